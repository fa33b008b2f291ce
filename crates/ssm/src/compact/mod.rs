//! `ssm`: the compact grid.

mod abreast;
mod all;
mod alone;
mod any;
mod beam;
mod boxes;
mod brick;
mod bricks;
mod chunk;
mod divide;
mod nearest;
mod objects;
mod order;
mod queue;
mod segment;
mod sort;
mod trace;

use crate::register::{Limit, register};
use crate::resolution::Resolution;
use crate::settings::Settings;
use accel::grid::Grid;
use accel::parallel::prelude::*;
use accel::{
    Accel, Bounds, BuildError, BuildResult, Builder, Cancel, Counters, Footprint, Hit, Ray, RaySet, Scene,
    Workload, vec_bytes,
};
use brick::BRICK;
use bricks::BrickGrid;
use lanes::{Blocks, EMPTY_SLOT, PackedObjects};
use order::{GROUP, Order};
use primitives::WithObjects;
use segment::UnitBox;

const ID: &str = "ssm";

/// Builds `ssm`: for each cell a position among the references, for each reference the number of a
/// group of objects, and a bit for each cell that holds any. Cells that hold much may be divided again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ssm {
    /// The settings of any grid.
    pub settings: Settings,
    /// A cell is divided into 4×4×4 where this is expected to spare a ray through it so many
    /// tests of groups, and so on; `None` for the plain grid.
    pub divide: Option<f32>,
}

impl Default for Ssm {
    fn default() -> Self {
        Self { settings: Settings::new(Resolution::Density(0.4)), divide: Some(12.0) }
    }
}

impl Ssm {
    /// Names and meanings, for help texts.
    pub const NAMES: [(&str, &str); 6] = {
        let [kernel, simd, resolution, density, memory] = Settings::NAMES;
        let divide = ("divide", "tests of 16 objects that dividing a cell must spare a ray, or off");
        [kernel, simd, resolution, density, divide, memory]
    };

    /// Changes one setting, see [`Ssm::NAMES`].
    ///
    /// # Errors
    /// [`BuildError::Setting`] if there is no such setting or the value makes no sense.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), BuildError> {
        if name != "divide" {
            return self.settings.set(ID, name, value);
        }
        self.divide = match value.parse::<f32>() {
            _ if value == "off" => None,
            Ok(gain) if gain > 0.0 && gain.is_finite() => Some(gain),
            _ => {
                let problem = format!("'{value}' is neither a number of tests above 0 nor off");
                return Err(BuildError::Setting { structure: ID.into(), setting: name.into(), problem });
            }
        };
        Ok(())
    }
}

impl Builder for Ssm {
    fn id(&self) -> &str {
        ID
    }

    fn settings(&self) -> String {
        let divide = self.divide.map_or("off".into(), |gain| gain.to_string());
        format!("{} divide={divide}", self.settings.display())
    }

    fn build<'s>(&self, scene: &'s Scene, workload: &Workload) -> BuildResult<'s> {
        self.build_unless(scene, workload, Cancel::NEVER)
    }

    fn build_unless<'s>(&self, scene: &'s Scene, _: &Workload, cancel: Cancel) -> BuildResult<'s> {
        primitives::with_objects(scene, self.settings.kernel, Build(*self, cancel))
    }
}

/// Builds for objects of any kind.
pub(crate) struct Build<'c>(pub Ssm, pub Cancel<'c>);

impl<'s> WithObjects<'s> for Build<'_> {
    type Out = BuildResult<'s>;
    fn objects<O: PackedObjects + 's>(self, objects: O) -> Self::Out {
        Ok(Box::new(Built::new(objects, &self.0, self.1)?))
    }
}

/// The lists of all cells, one behind another.
struct Cells {
    /// Where the references of each cell begin and, one further, end; cells go brick by brick.
    positions: Vec<u32>,
    /// Numbers of groups of objects, or of a brick in the place of a divided cell's list.
    references: Vec<u32>,
}

impl Cells {
    #[inline(always)]
    fn list(&self, cell: usize) -> &[u32] {
        &self.references[self.positions[cell] as usize..self.positions[cell + 1] as usize]
    }

    /// The brick that a divided cell holds in the place of a list.
    #[inline(always)]
    fn brick(&self, cell: usize) -> u32 {
        self.references[self.positions[cell] as usize]
    }

    fn length(&self, cell: usize) -> u32 {
        self.positions[cell + 1] - self.positions[cell]
    }

    fn bytes(&self) -> u128 {
        (vec_bytes(&self.positions) + vec_bytes(&self.references)) as u128
    }
}

struct Built<O: PackedObjects> {
    settings: Settings,
    grid: Grid,
    bricks: BrickGrid,
    cells: Cells,
    /// The boxes of all groups, or none where they are not worth looking at.
    boxes: Vec<UnitBox>,
    /// Whether the first group is in no cell and meets every ray.
    apart: bool,
    blocks: O::Blocks,
    /// Whether lists of rays are put in order before their nearest hits are sought, and before any hit is.
    sort: [bool; 2],
    objects: O,
}

/// Bytes from which on putting a list of rays in order takes less time than it spares, measured on twelve scenes (docs/ssm.md).
const CACHED: usize = 1 << 24;

/// The same for nearest hits where no boxes of groups are kept and each ray tests more groups, measured on two scenes.
const CACHED_WITHOUT_BOXES: usize = 1 << 21;

