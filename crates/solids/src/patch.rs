//! Bicubic Bézier patches.

use crate::local::Local;
use crate::{Crossing, Crossings};
use accel::Ray;
use accel::solid::{Patch, Shape};
use glam::{DVec2, DVec3};

/// Crossings nearer to each other than this part of the patch's size may be told as one. A crossing's point is no farther from the
/// patch.
pub const WIDTH: f64 = 1.0 / (1u64 << 36) as f64;

/// What control points are rounded by, relative to the patch's size: far more than 16 products and sums of `f64`.
const ROUNDING: f64 = 1.0 / (1u64 << 46) as f64;

/// What is as thin as this, relative to the patch's size, is seen edge-on, slanting or not: rounding alone makes it so thick.
const FLAT: f64 = 1.0 / (1u64 << 49) as f64;

/// Parts looked at; only rays that lie in the patch come to so many.
const MAX: usize = 1 << 15;

/// A part of the patch as the ray sees it: its control points' distances from two planes that meet in the ray.
struct Part {
    net: [[DVec2; 4]; 4],
    /// Where it begins in u and v, and how long it is.
    from: [f64; 2],
    size: [f64; 2],
}

impl Part {
    /// The range of all control points: what the part lies within.
    fn hull(&self) -> [DVec2; 2] {
        let points = self.net.iter().flatten();
        points.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], p| [low.min(*p), high.max(*p)])
    }

    /// The part in a frame that lies along its longest way. Next to a fold, control points lie along a slanting line: only a frame
    /// along it tells that the ray passes beside them, and that neither derivative turns about.
    fn aligned(&self) -> Self {
        let [first, .., last] = &self.net;
        let ways = [first[3] - first[0], last[0] - first[0], last[3] - first[0], last[0] - first[3]];
        let longest = ways.into_iter().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        let along = longest.and_then(DVec2::try_normalize).unwrap_or(DVec2::X);
        let net = self.net.map(|row| row.map(|p| DVec2::new(p.dot(along), along.perp_dot(p))));
        Self { net, ..*self }
    }

    /// Whether the ray passes beside all control points on one side, by more than `slack`.
    fn is_missed(&self, slack: f64) -> bool {
        let [low, high] = self.hull();
        low.max_element() > slack || high.min_element() < -slack
    }

    /// The steps between neighbouring control points, whose hull thrice holds the derivatives in u or in v.
    fn steps(&self, axis: usize) -> [[DVec2; 3]; 4] {
        std::array::from_fn(|line| {
            std::array::from_fn(|i| match axis {
                0 => self.net[line][i + 1] - self.net[line][i],
                _ => self.net[i + 1][line] - self.net[i][line],
            })
        })
    }

    /// Both halves in u or v (de Casteljau).
    fn halves(&self, axis: usize) -> [Self; 2] {
        let mut nets = [self.net; 2];
        for line in 0..4 {
            let get = |i: usize| if axis == 0 { self.net[line][i] } else { self.net[i][line] };
            let [a, b, c, d] = [get(0), get(1), get(2), get(3)];
            let (ab, bc, cd) = ((a + b) * 0.5, (b + c) * 0.5, (c + d) * 0.5);
            let (abc, bcd) = ((ab + bc) * 0.5, (bc + cd) * 0.5);
            let middle = (abc + bcd) * 0.5;
            for (net, points) in nets.iter_mut().zip([[a, ab, abc, middle], [middle, bcd, cd, d]]) {
                for (i, point) in points.into_iter().enumerate() {
                    *(if axis == 0 { &mut net[line][i] } else { &mut net[i][line] }) = point;
                }
            }
        }
        let mut size = self.size;
        size[axis] *= 0.5;
        let mut second = self.from;
        second[axis] += size[axis];
        let [low, high] = nets;
        [Self { net: low, from: self.from, size }, Self { net: high, from: second, size }]
    }

    /// The point and the derivatives at a place of the part.
    fn at(&self, [u, v]: [f64; 2]) -> (DVec2, [DVec2; 2]) {
        let rows = self.net.map(|row| cubic(row, u));
        let (point, along_v) = cubic(rows.map(|(point, _)| point), v);
        let (along_u, _) = cubic(rows.map(|(_, slope)| slope), v);
        (point, [along_u, along_v])
    }

    /// Newton's root, where it converges, in places of the part.
    fn root(&self, small: f64) -> Option<[f64; 2]> {
        let mut place = [0.5; 2];
        let mut last = f64::INFINITY;
        for _ in 0..16 {
            let (point, [a, b]) = self.at(place);
            let away = point.abs().max_element();
            // Down to what rounding leaves.
            if away <= small && away >= 0.5 * last {
                return Some(place);
            }
            let det = a.perp_dot(b);
            let step = DVec2::new(point.perp_dot(b), a.perp_dot(point)) / det;
            place = [place[0] - step.x, place[1] - step.y];
            if !place.iter().all(|p| (-1.0..=2.0).contains(p)) {
                return None;
            }
            last = away;
        }
        (last <= small).then_some(place)
    }
}

/// A cubic's point and derivative.
fn cubic([a, b, c, d]: [DVec2; 4], t: f64) -> (DVec2, DVec2) {
    let (ab, bc, cd) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
    let (abc, bcd) = (ab.lerp(bc, t), bc.lerp(cd, t));
    (abc.lerp(bcd, t), (bcd - abc) * 3.0)
}

