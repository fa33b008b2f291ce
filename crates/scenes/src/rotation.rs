//! Rotation matrices from `libm`, whose bits agree on every platform.

use glam::{DMat3, DVec3};

/// The right-handed rotation by `angle` radians about the unit vector `axis`.
pub fn about(axis: DVec3, angle: f64) -> DMat3 {
    let (sin, cos) = libm::sincos(angle);
    let column = |p: DVec3| p * cos + axis.cross(p) * sin + axis * (axis.dot(p) * (1.0 - cos));
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}

/// The smallest rotation that turns +Z to the unit vector `direction`; half a turn about Y for −Z.
pub fn from_z_to(direction: DVec3) -> DMat3 {
    if direction.z >= 0.9999 {
        DMat3::IDENTITY
    } else if direction.z <= -0.9999 {
        about(DVec3::Y, std::f64::consts::PI)
    } else {
        about(DVec3::Z.cross(direction).normalize(), libm::acos(direction.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_are_right_handed() {
        let quarter = about(DVec3::Z, std::f64::consts::FRAC_PI_2);
        assert!((quarter * DVec3::X).distance(DVec3::Y) < 1e-15);
    }

    #[test]
    fn z_turns_to_the_direction() {
        for d in [DVec3::Z, -DVec3::Z, DVec3::X, DVec3::new(0.6, 0.0, -0.8)] {
            assert!((from_z_to(d) * DVec3::Z).distance(d) < 1e-15);
        }
    }
}
