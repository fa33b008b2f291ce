//! From a scene's name to its geometry.

use crate::camera::{self, Camera, Up};
use crate::definition::{Definition, MeshFile};
use crate::error::SceneError;
use crate::modifier::{self, Transform};
use crate::reader::{self, Polygons};
use crate::spec::{SceneSpec, Source};
use crate::{catalog, view};
use accel::solid::SolidError;
use accel::{Geometry, Mesh, Scene, Solid, Vec3};
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
    resolve(spec, DEEPEST).map(|staged| staged.loaded)
}

/// A scene under way.
struct Staged {
    loaded: Loaded,
    /// Whether the camera is still one that frames the scene, rather than one that stands somewhere.
    framed: bool,
}

impl Staged {
    /// A scene without a name, framed as its kind is: files that `up_of` knows upright, all else as the
    /// suite's own scenes.
    fn new(geometry: Geometry, up: Option<Vec3>, source: String, notes: Vec<String>) -> Self {
        let view = match up {
            Some(up) => view::upright(&geometry, up, view::FOV),
            None => view::framing(&geometry),
        };
        let scene = Scene { id: String::new(), geometry, view };
        Self { loaded: Loaded { scene, original: None, source, notes }, framed: true }
    }

    /// Turns the camera to what is told of it.
    fn aim(&mut self, camera: &Camera, origin: &str) -> Result<(), SceneError> {
        if camera.is_silent() {
            return Ok(());
        }
        let Scene { geometry, view, .. } = &mut self.loaded.scene;
        if self.framed && (camera.up.is_some() || camera.fov.is_some()) {
            let up = camera.up.map_or(view.up, Up::vector);
            *view = view::upright(geometry, up, camera.fov.unwrap_or(view.fov_y_degrees));
        }
        camera.apply(view);
        self.framed &= camera.eye.is_none() && camera.target.is_none();
        camera::validate(view).map_err(|reason| bad(format!("`{origin}`"), reason))
    }
}

/// What is up in a mesh file, where its format says so: OBJ has y up unless told otherwise.
fn up_of(path: &Path) -> Option<Vec3> {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("obj")).then_some(Vec3::Y)
}

fn resolve(spec: &SceneSpec, depth: u32) -> Result<Staged, SceneError> {
    let mut staged = match &spec.source {
        Source::Id(id) => define(&catalog::definition(id)?, None, depth)?,
        Source::Definition(path) => {
            let text =
                fs::read_to_string(path).map_err(|source| SceneError::Io { path: path.clone(), source })?;
            let folder = path.parent().unwrap_or(Path::new("."));
            let definition = Definition::parse_in(&text, Some(folder));
            let definition = definition.map_err(|reason| bad(path.display(), reason))?;
            define(&definition, Some(folder), depth)?
        }
        Source::Mesh(path) => {
            let (geometry, notes) = from_file(path)?;
            let source = path.display().to_string();
            let mut staged = Staged::new(geometry, up_of(path), source, notes);
            let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            staged.loaded.scene.id = stem.unwrap_or_default();
            staged
        }
    };
    let Staged { loaded, .. } = &mut staged;
    loaded.scene.id.push_str(&spec.suffix);
    let origin = loaded.scene.id.clone();
    change(loaded, &origin, spec.modifiers.split, &spec.modifiers.transform)?;
    staged.aim(&spec.modifiers.camera, &origin)?;
    Ok(staged)
}

fn bad(origin: impl std::fmt::Display, reason: String) -> SceneError {
    SceneError::Definition { origin: origin.to_string(), reason }
}

fn define(definition: &Definition, folder: Option<&Path>, depth: u32) -> Result<Staged, SceneError> {
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
    let staged = match (&definition.generator, &definition.file) {
        (Some(generator), _) => {
            let geometry = generator.build(definition.seed).map_err(|reason| bad(&origin, reason))?;
            Staged::new(geometry, None, format!("generated, seed {}", definition.seed), Vec::new())
        }
        (None, Some(file)) => {
            let source = if file.source.is_empty() { &file.name } else { &file.source };
            let (geometry, notes) = read(&definition.id, file, folder)?;
            let up = up_of(Path::new(&file.name));
            Staged::new(geometry, up, source.clone(), notes)
        }
        (None, None) if definition.solids.is_empty() => {
            return Err(bad(&origin, "it has no geometry".into()));
        }
        (None, None) => {
            Staged::new(Geometry::Solids(definition.solids.clone()), None, "listed".into(), Vec::new())
        }
    };
    finish(definition, staged)
}

fn finish(definition: &Definition, mut staged: Staged) -> Result<Staged, SceneError> {
    staged.loaded.scene.id.clone_from(&definition.id);
    staged.aim(&definition.view, &definition.id)?;
    change(&mut staged.loaded, &definition.id, definition.split, &definition.transform)?;
    Ok(staged)
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
    if let Geometry::Solids(solids) = geometry
        && let Some((number, error)) = unsound(solids)
    {
        return out_of_scale(format!("transformed, its solid {number} is none any more: {error}"));
    }
    if !(view.eye.is_finite() && view.target.is_finite()) {
        return out_of_scale(format!(
            "its camera is at {}, looking at {}: not finite",
            view.eye, view.target
        ));
    }
    Ok(())
}

/// Coordinates are up to 2¹²⁴: then extents, padded or not, are finite, and so are the places around the
/// scene that rays start from.
const LARGEST: f32 = f32::from_bits(0x7d80_0000);

/// The largest magnitude of a coordinate.
fn largest(geometry: &Geometry) -> f32 {
    let most = |p: &Vec3| p.abs().max_element();
    match geometry {
        Geometry::Triangles(mesh) => mesh.positions.iter().map(most).fold(0.0, f32::max),
        Geometry::Boxes(boxes) => boxes.iter().map(|b| most(&b.min).max(most(&b.max))).fold(0.0, f32::max),
        Geometry::Solids(_) => {
            let b = geometry.bounds();
            if b.is_empty() { 0.0 } else { most(&b.min).max(most(&b.max)) }
        }
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
        Geometry::Solids(solids) => {
            let bounds: Vec<Vec3> = solids.iter().map(Solid::bounds).flat_map(|b| [b.min, b.max]).collect();
            find(Box::new(bounds.iter()))
        }
    }
}

/// The first solid, from 1, that can't be traced.
fn unsound(solids: &[Solid]) -> Option<(usize, SolidError)> {
    solids.iter().enumerate().find_map(|(i, solid)| Some((i + 1, solid.validate().err()?)))
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

/// What a mesh or patch file holds, and in words what of it does not.
fn from_file(path: &Path) -> Result<(Geometry, Vec<String>), SceneError> {
    if reader::is_patches(path) {
        return Ok((Geometry::Solids(reader::patches(path)?), Vec::new()));
    }
    let (mesh, notes) = noted(path, reader::mesh(path)?);
    Ok((Geometry::Triangles(mesh), notes))
}

fn read(id: &str, file: &MeshFile, folder: Option<&Path>) -> Result<(Geometry, Vec<String>), SceneError> {
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
    let (geometry, notes) = from_file(&path)?;
    match file.triangles {
        Some(expected) if expected != geometry.len() as u64 => Err(bad(
            format!("`{id}`"),
            format!("{} {} are announced, {} read", expected, geometry.kind(), geometry.len()),
        )),
        _ => Ok((geometry, notes)),
    }
}
