use crate::solid::round;
use accel::Mesh;
use glam::DVec3;
use std::f64::consts::TAU;

/// The height field z = cos(2πρ)·e^(−ρ) on [−4, 4)², sampled at w × w points for
/// w = 32·2^(sf−1): 2(w−1)² triangles with shared corners. `sf` is at least 1.
pub fn sombrero(sf: u32) -> Mesh {
    let w = 16u32 << sf;
    let flat = |i: u32| f64::from(i) * 8.0 / f64::from(w) - 4.0;
    let positions = (0..w * w).map(|i| {
        let (x, y) = (flat(i % w), flat(i / w));
        let rho = (x * x + y * y).sqrt();
        round(DVec3::new(x, y, libm::cos(TAU * rho) * libm::exp(-rho)))
    });
    let triangles = (0..(w - 1) * (w - 1)).flat_map(|i| {
        let a = i / (w - 1) * w + i % (w - 1);
        [[a, a + 1, a + w + 1], [a, a + w + 1, a + w]]
    });
    Mesh { positions: positions.collect(), triangles: triangles.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts() {
        for sf in [1, 3] {
            let w = 32 * 2usize.pow(sf - 1);
            let mesh = sombrero(sf);
            assert_eq!((mesh.positions.len(), mesh.triangles.len()), (w * w, 2 * (w - 1) * (w - 1)));
        }
    }
}
