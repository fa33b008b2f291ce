//! Planted faults must be found.

use super::*;
use crate::answers::Answers;
use crate::record::Query;
use crate::testing;
use ::judge::{Judge, Tolerance};
use accel::{Accel, Footprint, Hit, Ray, RaySet, Scene, Workload};
use primitives::KernelId;

/// A structure that is right but for every 1000th ray of a trace.
struct Faulty<'a> {
    inner: Box<dyn Accel + 'a>,
    fault: fn(Option<Hit>) -> Option<Hit>,
}

impl Accel for Faulty<'_> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.inner.closest(ray)
    }

    fn trace(&self, rays: &RaySet, hits: &mut [Option<Hit>]) {
        self.inner.trace(rays, hits);
        hits.iter_mut().skip(499).step_by(1000).for_each(|hit| *hit = (self.fault)(*hit));
    }

    fn trace_occluded(&self, rays: &RaySet, any: &mut [bool]) {
        self.inner.trace_occluded(rays, any);
        any.iter_mut().skip(499).step_by(1000).for_each(|any| *any = !*any);
    }

    fn footprint(&self) -> Footprint {
        self.inner.footprint()
    }
}

const ALL: u64 = u64::MAX;

fn differences(
    scene: &Scene,
    rays: &RaySet,
    query: Query,
    fault: fn(Option<Hit>) -> Option<Hit>,
) -> Vec<usize> {
    let choice = crate::registry::parse("minmax").unwrap();
    let inner = choice.builder.build(scene, &Workload::GENERAL).unwrap();
    let mut answers = Answers::new(query, rays.len());
    answers.trace(&Faulty { inner, fault }, rays);
    compare(&answers, &Reference::new(scene, rays, query, KernelId::MollerTrumbore, ALL))
}

#[test]
fn sound_structures_have_no_difference() {
    let (scene, rays) = testing::cloud(300, 4000);
    for query in [Query::Closest, Query::Occluded] {
        assert!(
            differences(&scene, &rays, query, |hit| hit).len() == if query == Query::Closest { 0 } else { 4 }
        );
    }
}

#[test]
fn lost_hits_invented_hits_and_wrong_hits_are_found() {
    // From inside a closed mesh every ray hits, so that every planted loss is one.
    let (scene, rays) = testing::from_inside(4000);
    let expected = [499, 1499, 2499, 3499];
    assert_eq!(differences(&scene, &rays, Query::Closest, |_| None), expected, "lost");
    assert_eq!(differences(&scene, &rays, Query::Closest, |_| Some(hit_of(1.0))), expected, "moved");
    let other = |h: Option<Hit>| h.map(|h| Hit { object: h.object + 1, ..h });
    assert_eq!(differences(&scene, &rays, Query::Closest, other), expected, "another object");
    let near = |h: Option<Hit>| h.map(|h| Hit { t: h.t.next_up(), ..h });
    assert_eq!(differences(&scene, &rays, Query::Closest, near), expected, "one unit in the last place of t");
    let weight = |h: Option<Hit>| h.map(|h| Hit { u: h.u + 0.125, ..h });
    assert_eq!(differences(&scene, &rays, Query::Closest, weight), expected, "another u");
    assert_eq!(differences(&scene, &rays, Query::Occluded, |h| h), expected, "occlusion");
    // All rays away from the scene: what is reported is invented.
    let away = testing::away(2000);
    assert_eq!(differences(&scene, &away, Query::Closest, |_| Some(hit_of(1.0))), [499, 1499], "invented");
}

fn hit_of(t: f32) -> Hit {
    Hit { t, object: 0, u: 0.0, v: 0.0 }
}

#[test]
fn a_sample_compares_what_it_says() {
    let (scene, rays) = testing::from_inside(4000);
    let reference = Reference::new(
        &scene,
        &rays,
        Query::Closest,
        KernelId::MollerTrumbore,
        100 * scene.geometry.len() as u64,
    );
    assert_eq!(reference.numbers.len(), 100);
    let mut wrong = Answers::new(Query::Closest, rays.len());
    assert_eq!(compare(&wrong, &reference), reference.numbers, "answers never written differ");
    let choice = crate::registry::parse("brute").unwrap();
    wrong.trace(choice.builder.build(&scene, &Workload::GENERAL).unwrap().as_ref(), &rays);
    assert!(compare(&wrong, &reference).is_empty());
}

#[test]
fn wrong_answers_are_told_apart_by_the_oracle() {
    let (scene, inside) = testing::from_inside(600);
    let oracle = Judge::new(&scene, Tolerance::VISIBLE);
    let choice = crate::registry::parse("brute:kernel=watertight").unwrap();
    let mut answers = Answers::new(Query::Closest, inside.len());
    answers.trace(choice.builder.build(&scene, &Workload::GENERAL).unwrap().as_ref(), &inside);
    let all: Vec<usize> = (0..inside.len()).collect();
    let mut hits = answers.closest().unwrap().to_vec();
    let sound = judge(&oracle, &inside, &hits, &all);
    assert_eq!((sound.missed, sound.false_hits, sound.wrong_object), (0, 0, 0));
    assert!(sound.t_ulp_max < 64.0 && sound.rays_exact == 600, "{sound:?}");
    hits[3] = None;
    hits[4] = None;
    hits[7].as_mut().unwrap().object ^= 1;
    hits[9].as_mut().unwrap().t *= 1.5;
    let found = judge(&oracle, &inside, &hits, &all);
    assert_eq!((found.missed, found.false_hits, found.wrong_object), (2, 0, 1));
    assert!(found.t_ulp_max > 1e6);
    let away = testing::away(10);
    let invented = judge(&oracle, &away, &[Some(hit_of(1.0)); 10], &[0, 5]);
    assert_eq!((invented.false_hits, invented.rays_exact), (2, 2));
}
