//! Primitive tests of rays with the objects of a block: all of a traversal that is compiled for each kind of objects.

use super::beam::BeamRays;
use super::scratch::PairList;
use accel::{Nearest, Ray};
use lanes::packet::{Packet, Pairs};
use lanes::{BLOCK, Blocks, ROW, Simd, Task, next_bit};

/// Tests pairs of rays and objects. Answers the rays' nearest hits.
pub(super) struct TestPairs<'a, B> {
    pub objects: &'a B,
    pub block: usize,
    pub rays: &'a [Ray],
    pub best: &'a [Nearest],
    /// The rays that are in pairs, by number.
    pub ids: &'a [u16],
    pub pairs: &'a PairList,
    pub any: bool,
}

impl<B: Blocks> Task for TestPairs<'_, B> {
    type Out = [Nearest; ROW];

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> [Nearest; ROW] {
        let Self { objects, block, rays, best, ids, pairs, any } = self;
        let mut chosen = [&rays[usize::from(ids[0])]; ROW];
        let mut nearest = [Nearest::new(f32::NEG_INFINITY); ROW];
        for (lane, id) in ids.iter().enumerate().take(ROW) {
            (chosen[lane], nearest[lane]) = (&rays[usize::from(*id)], best[usize::from(*id)]);
        }
        let PairList { rays, slots, len } = pairs;
        let pairs = Pairs { block, packet: &Packet::gather(s, &chosen), rays, slots, len: *len, any };
        objects.pairs(s, &pairs, &mut nearest);
        nearest
    }
}

/// Tests a ray with its candidates, for the nearest hit or any. Answers whether it was.
pub(super) struct TestOne<'a, B: Blocks> {
    pub objects: &'a B,
    pub block: usize,
    pub candidates: u64,
    pub one: &'a B::One,
    pub best: &'a mut Nearest,
    pub any: bool,
}

impl<B: Blocks> Task for TestOne<'_, B> {
    type Out = bool;

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> bool {
        let Self { objects, block, candidates, one, best, any } = self;
        if any {
            let hit = objects.any(s, block, candidates, one, best.t);
            if hit {
                *best = Nearest { t: best.t, object: 0, u: 0.0, v: 0.0 };
            }
            return hit;
        }
        let before = best.t;
        objects.closest(s, block, candidates, one, best);
        best.t < before
    }
}

/// Tests the rays of a beam that are under way with the candidates of a block, for the nearest hits or any.
pub(super) struct TestBeam<'a, B> {
    pub objects: &'a B,
    pub block: usize,
    pub candidates: u64,
    pub rays: &'a mut BeamRays,
    pub any: bool,
}

/// What became of a beam.
pub(super) struct Tested {
    /// The rays that are still under way, as bits.
    pub on: u32,
    /// How many tests there were.
    pub tests: u64,
}

impl<B: Blocks> Task for TestBeam<'_, B> {
    type Out = Tested;

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Tested {
        let Self { objects, block, candidates, rays, any } = self;
        let mut tested = Tested { on: 0, tests: 0 };
        let off = s.splat(f32::NEG_INFINITY);
        for at in (0..ROW).step_by(S::LANES) {
            let mut best = rays.nearest(s, at);
            let mut on = s.bits(s.lt(off, best.t));
            if on == 0 {
                continue;
            }
            let many = objects.many(s, &rays.packet(s, at));
            let mut left = candidates;
            while on != 0
                && let Some(slot) = next_bit(&mut left)
            {
                tested.tests += u64::from(on.count_ones());
                objects.packet(s, block * BLOCK + slot, &many, &mut best);
                if any {
                    let hit = s.lt_u(best.object, s.splat_u(Nearest::NONE));
                    best.t = s.select(hit, off, best.t);
                    on = s.bits(s.lt(off, best.t));
                }
            }
            rays.set(s, at, &best);
            tested.on |= on << at;
        }
        tested
    }
}

/// Resolves what was found for a beam's rays.
pub(super) struct ResolveBeam<'a, B> {
    pub objects: &'a B,
    pub rays: &'a BeamRays,
    pub any: bool,
}

impl<B: Blocks> Task for ResolveBeam<'_, B> {
    type Out = [Nearest; ROW];

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> [Nearest; ROW] {
        let Self { objects, rays, any } = self;
        let mut nearest = [Nearest::new(0.0); ROW];
        for at in (0..ROW).step_by(S::LANES) {
            let mut found = rays.nearest(s, at);
            if !any {
                let many = objects.many(s, &rays.packet(s, at));
                objects.resolve_packet(s, &many, &mut found);
            }
            found.store(s, &mut nearest[at..]);
        }
        nearest
    }
}

/// Resolves what was deferred for each of the rays.
pub(super) struct ResolveEach<'a, B> {
    pub objects: &'a B,
    pub rays: &'a [Ray],
    pub best: &'a mut [Nearest],
}

impl<B: Blocks> Task for ResolveEach<'_, B> {
    type Out = ();

    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        self.objects.resolve_each(s, self.rays, self.best);
    }
}
