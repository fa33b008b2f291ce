//! The crate as others use it.

use ssm::{BuildError, InputError, Kernel, Ray, Simd, Ssm, Vec3};

#[test]
fn a_mesh_is_traced_and_bad_ones_are_errors() {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.5]];
    let triangles = [[0, 1, 2], [1, 3, 2]];
    let options = Ssm::options().kernel(Kernel::Watertight).simd(Simd::Portable).density(2.0);
    let ray = |x: f32| Ray::new(Vec3::new(x, x, 1.0), Vec3::NEG_Z);
    let rays = [ray(0.2), ray(0.8), ray(2.0), ray(f32::NAN)];
    for ssm in [Ssm::build(&positions, &triangles).unwrap(), options.build(&positions, &triangles).unwrap()] {
        let hits = ssm.trace(&rays);
        assert_eq!(
            hits.iter().map(|hit| hit.map(|hit| hit.object)).collect::<Vec<_>>(),
            [Some(0), Some(1), None, None]
        );
        assert_eq!(rays.map(|ray| ssm.closest(&ray)), *hits);
        assert_eq!(ssm.trace_occluded(&rays), [true, true, false, false]);
        assert_eq!(rays.map(|ray| ssm.occluded(&ray)), [true, true, false, false]);
        assert!(ssm.footprint().total() > 0);
    }
    let error = Ssm::build(&positions, &[[0, 1, 4]]).unwrap_err();
    assert_eq!(error, BuildError::Input(InputError::Index { triangle: 0, index: 4, positions: 4 }));
    assert!(matches!(options.density(0.0).build(&positions, &triangles), Err(BuildError::Setting { .. })));
    assert!(matches!(
        options.memory_limit(9).build(&positions, &triangles),
        Err(BuildError::TooLarge { .. })
    ));
    assert!(Ssm::build::<Vec3>(&[], &[]).unwrap().trace(&rays).iter().all(Option::is_none));
}
