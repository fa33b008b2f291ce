//! Tables 2–5: time of a reference method over time of BMSSM, without detail tests.

use super::candidates::quantile;
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
use harness::clock::Clock;
use lanes::Level;
use primitives::Boxes;
use scenes::Random;

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
    references: [f64; 2],
    /// The references where a row is repeated.
    repeated: [f64; 2],
    /// The references for rays in random order.
    scattered: [f64; 2],
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

    fn minmax_at(&self, (row, col): (u32, u32), detail: &mut Detail) {
        if self.raster.projection == Projection::Parallel {
            return minmax_parallel(&self.rects, [col as f32, row as f32], detail);
        }
        let ray = self.raster.ray(row, col);
        minmax_perspective(&self.boxes, ray.origin, ray.direction, detail);
    }

    fn sphere_at(&self, (row, col): (u32, u32), detail: &mut Detail) {
        match self.raster.projection {
            Projection::Parallel => sphere_parallel(&self.circles, [col as f32, row as f32], detail),
            Projection::Perspective => {
                let unit: Vec3 = self.raster.ray(row, col).direction.normalize();
                sphere_perspective(&self.spheres, unit, detail);
            }
        }
    }

    fn minmax(&self, row: u32, detail: &mut Detail) {
        Self::pixels(row).for_each(|at| self.minmax_at(at, detail));
    }

    fn sphere(&self, row: u32, detail: &mut Detail) {
        Self::pixels(row).for_each(|at| self.sphere_at(at, detail));
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

    /// Nanoseconds a ray of each loop over the rows of an image, one after the other.
    fn times(&self, rows: &[u32]) -> [f64; LOOPS.len()] {
        let clock = Clock::of(1);
        LOOPS.map(|pass| {
            let mut detail = Detail::default();
            let start = clock.now();
            rows.iter().for_each(|row| pass(self, *row, &mut detail));
            (clock.now() - start) as f64 / (rows.len() as f64 * f64::from(IMAGE))
        })
    }

    /// Nanoseconds a ray of the references where one row is repeated until the clock's steps don't show.
    fn repeated(&self) -> [f64; 2] {
        let row = |round: usize| ((2 * round + 1) as u32 * IMAGE) / (2 * REPEATED as u32);
        let [mut a, mut b] = [Detail::default(); 2];
        let times = medians(
            REPEATED,
            &mut [&mut |round| self.minmax(row(round), &mut a), &mut |round| self.sphere(row(round), &mut b)],
        );
        [0, 1].map(|i: usize| times[i] / f64::from(IMAGE))
    }

    /// Nanoseconds a ray of the references for rays in random order, so that none is like the one before.
    fn scattered(&self) -> [f64; 2] {
        let mut random = Random::new(7);
        let mut at = || random.below(IMAGE as usize) as u32;
        let pixels: Vec<(u32, u32)> = (0..SCATTERED).map(|_| (at(), at())).collect();
        let [mut a, mut b] = [Detail::default(); 2];
        let times = medians(
            1,
            &mut [&mut |_| pixels.iter().for_each(|at| self.minmax_at(*at, &mut a)), &mut |_| {
                pixels.iter().for_each(|at| self.sphere_at(*at, &mut b))
            }],
        );
        [0, 1].map(|i: usize| times[i] / SCATTERED as f64)
    }
}

/// Rays in random order, more than a branch predictor learns by heart.
const SCATTERED: usize = 4096;

/// The loops that are compared: two references, and three of BMSSM.
const LOOPS: [fn(&Case, u32, &mut Detail); 5] =
    [Case::minmax, Case::sphere, Case::appendix, Case::words, Case::wide];

/// Rows of each cell that are repeated.
const REPEATED: usize = 5;

/// How much is timed.
#[derive(Clone, Copy, Debug)]
pub struct Images {
    /// How often the images are traced; the rounds of a cell lie as far apart as all others take.
    pub rounds: usize,
    /// Every how manieth row of an image: 1 for whole ones.
    pub step: u32,
}

/// Nanoseconds a ray by objects and sides: the median of the rounds.
fn measure(projection: Projection, images: Images) -> Vec<Vec<Times>> {
    let cases = OBJECTS.map(|p| SIDES.map(|s| Case::new(projection, p, s)));
    let rows: Vec<u32> = (0..IMAGE).step_by(images.step as usize).collect();
    let mut samples = OBJECTS.map(|_| SIDES.map(|_| Vec::new()));
    for _ in 0..images.rounds {
        for (cases, samples) in cases.iter().zip(&mut samples) {
            for (case, samples) in cases.iter().zip(samples) {
                samples.push(case.times(&rows));
            }
        }
    }
    let times = |case: &Case, samples: &Vec<[f64; 5]>| {
        let [minmax, sphere, appendix, words, wide] = [0, 1, 2, 3, 4]
            .map(|i: usize| quantile(&samples.iter().map(|sample| sample[i]).collect::<Vec<_>>(), 0.5));
        Times {
            references: [minmax, sphere],
            repeated: case.repeated(),
            scattered: case.scattered(),
            appendix,
            words,
            wide,
        }
    };
    let row = |(cases, samples): (&[Case; 6], &[Vec<[f64; 5]>; 6])| {
        cases.iter().zip(samples).map(|(case, samples)| times(case, samples)).collect()
    };
    cases.iter().zip(&samples).map(row).collect()
}

