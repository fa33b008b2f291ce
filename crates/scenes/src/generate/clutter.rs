//! Things of very different sizes on a floor: from two triangles that span the scene to slivers
//! a hundred-thousandth as long.

use crate::random::Random;
use crate::rotation::about;
use crate::solid::round;
use accel::Mesh;
use glam::DVec3;
use std::f64::consts::TAU;

/// The largest thing is this many times as large as the smallest.
pub const SPREAD: f64 = 1000.0;
/// Triangles of the least thing, a wedge.
const WEDGE: usize = 8;
/// The fewest triangles: a floor with one wedge.
pub const MIN: u32 = WEDGE as u32 + 2;

/// Boxes, prisms and tubes on a floor of two triangles, which is 2 wide: `count` triangles in all, or
/// up to seven fewer. Their sizes are log-uniform over three decades; into how many pieces their sides
/// are cut, and how evenly, does not depend on their size. The floor is about half covered.
pub fn clutter(count: u32, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let mut out = Surfaces { mesh: Mesh { positions: Vec::new(), triangles: Vec::new() } };
    let corner = |i: usize, j: usize| DVec3::new(2.0 * i as f64 - 1.0, 2.0 * j as f64 - 1.0, 0.0);
    out.patch([1, 1], corner);
    let largest = (60.0 / f64::from(count).sqrt()).min(0.8);
    loop {
        let left = (count as usize).saturating_sub(out.mesh.triangles.len());
        if left < WEDGE {
            return out.mesh;
        }
        let size = largest * libm::pow(SPREAD, -random.unit());
        let thing = Thing::draw(&mut random);
        // What would be too many is a wedge instead: it always fits.
        let thing = if thing.triangles() > left { Thing::Prism { sides: 3, rings: 1 } } else { thing };
        thing.put(&mut out, &mut random, size);
    }
}

/// A kind of thing and into how many pieces it is cut.
enum Thing {
    /// A box whose edges are cut into so many pieces along each axis.
    Block([usize; 3]),
    /// A prism over a convex polygon, upright.
    Prism { sides: usize, rings: usize },
    /// A pipe with walls, standing or lying.
    Tube { sides: usize, rings: usize },
}

impl Thing {
    fn draw(random: &mut Random) -> Self {
        let kind = random.below(3);
        // Few pieces are as likely as many: log-uniform.
        let mut pieces = |least: f64, most: f64| (least * libm::pow(most / least, random.unit())) as usize;
        match kind {
            0 => Self::Block([pieces(1.0, 12.0), pieces(1.0, 4.0), pieces(1.0, 4.0)]),
            1 => Self::Prism { sides: pieces(3.0, 12.0), rings: pieces(1.0, 6.0) },
            _ => Self::Tube { sides: pieces(5.0, 40.0), rings: pieces(1.0, 8.0) },
        }
    }

    fn triangles(&self) -> usize {
        match *self {
            Self::Block([a, b, c]) => 4 * (a * b + b * c + c * a),
            Self::Prism { sides, rings } => 2 * sides * rings + 2 * (sides - 2),
            Self::Tube { sides, rings } => 4 * sides * rings + 4 * sides,
        }
    }

    /// Puts the thing on the floor, `size` across.
    fn put(&self, out: &mut Surfaces, random: &mut Random, size: f64) {
        let turn = about(DVec3::Z, random.range(0.0, TAU));
        let room = 1.0 - size;
        let place = DVec3::new(random.range(-room, room), random.range(-room, room), 0.0);
        let to_world = |p: DVec3| place + turn * (p * size);
        match *self {
            Self::Block(pieces) => block(out, random, pieces, to_world),
            Self::Prism { sides, rings } => prism(out, random, [sides, rings], to_world),
            Self::Tube { sides, rings } => tube(out, random, [sides, rings], to_world),
        }
    }
}

/// A mesh under construction, made of rectangular patches and fans.
struct Surfaces {
    mesh: Mesh,
}

