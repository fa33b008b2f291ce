use super::*;
use accel::Vec3;
use accel::solid::Net;
use proptest::prelude::*;

fn crossings(patch: &Patch, ray: &Ray) -> Vec<Crossing> {
    let mut out = Vec::new();
    patch.crossings(ray, &mut out);
    out
}

/// A net over the unit square with these heights.
fn sheet(height: impl Fn(usize, usize) -> f32) -> Patch {
    let at = |i: usize| i as f32 / 3.0;
    Patch::new(std::array::from_fn(|j| std::array::from_fn(|i| Vec3::new(at(i), at(j), height(i, j)))))
}

#[test]
fn a_plane_is_hit_where_it_lies() {
    let plane = sheet(|_, _| 0.5);
    let ray = Ray::new(Vec3::new(0.25, 0.75, 2.0), Vec3::new(0.0, 0.0, -0.5));
    let found = crossings(&plane, &ray);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!((found[0].t - 3.0).abs() < 1e-12 && found[0].enters);
    assert!((found[0].u - 0.25).abs() < 1e-6 && (found[0].v - 0.75).abs() < 1e-6);
    let beside = Ray { origin: Vec3::new(1.01, 0.5, 2.0), ..ray };
    assert_eq!(crossings(&plane, &beside), []);
    for edge_on in [Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)] {
        assert_eq!(crossings(&plane, &Ray::new(Vec3::new(0.1, 0.1, 0.5), edge_on)), []);
    }
}

#[test]
fn borders_corners_and_points_are_hit() {
    let plane = sheet(|_, _| 0.0);
    for (x, y) in [(0.0, 0.0), (1.0, 1.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5), (0.25, 0.5)] {
        assert_eq!(crossings(&plane, &Ray::new(Vec3::new(x, y, 1.0), Vec3::NEG_Z)).len(), 1, "{x} {y}");
    }
    // A quarter of a disc, drawn together to its middle.
    let (r, k) = (3.0f32, 0.56f32);
    let quarter = |s: f32| [(s, 0.0), (s, s * k), (s * k, s), (0.0, s)].map(|(x, y)| Vec3::new(x, y, 1.0));
    let disc = Patch::new([quarter(0.0), quarter(r / 3.0), quarter(r * 2.0 / 3.0), quarter(r)]);
    assert_eq!(crossings(&disc, &Ray::new(Vec3::ZERO, Vec3::Z)).len(), 1);
    assert_eq!(crossings(&disc, &Ray::new(Vec3::new(1e-9, 1e-9, 0.0), Vec3::Z)).len(), 1);
    assert_eq!(crossings(&disc, &Ray::new(Vec3::new(-1e-3, -1e-3, 0.0), Vec3::Z)).len(), 0);
}

#[test]
fn folds_are_hit_twice() {
    let arch = sheet(|i, _| if i == 1 || i == 2 { 1.0 } else { 0.0 });
    // Its top is at 3/4.
    let along = |z: f32| crossings(&arch, &Ray::new(Vec3::new(-1.0, 0.5, z), Vec3::X)).len();
    assert_eq!((along(0.7), along(0.74999), along(0.751)), (2, 2, 0));
    assert!(along(0.75) <= 2);
}

/// Seen so that it is folded along a slanting line, with three crossings, two of them next to the fold.
#[test]
fn crossings_beside_a_slanting_fold_are_found() {
    let net: [[[f32; 3]; 4]; 4] = [
        [
            [-0.52082264, 0.30363715, 0.24608302],
            [-0.12272751, -0.42569625, 0.61142004],
            [0.44990313, -0.47688568, 0.37420726],
            [-0.09137952, -0.84592247, -0.5568608],
        ],
        [
            [-0.061694026, -0.7229985, -0.43223727],
            [0.8825052, 0.41824985, -0.1471926],
            [0.7294687, -0.5578183, 0.05608952],
            [0.99046004, 0.07261026, 0.118623614],
        ],
        [
            [0.63752353, 0.34227145, -0.10073769],
            [0.15008414, -0.568527, -0.73957944],
            [0.043367743, -0.6741812, -0.8527641],
            [-0.57255316, -0.4953513, -0.0855695],
        ],
        [
            [-0.059532523, -0.87849104, 0.3344704],
            [0.8676045, -0.0007597208, 0.022659302],
            [-0.445091, -0.544515, -0.2585678],
            [-0.033616304, -0.6077281, -0.010058999],
        ],
    ];
    let patch = Patch::new(net.map(|row| row.map(Vec3::from)));
    let ray =
        Ray::new(Vec3::new(0.70150316, -1.0401621, -2.1596968), Vec3::new(-0.65050584, 0.59045, 1.9893811));
    let found: Vec<f64> = crossings(&patch, &ray).iter().map(|crossing| crossing.t).collect();
    let known = [1.000_040_791_56, 1.000_055_910_24, 1.027_606_654_78];
    assert_eq!(found.len(), known.len(), "{found:?}");
    assert!(found.iter().zip(known).all(|(t, known)| (t - known).abs() < 1e-7), "{found:?}");
}

fn net() -> impl Strategy<Value = Net> {
    prop::array::uniform4(prop::array::uniform4([-1f32..1.0, -1.0..1.0, -1.0..1.0]))
        .prop_map(|net| net.map(|row| row.map(Vec3::from)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// Against fine triangles: where the line passes well inside of one, there is a crossing at the patch's own point.
    #[test]
    fn nothing_is_missed(net in net(), from in [-3f32..3.0, -3.0..3.0, -3.0..3.0], to in [-0.5f32..0.5, -0.5..0.5, -0.5..0.5]) {
        let patch = Patch::new(net);
        let (origin, to) = (Vec3::from(from), Vec3::from(to));
        prop_assume!(origin.distance(to) > 0.1);
        let ray = Ray { t_min: -1e6, ..Ray::new(origin, to - origin) };
        let found = crossings(&patch, &ray);
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        for hit in &found {
            // As reported, u and v are rounded.
            let on = patch.at(f64::from(hit.u), f64::from(hit.v));
            prop_assert!(on.distance(o + d * hit.t) < 1e-5);
        }
        let n = 160;
        let at = |i: i32, j: i32| patch.at(f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
        for j in 0..n {
            for i in 0..n {
                let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                for [a, b, c] in [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]] {
                    let normal = (b - a).cross(c - a);
                    let steep = normal.dot(d) / (normal.length() * d.length());
                    let Some(t) = met([a, b, c], o, d) else { continue };
                    if steep.abs() < 0.2 || i == 0 || j == 0 || i == n - 1 || j == n - 1 {
                        continue;
                    }
                    let size = a.distance(b).max(a.distance(c)) / d.length();
                    prop_assert!(found.iter().any(|hit| (hit.t - t).abs() < 2.0 * size), "{:?} at {}: {:?}", ray, t, found);
                }
            }
        }
    }
}

/// Where a line meets a triangle.
fn met([a, b, c]: [DVec3; 3], o: DVec3, d: DVec3) -> Option<f64> {
    let (e1, e2) = (b - a, c - a);
    let p = d.cross(e2);
    let det = e1.dot(p);
    let (u, q) = ((o - a).dot(p) / det, (o - a).cross(e1));
    let v = d.dot(q) / det;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| e2.dot(q) / det)
}
