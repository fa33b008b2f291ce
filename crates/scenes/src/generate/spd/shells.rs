use crate::solid::Solid;
use glam::DVec3;
use std::f64::consts::PI;

/// A sea shell of 180·2^sf overlapping spheres along a logarithmic spiral (Pickover 1989):
/// at angle a the radius is r = e^(0.15a), the centre (r sin a, r cos a, −2r), for a from
/// −12π up to but not including 6π.
pub fn shells(sf: u32) -> Vec<Solid> {
    let steps = 180u64 << sf;
    (0..steps)
        .map(|i| {
            let angle = 18.0 * PI * (i as f64 / steps as f64) - 12.0 * PI;
            let radius = libm::exp(0.15 * angle);
            let (sin, cos) = libm::sincos(angle);
            Solid::Sphere { center: DVec3::new(sin, cos, -2.0) * radius, radius }
        })
        .collect()
}
