//! From a scene's name to its geometry.

use crate::definition::{Definition, MeshFile};
use crate::error::SceneError;
use crate::modifier::{self, Transform};
use crate::reader::{self, Polygons};
use crate::spec::{SceneSpec, Source};
use crate::{catalog, view};
use accel::{Geometry, Mesh, Scene, Vec3, View};
use std::fs;
use std::path::{Path, PathBuf};

/// A scene with what records and reports want to know besides.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// For a split scene the original object of each object.
    pub original: Option<Vec<u32>>,
    /// `generated` with its seed, or the file and its origin.
    pub source: String,
    /// What a user should know of how the file was read.
    pub notes: Vec<String>,
}

/// Definitions may stand on each other this often.
const DEEPEST: u32 = 8;

/// Makes or reads the scene.
///
/// # Errors
/// Unknown names, slips in definitions, missing or unsound meshes; see [`SceneError`].
pub fn load(spec: &SceneSpec) -> Result<Scene, SceneError> {
    load_full(spec).map(|loaded| loaded.scene)
}

/// As [`load`], with the map of a split and the origin.
///
/// # Errors
/// As [`load`].
pub fn load_full(spec: &SceneSpec) -> Result<Loaded, SceneError> {
    resolve(spec, DEEPEST)
}

fn resolve(spec: &SceneSpec, depth: u32) -> Result<Loaded, SceneError> {
    let mut loaded = match &spec.source {
        Source::Id(id) => define(&catalog::definition(id)?, None, depth)?,
        Source::Definition(path) => {
            let text =
                fs::read_to_string(path).map_err(|source| SceneError::Io { path: path.clone(), source })?;
            let definition = Definition::parse(&text).map_err(|reason| bad(path.display(), reason))?;
            define(&definition, Some(path.parent().unwrap_or(Path::new("."))), depth)?
        }
        Source::Mesh(path) => {
            let (mesh, notes) = noted(path, reader::mesh(path)?);
            let geometry = Geometry::Triangles(mesh);
            let id = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
            let view = view::framing(&geometry);
            let scene = Scene { id, geometry, view };
            Loaded { scene, original: None, source: path.display().to_string(), notes }
        }
    };
    loaded.scene.id.push_str(&spec.suffix);
    let origin = loaded.scene.id.clone();
    change(&mut loaded, &origin, spec.modifiers.split, &spec.modifiers.transform)?;
    Ok(loaded)
}

fn bad(origin: impl std::fmt::Display, reason: String) -> SceneError {
    SceneError::Definition { origin: origin.to_string(), reason }
}

fn define(definition: &Definition, folder: Option<&Path>, depth: u32) -> Result<Loaded, SceneError> {
    let origin = format!("`{}`", definition.id);
    if let Some(base) = &definition.base {
        if depth == 0 {
            return Err(bad(&origin, format!("more than {DEEPEST} scenes stand on each other")));
        }
        let mut spec: SceneSpec = base.parse()?;
        if let (Some(folder), Source::Definition(path) | Source::Mesh(path)) = (folder, &mut spec.source) {
            *path = folder.join(&*path);
        }
        return finish(definition, resolve(&spec, depth - 1)?);
    }
    let (geometry, source, notes) = match (&definition.generator, &definition.file) {
        (Some(generator), _) => {
            let geometry = generator.build(definition.seed).map_err(|reason| bad(&origin, reason))?;
            (geometry, format!("generated, seed {}", definition.seed), Vec::new())
        }
        (None, Some(file)) => {
            let source = if file.source.is_empty() { &file.name } else { &file.source };
            let (mesh, notes) = read(&definition.id, file, folder)?;
            (Geometry::Triangles(mesh), source.clone(), notes)
        }
        (None, None) => return Err(bad(&origin, "it has no geometry".into())),
    };
    let view = view::framing(&geometry);
    let scene = Scene { id: String::new(), geometry, view };
    finish(definition, Loaded { scene, original: None, source, notes })
}

fn finish(definition: &Definition, mut loaded: Loaded) -> Result<Loaded, SceneError> {
    loaded.scene.id.clone_from(&definition.id);
    if let Some(hint) = definition.view {
        loaded.scene.view = View::from(hint);
    }
    change(&mut loaded, &definition.id, definition.split, &definition.transform)?;
    Ok(loaded)
}

