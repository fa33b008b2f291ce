//! A structure of your own, registered and held to brute force as the suite's own are: objects sorted by where along x
//! their boxes begin, so that a ray need not look at those that begin beyond its end.
//!
//! `cargo run --release --example own_structure`

use accel::{Accel, BuildError, Builder, Footprint, Hit, Nearest, Objects, Ray, Scene, Workload};
use harness::registry::{Choice, Entry, KERNEL, Traits};
use harness::sweeps::differences::{self, Sweep};
use harness::workload::Subject;
use lanes::PackedObjects;
use primitives::{KernelId, WithObjects, with_objects};
use scenes::rays::RaysId;
use std::error::Error;

struct Sorted<O> {
    objects: O,
    order: Vec<(f32, u32)>, // where an object's box begins, and the object; ascending
}

impl<O: Objects> Accel for Sorted<O> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        // A ray that runs towards lesser x never gets beyond its origin.
        let backward = ray.direction.x <= 0.0 && ray.t_min >= 0.0;
        let reach = if backward { ray.origin.x } else { f32::INFINITY };
        let mut best = Nearest::new(ray.t_max);
        for (_, id) in self.order.iter().take_while(|(x, _)| *x <= reach) {
            self.objects.closest(*id, ray, &mut best);
        }
        best.hit()
    }

    fn footprint(&self) -> Footprint {
        Footprint::default().structure("order", accel::vec_bytes(&self.order))
    }
}

struct Sort(KernelId);

impl Builder for Sort {
    fn id(&self) -> &str {
        "sorted"
    }

    fn settings(&self) -> String {
        format!("kernel={}", self.0)
    }

    fn build<'s>(&self, scene: &'s Scene, _: &Workload) -> Result<Box<dyn Accel + 's>, BuildError> {
        Ok(with_objects(scene, self.0, Sort(self.0)))
    }
}

impl<'s> WithObjects<'s> for Sort {
    type Out = Box<dyn Accel + 's>;

    fn objects<O: PackedObjects + 's>(self, objects: O) -> Self::Out {
        let mut order: Vec<_> = (0..objects.len() as u32).map(|id| (objects.bounds(id).min.x, id)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        Box::new(Sorted { objects, order })
    }
}

/// In the suite this stands in a file of `crates/harness/src/registry/entries/`.
static ENTRY: Entry = Entry {
    description: "objects sorted along x",
    settings: &[KERNEL],
    traits: Traits { linear: true, ..Traits::BUILT_IN },
    variants: &["kernel=watertight"],
    ..Entry::new("sorted", |settings| Ok(Box::new(Sort(settings.kernel()?))))
};

/// Runs the example.
pub fn main() -> Result<(), Box<dyn Error>> {
    let choices =
        [Choice::of(&ENTRY, &"sorted".parse()?)?, Choice::of(&ENTRY, &"sorted:kernel=exact".parse()?)?];
    let scenes = ["small-1k", "boxes-100-40", "unit-equal", "unit-flat"].map(str::to_owned).to_vec();
    let rays = RaysId::ALL.to_vec();
    let sweep = Sweep { subject: Subject { scenes, rays, size: 16, seed: 1 }, rays_each: 0, tests: 1 << 22 };
    let tally = differences::run(&sweep, &choices, ())?;
    for row in &tally.structures {
        println!("{}: {} rays, {} differ from brute force", row.structure, row.rays, row.differences);
    }
    assert!(tally.is_sound(), "{:?}", tally.findings);
    Ok(())
}
