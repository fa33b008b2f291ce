//! Rays that are none: whatever they are, every walk ends, and what others are handed hits nothing.

use crate::Numbers;
use crate::cases;
use crate::compare::Difference;
use accel::{Accel, AnyRays, Raster, Ray, RaySet, Scene, Workload};
use harness::guard::guard;
use harness::registry::{self, guarded_build};

/// How many of these rays hit something, asked for in every way that there is: nearest hit and any hit, together and alone,
/// and all crossings.
pub fn hits(built: &dyn Accel, rays: &RaySet) -> u64 {
    let mut hits = vec![None; rays.len()];
    let mut occluded = vec![false; rays.len()];
    built.trace(rays, &mut hits);
    built.trace_occluded(rays, &mut occluded);
    built.count(rays, false);
    built.count(rays, true);
    let found = |i: &usize| {
        let ray = rays.ray(*i);
        // All three are asked, whatever the first says.
        let alone = [built.closest(&ray).is_some(), built.occluded(&ray), !built.all_hits(&ray).is_empty()];
        hits[*i].is_some() || occluded[*i] || alone.contains(&true)
    };
    (0..rays.len()).filter(found).count() as u64
}

/// Has the structure `spec` trace a list of rays that are none, and returns how many.
///
/// Given to the structure as they are they have to come to an end; through [`AnyRays`] they have to hit nothing.
///
/// # Errors
/// A build that fails for another reason than memory, a panic, a hit.
pub fn hold(scene: &Scene, rays: &[Ray], spec: &str) -> Result<u64, Difference> {
    let set = RaySet::List(rays.to_vec());
    let Some(built) = traced(scene, &set, &Workload::GENERAL, spec)? else { return Ok(0) };
    let handed = AnyRays::new(built);
    let hits = handed.trace(rays).into_iter().map(|hit| hit.is_some());
    let together = hits.zip(handed.trace_occluded(rays));
    for (ray, (hit, occluded)) in rays.iter().zip(together) {
        let alone = handed.closest(ray).is_some() || handed.occluded(ray) || !handed.all_hits(ray).is_empty();
        if hit || occluded || alone {
            let what = "a ray that is none hits".to_owned();
            return Err(Difference { structure: spec.into(), ray: Some(*ray), what });
        }
    }
    Ok(rays.len() as u64)
}

/// Has the structure `spec`, built for an image whose rays are none, trace it, and returns how many rays that are.
///
/// # Errors
/// A build that fails for another reason than memory, a panic.
pub fn hold_image(scene: &Scene, raster: &Raster, spec: &str) -> Result<u64, Difference> {
    let workload = Workload { raster: Some(*raster), general: true };
    let built = traced(scene, &RaySet::Raster(*raster), &workload, spec)?;
    Ok(if built.is_some() { raster.len() as u64 } else { 0 })
}

/// The structure, once it has traced the rays in every way; none where memory does not suffice.
fn traced<'s>(
    scene: &'s Scene,
    rays: &RaySet,
    workload: &Workload,
    spec: &str,
) -> Result<Option<Box<dyn Accel + 's>>, Difference> {
    let wrong = |what: String| Difference { structure: spec.into(), ray: None, what };
    let choice = registry::parse(spec).map_err(|error| wrong(error.to_string()))?;
    let built = match guarded_build(&choice, scene, workload) {
        Ok(built) => built,
        Err(failure) if failure.is_too_large() => return Ok(None),
        Err(failure) => return Err(wrong(failure.to_string())),
    };
    guard("tracing", || hits(&*built, rays)).map_err(|panic| wrong(panic.to_string()))?;
    Ok(Some(built))
}

/// Rays that are none made of these, and an image of such rays, through a scene.
///
/// # Errors
/// Those of [`hold`] and [`hold_image`].
pub fn any(numbers: &mut impl Numbers, scene: &Scene, rays: &[Ray], spec: &str) -> Result<u64, Difference> {
    let spoiled: Vec<Ray> = rays.iter().map(|ray| cases::unusable(numbers, *ray)).collect();
    let asked = hold(scene, &spoiled, spec)?;
    let Some(image) = cases::small_image(numbers, scene, &cases::CLOSE) else { return Ok(asked) };
    let image = cases::unusable_image(numbers, image);
    Ok(asked + hold_image(scene, &image, spec)?)
}
