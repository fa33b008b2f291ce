use super::*;
use crate::{TriangleKernel, WithKernel};
use accel::Vec3;
use lanes::{Level, Task};
use proptest::prelude::*;

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![-2f32..2.0, Just(0.0), Just(-0.0), Just(1.0), Just(0.5)]
}

fn point() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(coordinate()).prop_map(Vec3::from_array)
}

fn ray() -> impl Strategy<Value = Ray> {
    (point(), point()).prop_filter_map("zero direction", |(origin, direction)| {
        let ray = Ray::new(origin, direction);
        ray.validate().is_ok().then_some(ray)
    })
}

fn same(a: Option<Surface>, b: Option<Surface>) -> bool {
    let bits = |s: Surface| [s.t.to_bits(), s.u.to_bits(), s.v.to_bits()];
    a.map(bits) == b.map(bits)
}

/// Tests every ray against every triangle in both ways of a kernel.
struct BothWays<'a, K>(&'a [Ray], &'a [Corners], K);

impl<K: Kernel> Task for BothWays<'_, K> {
    type Out = Vec<[Option<Surface>; 2]>;

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Self::Out {
        let Self(rays, triangles, _) = self;
        let mut group = vec![Row([f32::NAN; ROW]); K::ROWS];
        for (lane, corners) in triangles.iter().enumerate() {
            K::pack(corners, &mut group, lane);
        }
        let mut out = vec![[None; 2]; rays.len() * triangles.len()];
        for (r, ray) in rays.iter().enumerate() {
            for at in (0..ROW).step_by(S::LANES) {
                let lanes = K::triangles(s, &K::one(ray), Packed::new(&group, at), u32::MAX, f32::INFINITY);
                for lane in (0..S::LANES).filter(|lane| s.bits(lanes.hit) >> lane & 1 != 0) {
                    out[r * triangles.len() + at + lane][0] = Some(lanes.rows(s).surface(lane));
                }
            }
        }
        for first in (0..rays.len()).step_by(S::LANES) {
            let many = K::many(s, &Packet::load(s, &rays[first..]));
            for k in 0..triangles.len() {
                let lanes = K::rays(s, &many, Packed::new(&group, k), s.splat(f32::INFINITY));
                for lane in (0..S::LANES).filter(|lane| s.bits(lanes.hit) >> lane & 1 != 0) {
                    out[(first + lane) * triangles.len() + k][1] = Some(lanes.rows(s).surface(lane));
                }
            }
        }
        out
    }
}

struct Check<'a>(&'a [Ray], &'a [Corners]);

impl WithKernel for Check<'_> {
    type Out = usize;
    fn kernel<K: TriangleKernel>(self) -> usize {
        let Self(rays, triangles) = self;
        let mut hits = 0;
        for level in Level::here() {
            let all = level.run(BothWays(rays, triangles, K::default()));
            for (i, [one, many]) in all.into_iter().enumerate() {
                let (ray, corners) = (&rays[i / ROW], &triangles[i % ROW]);
                let reference = K::test(&K::one(ray), corners, f32::INFINITY);
                assert!(
                    same(one, reference),
                    "{} {level:?} {ray:?} {corners:?}: {one:?} {reference:?}",
                    K::ID
                );
                assert!(
                    same(many, reference),
                    "{} {level:?} {ray:?} {corners:?}: {many:?} {reference:?}",
                    K::ID
                );
                hits += usize::from(reference.is_some());
            }
        }
        hits
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Scalar, one ray in lanes and many rays in lanes give the same bits at every level.
    #[test]
    fn all_ways_of_a_kernel_agree(
        rays in prop::collection::vec(ray(), ROW..=ROW),
        triangles in prop::collection::vec(prop::array::uniform3(point()), ROW..=ROW),
    ) {
        for kernel in KernelId::ALL {
            kernel.with(Check(&rays, &triangles));
        }
    }
}

#[test]
fn a_plain_hit_has_the_expected_coordinates() {
    struct Plain;
    impl WithKernel for Plain {
        type Out = Option<Surface>;
        fn kernel<K: TriangleKernel>(self) -> Self::Out {
            let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
            let ray = Ray::new(Vec3::new(0.25, 0.5, 2.0), Vec3::NEG_Z);
            K::test(&K::one(&ray), &corners, 10.0)
        }
    }
    for kernel in KernelId::ALL {
        assert_eq!(KernelId::from_id(kernel.id()), Some(kernel));
        if kernel == KernelId::BoundingBox {
            continue;
        }
        assert_eq!(kernel.with(Plain), Some(Surface { t: 2.0, u: 0.25, v: 0.5 }), "{kernel}");
    }
}

#[test]
fn watertight_never_leaks_through_a_shared_edge_or_corner() {
    // A fan around a point, hit from everywhere at the point and along its spokes.
    let hub = Vec3::new(0.1, 0.2, 0.3);
    let rim: Vec<Vec3> = [(1.0, 0.1), (0.4, 0.9), (-0.7, 0.6), (-0.8, -0.5), (0.3, -1.1)]
        .map(|(x, y)| hub + Vec3::new(x, y, 0.2 * x - 0.3 * y))
        .to_vec();
    let fan: Vec<Corners> = (0..5).map(|i| [hub, rim[i], rim[(i + 1) % 5]]).collect();
    let mut seed = 1u32;
    let mut random = move || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32 * 2.0 - 1.0
    };
    for i in 0..20_000 {
        let spoke = rim[i % 5];
        let aim = hub + (spoke - hub) * random().abs() * 0.99;
        let origin = Vec3::new(random() * 0.3, random() * 0.3, 3.0 + random());
        let ray = Watertight::one(&Ray::new(origin, aim - origin));
        let hit = fan.iter().any(|corners| Watertight::test(&ray, corners, f32::INFINITY).is_some());
        assert!(hit, "leak at {aim}");
    }
}

#[test]
fn kernels_are_read_or_named() {
    assert_eq!(KernelId::parse("watertight"), Ok(KernelId::Watertight));
    assert!(KernelId::parse("tight").unwrap_err().contains("moller-trumbore"));
}
