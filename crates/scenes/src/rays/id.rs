//! The ray sets by name.

use crate::near::near;
use std::fmt;
use std::str::FromStr;

/// What is asked of a set's rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// The nearest hit.
    Closest,
    /// Whether there is a hit up to a finite t.
    Occlusion,
}

/// A ray set. The first seven are for measuring, the others for checking.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RaysId {
    /// An image by parallel rays that frames the scene's bounds along the view's direction.
    Parallel,
    /// The image that the scene's view says.
    Perspective,
    /// From the primary hits towards a light beside the eye.
    Shadow,
    /// From the primary hits into the hemisphere, as far as a fifth of the bounds' diagonal.
    Ambient,
    /// From the primary hits into the hemisphere, cosine-weighted, unbounded.
    Diffuse,
    /// From around the scene through points uniform in its bounds.
    Random,
    /// Parallel to an axis, most of them exactly in planes between slices or through corners, the other
    /// components 0 or −0.
    Axis,
    /// Origins exactly on the faces, edges and corners of the bounds, and outside.
    Bounds,
    /// Origins inside objects' boxes and on their surfaces.
    Inside,
    /// Aimed at points of objects' edges, from outside and inside the bounds.
    Edge,
    /// Aimed at objects' corners.
    Vertex,
    /// In the plane of an object's face, along its edges and across.
    Plane,
    /// Direction components of ±0, denormal, 1e-30, and very large ones.
    Directions,
    /// Origins at hit points, not offset.
    Surface,
    /// Ranges [t_min, t_max] that begin or end exactly at a hit.
    Range,
    /// From the inner quarter of the bounds at points in faces: on a closed mesh around its centre each hits.
    LeakFace,
    /// The same at edges.
    LeakEdge,
    /// The same at corners.
    LeakVertex,
}

impl RaysId {
    /// All sets there are.
    pub const ALL: [Self; 18] = [
        Self::Parallel,
        Self::Perspective,
        Self::Shadow,
        Self::Ambient,
        Self::Diffuse,
        Self::Random,
        Self::Axis,
        Self::Bounds,
        Self::Inside,
        Self::Edge,
        Self::Vertex,
        Self::Plane,
        Self::Directions,
        Self::Surface,
        Self::Range,
        Self::LeakFace,
        Self::LeakEdge,
        Self::LeakVertex,
    ];

    /// The sets for measuring.
    pub const MEASURED: [Self; 7] = [
        Self::Parallel,
        Self::Perspective,
        Self::Shadow,
        Self::Ambient,
        Self::Diffuse,
        Self::Random,
        Self::Axis,
    ];

    /// The sets that only checks use.
    pub fn torture() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|id| !Self::MEASURED.contains(id))
    }

    /// The set's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Parallel => "parallel",
            Self::Perspective => "perspective",
            Self::Shadow => "shadow",
            Self::Ambient => "ambient",
            Self::Diffuse => "diffuse",
            Self::Random => "random",
            Self::Axis => "axis",
            Self::Bounds => "bounds",
            Self::Inside => "inside",
            Self::Edge => "edge",
            Self::Vertex => "vertex",
            Self::Plane => "plane",
            Self::Directions => "directions",
            Self::Surface => "surface",
            Self::Range => "range",
            Self::LeakFace => "leak-face",
            Self::LeakEdge => "leak-edge",
            Self::LeakVertex => "leak-vertex",
        }
    }

    /// What is asked of its rays.
    pub const fn query(self) -> Query {
        match self {
            Self::Shadow | Self::Ambient => Query::Occlusion,
            _ => Query::Closest,
        }
    }

    /// Whether its rays are the primary rays of an image.
    pub const fn is_raster(self) -> bool {
        matches!(self, Self::Parallel | Self::Perspective)
    }

    /// Whether its rays depend on hits.
    pub const fn needs_hits(self) -> bool {
        matches!(self, Self::Shadow | Self::Ambient | Self::Diffuse | Self::Surface | Self::Range)
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
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RaysError {
    /// No set of this name.
    #[error("there is no ray set `{id}`; near: {}; there are: {}", .near.join(", "), RaysId::ALL.map(RaysId::name).join(", "))]
    Unknown {
        /// What was asked for.
        id: String,
        /// Similar names, nearest first.
        near: Vec<String>,
    },
    /// Rays of this set start from hits, and there are none.
    #[error("`{rays}` rays start from hits, and none of the rays that look for them meets scene `{scene}`")]
    NoHits {
        /// The set.
        rays: RaysId,
        /// The scene.
        scene: String,
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
