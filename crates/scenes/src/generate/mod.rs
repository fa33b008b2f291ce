//! Generators of scenes: from a definition's parameters and seed to geometry.
//!
//! The same parameters give the same bits on every platform: random numbers come from
//! integer arithmetic, coordinates from IEEE double arithmetic and `libm`, and are rounded
//! to single precision once, at the end.

mod blobs;
mod boxes;
mod bumps;
mod clutter;
mod degenerate;
mod foliage;
mod machine_part;
mod spd;
mod stadium;
mod strands;
mod triangles;

pub use boxes::PIXELS;
pub use degenerate::Shape;

use crate::analytic::analytic;
use crate::solid::{self, Solid};
use accel::{Geometry, Mesh};
use glam::DVec3;
use serde::Deserialize;

/// More objects than this are refused: a slip in a number should not fill the memory.
pub const MAX_OBJECTS: u64 = 1 << 26;

/// Edges around a solid at most: what is made once for all spheres of a scene takes the square of them, whether there are
/// spheres or not.
const MAX_SEGMENTS: u32 = 2048;

/// A scene family with its parameters, as the `[generator]` table of a definition says it.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Generator {
    /// The paper's boxes: `objects` boxes `side` pixels wide.
    Boxes {
        /// Number of boxes, p in the paper.
        objects: u32,
        /// Width in pixels, s in the paper.
        side: f64,
    },
    /// Boxes that share faces, some of them flat.
    StackedBoxes {
        /// Boxes along each axis.
        side: u32,
    },
    /// Separate random triangles of mean edge `edge`/∛`objects`.
    Triangles {
        /// Number of triangles.
        objects: u32,
        /// Mean edge in units of the mean distance of the triangles.
        edge: f64,
    },
    /// Long thin triangles in random directions.
    Needles {
        /// Number of triangles.
        objects: u32,
        /// Their length; the scene is the unit cube.
        length: f64,
        /// Length over width.
        aspect: f64,
    },
    /// A closed bumpy sphere of about `objects` triangles.
    Bumps {
        /// Number of triangles, about.
        objects: u32,
        /// Height of the bumps; the sphere's radius is 1.
        #[serde(default = "default_height")]
        height: f64,
    },
    /// A closed sphere of about `objects` triangles.
    Ball {
        /// Number of triangles, about.
        objects: u32,
        /// Radius.
        radius: f64,
        /// Centre.
        center: [f64; 3],
    },
    /// The teapot in a large hall.
    Stadium {
        /// Cells along a side of each of the 32 patches.
        cells: u32,
        /// Width of the hall; the teapot is 6.5 wide.
        hall: f64,
    },
    /// A tree in leaf.
    Foliage {
        /// Number of triangles; odd ones are made even.
        objects: u32,
    },
    /// A ball of hair.
    Strands {
        /// Number of triangles, rounded to a multiple of 90.
        objects: u32,
    },
    /// Things of very different sizes on a floor.
    Clutter {
        /// Number of triangles, of which up to seven may be left out.
        objects: u32,
    },
    /// Equal, flat or zero-area triangles.
    Degenerate {
        /// Which of them.
        shape: Shape,
        /// Number of triangles, about.
        objects: u32,
    },
    /// One of Haines' databases made of solids.
    Spd {
        /// Which of them.
        database: Database,
        /// Its size factor.
        size_factor: u32,
        /// Edges around a tessellated sphere, cone or cylinder.
        #[serde(default = "default_segments")]
        segments: u32,
        /// Whether spheres, cones and cylinders stay what they are instead, capped.
        #[serde(default)]
        analytic: bool,
    },
    /// Haines' sombrero, a height field.
    Sombrero {
        /// 32·2^(size_factor − 1) samples a side.
        size_factor: u32,
    },
    /// Newell's teapot.
    Teapot {
        /// Cells along a side of each of the 32 patches.
        cells: u32,
        /// Whether it stands on Haines' checkerboard of cells × cells squares.
        #[serde(default)]
        checkerboard: bool,
    },
    /// Newell's teapot as its 32 Bézier patches.
    TeapotPatches,
    /// Implicit surfaces about a few points each, in the unit cube.
    Blobs {
        /// How many.
        objects: u32,
    },
    /// Plates with bosses and bores, each a set of boxes and cylinders.
    MachinePart {
        /// How many.
        objects: u32,
    },
}

/// Haines' databases that consist of solids.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
#[expect(missing_docs, reason = "the databases' own names")]
pub enum Database {
    Balls,
    Gears,
    Jacks,
    Lattice,
    Mount,
    Rings,
    Shells,
    Tetra,
    Tree,
}

fn default_height() -> f64 {
    0.1
}

fn default_segments() -> u32 {
    8
}

