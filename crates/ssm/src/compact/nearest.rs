//! The nearest hits of rays.

use super::Built;
use super::abreast::{Lanes, VisitEach, Walks};
use super::alone::{Walking, walk};
use super::chunk::Chunk;
use super::objects::{Objects, Tested};
use super::queue::{Queue, UnitRays};
use accel::{Count, Nearest, Ray};
use lanes::{Blocks, PackedObjects, ROW, Simd, next_lane};

/// All lanes.
const LANES: u32 = u32::MAX >> (32 - ROW);

/// Rays on their way through the cells side by side.
struct Abreast<'a, 'o, S, B: Blocks, C, const BOXED: bool> {
    objects: &'a mut Objects<'o, S, B, C, false, BOXED>,
    rays: &'a mut [Tested<B::One>; ROW],
    walking: &'a mut [Walking; ROW],
    unit: &'a mut UnitRays,
    queue: &'a mut Queue,
}

impl<S: Simd, B: Blocks, C: Count, const BOXED: bool> Abreast<'_, '_, S, B, C, BOXED> {
    /// Tests all pairs that wait.
    #[inline(always)]
    fn test(&mut self, limit: &mut Lanes<f32>) {
        for first in (0..self.queue.len()).step_by(ROW) {
            let mut met = u32::MAX >> (32 - ROW.min(self.queue.len() - first));
            if BOXED {
                met = self.queue.met(self.objects.simd, first, self.unit, self.objects.boxes);
            }
            while let Some(at) = next_lane(&mut met) {
                let (lane, group) = self.queue.pair(first + at);
                let ray = &mut self.rays[lane];
                let before = ray.best.t;
                self.objects.test(ray, group);
                if ray.best.t < before {
                    let walking = &mut self.walking[lane];
                    walking.found(ray.best.t);
                    self.unit.limit(lane, walking.limit);
                    limit[lane] = limit[lane].min(walking.limit);
                }
            }
        }
        self.queue.clear();
    }
}

impl<S: Simd, B: Blocks, C: Count, const BOXED: bool> VisitEach for Abreast<'_, '_, S, B, C, BOXED> {
    #[inline(always)]
    fn cells(&mut self, mut lanes: u32, numbers: &Lanes<u32>, limit: &mut Lanes<f32>) {
        let (mut lane, mut list) = (0, &[][..]);
        loop {
            loop {
                let (now, later) = list.split_at(list.len().min(self.queue.room()));
                for &group in now {
                    self.objects.count.candidates(1);
                    let known = self.walking[lane].met.contains_or_insert(group);
                    self.queue.add(lane, group, !known);
                }
                list = later;
                if !list.is_empty() {
                    break;
                }
                let Some(next) = next_lane(&mut lanes) else { break };
                lane = next;
                list = self.objects.cells.list(numbers[lane] as usize);
            }
            self.test(limit);
            if lanes == 0 && list.is_empty() {
                return;
            }
        }
    }

    #[inline(always)]
    fn brick(&self, number: usize) -> u32 {
        self.objects.cells.brick(number)
    }

    #[inline(always)]
    fn steps(&mut self, count: u32) {
        self.objects.count.cells(u64::from(count));
    }
}

/// The nearest hit of each ray: many side by side, a single one by itself.
#[inline(always)]
pub(super) fn nearest<O: PackedObjects, S: Simd, C: Count, const BOXED: bool>(
    built: &Built<O>,
    objects: &mut Objects<'_, S, O::Blocks, C, false, BOXED>,
    rays: &[Ray],
    found: &mut [Nearest],
) {
    let Some(first) = rays.first() else { return };
    let Built { bricks, blocks, .. } = built;
    let simd = objects.simd;
    let mut chunk = Chunk::new(blocks.one(first));
    let mut held = chunk.rays;
    let mut walking = [Walking::NOWHERE; ROW];
    let mut numbers = [0; ROW];
    let mut walks = Walks::NONE;
    let (mut unit, mut queue) = (UnitRays::NONE, Queue::EMPTY);
    let (mut begun, mut next) = (0, 0);
    loop {
        let mut idle = !walks.active & LANES;
        while idle != 0 && (chunk.waiting != 0 || next < rays.len()) {
            let Some(from) = next_lane(&mut chunk.waiting) else {
                let own = &rays[next..rays.len().min(next + ROW)];
                (begun, next) = (next, next + own.len());
                chunk.fill(built, objects, own);
                for (lane, found) in found[begun..next].iter_mut().enumerate() {
                    if chunk.waiting >> lane & 1 == 0 {
                        *found = chunk.rays[lane].resolved(blocks);
                    }
                }
                continue;
            };
            let Some(segment) = chunk.segments.lane(from) else { continue };
            if rays.len() == 1 {
                walk(built, objects, &mut chunk.rays[from], segment);
                found[0] = chunk.rays[from].resolved(blocks);
                continue;
            }
            let Some(lane) = next_lane(&mut idle) else { break };
            numbers[lane] = begun + from;
            held[lane] = chunk.rays[from];
            walking[lane] = Walking::new(segment, held[lane].best.t);
            unit.set(lane, &segment, walking[lane].limit);
            walks.begin(bricks, lane, &segment, walking[lane].limit.min(1.0));
        }
        if walks.active == 0 {
            return;
        }
        let before = walks.active;
        let (rays, walking) = (&mut held, &mut walking);
        let (unit, queue) = (&mut unit, &mut queue);
        walks.step(simd, bricks, &mut Abreast { objects: &mut *objects, rays, walking, unit, queue });
        let mut ended = before & !walks.active;
        while let Some(lane) = next_lane(&mut ended) {
            found[numbers[lane]] = held[lane].resolved(blocks);
        }
    }
}
