//! The extremes: where single precision ends.

use accel::{Geometry, Mesh, Ray, RaySet, Scene, Vec3, View, Workload};
use harness::guard::guard;
use harness::registry::{self, Choice, guarded_build};
use harness::workload::{pick, sample};
use judge::{Counts, Judge, Tolerance, Truth};
use primitives::KernelId;
use scenes::Random;
use scenes::rays::{RaysId, RaysSpec, generate};
use serde::{Deserialize, Serialize};

/// An extreme with what every structure answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Extreme {
    /// What it is.
    pub name: String,
    /// Triangles.
    pub triangles: u64,
    /// Rays judged.
    pub rays: u64,
    /// Rays left out because their true t is not zero and less than the least normal `f32`.
    pub left_out: u64,
    /// By structure.
    pub answers: Vec<Answer>,
}

/// What a structure answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// The structure with its settings.
    pub structure: String,
    /// By kind, or why there is no answer.
    pub found: Result<Counts, String>,
}

/// The structures of the table: the suite's own with each kernel that is not lossy, and those of others.
pub fn structures() -> Vec<Choice> {
    let kernels = [KernelId::MollerTrumbore, KernelId::Watertight, KernelId::Double, KernelId::Exact];
    let own =
        ["bmssm", "ssm"].into_iter().flat_map(|id| kernels.map(|kernel| format!("{id}:kernel={kernel}")));
    let others =
        ["embree", "embree-robust", "embree-compact", "obvhs-bvh2", "obvhs-cwbvh"].map(str::to_owned);
    own.chain(others).filter_map(|spec| registry::parse(&spec).ok()).collect()
}

/// A scene with rays.
struct Case {
    name: String,
    scene: Scene,
    rays: Vec<Ray>,
}

/// Every extreme with about `rays` rays, one of `largest` triangles unless that is 0; `heard` is told of each.
pub fn all(rays: usize, largest: usize, seed: u64, heard: &mut dyn FnMut(&str)) -> Vec<Extreme> {
    let choices = structures();
    let mut found = Vec::new();
    for make in cases(rays, largest, seed) {
        let Some(case) = make() else { continue };
        heard(&case.name);
        found.push(judge(&case, &choices));
    }
    found
}

fn judge(case: &Case, choices: &[Choice]) -> Extreme {
    let judge = Judge::new(&case.scene, Tolerance::VISIBLE);
    let all = RaySet::List(case.rays.clone());
    let truth = judge.truth(&all, &mut |_| {});
    let fair: Vec<usize> =
        (0..all.len()).filter(|i| !truth.0[*i].is_some_and(|hit| hit.is_denormal())).collect();
    let rays = pick(&all, &fair);
    let truth = Truth(fair.iter().map(|i| truth.0[*i]).collect());
    let answer = |choice: &Choice| {
        let mut hits = vec![None; rays.len()];
        let found = guarded_build(choice, &case.scene, &Workload::GENERAL)
            .map_err(|failure| failure.to_string())
            .and_then(|accel| {
                guard("tracing", || accel.trace(&rays, &mut hits)).map_err(|error| error.to_string())
            })
            .map(|()| judge.judge_all(&rays, &truth, &hits).counts);
        Answer { structure: choice.spec.to_string(), found }
    };
    Extreme {
        name: case.name.clone(),
        triangles: case.scene.geometry.len() as u64,
        rays: rays.len() as u64,
        left_out: (all.len() - rays.len()) as u64,
        answers: choices.iter().map(answer).collect(),
    }
}

type Make = Box<dyn FnOnce() -> Option<Case>>;

