//! The study: each scene as it is and at rising levels.

use crate::errors::{Errors, Shown, Truth, errors, normal_of};
use crate::record::{FORMAT, Form, Model, ModelRow, SceneRows};
use crate::tessellate::{Tessellation, tessellate};
use accel::solid::Shape;
use accel::{Accel, Geometry, Hit, RaySet, Scene, Solid, Workload, vec_bytes};
use harness::clock::Clock;
use harness::machine::Machine;
use harness::record::Suite;
use harness::registry::{self, BuildFailure, RegistryError, StructureSpec, guarded_build};
use scenes::rays::{RaysError, RaysId, RaysSpec, generate, perspective};
use scenes::{SceneError, SceneSpec};
use std::collections::BTreeMap;

/// What is studied.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Scenes of solids, by name.
    pub scenes: Vec<String>,
    /// The structure for all forms, with settings but for its kernel.
    pub structure: StructureSpec,
    /// Rows and columns of the image.
    pub pixels: u32,
    /// Widths of a pixel that a surface may be off.
    pub max_displacement: f64,
    /// The part of pixels that may be wrong.
    pub max_wrong: f64,
    /// The highest level.
    pub levels: u32,
    /// Triangles of a level at most.
    pub triangles: u64,
    /// Rows and columns of the list of rays.
    pub list: u32,
    /// Samples of each time, of which the least is taken.
    pub rounds: u32,
    /// The command as given.
    pub command: String,
}

/// Why there is no study.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A scene that can't be had.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A scene without solids.
    #[error("scene `{0}` is of {1}: there is nothing to tessellate")]
    NoSolids(String, &'static str),
    /// A structure that can't be built.
    #[error(transparent)]
    Build(#[from] BuildFailure),
    /// A structure that isn't there.
    #[error(transparent)]
    Registry(#[from] RegistryError),
}

/// Studies all scenes in the current pool; `begun` hears of each scene and form, `keep` is given the record whenever it has grown.
///
/// # Errors
/// [`StudyError`]
pub fn run(
    plan: &Plan,
    mut begun: impl FnMut(&str, Form),
    mut keep: impl FnMut(&Model),
) -> Result<Model, StudyError> {
    let mut model = Model {
        format: FORMAT,
        command: plan.command.clone(),
        suite: Suite::this(),
        machine: Machine::here(),
        structure: plan.structure.to_string(),
        pixels: plan.pixels,
        max_displacement: plan.max_displacement,
        max_wrong: plan.max_wrong,
        scenes: Vec::new(),
    };
    for name in &plan.scenes {
        let spec: SceneSpec = name.parse()?;
        let scene = scenes::load(&spec)?;
        let rows = study(plan, &scene, |form| begun(name, form))?;
        model.scenes.push(rows);
        keep(&model);
    }
    Ok(model)
}

/// The rays that all forms of a scene are asked for.
struct Rays {
    image: RaySet,
    list: Option<RaySet>,
}

fn study(plan: &Plan, scene: &Scene, mut begun: impl FnMut(Form)) -> Result<SceneRows, StudyError> {
    let Geometry::Solids(solids) = &scene.geometry else {
        return Err(StudyError::NoSolids(scene.id.clone(), scene.geometry.kind()));
    };
    begun(Form::True);
    let rays = Rays { image: RaySet::Raster(perspective(&scene.view, plan.pixels, plan.pixels)), list: None };
    let truth = reference(plan, scene, &rays.image)?;
    let rays = Rays { list: list(plan, scene)?, ..rays };
    let truth = Truth { solids, rays: &rays.image, hits: &truth };
    let of_solid = |hit: &Hit, at| (hit.object, normal_of(&solids[hit.object as usize], hit, at));
    let mut rows = vec![row(plan, Form::True, scene, &rays, |hits| {
        errors(&truth, &Shown { hits, of: &of_solid }, plan.max_displacement)
    })?];
    let mut ended = format!("level {} is the highest that was asked for", plan.levels);
    for level in 0..=plan.levels {
        let before = rows.last().filter(|row| row.form != Form::True).map_or(0, |row| row.objects);
        if before.saturating_mul(4) > plan.triangles {
            ended = format!("level {level} would have more than {} triangles", plan.triangles);
            break;
        }
        begun(Form::Level(level));
        let clock = Clock::of(rayon::current_num_threads());
        let start = clock.now();
        let Tessellation { mesh, owner } = tessellate(solids, level);
        let tessellate_ns = (clock.now() - start) as f64;
        let tessellated = Scene { geometry: Geometry::Triangles(mesh), ..scene.clone() };
        let of_facet = |hit: &Hit, at| {
            let normal = match &tessellated.geometry {
                Geometry::Triangles(mesh) => mesh.corners(hit.object as usize).normal(at),
                _ => None,
            };
            (owner[hit.object as usize], normal)
        };
        let judge =
            |hits: &[Option<Hit>]| errors(&truth, &Shown { hits, of: &of_facet }, plan.max_displacement);
        let row = row(plan, Form::Level(level), &tessellated, &rays, judge)?;
        rows.push(ModelRow { tessellate_ns, ..row });
    }
    let mut all = SceneRows { scene: scene.id.clone(), kinds: kinds(solids), rows, ended };
    all.mark_front();
    Ok(all)
}

/// The structure with a kernel: no ray may slip through the triangles of a model.
fn build<'s>(
    plan: &Plan,
    scene: &'s Scene,
    kernel: &str,
    workload: &Workload,
) -> Result<Box<dyn Accel + 's>, StudyError> {
    let spec = plan.structure.with("kernel", kernel);
    let choice = registry::parse(&spec.to_string())?;
    Ok(guarded_build(&choice, scene, workload)?)
}