/// Bytes of a brick: a position for each cell, and bits.
const BRICK_BYTES: u128 = 4 * BRICK as u128 + 8;

/// The cells of a grid over objects, and the order in which the objects are packed.
struct Laid {
    grid: Grid,
    bricks: BrickGrid,
    cells: Cells,
    boxes: Vec<UnitBox>,
    slots: Vec<u32>,
    apart: bool,
}

impl Laid {
    /// `copy` tells what the packed objects will take.
    fn new<B: Bounds>(
        objects: &B,
        ssm: &Ssm,
        copy: fn(usize) -> u128,
        cancel: Cancel,
    ) -> Result<Self, BuildError> {
        let settings = &ssm.settings;
        let Order { slots, apart, bounds } = order::order(objects)?;
        let others = slots.len() - if apart { GROUP } else { 0 };
        let grid = crate::resolution::grid(ID, settings.resolution, bounds, others)?;
        let mut bricks = BrickGrid::new(&grid, ssm.divide.map_or(0, |_| u32::MAX));
        let copy = copy(slots.len());
        let limit = Limit::of(ID, settings).less(copy + slots.len() as u128 * 4)?;
        let count = limit.cells(bricks.count() * BRICK as u128, BRICK_BYTES / BRICK as u128)? / BRICK;
        let groups = (slots.len() / GROUP) as u32;
        let bytes = |references: u64| count as u128 * BRICK_BYTES + 4 * u128::from(references);
        let lists = register(count * BRICK, groups, limit, cancel, bytes, |group, found| {
            if apart && group == 0 {
                return Ok(());
            }
            let first = group as usize * GROUP;
            let held = slots[first..first + GROUP].iter().filter(|object| **object != EMPTY_SLOT);
            let mut slices = [const { [0..0, 0..0, 0..0] }; GROUP];
            let mut len = 0;
            for (slices, object) in slices.iter_mut().zip(held) {
                *slices = bricks.slices(&objects.bounds(*object));
                len += 1;
            }
            bricks.cells(&slices[..len], found)
        })?;
        let mut cells = Cells { positions: lists.offsets, references: lists.references };
        let mut occupied: Vec<u64> = limit.blank(count, cancel)?;
        let ends = cells.positions.par_windows(BRICK + 1).step_by(BRICK);
        occupied.par_iter_mut().zip(ends).for_each(|(bits, ends)| {
            *bits = (0..BRICK).fold(0, |bits, cell| bits | u64::from(ends[cell] != ends[cell + 1]) << cell);
        });
        bricks.occupied = occupied.into_boxed_slice();
        if let Some(gain) = ssm.divide {
            cells = divide::divide(cells, &mut bricks, objects, &slots, gain, (limit, cancel))?;
        }
        let left = limit.less(cells.bytes() + bricks.bytes())?;
        let boxes = boxes::boxes(objects, &grid, &bricks, &cells, &slots, left)?;
        Ok(Self { grid, bricks, cells, boxes, slots, apart })
    }
}

impl<O: PackedObjects> Built<O> {
    fn new(objects: O, ssm: &Ssm, cancel: Cancel) -> Result<Self, BuildError> {
        let settings = ssm.settings;
        let Laid { grid, bricks, cells, boxes, slots, apart } =
            Laid::new(&objects.shape(), ssm, O::bytes_of_blocks, cancel)?;
        cancel.check(ID)?;
        let blocks = objects.blocks(ID, &slots)?;
        let mut built =
            Self { settings, grid, bricks, cells, boxes, apart, blocks, sort: [false; 2], objects };
        let nearest = if built.boxes.is_empty() { CACHED_WITHOUT_BOXES } else { CACHED };
        built.sort = [nearest, CACHED].map(|bytes| built.footprint().total() > bytes);
        Ok(built)
    }
}

impl<O: PackedObjects> Accel for Built<O> {
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

    fn candidates(&self, ray: &Ray, found: &mut Vec<u32>) -> bool {
        self.gather(ray, found);
        true
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Hit> {
        accel::all_hits::of(self, &self.objects, ray)
    }

    fn footprint(&self) -> Footprint {
        Footprint::default()
            .structure("cells", vec_bytes(&self.cells.positions))
            .structure("references", vec_bytes(&self.cells.references))
            .structure("occupied", size_of_val(&*self.bricks.occupied))
            .structure("divided", size_of_val(&*self.bricks.divided))
            .structure("boxes", vec_bytes(&self.boxes))
            .geometry_copy("blocks", self.blocks.bytes())
    }

    fn plan(&self) -> String {
        let [x, y, z] = self.grid.resolution();
        let divided: u32 = self.bricks.divided.iter().map(|bits| bits.count_ones()).sum();
        let filled: u32 = self.bricks.occupied.iter().map(|bits| bits.count_ones()).sum();
        format!(
            "{x}x{y}x{z} cells by {}, the largest objects {}, {divided} cells divided into 4x4x4; {} cells hold {} references to groups of {GROUP}",
            self.settings.resolution,
            if self.apart { "set apart" } else { "among the others" },
            filled - divided,
            self.cells.references.len() - divided as usize
        )
    }

    fn count(&self, rays: &RaySet, occlusion: bool) -> Option<Counters> {
        Some(if occlusion { self.counted::<true>(rays) } else { self.counted::<false>(rays) })
    }
}