fn cases(rays: usize, largest: usize, seed: u64) -> Vec<Make> {
    let mut all: Vec<Make> = Vec::new();
    let mut add = |make: Make| all.push(make);
    for (name, factor) in [
        ("coordinates up to 2.5·10³⁸, an extent beyond single precision", 2e38f64),
        ("coordinates up to 1.6·10³⁸, an extent within it", 1.3e38),
        ("coordinates of 10³⁰", 1e30),
        ("coordinates of 10⁻³⁰", 1e-30),
        ("coordinates down to denormal, 10⁻³⁹", 1e-39),
        ("coordinates all denormal, 10⁻⁴²", 1e-42),
    ] {
        add(Box::new(move || {
            let scene = scaled(&load("bumps-1k")?, factor);
            let rays = aimed(&scene, 4.0, rays, seed);
            Some(Case { name: name.into(), scene, rays })
        }));
    }
    add(Box::new(move || {
        let ball = load("bumps-1k")?;
        let scene = together(&scaled(&ball, 2f64.powi(60)), &scaled(&ball, 2f64.powi(-60)));
        let half = rays / 2;
        let mut list = aimed(&scaled(&ball, 2f64.powi(-60)), 4.0, half, seed);
        list.extend(aimed(&scene, 4.0, rays - half, seed + 1));
        Some(Case { name: "one scene over 2^±60".into(), scene, rays: list })
    }));
    add(Box::new(move || {
        let ball = load("bumps-1k")?;
        let scene = together(&hall(1e6), &ball);
        let half = rays / 2;
        let mut list = aimed(&ball, 4.0, half, seed);
        list.extend(aimed(&ball, 4e5, rays - half, seed + 1));
        Some(Case { name: "a ball of radius 1 in a hall of 10⁶".into(), scene, rays: list })
    }));
    for power in [2, 4, 6, 8, 10, 12] {
        add(Box::new(move || {
            let scene = load("bumps-1k")?;
            let rays = aimed(&scene, 10f64.powi(power), rays, seed);
            Some(Case { name: format!("camera at 10^{power} radii"), scene, rays })
        }));
    }
    for (name, sets) in [
        ("t ranges that begin or end at the hit", vec![RaysId::Range]),
        ("directions of ±0, denormal, huge: 0·∞", vec![RaysId::Directions, RaysId::Axis, RaysId::Bounds]),
        ("rays from surfaces, not offset", vec![RaysId::Surface]),
        ("through corners of many triangles", vec![RaysId::Vertex]),
        ("along edges, in planes of triangles", vec![RaysId::Plane, RaysId::Edge]),
    ] {
        add(Box::new(move || Some(Case { name: name.into(), ..generated("bumps-1k", &sets, rays, seed)? })));
    }
    add(Box::new(move || {
        let case = generated("bumps-1k", &[RaysId::Random], rays, seed)?;
        let limits =
            [(1e-40, 1e-39), (0.0, 1e-45), (1e-45, f32::INFINITY), (-1e-40, 1e30), (0.5, 0.5), (-0.0, 0.0)];
        let range = |(i, ray): (usize, Ray)| {
            let (t_min, t_max) = limits[i % limits.len()];
            Ray { t_min, t_max, ..ray }
        };
        let rays = case.rays.into_iter().enumerate().map(range).collect();
        Some(Case { name: "t ranges denormal, empty, a point".into(), rays, ..case })
    }));
    let slivers = vec![RaysId::Inside, RaysId::Edge, RaysId::Vertex, RaysId::Plane];
    for (name, scene, sets) in [
        ("slivers: inside, along edges, at corners", "extreme-needles", slivers),
        ("zero area among others", "extreme-mixed", vec![RaysId::Random, RaysId::Edge]),
        ("coplanar and overlapping", "extreme-coplanar", vec![RaysId::Random, RaysId::Vertex]),
        ("every triangle four times", "extreme-duplicates", vec![RaysId::Random, RaysId::Edge]),
        ("150,000 radii from the origin", "extreme-offset-150k", vec![RaysId::Random, RaysId::LeakEdge]),
    ] {
        add(Box::new(move || Some(Case { name: name.into(), ..generated(scene, &sets, rays, seed)? })));
    }
    if largest > 0 {
        add(Box::new(move || {
            let scene = load(&format!("bumps-{largest}"))?;
            let name = format!("{largest} triangles: random and at edges");
            let mut list = aimed(&scene, 4.0, rays / 2, seed);
            list.extend(at_edges(&scene, rays - rays / 2));
            Some(Case { name, scene, rays: list })
        }));
    }
    all
}

fn load(id: &str) -> Option<Scene> {
    scenes::load(&id.parse().ok()?).ok()
}

fn generated(id: &str, sets: &[RaysId], rays: usize, seed: u64) -> Option<Case> {
    let scene = load(id)?;
    let tracer = registry::quick(&scene, KernelId::Exact);
    let mut all = Vec::new();
    for set in sets {
        let side = ((rays / sets.len()) as f64).sqrt().ceil() as u32;
        let spec = RaysSpec { id: *set, rows: side, cols: side, seed };
        let made = generate(&scene, &spec, tracer.as_ref()).ok()?;
        all.extend((0..made.len()).map(|i| made.ray(i)));
    }
    drop(tracer);
    Some(Case { name: String::new(), scene, rays: all })
}

