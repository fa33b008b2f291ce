use crate::random::mix;
use crate::rotation::about;
use crate::solid::Solid;
use glam::DVec3;
use std::f64::consts::TAU;

/// A fractal mountain of 2·4^sf triangles below four spheres.
///
/// Midpoint displacement over [−1, 1]² from flat corners. The deviates come from a hash of
/// `seed` and the grid coordinates, so neighbouring quads agree on their common edge.
pub fn mount(sf: u32, seed: u64) -> Vec<Solid> {
    let n = 1usize << sf;
    let mut height = vec![0.0; (n + 1) * (n + 1)];
    let at = |x: usize, y: usize| y * (n + 1) + x;
    let roughness = (libm::cbrt(2.0) - 1.0).sqrt();
    let mut side = n;
    while side > 1 {
        let half = side / 2;
        let h = half as f64 * 2.0 / n as f64 * roughness;
        for y in (0..=n).step_by(half) {
            for x in (0..=n).step_by(half) {
                height[at(x, y)] = match (x % side != 0, y % side != 0) {
                    (false, false) => continue,
                    (true, false) => {
                        0.5 * (height[at(x - half, y)] + height[at(x + half, y)]) + h * gauss(seed, x, y)
                    }
                    (false, true) => {
                        0.5 * (height[at(x, y - half)] + height[at(x, y + half)]) + h * gauss(seed, x, y)
                    }
                    (true, true) => {
                        let corner =
                            |dx: usize, dy: usize| height[at(x - half + dx * side, y - half + dy * side)];
                        let mean = 0.25 * (corner(0, 0) + corner(1, 0) + corner(0, 1) + corner(1, 1));
                        mean + std::f64::consts::SQRT_2 * h * gauss(seed, x, y)
                    }
                }
            }
        }
        side = half;
    }
    let point = |x: usize, y: usize| {
        let flat = |i: usize| i as f64 * 2.0 / n as f64 - 1.0;
        DVec3::new(flat(x), flat(y), height[at(x, y)])
    };
    let mut solids = spheres();
    for y in 0..n {
        for x in 0..n {
            let (a, b, c, d) = (point(x, y), point(x + 1, y), point(x + 1, y + 1), point(x, y + 1));
            solids.push(Solid::convex(vec![a, b, c]));
            solids.push(Solid::convex(vec![a, c, d]));
        }
    }
    solids
}

/// Four spheres on the corners of a tetrahedron, hovering over the mountain.
fn spheres() -> Vec<Solid> {
    let radius = 0.17;
    let center = DVec3::new(-0.8, 0.8, 1.0);
    let top = DVec3::Z * (radius * 1.5_f64.sqrt());
    let tilt = about(DVec3::new(1.0, 1.0, 0.0).normalize(), libm::acos(-1.0 / 3.0));
    let around = (0..3).map(|i| about(DVec3::Z, f64::from(i) * TAU / 3.0) * (tilt * top));
    std::iter::once(top).chain(around).map(|p| Solid::Sphere { center: center + p, radius }).collect()
}

/// A standard normal deviate that depends on nothing but its arguments (Box & Muller 1958).
fn gauss(seed: u64, x: usize, y: usize) -> f64 {
    let first = mix(mix(seed ^ 0x6d6f_756e_7461_696e) ^ ((x as u64) << 32 | y as u64));
    let unit = |bits: u64| ((bits >> 11) as f64 + 0.5) / (1u64 << 53) as f64;
    (-2.0 * libm::log(unit(first))).sqrt() * libm::cos(TAU * unit(mix(first ^ 1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts() {
        assert_eq!(mount(6, 1).len(), 2 * 4usize.pow(6) + 4);
    }

    #[test]
    fn deviates_are_normal() {
        let draws: Vec<f64> = (0..100).flat_map(|x| (0..100).map(move |y| gauss(1, x, y))).collect();
        let mean = draws.iter().sum::<f64>() / 1e4;
        let variance = draws.iter().map(|g| g * g).sum::<f64>() / 1e4;
        assert!(mean.abs() < 0.05 && (variance - 1.0).abs() < 0.05, "{mean} {variance}");
    }

    #[test]
    fn the_spheres_touch() {
        let centers: Vec<DVec3> = spheres()
            .iter()
            .filter_map(|s| if let Solid::Sphere { center, .. } = s { Some(*center) } else { None })
            .collect();
        for i in 0..4 {
            for j in 0..i {
                assert!((centers[i].distance(centers[j]) - 0.34).abs() < 1e-9);
            }
        }
    }
}
