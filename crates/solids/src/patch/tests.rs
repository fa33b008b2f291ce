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
