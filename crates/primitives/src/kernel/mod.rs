//! Ray-triangle tests as type parameters.
//!
//! A kernel is written once, over the lanes of [`Simd`], and used in two ways: one ray
//! against several triangles (lists of rays) and several rays against one triangle
//! (rasters). Both, and the scalar form, give the same bits.
//!
//! A new kernel is a file with the few functions of [`Kernel`]. Two capabilities come on top where they pay: what is the
//! same for all rays of an image is computed once ([`Preparation`]), and hits that are certain wait until the nearest is
//! known ([`Deferral`]).

mod baldwin_weber;
mod bounding_box;
mod deferral;
mod double;
mod exact;
mod moller_trumbore;
mod preparation;
mod quantised;
mod watertight;
mod wide;

pub use baldwin_weber::BaldwinWeber;
pub use bounding_box::BoundingBox;
pub use deferral::{Deferral, Immediate};
pub use double::Double;
pub use exact::Exact;
pub use moller_trumbore::MollerTrumbore;
pub use preparation::{Preparation, Unprepared};
pub use quantised::Quantised;
pub use watertight::Watertight;

use accel::settings::none_of;
use accel::{Corners, Ray, Surface, Vec3};
use lanes::packet::{Lanes, Packet, Vec3Lanes};
use lanes::{ROW, Row, Scalar, Simd};

/// A ray-triangle test.
pub trait Kernel: Copy + Default + Send + Sync + 'static {
    /// The kernel's name.
    const ID: KernelId;
    /// Rows of packed geometry for each group of [`ROW`] triangles.
    const ROWS: usize = 9;
    /// Whether geometry of extreme size is scaled by a power of two before the kernel sees it, since its products
    /// of coordinates would under- or overflow.
    const NORMALISED: bool = true;
    /// Whether it sees corners rounded to 16 bits a coordinate, which are kept so and unpacked for a test. It then packs the nine
    /// rows of corners and defers nothing.
    const QUANTISED: bool = false;
    /// What is computed beforehand for rays with a point or a direction in common: the kernel itself if it implements
    /// [`Preparation`], else [`Unprepared`].
    type Prepared: Preparation<Self>;
    /// What is known before a test is decided: the kernel itself if it implements [`Deferral`], else [`Immediate`].
    type Deferral: Deferral<Self>;
    /// What is computed once for a ray.
    type One: Copy + Send + Sync;
    /// What is computed once for `LANES` rays.
    type Many<S: Simd>: Copy;

    /// Writes a triangle to lane `lane` of a group of [`Kernel::ROWS`] rows.
    #[inline(always)]
    fn pack(corners: &Corners, group: &mut [Row], lane: usize) {
        pack_corners(corners, group, lane);
    }

    /// The corners packed in lane `lane`, or others with the same box; `None` where the rows don't hold them.
    #[inline(always)]
    fn corners(group: &[Row], lane: usize) -> Option<Corners> {
        Some(unpack_corners(group, lane))
    }

    /// Prepares one ray.
    fn one(ray: &Ray) -> Self::One;

    /// Prepares `LANES` rays.
    fn many<S: Simd>(s: S, rays: &Packet<S>) -> Self::Many<S>;

    /// One ray against the triangles in lanes `at .. at + LANES` of a group, with t up to `t_max`. Nobody looks at
    /// the answers of other lanes than those whose bits are `wanted`.
    fn triangles<S: Simd>(
        s: S,
        ray: &Self::One,
        group: &[Row],
        at: usize,
        wanted: u32,
        t_max: f32,
    ) -> Lanes<S>;

    /// `LANES` rays against the triangle in lane `lane` of a group, with t up to `t_max`.
    fn rays<S: Simd>(s: S, rays: &Self::Many<S>, group: &[Row], lane: usize, t_max: S::F) -> Lanes<S>;

    /// Whether there is [`Kernel::each`].
    const EACH: bool = false;

    /// Each ray against the triangle in its own lane, given by its corners, with the bits of [`Kernel::rays`]. Called only for
    /// kernels with [`Kernel::EACH`], which pack nine rows of corners and defer nothing.
    #[inline(always)]
    fn each<S: Simd>(s: S, rays: &Packet<S>, corners: [Vec3Lanes<S>; 3], t_max: S::F) -> Lanes<S> {
        let _ = (corners, t_max);
        Lanes { hit: s.mask(0), t: rays.t_max, u: rays.t_max, v: rays.t_max }
    }

    /// One ray against one triangle.
    #[inline]
    fn test(ray: &Self::One, corners: &Corners, t_max: f32) -> Option<Surface> {
        const MOST_ROWS: usize = 16;
        const { assert!(Self::ROWS <= MOST_ROWS) };
        let mut group = [Row([0.0; ROW]); MOST_ROWS];
        Self::pack(corners, &mut group[..Self::ROWS], 0);
        let Lanes { hit, t, u, v } = Self::triangles(Scalar, ray, &group[..Self::ROWS], 0, 1, t_max);
        hit.then_some(Surface { t, u, v })
    }
}

/// Names a kernel in settings and records.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum KernelId {
    /// [`MollerTrumbore`]
    MollerTrumbore,
    /// [`BaldwinWeber`]
    BaldwinWeber,
    /// [`Watertight`]
    Watertight,
    /// [`Double`]
    Double,
    /// [`Exact`]
    Exact,
    /// [`Quantised`]
    Quantised,
    /// [`BoundingBox`]
    BoundingBox,
}

impl KernelId {
    /// All kernels there are.
    pub const ALL: [Self; 7] = [
        Self::MollerTrumbore,
        Self::BaldwinWeber,
        Self::Watertight,
        Self::Double,
        Self::Exact,
        Self::Quantised,
        Self::BoundingBox,
    ];

