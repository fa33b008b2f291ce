use super::*;
use crate::{KernelId, WithKernel};
use accel::tolerance::holds;
use accel::{Aabb, Mesh, Objects, Vec3};
use lanes::{BLOCK, Level, OneByOne, ROW, Task};
use proptest::prelude::*;

fn mesh(corners: &[[Vec3; 3]]) -> Mesh {
    Mesh {
        positions: corners.iter().flatten().copied().collect(),
        triangles: (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
    }
}

fn point(range: f32) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(prop_oneof![-range..range, Just(0.0), Just(range)]).prop_map(Vec3::from_array)
}

struct Hull<'a>(&'a Mesh);

impl WithKernel for Hull<'_> {
    type Out = ();

    fn kernel<K: TriangleKernel>(self) {
        use accel::Bounds;
        let triangles = Triangles::<K>::new(self.0);
        let each = (0..self.0.triangles.len() as u32).map(|id| Bounds::bounds(&triangles, id));
        let union = each.fold(Aabb::EMPTY, |all, bounds| all.union(bounds));
        assert_eq!(triangles.shape().hull(), union, "{}", K::ID);
    }
}

struct ByMask<'a, B>(&'a B, &'a [Ray], u64);

impl<B: Blocks> Task for ByMask<'_, B> {
    type Out = Vec<[Nearest; 3]>;

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Self::Out {
        let Self(blocks, rays, mask) = self;
        let mut out = vec![[Nearest::new(f32::INFINITY); 3]; rays.len()];
        for (ray, [one, ..]) in rays.iter().zip(&mut out) {
            blocks.closest(s, 0, mask, &blocks.one(ray), one);
            blocks.resolve(&blocks.one(ray), one);
        }
        for first in (0..rays.len()).step_by(S::LANES) {
            let many = blocks.many(s, &Packet::load(s, &rays[first..]));
            let mut best = NearestPacket::new(s, s.splat(f32::INFINITY));
            for slot in (0..BLOCK).filter(|slot| mask >> slot & 1 != 0) {
                blocks.packet(s, slot, &many, &mut best);
            }
            blocks.resolve_packet(s, &many, &mut best);
            let mut stored = [Nearest::new(0.0); ROW];
            best.store(s, &mut stored);
            let mut paired = [Nearest::new(f32::INFINITY); ROW];
            let (mut places, mut slots, mut len) = ([0; PAIRS], [0; PAIRS], 0);
            for lane in 0..S::LANES {
                let there = |slot: &u8| mask >> slot & 1 != 0 && blocks.object((*slot).into()) != EMPTY_SLOT;
                for slot in (0..BLOCK as u8).filter(there) {
                    (places[len], slots[len]) = (lane as u8, slot);
                    len += 1;
                }
            }
            let packet = &Packet::load(s, &rays[first..]);
            let pairs = Pairs { block: 0, packet, rays: &places, slots: &slots, len, any: false };
            blocks.pairs(s, &pairs, &mut paired);
            let here = &rays[first..first + S::LANES];
            blocks.resolve_each(s, here, &mut paired[..S::LANES]);
            for lane in 0..S::LANES {
                (out[first + lane][1], out[first + lane][2]) = (stored[lane], paired[lane]);
            }
        }
        out
    }
}

const PAIRS: usize = ROW * BLOCK;

struct Compare<'a> {
    mesh: &'a Mesh,
    rays: &'a [Ray],
    mask: u64,
    /// Whether higher numbers come in lower slots.
    backwards: bool,
}