/// What the image truly shows: all tests in double precision.
fn reference(plan: &Plan, scene: &Scene, image: &RaySet) -> Result<Vec<Option<Hit>>, StudyError> {
    let accel = build(plan, scene, "double", &Workload::of(image))?;
    let mut hits = vec![None; image.len()];
    accel.trace(image, &mut hits);
    Ok(hits)
}

/// Rays from what the image shows; none where it shows nothing.
fn list(plan: &Plan, scene: &Scene) -> Result<Option<RaySet>, StudyError> {
    let accel = build(plan, scene, "double", &Workload::GENERAL)?;
    let spec = RaysSpec { id: RaysId::Diffuse, rows: plan.list, cols: plan.list, seed: 1 };
    let made: Result<RaySet, RaysError> = generate(scene, &spec, &*accel);
    Ok(made.ok())
}

fn row(
    plan: &Plan,
    form: Form,
    scene: &Scene,
    rays: &Rays,
    judge: impl Fn(&[Option<Hit>]) -> Errors,
) -> Result<ModelRow, StudyError> {
    let clock = Clock::of(rayon::current_num_threads());
    let kernel = "watertight";
    let start = clock.now_of_build();
    let general = build(plan, scene, kernel, &Workload::GENERAL)?;
    let build_ns = (clock.now_of_build() - start) as f64;
    let structure_bytes = general.footprint().total() as u64;
    let list_ns = rays.list.as_ref().map(|list| time(plan, &clock, &*general, list).0);
    drop(general);
    let image = build(plan, scene, kernel, &Workload::of(&rays.image))?;
    let (image_ns, hits) = time(plan, &clock, &*image, &rays.image);
    Ok(ModelRow {
        form,
        objects: scene.geometry.len() as u64,
        scene_bytes: bytes_of(&scene.geometry),
        structure_bytes,
        tessellate_ns: 0.0,
        build_ns,
        image_ns,
        list_ns,
        errors: judge(&hits),
        front: false,
    })
}

/// The least time for a ray, and the hits.
fn time(plan: &Plan, clock: &Clock, accel: &dyn Accel, rays: &RaySet) -> (f64, Vec<Option<Hit>>) {
    let mut hits = vec![None; rays.len()];
    let mut least = f64::INFINITY;
    for _ in 0..plan.rounds.max(1) {
        let start = clock.now();
        accel.trace(rays, &mut hits);
        least = least.min((clock.now() - start).max(1) as f64 / rays.len().max(1) as f64);
    }
    (least, hits)
}

/// How many there are of each kind.
fn kinds(solids: &[Solid]) -> String {
    let mut kinds: BTreeMap<&str, u64> = BTreeMap::new();
    solids.iter().for_each(|solid| *kinds.entry(solid.kind()).or_default() += 1);
    let kinds: Vec<String> =
        kinds.into_iter().map(|(kind, n)| format!("{} {kind}", harness::units::count(n))).collect();
    kinds.join(", ")
}

/// Bytes of a scene's own numbers.
fn bytes_of(geometry: &Geometry) -> u64 {
    let bytes = match geometry {
        Geometry::Triangles(mesh) => vec_bytes(&mesh.positions) + vec_bytes(&mesh.triangles),
        Geometry::Boxes(boxes) => vec_bytes(boxes),
        Geometry::Solids(solids) => vec_bytes(solids) + solids.iter().map(held).sum::<usize>(),
    };
    bytes as u64
}

/// Bytes that a solid holds elsewhere.
fn held(solid: &Solid) -> usize {
    match solid {
        Solid::Patch(patch) => size_of_val(patch.net()),
        Solid::Implicit(implicit) => implicit.function.bytes(),
        Solid::Facets(facets) => facets.bytes(),
        Solid::Csg(tree) => size_of_val(&*tree.parts) + tree.parts.iter().map(held).sum::<usize>(),
        Solid::Group(group) => group.parts().iter().map(|part| size_of_val(part) + held(part)).sum(),
        _ => 0,
    }
}