    /// Whether it takes the scene for another one: made for what is cheaper still, and wrong by design.
    pub const fn is_lossy(self) -> bool {
        matches!(self, Self::Quantised | Self::BoundingBox)
    }

    /// Whether no ray slips between two triangles that share an edge.
    pub const fn is_watertight(self) -> bool {
        matches!(self, Self::Watertight | Self::Exact)
    }

    /// Name as used in settings and records.
    pub const fn id(self) -> &'static str {
        match self {
            Self::MollerTrumbore => "moller-trumbore",
            Self::BaldwinWeber => "baldwin-weber",
            Self::Watertight => "watertight",
            Self::Double => "double",
            Self::Exact => "exact",
            Self::Quantised => "quantised",
            Self::BoundingBox => "box",
        }
    }

    /// The kernel of that name.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kernel| kernel.id() == id)
    }

    /// A setting's value: the kernel of that name.
    ///
    /// # Errors
    /// There is none of that name; the text says which there are.
    pub fn parse(value: &str) -> Result<Self, String> {
        Self::from_id(value).ok_or_else(|| none_of(value, Self::ALL.map(Self::id)))
    }

    /// Calls `with` with the kernel as a type.
    #[inline]
    pub fn with<W: WithKernel>(self, with: W) -> W::Out {
        match self {
            Self::MollerTrumbore => with.kernel::<MollerTrumbore>(),
            Self::BaldwinWeber => with.kernel::<BaldwinWeber>(),
            Self::Watertight => with.kernel::<Watertight>(),
            Self::Double => with.kernel::<Double>(),
            Self::Exact => with.kernel::<Exact>(),
            Self::Quantised => with.kernel::<Quantised>(),
            Self::BoundingBox => with.kernel::<BoundingBox>(),
        }
    }
}

impl std::fmt::Display for KernelId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.id())
    }
}

/// Code that is generic over the kernel.
pub trait WithKernel {
    /// What it computes.
    type Out;
    /// Does it with kernel `K`.
    fn kernel<K: Kernel>(self) -> Self::Out;
}

/// Writes corners to the first nine rows.
#[inline(always)]
pub(crate) fn pack_corners(corners: &Corners, group: &mut [Row], lane: usize) {
    for (corner, rows) in corners.iter().zip(group.chunks_exact_mut(3)) {
        for (axis, row) in rows.iter_mut().enumerate() {
            row.0[lane] = corner[axis];
        }
    }
}

/// The corners that [`pack_corners`] wrote to lane `lane`.
#[inline(always)]
pub(crate) fn unpack_corners(group: &[Row], lane: usize) -> Corners {
    let rows = &group[..9];
    let corner = |k: usize| Vec3::new(rows[k].0[lane], rows[k + 1].0[lane], rows[k + 2].0[lane]);
    [corner(0), corner(3), corner(6)]
}

// Plain functions and no closures: only what is `#[inline(always)]` is sure to be compiled
// with the instruction set of its caller.

/// The corners of `LANES` packed triangles from lane `at` on.
#[inline(always)]
pub(crate) fn load_corners<S: Simd>(s: S, group: &[Row], at: usize) -> [Vec3Lanes<S>; 3] {
    let rows = &group[..9];
    [load3(s, &rows[..3], at), load3(s, &rows[3..6], at), load3(s, &rows[6..], at)]
}

#[inline(always)]
pub(crate) fn load3<S: Simd>(s: S, rows: &[Row], at: usize) -> Vec3Lanes<S> {
    [s.load(&rows[0].0[at..]), s.load(&rows[1].0[at..]), s.load(&rows[2].0[at..])]
}

/// The corners of one packed triangle in all lanes.
#[inline(always)]
pub(crate) fn splat_corners<S: Simd>(s: S, group: &[Row], lane: usize) -> [Vec3Lanes<S>; 3] {
    let rows = &group[..9];
    [splat_row3(s, &rows[..3], lane), splat_row3(s, &rows[3..6], lane), splat_row3(s, &rows[6..], lane)]
}

/// Three packed values of one lane in all lanes.
#[inline(always)]
pub(crate) fn splat_row3<S: Simd>(s: S, rows: &[Row], lane: usize) -> Vec3Lanes<S> {
    [s.splat(rows[0].0[lane]), s.splat(rows[1].0[lane]), s.splat(rows[2].0[lane])]
}

/// Writes three rows from lane `at` on.
#[inline(always)]
pub(crate) fn store_rows<S: Simd>(s: S, v: Vec3Lanes<S>, rows: &mut [Row], at: usize) {
    for (v, row) in v.into_iter().zip(rows) {
        s.store(v, &mut row.0[at..]);
    }
}

/// a − b
#[inline(always)]
pub(crate) fn sub3<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>) -> Vec3Lanes<S> {
    [s.sub(a[0], b[0]), s.sub(a[1], b[1]), s.sub(a[2], b[2])]
}

/// ad − bc
#[inline(always)]
pub(crate) fn det2<S: Simd>(s: S, a: S::F, b: S::F, c: S::F, d: S::F) -> S::F {
    s.sub(s.mul(a, d), s.mul(b, c))
}

/// a × b
#[inline(always)]
pub(crate) fn cross3<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>) -> Vec3Lanes<S> {
    [det2(s, a[1], a[2], b[1], b[2]), det2(s, a[2], a[0], b[2], b[0]), det2(s, a[0], a[1], b[0], b[1])]
}

/// a · b, summed from x to z
#[inline(always)]
pub(crate) fn dot3<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>) -> S::F {
    s.add(s.add(s.mul(a[0], b[0]), s.mul(a[1], b[1])), s.mul(a[2], b[2]))
}

#[cfg(test)]
mod tests;
