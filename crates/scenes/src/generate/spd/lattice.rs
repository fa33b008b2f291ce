use crate::solid::Solid;
use glam::DVec3;

/// A cubic lattice in the unit cube: (n+1)³ spheres joined by 3n(n+1)² cylinders for a size
/// factor n of at least 1.
pub fn lattice(sf: u32) -> Vec<Solid> {
    let n = f64::from(sf);
    let (ball, bar) = (1.0 / (4.0 * n), 1.0 / (16.0 * n));
    let mut solids = Vec::new();
    for x in 0..=sf {
        for y in 0..=sf {
            for z in 0..=sf {
                let center = DVec3::new(f64::from(x), f64::from(y), f64::from(z)) / n;
                solids.push(Solid::Sphere { center, radius: ball });
                for (i, axis) in [(x, DVec3::X), (y, DVec3::Y), (z, DVec3::Z)] {
                    if i < sf {
                        let apex = center + axis / n;
                        solids.push(Solid::Cone { base: center, base_radius: bar, apex, apex_radius: bar });
                    }
                }
            }
        }
    }
    solids
}
