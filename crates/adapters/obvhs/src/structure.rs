//! obvhs' trees as structures of the comparison.

use std::panic::{AssertUnwindSafe, catch_unwind};

use accel::{Accel, BuildError, Builder, Footprint, Geometry, Hit, Mesh, Objects, Ray, Scene, Workload};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::cwbvh::CwBvh;
use obvhs::rt_triangle::{RtCompressedTriangle, RtTriangle};
use primitives::Boxes;
use solids::Solids;

use crate::leaves::{Leaves, ObjectLeaves, Packed, TriangleLeaves, bounds_of, triangles_of};
use crate::tree::Tree;

/// Which of obvhs' trees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// Binary, nodes of 48 bytes.
    Bvh2,
    /// Eight-wide and compressed, nodes of 80 bytes.
    CwBvh,
}

impl Variant {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Bvh2, Self::CwBvh];

    /// Its id as a structure.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Bvh2 => "obvhs-bvh2",
            Self::CwBvh => "obvhs-cwbvh",
        }
    }
}

/// obvhs' own presets of build time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preset {
    /// `fastest_build`.
    Fastest,
    /// `medium_build`.
    #[default]
    Medium,
    /// `very_slow_build`, which splits large triangles beforehand.
    VerySlow,
}

impl Preset {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Fastest, Self::Medium, Self::VerySlow];

    /// Its name as a setting.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Fastest => "fastest",
            Self::Medium => "medium",
            Self::VerySlow => "very-slow",
        }
    }

    /// The preset of that name.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.id() == id)
    }

    const fn parameters(self) -> BvhBuildParams {
        match self {
            Self::Fastest => BvhBuildParams::fastest_build(),
            Self::Medium => BvhBuildParams::medium_build(),
            Self::VerySlow => BvhBuildParams::very_slow_build(),
        }
    }
}

/// Builds obvhs' trees, on one thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObvhsBuilder {
    /// Which tree.
    pub variant: Variant,
    /// Time allowed for the build.
    pub preset: Preset,
    /// Whether triangles are kept with their edges in 16-bit floats: in 24 bytes instead of 64, and not where the scene has them.
    pub compressed: bool,
}

impl ObvhsBuilder {
    /// With the medium preset.
    pub const fn new(variant: Variant) -> Self {
        Self { variant, preset: Preset::Medium, compressed: false }
    }
}

impl Builder for ObvhsBuilder {
    fn id(&self) -> &str {
        self.variant.id()
    }

    fn settings(&self) -> String {
        let triangles = if self.compressed { " triangles=compressed" } else { "" };
        format!("build={}{triangles}", self.preset.id())
    }

    fn build<'s>(&self, scene: &'s Scene, _: &Workload) -> Result<Box<dyn Accel + 's>, BuildError> {
        if scene.geometry.is_empty() {
            return Ok(Box::new(Nothing));
        }
        self.within_reach(&scene.geometry)?;
        let parameters = self.preset.parameters();
        // obvhs asserts what geometry must be like; one failed cell must not end a run.
        let built = catch_unwind(AssertUnwindSafe(|| match self.variant {
            Variant::Bvh2 => self.built::<Bvh2>(&scene.geometry, parameters),
            Variant::CwBvh => self.built::<CwBvh>(&scene.geometry, parameters),
        }));
        built.map_err(|panic| BuildError::Library {
            structure: self.variant.id().to_owned(),
            message: format!("obvhs 0.4's builder panicked: {}", words_of(panic.as_ref())),
        })
    }
}

/// What a panic said.
fn words_of(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("it panicked").to_owned()
}

impl ObvhsBuilder {
    /// Refuses what obvhs can't order: it compares surface areas in single precision, and where they are infinite the
    /// builder of its BVH2 may never end, and that of its CWBVH read past its nodes or fill the stack, which nothing
    /// catches.
    fn within_reach(&self, geometry: &Geometry) -> Result<(), BuildError> {
        let bounds = geometry.bounds();
        let size = bounds.max - bounds.min;
        if (size.x * size.y + size.y * size.z + size.z * size.x).is_finite() {
            return Ok(());
        }
        let message = format!(
            "extents of {size} are out of obvhs' reach: its builders compare surface areas, which are infinite in \
             single precision here, and then panic, exhaust the stack or never end"
        );
        Err(BuildError::Library { structure: self.variant.id().to_owned(), message })
    }

    fn built<'s, T: Tree + 's>(
        &self,
        geometry: &'s Geometry,
        parameters: BvhBuildParams,
    ) -> Box<dyn Accel + 's> {
        match geometry {
            Geometry::Triangles(mesh) if self.compressed => {
                over_triangles::<T, RtCompressedTriangle>(mesh, parameters)
            }
            Geometry::Triangles(mesh) => over_triangles::<T, RtTriangle>(mesh, parameters),
            Geometry::Boxes(boxes) => over_objects::<T, _>(Boxes::new(boxes), parameters),
            Geometry::Solids(solids) => over_objects::<T, _>(Solids::new(solids), parameters),
        }
    }
}

/// A tree over the boxes of objects of any kind, which it asks through a closure.
fn over_objects<'s, T: Tree + 's, O: Objects + 's>(
    objects: O,
    parameters: BvhBuildParams,
) -> Box<dyn Accel + 's> {
    let tree = T::of_boxes(&bounds_of(&objects), parameters);
    let leaves = ObjectLeaves::new(objects, tree.order());
    Box::new(Built { tree, leaves })
}

fn over_triangles<'s, T: Tree + 's, P: Packed + 's>(
    mesh: &'s Mesh,
    parameters: BvhBuildParams,
) -> Box<dyn Accel + 's> {
    let triangles = triangles_of::<P>(mesh);
    let tree = T::of_triangles(&triangles, parameters);
    let leaves = TriangleLeaves::<P>::new(&triangles, tree.order());
    Box::new(Built { tree, leaves })
}

struct Built<T, L> {
    tree: T,
    leaves: L,
}

#[inline(always)]
fn converted(ray: &Ray) -> obvhs::ray::Ray {
    obvhs::ray::Ray::new(ray.origin.into(), ray.direction.into(), ray.t_min, ray.t_max)
}

impl<T: Tree, L: Leaves> Accel for Built<T, L> {
    #[inline]
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        let ray = converted(ray);
        let (t, slot) = self.tree.closest(ray, |ray, slot| self.leaves.hit(slot, ray))?;
        let (u, v) = self.leaves.surface(slot, &ray);
        Some(Hit { t, object: self.tree.order()[slot], u, v })
    }

    #[inline]
    fn occluded(&self, ray: &Ray) -> bool {
        !self.tree.clear(converted(ray), |ray, slot| self.leaves.hit(slot, ray))
    }

    fn footprint(&self) -> Footprint {
        let [(nodes, node_bytes), (indices, index_bytes)] = self.tree.bytes();
        Footprint::default()
            .structure(nodes, node_bytes)
            .structure(indices, index_bytes)
            .geometry_copy("objects", self.leaves.bytes())
    }
}

/// No objects, no tree.
struct Nothing;

impl Accel for Nothing {
    fn closest(&self, _: &Ray) -> Option<Hit> {
        None
    }

    fn footprint(&self) -> Footprint {
        Footprint::default()
    }
}

#[cfg(test)]
mod tests;
