//! Tests of scenes as a whole: loading by name, files good and bad, export, bits.

use super::*;
use accel::{Geometry, Mesh, Scene, Vec3};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn get(name: &str) -> Result<Scene, SceneError> {
    load(&name.parse()?)
}

fn mesh(scene: &Scene) -> &Mesh {
    match &scene.geometry {
        Geometry::Triangles(mesh) => mesh,
        other => panic!("{} is made of {}", scene.id, other.kind()),
    }
}

fn file(folder: &TempDir, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    path
}

fn read(name: &str, bytes: impl AsRef<[u8]>) -> Result<Mesh, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    Ok(load_mesh(&file(&folder, name, bytes))?.mesh)
}

#[test]
fn every_small_scene_loads_and_frames_itself() {
    for info in list().into_iter().filter(|info| info.available) {
        if ["-1m", "-2m", "200k", "dragon"].iter().any(|big| info.id.ends_with(big)) {
            continue;
        }
        let scene = get(&info.id).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.id, info.id);
        assert_eq!(scene.geometry.is_empty(), info.id == "unit-empty", "{}", info.id);
        let towards = scene.view.target.as_dvec3() - scene.view.eye.as_dvec3();
        assert!(towards.is_finite() && towards.cross(scene.view.up.as_dvec3()).length() > 0.0, "{}", info.id);
        if let Geometry::Triangles(mesh) = &scene.geometry {
            assert!(mesh.positions.iter().all(|p| p.is_finite()), "{}", info.id);
            assert!(
                mesh.triangles.iter().flatten().all(|i| (*i as usize) < mesh.positions.len()),
                "{}",
                info.id
            );
        }
    }
}

/// The bits of generated scenes, once and for all: figures in old records stay comparable.
#[test]
fn bits_never_change() {
    let expected = [
        ("small-1k", "b93f102d0ca5"),
        ("balls", "cb5bcf912ef4"),
        ("tree", "e66f40eb0d0a"),
        ("mount", "dc99328bd2ce"),
        ("rings", "c8d43f42cd8c"),
        ("gears", "0f3e9a8d7fa4"),
        ("sombrero", "8354fafee00d"),
        ("stadium", "b6d54994ec93"),
        ("bumps-20k", "2be24e2cd4bc"),
        ("needles", "318a8ec88f05"),
        ("shells", "96570e4efa56"),
        ("boxes-1000-25", "b250a56c9633"),
        ("foliage-1k", "696e5bf2e3ac"),
        ("strands-1k", "fece751bffc5"),
        ("clutter-1k", "d846cbca1e41"),
    ];
    let found = expected.map(|(id, _)| (id, checksum(&get(id).unwrap().geometry)[..12].to_owned()));
    assert_eq!(found, expected.map(|(id, bits)| (id, bits.to_owned())));
}

#[test]
fn closed_scenes_are_closed() {
    for id in ["bumps-20k", "extreme-sphere", "unit-far", "unit-tiny"] {
        assert!(solid::is_watertight(mesh(&get(id).unwrap())), "{id}");
    }
}

#[test]
fn modifiers_change_the_scene_and_its_name() {
    let plain = get("bumps-2k").unwrap();
    let scaled = get("bumps-2k@scale=-100").unwrap();
    assert_eq!(scaled.id, "bumps-2k@scale=-100");
    let factor = 2.0_f32.powi(-100);
    for (p, q) in mesh(&plain).positions.iter().zip(&mesh(&scaled).positions) {
        assert_eq!(*p * factor, *q);
    }
    let split = load_full(&"stadium@split=20".parse().unwrap()).unwrap();
    let original = split.original.unwrap();
    assert_eq!(original.len(), split.scene.geometry.len());
    assert_eq!(*original.last().unwrap() as usize, get("stadium").unwrap().geometry.len() - 1);
    assert!(matches!(get("bumps-2k@scale=130"), Err(SceneError::NotFinite { .. })));
}

