//! Every structure by hand, without the registry: build it, ask it for one ray and for one image.
//!
//! `cargo run --release --example structures`

use accel::{Builder, Ray, RaySet, Vec3, Workload};
use scenes::rays::perspective;
use std::error::Error;

fn builders() -> Vec<Box<dyn Builder>> {
    vec![
        Box::new(baselines::MinMax { kernel: primitives::KernelId::MollerTrumbore }),
        Box::new(bmssm::suite::dense::BmssmDense::default()),
        Box::new(bmssm::suite::fast::Bmssm::default()),
        Box::new(ssm::suite::SsmList::default()),
        Box::new(ssm::suite::Ssm::default()),
        Box::new(adapter_obvhs::ObvhsBuilder::new(adapter_obvhs::Variant::CwBvh)),
        #[cfg(feature = "embree")]
        Box::new(adapter_embree::EmbreeBuilder::new(adapter_embree::Variant::Plain)),
    ]
}

/// Runs the example.
pub fn main() -> Result<(), Box<dyn Error>> {
    // A scene by its name; a path to an OBJ file does as well.
    let scene = scenes::load(&"bumps-2k".parse()?)?;
    for builder in builders() {
        // Any rays: the structure is built for all of them.
        let accel = builder.build(&scene, &Workload::GENERAL)?;
        let ray = Ray::new(Vec3::new(0.0, 0.0, 9.0), Vec3::NEG_Z);
        let hit = accel.closest(&ray).ok_or("the ray meets the sphere")?;
        println!("{}: triangle {} at t = {}", builder.id(), hit.object, hit.t);
        assert!(accel.occluded(&ray));

        // One image: the structure is built for its primary rays alone.
        let raster = perspective(&scene.view, 48, 64);
        let image = builder.build(&scene, &Workload::raster(raster))?;
        let mut hits = vec![None; raster.len()];
        image.trace(&RaySet::Raster(raster), &mut hits);
        println!("  {} of {} pixels hit", hits.iter().flatten().count(), hits.len());

        // What it holds in memory, part by part.
        for part in accel.footprint().parts {
            println!("  {:<12} {} bytes", part.name, part.bytes);
        }
    }
    Ok(())
}
