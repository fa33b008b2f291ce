//! The ray sets by name.

use crate::near::near;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// What is asked of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Query {
    /// The nearest hit.
    Closest,
    /// Whether there is any hit up to t_max.
    Occluded,
}

/// What a ray set is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Camera rays: coherent, in rows and columns. For measuring.
    Image,
    /// A batch of rays in no order. For measuring.
    Batch,
    /// A batch that hunts for errors. For checking.
    Stress,
}

/// Parts of objects that rays are aimed at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// Points in faces.
    Face,
    /// Points of edges.
    Edge,
    /// Corners.
    Vertex,
}

/// What is known of a ray set.
#[derive(Clone, Copy, Debug)]
struct Entry {
    name: &'static str,
    kind: Kind,
    query: Query,
    needs_hits: bool,
    aims_at: Option<Feature>,
    from_inside: bool,
    from_surface: bool,
}

impl Entry {
    const fn new(name: &'static str, kind: Kind) -> Self {
        Self {
            name,
            kind,
            query: Query::Closest,
            needs_hits: false,
            aims_at: None,
            from_inside: false,
            from_surface: false,
        }
    }

    const fn image(name: &'static str) -> Self {
        Self::new(name, Kind::Image)
    }

    const fn batch(name: &'static str) -> Self {
        Self::new(name, Kind::Batch)
    }

    const fn stress(name: &'static str) -> Self {
        Self::new(name, Kind::Stress)
    }

    const fn occlusion(self) -> Self {
        Self { query: Query::Occluded, ..self }
    }

    const fn needs_hits(self) -> Self {
        Self { needs_hits: true, ..self }
    }

    const fn aimed_at(self, feature: Feature) -> Self {
        Self { aims_at: Some(feature), ..self }
    }

    const fn starting_inside(self) -> Self {
        Self { from_inside: true, ..self }
    }

    const fn starting_on_surfaces(self) -> Self {
        Self { from_surface: true, needs_hits: true, ..self }
    }
}

