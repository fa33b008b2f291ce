//! General rays: R & S & T over blocks of objects and blocks of blocks (Skala 1993, §5, and
//! the hierarchical data structures that its §7 suggests).

mod item;
mod maps;
mod order;
mod split;
mod trace;
mod tree;
mod unit_box;

use accel::grid::Grid;
use accel::{Count, Footprint, Hit, NoCount, Ray, vec_bytes};
use item::Scene;
use lanes::{Blocks, Level, PackedObjects, Portable, Simd, Task};
use maps::BlockMaps;
use order::Order;
use split::Shape;
use trace::Stack;
use tree::Node;

/// Most objects that are split object by object.
pub const MOST_STRETCH: usize = order::PART;

/// Objects that are split object by object unless told otherwise.
pub const STRETCH: usize = MOST_STRETCH;

/// How the maps for rays of any kind are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The instruction set.
    pub simd: Level,
    /// Objects up to which a part of the scene is split object by object, larger ones by clusters of
    /// neighbours; at most [`MOST_STRETCH`].
    pub stretch: usize,
}

/// The maps of a scene for rays of any kind.
pub struct General<O: PackedObjects> {
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

impl<O: PackedObjects> General<O> {
    /// Builds the maps of all `objects`, in the current rayon pool.
    pub fn new(objects: &O, settings: Settings) -> Self {
        let simd = settings.simd;
        let Scene { frame, extent, items, keys } = Scene::new(objects, simd);
        let shape = Shape { extent };
        let Order { slots, maps, blocks } = Order::new(&shape, items, keys, settings);
        let nodes = tree::over(&shape, blocks, simd);
        Self { frame, maps, nodes, objects: objects.blocks(&slots), simd }
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
        // The same steps at every level: one is enough.
        Counted { general: self, rays, occlusion, count: C::default() }.run(Portable)
    }

    /// Bytes held.
    pub fn footprint(&self) -> Footprint {
        Footprint::default()
            .structure("maps", vec_bytes(&self.maps))
            .structure("tree", vec_bytes(&self.nodes))
            .geometry_copy("blocks", self.objects.bytes())
    }
}

struct Closest<'a, O: PackedObjects> {
    general: &'a General<O>,
    rays: &'a [Ray],
    hits: &'a mut [Option<Hit>],
}

impl<O: PackedObjects> Task for Closest<'_, O> {
    type Out = ();
    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        let mut stack = Stack::default();
        for (ray, hit) in self.rays.iter().zip(self.hits) {
            *hit = self.general.nearest::<S, NoCount, false>(s, ray, &mut stack, &mut NoCount).hit();
        }
    }
}

struct Occluded<'a, O: PackedObjects> {
    general: &'a General<O>,
    rays: &'a [Ray],
    occluded: &'a mut [bool],
}

impl<O: PackedObjects> Task for Occluded<'_, O> {
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

struct Counted<'a, O: PackedObjects, C> {
    general: &'a General<O>,
    rays: &'a [Ray],
    occlusion: bool,
    count: C,
}

impl<O: PackedObjects, C: Count> Task for Counted<'_, O, C> {
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
