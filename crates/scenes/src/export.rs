//! Scenes as Wavefront OBJ.

use accel::{Geometry, Scene, Vec3};
use std::io::{self, Write};

/// Writes the scene as OBJ: triangles in object order, coordinates in the shortest form that
/// reads back to the same bits. A box becomes six quads, so reading it back gives twelve
/// triangles a box.
///
/// # Errors
/// Whatever `out` answers, and [`io::ErrorKind::Unsupported`] for solids, which OBJ doesn't know.
pub fn write_obj(scene: &Scene, mut out: impl Write) -> io::Result<()> {
    if let Geometry::Solids(solids) = &scene.geometry {
        let kind = solids.first().map_or("solid", accel::Solid::kind);
        let reason =
            format!("scene `{}` has objects of the kind `{kind}`, and OBJ knows polygons only", scene.id);
        return Err(io::Error::new(io::ErrorKind::Unsupported, reason));
    }
    writeln!(out, "# {}", scene.id.replace(['\n', '\r'], " "))?;
    match &scene.geometry {
        Geometry::Solids(_) => {}
        Geometry::Triangles(mesh) => {
            mesh.positions.iter().try_for_each(|p| vertex(&mut out, *p))?;
            for t in &mesh.triangles {
                let [a, b, c] = t.map(|i| u64::from(i) + 1);
                writeln!(out, "f {a} {b} {c}")?;
            }
        }
        Geometry::Boxes(boxes) => {
            for b in boxes {
                for corner in 0..8 {
                    let pick = |axis: usize| if corner >> axis & 1 == 0 { b.min[axis] } else { b.max[axis] };
                    vertex(&mut out, Vec3::new(pick(0), pick(1), pick(2)))?;
                }
                for [a, b, c, d] in
                    [[8, 6, 5, 7], [4, 3, 1, 2], [8, 7, 3, 4], [6, 2, 1, 5], [8, 4, 2, 6], [7, 5, 1, 3]]
                {
                    writeln!(out, "f {} {} {} {}", a - 9, b - 9, c - 9, d - 9)?;
                }
            }
        }
    }
    out.flush()
}

fn vertex(out: &mut impl Write, p: Vec3) -> io::Result<()> {
    // Debug prints the shortest digits that read back to the same bits, and keeps −0.
    writeln!(out, "v {:?} {:?} {:?}", p.x, p.y, p.z)
}
