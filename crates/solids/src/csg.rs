//! Combinations of closed solids, by the intervals of a ray in them (S. Roth 1982, "Ray Casting for Modeling Solids", Computer
//! Graphics and Image Processing 18(2)).

use crate::{Crossing, Crossings};
use accel::solid::{Combination, Csg, Shape};
use accel::{Ray, Solid};

/// Every crossing of the whole line with a solid, in order.
fn along(solid: &Solid, line: &Ray) -> Vec<Crossing> {
    match solid {
        Solid::Csg(tree) => along_tree(tree, line),
        other => {
            let mut out = Vec::new();
            other.crossings(line, &mut out);
            out
        }
    }
}

fn along_tree(tree: &Csg, line: &Ray) -> Vec<Crossing> {
    if tree.bounds().overlap(line.origin, line.direction).is_none() {
        return Vec::new();
    }
    let first = along(&tree.parts[0], line);
    if first.is_empty() && tree.combination != Combination::Union {
        return first;
    }
    let second = along(&tree.parts[1], line);
    if second.is_empty() {
        return if tree.combination == Combination::Intersection { second } else { first };
    }
    merged(tree.combination, [&first, &second])
}

/// Where the line's way into or out of both parts is one into or out of the whole.
fn merged(combination: Combination, parts: [&[Crossing]; 2]) -> Vec<Crossing> {
    let mut out = Vec::new();
    let mut next = [0; 2];
    // How often each has been entered and not left: facets may be passed in any order where they meet.
    let mut depth = [0i32; 2];
    let mut inside = false;
    while let Some(t) = [0, 1].into_iter().filter_map(|i| parts[i].get(next[i])).map(|c| c.t).reduce(f64::min)
    {
        let mut cause = None;
        // What happens at one place happens at once: surfaces that touch leave nothing between them.
        for i in [0, 1] {
            while let Some(crossing) = parts[i].get(next[i]).filter(|crossing| crossing.t <= t) {
                depth[i] += if crossing.enters { 1 } else { -1 };
                next[i] += 1;
                cause = cause.or(Some(crossing));
            }
        }
        let now = combination.holds(depth.map(|depth| depth > 0));
        if let (true, Some(cause)) = (now != inside, cause) {
            out.push(Crossing { enters: now, ..*cause });
            inside = now;
        }
    }
    out
}

impl Crossings for Csg {
    fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        // What is inside at the beginning of the range is known from what comes before.
        let line = Ray { t_min: f32::MIN, t_max: f32::INFINITY, ..*ray };
        out.extend(along_tree(self, &line).into_iter().filter(|crossing| crossing.within(ray, ray.t_max)));
    }
}

#[cfg(test)]
mod tests;