impl Surfaces {
    /// A grid of `rows` × `cols` cells of two triangles each, over the points `at(row, col)`.
    fn patch(&mut self, [rows, cols]: [usize; 2], at: impl Fn(usize, usize) -> DVec3) {
        let first = self.mesh.positions.len();
        let number = |i: usize, j: usize| (first + i * (cols + 1) + j) as u32;
        for i in 0..=rows {
            self.mesh.positions.extend((0..=cols).map(|j| round(at(i, j))));
        }
        for i in 0..rows {
            for j in 0..cols {
                let (a, b, c, d) = (number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1));
                self.mesh.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }

    /// The convex polygon with these corners, fanned from the first.
    fn fan(&mut self, corners: impl Iterator<Item = DVec3>) {
        let first = self.mesh.positions.len() as u32;
        self.mesh.positions.extend(corners.map(round));
        let end = self.mesh.positions.len() as u32;
        self.mesh.triangles.extend((first + 2..end).map(|i| [first, i - 1, i]));
    }
}

/// The ends of `pieces` pieces of [0, 1], at random crowded towards either end or even.
fn cuts(random: &mut Random, pieces: usize) -> Vec<f64> {
    let crowding = libm::exp2(random.range(-1.5, 1.5));
    (0..=pieces).map(|i| libm::pow(i as f64 / pieces as f64, crowding)).collect()
}

/// Angles of a convex polygon's corners, with the first again at the end, at random far from even.
fn angles(random: &mut Random, sides: usize) -> Vec<f64> {
    let uneven = random.range(0.0, 0.4);
    let mut angles: Vec<f64> =
        (0..sides).map(|i| (i as f64 + uneven * random.unit()) * (TAU / sides as f64)).collect();
    angles.push(angles[0]);
    angles
}

fn block(out: &mut Surfaces, random: &mut Random, pieces: [usize; 3], to_world: impl Fn(DVec3) -> DVec3) {
    let extent = DVec3::new(1.0, random.range(0.1, 1.0), random.range(0.1, 1.0));
    let cuts = pieces.map(|n| cuts(random, n));
    for axis in 0..3 {
        let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
        for side in [0.0, 1.0] {
            out.patch([pieces[x], pieces[y]], |i, j| {
                let mut p = DVec3::splat(side);
                (p[x], p[y]) = (cuts[x][i], cuts[y][j]);
                to_world((p - DVec3::new(0.5, 0.5, 0.0)) * extent)
            });
        }
    }
}

fn prism(out: &mut Surfaces, random: &mut Random, bands: [usize; 2], to_world: impl Fn(DVec3) -> DVec3) {
    let [sides, rings] = bands;
    let height = random.range(0.1, 2.0);
    let (angles, levels) = (angles(random, sides), cuts(random, rings));
    let at = |i: usize, j: usize| {
        let (sin, cos) = libm::sincos(angles[j]);
        to_world(DVec3::new(0.5 * cos, 0.5 * sin, levels[i] * height))
    };
    out.patch([rings, sides], at);
    out.fan((0..sides).map(|j| at(0, j)));
    out.fan((0..sides).map(|j| at(rings, j)));
}

fn tube(out: &mut Surfaces, random: &mut Random, bands: [usize; 2], to_world: impl Fn(DVec3) -> DVec3) {
    let [sides, rings] = bands;
    let width = random.range(0.05, 0.5);
    let (outer, inner) = (0.5 * width, 0.5 * width * random.range(0.5, 0.95));
    let lies = random.below(2) == 0;
    let (angles, levels) = (angles(random, sides), cuts(random, rings));
    let at = |radius: f64, i: usize, j: usize| {
        let (sin, cos) = libm::sincos(angles[j]);
        let (x, y, z) = (radius * cos, radius * sin, levels[i]);
        to_world(if lies { DVec3::new(z - 0.5, y, x + outer) } else { DVec3::new(x, y, z) })
    };
    out.patch([rings, sides], |i, j| at(outer, i, j));
    out.patch([rings, sides], |i, j| at(inner, i, j));
    for end in [0, rings] {
        out.patch([1, sides], |i, j| at(if i == 0 { outer } else { inner }, end, j));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_count_is_up_to_seven_less_than_asked_for() {
        for count in [10, 11, 17, 18, 100, 9_999, 100_000] {
            let mesh = clutter(count, 2);
            let made = mesh.triangles.len();
            assert!(made <= count as usize && made + WEDGE > count as usize, "{count} {made}");
            assert!(mesh.positions.iter().all(|p| p.is_finite()));
            assert_eq!(mesh, clutter(count, 2));
        }
        assert_ne!(clutter(1000, 2), clutter(1000, 3));
    }

    #[test]
    fn things_announce_the_triangles_that_they_make() {
        let mut random = Random::new(9);
        for _ in 0..200 {
            let thing = Thing::draw(&mut random);
            let mut out = Surfaces { mesh: Mesh { positions: Vec::new(), triangles: Vec::new() } };
            thing.put(&mut out, &mut random, 0.1);
            assert_eq!(out.mesh.triangles.len(), thing.triangles());
            let on_floor = out.mesh.positions.iter().map(|p| p.z).fold(f32::INFINITY, f32::min);
            // A lying tube may rest on a side rather than an edge.
            assert!((-1e-6..0.01).contains(&on_floor), "{on_floor}");
            assert!(out.mesh.positions.iter().all(|p| p.x.abs() <= 1.0 && p.y.abs() <= 1.0));
        }
    }

    #[test]
    fn sizes_spread_over_the_three_decades_alike() {
        let mut random = Random::new(1);
        let (mut decades, things) = ([0; 3], 3000);
        for _ in 0..things {
            let mut out = Surfaces { mesh: Mesh { positions: Vec::new(), triangles: Vec::new() } };
            let size = libm::pow(SPREAD, -random.unit());
            Thing::Block([1; 3]).put(&mut out, &mut random, size);
            let length = out.mesh.positions[0].distance(out.mesh.positions[1]);
            assert!(f64::from(length) <= 1.01 * size);
            decades[((-size.log10()) as usize).min(2)] += 1;
        }
        assert!(decades.iter().all(|n| (900..1100).contains(n)), "{decades:?}");
        // Seen in the mesh: the edges of a scene reach over more decades than its things.
        let mesh = clutter(100_000, 1);
        let longest = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            a.distance(b).max(b.distance(c)).max(c.distance(a))
        };
        let mut edges: Vec<f32> = mesh.triangles[2..].iter().map(longest).collect();
        edges.sort_by(f32::total_cmp);
        let (low, high) = (edges[edges.len() / 100], edges[edges.len() - edges.len() / 100]);
        assert!(high > 500.0 * low, "{low} {high}");
    }
}
