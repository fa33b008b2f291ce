use super::*;
use crate::Mesh;
use proptest::prelude::*;

/// The boundary of a set of unit cubes, outwards: closed, with edges of two and of four triangles.
fn boundary(cubes: &[[i32; 3]]) -> Mesh {
    let mut mesh = Mesh::default();
    for cube in cubes {
        for axis in 0..3 {
            for (step, high) in [(-1, false), (1, true)] {
                let mut next = *cube;
                next[axis] += step;
                if !cubes.contains(&next) {
                    face(&mut mesh, *cube, axis, high);
                }
            }
        }
    }
    mesh
}

fn face(mesh: &mut Mesh, cube: [i32; 3], axis: usize, high: bool) {
    let corner = |u: i32, v: i32| {
        let mut at = cube;
        at[axis] += i32::from(high);
        at[(axis + 1) % 3] += u;
        at[(axis + 2) % 3] += v;
        Vec3::from(at.map(|c| c as f32))
    };
    let first = mesh.positions.len() as u32;
    mesh.positions.extend([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
    let [a, b, c, d] = [first, first + 1, first + 2, first + 3];
    mesh.triangles.extend(if high { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
}

/// Where a point is by the cubes that its surroundings lie in.
fn expected(cubes: &[[i32; 3]], point: Vec3) -> Location {
    let around = |c: f32| {
        let low = c.ceil() as i32 - 1;
        low..=c.floor() as i32
    };
    let [xs, ys, zs] = point.to_array().map(around);
    let (mut inside, mut outside) = (false, false);
    for x in xs {
        for y in ys.clone() {
            for z in zs.clone() {
                let held = cubes.contains(&[x, y, z]);
                inside |= held;
                outside |= !held;
            }
        }
    }
    match (inside, outside) {
        (true, true) => Location::Surface,
        (true, false) => Location::Inside,
        _ => Location::Outside,
    }
}

fn cubes() -> impl Strategy<Value = Vec<[i32; 3]>> {
    prop::collection::btree_set([0..3, 0..3, 0..3], 1..14).prop_map(|set| set.into_iter().collect())
}

fn small() -> impl Strategy<Value = Vec3> {
    [-2..9, -2..9, -2..9].prop_map(|c: [i32; 3]| Vec3::from(c.map(|c| c as f32 * 0.5)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// Half of the points lie on planes of faces, and their rays along edges and through corners.
    #[test]
    fn points_are_where_the_cubes_say(cubes in cubes(), points in prop::collection::vec(small(), 40)) {
        let mesh = boundary(&cubes);
        for point in points {
            let found = locate((&mesh).into(), 0..mesh.triangles.len() as u32, point);
            prop_assert_eq!(found, expected(&cubes, point), "{} of {:?}", point, cubes);
        }
    }

    #[test]
    fn every_line_enters_as_often_as_it_leaves(cubes in cubes(), origin in small(), to in small()) {
        prop_assume!(origin != to);
        let mesh = boundary(&cubes);
        let ray = Ray::new(origin, to - origin);
        let sides = (0..mesh.triangles.len()).filter_map(|i| crossed(&ray, &mesh.corners(i)));
        let (mut entering, mut leaving) = (0, 0);
        sides.for_each(|side| *(if side == Side::Entering { &mut entering } else { &mut leaving }) += 1);
        prop_assert_eq!(entering, leaving);
    }

    /// Where no edge is met, what is crossed is what a closed triangle is hit by.
    #[test]
    fn sides_are_those_of_the_normal(o in [-1f32..1.0, -1.0..1.0, -1.0..1.0], to in [-1f32..1.0, -1.0..1.0, -1.0..1.0]) {
        let corners = [Vec3::new(-2.0, -2.0, 0.0), Vec3::new(3.0, 0.0, 0.0), Vec3::new(0.0, 4.0, 0.0)];
        let (origin, to) = (Vec3::from(o), Vec3::from(to));
        prop_assume!(origin.z != to.z);
        let ray = Ray::new(origin, to - origin);
        let t = -origin.as_dvec3().z / ray.direction.as_dvec3().z;
        let at = origin.as_dvec3() + ray.direction.as_dvec3() * t;
        prop_assume!(at.truncate().length() < 0.9);
        let side = if ray.direction.z < 0.0 { Side::Entering } else { Side::Leaving };
        prop_assert_eq!(crossed(&ray, &corners), Some(side));
    }
}

#[test]
fn far_points_are_outside_and_near_ones_inside() {
    let mesh = boundary(&[[0, 0, 0]]);
    let at = |x: f32, y: f32, z: f32| locate((&mesh).into(), 0..12, Vec3::new(x, y, z));
    assert_eq!(at(-1e30, 0.5, 0.5), Location::Outside);
    assert_eq!(at(1e30, 1e30, 0.5), Location::Outside);
    assert_eq!(at(1e-45, 1e-45, 1e-45), Location::Inside);
    assert_eq!(at(-1e-45, 1e-45, 1e-45), Location::Outside);
    assert_eq!(at(1f32.next_down(), 0.5, 0.5), Location::Inside);
    assert_eq!(at(1.0, 0.5, 0.5), Location::Surface);
}
