//! From a scene's name to its geometry.

use crate::definition::{Definition, MeshFile};
use crate::error::SceneError;
use crate::modifier::{self, Transform};
use crate::spec::{SceneSpec, Source};
use crate::{catalog, reader, view};
use accel::{Geometry, Scene, View};
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
            let geometry = Geometry::Triangles(reader::mesh(path)?);
            let id = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
            let view = view::framing(&geometry);
            Loaded { scene: Scene { id, geometry, view }, original: None, source: path.display().to_string() }
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
    let (geometry, source) = match (&definition.generator, &definition.file) {
        (Some(generator), _) => {
            let geometry = generator.build(definition.seed).map_err(|reason| bad(&origin, reason))?;
            (geometry, format!("generated, seed {}", definition.seed))
        }
        (None, Some(file)) => {
            let source = if file.source.is_empty() { &file.name } else { &file.source };
            (Geometry::Triangles(read(&definition.id, file, folder)?), source.clone())
        }
        (None, None) => return Err(bad(&origin, "it has no geometry".into())),
    };
    let view = view::framing(&geometry);
    finish(definition, Loaded { scene: Scene { id: String::new(), geometry, view }, original: None, source })
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
    transform.apply(geometry, view);
    match not_finite(geometry) {
        Some((vertex, value)) => {
            let value = value.to_string();
            Err(SceneError::NotFinite { path: PathBuf::from(id), line: None, vertex, value })
        }
        None => Ok(()),
    }
}

/// The first corner, from 1, that is not finite.
fn not_finite(geometry: &Geometry) -> Option<(u64, f32)> {
    let bad = |p: &accel::Vec3| p.to_array().into_iter().find(|x| !x.is_finite());
    let find = |mut points: Box<dyn Iterator<Item = &accel::Vec3> + '_>| {
        points.by_ref().enumerate().find_map(|(i, p)| bad(p).map(|value| (i as u64 + 1, value)))
    };
    match geometry {
        Geometry::Triangles(mesh) => find(Box::new(mesh.positions.iter())),
        Geometry::Boxes(boxes) => find(Box::new(boxes.iter().flat_map(|b| [&b.min, &b.max]))),
    }
}

fn read(id: &str, file: &MeshFile, folder: Option<&Path>) -> Result<accel::Mesh, SceneError> {
    let unavailable = |reason: String| SceneError::Unavailable {
        id: id.to_owned(),
        reason,
        hint: "run `cargo xtask setup`, which fetches it",
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
    let mesh = reader::mesh(&path)?;
    match file.triangles {
        Some(expected) if expected != mesh.triangles.len() as u64 => Err(bad(
            format!("`{id}`"),
            format!("{} triangles are announced, {} read", expected, mesh.triangles.len()),
        )),
        _ => Ok(mesh),
    }
}
