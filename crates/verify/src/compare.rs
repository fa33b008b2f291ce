//! One structure held to brute force and to the oracle.

use accel::{Accel, Builder, Geometry, Hit, Ray, RaySet, Scene, Workload};
use baselines::Brute;
use harness::check::oracle_of;
use harness::guard::guard;
use harness::registry::{self, guarded_build};
use primitives::KernelId;
use std::fmt;

/// An answer that is not the right one.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The structure with its settings.
    pub structure: String,
    /// The ray, where it is one ray's answer.
    pub ray: Option<Ray>,
    /// What is wrong.
    pub what: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { structure, ray, what } = self;
        match ray {
            Some(ray) => write!(f, "{structure} on {ray:?}: {what}"),
            None => write!(f, "{structure}: {what}"),
        }
    }
}

/// What was compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Compared {
    /// Rays whose answers were compared with brute force.
    pub rays: u64,
    /// Rays of them that hit.
    pub hits: u64,
    /// Rays of them that were compared with the oracle too.
    pub exact: u64,
}

/// Rays of which each is traced alone besides.
const ALONE: usize = 16;

/// Rays through a scene with the answers of brute force, which any number of structures with its kernel are held to.
pub struct Judged<'a> {
    scene: &'a Scene,
    rays: &'a RaySet,
    workload: Workload,
    kernel: KernelId,
    brute: Box<dyn Accel + 'a>,
    expected: Vec<Option<Hit>>,
    hits: u64,
}

impl<'a> Judged<'a> {
    /// Asks brute force with this kernel.
    ///
    /// # Errors
    /// Says why it can't be built.
    pub fn new(
        scene: &'a Scene,
        rays: &'a RaySet,
        workload: Workload,
        kernel: KernelId,
    ) -> Result<Self, Difference> {
        let brute = Brute::new(kernel).build(scene, &Workload::GENERAL).map_err(|error| Difference {
            structure: format!("brute:kernel={kernel}"),
            ray: None,
            what: error.to_string(),
        })?;
        let mut expected = vec![None; rays.len()];
        brute.trace(rays, &mut expected);
        let hits = expected.iter().flatten().count() as u64;
        Ok(Self { scene, rays, workload, kernel, brute, expected, hits })
    }

    /// Rays that hit something.
    pub fn hits(&self) -> u64 {
        self.hits
    }

    /// Holds the structure `spec`, of the same kernel, to the answers: all rays together for hits and for occlusion, some of
    /// them alone. Returns how many rays it answered: none where it needs more memory than there is.
    ///
    /// # Errors
    /// The first difference, a build that fails for another reason than memory, a panic.
    pub fn hold(&self, spec: &str) -> Result<u64, Difference> {
        // Where one image is wanted no ray is asked for alone.
        self.hold_some(spec, if self.workload.general { ALONE } else { 0 })
    }

    /// [`Judged::hold`] with every ray alone besides, all of its crossings too.
    ///
    /// # Errors
    /// Those of [`Judged::hold`].
    pub fn hold_all(&self, spec: &str) -> Result<u64, Difference> {
        self.hold_some(spec, self.rays.len())
    }

    /// How many of these hits are none by brute force, or the reverse.
    pub fn hit_otherwise(&self, hits: &[Option<Hit>]) -> u64 {
        hits.iter().zip(&self.expected).filter(|(a, b)| a.is_some() != b.is_some()).count() as u64
    }

