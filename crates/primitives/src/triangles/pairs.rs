//! Rays and triangles in pairs, one in each lane.

use super::{Kernel, TriangleBlocks, next_lane};
use crate::kernel::Deferral;
use accel::Nearest;
use lanes::packet::{Packet, Pairs, RayRows};
use lanes::{BLOCK, ROW, Simd};

impl<K: Kernel> TriangleBlocks<'_, K> {
    /// [`lanes::Blocks::pairs`]. A ray's tests are all begun with the nearest hit that was known before those
    /// beside them.
    #[inline(always)]
    pub(super) fn each_pair<S: Simd>(
        &self,
        s: S,
        block: usize,
        pairs: &Pairs,
        lanes: &Packet<S>,
        any: bool,
        best: &mut [Nearest; ROW],
    ) {
        const { assert!(!K::EACH || (K::ROWS == 9 && !K::Deferral::DEFERS)) };
        let frame = &self.triangles.frame;
        let scaled = frame.packet(s, lanes);
        let rows = RayRows::of(s, lanes);
        let mut t_max = [0.0; ROW];
        for (t_max, best) in t_max.iter_mut().zip(&*best) {
            *t_max = best.t;
        }
        let first = block * (BLOCK / ROW) * K::ROWS;
        let packed = &self.rows[first..first + BLOCK / ROW * K::ROWS];
        for at in (0..pairs.len).step_by(S::LANES) {
            let left = pairs.len - at;
            let wanted = if left < S::LANES { (1 << left) - 1 } else { u32::MAX };
            let (ray_places, slots) = (&pairs.rays[at..], &pairs.slots[at..]);
            let slot = s.load_bytes(slots);
            let ray = s.load_bytes(ray_places);
            let mut corners = [[s.splat(0.0); 3]; 3];
            for (corner, values) in corners.iter_mut().enumerate() {
                for (axis, value) in values.iter_mut().enumerate() {
                    let row = &packed[3 * corner + axis..];
                    *value = s.lookup([&row[0], &row[9], &row[18], &row[27]], slot);
                }
            }
            let found = K::each(s, &scaled.permuted(s, ray), corners, s.permute(s.load(&t_max), ray));
            let mut hits = s.bits(found.hit) & wanted;
            if hits == 0 {
                continue;
            }
            let found = found.rows(s);
            while let Some(lane) = next_lane(&mut hits) {
                let (slot, place) = (block * BLOCK + usize::from(slots[lane]), usize::from(ray_places[lane]));
                let surface = found.surface(lane);
                let ray = rows.ray(place);
                let corners = self.corners(self.packed(slot), slot);
                if frame.holds(&corners, &ray, frame.is_near(ray.origin), surface.t) {
                    best[place].offer(self.ids.get(slot), surface);
                    t_max[place] = if any { f32::NEG_INFINITY } else { best[place].t };
                }
            }
        }
    }
}
