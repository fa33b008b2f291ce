//! What tests of many crates share: numbers that are the same in every run, and small scenes.

use crate::solid::{Cone, Disc, Quadric, Sphere, Torus};
use crate::{Aabb, Geometry, Mesh, Ray, RaySet, Scene, Solid, Vec3, View};

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

/// The kinds of solids that [`solid`] makes.
pub const KINDS: [&str; 8] = ["triangle", "box", "sphere", "cone", "cylinder", "disc", "quadric", "torus"];

/// A solid of a kind about `center`, of about this size, from numbers in [−1, 1).
///
/// # Panics
/// If there is no such kind.
pub fn solid(kind: &str, center: Vec3, size: f32, random: &mut impl FnMut() -> f32) -> Solid {
    let mut positive = || size * (0.6 + 0.4 * random());
    let (a, b) = (positive(), positive());
    let mut point = || Vec3::new(random(), random(), random());
    let (p, q) = (point() * size, point());
    match kind {
        "triangle" => Solid::Triangle([center, center + p, center + q * size]),
        "box" => Solid::Box(Aabb::of_points([center - p.abs(), center + q.abs() * size])),
        "sphere" => Solid::Sphere(Sphere { center, radius: a }),
        "cone" => {
            let top_radius = if a < b { 0.0 } else { b * 0.5 };
            Solid::Cone(Cone { base: center - p, base_radius: a, top: center + p, top_radius })
        }
        "cylinder" => Solid::Cone(Cone { base: center - p, base_radius: a, top: center + p, top_radius: a }),
        "disc" => Solid::Disc(Disc { center, normal: q, radius: a }),
        "quadric" => {
            let half = Vec3::splat(size);
            let bounds = Aabb { min: center - half, max: center + half };
            let [x, y, z] = q.to_array();
            let one = -0.3 * size * size;
            let (x, y, z, flat) = (x + 1.0, y + 1.0, z, 0.3 * z);
            let slope = 0.2 * size * z;
            let coefficients = [x, y, z, flat, 0.1, -flat, slope, 0.0, -slope, one];
            Solid::Quadric(Quadric { coefficients, bounds })
        }
        "torus" => {
            Solid::Torus(Torus { center, axis: q, major: a, minor: a * 0.1 + a * 0.8 * b / (size * 1.1) })
        }
        _ => panic!("no kind `{kind}`"),
    }
}

/// So many solids of these kinds in turn, in the cube from −1 to 1, from a seed.
pub fn solids(seed: u32, kinds: &[&str], count: u32, size: f32) -> Scene {
    let mut random = random(seed);
    let one = |i: u32| {
        let center = Vec3::new(random(), random(), random());
        solid(kinds[i as usize % kinds.len()], center, size, &mut random)
    };
    scene(Geometry::Solids((0..count).map(one).collect()))
}

/// Rays from around and within the cube from −1 to 1 through it, half of them along an axis or from far away.
pub fn rays(seed: u32, count: u32) -> Vec<Ray> {
    let mut random = random(seed);
    let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
    let ray = |i: u32| {
        let target = point(1.0);
        let origin = match i % 4 {
            0 => point(1.0),
            1 => point(3.0),
            2 => point(40.0),
            _ => target + Vec3::AXES[i as usize / 4 % 3] * 5.0,
        };
        let t_max = if i.is_multiple_of(5) { 1.0 } else { f32::INFINITY };
        Ray { t_max, ..Ray::new(origin, target - origin) }
    };
    (0..count).map(ray).collect()
}

/// Spheres with a ray each, every second of which is within a few millionths of the silhouette, at scales of 2^±60 and up to 10^7 from
/// the origin.
pub fn spheres_and_rays(count: u32) -> impl Iterator<Item = (Sphere, Ray)> {
    let mut random = random(61);
    (0..count).map(move |i| {
        let mut point = || Vec3::new(random(), random(), random());
        let (center, away, aside, aim) = (point(), point(), point(), point());
        let scale = [1.0, 2f32.powi(60), 2f32.powi(-60), 16.0][i as usize / 2 % 4];
        let offset = if i % 3 == 0 { Vec3::new(1e7, -1e7, 1e7) } else { Vec3::ZERO };
        let center = (center + offset) * scale;
        let radius = (0.2 + aim.x.abs()) * scale;
        let direction = away.as_dvec3().normalize_or(glam::DVec3::X);
        let across = direction.cross(aside.as_dvec3()).normalize_or(glam::DVec3::Y);
        let miss = if i.is_multiple_of(2) { 1.0 + f64::from(aim.y) * 1e-6 } else { f64::from(aim.z) * 1.2 };
        let far = f64::from(scale) * f64::from(2.0 + aim.y.abs() * 20.0);
        let origin = center.as_dvec3() + across * (miss * f64::from(radius)) - direction * far;
        let ray = Ray::new(origin.as_vec3(), (direction * f64::from(0.1 + aim.x.abs())).as_vec3());
        let t_max = if i % 7 == 0 { (far * 2.0) as f32 } else { f32::INFINITY };
        (Sphere { center, radius }, Ray { t_max, ..ray })
    })
}