#[test]
fn exported_scenes_read_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    for id in ["gears", "small-1k", "unit-tiny", "extreme-scale-p100"] {
        let scene = get(id).unwrap();
        let path = folder.path().join("scene.obj");
        write_obj(&scene, fs::File::create(&path).unwrap()).unwrap();
        let back = get(path.to_str().unwrap()).unwrap();
        assert_eq!(checksum(&back.geometry), checksum(&scene.geometry), "{id}");
    }
    let boxes = get("unit-boxes").unwrap();
    let path = folder.path().join("boxes.obj");
    write_obj(&boxes, fs::File::create(&path).unwrap()).unwrap();
    let back = get(path.to_str().unwrap()).unwrap();
    assert_eq!(back.geometry.len(), 12 * boxes.geometry.len());
    assert_eq!(back.geometry.bounds(), boxes.geometry.bounds());
}

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

#[test]
fn obj_statements() {
    let text = format!(
        "mtllib missing.mtl\r\n{TETRAHEDRON}vn 1 0 0\nusemtl x\nl 1 2\nf 1/7 2/8/9 3//1 4 # fan\nf -4 -3 -1\n"
    );
    let mesh = read("a.obj", text).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 3]]);
    assert_eq!(mesh.positions[1], Vec3::X);
    let forward = read("a.obj", format!("f 1 2 3\n{TETRAHEDRON}")).unwrap();
    assert_eq!(forward.triangles, [[0, 1, 2]]);
}

#[test]
fn obj_is_taken_as_it_is_found() {
    let mark = read("a.obj", format!("\u{feff}{TETRAHEDRON}f 1 2 3")).unwrap();
    assert_eq!((mark.positions.len(), mark.positions[2]), (4, Vec3::Y), "no vertex is lost");
    // Names in Latin-1, a fourth coordinate, colours, blanks, a comment that touches, polylines, groups.
    let found =
        b"o caf\xe9\n v 0 0 0 2 # w\nv 1 0 0 0.5 0.5 0.5\nusemtl\nv 0 1 0#x\n\tf 1 2 3\ng\nl 1 2 3\nf 3 2 1";
    let found = read("a.obj", found).unwrap();
    assert_eq!((found.positions[0], found.triangles), (Vec3::ZERO, vec![[0, 1, 2], [2, 1, 0]]));
    let spare = read("a.obj", format!("v 9 9 9\n{TETRAHEDRON}f 4 3 2\nf 5 5 1")).unwrap();
    assert_eq!(
        (spare.positions.len(), spare.triangles),
        (5, vec![[3, 2, 1], [4, 4, 0]]),
        "the file's numbers"
    );
}

#[test]
fn faces_without_area_by_their_corners_are_left_out_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = file(&folder, "a.obj", format!("{TETRAHEDRON}f 1 2\nf 1 2 3\nf 4\nf\nf 2 3 4\nf 1 x"));
    let read = load_mesh(&path).unwrap();
    assert_eq!((read.mesh.triangles.len(), read.skipped), (2, 4));
    let loaded = load_full(&path.to_str().unwrap().parse().unwrap()).unwrap();
    assert!(loaded.notes[0].ends_with("a.obj: 4 faces of fewer than three corners are left out"));
    assert!(load_full(&"bumps-1k".parse().unwrap()).unwrap().notes.is_empty());
}

#[test]
fn scales_that_single_precision_cannot_reckon_with_are_refused() {
    let refused = |name: &str, says: &str| {
        let error = get(name).unwrap_err().to_string();
        assert!(error.contains(name.split('@').next().unwrap()) && error.contains(says), "{error}");
    };
    refused("bumps-1k@scale=-2147483648", "exponent must be in −200…200");
    refused("bumps-1k@scale=2147483647", "exponent must be in −200…200");
    refused("bumps-1k@scale=127", "extents are not finite");
    refused("bumps-1k@scale=-150", "its coordinates vanish");
    refused("bumps-1k@offset=2e38,0,0", "extents are not finite");
    let folder = tempfile::tempdir().unwrap();
    let wide = file(&folder, "wide.obj", "v -3e38 0 0\nv 3e38 0 0\nv 0 1 0\nf 1 2 3");
    assert!(matches!(get(wide.to_str().unwrap()), Err(SceneError::OutOfScale { .. })));
    for fine in ["bumps-1k@scale=123", "bumps-1k@scale=-120", "unit-empty@scale=-200"] {
        assert!(get(fine).is_ok(), "{fine}");
    }
}

