use crate::rotation::about;
use crate::solid::Solid;
use glam::{DAffine3, DVec3};

/// Width of a branch over its length.
const WIDTH: f64 = 0.15;
/// A branch's radius at its tip over the one at its base.
const TAPER: f64 = 0.67;

/// A binary tree: 2^(sf+1) − 1 cones, as many spheres at their tips, and the ground.
pub fn tree(sf: u32) -> Vec<Solid> {
    let mut solids = vec![Solid::ground(50.0, 0.0)];
    let fork = [(40.0_f64, 90.0_f64, 0.65), (25.0, 230.0, 0.70)].map(|(a, d, scale)| {
        let turn = about(DVec3::Z, d.to_radians()) * about(DVec3::X, a.to_radians());
        DAffine3::from_mat3_translation(turn * scale, DVec3::Z)
    });
    grow(&mut solids, DAffine3::IDENTITY, 1.0, sf, &fork);
    solids
}

fn grow(solids: &mut Vec<Solid>, to_world: DAffine3, scale: f64, depth: u32, fork: &[DAffine3; 2]) {
    let base_radius = scale * WIDTH;
    let apex_radius = base_radius * TAPER;
    let apex = to_world.transform_point3(DVec3::Z);
    solids.push(Solid::Cone { base: to_world.translation, base_radius, apex, apex_radius });
    solids.push(Solid::Sphere { center: apex, radius: apex_radius });
    if depth > 0 {
        for branch in fork {
            grow(solids, to_world * *branch, scale * TAPER, depth - 1, fork);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_are_cones() {
        let solids = tree(11);
        assert_eq!(solids.iter().filter(|s| matches!(s, Solid::Cone { .. })).count(), 4095);
    }
}
