//! Tests of the ray sets against brute force.

use super::*;
use crate::{SceneSpec, load};
use accel::{Builder, Geometry, Hit, Projection, Ray, Workload};
use baselines::Brute;
use primitives::KernelId;

fn scene(id: &str) -> Scene {
    load(&id.parse::<SceneSpec>().unwrap()).unwrap()
}

fn brute(scene: &Scene) -> Box<dyn Accel + '_> {
    Brute::new(KernelId::Double).build(scene, &Workload::GENERAL).unwrap()
}

fn make(scene: &Scene, id: RaysId, side: u32) -> Result<RaySet, RaysError> {
    generate(scene, &RaysSpec { id, rows: side, cols: side, seed: 9 }, brute(scene).as_ref())
}

fn list(scene: &Scene, id: RaysId, side: u32) -> Vec<Ray> {
    match make(scene, id, side).unwrap() {
        RaySet::List(list) => list,
        RaySet::Raster(_) => panic!("{id} is a raster"),
    }
}

fn hits(scene: &Scene, rays: &RaySet) -> Vec<Option<Hit>> {
    let mut hits = vec![None; rays.len()];
    brute(scene).trace(rays, &mut hits);
    hits
}

fn hit_rate(scene: &Scene, rays: Vec<Ray>) -> f64 {
    let rays = RaySet::List(rays);
    let hits = hits(scene, &rays);
    hits.iter().flatten().count() as f64 / hits.len() as f64
}

#[test]
fn every_set_is_sound_and_reproducible() {
    for id in [
        "bumps-2k",
        "unit-boxes",
        "unit-flat",
        "unit-one",
        "unit-points",
        "extreme-scale-m100",
        "extreme-sphere",
    ] {
        let scene = scene(id);
        for rays in RaysId::ALL {
            let made = match make(&scene, rays, 16) {
                Ok(made) => made,
                Err(error) => {
                    assert!(id == "unit-points" && rays.needs_hits(), "{id}: {error}");
                    continue;
                }
            };
            assert_eq!(made.len(), 256, "{id} {rays}");
            assert_eq!(made, make(&scene, rays, 16).unwrap(), "{id} {rays}");
            for i in 0..made.len() {
                made.ray(i).validate().unwrap_or_else(|error| panic!("{id} {rays} {i}: {error}"));
            }
            assert_eq!(matches!(made, RaySet::Raster(_)), rays.is_image());
            if rays.query() == Query::Occluded {
                assert!((0..made.len()).all(|i| made.ray(i).t_max.is_finite()));
            }
        }
    }
}

#[test]
fn empty_scenes_give_rays_or_reasons() {
    let scene = scene("unit-empty");
    for rays in RaysId::ALL {
        match make(&scene, rays, 4) {
            Ok(made) => assert_eq!(made.len(), 16, "{rays}"),
            Err(RaysError::NoHits { .. } | RaysError::NoObjects { .. }) => {}
            Err(error) => panic!("{rays}: {error}"),
        }
    }
}

#[test]
fn names_round_trip_and_slips_get_suggestions() {
    for id in RaysId::ALL {
        assert_eq!(id.to_string().parse(), Ok(id));
    }
    let Err(RaysError::Unknown { near, .. }) = "paralel".parse::<RaysId>() else { panic!() };
    assert_eq!(near[0], "parallel");
}

#[test]
fn the_papers_image_has_one_pixel_each_256th() {
    let scene = scene("boxes-1000-25");
    let cube = accel::Aabb { min: accel::Vec3::ZERO, max: accel::Vec3::ONE };
    let raster = parallel(&scene.view, &cube, 256, 256);
    assert_eq!(raster.projection, Projection::Parallel);
    let first = raster.ray(0, 0);
    assert_eq!((first.origin.x, first.origin.y), (0.5 / 256.0, 1.0 - 0.5 / 256.0));
    assert_eq!(raster.right, accel::Vec3::X / 256.0);
}

#[test]
fn images_see_the_scene() {
    for id in ["bumps-2k", "unit-far", "unit-tiny", "unit-huge", "stadium", "balls", "boxes-1000-25"] {
        let scene = scene(id);
        for rays in [RaysId::Parallel, RaysId::Perspective] {
            let made = make(&scene, rays, 12).unwrap();
            let seen = hits(&scene, &made).iter().flatten().count();
            assert!(seen > 20, "{id} {rays}: {seen} of {}", made.len());
        }
    }
}

