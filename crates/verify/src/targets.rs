//! What a fuzzer calls: any bytes in, no panic, no hang, no wrong answer.

use crate::cases::{self, Reach, WIDE};
use crate::compare::compare;
use crate::{Bytes, Numbers, unusable};
use harness::record::{from_text, to_text};
use harness::registry::{StructureSpec, choose};
use primitives::KernelId;
use scenes::Random;
use scenes::exchange::read_rays;
use std::path::Path;

/// A target: what it is called, and what it does with bytes.
pub type Target = (&'static str, fn(&[u8]));

/// All targets; each is a binary in `fuzz/`, and a folder of its corpus.
pub const ALL: [Target; 7] = [
    ("obj", obj),
    ("ply", ply),
    ("rays", rays),
    ("scene", scene),
    ("record", record),
    ("settings", settings),
    ("structures", structures),
];

/// Has the calling thread do all work itself: for a process that runs one small case after the other, waking another
/// thread for each step takes longer than the step. To be called before anything else.
pub fn work_alone() {
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    // There is a pool where tests called a target before: it does as well.
    let _ = alone.build_global();
}

/// Bytes that readers get at most: more only take longer.
const MAX: usize = 1 << 16;

fn mesh(name: &str, bytes: &[u8]) {
    let read = scenes::mesh_of_bytes(Path::new(name), &bytes[..bytes.len().min(MAX)]);
    let Ok(scenes::Polygons { mesh, .. }) = read else { return };
    assert!(!mesh.triangles.is_empty() && mesh.positions.iter().all(|p| p.is_finite()));
    assert!(mesh.triangles.iter().flatten().all(|index| (*index as usize) < mesh.positions.len()));
}

/// A Wavefront OBJ.
pub fn obj(bytes: &[u8]) {
    mesh("case.obj", bytes);
}

/// An ASCII PLY.
pub fn ply(bytes: &[u8]) {
    mesh("case.ply", bytes);
}

/// Rays as CSV: what is read is sound, and reads back the same.
pub fn rays(bytes: &[u8]) {
    let Ok(rays) = read_rays(bytes) else { return };
    let mut text = String::new();
    for ray in &rays {
        assert!(ray.validate().is_ok(), "{ray:?}");
        let [o, d] = [ray.origin, ray.direction];
        text += &format!("{},{},{},{},{},{},{},{}\n", o.x, o.y, o.z, d.x, d.y, d.z, ray.t_min, ray.t_max);
    }
    assert_eq!(read_rays(text.as_bytes()).expect("rays that were read once"), rays);
}

/// A scene definition in TOML.
pub fn scene(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(definition) = scenes::Definition::parse(text) else { return };
    if let Some(generator) = definition.generator.filter(|generator| generator.objects_bound() <= 1 << 10) {
        // A refusal is as good; a panic is not.
        let _ = generator.build(definition.seed);
    }
}

/// A record in JSON.
pub fn record(bytes: &[u8]) {
    let path = Path::new("record.json");
    let Ok(text) = std::str::from_utf8(&bytes[..bytes.len().min(MAX)]) else { return };
    let Ok(record) = from_text(path, text) else { return };
    let text = to_text(&record).expect("a record that was read");
    assert_eq!(from_text(path, &text).expect("a record that was written"), record);
}

/// A structure with settings: what a built-in one says that they are reads back the same.
pub fn settings(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(spec) = text.parse::<StructureSpec>() else { return };
    assert_eq!(spec.to_string().parse(), Ok(spec.clone()));
    let Ok(choice) = choose(&spec) else { return };
    // Libraries say what they do in words of their own.
    if !choice.entry.traits.built_in {
        return;
    }
    let all = choice.builder.settings();
    let again = format!("{}:{all}", spec.id).parse().expect("settings as they are written");
    assert_eq!(choose(&again).expect("settings that were taken once").builder.settings(), all);
}

/// A scene, rays and settings: a built-in structure against brute force, and that now and then against the oracle; rays that are none
/// now and then.
///
/// All is small, as many small cases find more than few large ones: the marathon has those.
pub fn structures(bytes: &[u8]) {
    let mut numbers = Bytes(bytes);
    let reach = Reach::new(&mut numbers, &WIDE);
    let kernel = numbers.one_of(&KernelId::ALL);
    let mut spec = cases::structure(&mut numbers, kernel, 12);
    // To ask the system takes longer than all else; no grid of so few cells comes near.
    if !["minmax", "sphere"].iter().any(|id| spec.starts_with(id)) {
        spec += ",memory=1000000000";
    }
    // Up to three blocks, mostly one.
    let most = if numbers.below(16) == 0 { 140 } else { 16 };
    let Ok((_, scene)) = cases::scene(&mut numbers, &reach, most) else { return };
    let count = 1 + numbers.below(4) as usize;
    let rays = cases::rays(&mut numbers, &scene, &reach, count);
    let true_answers = usize::from(numbers.below(8) == 0);
    if let Err(difference) = compare(&scene, &rays, &spec, true_answers) {
        panic!("{difference}\n{scene:?}");
    }
    // One case in 16 has its rays spoiled too; half of these meet solids instead. It takes as long as many others.
    let spoiled = match numbers.below(32) {
        1 => unusable::any(&mut numbers, &scene, &rays, &spec),
        2 => {
            let mut random = Random::new(numbers.bits().into());
            let scene = cases::solids(&mut random, &cases::KINDS, 1 + numbers.below(16));
            unusable::any(&mut numbers, &scene, &rays, &spec)
        }
        _ => return,
    };
    if let Err(difference) = spoiled {
        panic!("{difference}\n{scene:?}");
    }
}
