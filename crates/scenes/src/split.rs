//! Large objects split into small facets (Skala 1993, §2: objects that span many slices set
//! bits everywhere; the paper's advice is to split them).

use crate::generate::MAX_OBJECTS;
use accel::Mesh;
use std::collections::HashMap;

/// A mesh of facets and where each comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// The facets. Those of one triangle follow one another in the triangle's place.
    pub mesh: Mesh,
    /// For each facet the triangle that it is part of.
    pub original: Vec<u32>,
}

/// Cuts triangles at the middle of their longest edge until no edge is longer than `longest`.
///
/// Neighbours cut a common edge at the same points, so a closed mesh stays closed. An edge
/// too short to have a middle in single precision is left as it is.
///
/// # Errors
/// In words, when more than [`MAX_OBJECTS`] facets would be made.
pub fn split(mesh: &Mesh, longest: f64) -> Result<Split, String> {
    let mut positions = mesh.positions.clone();
    let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
    let mut out = Split { mesh: Mesh { positions: Vec::new(), triangles: Vec::new() }, original: Vec::new() };
    let mut pending = Vec::new();
    for (number, triangle) in mesh.triangles.iter().enumerate() {
        pending.push(*triangle);
        while let Some(t) = pending.pop() {
            if out.original.len() + pending.len() >= MAX_OBJECTS as usize {
                return Err(format!("splitting to edges of {longest} makes more than {MAX_OBJECTS} facets"));
            }
            match cut(t, longest, &mut positions, &mut middles) {
                Some(halves) => pending.extend(halves.into_iter().rev()),
                None => {
                    out.mesh.triangles.push(t);
                    out.original.push(number as u32);
                }
            }
        }
    }
    out.mesh.positions = positions;
    Ok(out)
}

fn cut(
    t: [u32; 3],
    longest: f64,
    positions: &mut Vec<accel::Vec3>,
    middles: &mut HashMap<(u32, u32), u32>,
) -> Option<[[u32; 3]; 2]> {
    let at = |i: u32| positions[i as usize].as_dvec3();
    // Ties are broken by the corners' numbers, which neighbours share.
    let key = |k: usize| {
        let (a, b) = (t[k], t[(k + 1) % 3]);
        (at(a).distance_squared(at(b)), a.min(b), a.max(b))
    };
    let k = (0..3).max_by(|&i, &j| key(i).partial_cmp(&key(j)).unwrap_or(std::cmp::Ordering::Equal))?;
    let (square, low, high) = key(k);
    if square <= longest * longest {
        return None;
    }
    let middle = ((at(low) + at(high)) * 0.5).as_vec3();
    if middle == positions[low as usize] || middle == positions[high as usize] {
        return None;
    }
    let m = *middles.entry((low, high)).or_insert_with(|| {
        positions.push(middle);
        positions.len() as u32 - 1
    });
    let (a, b, c) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
    Some([[a, m, c], [m, b, c]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::Generator;
    use accel::Geometry;

    fn area(mesh: &Mesh, t: [u32; 3]) -> f64 {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize].as_dvec3());
        0.5 * (b - a).cross(c - a).length()
    }

    #[test]
    fn facets_are_short_and_fill_their_triangle() {
        let Ok(Geometry::Triangles(mesh)) = (Generator::Triangles { objects: 50, edge: 2.0 }).build(1) else {
            panic!("triangles")
        };
        let split = split(&mesh, 0.1).unwrap();
        assert!(split.original.is_sorted() && split.mesh.triangles.len() > 500);
        let mut areas = [0.0; 50];
        for (t, &o) in split.mesh.triangles.iter().zip(&split.original) {
            let [a, b, c] = t.map(|i| split.mesh.positions[i as usize].as_dvec3());
            assert!(a.distance(b).max(b.distance(c)).max(c.distance(a)) <= 0.1);
            areas[o as usize] += area(&split.mesh, *t);
        }
        for (sum, t) in areas.iter().zip(&mesh.triangles) {
            assert!((sum / area(&mesh, *t) - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn closed_meshes_stay_closed() {
        let Ok(Geometry::Triangles(mesh)) = (Generator::Bumps { objects: 200, height: 0.1 }).build(1) else {
            panic!("triangles")
        };
        let split = split(&mesh, 0.2).unwrap();
        assert!(crate::solid::is_watertight(&split.mesh));
    }

    #[test]
    fn hopeless_lengths_are_refused() {
        let positions =
            [[0.0, 0.0, 0.0], [1e6, 0.0, 0.0], [0.0, 1e6, 0.0]].map(accel::Vec3::from_array).to_vec();
        let mesh = Mesh { positions, triangles: vec![[0, 1, 2]] };
        assert!(split(&mesh, 1e4).unwrap().original.len() > 1000);
    }
}