    fn hold_some(&self, spec: &str, alone: usize) -> Result<u64, Difference> {
        let wrong = |ray: Option<Ray>, what: String| Difference { structure: spec.into(), ray, what };
        let choice = registry::parse(spec).map_err(|error| wrong(None, error.to_string()))?;
        let built = match guarded_build(&choice, self.scene, &self.workload) {
            Ok(built) => built,
            Err(failure) if failure.is_too_large() => return Ok(0),
            Err(failure) => return Err(wrong(None, failure.to_string())),
        };
        let mut hits = vec![None; self.rays.len()];
        let mut occluded = vec![false; self.rays.len()];
        guard("tracing", || {
            built.trace(self.rays, &mut hits);
            built.trace_occluded(self.rays, &mut occluded);
        })
        .map_err(|panic| wrong(None, panic.to_string()))?;
        let answers = hits.iter().zip(&occluded).zip(&self.expected);
        for (i, ((hit, occluded), right)) in answers.enumerate() {
            if !same(hit, right) || *occluded != right.is_some() {
                let what = format!("{hit:?}, occluded: {occluded}; brute force: {right:?}");
                return Err(wrong(Some(self.rays.ray(i)), what));
            }
        }
        // Spread over all rays.
        for i in (0..self.rays.len()).step_by((self.rays.len() / alone.max(1)).max(1)).take(alone) {
            let (ray, right) = (self.rays.ray(i), &self.expected[i]);
            let (hit, any) = guard("tracing", || (built.closest(&ray), built.occluded(&ray)))
                .map_err(|panic| wrong(Some(ray), panic.to_string()))?;
            if !same(&hit, right) || any != right.is_some() {
                let what = format!("alone {hit:?}, occluded: {any}; brute force: {right:?}");
                return Err(wrong(Some(ray), what));
            }
            guard("tracing", || all_hits(&*self.brute, &*built, &ray))
                .map_err(|panic| panic.to_string())
                .flatten()
                .map_err(|what| wrong(Some(ray), what))?;
        }
        Ok(self.rays.len() as u64)
    }

    /// Holds the answers to so many of the rays to the oracle, if the kernel is the exact one and the objects are triangles.
    /// Returns how many it judged.
    ///
    /// # Errors
    /// The first answer that is not the true one.
    pub fn by_oracle(&self, rays: usize) -> Result<u64, Difference> {
        if self.kernel != KernelId::Exact || !matches!(self.scene.geometry, Geometry::Triangles(_)) {
            return Ok(0);
        }
        let oracle = oracle_of(self.scene);
        let mut judged = 0;
        for i in (0..self.rays.len()).step_by((self.rays.len() / rays.max(1)).max(1)).take(rays) {
            let ray = self.rays.ray(i);
            let truth = oracle.closest(&ray);
            let t = truth.as_ref().map_or(0.0, |(_, exact)| exact.t.to_f64());
            // Where t is less than the least normal number, its rounding may exceed what the invariant allows.
            if t != 0.0 && t.abs() < f64::from(f32::MIN_POSITIVE) {
                continue;
            }
            judged += 1;
            let (object, t) = match &truth {
                Some((object, exact)) => (Some(*object), Some(exact.t.to_f32())),
                None => (None, None),
            };
            let hit = self.expected[i];
            if hit.map(|hit| hit.object) != object || hit.map(|hit| hit.t) != t {
                return Err(Difference {
                    structure: "brute:kernel=exact".into(),
                    ray: Some(ray),
                    what: format!("{hit:?}; true: {object:?} at {t:?}"),
                });
            }
        }
        Ok(judged)
    }
}

/// Holds one structure to brute force with the same kernel on a list of rays and, with the exact kernel, brute force to the
/// oracle on `exact` of them.
///
/// # Errors
/// Those of [`Judged`].
pub fn compare(scene: &Scene, rays: &[Ray], spec: &str, exact: usize) -> Result<Compared, Difference> {
    let choice = registry::parse(spec).map_err(|error| Difference {
        structure: spec.into(),
        ray: None,
        what: error.to_string(),
    })?;
    let kernel = choice.built_in_kernel().unwrap_or(KernelId::Exact);
    let set = RaySet::List(rays.to_vec());
    let judged = Judged::new(scene, &set, Workload::GENERAL, kernel)?;
    let rays = judged.hold(spec)?;
    Ok(Compared { rays, hits: judged.hits(), exact: judged.by_oracle(exact)? })
}

/// Holds every crossing of a ray to brute force, if the structure tells all.
///
/// # Errors
/// What is wrong.
pub fn all_hits(brute: &dyn Accel, built: &dyn Accel, ray: &Ray) -> Result<(), String> {
    if !built.candidates(ray, &mut Vec::new()) {
        return Ok(());
    }
    let (expected, hits) = (brute.all_hits(ray), built.all_hits(ray));
    let same = hits.len() == expected.len() && hits.iter().zip(&expected).all(|(a, b)| a.same_bits(b));
    if same { Ok(()) } else { Err(format!("all hits are {hits:?}; brute force: {expected:?}")) }
}

/// Equality of every bit.
pub fn same(a: &Option<Hit>, b: &Option<Hit>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => a.same_bits(b),
        (None, None) => true,
        _ => false,
    }
}