/// Two tables of one projection: against min-max, against the sphere.
fn pair(projection: Projection, prints: [(&str, &Cells); 2], images: Images) -> [Table; 2] {
    let times = measure(projection, images);
    [0, 1].map(|which| {
        let (title, printed) = prints[which];
        let reference = |t: &Times| t.references[which];
        let each = |value: &dyn Fn(&Times) -> f64| grid(|row, col| value(&times[row][col]));
        let an_object = |value: &dyn Fn(&Times) -> f64| {
            grid(|row, col| value(&times[row][col]) / f64::from(OBJECTS[row]))
        };
        let [whole, again, scattered, maps] = [
            an_object(&reference),
            an_object(&|t| t.repeated[which]),
            an_object(&|t| t.scattered[which]),
            an_object(&|t| t.appendix),
        ];
        let costs = in_words([&whole, &again, &scattered, &maps]);
        let table = Table::of_cells(title, "objects", printed, each(&|t| reference(t) / t.appendix))
            .with("ν with 64-bit words and find-first-set", each(&|t| reference(t) / t.words))
            .with("ν with SIMD words", each(&|t| reference(t) / t.wide))
            .with("ns a ray: reference", each(&reference))
            .with(APPENDIX_NS, each(&|t| t.appendix))
            .with("ns a ray: 64-bit words", each(&|t| t.words))
            .with("ns a ray: SIMD words", each(&|t| t.wide))
            .with("ns an object: reference", whole)
            .with("ns an object: reference, one row again and again", again)
            .with("ns an object: reference, rays in random order", scattered)
            .with("ns an object: appendix loop", maps)
            .remark("Ours in the first place is the appendix loop: 32-bit words, bit by bit.")
            .remark(
                "The reference loops are scalar, object by object, as in the paper. Written for lanes they would be \
                 several times faster, and each ν as much lower.",
            )
            .remark(costs);
        let trends = table.trends_in_words();
        table.remark(trends)
    })
}

/// What an object costs with few of them and with many: the reference over whole images, over one row again and again, and in random
/// order; the appendix loop.
fn in_words(all: [&[Vec<f64>]; 4]) -> String {
    let mean = |row: &[f64]| row.iter().sum::<f64>() / row.len() as f64;
    let ends = |rows: &[Vec<f64>]| [mean(&rows[0]), mean(&rows[rows.len() - 1])];
    let [[few, many], [few_again, many_again], [few_scattered, many_scattered], [few_maps, many_maps]] =
        all.map(ends);
    let (least, most) = (OBJECTS[0], OBJECTS[OBJECTS.len() - 1]);
    let grown = many / few - 1.0;
    let why = if grown < 0.2 {
        "The reference costs the same whatever p is"
    } else if many_scattered / few_scattered - 1.0 < 0.5 * grown {
        "Neighbouring rays meet nearly the same boxes, and the branch predictor knows a short loop's answers from the ray before, those of a long \
         one no more: in random order most of the growth is gone"
    } else {
        "Neither repetition nor the likeness of neighbouring rays is the whole reason"
    };
    format!(
        "An object costs the reference {few:.2} ns with p = {least} and {many:.2} ns with p = {most} over a whole image; over one row again and \
         again, until the clock's steps don't show, {few_again:.2} and {many_again:.2}; over rays in random order {few_scattered:.2} and \
         {many_scattered:.2}. {why}. The appendix loop takes {few_maps:.3} and {many_maps:.3} ns an object: where that grows faster than the \
         reference, ν falls along p. A PC 386 guesses no branch, so that there an object costs the same whatever p is, and ν rises as what else a \
         ray costs is shared by more objects."
    )
}

/// The variant of Tables 2 to 5 that holds the time of BMSSM as printed.
pub const APPENDIX_NS: &str = "ns a ray: appendix loop";

/// Tables 2 to 5, over whole images as in the paper.
pub fn tables(images: Images) -> [Table; 4] {
    let parallel = [
        ("ν of BMSSM against the min-max test, parallel", &*TABLE_2),
        ("ν of BMSSM against the sphere (circle) test, parallel", &*TABLE_3),
    ];
    let perspective = [
        ("ν of BMSSM against the min-max test, perspective", &*TABLE_4),
        ("ν of BMSSM against the sphere test, perspective", &*TABLE_5),
    ];
    let [two, three] = pair(Projection::Parallel, parallel, images);
    let [four, five] = pair(Projection::Perspective, perspective, images);
    let lost = "The print stops within p = 1600; the rows below are ours alone.";
    let circle = circle_over_minmax(&two, &three);
    [two, three.remark(circle), four.remark(lost), five.remark(lost)]
}

/// Time of the circle test over that of the min-max test, which §6 says too.
fn circle_over_minmax(two: &Table, three: &Table) -> String {
    let ratios =
        || three.ours.iter().flatten().zip(two.ours.iter().flatten()).map(|(circle, minmax)| circle / minmax);
    let (low, high) = (ratios().fold(f64::INFINITY, f64::min), ratios().fold(0.0, f64::max));
    let within = ratios().filter(|ratio| (1.81..=2.52).contains(ratio)).count();
    format!(
        "Circle over min-max: \"ν ∈ <1.81, 2.52>\" (§6); here {low:.2} to {high:.2}, {within} of {} cells within. A comparison that is \
         guessed wrong costs more today than the operations of either test.",
        ratios().count()
    )
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