#[test]
fn the_parallel_image_just_holds_the_bounds() {
    let scene = scene("bumps-2k");
    let bounds = scene.geometry.bounds();
    let raster = parallel(&scene.view, &bounds, 64, 64);
    let [right, down] = [raster.right, raster.down].map(|v| v.as_dvec3());
    for corner in 0..8 {
        let pick = |a: usize| if corner >> a & 1 == 0 { bounds.min[a] } else { bounds.max[a] };
        let offset = accel::Vec3::new(pick(0), pick(1), pick(2)).as_dvec3() - raster.origin.as_dvec3();
        for axis in [right, down] {
            let pixel = offset.dot(axis) / axis.length_squared();
            assert!((-0.001..64.001).contains(&pixel), "{pixel}");
        }
        assert!(offset.dot(raster.forward.as_dvec3()) > 0.0);
    }
}

#[test]
fn spawned_rays_seldom_meet_what_they_leave() {
    for id in ["bumps-2k", "extreme-sphere", "unit-huge", "unit-tiny"] {
        let scene = scene(id);
        let diffuse = list(&scene, RaysId::Diffuse, 24);
        let primary = RaySet::Raster(perspective(&scene.view, 24, 24));
        let left: Vec<Hit> = hits(&scene, &primary).into_iter().flatten().collect();
        let own = hits(&scene, &RaySet::List(diffuse.clone()))
            .iter()
            .enumerate()
            .filter(|(i, hit)| {
                hit.is_some_and(|hit| hit.object == left[i * left.len() / diffuse.len()].object)
            })
            .count();
        assert!(own <= 2, "{id}: {own} of {}", diffuse.len());
    }
}

#[test]
fn shadows_fall_on_some_points_only() {
    let scene = scene("balls@scale=3");
    let rate = hit_rate(&scene, list(&scene, RaysId::Shadow, 16));
    assert!((0.02..0.9).contains(&rate), "{rate}");
}

#[test]
fn leak_rays_hit_a_closed_mesh() {
    let scene = scene("bumps-2k");
    for id in [RaysId::LeakFace, RaysId::LeakEdge, RaysId::LeakVertex] {
        let rate = hit_rate(&scene, list(&scene, id, 24));
        assert!(rate > 0.95, "{id}: {rate}");
    }
    assert_eq!(hit_rate(&scene, list(&scene, RaysId::LeakFace, 24)), 1.0);
}

#[test]
fn aimed_rays_point_at_their_feature() {
    let scene = scene("small-1k");
    let Geometry::Triangles(mesh) = &scene.geometry else { panic!() };
    for ray in list(&scene, RaysId::Vertex, 8) {
        let nearest = mesh.positions.iter().map(|p| p.distance(ray.at(1.0))).fold(f32::MAX, f32::min);
        assert!(nearest < 1e-6, "{nearest}");
    }
}

#[test]
fn axis_rays_lie_in_slice_planes() {
    let scene = scene("small-1k");
    let bounds = scene.geometry.bounds();
    let rays = list(&scene, RaysId::Axis, 32);
    let in_plane = |ray: &Ray, a: usize| {
        let (low, high) = (bounds.min[a], bounds.max[a]);
        ray.direction[a] == 0.0 && (0..=256).any(|k| low + (high - low) * (k as f32 / 256.0) == ray.origin[a])
    };
    let many = rays.iter().filter(|ray| (0..3).any(|a| in_plane(ray, a))).count();
    assert!(many > rays.len() / 4, "{many} of {}", rays.len());
    assert!(
        rays.iter().any(|ray| ray.direction.to_array().iter().any(|x| x.to_bits() == (-0.0_f32).to_bits()))
    );
    assert!(rays.iter().all(|ray| ray.direction.abs().max_element() == 1.0));
}

#[test]
fn ranges_end_exactly_at_hits() {
    let scene = scene("bumps-2k");
    let rays = list(&scene, RaysId::Range, 16);
    let found = hits(&scene, &RaySet::List(rays.clone()));
    let closed = rays.iter().zip(&found).filter(|(ray, _)| ray.t_min == ray.t_max);
    let mut seen = 0;
    for (ray, hit) in closed {
        assert_eq!(hit.map(|hit| hit.t), Some(ray.t_min));
        seen += 1;
    }
    assert!(seen > 10);
}
