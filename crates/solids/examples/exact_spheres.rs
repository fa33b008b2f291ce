//! Holds the exact test of spheres to the oracle, ray by ray: `exact_spheres [RAYS]`, by default 2,000,000.
//!
//! Every second ray grazes its sphere. Of the plain test it tells how often it errs on the same rays.

use accel::testing::spheres_and_rays;
use accel::{Objects, Solid};
use solids::{Solids, exact};
use std::process::ExitCode;

fn main() -> ExitCode {
    let count = std::env::args().nth(1).map_or(Ok(2_000_000), |count| count.parse());
    let Ok(count) = count else {
        eprintln!("usage: exact_spheres [RAYS]");
        return ExitCode::from(2);
    };
    let (mut hits, mut differences, mut plain_hits, mut plain_digits) = (0u32, 0u32, 0u32, 0u32);
    for (sphere, ray) in spheres_and_rays(count) {
        let expected = oracle::intersect_sphere(&ray, &sphere);
        let found = exact::nearest(&sphere, &ray, ray.t_max);
        if found.map(f32::to_bits) != expected.map(f32::to_bits) {
            differences += 1;
            println!("{sphere:?} {ray:?}: {found:?}, not {expected:?}");
        }
        let all = [Solid::Sphere(sphere)];
        let plain = Solids::new(&all).intersect(0, &ray, ray.t_max).map(|hit| hit.t);
        hits += u32::from(expected.is_some());
        plain_hits += u32::from(plain.is_some() != expected.is_some());
        plain_digits += u32::from(plain.is_some() && expected.is_some() && plain != expected);
    }
    println!("{count} rays, {hits} hits: the exact test differs from the oracle on {differences}");
    println!(
        "the plain test tells a hit for a miss or the reverse on {plain_hits}, another t on {plain_digits}"
    );
    ExitCode::from(u8::from(differences != 0))
}