fn mesh(scene: &Scene) -> &Mesh {
    match &scene.geometry {
        Geometry::Triangles(mesh) => mesh,
        Geometry::Boxes(_) | Geometry::Solids(_) => unreachable!("extremes are of triangles"),
    }
}

fn with(mesh: Mesh) -> Scene {
    let view = View { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };
    Scene { id: "extreme".into(), geometry: Geometry::Triangles(mesh), view }
}

/// Coordinates multiplied in `f64` and rounded once.
fn scaled(scene: &Scene, factor: f64) -> Scene {
    let mesh = mesh(scene);
    let positions = mesh.positions.iter().map(|p| (p.as_dvec3() * factor).as_vec3()).collect();
    with(Mesh { positions, triangles: mesh.triangles.clone() })
}

fn together(a: &Scene, b: &Scene) -> Scene {
    let (a, b) = (mesh(a), mesh(b));
    let base = a.positions.len() as u32;
    let more = b.triangles.iter().map(|t| t.map(|corner| corner + base));
    with(Mesh {
        positions: a.positions.iter().chain(&b.positions).copied().collect(),
        triangles: a.triangles.iter().copied().chain(more).collect(),
    })
}

/// A box of half the size `half` about the origin, from inside.
fn hall(half: f32) -> Scene {
    let corner = |i: u32| {
        let side = |bit: u32| if i >> bit & 1 == 1 { half } else { -half };
        Vec3::new(side(0), side(1), side(2))
    };
    let quads = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    with(Mesh { positions: (0..8).map(corner).collect(), triangles })
}

/// Rays from a sphere of so many of the scene's half extents at random points of its triangles.
fn aimed(scene: &Scene, radii: f64, rays: usize, seed: u64) -> Vec<Ray> {
    let mesh = mesh(scene);
    let bounds = mesh.bounds();
    let radius = (bounds.max.as_dvec3() - bounds.min.as_dvec3()).max_element() * 0.5 * radii;
    let mut random = Random::from_state(seed);
    let mut list = Vec::new();
    while list.len() < rays {
        let [a, b, c] = mesh.corners(random.below(mesh.triangles.len())).map(|p| p.as_dvec3());
        let (mut u, mut v) = (random.unit(), random.unit());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let target = a + (b - a) * u + (c - a) * v;
        let z = 2.0 * random.unit() - 1.0;
        let angle = random.unit() * std::f64::consts::TAU;
        let ring = (1.0 - z * z).sqrt();
        let out = [ring * angle.cos(), ring * angle.sin(), z];
        // Beyond `f32` the eye is as far as there are numbers.
        let most = f64::from(f32::MAX);
        let eye = out.map(|x| (x * radius).clamp(-most, most) as f32);
        let eye = Vec3::from_array(eye);
        let towards = target - eye.as_dvec3();
        let size = towards.abs().max_element();
        // The scale is shared between t and the direction, so that it is the scene that is extreme and neither of these.
        let direction = (towards / size * size.sqrt()).as_vec3();
        if size > 0.0 && direction.is_finite() {
            list.push(Ray::new(eye, direction));
        }
    }
    list
}

/// Rays from outside at the middles of edges, in steps over the whole mesh.
fn at_edges(scene: &Scene, rays: usize) -> Vec<Ray> {
    let mesh = mesh(scene);
    let ray = |i: usize| {
        let [a, b, _] = mesh.corners(i);
        let target = (a.as_dvec3() + b.as_dvec3()) * 0.5;
        let eye = (target * 3.0).as_vec3();
        Ray::new(eye, (target - eye.as_dvec3()).as_vec3())
    };
    sample(mesh.triangles.len(), rays).into_iter().map(ray).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_cell_is_empty_and_structures_agree_on_the_rays() {
        let mut heard = 0;
        let found = all(60, 0, 1, &mut |_| heard += 1);
        assert!(found.len() >= 20 && heard == found.len());
        let structures = structures().len();
        for extreme in &found {
            assert_eq!(extreme.answers.len(), structures, "{}", extreme.name);
            assert!(extreme.rays + extreme.left_out >= 60, "{}", extreme.name);
            for answer in &extreme.answers {
                let counted = answer.found.as_ref().is_ok_and(|counts| counts.rays == extreme.rays);
                assert!(counted || answer.found.is_err(), "{}: {answer:?}", extreme.name);
            }
        }
    }
}