#[test]
fn cameras_are_as_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = file(&folder, "a.obj", format!("{TETRAHEDRON}f 1 2 3"));
    let name = path.to_str().unwrap();
    let view = |suffix: &str| get(&format!("{name}{suffix}")).unwrap().view;
    assert_eq!(view("").up, Vec3::Y, "OBJ has y up");
    assert_eq!(view("@up=z").up, Vec3::Z);
    assert_ne!(view("@up=z").eye, view("").eye, "another frame");
    assert_eq!(view("@fov=20").fov_y_degrees, 20.0);
    assert!(view("@fov=20").eye.length() > 1.5 * view("").eye.length(), "it still fills the picture");
    let stands = view("@eye=3,4,5@target=0,0,1@up=0,0,2@fov=60");
    assert_eq!((stands.eye, stands.target), (Vec3::new(3.0, 4.0, 5.0), Vec3::Z));
    assert_eq!((stands.up, stands.fov_y_degrees), (Vec3::Z * 2.0, 60.0));
    // A camera that stands somewhere is not moved by another `up`.
    assert_eq!(get("sponza@up=z").map(|scene| scene.view.eye).ok(), get("sponza").map(|s| s.view.eye).ok());
    assert_eq!(get("bumps-1k@eye=3,0,0").unwrap().view.eye, Vec3::X * 3.0);
    for (suffix, says) in [
        ("@eye=0,0,0@target=0,0,0", "one point"),
        ("@eye=0,5,0@target=0,0,0", "`up`"),
        ("@eye=1e39,0,0", "finite"),
    ] {
        let error = get(&format!("{name}{suffix}")).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
    let head = "id = 'own'\ndescription = 'mine'\ncharacter = 'own'\n[file]\nname = 'a.obj'\n";
    let own = |text: &str| {
        let path = file(&folder, "own.toml", format!("{head}{text}"));
        get(path.to_str().unwrap()).unwrap().view
    };
    assert_eq!(own(""), view(""));
    assert_eq!(own("[view]\nup = 'z'\nfov = 20"), view("@up=z@fov=20"));
    let standing = own("[view]\neye = [3, 4, 5]\ntarget = [0, 0, 1]");
    assert_eq!((standing.eye, standing.up), (Vec3::new(3.0, 4.0, 5.0), Vec3::Y));
}

/// Where the cameras of the suite's meshes stand, and their bits: figures in old records stay comparable.
#[test]
fn meshes_that_are_here_are_what_they_were() {
    for (id, bits, eye) in [
        ("bunny", "761244586e09", [1.6, 0.9, 4.6]),
        ("dragon", "693ee0bb506e", [-0.12, 0.2, 0.34]),
        ("sponza", "01ab0f32fd6a", [-9.0, 3.0, 0.0]),
    ] {
        match get(id) {
            Ok(scene) => {
                assert_eq!(checksum(&scene.geometry)[..12], *bits, "{id}");
                assert_eq!((scene.view.eye, scene.view.up), (Vec3::from_array(eye), Vec3::Y), "{id}");
            }
            Err(error) => assert!(error.is_unavailable(), "{error}"),
        }
    }
}

