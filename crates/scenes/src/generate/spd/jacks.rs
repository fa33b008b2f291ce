use crate::rotation::about;
use crate::solid::Solid;
use glam::{DAffine3, DMat3, DVec3};

/// Jacks within jacks: (8^sf − 1)/7 of them, each three cylinders and six spheres.
pub fn jacks(sf: u32) -> Vec<Solid> {
    let turn = about(DVec3::Y, (-20.0_f64).to_radians()) * about(DVec3::X, (-30.0_f64).to_radians());
    let mut solids = Vec::new();
    if sf > 0 {
        grow(&mut solids, DAffine3::from_mat3(turn), 1.0, sf - 1);
    }
    solids
}

fn grow(solids: &mut Vec<Solid>, to_world: DAffine3, scale: f64, depth: u32) {
    let arms = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * 0.75);
    let size = 0.75 * scale;
    for arm in arms {
        let [base, apex] = [-arm, arm].map(|p| to_world.transform_point3(p));
        solids.push(Solid::Cone { base, base_radius: 0.1 * size, apex, apex_radius: 0.1 * size });
        solids.extend([base, apex].map(|center| Solid::Sphere { center, radius: 0.2 * size }));
    }
    if depth > 0 {
        for octant in 0..8 {
            let offset = DVec3::from_array([4, 2, 1].map(|bit| if octant & bit == 0 { -0.5 } else { 0.5 }));
            let part = DAffine3::from_mat3_translation(DMat3::from_diagonal(DVec3::splat(0.5)), offset);
            grow(solids, to_world * part, 0.5 * scale, depth - 1);
        }
    }
}
