//! Settings, limits, footprints and counters.

mod common;

use accel::{BuildError, Builder, Group, Workload};
use common::{cloud, rays};
use ssm::suite::{Resolution, Settings, Ssm, SsmList};

#[test]
fn settings_that_make_no_sense_are_named() {
    let settings = [
        ("resolution", "0"),
        ("density", "-1"),
        ("kernel", "fast"),
        ("simd", "mmx"),
        ("memory", "all"),
        ("n", "4"),
    ];
    for (name, value) in settings {
        for error in [SsmList::default().set(name, value), Ssm::default().set(name, value)] {
            let Err(BuildError::Setting { setting, problem, .. }) = error else {
                panic!("{name}={value} was taken");
            };
            assert_eq!(setting, name);
            assert!(!problem.is_empty());
        }
    }
    let (zero, scene) = (Settings::new(Resolution::Slices([0, 4, 4])), cloud(10, 0.1));
    let refused = SsmList::new(zero).build(&scene, &Workload::GENERAL);
    assert!(matches!(refused, Err(BuildError::Setting { .. })));
}

#[test]
fn settings_print_as_they_are_set() {
    let mut ssm = Ssm::default();
    for (name, value) in [
        ("resolution", "8x4x2"),
        ("simd", "portable"),
        ("kernel", "moller-trumbore"),
        ("memory", "5"),
        ("divide", "1.5"),
    ] {
        ssm.set(name, value).unwrap();
    }
    let printed = ssm.settings();
    let mut again = Ssm::default();
    for pair in printed.split(' ') {
        let (name, value) = pair.split_once('=').unwrap();
        again.set(name, value).unwrap();
    }
    assert_eq!(ssm, again);
}

#[test]
fn too_large_a_grid_is_refused_before_it_is_allocated() {
    let scene = cloud(100, 0.1);
    let settings = Settings::new(Resolution::Slices([16_384; 3]));
    for builder in [&SsmList::new(settings) as &dyn Builder, &Ssm { settings, divide: None }] {
        let Err(BuildError::TooLarge { bytes, limit, .. }) = builder.build(&scene, &Workload::GENERAL) else {
            panic!("2^42 cells were built");
        };
        assert!(bytes > 1 << 43 && limit > 0);
    }
    let settings = Settings { memory: Some(2200), ..Settings::new(Resolution::Slices([8; 3])) };
    for builder in [&SsmList::new(settings) as &dyn Builder, &Ssm { settings, divide: None }] {
        let Err(BuildError::TooLarge { bytes, limit: 2200, .. }) = builder.build(&scene, &Workload::GENERAL)
        else {
            panic!("more than 2200 bytes were taken");
        };
        let fits = Settings { memory: Some(bytes.max(1 << 16)), ..settings };
        Ssm { settings: fits, divide: None }.build(&scene, &Workload::GENERAL).unwrap();
        SsmList::new(fits).build(&scene, &Workload::GENERAL).unwrap();
    }
}

#[test]
fn the_papers_layout_takes_what_the_paper_says_but_for_the_pointer() {
    let scene = cloud(500, 0.1);
    let list = SsmList::new(Settings::new(Resolution::Slices([10; 3])));
    let footprint = list.build(&scene, &Workload::GENERAL).unwrap().footprint();
    let bytes = |name| footprint.parts.iter().find(|part| part.name == name).unwrap().bytes;
    assert_eq!((bytes("counters"), bytes("pointers")), (2 * 1000, 4 * 1000));
    assert!(bytes("ids") > 2 * 500);
    assert_eq!(footprint.bytes(Group::GeometryCopy), 0);
}

#[test]
fn counters_tell_what_early_ends_and_mailboxes_save() {
    let scene = cloud(2000, 0.1);
    let rays = rays(&scene, 500);
    for builder in [&SsmList::default() as &dyn Builder, &Ssm::default()] {
        let built = builder.build(&scene, &Workload::GENERAL).unwrap();
        let nearest = built.count(&rays, false).unwrap();
        let any = built.count(&rays, true).unwrap();
        assert!(nearest.cells > 0 && nearest.tests > 0 && nearest.candidates > 0);
        assert!(any.cells < nearest.cells && any.tests < nearest.tests, "{}", builder.id());
        assert!(!built.plan().is_empty());
    }
}

#[test]
fn a_mailbox_spares_tests_and_changes_no_candidate() {
    let scene = cloud(500, 0.5);
    let rays = rays(&scene, 200);
    let count = |mailbox| {
        let list = SsmList { mailbox, ..SsmList::default() };
        list.build(&scene, &Workload::GENERAL).unwrap().count(&rays, false).unwrap()
    };
    let (without, with) = (count(false), count(true));
    assert_eq!((without.tests, without.cells), (without.candidates, with.cells));
    assert!(with.tests < without.tests && with.candidates == without.candidates);
}
