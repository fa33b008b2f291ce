//! Scenes, rays and the comparison with brute force.
#![allow(dead_code)]

pub use accel::testing::scene;
use accel::{Aabb, Accel, Builder, Geometry, Hit, Mesh, Ray, RaySet, Scene, Vec3, Workload};
use baselines::Brute;
use primitives::KernelId;

/// A small generator of numbers that look random.
pub struct Random(pub u32);

impl Random {
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 / (1 << 24) as f32
    }

    /// In the cube of half-edge `scale` about the origin.
    pub fn point(&mut self, scale: f32) -> Vec3 {
        Vec3::new(self.unit() - 0.5, self.unit() - 0.5, self.unit() - 0.5) * (2.0 * scale)
    }
}

pub fn mesh(corners: impl IntoIterator<Item = [Vec3; 3]>) -> Scene {
    let mut mesh = Mesh::default();
    for triangle in corners {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(triangle);
        mesh.triangles.push([first, first + 1, first + 2]);
    }
    scene(Geometry::Triangles(mesh))
}

/// Triangles of about `size` in the cube from −1 to 1.
pub fn cloud(count: usize, size: f32) -> Scene {
    let mut random = Random(count as u32);
    mesh((0..count).map(|_| {
        let at = random.point(1.0);
        [at, at + random.point(size), at + random.point(size)]
    }))
}

pub fn boxes(count: usize, size: f32) -> Scene {
    let mut random = Random(count as u32);
    let one = |_| {
        let at = random.point(1.0);
        Aabb::of_points([at, at + random.point(size)])
    };
    scene(Geometry::Boxes((0..count).map(one).collect()))
}

/// The scene scaled and moved.
pub fn moved(mut scene: Scene, scale: f32, by: Vec3) -> Scene {
    match &mut scene.geometry {
        Geometry::Solids(solids) => {
            solids.iter_mut().for_each(|s| *s = s.moved(f64::from(scale), by.as_dvec3()));
        }
        Geometry::Triangles(mesh) => mesh.positions.iter_mut().for_each(|p| *p = *p * scale + by),
        Geometry::Boxes(boxes) => boxes.iter_mut().for_each(|b| {
            *b = Aabb { min: b.min * scale + by, max: b.max * scale + by };
        }),
    }
    scene
}

/// Rays from inside, outside and on the bounds, in random directions and along axes with
/// zeros of both signs, in planes of many grids, with open and with closed ranges.
pub fn rays(scene: &Scene, count: usize) -> RaySet {
    let bounds = scene.geometry.bounds();
    let (center, half) =
        if bounds.is_empty() { (Vec3::ZERO, Vec3::ONE) } else { (bounds.center(), bounds.extent() * 0.5) };
    let largest = half.max_element();
    let size = if largest > 0.0 { half.max(Vec3::splat(largest * 0.01)) } else { Vec3::splat(1e-3) };
    let mut random = Random(99);
    let eighth = |v: f32| (v * 8.0).round() / 8.0;
    let list = (0..count).map(|i| {
        let at = random.point(if i % 3 == 0 { 3.0 } else { 1.0 });
        let at = if i % 4 == 1 { Vec3::from_array(at.to_array().map(eighth)) } else { at };
        let mut direction = random.point(1.0);
        let zero = if i % 2 == 0 { 0.0 } else { -0.0 };
        match i % 5 {
            1 => direction[i / 5 % 3] = zero,
            2 => {
                let axis = i / 5 % 3;
                let along = direction[axis];
                direction = Vec3::splat(zero);
                direction[axis] = if along < 0.0 { -1.0 } else { 1.0 };
            }
            _ => {}
        }
        if direction == Vec3::ZERO {
            direction = Vec3::X;
        }
        let mut ray = Ray::new(center + at * size, direction * largest.max(1e-3));
        if i % 7 == 0 {
            (ray.t_min, ray.t_max) = (0.125, 0.75);
        }
        if i % 11 == 0 {
            ray.t_min = f32::NEG_INFINITY;
        }
        ray
    });
    RaySet::List(list.collect())
}

/// Whether all hits are the same, bit by bit; and occlusion the same.
pub fn compare(scene: &Scene, kernel: KernelId, rays: &RaySet, what: &str, built: &dyn Accel) {
    let mut reference = vec![None; rays.len()];
    let brute = Brute::new(kernel).build(scene, &Workload::GENERAL).unwrap();
    brute.trace(rays, &mut reference);
    let mut hits: Vec<Option<Hit>> = vec![None; rays.len()];
    built.trace(rays, &mut hits);
    let mut occluded = vec![false; rays.len()];
    built.trace_occluded(rays, &mut occluded);
    for (i, (hit, expected)) in hits.iter().zip(&reference).enumerate() {
        let same = match (hit, expected) {
            (Some(a), Some(b)) => a.same_bits(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        let ray = rays.ray(i);
        assert!(same, "{what}: ray {i} {ray:?}: {hit:?} instead of {expected:?}");
        assert_eq!(occluded[i], expected.is_some(), "{what}: occlusion of ray {i} {ray:?}");
        if i % 16 == 0 {
            assert_eq!(built.closest(&ray), *expected, "{what}: alone");
            assert_eq!(built.occluded(&ray), expected.is_some(), "{what}: alone");
            let all = brute.all_hits(&ray);
            assert_eq!(
                all.first().map(|hit| hit.t),
                expected.map(|hit| hit.t),
                "{what}: all hits begin with the nearest"
            );
            assert_eq!(built.all_hits(&ray), all, "{what}: all hits of {ray:?}");
        }
    }
}
