//! Large objects split into small facets (Skala 1993, §2): what it does to candidates, time and memory.

use super::PaperError;
use super::timing::medians;
use accel::{BuildError, Builder, Geometry, Group, Mesh, Ray, RaySet, Scene, Workload};
use bmssm::suite::dense::{BmssmDense, Resolution};
use scenes::Random;
use scenes::load;
use scenes::rays;
use scenes::split;
use serde::{Deserialize, Serialize};

/// A scene whose edges are no longer than a bound.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Facets {
    /// The scene.
    #[serde(default = "hall")]
    pub scene: String,
    /// Longest edge; `None` for the scene as it is.
    pub longest: Option<f64>,
    /// Objects.
    pub objects: usize,
    /// Mean candidates of a primary ray, R & S.
    pub primary_candidates: f64,
    /// Time of a primary ray in ns.
    pub primary_ns: f64,
    /// Bytes of R and S.
    pub primary_bytes: usize,
    /// Mean candidates of a general ray over its cells, R & S & T.
    pub general_candidates: f64,
    /// Time of a general ray in ns.
    pub general_ns: f64,
    /// Bytes of R, S and T.
    pub general_bytes: usize,
}

/// Slices on each axis for general rays.
pub const RESOLUTION: u32 = 64;

/// Rows and columns of the image.
pub const IMAGE: u32 = 128;

/// The one scene of records of old.
fn hall() -> String {
    HALL.0.to_owned()
}

/// A scene and the longest edges tried.
type Tried = (&'static str, &'static [Option<f64>]);

/// Triangles that lie across, so that their boxes hold much that they don't.
const ACROSS: Tried = ("large-1k", &[None, Some(0.2), Some(0.1), Some(0.05)]);

/// A teapot in a hall 400 wide, whose walls lie along the axes.
const HALL: Tried = ("stadium", &[None, Some(200.0), Some(50.0), Some(25.0), Some(12.0)]);

/// A scene that splitting helps, and one that it can't help.
///
/// # Errors
/// As [`evaluate`], and where a scene can't be made.
pub fn all(rounds: usize) -> Result<Vec<Facets>, PaperError> {
    let mut all = Vec::new();
    for (id, longest) in [ACROSS, HALL] {
        all.extend(evaluate(&load(&id.parse()?)?, longest, rounds)?);
    }
    Ok(all)
}

/// Splits the triangles of `scene` finer and finer.
///
/// # Errors
/// As [`Builder::build`].
pub fn evaluate(scene: &Scene, longest: &[Option<f64>], rounds: usize) -> Result<Vec<Facets>, BuildError> {
    let Geometry::Triangles(mesh) = &scene.geometry else { return Ok(Vec::new()) };
    let mut out = Vec::new();
    for longest in longest.iter().copied() {
        let facets: Mesh = match longest.map(|longest| split(mesh, longest)) {
            Some(Ok(split)) => split.mesh,
            Some(Err(_)) => continue,
            None => mesh.clone(),
        };
        let scene = Scene { geometry: Geometry::Triangles(facets), ..scene.clone() };
        out.push(one(&scene, longest, rounds)?);
    }
    Ok(out)
}

fn one(scene: &Scene, longest: Option<f64>, rounds: usize) -> Result<Facets, BuildError> {
    let mut dense = BmssmDense::default();
    dense.settings.resolution = Resolution::Same(RESOLUTION);
    let primary = RaySet::Raster(rays::perspective(&scene.view, IMAGE, IMAGE));
    let bounds = scene.geometry.bounds();
    let mut random = Random::new(11);
    let general = RaySet::List(
        (0..500)
            .map(|_| {
                let at = random.in_cube(0.0, 1.0).as_vec3();
                Ray::new(bounds.min + bounds.extent() * at, random.direction().as_vec3())
            })
            .collect(),
    );
    let [(pc, pt, pb), (gc, gt, gb)] =
        [measure(&dense, scene, &primary, rounds)?, measure(&dense, scene, &general, rounds)?];
    Ok(Facets {
        scene: scene.id.clone(),
        longest,
        objects: scene.geometry.len(),
        primary_candidates: pc,
        primary_ns: pt,
        primary_bytes: pb,
        general_candidates: gc,
        general_ns: gt,
        general_bytes: gb,
    })
}

/// Candidates and ns a ray, and bytes of the maps.
fn measure(
    dense: &BmssmDense,
    scene: &Scene,
    rays: &RaySet,
    rounds: usize,
) -> Result<(f64, f64, usize), BuildError> {
    let built = dense.build(scene, &Workload::of(rays))?;
    let candidates = built.count(rays, false).map_or(0, |c| c.candidates);
    let mut hits = vec![None; rays.len()];
    let ns = medians(rounds, &mut [&mut |_| built.trace(rays, &mut hits)])[0];
    let count = rays.len() as f64;
    Ok((candidates as f64 / count, ns / count, built.footprint().bytes(Group::Structure)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splitting_lowers_the_candidates_of_triangles_that_lie_across() {
        let scene = load(&ACROSS.0.parse().unwrap()).unwrap();
        let [whole, split] = evaluate(&scene, &[None, Some(0.1)], 1).unwrap().try_into().unwrap();
        assert!(split.primary_candidates < 0.9 * whole.primary_candidates, "{whole:?} {split:?}");
        assert!(split.general_candidates < 0.7 * whole.general_candidates, "{whole:?} {split:?}");
    }

    /// The boxes of walls along the axes are as thin as the walls.
    #[test]
    fn splitting_lowers_no_candidates_of_a_hall() {
        let scene = load(&"stadium".parse().unwrap()).unwrap();
        let Geometry::Triangles(mesh) = &scene.geometry else { panic!("triangles") };
        // The hall alone: its 12 triangles are the last.
        let hall = Mesh { triangles: mesh.triangles[mesh.triangles.len() - 12..].to_vec(), ..mesh.clone() };
        let scene = Scene { geometry: Geometry::Triangles(hall), ..scene };
        let facets = evaluate(&scene, HALL.1, 1).unwrap();
        assert_eq!(facets.len(), 5);
        assert!(facets[1..].iter().all(|f| f.primary_candidates >= facets[0].primary_candidates));
        assert!(facets[1..].iter().all(|f| f.general_candidates >= facets[0].general_candidates));
        assert!(
            facets
                .windows(2)
                .all(|w| w[1].objects >= w[0].objects && w[1].general_bytes >= w[0].general_bytes)
        );
    }
}
