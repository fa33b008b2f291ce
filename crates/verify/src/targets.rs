//! What a fuzzer calls: any bytes in, no panic, no hang, no wrong answer.

use crate::cases::{self, Reach, WIDE};
use crate::compare::compare;
use crate::{Bytes, Numbers};
use harness::registry::StructureSpec;
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

/// Bytes that readers get at most: more only take longer.
const MOST: usize = 1 << 16;

/// Writes the bytes to a file of that name and lets `read` have it.
fn as_file(name: &str, bytes: &[u8], read: impl FnOnce(&Path)) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    std::fs::write(&path, &bytes[..bytes.len().min(MOST)]).expect("a temporary file");
    read(&path);
}

fn mesh(name: &str, bytes: &[u8]) {
    as_file(name, bytes, |path| {
        let Ok(polygons) = scenes::load_mesh(path) else { return };
        let positions = polygons.mesh.positions.len();
        assert!(!polygons.mesh.triangles.is_empty() && polygons.mesh.positions.iter().all(|p| p.is_finite()));
        assert!(polygons.mesh.triangles.iter().flatten().all(|index| (*index as usize) < positions));
    });
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
    if let Some(generator) = definition.generator.filter(|generator| generator.objects_bound() <= 1 << 12) {
        // A refusal is as good; a panic is not.
        let _ = generator.build(definition.seed);
    }
}

/// A record in JSON.
pub fn record(bytes: &[u8]) {
    as_file("record.json", bytes, |path| {
        let Ok(record) = harness::record::read(path) else { return };
        harness::record::write(path, &record).expect("a record that was read");
        let again = harness::record::read(path).expect("a record that was written");
        assert_eq!(serde_json::to_string(&again).ok(), serde_json::to_string(&record).ok());
    });
}

/// A structure with settings.
pub fn settings(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(spec) = text.parse::<StructureSpec>() else { return };
    if let Ok(choice) = harness::registry::choose(&spec) {
        assert!(!choice.builder.settings().contains('\n'));
    }
}

/// A scene, rays and settings: every built-in structure against brute force and the oracle.
pub fn structures(bytes: &[u8]) {
    let mut numbers = Bytes(bytes);
    let reach = Reach::new(&mut numbers, &WIDE);
    let spec = cases::structure(&mut numbers);
    let Ok((_, scene)) = cases::scene(&mut numbers, &reach, 24) else { return };
    let count = 1 + numbers.below(32) as usize;
    let rays = cases::rays(&mut numbers, &scene, &reach, count);
    if let Err(difference) = compare(&scene, &rays, &spec, rays.len()) {
        panic!("{difference}\n{scene:?}");
    }
}
