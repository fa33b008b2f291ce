use super::*;

/// n × n squares of two triangles in the plane z = 1, number 2·(row·n + column) and the next.
fn sheet(n: u32) -> Mesh {
    let at = |i: u32| i as f32;
    let positions = (0..=n).flat_map(|y| (0..=n).map(move |x| Vec3::new(at(x), at(y), 1.0))).collect();
    let triangles = (0..n)
        .flat_map(|y| (0..n).map(move |x| y * (n + 1) + x))
        .flat_map(|a| [[a, a + 1, a + n + 1], [a + n + 2, a + n + 1, a + 1]])
        .collect();
    Mesh { positions, triangles }
}

fn build(mesh: &Mesh, settings: SceneSettings) -> EmbreeScene<'_> {
    EmbreeScene::new(Device::new(1).unwrap(), mesh, settings).unwrap()
}

fn down(x: f32, y: f32) -> Ray {
    Ray::new(Vec3::new(x, y, 3.0), Vec3::new(0.0, 0.0, -2.0))
}

fn all_settings() -> impl Iterator<Item = SceneSettings> {
    [Quality::Low, Quality::Medium, Quality::High].into_iter().flat_map(|quality| {
        [(false, false), (true, false), (false, true), (true, true)].map(|(robust, compact)| SceneSettings {
            quality,
            robust,
            compact,
        })
    })
}

#[test]
fn every_kind_of_scene_finds_what_is_there() {
    let mesh = sheet(8);
    for settings in all_settings() {
        let scene = build(&mesh, settings);
        for square in 0..64_u32 {
            let (x, y) = ((square % 8) as f32, (square / 8) as f32);
            let hit = scene.closest(&down(x + 0.25, y + 0.25)).unwrap();
            assert_eq!(hit.object, 2 * square, "{settings:?}");
            // How Embree divides depends on the instruction set it chooses.
            assert!((hit.t - 1.0).abs() < 1e-6, "{settings:?}: {}", hit.t);
            assert!((hit.u - 0.25).abs() < 1e-6 && (hit.v - 0.25).abs() < 1e-6);
            assert!(scene.occluded(&down(x + 0.25, y + 0.25)));
        }
        assert_eq!(scene.closest(&down(-0.5, 2.0)), None);
        assert!(!scene.occluded(&down(-0.5, 2.0)));
        let short = Ray { t_max: 0.9, ..down(2.3, 2.3) };
        assert_eq!(scene.closest(&short), None);
        assert!(!scene.occluded(&short));
    }
}

#[test]
fn packets_answer_as_single_rays_do() {
    let mesh = sheet(8);
    let scene = build(&mesh, SceneSettings { robust: true, ..SceneSettings::default() });
    for count in [0, 1, 7, 15, 16] {
        let rays: Vec<Ray> = (0..count).map(|i| down(i as f32 * 0.61 - 0.5, 1.3)).collect();
        for coherence in [Coherence::Coherent, Coherence::Incoherent] {
            let mut hits = vec![None; count];
            let mut occluded = vec![false; count];
            scene.closest16(&rays, coherence, &mut hits);
            scene.occluded16(&rays, coherence, &mut occluded);
            for (i, ray) in rays.iter().enumerate() {
                let single = scene.closest(ray);
                assert_eq!(hits[i].map(|h| (h.object, h.t)), single.map(|h| (h.object, h.t)));
                assert_eq!(occluded[i], single.is_some());
            }
        }
    }
}

#[test]
#[should_panic(expected = "a packet holds 16 rays")]
fn a_packet_of_17_is_refused() {
    let mesh = sheet(1);
    let scene = build(&mesh, SceneSettings::default());
    scene.closest16(&[down(0.2, 0.2); 17], Coherence::Coherent, &mut [None; 17]);
}

/// The words behind a struct that Embree is given.
#[repr(C)]
struct Guarded<T> {
    inner: T,
    guard: [u32; 16],
}

const GUARD: [u32; 16] = [0x5afe_c0de; 16];

/// A single ray-hit as its 24 words, of which 20 are fields.
#[repr(C)]
union Words {
    rayhit: RTCRayHit,
    words: [u32; 24],
}

/// The word of the ray-hit where Embree has put `instPrimID` since 4.3.
const INST_PRIM_ID: usize = 20;

