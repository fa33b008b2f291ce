//! From hits to colours.

use super::colour::{NOTHING, of_object, srgb};
use accel::{Geometry, Hit, Mesh, Raster, Ray, Vec3};
use image::{Rgba, RgbaImage};

/// What a pixel's colour says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    /// Matt surfaces under a lamp beside the eye
    Light,
    /// The surface normal: red, green and blue for x, y and z
    Normal,
    /// The distance: near is bright
    Depth,
    /// Which object: one colour each
    Object,
}

/// The picture of a raster's hits; transparent where nothing is hit.
///
/// # Panics
/// If `hits` is not as long as the raster, or names objects that the scene doesn't have.
pub fn shade(geometry: &Geometry, raster: &Raster, hits: &[Option<Hit>], shading: Shading) -> RgbaImage {
    assert_eq!(hits.len(), raster.len(), "one hit for each pixel");
    let depths = Depths::of(raster, hits);
    RgbaImage::from_fn(raster.cols, raster.rows, |x, y| {
        let at = y as usize * raster.cols as usize + x as usize;
        let Some(hit) = &hits[at] else { return NOTHING };
        let ray = raster.ray(y, x);
        let normal = normal(geometry, &ray, hit);
        match shading {
            Shading::Light => srgb(Vec3::new(0.62, 0.68, 0.78) * lit(raster, &ray, normal)),
            Shading::Object => srgb(of_object(hit.object) * lit(raster, &ray, normal)),
            Shading::Normal => {
                let [r, g, b] = (normal * 0.5 + 0.5).to_array().map(|x| (x * 255.0).round() as u8);
                Rgba([r, g, b, 255])
            }
            Shading::Depth => srgb(Vec3::splat(depths.brightness(&ray, hit))),
        }
    })
}

/// The surface's unit normal on the side that the ray comes from; the reversed direction where a
/// surface has none.
fn normal(geometry: &Geometry, ray: &Ray, hit: &Hit) -> Vec3 {
    let normal = match geometry {
        Geometry::Triangles(mesh) => triangle_normal(mesh, hit.object),
        Geometry::Boxes(boxes) => {
            let b = &boxes[hit.object as usize];
            let from_center = (ray.at(hit.t) - b.center()) / b.extent().max(Vec3::splat(f32::MIN_POSITIVE));
            let face = from_center.abs().max_position();
            Vec3::AXES[face] * from_center[face].signum()
        }
        Geometry::Solids(solids) => {
            let point = ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(hit.t);
            solids[hit.object as usize].normal(point).map_or(Vec3::ZERO, |normal| normal.as_vec3())
        }
    };
    let back = -unit(ray.direction);
    let normal = if normal == Vec3::ZERO { back } else { normal };
    if normal.dot(back) < 0.0 { -normal } else { normal }
}

fn triangle_normal(mesh: &Mesh, object: u32) -> Vec3 {
    let [a, b, c] = mesh.corners(object as usize).map(|corner| corner.as_dvec3());
    (b - a).cross(c - a).normalize_or_zero().as_vec3()
}

/// `v` of unit length; in double precision, which no finite `f32` overflows.
fn unit(v: Vec3) -> Vec3 {
    v.as_dvec3().normalize_or_zero().as_vec3()
}

/// Light of a lamp above and to the left of the eye, and a little from everywhere.
fn lit(raster: &Raster, ray: &Ray, normal: Vec3) -> f32 {
    let lamp = unit(-unit(ray.direction) - unit(raster.right) * 0.35 - unit(raster.down) * 0.5);
    0.06 + 0.94 * normal.dot(lamp).max(0.0)
}

/// The nearest and farthest hit.
struct Depths {
    near: f32,
    far: f32,
}

impl Depths {
    fn of(raster: &Raster, hits: &[Option<Hit>]) -> Self {
        let nothing = Self { near: f32::INFINITY, far: f32::NEG_INFINITY };
        hits.iter().enumerate().fold(nothing, |all, (at, hit)| {
            let Some(hit) = hit else { return all };
            let (row, col) = (at / raster.cols as usize, at % raster.cols as usize);
            let depth = depth(&raster.ray(row as u32, col as u32), hit);
            Self { near: all.near.min(depth), far: all.far.max(depth) }
        })
    }

    fn brightness(&self, ray: &Ray, hit: &Hit) -> f32 {
        let range = self.far - self.near;
        let share = if range > 0.0 { (depth(ray, hit) - self.near) / range } else { 0.0 };
        1.0 - 0.97 * share
    }
}

pub(super) fn depth(ray: &Ray, hit: &Hit) -> f32 {
    hit.t * ray.direction.as_dvec3().length() as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::{Aabb, Projection};

    fn raster() -> Raster {
        Raster {
            projection: Projection::Parallel,
            rows: 1,
            cols: 3,
            origin: Vec3::new(-1.5, -0.5, 5.0),
            forward: Vec3::NEG_Z,
            right: Vec3::X,
            down: Vec3::Y,
        }
    }

    fn hit(t: f32, object: u32) -> Option<Hit> {
        Some(Hit { t, object, u: 0.2, v: 0.2 })
    }

    fn mesh() -> Geometry {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        Geometry::Triangles(Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 1], [0, 0, 0]] })
    }

    #[test]
    fn normals_face_the_eye_and_misses_are_transparent() {
        let hits = [hit(5.0, 0), hit(5.0, 1), None];
        let picture = shade(&mesh(), &raster(), &hits, Shading::Normal);
        assert_eq!(picture.get_pixel(0, 0).0, [128, 128, 255, 255]);
        assert_eq!(picture.get_pixel(1, 0), picture.get_pixel(0, 0), "both sides look the same");
        assert_eq!(*picture.get_pixel(2, 0), NOTHING);
    }

    #[test]
    fn near_is_bright_and_surfaces_without_area_are_drawn() {
        let hits = [hit(5.0, 0), hit(6.0, 2), hit(7.0, 1)];
        let picture = shade(&mesh(), &raster(), &hits, Shading::Depth);
        let [a, b, c] = [0, 1, 2].map(|x| picture.get_pixel(x, 0).0[0]);
        assert!(a > b && b > c, "{a} {b} {c}");
        assert_eq!(shade(&mesh(), &raster(), &hits, Shading::Light).get_pixel(1, 0).0[3], 255);
    }

    #[test]
    fn boxes_have_the_normal_of_the_face() {
        let boxes =
            Geometry::Boxes(vec![Aabb { min: Vec3::new(-2.0, -2.0, -1.0), max: Vec3::new(2.0, 2.0, 1.0) }]);
        let picture = shade(&boxes, &raster(), &[hit(4.0, 0), None, None], Shading::Normal);
        assert_eq!(picture.get_pixel(0, 0).0, [128, 128, 255, 255]);
    }
}
