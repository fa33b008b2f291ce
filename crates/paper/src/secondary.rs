//! Secondary rays (Skala 1993, §5): R & S & T against lists of objects in cells, in the form of
//! Tables 2–5. The paper gives no such table.

use super::loops::{Detail, Wide, appendix, wide, words};
use super::printed::{OBJECTS, SIDES};
use super::table::{Table, grid};
use super::timing::medians;
use accel::dda::Walk;
use accel::grid::Grid;
use accel::{Aabb, Objects, Ray, Vec3};
use bmssm::suite::dense::SpaceMaps;
use lanes::Level;
use primitives::Boxes;
use scenes::Random;
use std::hint::black_box;

/// Slices on each axis.
pub const RESOLUTION: u32 = 32;

/// A scene as both methods keep it.
struct Case {
    maps: SpaceMaps,
    narrow: [Vec<Vec<u32>>; 3],
    /// SSM: where each cell's list begins, and the lists.
    starts: Vec<u32>,
    ids: Vec<u32>,
    rays: Vec<Ray>,
}

/// Boxes of one size with centres uniform over the unit cube, clipped there.
pub fn boxes(count: u32, side: f64, seed: u64) -> Vec<Aabb> {
    let mut random = Random::new(seed);
    (0..count)
        .map(|_| {
            let center = random.in_cube(0.0, 1.0);
            let clip = |v: f64| v.clamp(0.0, 1.0) as f32;
            let corner = |sign: f64| Vec3::from_array((center + sign * 0.5 * side).to_array().map(clip));
            Aabb { min: corner(-1.0), max: corner(1.0) }
        })
        .collect()
}

impl Case {
    fn new(count: u32, side: u32, rays: usize) -> Option<Self> {
        let boxes = boxes(count, f64::from(side) / 256.0, 1993);
        let objects = Boxes::new(&boxes);
        let ids = 0..objects.len() as u32;
        let bounds = ids.clone().fold(Aabb::EMPTY, |all, id| all.union(objects.bounds(id)));
        let grid = Grid::new(bounds, [RESOLUTION; 3]).ok()?;
        let maps = SpaceMaps::new(&objects, grid);
        let narrow = [0, 1, 2].map(|axis: usize| {
            let halves = |w: &u64| [*w as u32, (*w >> 32) as u32];
            let words = (count as usize).div_ceil(32);
            let slice = |i: u32| maps.axes[axis].slice(i).iter().flat_map(halves).take(words).collect();
            (0..RESOLUTION).map(slice).collect()
        });
        let mut lists = vec![Vec::new(); grid.cells() as usize];
        for id in ids {
            let [x, y, z] = [0, 1, 2].map(|axis| grid.slices(axis, &objects.bounds(id)));
            for k in z {
                for j in y.clone() {
                    for i in x.clone() {
                        lists[grid.index([i, j, k])].push(id);
                    }
                }
            }
        }
        let mut starts = vec![0];
        for list in &lists {
            starts.push(starts[starts.len() - 1] + list.len() as u32);
        }
        let mut random = Random::new(7);
        let mut ray = || Ray::new(random.in_cube(0.0, 1.0).as_vec3(), random.direction().as_vec3());
        let rays = (0..rays).map(|_| ray()).collect();
        Some(Self { maps, narrow, starts, ids: lists.concat(), rays })
    }

    /// Calls `visit` with the slices of every cell on the way of every ray.
    #[inline(always)]
    fn walk(&self, mut visit: impl FnMut([u32; 3])) {
        for ray in &self.rays {
            if let Some(segment) = self.maps.grid.clip(ray) {
                Walk::new(&self.maps.grid, &segment).for_each(|cell| visit(cell.slice));
            }
        }
    }

    fn ssm(&self, count: &mut u64) {
        self.walk(|slice| {
            let cell = self.maps.grid.index(slice);
            for id in &self.ids[self.starts[cell] as usize..self.starts[cell + 1] as usize] {
                *count += 1;
                black_box(*id);
            }
        });
    }

