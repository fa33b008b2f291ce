//! The contract of acceleration structures.

use crate::parallel::for_each_chunk;
use crate::{Cancel, Footprint, Hit, Ray, RaySet, Scene};

/// A built acceleration structure.
///
/// Traces in the current rayon pool: [`Accel::trace`] uses as many threads as that has.
pub trait Accel: Send + Sync {
    /// The nearest hit; on equal t the lowest object number.
    fn closest(&self, ray: &Ray) -> Option<Hit>;

    /// Whether anything is hit. Which object makes no difference.
    fn occluded(&self, ray: &Ray) -> bool {
        self.closest(ray).is_some()
    }

    /// The nearest hit of every ray, in the set's order.
    ///
    /// # Panics
    /// If `hits` is not as long as the set.
    fn trace(&self, rays: &RaySet, hits: &mut [Option<Hit>]) {
        for_each_ray(rays, hits, |ray| self.closest(ray));
    }

    /// Whether anything is hit, for every ray in the set's order.
    ///
    /// # Panics
    /// If `occluded` is not as long as the set.
    fn trace_occluded(&self, rays: &RaySet, occluded: &mut [bool]) {
        for_each_ray(rays, occluded, |ray| self.occluded(ray));
    }

    /// Appends the number of every object that the ray may meet within its range, each once, in any order: none that it
    /// hits is missing. Returns false, and appends nothing, if the structure can't tell.
    fn candidates(&self, ray: &Ray, found: &mut Vec<u32>) -> bool {
        let _ = (ray, found);
        false
    }

    /// Every crossing of the ray within its range, in order of t, then of object: "find all intersection points" (Skala
    /// 1993, §1). A ray through an edge that triangles share crosses each of them, and an object at more than one t is
    /// crossed as often.
    ///
    /// By default the nearest hits are followed one behind another, which of crossings at the same t tells one only.
    /// Structures that name [`Accel::candidates`] tell all.
    fn all_hits(&self, ray: &Ray) -> Vec<Hit> {
        by_steps(self, ray)
    }

    /// What the structure holds in memory.
    fn footprint(&self) -> Footprint;

    /// What was chosen at build time and why, in a line or a few; empty if nothing was.
    fn plan(&self) -> String {
        String::new()
    }

    /// What tracing `rays` costs in steps, or `None` if the structure can't tell. `occlusion` asks for
    /// [`Accel::trace_occluded`] instead of [`Accel::trace`].
    fn count(&self, rays: &RaySet, occlusion: bool) -> Option<Counters> {
        let _ = (rays, occlusion);
        None
    }
}

/// What the nearest hits tell: from each the ray goes on behind it. Of crossings at the same t that is one.
fn by_steps(accel: &(impl Accel + ?Sized), ray: &Ray) -> Vec<Hit> {
    let mut hits: Vec<Hit> = Vec::new();
    let mut rest = *ray;
    while let Some(hit) = accel.closest(&rest) {
        hits.push(hit);
        rest.t_min = hit.t.max(rest.t_min).next_up();
        if rest.t_min > rest.t_max || rest.t_min.is_infinite() {
            break;
        }
    }
    hits
}

/// Rays traced by one task of the thread pool.
const CHUNK: usize = 4096;

/// Writes `of` each ray to `out`, on all threads of the current pool.
///
/// # Panics
/// If `out` is not as long as the set.
pub fn for_each_ray<T: Send>(rays: &RaySet, out: &mut [T], of: impl Fn(&Ray) -> T + Sync) {
    assert_eq!(rays.len(), out.len(), "one place for each ray");
    for_each_chunk(out, CHUNK, &|chunk, out| {
        for (i, out) in out.iter_mut().enumerate() {
            *out = of(&rays.ray(chunk * CHUNK + i));
        }
    });
}

/// What a structure is built for. It builds nothing that the workload doesn't name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Workload {
    /// Primary rays of this image.
    pub raster: Option<crate::Raster>,
    /// Any rays whatever.
    pub general: bool,
}

impl Workload {
    /// Any rays whatever.
    pub const GENERAL: Self = Self { raster: None, general: true };

    /// The primary rays of one image and no others.
    pub const fn raster(raster: crate::Raster) -> Self {
        Self { raster: Some(raster), general: false }
    }

    /// What tracing `rays` requires.
    pub fn of(rays: &RaySet) -> Self {
        match rays {
            RaySet::Raster(raster) => Self::raster(*raster),
            RaySet::List(_) => Self::GENERAL,
        }
    }
}

/// A structure for a scene, or why there is none.
pub type BuildResult<'s> = Result<Box<dyn Accel + 's>, BuildError>;

