//! One structure held to brute force and to the oracle.

use accel::{Accel, Builder, Hit, Ray, RaySet, Scene, Workload};
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

/// Holds the structure `spec` to brute force with the same kernel: all rays together for hits and for occlusion, some of
/// them alone. With the exact kernel the first `exact` of them are held to the oracle.
///
/// # Errors
/// The first difference, a build that fails for another reason than memory, a panic.
pub fn compare(scene: &Scene, rays: &[Ray], spec: &str, exact: usize) -> Result<Compared, Difference> {
    let wrong =
        |ray: Option<&Ray>, what: String| Difference { structure: spec.into(), ray: ray.copied(), what };
    let choice = registry::parse(spec).map_err(|error| wrong(None, error.to_string()))?;
    let kernel = choice.built_in_kernel().unwrap_or(KernelId::Exact);
    let built = match guarded_build(&choice, scene, &Workload::GENERAL) {
        Ok(built) => built,
        Err(failure) if failure.is_too_large() => return Ok(Compared::default()),
        Err(failure) => return Err(wrong(None, failure.to_string())),
    };
    let brute =
        Brute::new(kernel).build(scene, &Workload::GENERAL).map_err(|e| wrong(None, e.to_string()))?;
    let set = RaySet::List(rays.to_vec());
    let (mut expected, mut hits) = (vec![None; rays.len()], vec![None; rays.len()]);
    let mut occluded = vec![false; rays.len()];
    brute.trace(&set, &mut expected);
    guard("tracing", || {
        built.trace(&set, &mut hits);
        built.trace_occluded(&set, &mut occluded);
    })
    .map_err(|panic| wrong(None, panic.to_string()))?;
    for (i, ray) in rays.iter().enumerate() {
        let right = expected[i];
        if !same(&hits[i], &right) || occluded[i] != right.is_some() {
            let what = format!("{:?}, occluded: {}; brute force: {right:?}", hits[i], occluded[i]);
            return Err(wrong(Some(ray), what));
        }
    }
    for (i, ray) in rays.iter().enumerate().take(ALONE) {
        let (hit, any) = (built.closest(ray), built.occluded(ray));
        if !same(&hit, &expected[i]) || any != expected[i].is_some() {
            return Err(wrong(
                Some(ray),
                format!("alone {hit:?}, occluded: {any}; brute force: {:?}", expected[i]),
            ));
        }
    }
    for ray in rays.iter().take(ALONE) {
        all_hits(&*brute, &*built, ray).map_err(|what| wrong(Some(ray), what))?;
    }
    let judged = if kernel == KernelId::Exact {
        by_oracle(scene, &rays[..exact.min(rays.len())], &hits)
    } else {
        Ok(0)
    };
    let exact = judged.map_err(|(i, what)| wrong(Some(&rays[i]), what))?;
    let hits = expected.iter().flatten().count() as u64;
    Ok(Compared { rays: rays.len() as u64, hits, exact })
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

/// How many hits are the true ones, or the first that is not.
fn by_oracle(scene: &Scene, rays: &[Ray], hits: &[Option<Hit>]) -> Result<u64, (usize, String)> {
    let oracle = oracle_of(scene);
    let mut judged = 0;
    for (i, ray) in rays.iter().enumerate() {
        let truth = oracle.closest(ray);
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
        if hits[i].map(|hit| hit.object) != object || hits[i].map(|hit| hit.t) != t {
            return Err((i, format!("{:?}; true: {object:?} at {t:?}", hits[i])));
        }
    }
    Ok(judged)
}
