//! Tables 2–5: time of a reference method over time of BMSSM, without detail tests.

use super::experiment::{self, IMAGE};
use super::loops::{
    Circle, Detail, Rect, Sphere, Wide, appendix, minmax_parallel, minmax_perspective, sphere_parallel,
    sphere_perspective, wide, words,
};
use super::printed::{Cells, OBJECTS, SIDES, TABLE_2, TABLE_3, TABLE_4, TABLE_5};
use super::table::{Table, grid};
use super::timing::medians;
use accel::{Aabb, Geometry, Projection, Raster, Vec3};
use bmssm::suite::dense::{Axis, ImageMaps};
use lanes::Level;
use primitives::Boxes;

/// Seed of the scenes that are timed.
const SEED: u64 = 1993;

/// A scene of the experiment in all forms that the loops take.
pub struct Case {
    raster: Raster,
    boxes: Vec<Aabb>,
    rects: Vec<Rect>,
    circles: Vec<Circle>,
    spheres: Vec<Sphere>,
    maps: ImageMaps,
    /// The same maps as 32-bit words, slice by slice: rows, columns.
    narrow: [Vec<Vec<u32>>; 2],
}

/// Nanoseconds a ray of the two references and the three loops.
#[derive(Clone, Copy, Debug)]
struct Times {
    minmax: f64,
    sphere: f64,
    appendix: f64,
    words: f64,
    wide: f64,
}

impl Case {
    /// `objects` boxes of `side` pixels.
    pub fn new(projection: Projection, objects: u32, side: u32) -> Self {
        let squares = experiment::squares(objects, side, SEED);
        let (scene, raster) = match projection {
            Projection::Parallel => experiment::parallel(&squares, SEED),
            Projection::Perspective => experiment::perspective(&squares, SEED),
        };
        let boxes = match scene.geometry {
            Geometry::Boxes(boxes) => boxes,
            Geometry::Triangles(_) | Geometry::Solids(_) => Vec::new(),
        };
        let maps = ImageMaps::new(&Boxes::new(&boxes), raster);
        let narrow = [&maps.rows, &maps.cols].map(|axis: &Axis| {
            let halves = |w: &u64| [*w as u32, (*w >> 32) as u32];
            let count = (objects as usize).div_ceil(32);
            let slice = |i: u32| axis.slice(i).iter().flat_map(halves).take(count).collect();
            (0..axis.len() as u32).map(slice).collect()
        });
        let rects = boxes.iter().map(|b| Rect { min: [b.min.x, b.min.y], max: [b.max.x, b.max.y] }).collect();
        let circles = boxes.iter().map(|b| {
            let (center, half) = (b.center(), b.extent() * 0.5);
            Circle { center: [center.x, center.y], square: half.x * half.x + half.y * half.y }
        });
        let spheres = boxes.iter().map(|b| {
            let to_center = b.center() - raster.origin;
            let half = b.extent() * 0.5;
            Sphere { to_center, rest: to_center.length_squared() - half.length_squared() }
        });
        let (circles, spheres) = (circles.collect(), spheres.collect());
        Self { raster, rects, circles, spheres, boxes, maps, narrow }
    }

    /// The pixels of a row.
    fn pixels(row: u32) -> impl Iterator<Item = (u32, u32)> {
        (0..IMAGE).map(move |col| (row, col))
    }

    fn minmax(&self, row: u32, detail: &mut Detail) {
        match self.raster.projection {
            Projection::Parallel => {
                Self::pixels(row)
                    .for_each(|(y, x)| minmax_parallel(&self.rects, [x as f32, y as f32], detail));
            }
            Projection::Perspective => Self::pixels(row).for_each(|(row, col)| {
                let ray = self.raster.ray(row, col);
                minmax_perspective(&self.boxes, ray.origin, ray.direction, detail);
            }),
        }
    }

    fn sphere(&self, row: u32, detail: &mut Detail) {
        match self.raster.projection {
            Projection::Parallel => {
                Self::pixels(row)
                    .for_each(|(y, x)| sphere_parallel(&self.circles, [x as f32, y as f32], detail));
            }
            Projection::Perspective => Self::pixels(row).for_each(|(row, col)| {
                let unit: Vec3 = self.raster.ray(row, col).direction.normalize();
                sphere_perspective(&self.spheres, unit, detail);
            }),
        }
    }

    fn appendix(&self, row: u32, detail: &mut Detail) {
        for (row, col) in Self::pixels(row) {
            let [r, s] = [&self.narrow[0][row as usize], &self.narrow[1][col as usize]];
            appendix(r.iter().zip(s).map(|(r, s)| r & s), detail);
        }
    }

    fn words(&self, row: u32, detail: &mut Detail) {
        for (row, col) in Self::pixels(row) {
            let (r, s) = (self.maps.rows.slice(row), self.maps.cols.slice(col));
            words(r.iter().zip(s).map(|(r, s)| r & s), detail);
        }
    }