/// Makes structures of one kind with fixed settings.
pub trait Builder: Send + Sync {
    /// The structure's id, such as `bmssm-dense`.
    fn id(&self) -> &str;

    /// The settings, as `name=value` separated by blanks. By default there are none.
    fn settings(&self) -> String {
        String::new()
    }

    /// Builds for a scene and a workload, in the current rayon pool.
    ///
    /// Rays that the workload doesn't name may get no answer from the result: they panic.
    ///
    /// # Errors
    /// Where the structure can't serve this scene or workload, or its memory would not fit.
    fn build<'s>(&self, scene: &'s Scene, workload: &Workload) -> BuildResult<'s>;

    /// [`Builder::build`] that gives up soon after it is asked to. By default it looks before building and after;
    /// builders that may take long look in between.
    ///
    /// # Errors
    /// As [`Builder::build`], and [`BuildError::Cancelled`].
    fn build_unless<'s>(&self, scene: &'s Scene, workload: &Workload, cancel: Cancel) -> BuildResult<'s> {
        cancel.check(self.id())?;
        let built = self.build(scene, workload)?;
        cancel.check(self.id())?;
        Ok(built)
    }
}

/// Why a structure was not built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// The geometry can't be traced.
    #[error(transparent)]
    Input(#[from] crate::InputError),
    /// The structure has no way to serve this.
    #[error("{structure} does not serve {what}")]
    Unsupported {
        /// The structure's id.
        structure: String,
        /// What it does not serve.
        what: String,
    },
    /// The memory would exceed the limit.
    #[error(
        "{structure} would take {bytes} bytes, more than the limit of {limit} bytes; choose a lower resolution"
    )]
    TooLarge {
        /// The structure's id.
        structure: String,
        /// Bytes it would take.
        bytes: u128,
        /// Bytes there are.
        limit: u128,
    },
    /// A setting makes no sense.
    #[error("{structure}: {setting}: {problem}")]
    Setting {
        /// The structure's id.
        structure: String,
        /// The setting's name.
        setting: String,
        /// What is wrong with it.
        problem: String,
    },
    /// The build was asked to end before it was done.
    #[error("{structure}: the build was cancelled")]
    Cancelled {
        /// The structure's id.
        structure: String,
    },
    /// The library behind the structure failed.
    #[error("{structure}: {message}")]
    Library {
        /// The structure's id.
        structure: String,
        /// What the library said.
        message: String,
    },
}

impl Cancel<'_> {
    /// An error if the build of this structure is to end.
    ///
    /// # Errors
    /// [`BuildError::Cancelled`]
    pub fn check(&self, structure: &str) -> Result<(), BuildError> {
        if self.is_asked() {
            return Err(BuildError::Cancelled { structure: structure.into() });
        }
        Ok(())
    }
}

/// Counts steps of a traversal; [`NoCount`] compiles to nothing.
pub trait Count: Default + Send {
    /// Words of bit maps combined.
    fn words(&mut self, n: u64);
    /// Blocks of objects looked at.
    fn blocks(&mut self, n: u64);
    /// Cells or nodes visited.
    fn cells(&mut self, n: u64);
    /// Candidates: bits set, or list entries met.
    fn candidates(&mut self, n: u64);
    /// Objects tested in detail.
    fn tests(&mut self, n: u64);
}

/// Counts nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoCount;

impl Count for NoCount {
    #[inline(always)]
    fn words(&mut self, _: u64) {}
    #[inline(always)]
    fn blocks(&mut self, _: u64) {}
    #[inline(always)]
    fn cells(&mut self, _: u64) {}
    #[inline(always)]
    fn candidates(&mut self, _: u64) {}
    #[inline(always)]
    fn tests(&mut self, _: u64) {}
}

/// Sums of steps over a set of rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Words of bit maps combined.
    pub words: u64,
    /// Blocks of objects looked at.
    pub blocks: u64,
    /// Cells or nodes visited.
    pub cells: u64,
    /// Candidates: bits set, or list entries met.
    pub candidates: u64,
    /// Objects tested in detail.
    pub tests: u64,
}

impl Counters {
    /// Adds another's sums.
    pub fn merge(&mut self, other: &Self) {
        self.words += other.words;
        self.blocks += other.blocks;
        self.cells += other.cells;
        self.candidates += other.candidates;
        self.tests += other.tests;
    }
}

impl Count for Counters {
    fn words(&mut self, n: u64) {
        self.words += n;
    }
    fn blocks(&mut self, n: u64) {
        self.blocks += n;
    }
    fn cells(&mut self, n: u64) {
        self.cells += n;
    }
    fn candidates(&mut self, n: u64) {
        self.candidates += n;
    }
    fn tests(&mut self, n: u64) {
        self.tests += n;
    }
}