impl WithKernel for Compare<'_> {
    type Out = ();
    fn kernel<K: TriangleKernel>(self) {
        let Self { mesh, rays, mask, backwards } = self;
        let objects = Triangles::<K>::new(mesh);
        let order: Vec<u32> =
            (0..BLOCK as u32).map(|i| if i % 5 == 4 { EMPTY_SLOT } else { i / 5 * 4 + i % 5 }).collect();
        let order: Vec<u32> =
            order.iter().map(|&id| if (id as usize) < objects.len() { id } else { EMPTY_SLOT }).collect();
        let order: Vec<u32> = if backwards { order.into_iter().rev().collect() } else { order };
        let blocks = objects.blocks("x", &order).unwrap();
        let packed = OneByOne::new(objects, "x", &order).unwrap();
        let in_place = objects.blocks_in_place("x", &order).unwrap();
        for level in Level::here() {
            let fast = level.run(ByMask(&blocks, rays, mask));
            let plain = level.run(ByMask(&packed, rays, mask));
            let in_place = level.run(ByMask(&in_place, rays, mask));
            for (((ray, fast), plain), in_place) in rays.iter().zip(fast).zip(plain).zip(in_place) {
                let mut reference = Nearest::new(f32::INFINITY);
                for slot in (0..BLOCK).filter(|slot| mask >> slot & 1 != 0 && order[*slot] != EMPTY_SLOT) {
                    if let Some(surface) = objects.intersect(order[slot], ray, f32::INFINITY) {
                        objects.closest(order[slot], ray, &mut reference);
                        let bounds = objects.bounds(order[slot]);
                        assert!(
                            holds(&bounds, ray, surface.t),
                            "{:?} breaks the invariant on {ray:?}",
                            K::ID
                        );
                    }
                }
                for found in [fast, plain, in_place].into_iter().flatten() {
                    assert_eq!(found.hit(), reference.hit(), "{} {level:?} {ray:?}", K::ID);
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Blocks, packets and single tests agree, and the hit-in-padded-bounds invariant holds, also for rays from far
    /// away, where hits are mostly rounding.
    #[test]
    fn blocks_agree_with_single_tests_and_the_invariant_holds(
        corners in prop::collection::vec(prop::array::uniform3(point(1.0)), 1..52),
        origins in prop::collection::vec(prop_oneof![3 => point(2.0), 1 => point(1e7)], ROW..=ROW),
        aims in prop::collection::vec(point(1.0), ROW..=ROW),
        mask: u64,
    ) {
        let rays: Vec<Ray> = origins.iter().zip(&aims)
            .map(|(o, a)| Ray::new(*o, if a == o { Vec3::X } else { *a - *o }))
            .collect();
        for kernel in KernelId::ALL {
            kernel.with(Compare { mesh: &mesh(&corners), rays: &rays, mask, backwards: false });
        }
    }

    /// Triangles in a few planes perpendicular to an axis are hit at one t by tens, of which the lowest number comes first.
    #[test]
    fn ties_in_one_plane_go_to_the_lowest_number(
        corners in prop::collection::vec((prop::array::uniform3(point(1.0)), -1i8..=1), 1..52),
        origins in prop::collection::vec(point(2.0), ROW..=ROW),
        aims in prop::collection::vec(point(0.5), ROW..=ROW),
        axis in 0usize..3,
        backwards: bool,
    ) {
        let mut flat: Vec<_> = corners.iter().map(|(corners, _)| *corners).collect();
        for (flat, (_, place)) in flat.iter_mut().zip(&corners) {
            flat.iter_mut().for_each(|corner| corner[axis] = f32::from(*place) * 0.3);
        }
        let rays: Vec<Ray> = origins.iter().zip(&aims)
            .map(|(o, a)| Ray::new(*o, if a == o { Vec3::X } else { *a - *o }))
            .collect();
        for kernel in KernelId::ALL {
            kernel.with(Compare { mesh: &mesh(&flat), rays: &rays, mask: u64::MAX, backwards });
        }
    }
}

proptest! {
    #[test]
    fn the_hull_is_the_box_of_all_boxes(
        corners in prop::collection::vec(prop::array::uniform3(point(3e4)), 0..20),
        scale in prop_oneof![Just(1.0f32), Just(1e-30), Just(1e30)],
    ) {
        let corners: Vec<_> = corners.into_iter().map(|each| each.map(|corner| corner * scale)).collect();
        for kernel in KernelId::ALL {
            kernel.with(Hull(&mesh(&corners)));
        }
    }
}
