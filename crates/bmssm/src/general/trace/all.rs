//! All that a ray may meet, however far away.

use super::{ClippedSegment, Stack, Waiting, nearest_child};
use crate::general::General;
use crate::general::tree::Node;
use accel::Ray;
use accel::tolerance::LIMIT_S;
use lanes::{BLOCK, Blocks, PackedObjects, Simd, Task, next_bit};

struct Gather<'a, O: PackedObjects> {
    general: &'a General<O>,
    ray: &'a Ray,
    found: &'a mut Vec<u32>,
}

impl<O: PackedObjects> Task for Gather<'_, O> {
    type Out = ();

    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        let Self { general, ray, found } = self;
        let Some(segment) = general.frame.clip(ray) else { return };
        if general.nodes.is_empty() {
            return;
        }
        let clipped = ClippedSegment::new(&segment);
        let limit = 1.0 + LIMIT_S as f32;
        let mut stack = Stack::default();
        let mut next = Some(Waiting { enter: 0.0, exit: 1.0, what: 0 });
        while let Some(Waiting { enter, exit, what }) = next {
            if what & Node::BLOCK == 0 {
                let child = nearest_child(s, &general.nodes[what as usize], &clipped, limit, &mut stack);
                next = if child.is_none() { stack.pop(limit) } else { child };
                continue;
            }
            let block = (what & !Node::BLOCK) as usize;
            let mut candidates = general.maps[block].candidates(s, clipped.at(enter), clipped.at(exit));
            while let Some(place) = next_bit(&mut candidates) {
                // Each object is in one slot of one block.
                found.push(general.objects.object(block * BLOCK + place));
            }
            next = stack.pop(limit);
        }
    }
}

impl<O: PackedObjects> General<O> {
    /// Appends all candidates of a ray.
    pub fn gather(&self, ray: &Ray, found: &mut Vec<u32>) {
        self.simd.run(Gather { general: self, ray, found });
    }
}