#[test]
fn bad_files_are_explained() {
    let v = TETRAHEDRON;
    for (name, text, says) in [
        ("a.obj", format!("{v}v 1 nan 0\nf 1 2 3"), "line 5: vertex 5 has the coordinate nan"),
        ("a.obj", format!("{v}v 1 0 -inf\nf 1 2 3"), "line 5: vertex 5 has the coordinate -inf"),
        ("a.obj", format!("{v}v 1e60 0 0\nf 1 2 3"), "line 5: vertex 5 has the coordinate 1e60"),
        ("a.obj", "v 1 2\n".into(), "line 1: vertex 1 has less than three"),
        ("a.obj", "v 1 2 x\n".into(), "line 1: vertex 1 has `x`"),
        ("a.obj", format!("{v}f 1 2 3\nf 1 2 9"), "line 6: the face names vertex 9, but there are 4"),
        ("a.obj", format!("{v}f 1 2 0"), "line 5: the face names vertex 0"),
        ("a.obj", format!("{v}f 1 2 -5"), "line 5: the face names vertex -5"),
        ("a.obj", format!("{v}f 1 2 99999999999999999"), "line 5: the face names vertex 99999999999999999"),
        ("a.obj", format!("{v}f 1 2"), "no faces in 5 lines but 1 of fewer than three corners"),
        ("a.obj", format!("{v}f 1 2 x"), "line 5: a face has `x`"),
        ("a.obj", v.into(), "no faces in 4 lines"),
        ("a.obj", String::new(), "nor vertices"),
        ("a.obj", "v 1 2 3\0".into(), "line 1: a zero byte"),
        ("a.ply", "hello".into(), "line 1: a PLY file begins"),
        (
            "a.ply",
            "ply\nformat binary_little_endian 1.0\n".into(),
            "line 2: the format is `binary_little_endian`",
        ),
        ("a.ply", "ply\nformat ascii 1.0\n".into(), "no `end_header`"),
        ("a.ply", ply("0 0 0\n1 0 0\n0 1 nan\n3 0 1 2\n"), "line 12: vertex 3 has the coordinate nan"),
        ("a.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), "line 13: the face names vertex 3, but there are 3"),
        ("a.ply", ply("0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n"), "line 13: the face announces 4 corners and has 3"),
        ("a.ply", ply("0 0 0\n1 0 0\n"), "after 2 of 3 `vertex` lines"),
    ] {
        let error = read(name, &text).unwrap_err().to_string();
        assert!(error.contains(says), "{text:?} gave {error:?}, wanted {says:?}");
    }
}

fn ply(body: &str) -> String {
    let header = ["ply", "format ascii 1.0", "element vertex 3", "property float x", "property float y"];
    let rest = ["property float z", "element face 1", "property list uchar int vertex_indices", "end_header"];
    format!("{}\n{}\n{body}", header.join("\n"), rest.join("\n"))
}

#[test]
fn ply_is_read() {
    let mesh = read("a.PLY", ply("0 0 0\n1 0 0\n\n0 1 0\n3 0 1 2\n")).unwrap();
    assert_eq!((mesh.positions[2], &mesh.triangles[..]), (Vec3::Y, &[[0, 1, 2]][..]));
}

#[test]
fn garbage_is_answered_soon() {
    let mut random = Random::new(1);
    // Bytes without zeros run to the end; a file without line ends stops at the first megabyte.
    let noise: Vec<u8> = (0..4 << 20).map(|_| (random.bits() % 255) as u8 + 1).collect();
    assert!(matches!(read("a.obj", &noise), Err(SceneError::NoFaces { .. } | SceneError::Syntax { .. })));
    assert!(matches!(read("a.obj", vec![b'x'; 4 << 20]), Err(SceneError::Syntax { line: 1, .. })));
    assert!(matches!(read("a.ply", &noise), Err(SceneError::Syntax { line: 1, .. })));
}

#[test]
fn missing_and_unreadable_files_are_named() {
    let error = get("/nonexistent/mesh.obj").unwrap_err();
    assert!(error.to_string().contains("/nonexistent/mesh.obj"), "{error}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("folder.obj");
    fs::create_dir(&path).unwrap();
    assert!(matches!(get(path.to_str().unwrap()), Err(SceneError::Io { .. })));
    let stl = file(&folder, "a.stl", "solid");
    assert!(matches!(get(stl.to_str().unwrap()), Err(SceneError::Definition { .. })));
}

#[test]
fn own_definitions() {
    let folder = tempfile::tempdir().unwrap();
    file(&folder, "mesh.obj", format!("{TETRAHEDRON}f 1 2 3 4"));
    let head = |id: &str| format!("id = '{id}'\ndescription = 'mine'\ncharacter = 'own'\n");
    let own =
        file(&folder, "own.toml", head("own") + "[file]\nname = 'mesh.obj'\n[transform]\noffset = [0, 0, 1]");
    let scene = get(own.to_str().unwrap()).unwrap();
    assert_eq!((scene.id.as_str(), mesh(&scene).positions[0]), ("own", Vec3::Z));
    let twice = file(&folder, "twice.toml", head("twice") + "base = 'own.toml@scale=1'");
    assert_eq!(mesh(&get(twice.to_str().unwrap()).unwrap()).positions[0], Vec3::Z * 2.0);
    let circle = file(&folder, "circle.toml", head("circle") + "base = 'circle.toml'");
    assert!(matches!(get(circle.to_str().unwrap()), Err(SceneError::Definition { .. })));
    let wrong = head("wrong") + "[file]\nname = 'mesh.obj'\nsha256 = 'abc'";
    let wrong = file(&folder, "wrong.toml", wrong);
    assert!(get(wrong.to_str().unwrap()).unwrap_err().is_unavailable());
}

/// tobj numbers vertices anew, so corners are compared by position.
#[test]
fn obj_reader_agrees_with_tobj() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = String::from("o first\nmtllib none.mtl\n");
    let mut random = Random::new(5);
    for i in 1..=200 {
        text += &format!(
            "v {} {} {}\nvn 0 0 1\nvt 0 1\n",
            random.unit(),
            random.range(-5.0, 5.0),
            random.unit() * 1e-7
        );
        if i > 10 {
            let corners = 3 + random.below(4);
            let words: Vec<String> = (0..corners)
                .map(|k| match random.below(3) {
                    0 => format!("{}/1/1", 1 + random.below(i)),
                    1 => format!("-{}//1", 1 + random.below(i)),
                    _ => format!("{}", 1 + (k * 7 + i) % i),
                })
                .collect();
            text += &format!("f {}\n", words.join(" "));
        }
        if i % 50 == 0 {
            text += &format!("g part{i}\n");
        }
    }
    let path = file(&folder, "a.obj", text);
    let ours = load_mesh(&path).unwrap().mesh;
    assert_eq!(corners(&ours), tobj_corners(&path));
}

fn corners(mesh: &Mesh) -> Vec<[[f32; 3]; 3]> {
    mesh.triangles.iter().map(|t| t.map(|i| mesh.positions[i as usize].to_array())).collect()
}

fn tobj_corners(path: &Path) -> Vec<[[f32; 3]; 3]> {
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_lines: true,
        ignore_points: true,
        ..Default::default()
    };
    let (models, _) = tobj::load_obj(path, &options).unwrap();
    let triangle = |m: &tobj::Mesh, t: &[u32]| {
        [0, 1, 2].map(|k| [0, 1, 2].map(|axis| m.positions[3 * t[k] as usize + axis]))
    };
    models
        .iter()
        .flat_map(|m| m.mesh.indices.chunks(3).map(|t| triangle(&m.mesh, t)).collect::<Vec<_>>())
        .collect()
}

