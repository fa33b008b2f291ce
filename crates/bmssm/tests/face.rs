//! The crate as others use it.

use bmssm::{
    Aabb, Bmssm, BuildError, Camera, CameraError, InputError, Kernel, Objects, Ray, Simd, Surface, Vec3,
};

/// A bumpy square of two triangles for each of 40 × 40 fields.
fn mesh() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let at = |i: u32| (i % 41, i / 41);
    let height = |x: u32, y: u32| ((x * 7 + y * 13) % 11) as f32 * 0.02;
    let positions =
        (0..41 * 41).map(at).map(|(x, y)| [x as f32 / 40.0, y as f32 / 40.0, height(x, y)]).collect();
    let fields = (0..41 * 40).filter(|i| i % 41 != 40);
    (positions, fields.flat_map(|i| [[i, i + 1, i + 41], [i + 1, i + 42, i + 41]]).collect())
}

fn rays() -> Vec<Ray> {
    let ray = |i: u16| {
        let (x, y) = (f32::from(i % 37) / 30.0, f32::from(i / 37) / 30.0);
        Ray::new(Vec3::new(x, y, 2.0), Vec3::new(0.3 - x * 0.5, 0.1, -1.0))
    };
    (0..1200).map(ray).collect()
}

#[test]
fn all_ways_to_ask_give_one_answer() {
    let (positions, triangles) = mesh();
    let bmssm = Bmssm::build(&positions, &triangles).unwrap();
    let rays = rays();
    let hits = bmssm.trace(&rays);
    assert!(hits.iter().flatten().count() > 300 && hits.iter().any(Option::is_none));
    let occluded = bmssm.trace_occluded(&rays);
    for ((ray, hit), occluded) in rays.iter().zip(&hits).zip(occluded) {
        assert_eq!(bmssm.closest(ray), *hit);
        assert_eq!((bmssm.occluded(ray), occluded), (hit.is_some(), hit.is_some()));
    }
    let points: Vec<Vec3> = positions.iter().copied().map(Vec3::from).collect();
    let portable = Bmssm::options().simd(Simd::Portable).build(&points, &triangles).unwrap();
    assert_eq!(portable.trace(&rays), hits);
    let exact = Bmssm::options().kernel(Kernel::Double).build(&points, &triangles).unwrap();
    assert_eq!(exact.trace(&rays).iter().flatten().count(), hits.iter().flatten().count());
}

#[test]
fn an_image_answers_for_its_pixels() {
    let (positions, triangles) = mesh();
    let any = Bmssm::build(&positions, &triangles).unwrap();
    let eye = [0.5, 0.4, 2.0];
    for camera in [
        Camera::perspective(eye, [0.5; 3], [0.0, 1.0, 0.0], 40.0, [30, 50]).unwrap(),
        Camera::parallel(eye, [0.5; 3], [0.0, 1.0, 0.0], 0.7, [30, 50]).unwrap(),
    ] {
        let image = Bmssm::for_image(&camera, &positions, &triangles).unwrap();
        let shown = image.trace();
        assert!(shown.iter().flatten().count() > 300);
        for (pixel, hit) in (0..).zip(&shown) {
            let (row, col) = (pixel / 50, pixel % 50);
            assert_eq!(image.closest(row, col), *hit);
            assert_eq!(any.closest(&camera.ray(row, col).unwrap()), *hit);
        }
        assert_eq!((image.closest(30, 0), image.closest(0, 50)), (None, None));
        assert!(image.footprint().total() > 0);
    }
}

#[test]
fn unusable_input_is_an_error_and_no_panic() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let error = |positions: &[[f32; 3]], triangles: &[[u32; 3]]| match Bmssm::build(positions, triangles) {
        Err(BuildError::Input(error)) => error,
        other => panic!("{other:?}"),
    };
    let index = error(&corners, &[[0, 1, 2], [0, 1, 3]]);
    assert_eq!(index, InputError::Index { triangle: 1, index: 3, positions: 3 });
    assert_eq!(index.to_string(), "triangle 1 names position 3, but there are 3 positions");
    let nan = error(&[corners[0], [0.0, f32::NAN, 0.0]], &[]);
    assert!(matches!(nan, InputError::Position { position: 1, .. }), "{nan}");
    let far = error(&[[-3e38; 3], [3e38; 3], [0.0; 3]], &[[0, 1, 2]]);
    assert!(matches!(far, InputError::Extent { .. }), "{far}");
    let little = Bmssm::options().memory_limit(10).build(&corners, &[[0, 1, 2]]);
    assert!(matches!(little, Err(BuildError::TooLarge { limit: 10, .. })), "{little:?}");
}

