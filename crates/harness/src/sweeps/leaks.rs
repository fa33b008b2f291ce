//! Rays from inside closed meshes, none of which may get out.

use crate::check::oracle_of;
use crate::guard::guard;
use crate::progress::{Event, Listener};
use crate::registry::{Choice, guarded_build};
use accel::{Builder, Geometry, Scene, Workload};
use baselines::Brute;
use primitives::KernelId;
use scenes::SceneError;
use scenes::rays::{RaysError, RaysId, RaysSpec, generate};
use serde::Serialize;

/// The meshes: a bumpy sphere, and one of radius 2 far from the origin.
pub const MESHES: [&str; 2] = ["bumps-20k", "extreme-sphere"];

/// The scales at which they are looked at.
pub const SCALES: [f32; 3] = [1e-3, 1.0, 1e3];

/// What the rays are aimed at: faces, edges and corners.
const SETS: [RaysId; 3] = [RaysId::LeakFace, RaysId::LeakEdge, RaysId::LeakVertex];

/// What was found.
#[derive(Clone, Debug, Default, Serialize)]
pub struct LeakTally {
    /// Rays traced by each structure.
    pub rays: u64,
    /// By mesh, scale and structure.
    pub rows: Vec<LeakRow>,
}

/// A structure on a mesh at a scale.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeakRow {
    /// The mesh.
    pub mesh: String,
    /// By what its coordinates are multiplied.
    pub scale: f32,
    /// The structure with its settings.
    pub structure: String,
    /// Rays traced.
    pub rays: u64,
    /// Rays that truly hit the mesh and for which no hit was reported, aimed at faces, edges and corners.
    pub leaks: [u64; 3],
    /// Whether the structure's kernel promises that there are none.
    pub promised: bool,
    /// What went wrong, if anything did.
    pub error: Option<String>,
}

impl LeakTally {
    /// Whether no structure leaks that promises not to.
    pub fn is_tight(&self) -> bool {
        let promised = self.rows.iter().filter(|row| row.promised);
        promised.into_iter().all(|row| row.leaks == [0; 3] && row.error.is_none())
    }

    /// Leaks at faces, edges and corners over all meshes and scales, by structure, with its rays.
    pub fn sums(&self) -> Vec<(&str, u64, [u64; 3])> {
        let mut sums: Vec<(&str, u64, [u64; 3])> = Vec::new();
        for row in &self.rows {
            let place = sums.iter().position(|sum| sum.0 == row.structure).unwrap_or_else(|| {
                sums.push((&row.structure, 0, [0; 3]));
                sums.len() - 1
            });
            sums[place].1 += row.rays;
            sums[place].2.iter_mut().zip(row.leaks).for_each(|(sum, leaks)| *sum += leaks);
        }
        sums
    }
}

/// At least `least` rays in all for each structure; `listener` hears of every mesh and scale.
///
/// # Errors
/// A mesh that can't be had.
pub fn run(
    least: u64,
    seed: u64,
    choices: &[Choice],
    mut listener: impl Listener,
) -> Result<LeakTally, SceneError> {
    let parts = MESHES.len() * SCALES.len() * SETS.len();
    let side = ((least as f64 / parts as f64).sqrt().ceil() as u32).max(1);
    let mut tally = LeakTally::default();
    for mesh in MESHES {
        let plain = scenes::load(&mesh.parse()?)?;
        for scale in SCALES {
            listener.hear(&Event::MeshBegun { id: mesh, scale });
            let scene = scaled(&plain, scale);
            let (rays, rows) = one_mesh(mesh, scale, &scene, side, seed, choices).unwrap_or_default();
            tally.rays += rays;
            tally.rows.extend(rows);
        }
    }
    Ok(tally)
}

/// The same mesh with every coordinate multiplied and rounded: corners shared stay shared, so it stays closed.
fn scaled(scene: &Scene, scale: f32) -> Scene {
    let mut scene = scene.clone();
    if let Geometry::Triangles(mesh) = &mut scene.geometry {
        mesh.positions.iter_mut().for_each(|p| *p *= scale);
    }
    scene
}

fn one_mesh(
    mesh: &str,
    scale: f32,
    scene: &Scene,
    side: u32,
    seed: u64,
    choices: &[Choice],
) -> Result<(u64, Vec<LeakRow>), RaysError> {
    let tracer =
        Brute::new(KernelId::Exact).build(scene, &Workload::GENERAL).expect("brute force serves all");
    let mut oracle = None;
    let mut count = 0;
    let blank = |choice: &Choice| LeakRow {
        mesh: mesh.to_owned(),
        scale,
        structure: choice.spec.to_string(),
        rays: 0,
        leaks: [0; 3],
        promised: choice.built_in_kernel().is_some_and(KernelId::is_watertight),
        error: None,
    };
    let mut rows: Vec<LeakRow> = choices.iter().map(blank).collect();
    let built: Vec<_> =
        choices.iter().map(|choice| guarded_build(choice, scene, &Workload::GENERAL)).collect();
    for (kind, id) in SETS.into_iter().enumerate() {
        let rays = generate(scene, &RaysSpec { id, rows: side, cols: side, seed }, tracer.as_ref())?;
        count += rays.len() as u64;
        for (row, built) in rows.iter_mut().zip(&built) {
            let mut hits = vec![None; rays.len()];
            let traced = match built {
                Ok(accel) => guard("tracing", || accel.trace(&rays, &mut hits)).map_err(|e| e.to_string()),
                Err(failure) => Err(failure.to_string()),
            };
            row.rays += rays.len() as u64;
            row.error = traced.err().or(row.error.take());
            for i in (0..rays.len()).filter(|i| row.error.is_none() && hits[*i].is_none()) {
                let oracle = oracle.get_or_insert_with(|| oracle_of(scene));
                row.leaks[kind] += u64::from(oracle.closest(&rays.ray(i)).is_some());
            }
        }
    }
    Ok((count, rows))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry;

    #[test]
    fn watertight_kernels_are_tight_and_others_leak() {
        let ids = ["bmssm:kernel=exact", "ssm:kernel=watertight", "ssm:kernel=moller-trumbore"];
        let choices = ids.map(|id| registry::parse(id).unwrap());
        let tally = run(40_000, 1, &choices, ()).unwrap();
        assert!(tally.rays >= 40_000 && tally.rows.len() == 18, "{tally:?}");
        assert!(tally.is_tight(), "{tally:?}");
        let sums = tally.sums();
        assert_eq!((sums[0].2, sums[1].2), ([0; 3], [0; 3]));
        assert!(sums[2].2[1] + sums[2].2[2] > 0, "Möller–Trumbore leaks at edges or corners: {sums:?}");
    }
}
