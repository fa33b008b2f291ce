//! Bit maps of space subdivision as the paper prints them (Skala 1993, §2, §5).
//!
//! `cargo run --release --example bmssm_dense`

use accel::{Builder, Need, Ray, RaySet, Vec3};
use bmssm::suite::dense::BmssmDense;
use scenes::rays::perspective;
use std::error::Error;

/// Runs the example.
pub fn main() -> Result<(), Box<dyn Error>> {
    // A scene by its name; a path to an OBJ file does as well.
    let scene = scenes::load(&"bumps-2k".parse()?)?;

    // Any rays: this structure is built for all of them.
    let builder = BmssmDense::default();
    let accel = builder.build(&scene, &Need::GENERAL)?;
    let ray = Ray::new(Vec3::new(0.0, 0.0, 9.0), Vec3::NEG_Z);
    let hit = accel.closest(&ray).ok_or("the ray meets the sphere")?;
    println!("{}: triangle {} at t = {}", builder.id(), hit.object, hit.t);
    assert!(accel.occluded(&ray));

    // One image: the structure is built for its primary rays alone.
    let raster = perspective(&scene.view, 48, 64);
    let image = builder.build(&scene, &Need::raster(raster))?;
    let mut hits = vec![None; raster.len()];
    image.trace(&RaySet::Raster(raster), &mut hits);
    println!("{} of {} pixels hit", hits.iter().flatten().count(), hits.len());

    // What it holds in memory, part by part.
    for part in accel.footprint().parts {
        println!("{:<12} {} bytes", part.name, part.bytes);
    }
    Ok(())
}
