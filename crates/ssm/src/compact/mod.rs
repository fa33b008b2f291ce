//! `ssm`: the compact grid.

mod field;
mod order;
mod trace;

use crate::register::{Limit, register};
use crate::{Resolution, Settings};
use accel::grid::Grid;
use accel::objects::EMPTY_SLOT;
use accel::{
    Accel, Blocks, BuildError, Builder, Counters, Footprint, Hit, Need, Objects, Ray, RaySet, Scene,
    WithObjects,
};
use field::{BRICK, Layout, slices};
use order::GROUP;
use rayon::prelude::*;

const ID: &str = "ssm";

/// Builds `ssm`: for each cell a position among the references, for each reference the number of a
/// group of objects, and a bit for each cell that holds any.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ssm {
    /// The settings.
    pub settings: Settings,
}

impl Default for Ssm {
    /// Four cells for each object.
    fn default() -> Self {
        Self { settings: Settings::new(Resolution::Density(4.0)) }
    }
}

impl Ssm {
    /// Changes one setting, see [`Settings::NAMES`].
    ///
    /// # Errors
    /// [`BuildError::Setting`] if there is no such setting or the value makes no sense.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), BuildError> {
        self.settings.set(ID, name, value)
    }
}

impl Builder for Ssm {
    fn id(&self) -> &str {
        ID
    }

    fn settings(&self) -> String {
        self.settings.display()
    }

    fn build<'s>(&self, scene: &'s Scene, _: &Need) -> Result<Box<dyn Accel + 's>, BuildError> {
        scene.with_objects(self.settings.kernel, *self)
    }
}

impl<'s> WithObjects<'s> for Ssm {
    type Out = Result<Box<dyn Accel + 's>, BuildError>;
    fn objects<O: Objects + 's>(self, objects: O) -> Self::Out {
        Ok(Box::new(Built::new(objects, &self.settings)?))
    }
}

struct Built<O: Objects> {
    settings: Settings,
    grid: Grid,
    layout: Layout,
    /// Where the references of each cell begin and, one further, end; cells go brick by brick.
    cells: Box<[u32]>,
    /// Groups of objects.
    references: Box<[u32]>,
    /// A bit for each cell of a brick.
    occupied: Box<[u64]>,
    blocks: O::Blocks,
    _objects: O,
}

impl<O: Objects> Built<O> {
    fn new(objects: O, settings: &Settings) -> Result<Self, BuildError> {
        let bounds = crate::resolution::bounds(&objects);
        let grid = crate::resolution::grid(ID, settings, bounds, objects.len())?;
        let layout = Layout::new(grid.resolution());
        let limit = Limit::of(ID, settings);
        // A position for each cell, and its bit.
        const BRICK_BYTES: u128 = 4 * BRICK as u128 + 8;
        let bricks = limit.cells(layout.bricks() * BRICK as u128, BRICK_BYTES / BRICK as u128)? / BRICK;
        let order = order::morton(&objects, &bounds);
        let groups = (order.len() / GROUP) as u32;
        let bytes = |references: u64| bricks as u128 * BRICK_BYTES + 4 * u128::from(references);
        let lists = register(bricks * BRICK, groups, limit, bytes, |group, found| {
            let first = group as usize * GROUP;
            for object in order[first..first + GROUP].iter().filter(|object| **object != EMPTY_SLOT) {
                layout.cells(slices(&grid, &objects.bounds(*object)), found);
            }
            found.sort_unstable();
            found.dedup();
        })?;
        let occupied = lists.offsets.par_windows(BRICK + 1).step_by(BRICK).map(|ends| {
            (0..BRICK).fold(0, |bits, cell| bits | u64::from(ends[cell] != ends[cell + 1]) << cell)
        });
        Ok(Self {
            settings: *settings,
            grid,
            layout,
            occupied: occupied.collect::<Vec<_>>().into_boxed_slice(),
            cells: lists.offsets.into_boxed_slice(),
            references: lists.references.into_boxed_slice(),
            blocks: objects.blocks(&order),
            _objects: objects,
        })
    }
}

impl<O: Objects> Accel for Built<O> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.nearest::<false>(ray).hit()
    }

    fn occluded(&self, ray: &Ray) -> bool {
        self.nearest::<true>(ray).hit().is_some()
    }

    fn trace(&self, rays: &RaySet, hits: &mut [Option<Hit>]) {
        self.batches::<false, _>(rays, hits, |nearest| nearest.hit());
    }

    fn trace_occluded(&self, rays: &RaySet, occluded: &mut [bool]) {
        self.batches::<true, _>(rays, occluded, |nearest| nearest.hit().is_some());
    }

    fn footprint(&self) -> Footprint {
        Footprint::default()
            .structure("cells", size_of_val(&*self.cells))
            .structure("references", size_of_val(&*self.references))
            .structure("occupied", size_of_val(&*self.occupied))
            .geometry_copy("blocks", self.blocks.bytes())
    }

    fn plan(&self) -> String {
        let [x, y, z] = self.grid.resolution();
        let filled: u32 = self.occupied.iter().map(|bits| bits.count_ones()).sum();
        format!(
            "{x}x{y}x{z} cells by {}; {filled} of them hold {} references to groups of {GROUP}",
            self.settings.resolution,
            self.references.len()
        )
    }

    fn count(&self, rays: &RaySet, occlusion: bool) -> Option<Counters> {
        Some(if occlusion { self.counted::<true>(rays) } else { self.counted::<false>(rays) })
    }
}