#[test]
fn real_meshes_agree_with_tobj() {
    for id in ["sponza", "bunny"] {
        match get(id) {
            Ok(scene) => {
                let path = reader::find(&format!("{id}.obj")).unwrap();
                assert_eq!(corners(mesh(&scene)), tobj_corners(&path), "{id}");
            }
            Err(error) => {
                assert!(error.is_unavailable() && error.hint().is_some(), "{error}");
                eprintln!("skipped: {error}");
            }
        }
    }
}

proptest::proptest! {
    #[test]
    fn no_bytes_make_the_readers_panic(bytes: Vec<u8>, head in "(v [0-9.e-]{1,5} 1 2\n|f [0-9/-]{1,5} 1 1\n|ply\n|element (vertex|face) [0-9]{1,20}\n|property (list a b )?x\n|end_header\n|[0-9 ]{0,9}\n){0,12}") {
        let text = [head.as_bytes(), &bytes].concat();
        let _ = read("a.obj", &text);
        let _ = read("a.ply", [b"ply\n", &text[..]].concat());
    }

    #[test]
    fn no_name_makes_the_catalogue_panic(name in "[a-z0-9@=.,-]{0,20}") {
        if let Ok(SceneSpec { source: Source::Id(id), .. }) = name.parse() {
            let _ = describe(&id);
        }
    }
}
