//! Embree through the safe API of the crate [embree4-rs](https://docs.rs/embree4-rs), to measure what that costs.
//!
//! The crate has no test for occlusion, so that question is answered by the nearest hit. It has no packets, shows no
//! memory monitor, and copies the geometry.

use std::fmt::Display;

use accel::{Accel, BuildError, Builder, Footprint, Geometry, Hit, Mesh, Ray, Scene, Workload};
use embree4_rs::geometry::TriangleMeshGeometry;
use embree4_rs::{CommittedScene, SceneOptions};

use crate::device::Device;
use crate::scene::{EmbreeScene, SceneSettings, check_indices, found, single};

const ID: &str = "embree-rs";

/// Builds a scene of triangles as embree4-rs does with its defaults.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WrapperBuilder;

fn failed(error: impl Display) -> BuildError {
    BuildError::Library { structure: ID.to_owned(), message: error.to_string() }
}

impl Builder for WrapperBuilder {
    fn id(&self) -> &str {
        ID
    }

    fn settings(&self) -> String {
        "quality=medium".to_owned()
    }

    fn build<'s>(&self, scene: &'s Scene, _: &Workload) -> Result<Box<dyn Accel + 's>, BuildError> {
        let Geometry::Triangles(mesh) = &scene.geometry else {
            let what = format!("{}: Embree has triangles", scene.geometry.kind());
            return Err(BuildError::Unsupported { structure: ID.to_owned(), what });
        };
        // The crate passes indices on unchecked.
        check_indices(mesh).map_err(failed)?;
        let threads = rayon::current_num_threads();
        let scene = committed(mesh, threads).map_err(|error| failed(format!("{error:#}")))?;
        Ok(Box::new(Built { scene, mesh, threads }))
    }
}

fn committed(mesh: &Mesh, threads: usize) -> Result<CommittedScene, impl Display> {
    let positions: Vec<_> = mesh.positions.iter().map(|p| (p.x, p.y, p.z)).collect();
    let triangles: Vec<_> = mesh.triangles.iter().map(|&[a, b, c]| (a, b, c)).collect();
    // The crate passes the text on as it is, and C reads on to a NUL.
    let device = embree4_rs::Device::try_new(Some(&format!("threads={threads}\0")))?;
    let scene = embree4_rs::Scene::try_new(device, SceneOptions::default())?;
    if !triangles.is_empty() {
        let geometry = TriangleMeshGeometry::try_new(&scene.device, &positions, &triangles)?;
        // The scene keeps a reference, so ours may go.
        scene.attach_geometry(&geometry)?;
    }
    scene.commit()
}

struct Built<'s> {
    scene: CommittedScene,
    mesh: &'s Mesh,
    threads: usize,
}

// SAFETY: the scene and its device are handles, which Embree allows to be used and released from any thread; nothing
// of them belongs to the thread that made them. (embree4-rs itself says that the scene may be shared.)
unsafe impl Send for Built<'_> {}

impl Built<'_> {
    /// What Embree holds for the same scene built without the crate, as its memory monitor says.
    fn held_by_a_twin(&self) -> usize {
        let twin = Device::new(self.threads)
            .and_then(|device| EmbreeScene::new(device, self.mesh, SceneSettings::default()));
        twin.map_or(0, |twin| usize::try_from(twin.memory().now).unwrap_or(usize::MAX))
    }
}

impl Accel for Built<'_> {
    #[inline]
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        match self.scene.intersect_1(single(ray), None) {
            Ok(Some(rayhit)) => Some(found(&rayhit)),
            // An error would say that the scene isn't committed, which its type rules out.
            Ok(None) | Err(_) => None,
        }
    }

    #[inline]
    fn occluded(&self, ray: &Ray) -> bool {
        self.closest(ray).is_some()
    }

    fn footprint(&self) -> Footprint {
        let positions = size_of_val(self.mesh.positions.as_slice());
        let triangles = size_of_val(self.mesh.triangles.as_slice());
        Footprint::default()
            .structure("memory monitor of a twin", self.held_by_a_twin())
            .geometry_copy("positions", positions)
            .geometry_copy("triangles", triangles)
    }

    fn plan(&self) -> String {
        let version = crate::version().map_or_else(
            |error| error.to_string(),
            |(major, minor, patch)| format!("Embree {major}.{minor}.{patch}"),
        );
        format!("{version} through embree4-rs {VERSION}")
    }
}

/// The version of embree4-rs that the workspace pins.
pub const VERSION: &str = "0.0.16";
