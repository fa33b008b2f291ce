//! Builds that are cancelled, limited, repeated or done by many threads.

use super::group::Group;
use super::subject::{Subject, Verdict};
use crate::cases::{self, CLOSE, Shape};
use crate::compare::same;
use accel::{Cancel, Ray, RaySet, Scene, Workload};
use harness::registry::{Choice, guarded_build, guarded_build_unless};
use primitives::KernelId;
use scenes::Random;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

pub(super) const GROUPS: &[Group] = &[
    Group { name: "builds/limited", about: "built within any limit of memory, or an error", ask: limited },
    Group { name: "builds/threads", about: "eight threads build at a time: the same answers", ask: threads },
    Group { name: "builds/memory", about: "built and dropped: memory is back to what it was", ask: memory },
    Group {
        name: "builds/cancelled",
        about: "cancelled whenever it looks: an error, nothing kept",
        ask: cancelled,
    },
];

fn case() -> (Scene, Vec<Ray>) {
    let mut numbers = Random::new(40);
    let scene = cases::scene_of(&mut numbers, Shape::Mixed, &CLOSE, 2000).expect("a sound shape");
    let rays = cases::rays(&mut numbers, &scene, &CLOSE, 128);
    (scene, rays)
}

fn cancelled(subject: &Subject) -> Verdict {
    let (scene, _) = case();
    let choice = subject.choice(KernelId::Exact);
    let mut checks = 0;
    // Each moment at first, then fewer and fewer of them.
    let mut moment = 0;
    loop {
        let looked = AtomicU64::new(0);
        let asked = || looked.fetch_add(1, Relaxed) >= moment;
        match guarded_build_unless(&choice, &scene, &Workload::GENERAL, Cancel::when(&asked)) {
            Ok(_) => return Verdict::Passed { checks },
            Err(failure) if failure.is_cancelled() => checks += 1,
            Err(failure) => return Verdict::Wrong { what: format!("at moment {moment}: {failure}") },
        }
        moment += 1 + moment / 8;
    }
}

/// Bytes by which a build may exceed its limit: what threads and the library allocate once.
const ROOM: u64 = 64 << 10;

fn limited(subject: &Subject) -> Verdict {
    if !subject.takes("memory") {
        return Verdict::NotAsked { why: "it takes no limit" };
    }
    let (scene, _) = case();
    let mut checks = 0;
    for power in 10..28 {
        let limit = 1u64 << power;
        let spec = subject.spec(KernelId::Exact, Some(("memory", &limit.to_string())));
        let choice = match Choice::of(subject.entry, &spec) {
            Ok(choice) => choice,
            Err(error) => return Verdict::Wrong { what: error.to_string() },
        };
        let (built, used) = heap::observe(|| guarded_build(&choice, &scene, &Workload::GENERAL).map(drop));
        let peak = used.map_or(0, |used| used.peak);
        if peak > limit + limit / 20 + ROOM {
            return Verdict::Wrong { what: format!("with {limit} bytes it takes {peak}") };
        }
        match built {
            Ok(()) => checks += 1,
            Err(failure) if failure.is_too_large() => checks += 1,
            Err(failure) => return Verdict::Wrong { what: failure.to_string() },
        }
    }
    Verdict::Passed { checks }
}

fn threads(subject: &Subject) -> Verdict {
    let (scene, rays) = case();
    let choice = subject.choice(KernelId::Exact);
    let set = RaySet::List(rays);
    let answers = || {
        let mut hits = vec![None; set.len()];
        let built =
            guarded_build(&choice, &scene, &Workload::GENERAL).map_err(|failure| failure.to_string())?;
        built.trace(&set, &mut hits);
        Ok::<_, String>(hits)
    };
    let all: Vec<_> = std::thread::scope(|scope| {
        let builders: Vec<_> = (0..8).map(|_| scope.spawn(answers)).collect();
        builders
            .into_iter()
            .map(|builder| builder.join().unwrap_or_else(|_| Err("it panicked".into())))
            .collect()
    });
    let mut first = None;
    for hits in all {
        match (hits, &first) {
            (Err(what), _) => return Verdict::Wrong { what },
            (Ok(hits), None) => first = Some(hits),
            (Ok(hits), Some(first)) if hits.iter().zip(first).all(|(a, b)| same(a, b)) => {}
            (Ok(_), Some(_)) => return Verdict::Wrong { what: "answers depend on who builds".into() },
        }
    }
    Verdict::Passed { checks: 8 }
}

fn memory(subject: &Subject) -> Verdict {
    if !subject.entry.traits.counted {
        return Verdict::NotAsked { why: "its library takes memory of its own" };
    }
    if !heap::counting() {
        return Verdict::NotAsked { why: "this program does not count its memory" };
    }
    let (scene, _) = case();
    let choice = subject.choice(KernelId::Exact);
    // What a library or a thread allocates once, at its first use, belongs to no structure.
    let left = (0..4).filter_map(|_| {
        let build = || guarded_build(&choice, &scene, &Workload::GENERAL).map(drop);
        Some(heap::observe(build).1?.left.abs())
    });
    match left.min() {
        Some(0) => Verdict::Passed { checks: 4 },
        left => Verdict::Wrong { what: format!("{} bytes are left", left.unwrap_or_default()) },
    }
}