    fn wide(&self, row: u32, detail: &mut Detail) {
        Level::best().run(Wide(
            #[inline(always)]
            || {
                for (row, col) in Self::pixels(row) {
                    wide([self.maps.rows.slice(row), self.maps.cols.slice(col)], detail);
                }
            },
        ));
    }

    fn times(&self, rounds: usize) -> Times {
        // Another row each round, spread over the image.
        let row = |round: usize| ((2 * round + 1) * IMAGE as usize / (2 * rounds)) as u32;
        let mut detail = [Detail::default(); 5];
        let [a, b, c, d, e] = &mut detail;
        let times = medians(
            rounds,
            &mut [
                &mut |round| self.minmax(row(round), a),
                &mut |round| self.sphere(row(round), b),
                &mut |round| self.appendix(row(round), c),
                &mut |round| self.words(row(round), d),
                &mut |round| self.wide(row(round), e),
            ],
        );
        let [minmax, sphere, appendix, words, wide] =
            [0, 1, 2, 3, 4].map(|i: usize| times[i] / f64::from(IMAGE));
        Times { minmax, sphere, appendix, words, wide }
    }
}

/// Two tables of one projection: against min-max, against the sphere.
fn pair(projection: Projection, prints: [(&str, &Cells); 2], rounds: usize) -> [Table; 2] {
    let times: Vec<Vec<Times>> = OBJECTS
        .iter()
        .map(|p| {
            let cell = |s: &u32| Case::new(projection, *p, *s).times(rounds);
            SIDES.iter().map(cell).collect()
        })
        .collect();
    let of: [fn(&Times) -> f64; 2] = [|t| t.minmax, |t| t.sphere];
    [0, 1].map(|which| {
        let (title, printed) = prints[which];
        let reference = of[which];
        let each = |value: &dyn Fn(&Times) -> f64| grid(|row, col| value(&times[row][col]));
        let table = Table::of_cells(title, "objects", printed, each(&|t| reference(t) / t.appendix))
            .with("ν with 64-bit words and find-first-set", each(&|t| reference(t) / t.words))
            .with("ν with SIMD words", each(&|t| reference(t) / t.wide))
            .with("ns a ray: reference", each(&reference))
            .with("ns a ray: appendix loop", each(&|t| t.appendix))
            .with("ns a ray: 64-bit words", each(&|t| t.words))
            .with("ns a ray: SIMD words", each(&|t| t.wide))
            .remark("Ours in the first place is the appendix loop: 32-bit words, bit by bit.")
            .remark(
                "The reference loops are scalar, object by object, as in the paper. Written for lanes they would be \
                 several times faster, and each ν as much lower.",
            );
        let [all, down, along] = table.trends();
        table.remark(format!(
            "Rank correlation with the print: {all:.3} over all cells; along p {down:.2} on average over the columns, \
             along s {along:.2} over the rows."
        ))
    })
}

/// Tables 2 to 5: medians of `rounds` interleaved rounds, each over the rays of another row of the image.
pub fn tables(rounds: usize) -> [Table; 4] {
    let parallel = [
        ("ν of BMSSM against the min-max test, parallel", &*TABLE_2),
        ("ν of BMSSM against the sphere (circle) test, parallel", &*TABLE_3),
    ];
    let perspective = [
        ("ν of BMSSM against the min-max test, perspective", &*TABLE_4),
        ("ν of BMSSM against the sphere test, perspective", &*TABLE_5),
    ];
    let [two, three] = pair(Projection::Parallel, parallel, rounds);
    let [four, five] = pair(Projection::Perspective, perspective, rounds);
    let lost = "The print stops within p = 1600; the rows below are ours alone.";
    [two, three, four.remark(lost), five.remark(lost)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// BMSSM is equivalent to the min-max test (§2), and the circle around a box holds more.
    #[test]
    fn loops_find_the_candidates_of_the_minmax_test() {
        for projection in [Projection::Parallel, Projection::Perspective] {
            let case = Case::new(projection, 630, 25);
            let count = |pass: &dyn Fn(u32, &mut Detail)| {
                let mut detail = Detail::default();
                (0..IMAGE).step_by(32).for_each(|row| pass(row, &mut detail));
                detail.count
            };
            let maps = count(&|row, d| case.words(row, d));
            assert_eq!(count(&|row, d| case.appendix(row, d)), maps);
            assert_eq!(count(&|row, d| case.wide(row, d)), maps);
            let minmax = count(&|row, d| case.minmax(row, d));
            match projection {
                Projection::Parallel => assert_eq!(minmax, maps),
                // A box seen in perspective fills no rectangle of the image.
                Projection::Perspective => assert!(minmax <= maps && minmax > maps / 2, "{minmax} {maps}"),
            }
            assert!(count(&|row, d| case.sphere(row, d)) > minmax);
        }
    }
}
