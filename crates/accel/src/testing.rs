//! What tests of many crates share: numbers that are the same in every run, and small scenes.

use crate::{Geometry, Mesh, Ray, RaySet, Scene, Vec3, View};

/// Numbers that look random, from a seed.
#[derive(Clone, Debug)]
pub struct Numbers(pub u64);

impl Numbers {
    /// From 0 to 1, without 1.
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }

    /// From −1 to 1, without 1.
    pub fn signed(&mut self) -> f32 {
        self.unit() * 2.0 - 1.0
    }

    /// A point of the cube from 0 to 1.
    pub fn vec3(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit())
    }
}

/// Numbers in [−1, 1) from a smaller generator.
pub fn random(seed: u32) -> impl FnMut() -> f32 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 23) as f32 - 1.0
    }
}

/// A scene with a view that nobody looks through.
pub fn scene(geometry: Geometry) -> Scene {
    let view = View { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };
    Scene { id: "test".into(), geometry, view }
}

/// Triangles with edges of up to about `size`, each at a corner in the cube from −1 to 1, from a seed.
pub fn soup(seed: u32, triangles: u32, size: f32) -> Mesh {
    let mut random = random(seed);
    soup_of(&mut random, triangles, size)
}

fn soup_of(random: &mut impl FnMut() -> f32, triangles: u32, size: f32) -> Mesh {
    let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
    let mut mesh = Mesh::default();
    for i in 0..triangles {
        let corner = point(1.0);
        mesh.positions.extend([corner, corner + point(size), corner + point(size)]);
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    mesh
}

/// A cloud of triangles and rays that start in, on and outside of it.
pub fn cloud(triangles: u32, rays: u32) -> (Scene, RaySet) {
    let mut random = random(7);
    let mesh = soup_of(&mut random, triangles, 0.3);
    let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
    let rays = (0..rays).map(|i| Ray::new(point(if i % 3 == 0 { 3.0 } else { 1.0 }), point(1.0))).collect();
    (scene(Geometry::Triangles(mesh)), RaySet::List(rays))
}
