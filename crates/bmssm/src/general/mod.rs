//! General rays: R & S & T over blocks of objects and blocks of blocks (Skala 1993, §5, and
//! the hierarchical data structures that its §7 suggests).

mod maps;
mod order;
mod split;
mod trace;
mod tree;

use accel::grid::Grid;
use accel::objects::{BLOCK, Blocks, EMPTY_SLOT, Objects};
use accel::simd::{Level, Simd, Task};
use accel::{Aabb, Count, Footprint, Hit, NoCount, Ray, vec_bytes};
use maps::{BlockMaps, UnitBox};
use rayon::prelude::*;
use split::{Item, Shape};
use trace::Stack;
use tree::Node;

/// How the maps for rays of any kind are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The instruction set.
    pub simd: Level,
    /// Objects along a Morton curve within which blocks are cut; all of them at once if there are no more.
    pub stretch: usize,
}

/// The maps of a scene for rays of any kind.
pub struct General<O: Objects> {
    /// One cell over the scene: clips rays and gives the unit coordinates.
    frame: Grid,
    /// Maps of the blocks of objects.
    maps: Vec<BlockMaps>,
    /// The levels above.
    nodes: Vec<Node>,
    /// The objects, reordered.
    objects: O::Blocks,
    simd: Level,
}

impl<O: Objects> General<O> {
    /// Builds the maps of all `objects`, in the current rayon pool.
    pub fn new(objects: &O, settings: Settings) -> Self {
        let Settings { simd, stretch } = settings;
        let len = objects.len() as u32;
        let bounds: Vec<Aabb> =
            (0..len).into_par_iter().with_min_len(4096).map(|id| objects.bounds(id)).collect();
        let scene = bounds.iter().fold(Aabb::EMPTY, |all, b| all.union(*b));
        let scene = if scene.is_empty() { Aabb::of_points([accel::Vec3::ZERO]) } else { scene };
        let frame = Grid::new(scene, [1; 3]).expect("one slice is always allowed");
        let boxes: Vec<UnitBox> =
            bounds.par_iter().with_min_len(4096).map(|bounds| unit_box(&frame, bounds)).collect();
        drop(bounds);
        let extent = scene.extent() / scene.extent().max_element();
        let shape = Shape { extent: extent.to_array() };
        let mut items = if boxes.len() > stretch {
            order::along_curve(&boxes)
        } else {
            (0..len).zip(&boxes).map(|(id, bounds)| Item::new(id, bounds)).collect()
        };
        drop(boxes);
        let blocks = order::blocks(&shape, &mut items, stretch);
        let maps: Vec<BlockMaps> = blocks
            .par_iter()
            .with_min_len(64)
            .map(|block| BlockMaps::new(&block.bounds, items[block.items.clone()].iter().map(Item::bounds)))
            .collect();
        let mut order = vec![EMPTY_SLOT; blocks.len() * BLOCK];
        for (block, slots) in blocks.iter().zip(order.chunks_exact_mut(BLOCK)) {
            for (slot, item) in slots.iter_mut().zip(&items[block.items.clone()]) {
                *slot = item.number();
            }
        }
        drop(items);
        let nodes = tree::over(&shape, &blocks);
        Self { frame, maps, nodes, objects: objects.blocks(&order), simd }
    }

    /// The nearest hit of each ray.
    pub fn closest(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        self.simd.run(Closest { general: self, rays, hits });
    }

    /// Whether each ray hits anything.
    pub fn occluded(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.simd.run(Occluded { general: self, rays, occluded });
    }

    /// Steps that the rays take.
    pub fn count<C: Count>(&self, rays: &[Ray], occlusion: bool) -> C {
        self.simd.run(Counted { general: self, rays, occlusion, count: C::default() })
    }

    /// Bytes held.
    pub fn footprint(&self) -> Footprint {
        Footprint::default()
            .structure("maps", vec_bytes(&self.maps))
            .structure("tree", vec_bytes(&self.nodes))
            .geometry_copy("blocks", self.objects.bytes())
    }
}

fn unit_box(frame: &Grid, bounds: &Aabb) -> UnitBox {
    let unit =
        |corner: accel::Vec3| [0, 1, 2].map(|axis: usize| frame.unit(axis, f64::from(corner[axis])) as f32);
    UnitBox { min: unit(bounds.min), max: unit(bounds.max) }
}

struct Closest<'a, O: Objects> {
    general: &'a General<O>,
    rays: &'a [Ray],
    hits: &'a mut [Option<Hit>],
}

impl<O: Objects> Task for Closest<'_, O> {
    type Out = ();
    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        let mut stack = Stack::default();
        for (ray, hit) in self.rays.iter().zip(self.hits) {
            *hit = self.general.nearest::<S, NoCount, false>(s, ray, &mut stack, &mut NoCount).hit();
        }
    }
}

struct Occluded<'a, O: Objects> {
    general: &'a General<O>,
    rays: &'a [Ray],
    occluded: &'a mut [bool],
}

impl<O: Objects> Task for Occluded<'_, O> {
    type Out = ();
    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        let mut stack = Stack::default();
        for (ray, occluded) in self.rays.iter().zip(self.occluded) {
            *occluded =
                self.general.nearest::<S, NoCount, true>(s, ray, &mut stack, &mut NoCount).hit().is_some();
        }
    }
}

struct Counted<'a, O: Objects, C> {
    general: &'a General<O>,
    rays: &'a [Ray],
    occlusion: bool,
    count: C,
}

impl<O: Objects, C: Count> Task for Counted<'_, O, C> {
    type Out = C;
    #[inline(always)]
    fn run<S: Simd>(mut self, s: S) -> C {
        let mut stack = Stack::default();
        for ray in self.rays {
            if self.occlusion {
                self.general.nearest::<S, C, true>(s, ray, &mut stack, &mut self.count);
            } else {
                self.general.nearest::<S, C, false>(s, ray, &mut stack, &mut self.count);
            }
        }
        self.count
    }
}

#[cfg(test)]
mod tests;