/// Declares the ray sets: a variant, its documentation, and what is known of it.
macro_rules! ray_sets {
    ($($(#[$doc:meta])* $id:ident: $entry:expr;)*) => {
        /// A ray set.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum RaysId {
            $($(#[$doc])* $id,)*
        }

        impl RaysId {
            /// All sets there are, those for measuring first.
            pub const ALL: [Self; [$(Self::$id),*].len()] = [$(Self::$id),*];

            const fn entry(self) -> Entry {
                match self {
                    $(Self::$id => $entry,)*
                }
            }
        }
    };
}

ray_sets! {
    /// An image by parallel rays that frames the scene's bounds along the view's direction.
    Parallel: Entry::image("parallel");
    /// The image that the scene's view says.
    Perspective: Entry::image("perspective");
    /// From the primary hits towards a light beside the eye.
    Shadow: Entry::batch("shadow").occlusion().needs_hits();
    /// From the primary hits into the hemisphere, as far as a fifth of the bounds' diagonal.
    Ambient: Entry::batch("ambient").occlusion().needs_hits();
    /// From the primary hits into the hemisphere, cosine-weighted, unbounded.
    Diffuse: Entry::batch("diffuse").needs_hits();
    /// From around the scene through points uniform in its bounds.
    Random: Entry::batch("random");
    /// Parallel to an axis, most of them exactly in planes between slices or through corners, the other
    /// components 0 or −0.
    Axis: Entry::batch("axis");
    /// Origins exactly on the faces, edges and corners of the bounds, and outside.
    Bounds: Entry::stress("bounds");
    /// Origins inside objects' boxes and on their surfaces.
    Inside: Entry::stress("inside");
    /// Aimed at points of objects' edges, from outside and inside the bounds.
    Edge: Entry::stress("edge").aimed_at(Feature::Edge);
    /// Aimed at objects' corners.
    Vertex: Entry::stress("vertex").aimed_at(Feature::Vertex);
    /// In the plane of an object's face, along its edges and across.
    Plane: Entry::stress("plane");
    /// Direction components of ±0, denormal, 1e-30, and very large ones.
    Directions: Entry::stress("directions");
    /// Origins at hit points, not offset.
    Surface: Entry::stress("surface").starting_on_surfaces();
    /// Ranges [t_min, t_max] that begin or end exactly at a hit.
    Range: Entry::stress("range").needs_hits();
    /// From the inner quarter of the bounds at points in faces: on a closed mesh around its centre each hits.
    LeakFace: Entry::stress("leak-face").aimed_at(Feature::Face).starting_inside();
    /// The same at edges.
    LeakEdge: Entry::stress("leak-edge").aimed_at(Feature::Edge).starting_inside();
    /// The same at corners.
    LeakVertex: Entry::stress("leak-vertex").aimed_at(Feature::Vertex).starting_inside();
}

impl RaysId {
    /// The sets for measuring.
    pub fn measured() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|id| !id.is_stress())
    }

    /// The sets that only checks use.
    pub fn stress() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|id| id.is_stress())
    }

    /// The set's name.
    pub const fn name(self) -> &'static str {
        self.entry().name
    }

    /// What the set is for.
    pub const fn kind(self) -> Kind {
        self.entry().kind
    }

    /// What is asked of its rays.
    pub const fn query(self) -> Query {
        self.entry().query
    }

    /// Whether its rays are the camera rays of an image.
    pub const fn is_image(self) -> bool {
        matches!(self.kind(), Kind::Image)
    }

    /// Whether it hunts for errors.
    pub const fn is_stress(self) -> bool {
        matches!(self.kind(), Kind::Stress)
    }

    /// Whether its rays depend on hits.
    pub const fn needs_hits(self) -> bool {
        self.entry().needs_hits
    }

    /// The parts of objects that its rays are aimed at, if they are.
    pub const fn aims_at(self) -> Option<Feature> {
        self.entry().aims_at
    }

    /// Whether its rays start inside a closed mesh, so that one that hits nothing has leaked.
    pub const fn starts_inside(self) -> bool {
        self.entry().from_inside
    }

    /// Whether its rays start at hit points, rounded and not offset.
    pub const fn starts_on_surfaces(self) -> bool {
        self.entry().from_surface
    }
}

impl fmt::Display for RaysId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for RaysId {
    type Err = RaysError;

    fn from_str(text: &str) -> Result<Self, RaysError> {
        Self::ALL.into_iter().find(|id| id.name() == text).ok_or_else(|| RaysError::Unknown {
            id: text.to_owned(),
            near: near(text, Self::ALL.iter().map(|id| id.name())),
        })
    }
}

/// Why there are no rays.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RaysError {
    /// No set of this name.
    #[error("there is no ray set `{id}`; near: {}; there are: {}", .near.join(", "), RaysId::ALL.map(RaysId::name).join(", "))]
    Unknown {
        /// What was asked for.
        id: String,
        /// Similar names, nearest first.
        near: Vec<String>,
    },
    /// Memory does not suffice for the rays and what they hit.
    #[error(
        "{count} `{rays}` rays and their hits take {bytes} bytes, more than the {available} there are; choose a smaller --size"
    )]
    TooLarge {
        /// The set.
        rays: RaysId,
        /// How many there would be.
        count: u128,
        /// What they would take.
        bytes: u128,
        /// What there is.
        available: u128,
    },
    /// Rays of this set start from hits, and there are none.
    #[error("`{rays}` rays start from hits, and none of the rays that look for them meets scene `{scene}`")]
    NoHits {
        /// The set.
        rays: RaysId,
        /// The scene.
        scene: String,
    },
    /// The scene's camera or coordinates make a ray that structures don't accept.
    #[error("`{rays}` rays of scene `{scene}` can't be traced: {source}")]
    Unusable {
        /// The set.
        rays: RaysId,
        /// The scene.
        scene: String,
        /// What is wrong with the first such ray.
        source: accel::RayError,
    },
    /// Rays of this set aim at objects, and there are none.
    #[error("`{rays}` rays aim at objects, and scene `{scene}` has none")]
    NoObjects {
        /// The set.
        rays: RaysId,
        /// The scene.
        scene: String,
    },
}