/// Splits, then transforms; the result must be finite.
fn change(
    loaded: &mut Loaded,
    id: &str,
    split: Option<f64>,
    transform: &Transform,
) -> Result<(), SceneError> {
    let Scene { geometry, view, .. } = &mut loaded.scene;
    if let Some(longest) = split {
        let facets = modifier::split(geometry, longest).map_err(|reason| bad(format!("`{id}`"), reason))?;
        loaded.original = match (loaded.original.take(), facets) {
            (Some(before), Some(facets)) => Some(facets.iter().map(|i| before[*i as usize]).collect()),
            (before, facets) => facets.or(before),
        };
    }
    let before = largest(geometry);
    transform.apply(geometry, view);
    if let Some((vertex, value)) = not_finite(geometry) {
        let value = value.to_string();
        return Err(SceneError::NotFinite { path: PathBuf::from(id), line: None, vertex, value });
    }
    let out_of_scale = |reason| Err(SceneError::OutOfScale { path: PathBuf::from(id), reason });
    let after = largest(geometry);
    if after > LARGEST {
        return out_of_scale(format!(
            "its largest coordinate is {after:e}; beyond {LARGEST:e} extents are not finite in single precision"
        ));
    }
    if before >= f32::MIN_POSITIVE && after < f32::MIN_POSITIVE {
        let exponent = transform.scale_exponent;
        return out_of_scale(format!(
            "scaled by 2^{exponent} its coordinates vanish: the largest was {before:e} and becomes {after:e}"
        ));
    }
    Ok(())
}

/// Coordinates are up to 2¹²⁶: then extents, padded or not, are finite.
const LARGEST: f32 = f32::from_bits(0x7e80_0000);

/// The largest magnitude of a coordinate.
fn largest(geometry: &Geometry) -> f32 {
    let most = |p: &Vec3| p.abs().max_element();
    match geometry {
        Geometry::Triangles(mesh) => mesh.positions.iter().map(most).fold(0.0, f32::max),
        Geometry::Boxes(boxes) => boxes.iter().map(|b| most(&b.min).max(most(&b.max))).fold(0.0, f32::max),
    }
}

/// The first corner, from 1, that is not finite.
fn not_finite(geometry: &Geometry) -> Option<(u64, f32)> {
    let bad = |p: &Vec3| p.to_array().into_iter().find(|x| !x.is_finite());
    let find = |mut points: Box<dyn Iterator<Item = &Vec3> + '_>| {
        points.by_ref().enumerate().find_map(|(i, p)| bad(p).map(|value| (i as u64 + 1, value)))
    };
    match geometry {
        Geometry::Triangles(mesh) => find(Box::new(mesh.positions.iter())),
        Geometry::Boxes(boxes) => find(Box::new(boxes.iter().flat_map(|b| [&b.min, &b.max]))),
    }
}

/// The mesh, and in words what of its file is not in it.
fn noted(path: &Path, polygons: Polygons) -> (Mesh, Vec<String>) {
    let note = match polygons.skipped {
        0 => None,
        1 => Some(format!("{}: 1 face of fewer than three corners is left out", path.display())),
        n => Some(format!("{}: {n} faces of fewer than three corners are left out", path.display())),
    };
    (polygons.mesh, note.into_iter().collect())
}

fn read(id: &str, file: &MeshFile, folder: Option<&Path>) -> Result<(Mesh, Vec<String>), SceneError> {
    let unavailable = |reason: String| SceneError::Unavailable {
        id: id.to_owned(),
        reason,
        hint: "run `cargo xtask setup` in a checkout, which fetches it, or name its folder by --meshes",
    };
    let path = match folder {
        Some(folder) => folder.join(&file.name),
        None => reader::find(&file.name)
            .ok_or_else(|| unavailable(format!("its mesh {} is not here", file.name)))?,
    };
    if let Some(expected) = &file.sha256 {
        let found = reader::file_sha256(&path)?;
        if !found.eq_ignore_ascii_case(expected) {
            return Err(unavailable(format!(
                "{} has the SHA-256 {found}, expected {expected}",
                path.display()
            )));
        }
    }
    let (mesh, notes) = noted(&path, reader::mesh(&path)?);
    match file.triangles {
        Some(expected) if expected != mesh.triangles.len() as u64 => Err(bad(
            format!("`{id}`"),
            format!("{} triangles are announced, {} read", expected, mesh.triangles.len()),
        )),
        _ => Ok((mesh, notes)),
    }
}
