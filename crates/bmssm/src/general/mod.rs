//! General rays: R & S & T over blocks of objects and blocks of blocks (Skala 1993, §5, and
//! the hierarchical data structures that its §7 suggests).

mod beam;
mod beams;
mod boxes;
mod maps;
mod memory;
mod order;
mod paths;
mod ready;
mod scene;
mod scratch;
mod sides;
mod state;
mod stream;
mod test;
mod together;
mod trace;
mod tree;
mod visit;

use crate::id::ID;
use accel::grid::Grid;
use accel::{BuildError, Cancel, Counters, Footprint, Hit, Nearest, Ray, vec_bytes};
use boxes::BlockBoxes;
use lanes::split::{Item, Shape, UnitBox};
use lanes::{Blocks, Level, PackedObjects, Simd, Task};
use maps::BlockMaps;
pub use memory::bytes;
use order::Order;
use scene::Scene;
use scratch::Scratch;
use together::stream_len;
use trace::Stack;
use tree::{Fill, Node};

/// Most objects that can be split object by object.
pub const MAX_EXACT_SPLIT: usize = order::PART;

/// How many are unless told otherwise.
pub const EXACT_SPLIT: usize = MAX_EXACT_SPLIT / 2;

/// Where objects are when rays of any kind are tested with them. Answers are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// Copied into rows, block by block.
    Rows,
    /// Where the scene has them, but for those whose boxes are not met: a block keeps the boxes of its objects, six bytes each.
    Boxes,
    /// Where the scene has them.
    Scene,
}

impl Storage {
    /// All there are, fastest first.
    pub const ALL: [Self; 3] = [Self::Rows, Self::Boxes, Self::Scene];

    /// Name as used in settings.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Rows => "rows",
            Self::Boxes => "boxes",
            Self::Scene => "scene",
        }
    }

    /// Nodes are what is left to save where nothing is copied; elsewhere they are few beside the copies, and full ones cost rays 3 %.
    const fn fill(self) -> Fill {
        match self {
            Self::Rows | Self::Boxes => Fill::Surface,
            Self::Scene => Fill::Full,
        }
    }
}

/// How the maps for rays of any kind are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The instruction set.
    pub simd: Level,
    /// Objects up to which a part of the scene is split object by object, larger ones by clusters of
    /// neighbours; at most [`MAX_EXACT_SPLIT`].
    pub exact_split: usize,
    /// Where objects are when they are tested.
    pub storage: Storage,
}

/// The maps of a scene for rays of any kind.
pub struct General<O: PackedObjects> {
    /// One cell over the scene: clips rays and gives the unit coordinates.
    frame: Grid,
    /// Maps of the blocks of objects.
    maps: Vec<BlockMaps>,
    /// The boxes of the blocks' objects, with [`Storage::Boxes`].
    boxes: Vec<BlockBoxes>,
    /// The levels above.
    nodes: Vec<Node>,
    /// How far from each other rays of a beam may begin or end, in unit coordinates: about as far as a block is long, for
    /// wider beams meet many blocks that few of their rays meet.
    spread: f32,
    /// The objects, reordered.
    objects: O::Blocks,
    /// How many of them there are.
    len: usize,
    simd: Level,
}

impl<O: PackedObjects> General<O> {
    /// Builds the maps of all `objects`, in the current rayon pool.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if the system doesn't give the memory, and [`BuildError::Cancelled`].
    pub fn new(objects: &O, settings: Settings, cancel: Cancel) -> Result<Self, BuildError> {
        let simd = settings.simd;
        let Scene { frame, extent, items, keys } = Scene::new(&objects.shape(), simd, cancel)?;
        let shape = Shape { extent };
        let Order { slots, maps, boxes, blocks } = Order::new(&shape, items, keys, settings, cancel)?;
        let spread = mean_side(&blocks);
        let nodes = tree::over(&shape, blocks, settings.storage.fill(), simd)?;
        cancel.check(ID)?;
        let len = objects.len();
        let objects = match settings.storage {
            Storage::Rows => objects.blocks(ID, &slots)?,
            Storage::Boxes | Storage::Scene => objects.blocks_in_place(ID, &slots)?,
        };
        cancel.check(ID)?;
        Ok(Self { frame, maps, boxes, nodes, spread, objects, len, simd })
    }

