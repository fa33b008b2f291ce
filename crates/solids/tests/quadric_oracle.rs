//! How far quadrics in double precision are off, by the oracle that rounds nothing.

use accel::testing::{random, solid};
use accel::{Ray, Solid, Vec3};
use glam::DVec3;
use oracle::quadric_roots;
use solids::Crossings;

/// Steps from one `f32` to another.
fn steps(a: f32, b: f32) -> u32 {
    let key = |x: f32| if x < 0.0 { -i64::from(x.to_bits() & 0x7fff_ffff) } else { i64::from(x.to_bits()) };
    key(a).abs_diff(key(b)).try_into().unwrap_or(u32::MAX)
}

/// No root too many or too few, and where a line is all but a tangent the t of single precision off by more than a step.
///
/// Half of the rays graze the surface within 10^-7 to 10^-12 of the quadric's size, from up to 1000 sizes away. Compared is what
/// lies plainly within the box.
#[test]
fn plain_quadrics_err_at_tangents_alone() {
    let mut random = random(71);
    let (mut compared, mut roots, mut wrong, mut off) = (0, 0, 0, 0);
    let mut worst = 0.0f64;
    for i in 0..8000 {
        let mut point = || Vec3::new(random(), random(), random());
        let (center, aim, aside, far) = (point() * 3.0, point(), point(), point());
        let size = [0.5f32, 2f32.powi(-30), 2f32.powi(30)][i % 3];
        let object = solid("quadric", center * size, size, &mut random);
        let Solid::Quadric(quadric) = &object else { unreachable!("a quadric") };
        let (middle, reach) = (quadric.center(), f64::from(size));
        let direction = aim.as_dvec3().normalize_or(DVec3::X);
        let through = |at: DVec3| {
            let away = reach * 10f64.powf(f64::from(far.x * 1.5 + 1.5));
            Ray::new((at - direction * away).as_vec3(), (direction * f64::from(0.1 + far.y.abs())).as_vec3())
        };
        let mut ray = through(middle + aside.as_dvec3() * reach);
        if i % 2 == 0 {
            // Move the line to where it touches: a point of the surface with a normal across the direction, by Newton's steps.
            let mut p = middle + aside.as_dvec3() * reach;
            for _ in 0..40 {
                let from = p - middle;
                let gradient = quadric.half_gradient(from);
                p -= gradient * (quadric.value(from) / (2.0 * gradient.length_squared()));
                let normal = quadric.half_gradient(p - middle);
                let curved = quadric.half_gradient(direction) - quadric.half_gradient(DVec3::ZERO);
                let step = normal.dot(direction) / curved.dot(direction);
                if step.is_finite() && step.abs() < reach {
                    p -= direction * step;
                }
            }
            let normal = quadric.half_gradient(p - middle).normalize_or(DVec3::X);
            ray = through(p + normal * (reach * 10f64.powf(f64::from(far.z * 2.5 - 9.5))));
        }
        let (origin, along) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        // How far within the box a point is, in sizes.
        let depth = |t: f64| 1.0 - ((origin + along * t - middle) / reach).abs().max_element();
        let all = Ray { t_min: f32::MIN, ..ray };
        let exact = quadric_roots(&all, quadric).unwrap();
        let exact: Vec<f32> = exact.as_slice().iter().map(oracle::Root::to_f32).collect();
        let mut found = Vec::new();
        object.crossings(&all, &mut found);
        let found: Vec<f64> = found.iter().map(|crossing| crossing.t).collect();
        let doubtful = |t: f64| depth(t).abs() < 1e-3;
        if exact.iter().any(|t| doubtful(f64::from(*t))) {
            continue;
        }
        let exact: Vec<f32> = exact.into_iter().filter(|t| depth(f64::from(*t)) > 0.0).collect();
        let found: Vec<f64> = found.into_iter().filter(|t| depth(*t) > 1e-3).collect();
        compared += 1;
        roots += exact.len();
        wrong += usize::from(exact.len() != found.len());
        for (exact, found) in exact.iter().zip(&found) {
            let apart = steps(*exact, *found as f32);
            off += usize::from(apart > 0);
            let space = (f64::from(*exact) - found).abs() * along.length() / reach;
            worst = worst.max(if apart > 1 { space } else { 0.0 });
        }
    }
    println!(
        "{compared} rays, {roots} roots: {wrong} miscounted, {off} rounded otherwise, by {worst:e} of a size"
    );
    assert!(compared > 4000 && roots > 4000, "{compared} rays, {roots} roots");
    assert!(wrong == 0 && off * 100 < roots && worst < 1e-4, "{wrong} miscounted, {off} off, by {worst}");
}
