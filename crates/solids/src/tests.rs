//! Blocks against one by one.

use crate::{Crossings, SolidBlocks, Solids};
use accel::testing::{KINDS, rays, solids};
use accel::{Geometry, Nearest, Objects, Ray};
use lanes::packet::{NearestPacket, Packet, Pairs};
use lanes::{BLOCK, Blocks, EMPTY_SLOT, Level, PackedObjects, ROW, Simd, Task};

/// Where a ray crosses a solid, and whether it enters there.
pub fn crossings(solid: &impl Crossings, ray: &Ray) -> Vec<(f64, bool)> {
    let mut out = Vec::new();
    solid.crossings(ray, &mut out);
    out.iter().map(|c| (c.t, c.enters)).collect()
}

struct Both<'a, 's>(&'a Solids<'s>, &'a [u32], &'a [Ray]);

impl Task for Both<'_, '_> {
    type Out = usize;

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> usize {
        let Self(objects, order, rays) = self;
        let blocks = objects.blocks("x", order).unwrap();
        let mut hits = 0;
        for sixteen in rays.chunks_exact(ROW) {
            let mut expected = [Nearest::new(0.0); ROW];
            for (ray, expected) in sixteen.iter().zip(&mut expected) {
                *expected = Nearest::new(ray.t_max);
                for id in 0..Objects::len(objects) as u32 {
                    objects.closest(id, ray, expected);
                }
                let (one, mut found) = (blocks.one(ray), Nearest::new(ray.t_max));
                for block in 0..order.len().div_ceil(BLOCK) {
                    let slots = (order.len() - block * BLOCK).min(BLOCK);
                    blocks.closest(s, block, u64::MAX >> (BLOCK - slots), &one, &mut found);
                }
                assert_eq!(format!("{found:?}"), format!("{expected:?}"), "{ray:?}");
                hits += usize::from(found.object != Nearest::NONE);
            }
            if <SolidBlocks<'_> as Blocks>::takes_pairs::<S>() {
                let packet = Packet::load(s, sixteen);
                let mut found = [Nearest::new(0.0); ROW];
                for (found, ray) in found.iter_mut().zip(sixteen) {
                    *found = Nearest::new(ray.t_max);
                }
                for block in 0..order.len().div_ceil(BLOCK) {
                    let slots = (order.len() - block * BLOCK).min(BLOCK);
                    let held = |slot: &usize| order[block * BLOCK + slot] != EMPTY_SLOT;
                    let all = (0..slots).filter(held).flat_map(|slot| (0..ROW).map(move |ray| (ray, slot)));
                    // Not by rays, nor by objects.
                    let mut all: Vec<(usize, usize)> = all.collect();
                    all.sort_by_key(|(ray, slot)| (ray * 7 + slot * 13) % 31);
                    let len = all.len();
                    all.resize(len.next_multiple_of(ROW), (0, 0));
                    let rays: Vec<u8> = all.iter().map(|(ray, _)| *ray as u8).collect();
                    let slots: Vec<u8> = all.iter().map(|(_, slot)| *slot as u8).collect();
                    let pairs = Pairs { block, packet: &packet, rays: &rays, slots: &slots, len, any: false };
                    blocks.pairs(s, &pairs, &mut found);
                }
                assert_eq!(format!("{found:?}"), format!("{expected:?}"), "in pairs");
            }
            for (first, rays) in sixteen.chunks_exact(S::LANES).enumerate() {
                let packet = Packet::load(s, rays);
                let (many, mut best) = (blocks.many(s, &packet), NearestPacket::new(s, packet.t_max));
                for slot in 0..order.len() {
                    blocks.packet(s, slot, &many, &mut best);
                }
                let mut found = [Nearest::new(0.0); ROW];
                best.store(s, &mut found);
                let expected = &expected[first * S::LANES..][..S::LANES];
                assert_eq!(format!("{:?}", &found[..S::LANES]), format!("{expected:?}"));
            }
        }
        hits
    }
}

#[test]
fn all_forms_and_instruction_sets_give_the_same_bits() {
    for kinds in [&["sphere"][..], &["cone", "cylinder"], &KINDS] {
        let scene = solids(41, kinds, 150, 0.15);
        let Geometry::Solids(solids) = &scene.geometry else { unreachable!("solids") };
        // Every third slot is empty, and the order is another.
        let order: Vec<u32> = (0..150u32)
            .rev()
            .flat_map(|id| [id, if id.is_multiple_of(2) { EMPTY_SLOT } else { id }])
            .collect();
        let mut rays = rays(43, 320);
        rays[5].direction *= 1e-20;
        rays[6].direction *= 1e20;
        for objects in [Solids::new(solids), Solids::in_double(solids), Solids::exact(solids)] {
            for level in Level::here() {
                let hits = level.run(Both(&objects, &order, &rays));
                assert!(hits > 50, "{kinds:?} {level:?}: {hits}");
            }
        }
    }
}