#[test]
fn embree_writes_nothing_behind_its_structs() {
    let mesh = sheet(4);
    let scene = build(&mesh, SceneSettings::default());
    let intersect = (&raw const INCOHERENT.intersect).cast_mut();
    let occluded = (&raw const INCOHERENT.occluded).cast_mut();
    let ray = single(&down(1.2, 1.2));

    let mut one = Guarded { inner: Words { words: [7; 24] }, guard: GUARD };
    // SAFETY: a field of the union that is plain numbers, with all its words set before.
    let rayhit = unsafe { &mut one.inner.rayhit };
    (rayhit.ray, rayhit.hit) = (ray, RTCHit::default());
    // SAFETY: a committed scene and a ray-hit of the right layout inside a bigger struct.
    unsafe { sys::rtcIntersect1(scene.handle(), (&raw mut one.inner).cast(), intersect) };
    // SAFETY: every word is set, and any word is a number.
    let (rayhit, words) = unsafe { (one.inner.rayhit, one.inner.words) };
    assert_eq!(rayhit.hit.primID, 2 * (4 + 1));
    let (_, minor, _) = scene.version();
    assert_eq!(words[INST_PRIM_ID] != 7, minor >= 3, "instPrimID came with 4.3");
    assert_eq!(words[INST_PRIM_ID + 1..], [7; 3]);
    assert_eq!(one.guard, GUARD);

    let mut shadow = Guarded { inner: ray, guard: GUARD };
    // SAFETY: as above.
    unsafe { sys::rtcOccluded1(scene.handle(), &raw mut shadow.inner, occluded) };
    assert_eq!(shadow.inner.tfar, f32::NEG_INFINITY);
    assert_eq!(shadow.guard, GUARD);

    let active = Active::first(16);
    let mut many = Guarded { inner: packet(&[down(1.2, 1.2); 16]), guard: GUARD };
    // SAFETY: as above, with an aligned mask.
    unsafe { sys::rtcIntersect16(active.as_ptr(), scene.handle(), &raw mut many.inner, intersect) };
    assert_eq!(many.inner.hit.primID, [10; 16]);
    assert_eq!(many.guard, GUARD);

    let mut shadows = Guarded { inner: packet(&[down(1.2, 1.2); 16]).ray, guard: GUARD };
    // SAFETY: as above.
    unsafe { sys::rtcOccluded16(active.as_ptr(), scene.handle(), &raw mut shadows.inner, occluded) };
    assert_eq!(shadows.inner.tfar, [f32::NEG_INFINITY; 16]);
    assert_eq!(shadows.guard, GUARD);
}

#[test]
fn memory_is_counted_and_compact_takes_less() {
    let mesh = sheet(100);
    let plain = build(&mesh, SceneSettings::default());
    let compact = build(&mesh, SceneSettings { compact: true, ..SceneSettings::default() });
    let triangles = mesh.triangles.len() as u64;
    let use_ = plain.memory();
    assert!(use_.now > 20 * triangles && use_.now < 200 * triangles, "{use_:?}");
    assert!(use_.peak >= use_.now);
    assert!(compact.memory().now < use_.now);
}

#[test]
fn positions_are_shared_where_there_is_room_behind_them() {
    let mut mesh = sheet(3);
    mesh.positions.shrink_to_fit();
    let bytes = (mesh.positions.len() + 1) * size_of::<Vec3>();
    assert_eq!(build(&mesh, SceneSettings::default()).copied_bytes(), bytes);
    mesh.positions.reserve_exact(1);
    let scene = build(&mesh, SceneSettings { compact: true, ..SceneSettings::default() });
    assert_eq!(scene.copied_bytes(), 0);
    assert_eq!(scene.closest(&down(2.25, 2.25)).map(|h| h.object), Some(16));
}

#[test]
fn an_empty_scene_is_never_hit() {
    let mesh = Mesh::default();
    let scene = build(&mesh, SceneSettings::default());
    assert_eq!(scene.closest(&down(0.0, 0.0)), None);
    assert!(!scene.occluded(&down(0.0, 0.0)));
}

#[test]
fn an_index_out_of_range_is_refused_before_embree_reads_it() {
    let mut mesh = sheet(1);
    mesh.triangles.push([0, 4, 1]);
    let error = EmbreeScene::new(Device::new(1).unwrap(), &mesh, SceneSettings::default()).err();
    assert_eq!(error, Some(EmbreeError::Index { triangle: 2, position: 4, positions: 4 }));
}
