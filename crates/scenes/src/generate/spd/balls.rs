use crate::rotation::{about, from_z_to};
use crate::solid::Solid;
use glam::{DMat3, DVec3};

/// A sphereflake: (9^(sf+1) − 1)/8 spheres on a ground square.
pub fn balls(sf: u32) -> Vec<Solid> {
    let mut solids = vec![Solid::ground(12.0, -0.5)];
    grow(&mut solids, DVec3::ZERO, 0.5, DVec3::Z, sf, &children());
    solids
}

fn children() -> [DVec3; 9] {
    let elevated = 54.7356_f64.to_radians();
    std::array::from_fn(|i| {
        let (elevation, azimuth) = if i < 3 { (elevated, 45 + 120 * i) } else { (0.0, 15 + 60 * (i - 3)) };
        let flat = DVec3::new(libm::cos(elevation), 0.0, libm::sin(elevation));
        about(DVec3::Z, (azimuth as f64).to_radians()) * flat
    })
}

fn grow(
    solids: &mut Vec<Solid>,
    center: DVec3,
    radius: f64,
    direction: DVec3,
    depth: u32,
    children: &[DVec3; 9],
) {
    solids.push(Solid::Sphere { center, radius });
    if depth > 0 {
        let turn: DMat3 = from_z_to(direction);
        for child in children {
            let towards = (turn * *child).normalize();
            grow(solids, center + towards * (radius * 4.0 / 3.0), radius / 3.0, towards, depth - 1, children);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_touch() {
        let solids = balls(4);
        let (Solid::Sphere { center: a, radius: r }, Solid::Sphere { center: b, radius: s }) =
            (&solids[1], &solids[2])
        else {
            panic!("spheres expected")
        };
        assert!((a.distance(*b) - (r + s)).abs() < 1e-12);
    }
}
