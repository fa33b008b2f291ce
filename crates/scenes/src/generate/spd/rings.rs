use crate::rotation::about;
use crate::solid::Solid;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Radius of the cylinders and spheres.
const RADIUS: f64 = 0.07412;
/// Distance of the layers.
const LAYER: f64 = 2.6131;

/// A pyramid of interlocking rings before a wall: 5n(n+1)(2n+1) cylinders and as many
/// spheres for a size factor n.
pub fn rings(sf: u32) -> Vec<Solid> {
    let y = LAYER * f64::from(sf + 1);
    // The wall spans the published view of 45° with 1 % to spare.
    let half = 1.01 * (y + LAYER) * libm::tan(PI / 8.0);
    let corner = |x: f64, z: f64| DVec3::new(x * half - 1.0, y, z * half + 0.5);
    let mut solids =
        vec![Solid::convex(vec![corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)])];
    let pentagons = pentagons();
    for depth in 0..sf {
        for iz in 0..=depth {
            for ix in 0..=depth {
                let across = |i: u32| 2.0 * f64::from(i) - f64::from(depth);
                let center = DVec3::new(across(ix), LAYER * f64::from(depth + 1), across(iz));
                for pentagon in &pentagons {
                    for i in 0..5 {
                        let (base, apex) = (center + pentagon[i], center + pentagon[(i + 4) % 5]);
                        solids.push(Solid::Cone { base, base_radius: RADIUS, apex, apex_radius: RADIUS });
                        solids.push(Solid::Sphere { center: base, radius: RADIUS });
                    }
                }
            }
        }
    }
    solids
}

/// Six pentagons, one in the XY plane, five tilted by a dodecahedron's angle around it.
fn pentagons() -> [[DVec3; 5]; 6] {
    let scale = 1.0 / (1.0 + RADIUS);
    let flat: [DVec3; 5] =
        std::array::from_fn(|i| about(DVec3::Z, i as f64 * TAU / 5.0) * (DVec3::X * scale));
    let tilt = about(DVec3::X, 2.0 * libm::acos(libm::cos(PI / 3.0) / libm::sin(PI / 5.0)));
    std::array::from_fn(|k| match k {
        0 => flat,
        _ => flat.map(|p| about(DVec3::Z, PI / 5.0 + (k - 1) as f64 * TAU / 5.0) * (tilt * p)),
    })
}
