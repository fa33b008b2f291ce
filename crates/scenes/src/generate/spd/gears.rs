use crate::rotation::about;
use crate::solid::Solid;
use glam::DVec3;

/// Teeth of a gear.
const TEETH: u32 = 36;

/// sf³ interlocking gears over a ground square: 146·sf³ + 1 polygons, two of each gear's
/// being concave 144-gons. `sf` is at least 1.
pub fn gears(sf: u32) -> Vec<Solid> {
    let n = f64::from(sf);
    let radius = 1.0 / (n - 0.05 * (n - 1.0));
    let thickness = (1.0 / (2.0 * n)).min(0.1);
    let mut solids = vec![Solid::ground(2.0, 0.0)];
    for iz in 0..sf {
        for iy in 0..sf {
            for ix in 0..sf {
                let flat = |i: u32| -1.0 + radius + 1.9 * radius * f64::from(i);
                let center = DVec3::new(flat(ix), flat(iy), 1.0 - f64::from(iz) / n);
                let phase = if (ix + iy + iz) % 2 == 1 { 5.0 } else { 0.0 };
                gear(&mut solids, center, phase, radius, thickness);
            }
        }
    }
    solids
}

fn gear(solids: &mut Vec<Solid>, center: DVec3, phase: f64, radius: f64, thickness: f64) {
    let (outer, inner) = (0.995 * radius, 0.9 * radius);
    let top: Vec<DVec3> = (0..TEETH)
        .flat_map(|tooth| {
            [(-0.19, outer), (0.19, outer), (0.3, inner), (0.7, inner)].map(|(angle, r)| {
                let degrees = phase + (f64::from(tooth) + angle) * 10.0;
                center + about(DVec3::Z, degrees.to_radians()) * (DVec3::X * r)
            })
        })
        .collect();
    let down = DVec3::Z * thickness;
    let bottom: Vec<DVec3> = top.iter().map(|p| *p - down).collect();
    for (here, next) in (0..top.len()).map(|i| (i, (i + 1) % top.len())) {
        solids.push(Solid::convex(vec![top[here], bottom[here], bottom[next], top[next]]));
    }
    let triangles = outline_triangles();
    let flipped = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    solids.push(Solid::Polygon { corners: top, triangles });
    solids.push(Solid::Polygon { corners: bottom, triangles: flipped });
}

/// The concave outline cut into the convex polygon of its inner corners and a quad per tooth.
fn outline_triangles() -> Vec<[u32; 3]> {
    let corners = 4 * TEETH;
    let teeth = (0..TEETH).flat_map(|tooth| {
        let first = 4 * tooth;
        let before = (first + corners - 1) % corners;
        [[before, first, first + 1], [before, first + 1, first + 2]]
    });
    let ring: Vec<u32> = (0..corners).filter(|i| i % 4 >= 2).collect();
    let core = (2..ring.len()).map(|i| [ring[0], ring[i - 1], ring[i]]);
    teeth.chain(core).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts() {
        assert_eq!(gears(4).len(), 9345);
        assert_eq!(outline_triangles().len(), 142);
    }

    #[test]
    fn the_cut_of_the_outline_covers_it_once() {
        let solids = gears(1);
        let Some(Solid::Polygon { corners, triangles }) = solids.get(145) else { panic!("the top face") };
        assert_eq!(corners.len(), 144);
        let cross = |a: DVec3, b: DVec3| a.x * b.y - a.y * b.x;
        let outline: f64 = (0..144).map(|i| cross(corners[i], corners[(i + 1) % 144])).sum();
        let areas = triangles.iter().map(|t| {
            let [a, b, c] = t.map(|i| corners[i as usize]);
            cross(b - a, c - a)
        });
        let (mut sum, mut least) = (0.0, f64::INFINITY);
        for area in areas {
            sum += area;
            least = least.min(area);
        }
        assert!((sum / outline - 1.0).abs() < 1e-12 && least > 0.0, "{sum} {outline} {least}");
    }
}
