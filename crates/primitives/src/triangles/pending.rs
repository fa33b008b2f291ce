//! Hits that wait to be resolved.

use accel::Nearest;
use lanes::packet::{Bounds, Lanes, NearestPacket};
use lanes::{ROW, Simd};

/// A hit that is certain and nearer than any other so far, but whose t is known within bounds only.
///
/// It waits where the nearest hit is kept, told apart by a v that no hit has: nobody but this type looks at more of it
/// than t, its upper bound.
#[derive(Clone, Copy, Debug)]
pub(super) struct PendingHit {
    /// The slot of the object that is hit.
    pub slot: usize,
    /// The hit's t is this or more.
    pub low: f32,
    /// The hit's t is this or less.
    pub high: f32,
}

/// The `v` of pending hits.
const MARK: f32 = f32::INFINITY;

impl PendingHit {
    /// The hit that waits, if one does.
    #[inline(always)]
    pub fn in_place_of(best: &Nearest) -> Option<Self> {
        (best.v == MARK).then_some(Self { slot: best.object as usize, low: best.u, high: best.t })
    }

    /// Takes the place of the nearest hit.
    #[inline(always)]
    pub fn wait(self, best: &mut Nearest) {
        *best = Nearest { t: self.high, object: self.slot as u32, u: self.low, v: MARK };
    }
}

/// The t of the nearest hit so far, or a lower bound of it where it is pending.
#[inline(always)]
pub(super) fn lower_bound(best: &Nearest) -> f32 {
    PendingHit::in_place_of(best).map_or(best.t, |pending| pending.low)
}

/// The [`lower_bound`] of each of some rays.
pub(super) struct Floors(pub [f32; ROW]);

impl Floors {
    #[inline(always)]
    pub fn of<S: Simd>(s: S, best: &[Nearest; ROW]) -> Self {
        let mut floors = [0.0; ROW];
        for at in (0..ROW).step_by(S::LANES) {
            let [t, _, u, v] = load_nearest(s, &best[at..]);
            s.store(s.select(marked(s, v), u, t), &mut floors[at..]);
        }
        Self(floors)
    }
}

/// t, the bits of the object's number, and both surface coordinates of the first `LANES`.
#[inline(always)]
pub(super) fn load_nearest<S: Simd>(s: S, best: &[Nearest]) -> [S::F; 4] {
    let best = &best[..S::LANES];
    let mut quads = [best[0].quad(); ROW];
    for (quad, best) in quads.iter_mut().zip(best) {
        *quad = best.quad();
    }
    s.load_quads(&quads)
}

/// The lanes whose hits are pending.
#[inline(always)]
pub(super) fn pending<S: Simd>(s: S, best: &NearestPacket<S>) -> S::M {
    marked(s, best.v)
}

/// The lanes whose hits are pending, from their `v`.
#[inline(always)]
pub(super) fn marked<S: Simd>(s: S, v: S::F) -> S::M {
    s.eq(v, s.splat(MARK))
}

/// Lets those of the certain hits on the object in a slot wait that come before what is there for certain, and tells
/// which.
#[inline(always)]
pub(super) fn defer<S: Simd>(
    s: S,
    slot: usize,
    certain: S::M,
    bounds: &Bounds<S>,
    best: &mut NearestPacket<S>,
) -> S::M {
    let low = s.select(pending(s, best), best.u, best.t);
    let wins = s.and(certain, s.lt(bounds.high, low));
    let lanes = Lanes { hit: wins, t: bounds.high, u: bounds.low, v: s.splat(MARK) };
    best.take(s, wins, slot as u32, &lanes);
    wins
}