/// Whether no two places of the part lie at the same point: no matrix within the bounds of its derivatives is singular, and so by
/// the mean value theorem, applied to each plane's distance, different places differ.
fn is_one_to_one(along: [&[[DVec2; 3]; 4]; 2]) -> bool {
    let range = |steps: &[[DVec2; 3]; 4]| {
        let steps = steps.iter().flatten();
        steps.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], p| [low.min(*p), high.max(*p)])
    };
    let [[u0, u1], [v0, v1]] = along.map(range);
    let product = |[a, b]: [f64; 2], [c, d]: [f64; 2]| {
        let all = [a * c, a * d, b * c, b * d];
        [all.into_iter().fold(f64::INFINITY, f64::min), all.into_iter().fold(f64::NEG_INFINITY, f64::max)]
    };
    let [p, q] = [product([u0.x, u1.x], [v0.y, v1.y]), product([u0.y, u1.y], [v0.x, v1.x])];
    p[0] - q[1] > 0.0 || p[1] - q[0] < 0.0
}

/// The longest way along any line of control points.
fn length(steps: &[[DVec2; 3]; 4]) -> f64 {
    let line = |steps: &[DVec2; 3]| steps.iter().map(|step| step.abs().max_element()).sum::<f64>();
    steps.iter().map(line).fold(0.0, f64::max)
}

/// A ray's line, and two directions that span what is perpendicular to it.
struct Sight {
    origin: DVec3,
    across: [DVec3; 2],
}

impl Sight {
    fn of(line: &Local) -> Option<Self> {
        let direction = line.direction.try_normalize()?;
        let (a, b) = direction.any_orthonormal_pair();
        // No part is missed by a line that is nowhere: all would be halved to the end.
        line.origin.is_finite().then_some(())?;
        Some(Self { origin: line.origin, across: [a, b] })
    }

    fn distances(&self, point: DVec3) -> DVec2 {
        let point = point - self.origin;
        DVec2::new(point.dot(self.across[0]), point.dot(self.across[1]))
    }
}

/// Every place where the line passes through the patch, in no order, by recursive halving: a part whose control points lie on one
/// side of a plane through the line isn't met (T. Nishita, T. Sederberg, M. Kakimoto 1990, "Ray Tracing Trimmed Rational Surface
/// Patches", SIGGRAPH; the halving is that of C. Woodward 1989, "Ray Tracing Parametric Surfaces by Subdivision in Viewing
/// Plane"), and a part that folds nowhere is left to Newton's iteration.
fn places(patch: &Patch, sight: &Sight, center: DVec3, extent: f64) -> Vec<[f64; 2]> {
    let net = patch.net().map(|row| row.map(|point| sight.distances(point.as_dvec3() - center)));
    let (slack, small, flat) = (extent * ROUNDING, extent * WIDTH * 0.25, extent * FLAT);
    let mut found = Vec::new();
    let mut waiting = vec![Part { net, from: [0.0; 2], size: [1.0; 2] }];
    let mut looked_at = 0;
    while let Some(part) = waiting.pop() {
        if part.is_missed(slack) {
            continue;
        }
        looked_at += 1;
        let [low, high] = part.hull();
        let extents = high - low;
        // Seen edge-on, all of it: like a triangle in whose plane the ray lies.
        if extents.min_element() <= slack && extents.max_element() > small || looked_at > MAX {
            continue;
        }
        let of = |place: [f64; 2]| [0, 1].map(|axis| part.from[axis] + place[axis] * part.size[axis]);
        if extents.max_element() <= small {
            found.push(of([0.5; 2]));
            continue;
        }
        let aligned = part.aligned();
        let [low, high] = aligned.hull();
        if aligned.is_missed(2.0 * slack) || (high - low).min_element() <= flat {
            continue;
        }
        let steps = [aligned.steps(0), aligned.steps(1)];
        if is_one_to_one([&steps[0], &steps[1]])
            && let Some(place) = part.root(small)
            && place.iter().all(|p| (-BESIDE..=1.0 + BESIDE).contains(p))
        {
            found.push(of(place));
            continue;
        }
        let axis = usize::from(length(&steps[1]) > length(&steps[0]));
        let [first, second] = part.halves(axis);
        waiting.extend([second, first]);
    }
    found
}

/// How far beside a part a root still counts as its own, so that none is lost between two: in places of the part.
const BESIDE: f64 = 1e-9;

impl Crossings for Patch {
    fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        let bounds = self.bounds();
        let center = bounds.center().as_dvec3();
        let Some(line) = Local::of(&bounds, center, ray) else { return };
        let Some(sight) = Sight::of(&line) else { return };
        let extent = f64::from(bounds.extent().max_element());
        let first = out.len();
        let square = line.direction.length_squared();
        for place in places(self, &sight, center, extent) {
            let [u, v] = place.map(|p| p.clamp(0.0, 1.0));
            let t = (self.at(u, v) - center - line.origin).dot(line.direction) / square;
            let [along_u, along_v] = self.tangents(u, v);
            let enters = along_u.cross(along_v).dot(line.direction) < 0.0;
            // Neighbouring parts may tell the same.
            let same = |other: &Crossing| (other.t - line.moved - t).abs() * square.sqrt() <= extent * WIDTH;
            if !out[first..].iter().any(same) {
                out.push(Crossing { t: line.moved + t, enters, u: u as f32, v: v as f32 });
            }
        }
        out[first..].sort_by(|a, b| a.t.total_cmp(&b.t));
        let mut at = 0;
        out.retain(|crossing| {
            at += 1;
            at <= first || crossing.within(ray, ray.t_max)
        });
    }
}

#[cfg(test)]
mod tests;
