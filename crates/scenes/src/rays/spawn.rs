//! Rays that start where primary rays hit.

use super::frame::{Frame, cosine_direction};
use super::id::{RaysError, RaysId};
use super::raster::perspective;
use super::spec::RaysSpec;
use crate::random::Random;
use accel::{Accel, Geometry, Hit, Ray, RaySet, Scene};
use glam::DVec3;

/// A hit as the start of further rays.
pub struct Start {
    /// The hit point, on the ray, not offset.
    pub point: DVec3,
    /// The object's geometric normal, on the side that the ray came from.
    pub normal: DVec3,
}

/// How far spawned rays start from the surface, along its geometric normal: 2⁻¹⁷ of the largest extent of
/// the scene or 2⁻¹⁹ (sixteen units in the last place) of the largest coordinate, whichever is more. The
/// hit point's own error is a few such units, so that rays seldom meet the object that they leave.
pub fn offset(scene: &Scene) -> f64 {
    let frame = Frame::of(scene);
    let largest = frame.min.abs().max(frame.max.abs()).max_element();
    ((frame.max - frame.min).max_element() * 2.0_f64.powi(-17)).max(largest * 2.0_f64.powi(-19))
}

/// Hits of the rays `rays`, in their order.
pub fn starts(scene: &Scene, rays: &RaySet, tracer: &dyn Accel) -> Vec<Start> {
    let mut hits = vec![None; rays.len()];
    tracer.trace(rays, &mut hits);
    let hit = |(i, hit): (usize, &Option<Hit>)| hit.map(|hit| start(&scene.geometry, &rays.ray(i), &hit));
    hits.iter().enumerate().filter_map(hit).collect()
}

fn start(geometry: &Geometry, ray: &Ray, hit: &Hit) -> Start {
    let direction = ray.direction.as_dvec3();
    let point = ray.origin.as_dvec3() + direction * f64::from(hit.t);
    let object = hit.object as usize;
    let normal = match geometry {
        Geometry::Triangles(mesh) => super::features::normal(&mesh.corners(object)),
        Geometry::Solids(solids) => solids[object].normal(point),
        Geometry::Boxes(boxes) => {
            let (min, max) = (boxes[object].min.as_dvec3(), boxes[object].max.as_dvec3());
            let gap = (point - min).abs().min((point - max).abs());
            let axis = (0..3).min_by(|a, b| gap[*a].total_cmp(&gap[*b]));
            axis.map(|axis| DVec3::AXES[axis])
        }
    };
    let normal = normal.unwrap_or_else(|| -direction.normalize_or(DVec3::Z));
    Start { point, normal: if normal.dot(direction) > 0.0 { -normal } else { normal } }
}

/// `shadow`, `ambient` and `diffuse` rays: the hits of the perspective image in pixel order, each as often as
/// it takes to make the number asked for.
pub fn from_hits(scene: &Scene, spec: &RaysSpec, tracer: &dyn Accel) -> Result<Vec<Ray>, RaysError> {
    let primary = RaySet::Raster(perspective(&scene.view, spec.rows, spec.cols));
    let starts = starts(scene, &primary, tracer);
    let count = spec.count();
    if starts.is_empty() && count > 0 {
        return Err(RaysError::NoHits { rays: spec.id, scene: scene.id.clone() });
    }
    let offset = offset(scene);
    let light = light(scene);
    let reach = (0.4 * Frame::of(scene).radius) as f32;
    let mut random = Random::new(spec.seed ^ 2);
    let ray = |i: usize| {
        let Start { point, normal } = starts[i * starts.len() / count];
        let origin = (point + normal * offset).as_vec3();
        match spec.id {
            // Stops short of the light: t = 1 is the light itself.
            RaysId::Shadow => {
                let direction = (light - origin.as_dvec3()).as_vec3();
                Ray { t_max: 1.0 - 1.0 / 1024.0, ..Ray::new(origin, direction) }
            }
            id => {
                let direction = cosine_direction(&mut random, normal).as_vec3();
                let t_max = if id == RaysId::Ambient { reach } else { f32::INFINITY };
                Ray { t_max, ..Ray::new(origin, direction) }
            }
        }
    };
    Ok((0..count).map(ray).filter(|ray| ray.validate().is_ok()).collect())
}

/// A light above and beside the eye, a third as far from it as its target: inside halls where the eye is.
fn light(scene: &Scene) -> DVec3 {
    let view = &scene.view;
    let (eye, up) = (view.eye.as_dvec3(), view.up.as_dvec3().normalize_or(DVec3::Z));
    let forward = view.target.as_dvec3() - eye;
    let right = forward.cross(up).normalize_or(DVec3::X);
    eye + (up + right).normalize() * (forward.length() / 3.0)
}
