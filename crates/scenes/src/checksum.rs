//! A scene's fingerprint for records.

use accel::{Geometry, Vec3};
use sha2::{Digest, Sha256};

/// SHA-256 in hex of the geometry's buffers: the letter T, B or S, then for triangles the number
/// of positions, the positions, the number of triangles and their indices, for boxes their
/// number and corners, for solids their number and for each the length of its kind's name, the name, and its numbers; counts as u64, coordinates as f32 bits, indices as u32, little-endian.
pub fn checksum(geometry: &Geometry) -> String {
    let mut hash = Sha256::new();
    match geometry {
        Geometry::Triangles(mesh) => {
            hash.update(b"T");
            points(&mut hash, mesh.positions.len(), mesh.positions.iter());
            hash.update((mesh.triangles.len() as u64).to_le_bytes());
            for t in &mesh.triangles {
                t.iter().for_each(|i| hash.update(i.to_le_bytes()));
            }
        }
        Geometry::Boxes(boxes) => {
            hash.update(b"B");
            points(&mut hash, boxes.len(), boxes.iter().flat_map(|b| [&b.min, &b.max]));
        }
        Geometry::Solids(solids) => {
            hash.update(b"S");
            hash.update((solids.len() as u64).to_le_bytes());
            for solid in solids {
                hash.update((solid.kind().len() as u64).to_le_bytes());
                hash.update(solid.kind());
                solid.numbers(&mut |number| hash.update(number.to_le_bytes()));
            }
        }
    }
    hex(&hash.finalize())
}

fn points<'a>(hash: &mut Sha256, count: usize, points: impl Iterator<Item = &'a Vec3>) {
    hash.update((count as u64).to_le_bytes());
    for p in points {
        p.to_array().iter().for_each(|x| hash.update(x.to_le_bytes()));
    }
}

/// Bytes as lower-case hex.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