impl Database {
    /// Number of primitives before tessellation, saturating.
    pub fn primitives(self, sf: u32) -> u64 {
        let n = u64::from(sf);
        let power = |base: u64, exponent: u32| base.saturating_pow(exponent);
        match self {
            Self::Balls => power(9, sf.saturating_add(1)) / 8 + 1,
            Self::Gears => power(n, 3).saturating_mul(146).saturating_add(1),
            Self::Jacks => (power(8, sf) / 7).saturating_mul(9),
            Self::Lattice => power(n + 1, 3).saturating_add(power(n + 1, 2).saturating_mul(3 * n)),
            Self::Mount => power(4, sf).saturating_mul(2).saturating_add(4),
            Self::Rings => power(n + 1, 3).saturating_mul(20).saturating_add(1),
            Self::Shells => power(2, sf).saturating_mul(180),
            Self::Tetra => power(4, sf),
            Self::Tree => power(2, sf.saturating_add(2)).saturating_sub(1),
        }
    }

    fn solids(self, sf: u32, seed: u64) -> Vec<Solid> {
        match self {
            Self::Balls => spd::balls(sf),
            Self::Gears => spd::gears(sf),
            Self::Jacks => spd::jacks(sf),
            Self::Lattice => spd::lattice(sf),
            Self::Mount => spd::mount(sf, seed),
            Self::Rings => spd::rings(sf),
            Self::Shells => spd::shells(sf),
            Self::Tetra => spd::tetra(sf),
            Self::Tree => spd::tree(sf),
        }
    }
}

impl Generator {
    /// Makes the geometry.
    ///
    /// # Errors
    /// In words, a parameter that the family can't use.
    pub fn build(&self, seed: u64) -> Result<Geometry, String> {
        self.validate()?;
        let mesh = match *self {
            Self::Boxes { objects, side } => return Ok(Geometry::Boxes(boxes::boxes(objects, side, seed))),
            Self::StackedBoxes { side } => return Ok(Geometry::Boxes(degenerate::stacked_boxes(side))),
            Self::TeapotPatches => return Ok(Geometry::Solids(spd::teapot_patches())),
            Self::Blobs { objects } => return Ok(Geometry::Solids(blobs::blobs(objects, seed))),
            Self::MachinePart { objects } => {
                return Ok(Geometry::Solids(machine_part::machine_part(objects, seed)));
            }
            Self::Triangles { objects, edge } => triangles::scattered(objects, edge, seed),
            Self::Needles { objects, length, aspect } => triangles::needles(objects, length, aspect, seed),
            Self::Bumps { objects, height } => bumps::bumps(objects, height),
            Self::Ball { objects, radius, center } => bumps::ball(objects, radius, DVec3::from_array(center)),
            Self::Stadium { cells, hall } => stadium::stadium(cells, hall),
            Self::Foliage { objects } => foliage::foliage(objects, seed),
            Self::Strands { objects } => strands::strands(objects, seed),
            Self::Clutter { objects } => clutter::clutter(objects, seed),
            Self::Degenerate { shape, objects } => degenerate::degenerate(shape, objects, seed),
            Self::Spd { database, size_factor, analytic: true, .. } => {
                return Ok(Geometry::Solids(analytic(&database.solids(size_factor, seed))));
            }
            Self::Spd { database, size_factor, segments, .. } => {
                solid::tessellate(&database.solids(size_factor, seed), segments)
            }
            Self::Sombrero { size_factor } => spd::sombrero(size_factor),
            Self::Teapot { cells, checkerboard } => {
                let mut mesh = spd::teapot(cells);
                if checkerboard {
                    merge(&mut mesh, solid::tessellate(&spd::checkerboard(cells), 3));
                }
                mesh
            }
        };
        Ok(Geometry::Triangles(mesh))
    }

    /// An upper bound on the number of triangles or boxes, saturating.
    pub fn objects_bound(&self) -> u64 {
        let cells = |n: u32| u64::from(n).saturating_mul(u64::from(n));
        match *self {
            Self::Boxes { objects, .. } | Self::Triangles { objects, .. } | Self::Needles { objects, .. } => {
                u64::from(objects)
            }
            Self::Bumps { objects, .. }
            | Self::Ball { objects, .. }
            | Self::Foliage { objects }
            | Self::Strands { objects }
            | Self::Clutter { objects } => u64::from(objects),
            Self::Degenerate { objects, .. } => 3 * u64::from(objects),
            Self::TeapotPatches => 32,
            // Each is as large as many triangles.
            Self::Blobs { objects } => 64 * u64::from(objects),
            Self::MachinePart { objects } => 256 * u64::from(objects),
            Self::StackedBoxes { side } => u64::from(side).saturating_pow(3),
            Self::Stadium { cells: n, .. } | Self::Teapot { cells: n, .. } => cells(n).saturating_mul(66),
            Self::Sombrero { size_factor } => {
                2048u64.saturating_mul(4u64.saturating_pow(size_factor.saturating_sub(1)))
            }
            Self::Spd { database, size_factor, segments, .. } => {
                let round = cells(segments.saturating_add(3)).max(2);
                let primitives = database.primitives(size_factor);
                match database {
                    Database::Gears => primitives.saturating_mul(4),
                    // Flat ones, and four spheres above them.
                    Database::Mount => primitives.saturating_add(4 * round),
                    Database::Tetra => primitives,
                    _ => primitives.saturating_mul(round),
                }
            }
        }
    }

