//! Rays that are none, or come from far away.

use super::group::Group;
use super::subject::{Subject, Verdict};
use crate::cases::{self, CLOSE, Reach, Shape};
use crate::{patience, unusable};
use accel::{Builder, Ray, Scene, Vec3, Workload};
use baselines::Brute;
use lanes::Level;
use primitives::KernelId;
use scenes::Random;
use std::time::Duration;

pub(super) const GROUPS: &[Group] = &[
    Group { name: "rays/inactive", about: "ranges that end before they begin hit nothing", ask: inactive },
    Group {
        name: "rays/nan",
        about: "no rays, and images of them: every walk ends, nothing is hit",
        ask: none,
    },
    Group { name: "rays/far", about: "origins 2^10 to 2^60 times the scene's size away", ask: far },
    Group { name: "rays/random", about: "random rays through random scenes", ask: random },
    Group { name: "rays/all-hits", about: "every crossing, in order, and once", ask: all_hits },
    Group { name: "rays/instructions", about: "every instruction set of the machine", ask: instructions },
];

fn case(seed: u64, reach: &Reach, count: usize) -> (Scene, Vec<Ray>) {
    let mut numbers = Random::new(seed);
    let scene = cases::scene_of(&mut numbers, Shape::Scattered, reach, 150).expect("a sound shape");
    let rays = cases::rays(&mut numbers, &scene, reach, count);
    (scene, rays)
}

fn inactive(subject: &Subject) -> Verdict {
    let (scene, rays) = case(3, &CLOSE, 512);
    let ended = |ray: &Ray| Ray { t_min: 2.0, t_max: 1.0, ..*ray };
    subject.hits_nothing(&scene, &rays.iter().map(ended).collect::<Vec<_>>())
}

/// A question that has not ended by then never will: it takes a second.
const PATIENCE: Duration = Duration::from_secs(120);

fn none(subject: &Subject) -> Verdict {
    let subject = *subject;
    let asked = patience::within(PATIENCE, move || {
        let verdict = each_way_to_be_none(&subject);
        if subject.is_built_in() { verdict.and(any_that_are_none(&subject)) } else { verdict }
    });
    asked.unwrap_or_else(|| Verdict::Wrong { what: format!("no end after {PATIENCE:?}") })
}

/// Rays that are none in several ways at a time, and images of them, in each of the settings that checks try.
fn any_that_are_none(subject: &Subject) -> Verdict {
    let mut numbers = Random::new(7);
    subject.entry.tried().fold(Verdict::Passed { checks: 0 }, |verdict, settings| {
        let spec = format!("{}:{settings}", subject.entry.id);
        (50..54).fold(verdict, |verdict, seed| {
            let (triangles, rays) = case(seed, &CLOSE, 64);
            let solids = cases::solids(&mut numbers, &cases::KINDS, 48);
            let scenes = [triangles, solids];
            let asked = scenes.iter().try_fold(0, |asked, scene| {
                unusable::any(&mut numbers, scene, &rays, &spec).map(|more| asked + more)
            });
            verdict.and(Verdict::of(asked.map_err(|wrong| wrong.to_string())))
        })
    })
}

/// Each part of sound rays replaced by each number that is none.
fn each_way_to_be_none(subject: &Subject) -> Verdict {
    let (scene, rays) = case(4, &CLOSE, 32);
    let mut all = Vec::new();
    for ray in &rays {
        for axis in 0..3 {
            for value in [f32::NAN, f32::INFINITY] {
                let (mut origin, mut direction) = (*ray, *ray);
                origin.origin[axis] = value;
                direction.direction[axis] = value;
                all.extend([origin, direction]);
            }
        }
        all.push(Ray { direction: Vec3::ZERO, ..*ray });
        all.push(Ray { t_min: f32::NAN, ..*ray });
        all.push(Ray { t_max: f32::NAN, ..*ray });
    }
    subject.hits_nothing(&scene, &all)
}

fn far(subject: &Subject) -> Verdict {
    let none = if subject.is_built_in() {
        Verdict::Passed { checks: 0 }
    } else {
        Verdict::Counted { checks: 0, wrong: 0 }
    };
    [10, 20, 30, 40, 52, 60].into_iter().fold(none, |verdict, origins| {
        let (scene, rays) = case(5, &Reach { origins, ..CLOSE }, 256);
        verdict.and(subject.holds(&scene, &rays, KernelId::Exact))
    })
}

fn random(subject: &Subject) -> Verdict {
    let none = if subject.is_built_in() {
        Verdict::Passed { checks: 0 }
    } else {
        Verdict::Counted { checks: 0, wrong: 0 }
    };
    (10..22).fold(none, |verdict, seed| {
        let (scene, rays) = case(seed, &CLOSE, 512);
        let kernel = if seed % 2 == 0 { KernelId::Exact } else { KernelId::MollerTrumbore };
        verdict.and(subject.holds(&scene, &rays, kernel))
    })
}

fn all_hits(subject: &Subject) -> Verdict {
    let mut verdict = Verdict::Passed { checks: 0 };
    for seed in 30..38 {
        let (scene, rays) = case(seed, &CLOSE, 512);
        let kernel = if seed % 2 == 0 { KernelId::Exact } else { KernelId::MollerTrumbore };
        let built = match subject.build_with(&scene, kernel) {
            Ok(built) => built,
            Err(failure) => return Verdict::Wrong { what: failure.to_string() },
        };
        if !built.candidates(&rays[0], &mut Vec::new()) {
            return Verdict::NotAsked { why: "it tells nearest hits only" };
        }
        let brute = Brute::new(kernel).build(&scene, &Workload::GENERAL).expect("brute force");
        let wrong = rays.iter().find_map(|ray| crate::compare::all_hits(&*brute, &*built, ray).err());
        verdict = verdict.and(Verdict::of(wrong.map_or(Ok(rays.len() as u64), Err)));
    }
    verdict
}

fn instructions(subject: &Subject) -> Verdict {
    if !subject.takes("simd") {
        return Verdict::NotAsked { why: "it chooses its instructions itself" };
    }
    let (scene, rays) = case(6, &CLOSE, 512);
    Level::ALL.into_iter().filter(|level| level.available()).fold(
        Verdict::Passed { checks: 0 },
        |verdict, level| {
            let spec = subject.spec(KernelId::Exact, Some(("simd", level.id()))).to_string();
            let compared = crate::compare::compare(&scene, &rays, &spec, 64);
            verdict.and(Verdict::of(compared.map(|done| done.rays).map_err(|wrong| wrong.to_string())))
        },
    )
}
