//! Marching through tetrahedra: what is inside is told by crossings, and so are the places where edges leave it.

use super::{Tessellation, round};
use accel::{Aabb, Ray, Solid, Vec3};
use glam::DVec3;
use solids::{Crossing, Crossings};
use std::collections::HashMap;

/// The six tetrahedra of a cube, along one of its diagonals: bits of a corner are its steps along x, y and z (A. Doi, A. Koide
/// 1991, "An Efficient Method of Triangulating Equi-Valued Surfaces by Using Tetrahedral Cells", IEICE Transactions E74(1)).
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 1, 5, 7], [0, 2, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 4, 6, 7]];

/// A grid of nodes over a solid, a little wider than its box, so that its faces lie in no plane of nodes.
struct Nodes {
    min: DVec3,
    step: f64,
    cells: [usize; 3],
    inside: Vec<bool>,
}

/// The part of a cell by which the grid begins before the box.
const ASIDE: f64 = 0.381_966;

impl Nodes {
    fn over(solid: &Solid, cells: u32) -> Self {
        let Aabb { min, max } = solid.bounds();
        let (min, max) = (min.as_dvec3(), max.as_dvec3());
        let step = ((max - min).max_element() / f64::from(cells)).max(f64::MIN_POSITIVE);
        let cells = ((max - min) / step).ceil().to_array().map(|n| n as usize + 1);
        let mut nodes = Self { min: min - ASIDE * step, step, cells, inside: Vec::new() };
        nodes.inside = vec![false; nodes.cells.iter().map(|n| n + 1).product()];
        for y in 0..=nodes.cells[1] {
            for x in 0..=nodes.cells[0] {
                nodes.column(solid, x, y);
            }
        }
        nodes
    }

    /// Every crossing of a column of nodes, and between which of them the solid is.
    fn column(&mut self, solid: &Solid, x: usize, y: usize) {
        let foot = self.place([x, y, 0]);
        let mut crossings = Vec::new();
        solid.crossings(&Ray { t_min: f32::MIN, ..Ray::new(foot, Vec3::Z) }, &mut crossings);
        let (mut depth, mut next) = (0, 0);
        for z in 0..=self.cells[2] {
            let height = f64::from(self.place([x, y, z]).z) - f64::from(foot.z);
            while let Some(crossing) = crossings.get(next).filter(|crossing| crossing.t <= height) {
                depth += if crossing.enters { 1 } else { -1 };
                next += 1;
            }
            let index = self.index([x, y, z]);
            self.inside[index] = depth > 0;
        }
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * (self.cells[1] + 1) + y) * (self.cells[0] + 1) + x
    }

    fn place(&self, at: [usize; 3]) -> Vec3 {
        round(self.min + DVec3::from_array(at.map(|i| i as f64)) * self.step)
    }
}

/// A corner of the surface for each edge that leaves the solid.
struct Corners<'a> {
    solid: &'a Solid,
    known: HashMap<(usize, usize), u32>,
    points: Vec<Vec3>,
    crossings: Vec<Crossing>,
}

impl Corners<'_> {
    fn between(&mut self, (a, from): (usize, Vec3), (b, to): (usize, Vec3)) -> u32 {
        let (key, from, to) = if a < b { ((a, b), from, to) } else { ((b, a), to, from) };
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let way = to - from;
        self.crossings.clear();
        self.solid.crossings(&Ray { t_max: 1.0, ..Ray::new(from, way) }, &mut self.crossings);
        // An end that lies on the surface may be on either side of it.
        let t = self.crossings.first().map_or(0.5, |crossing| crossing.t);
        self.points.push(round(from.as_dvec3() + way.as_dvec3() * t));
        let number = (self.points.len() - 1) as u32;
        self.known.insert(key, number);
        number
    }
}

/// Appends the surface of a closed solid, its longest side in so many cells.
pub fn solid(all: &mut Tessellation, owner: u32, solid: &Solid, cells: u32) {
    let nodes = Nodes::over(solid, cells);
    let mut corners = Corners { solid, known: HashMap::new(), points: Vec::new(), crossings: Vec::new() };
    let mut triangles = Vec::new();
    for z in 0..nodes.cells[2] {
        for y in 0..nodes.cells[1] {
            for x in 0..nodes.cells[0] {
                let places: [[usize; 3]; 8] =
                    std::array::from_fn(|i| [x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)]);
                let inside = places.map(|at| nodes.inside[nodes.index(at)]);
                if inside == [false; 8] || inside == [true; 8] {
                    continue;
                }
                let cube = places.map(|at| (nodes.index(at), nodes.place(at)));
                for tetrahedron in TETRAHEDRA {
                    cut(&mut corners, &mut triangles, tetrahedron.map(|i| (cube[i], inside[i])));
                }
            }
        }
    }
    all.append(owner, &corners.points, triangles);
}

/// The surface within a tetrahedron: a triangle where one corner is on a side of its own, else two.
fn cut(corners: &mut Corners, triangles: &mut Vec<[u32; 3]>, tetrahedron: [((usize, Vec3), bool); 4]) {
    let side =
        |wanted: bool| tetrahedron.iter().filter(move |(_, inside)| *inside == wanted).map(|(node, _)| *node);
    let (inner, outer): (Vec<_>, Vec<_>) = (side(true).collect(), side(false).collect());
    let middle =
        |nodes: &[(usize, Vec3)]| nodes.iter().map(|(_, p)| p.as_dvec3()).sum::<DVec3>() / nodes.len() as f64;
    if inner.is_empty() || outer.is_empty() {
        return;
    }
    let outward = middle(&outer) - middle(&inner);
    let mut push = |corners: &Corners, [a, b, c]: [u32; 3]| {
        let [p, q, r] = [a, b, c].map(|i| corners.points[i as usize].as_dvec3());
        triangles.push(if (q - p).cross(r - p).dot(outward) < 0.0 { [a, c, b] } else { [a, b, c] });
    };
    match (&inner[..], &outer[..]) {
        ([one], [a, b, c]) | ([a, b, c], [one]) => {
            let found = [a, b, c].map(|other| corners.between(*one, *other));
            push(corners, found);
        }
        ([a, b], [c, d]) => {
            let [ac, bc, bd, ad] = [(a, c), (b, c), (b, d), (a, d)].map(|(p, q)| corners.between(*p, *q));
            push(corners, [ac, bc, bd]);
            push(corners, [ac, bd, ad]);
        }
        _ => {}
    }
}
