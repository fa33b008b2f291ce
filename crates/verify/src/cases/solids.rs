//! Solids of each kind.

use super::point;
use crate::Numbers;
use accel::solid::{
    Combination, Cone, Csg, Disc, Expression, Facets, Group, Implicit, Patch, Quadric, Sphere, Torus,
};
use accel::{Aabb, Geometry, Mesh, Scene, Solid, Vec3, View};
use std::sync::Arc;

/// All kinds.
pub const KINDS: [&str; 13] = [
    "triangle", "box", "sphere", "cone", "cylinder", "disc", "quadric", "torus", "implicit", "patch",
    "facets", "csg", "group",
];

/// A scene of so many valid solids of these kinds in turn, in the cube from −1 to 1.
pub fn solids(numbers: &mut impl Numbers, kinds: &[&str], count: u32) -> Scene {
    let mut all = Vec::with_capacity(count as usize);
    while all.len() < count as usize {
        let kind = kinds[all.len() % kinds.len()];
        let size = f64::from(0.08 + 0.07 * numbers.unit());
        let solid = solid(numbers, kind).moved(size, point(numbers).as_dvec3());
        all.extend(solid.validate().is_ok().then_some(solid));
    }
    let view = View { eye: Vec3::Z * 4.0, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };
    Scene { id: "kinds".into(), geometry: Geometry::Solids(all), view }
}

/// A solid of a kind, about as large as the cube from −1 to 1.
///
/// # Panics
/// If there is no such kind.
fn solid(numbers: &mut impl Numbers, kind: &str) -> Solid {
    let (p, q) = (point(numbers), point(numbers));
    let [a, b] = [0.6 + 0.4 * numbers.unit(), 0.6 + 0.4 * numbers.unit()];
    let bounds = Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE };
    match kind {
        "triangle" => Solid::Triangle([p, q, point(numbers)]),
        "box" => Solid::Box(Aabb::of_points([p, q])),
        "sphere" => Solid::Sphere(Sphere { center: Vec3::ZERO, radius: a }),
        "cone" => Solid::Cone(Cone {
            base: p,
            base_radius: a,
            top: q,
            top_radius: if a < b { 0.0 } else { 0.5 * b },
        }),
        "cylinder" => Solid::Cone(Cone { base: p, base_radius: 0.5 * a, top: q, top_radius: 0.5 * a }),
        "disc" => Solid::Disc(Disc { center: Vec3::ZERO, normal: p, radius: a }),
        "quadric" => {
            let (p, q) = (p + Vec3::new(0.7, 0.7, 0.0), q * 0.3);
            let coefficients = [p.x, p.y, p.z, q.x, q.y, q.z, 0.2 * a, 0.0, -0.2 * b, -0.4];
            Solid::Quadric(Quadric { coefficients, bounds })
        }
        "torus" => Solid::Torus(Torus { center: Vec3::ZERO, axis: p, major: a, minor: 0.05 + 0.5 * a * b }),
        "implicit" => {
            let text = numbers.one_of(&FUNCTIONS);
            let function = Arc::new(Expression::parse(text).expect("a function"));
            Solid::Implicit(Implicit::new(function, bounds))
        }
        "patch" => {
            let at = |i: usize| i as f32 * 2.0 / 3.0 - 1.0;
            let mut corner = |i, j| Vec3::new(at(i), at(j), 0.0) + point(numbers) * 0.7;
            Solid::Patch(Patch::new(std::array::from_fn(|j| std::array::from_fn(|i| corner(i, j)))))
        }
        "facets" => Solid::Facets(Facets::new(Arc::new(bipyramid(numbers)))),
        "csg" => {
            let how = [Combination::Union, Combination::Intersection, Combination::Difference];
            let body = Solid::Box(Aabb { min: Vec3::splat(-0.6), max: Vec3::splat(0.6) });
            let ball = Solid::Sphere(Sphere { center: p * 0.6, radius: a });
            let bore = Solid::Cone(Cone { base: -q, base_radius: 0.3 * b, top: q, top_radius: 0.3 * b });
            let first = Csg::new(numbers.one_of(&how), body, ball);
            Solid::Csg(Csg::new(numbers.one_of(&how), Solid::Csg(first), bore))
        }
        "group" => {
            let mut part = |kind| solid(numbers, kind).moved(0.5, (p * 0.4).as_dvec3());
            let inner = Group::new(vec![part("triangle"), part("patch"), part("torus")]);
            Solid::Group(Group::new(vec![part("csg"), Solid::Group(inner), part("sphere")]))
        }
        _ => panic!("no kind `{kind}`"),
    }
}

/// With several roots on a line.
const FUNCTIONS: [&str; 3] = [
    "x^2 + y^2 + z^2 + 0.3*x*y - 0.7",
    "(x^2 + y^2 + z^2 + 0.3)^2 - 1.6*(x^2 + y^2)",
    "sin(4*x)*cos(4*y) + sin(4*y)*cos(4*z) + sin(4*z)*cos(4*x)",
];

/// A closed mesh of rough sides.
fn bipyramid(numbers: &mut impl Numbers) -> Mesh {
    let sides = 3 + numbers.below(8);
    let mut mesh = Mesh { positions: vec![Vec3::Z, Vec3::NEG_Z], triangles: Vec::new() };
    for side in 0..sides {
        let turn = std::f32::consts::TAU * side as f32 / sides as f32;
        let out = 0.7 + 0.3 * numbers.unit();
        mesh.positions.push(Vec3::new(turn.cos() * out, turn.sin() * out, 0.3 * numbers.unit()));
        let (here, next) = (2 + side, 2 + (side + 1) % sides);
        mesh.triangles.extend([[0, here, next], [1, next, here]]);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenes::Random;

    #[test]
    fn there_are_valid_solids_of_each_kind() {
        for kind in KINDS {
            let scene = solids(&mut Random::new(5), &[kind], 20);
            assert_eq!(scene.geometry.len(), 20, "{kind}");
            assert!(scene.geometry.bounds().extent().max_element() < 3.0, "{kind}");
        }
    }
}