    fn validate(&self) -> Result<(), String> {
        let positive = |name: &str, value: f64| {
            let usable = value.is_finite() && value > 0.0;
            if usable { Ok(()) } else { Err(format!("{name} must be a positive number, not {value}")) }
        };
        match *self {
            Self::Spd { segments, .. } if segments > MAX_SEGMENTS => {
                return Err(format!("segments must be at most {MAX_SEGMENTS}, not {segments}"));
            }
            Self::Boxes { side, .. } => positive("side", side)?,
            Self::Triangles { edge, .. } => positive("edge", edge)?,
            Self::Needles { length, aspect, .. } => {
                positive("length", length).and(positive("aspect", aspect))?
            }
            Self::Bumps { height, .. } if !(0.0..1.0).contains(&height) => {
                return Err(format!("height must be in [0, 1), not {height}"));
            }
            Self::Ball { radius, .. } => positive("radius", radius)?,
            Self::Stadium { hall, .. } => positive("hall", hall)?,
            _ => {}
        }
        let least = match *self {
            Self::Foliage { .. } => foliage::MIN,
            Self::Strands { .. } => strands::STRAND,
            Self::Clutter { .. } => clutter::MIN,
            _ => 1,
        };
        let size = match *self {
            Self::StackedBoxes { side: n }
            | Self::Stadium { cells: n, .. }
            | Self::Teapot { cells: n, .. }
            | Self::Sombrero { size_factor: n }
            | Self::Spd { size_factor: n, .. } => n,
            Self::Bumps { objects, .. }
            | Self::Ball { objects, .. }
            | Self::Foliage { objects }
            | Self::Strands { objects }
            | Self::Clutter { objects }
            | Self::Blobs { objects }
            | Self::MachinePart { objects } => objects,
            _ => 1,
        };
        if size < least {
            return Err(format!("the size must be at least {least}, not {size}"));
        }
        let objects = self.objects_bound();
        if objects > MAX_OBJECTS {
            return Err(format!("up to {objects} objects would be made; the most is {MAX_OBJECTS}"));
        }
        check_memory(objects, accel::available_memory())
    }
}

/// Bytes that an object takes at most: three corners and as many numbers, or a box, and what is made on the way.
const EACH: u128 = 64;

fn check_memory(objects: u64, available: u128) -> Result<(), String> {
    let bytes = u128::from(objects) * EACH;
    if bytes > available {
        return Err(format!("up to {bytes} bytes would be taken; there are {available}"));
    }
    Ok(())
}

/// Appends `other` to `mesh`.
fn merge(mesh: &mut Mesh, other: Mesh) {
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(other.positions);
    mesh.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + first)));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A count that is asked for makes the other number of triangles, the same for each seed and another mesh.
    pub(super) fn assert_counts(make: fn(u32, u64) -> Mesh, counts: &[(u32, usize)]) {
        for (count, made) in counts {
            let mesh = make(*count, 3);
            assert_eq!(mesh.triangles.len(), *made, "{count}");
            assert!(mesh.positions.iter().all(|p| p.is_finite()));
            assert_eq!(mesh, make(*count, 3));
        }
        assert_ne!(make(1000, 3), make(1000, 4));
    }

    #[test]
    fn primitive_counts_are_the_published_ones() {
        for (database, sf, published) in [
            (Database::Balls, 4, 7382),
            (Database::Gears, 4, 9345),
            (Database::Lattice, 12, 8281),
            (Database::Tetra, 6, 4096),
            (Database::Tree, 11, 8191),
            (Database::Mount, 6, 8196),
            (Database::Jacks, 4, 5265),
            (Database::Shells, 5, 5760),
            (Database::Rings, 7, 8401),
        ] {
            assert_eq!(database.solids(sf, 1).len(), published, "{database:?}");
            assert!(database.primitives(sf) >= published as u64, "{database:?}");
        }
    }

    #[test]
    fn scenes_larger_than_memory_are_refused() {
        assert!(check_memory(1000, 64_000).is_ok() && check_memory(1001, 64_000).is_err());
    }

    #[test]
    fn absurd_sizes_are_refused_before_memory_is_taken() {
        for generator in [
            Generator::Triangles { objects: u32::MAX, edge: 1.0 },
            Generator::Spd { database: Database::Balls, size_factor: u32::MAX, segments: 8, analytic: false },
            Generator::Spd { database: Database::Tetra, size_factor: 0, segments: 8, analytic: false },
            Generator::Spd { database: Database::Tetra, size_factor: 1, segments: u32::MAX, analytic: false },
            Generator::Spd { database: Database::Mount, size_factor: 1, segments: 200_000, analytic: false },
            Generator::Spd { database: Database::Gears, size_factor: 1, segments: 1 << 31, analytic: false },
            Generator::Sombrero { size_factor: 0 },
            Generator::Foliage { objects: 13 },
            Generator::Strands { objects: 89 },
            Generator::Clutter { objects: u32::MAX },
            Generator::Bumps { objects: 100, height: f64::NAN },
            Generator::Stadium { cells: 4, hall: -1.0 },
        ] {
            assert!(generator.build(1).is_err(), "{generator:?}");
        }
    }
}