#[test]
fn an_empty_scene_and_rays_that_are_none_hit_nothing() {
    let nothing = Bmssm::build::<Vec3>(&[], &[]).unwrap();
    assert_eq!(nothing.trace(&rays()), vec![None; 1200]);
    let (positions, triangles) = mesh();
    let bmssm = Bmssm::build(&positions, &triangles).unwrap();
    let middle = Vec3::new(0.5, 0.5, 2.0);
    let down = Ray::new(middle, Vec3::NEG_Z);
    let none = [
        Ray::new(Vec3::NAN, Vec3::NEG_Z),
        Ray::new(middle, Vec3::ZERO),
        Ray::new(middle, Vec3::new(0.0, f32::INFINITY, -1.0)),
        Ray { t_min: f32::NAN, ..down },
        Ray { t_max: f32::NAN, ..down },
        Ray { t_min: 5.0, t_max: 1.0, ..down },
    ];
    let mut mixed = vec![down];
    mixed.extend(none);
    let hits = bmssm.trace(&mixed);
    assert!(hits[0].is_some() && hits[1..].iter().all(Option::is_none), "{hits:?}");
    assert!(bmssm.trace_occluded(&mixed)[1..].iter().all(|occluded| !occluded));
    for ray in none {
        assert!(bmssm.closest(&ray).is_none() && !bmssm.occluded(&ray));
    }
}

#[test]
fn cameras_that_see_nothing_are_refused() {
    let up = [0.0, 1.0, 0.0];
    let camera = |eye: [f32; 3], fov, size| Camera::perspective(eye, [0.0; 3], up, fov, size);
    assert_eq!(camera([0.0; 3], 45.0, [4, 4]), Err(CameraError::Direction));
    assert_eq!(camera([0.0, 2.0, 0.0], 45.0, [4, 4]), Err(CameraError::Direction));
    assert_eq!(camera([f32::NAN, 2.0, 0.0], 45.0, [4, 4]), Err(CameraError::NotFinite));
    assert_eq!(camera([1.0; 3], 180.0, [4, 4]), Err(CameraError::Height(180.0)));
    assert_eq!(camera([1.0; 3], 45.0, [0, 4]), Err(CameraError::Size(0, 4)));
    let flat = Camera::parallel([1.0; 3], [0.0; 3], up, 0.0, [4, 4]);
    assert_eq!(flat, Err(CameraError::Height(0.0)));
    assert!(Camera::parallel([1.0; 3], [0.0; 3], up, 1e-45, [4, 4]).is_err());
}

/// Objects that say nonsense.
#[derive(Debug)]
struct Odd(Vec<Aabb>);

impl Objects for Odd {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn bounds(&self, id: u32) -> Aabb {
        self.0[id as usize]
    }

    fn intersect(&self, id: u32, _: &Ray, _: f32) -> Option<Surface> {
        Some(Surface { t: id as f32, u: 0.0, v: 0.0 })
    }
}

#[test]
fn objects_are_held_to_their_boxes() {
    let unit = |x: f32| Aabb { min: Vec3::new(x, 0.0, 0.0), max: Vec3::new(x + 1.0, 1.0, 1.0) };
    let bad = Odd(vec![unit(0.0), Aabb::EMPTY]);
    let error = Bmssm::build_objects(&bad).unwrap_err();
    assert!(matches!(error, BuildError::Input(InputError::Bounds { object: 1, .. })), "{error}");
    // Each says that every ray hits it at t = its number: true of one in ten for rays along x.
    let row = Odd((0u8..10).map(|i| unit(f32::from(i))).collect());
    let bmssm = Bmssm::build_objects(&row).unwrap();
    let ray = Ray::new(Vec3::new(-2.0, 0.5, 0.5), Vec3::X);
    let hit = bmssm.closest(&ray);
    assert_eq!(hit, None, "each would be hit at t from its number + 2 on");
    let ray = Ray::new(Vec3::new(0.5, 0.5, 0.5), Vec3::X);
    assert_eq!(bmssm.closest(&ray).map(|hit| hit.object), Some(0));
    assert_eq!(bmssm.trace(&rays()).len(), 1200);
}
