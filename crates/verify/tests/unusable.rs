//! Random rays that are none, through random scenes by structures with any settings: an end, and no hit.

use primitives::KernelId;
use scenes::Random;
use std::time::Duration;
use verify::cases::{self, Reach, WIDE};
use verify::{Numbers, patience, unusable};

/// Scenes, each with so many rays and an image.
const SCENES: u32 = 400;
const RAYS: usize = 40;

fn run(seed: u64, scenes: u32) -> u64 {
    let mut numbers = Random::new(seed);
    let mut asked = 0;
    for _ in 0..scenes {
        let reach = Reach::new(&mut numbers, &WIDE);
        let kernel = Numbers::one_of(&mut numbers, &KernelId::ALL);
        let spec = cases::structure(&mut numbers, kernel, 12);
        let scene = if Numbers::below(&mut numbers, 4) == 0 {
            cases::solids(&mut numbers, &cases::KINDS, 24)
        } else {
            let Ok((_, scene)) = cases::scene(&mut numbers, &reach, 100) else { continue };
            scene
        };
        let rays = cases::rays(&mut numbers, &scene, &reach, RAYS);
        asked += unusable::any(&mut numbers, &scene, &rays, &spec)
            .unwrap_or_else(|wrong| panic!("{wrong}\n{scene:?}"));
    }
    asked
}

#[test]
fn every_walk_ends_and_nothing_is_hit() {
    let asked = patience::within(Duration::from_secs(120), || run(1, SCENES));
    assert!(asked.expect("a walk does not end") > 20_000);
}
