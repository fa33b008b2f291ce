//! A structure of your own behind `Accel`, held to brute force: objects sorted by how far along x
//! their boxes begin, so that a ray need not look at those that begin beyond its end.
//!
//! `cargo run --release --example own_structure`

use accel::{Accel, Builder, Footprint, Geometry, Hit, Mesh, Nearest, Need, Objects, Ray};
use baselines::Brute;
use primitives::KernelId;
use primitives::Triangles;
use scenes::rays;
use std::error::Error;

struct Sorted<'s> {
    objects: Triangles<'s, primitives::kernel::MollerTrumbore>,
    order: Vec<(f32, u32)>, // the least x of an object's box, and the object; ascending
}

impl<'s> Sorted<'s> {
    fn new(mesh: &'s Mesh) -> Self {
        let objects = Triangles::new(mesh);
        let mut order: Vec<_> = (0..objects.len() as u32).map(|id| (objects.bounds(id).min.x, id)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { objects, order }
    }
}

impl Accel for Sorted<'_> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        // A ray that runs towards lesser x never gets beyond its origin.
        let backward = ray.direction.x <= 0.0 && ray.t_min >= 0.0;
        let reach = if backward { ray.origin.x } else { f32::INFINITY };
        let mut nearest = Nearest::new(ray.t_max);
        for (_, id) in self.order.iter().take_while(|(x, _)| *x <= reach) {
            if let Some(surface) = self.objects.intersect(*id, ray, nearest.t) {
                nearest.offer(*id, surface);
            }
        }
        nearest.hit()
    }

    fn footprint(&self) -> Footprint {
        Footprint::default().structure("order", accel::vec_bytes(&self.order))
    }
}

/// Runs the example.
pub fn main() -> Result<(), Box<dyn Error>> {
    let scene = scenes::load(&"small-1k".parse()?)?;
    let Geometry::Triangles(mesh) = &scene.geometry else { return Err("a scene of triangles".into()) };
    let own = Sorted::new(mesh);
    let brute = Brute::new(KernelId::MollerTrumbore).build(&scene, &Need::GENERAL)?;
    let spec = rays::RaysSpec { id: rays::RaysId::Random, rows: 32, cols: 32, seed: 1 };
    let rays = rays::generate(&scene, &spec, brute.as_ref())?;
    let (mut hits, mut expected) = (vec![None; rays.len()], vec![None; rays.len()]);
    own.trace(&rays, &mut hits);
    brute.trace(&rays, &mut expected);
    assert_eq!(hits, expected, "a structure loses and invents nothing");
    println!("{} rays agree; {} bytes", hits.len(), own.footprint().total());
    Ok(())
}