    fn appendix(&self, detail: &mut Detail) {
        self.walk(|slice| {
            let [r, s, t] = [0, 1, 2].map(|axis| &self.narrow[axis][slice[axis] as usize]);
            appendix(r.iter().zip(s).zip(t).map(|((r, s), t)| r & s & t), detail);
        });
    }

    fn words(&self, detail: &mut Detail) {
        self.walk(|slice| {
            let [r, s, t] = self.maps.cell(slice);
            words(r.iter().zip(s).zip(t).map(|((r, s), t)| r & s & t), detail);
        });
    }

    fn wide(&self, detail: &mut Detail) {
        Level::best().run(Wide(
            #[inline(always)]
            || self.walk(|slice| wide(self.maps.cell(slice), detail)),
        ));
    }
}

/// Time of SSM over time of BMSSM for random rays in the cube, without detail tests.
pub fn table(rays: usize, rounds: usize) -> Table {
    let cells: Vec<Vec<[f64; 7]>> = OBJECTS
        .iter()
        .map(|p| {
            let cell = |s: &u32| {
                let Some(case) = Case::new(*p, *s, rays) else { return [0.0; 7] };
                let mut listed = 0;
                let [mut a, mut b, mut c] = [Detail::default(); 3];
                let times = medians(
                    rounds,
                    &mut [
                        &mut |_| case.ssm(&mut listed),
                        &mut |_| case.appendix(&mut a),
                        &mut |_| case.words(&mut b),
                        &mut |_| case.wide(&mut c),
                    ],
                );
                let cells = case.maps.grid.cells() as f64;
                let q = case.ids.len() as f64 / cells;
                let per_ray = |i: usize| times[i] / rays as f64;
                let ssm_bytes = 2.0 * cells * (q + 2.0);
                [per_ray(0), per_ray(1), per_ray(2), per_ray(3), q, ssm_bytes, case.maps.bytes() as f64]
            };
            SIDES.iter().map(cell).collect()
        })
        .collect();
    let each = |of: &dyn Fn(&[f64; 7]) -> f64| grid(|row, col| of(&cells[row][col]));
    let none = vec![vec![None; SIDES.len()]; OBJECTS.len()];
    let table = Table::of_cells(
        "Secondary rays: ν of R & S & T against lists in cells (SSM)",
        "objects",
        &[[f64::NAN; 6]; 7],
        each(&|c| c[0] / c[1]),
    );
    Table { printed: none, ..table }
        .with("ν with 64-bit words and find-first-set", each(&|c| c[0] / c[2]))
        .with("ν with SIMD words", each(&|c| c[0] / c[3]))
        .with("ns a ray: SSM", each(&|c| c[0]))
        .with("ns a ray: appendix loop", each(&|c| c[1]))
        .with("ns a ray: 64-bit words", each(&|c| c[2]))
        .with("ns a ray: SIMD words", each(&|c| c[3]))
        .with("q, references of a cell", each(&|c| c[4]))
        .with("ν_mem, paper's M_SSM over maps as built", each(&|c| c[5] / c[6]))
        .remark(format!(
            "{RESOLUTION} slices on each axis, random rays from inside the cube to its border, no early end. A ν \
             below 1 says that SSM is faster: it looks only at the objects of a cell, BMSSM at a bit of each \
             object of the scene."
        ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_and_lists_hold_the_same_candidates() {
        let case = Case::new(400, 40, 50).unwrap();
        let mut listed = 0;
        case.ssm(&mut listed);
        let mut details = [Detail::default(); 3];
        case.appendix(&mut details[0]);
        case.words(&mut details[1]);
        case.wide(&mut details[2]);
        assert!(listed > 0);
        assert_eq!(details.map(|d| d.count), [listed; 3]);
        assert_eq!(case.maps.references(), case.ids.len() as u64);
    }
}