    /// The nearest hit of each ray.
    pub fn closest(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        if let ([ray], [hit]) = (rays, &mut *hits) {
            *hit = self.simd.run(Single::<O, false> { general: self, ray });
            return;
        }
        self.simd.run(self.nearest_hits(rays, hits));
    }

    /// Whether each ray hits anything.
    pub fn occluded(&self, rays: &[Ray], occluded: &mut [bool]) {
        if let ([ray], [occluded]) = (rays, &mut *occluded) {
            *occluded = self.simd.run(Single::<O, true> { general: self, ray }).is_some();
            return;
        }
        self.simd.run(self.any_hits(rays, occluded));
    }

    /// Steps that the rays take.
    pub fn count(&self, rays: &[Ray], occlusion: bool) -> Counters {
        // The same steps whatever is compiled: one set is enough.
        if occlusion {
            Level::Portable.run(self.any_hits(rays, &mut vec![false; rays.len()]))
        } else {
            Level::Portable.run(self.nearest_hits(rays, &mut vec![None; rays.len()]))
        }
    }

    fn nearest_hits<'a>(
        &'a self,
        rays: &'a [Ray],
        answers: &'a mut [Option<Hit>],
    ) -> impl Task<Out = Counters> + 'a {
        Stream::<_, _, _, false> { general: self, rays, answers, answer: |best: &Nearest| best.hit() }
    }

    fn any_hits<'a>(&'a self, rays: &'a [Ray], answers: &'a mut [bool]) -> impl Task<Out = Counters> + 'a {
        let answer = |best: &Nearest| best.object != Nearest::NONE;
        Stream::<_, _, _, true> { general: self, rays, answers, answer }
    }

    /// Bytes held.
    pub fn footprint(&self) -> Footprint {
        Footprint::default()
            .structure("maps", vec_bytes(&self.maps))
            .structure("boxes", vec_bytes(&self.boxes))
            .structure("tree", vec_bytes(&self.nodes))
            .geometry_copy("blocks", self.objects.bytes())
    }
}

/// The longest sides of the blocks' boxes, in the mean.
fn mean_side(blocks: &[Item]) -> f32 {
    let side = |block: &Item| {
        let UnitBox { min, max } = block.bounds();
        (max[0] - min[0]).max(max[1] - min[1]).max(max[2] - min[2])
    };
    blocks.iter().map(side).sum::<f32>() / blocks.len().max(1) as f32
}

/// Answers of many rays, from the nearest hit of each, or for `ANY` from some hit.
struct Stream<'a, O: PackedObjects, T, A, const ANY: bool> {
    general: &'a General<O>,
    rays: &'a [Ray],
    answers: &'a mut [T],
    answer: A,
}

impl<O: PackedObjects, T, A: Fn(&Nearest) -> T, const ANY: bool> Task for Stream<'_, O, T, A, ANY> {
    type Out = Counters;
    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Counters {
        let Self { general, mut rays, mut answers, answer } = self;
        let (mut scratch, extent) = (Scratch::default(), general.frame.bounds().extent().max_element());
        while !rays.is_empty() {
            let len = stream_len(general.maps.len(), extent, rays).min(rays.len());
            let next = rays.split_off(..len).expect("so many are left");
            let answers = answers.split_off_mut(..len).expect("one for each");
            general.stream::<S, ANY>(s, next, &mut scratch);
            for (place, best) in answers.iter_mut().zip(&scratch.best) {
                *place = answer(best);
            }
        }
        scratch.steps
    }
}

/// The nearest hit of one ray, or for `ANY` some hit.
struct Single<'a, O: PackedObjects, const ANY: bool> {
    general: &'a General<O>,
    ray: &'a Ray,
}

impl<O: PackedObjects, const ANY: bool> Task for Single<'_, O, ANY> {
    type Out = Option<Hit>;
    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Option<Hit> {
        self.general.nearest::<S, ANY>(s, self.ray, &mut Stack::default()).hit()
    }
}

#[cfg(test)]
mod tests;
