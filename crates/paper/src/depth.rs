//! Slices in depth for primary rays, which "it is not convenient" to have (Skala 1993, §6).

use super::experiment::{self, IMAGE};
use super::loops::{Detail, words};
use super::printed::{OBJECTS, SIDES};
use super::table::{Table, grid};
use super::timing::medians;
use accel::grid::Grid;
use accel::{Aabb, Bounds, Geometry, Nearest, Objects, Raster};
use bmssm::suite::dense::{ImageMaps, SpaceMaps};
use primitives::Boxes;

/// Numbers of slices that are tried.
const SLICES: [u32; 3] = [4, 16, 64];

/// Rounds of each timing, each over other rows.
const ROUNDS: usize = 5;

/// Slices along z.
struct Depth {
    maps: SpaceMaps,
    /// Where each slice begins.
    starts: Vec<f32>,
}

/// Boxes with the maps of an image, and slices in depth.
struct Case {
    raster: Raster,
    boxes: Vec<Aabb>,
    image: ImageMaps,
    depths: [Option<Depth>; SLICES.len()],
}

impl Case {
    fn new(objects: u32, side: u32) -> Self {
        let (scene, raster) = experiment::parallel(&experiment::squares(objects, side, 1993), 1993);
        let boxes = match scene.geometry {
            Geometry::Boxes(boxes) => boxes,
            _ => Vec::new(),
        };
        let shape = Boxes::new(&boxes);
        let depths = SLICES.map(|count| Depth::new(&shape, count));
        Self { raster, image: ImageMaps::new(&shape, raster), depths, boxes }
    }

    /// Sums the nearest hits of a row: every candidate is tested, or those slice by slice until one is hit before the next.
    fn row(&self, row: u32, depth: Option<&Depth>) -> f64 {
        let boxes = Boxes::new(&self.boxes);
        let mut sum = 0.0;
        for col in 0..IMAGE {
            let ray = self.raster.ray(row, col);
            let mut best = Nearest::new(ray.t_max);
            let (r, s) = (self.image.rows.slice(row), self.image.cols.slice(col));
            let test = |index: usize, mut word: u64, best: &mut Nearest| {
                while word != 0 {
                    boxes.closest((index << 6 | word.trailing_zeros() as usize) as u32, &ray, best);
                    word &= word - 1;
                }
            };
            match depth {
                None => r.iter().zip(s).enumerate().for_each(|(i, (r, s))| test(i, r & s, &mut best)),
                Some(Depth { maps, starts }) => {
                    for (k, start) in starts.iter().enumerate() {
                        if ray.origin.z + best.t < *start {
                            break;
                        }
                        let t = maps.axes[2].slice(k as u32);
                        for (i, ((r, s), t)) in r.iter().zip(s).zip(t).enumerate() {
                            test(i, r & s & t, &mut best);
                        }
                    }
                }
            }
            sum += f64::from(best.hit().map_or(0.0, |hit| hit.t));
        }
        sum
    }

    /// The candidates of a row without detail tests, as the paper timed them: nothing tells a ray where to end.
    fn untested(&self, row: u32, depth: Option<&Depth>, detail: &mut Detail) {
        for col in 0..IMAGE {
            let (r, s) = (self.image.rows.slice(row), self.image.cols.slice(col));
            match depth {
                None => words(r.iter().zip(s).map(|(r, s)| r & s), detail),
                Some(Depth { maps, starts }) => (0..starts.len() as u32).for_each(|k| {
                    let t = maps.axes[2].slice(k);
                    words(r.iter().zip(s).zip(t).map(|((r, s), t)| r & s & t), detail);
                }),
            }
        }
    }

    /// Nanoseconds a ray: with detail tests for no slices and for each of [`SLICES`], then without for no slices and the middle one.
    fn times(&self) -> [f64; 6] {
        let row = |round: usize| ((2 * round + 1) as u32 * IMAGE) / (2 * ROUNDS as u32);
        let mut sums = [0.0; 4];
        let [a, b, c, d] = &mut sums;
        let [mut e, mut f] = [Detail::default(); 2];
        let [four, sixteen, many] = self.depths.each_ref().map(Option::as_ref);
        let times = medians(
            ROUNDS,
            &mut [
                &mut |round| *a += self.row(row(round), None),
                &mut |round| *b += self.row(row(round), four),
                &mut |round| *c += self.row(row(round), sixteen),
                &mut |round| *d += self.row(row(round), many),
                &mut |round| self.untested(row(round), None, &mut e),
                &mut |round| self.untested(row(round), sixteen, &mut f),
            ],
        );
        std::array::from_fn(|i| times[i] / f64::from(IMAGE))
    }
}

impl Depth {
    fn new(boxes: &Boxes<'_>, count: u32) -> Option<Self> {
        let all =
            (0..Bounds::len(boxes) as u32).fold(Aabb::EMPTY, |all, id| all.union(Bounds::bounds(boxes, id)));
        let grid = Grid::new(all, [1, 1, count]).ok()?;
        let step = all.extent().z / count as f32;
        // A little before the slice, whose border is rounded.
        let starts = (0..count).map(|k| all.min.z + step * (k as f32 - 1e-3)).collect();
        Some(Self { maps: SpaceMaps::new(boxes, grid), starts })
    }
}

/// Time with slices in depth over time without.
pub fn table() -> Table {
    let times: Vec<Vec<[f64; 6]>> = OBJECTS.map(|p| SIDES.map(|s| Case::new(p, s).times()).to_vec()).to_vec();
    let ratio =
        |with: usize, without: usize| grid(|row, col| times[row][col][with] / times[row][col][without]);
    let gained = |values: &[Vec<f64>]| values.iter().flatten().filter(|ratio| **ratio < 0.95).count();
    let tested = [1, 2, 3].map(|with| ratio(with, 0));
    let counts = tested.each_ref().map(|values| gained(values));
    let untested = ratio(5, 4);
    let remark = format!(
        "With detail tests of boxes, {0}, {1} and {2} slices make a ray more than 5 % faster in {3}, {4} and {5} of the 42 cells: where \
         there are many candidates, a hit in a near slice spares those behind it. Without detail tests, as the paper timed, no hit ends a ray, and 16 slices \
         make it faster in {6} cells. \"Not convenient\" (§6) is right for what the paper timed, and for scenes of few candidates.",
        SLICES[0],
        SLICES[1],
        SLICES[2],
        counts[0],
        counts[1],
        counts[2],
        gained(&untested),
    );
    let [four, sixteen, many] = tested;
    Table::of_cells(
        "Slices in depth for primary rays, parallel: time with 16 over time without, with detail tests",
        "objects",
        &[[f64::NAN; 6]; 7],
        sixteen,
    )
    .with("4 slices", four)
    .with("64 slices", many)
    .with("16 slices, without detail tests", untested)
    .with("ns a ray without slices, with detail tests", grid(|row, col| times[row][col][0]))
    .remark(remark)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_in_depth_lose_no_nearest_hit() {
        let case = Case::new(630, 40);
        for row in (0..IMAGE).step_by(16) {
            let without = case.row(row, None);
            assert!(without > 0.0);
            for depth in &case.depths {
                assert_eq!(case.row(row, depth.as_ref()), without, "row {row}");
            }
        }
    }
}
