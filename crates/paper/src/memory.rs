//! Memory (Skala 1993, §5): M_SSM, M_BMSSM and ν_mem by formula and as built.

use super::experiment::scene;
use super::secondary::boxes;
use accel::{Aabb, Builder, Group, Objects, Workload};
use bmssm::suite::dense::{BmssmDense, Resolution};
use primitives::Boxes;
use serde::{Deserialize, Serialize};
use ssm::suite::SsmList;

/// Slices on each axis.
pub const RESOLUTIONS: [u32; 6] = [8, 16, 32, 64, 128, 256];

/// Numbers of objects.
pub const OBJECTS: [u32; 5] = [100, 1000, 10_000, 100_000, 1_000_000];

/// The special cases of §5.
pub const CASES: [&str; 3] = ["large", "one a cell", "sparse"];

/// Lists with more references than this are not built.
const MAX_REFERENCES: f64 = 3e7;

/// Bytes of lists with counters, pointers and ids of `width` bytes: 2N³(q+2) with the paper's 2.
pub fn ssm_bytes(n: u32, q: f64, width: f64) -> f64 {
    width * f64::from(n).powi(3) * (q + 2.0)
}

/// Bytes of the maps: ⅜·N·p.
pub fn bmssm_bytes(n: u32, p: u32) -> f64 {
    0.375 * f64::from(n) * f64::from(p)
}

/// The N at which ν_mem is 1: √(3p / 16(q+2)), halved under the root for ids of 4 bytes.
pub fn crossing(p: u32, q: f64, width: f64) -> f64 {
    (3.0 * f64::from(p) / (8.0 * width * (q + 2.0))).sqrt()
}

/// One N, p and case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Which of [`CASES`].
    pub case: String,
    /// Slices on each axis.
    pub n: u32,
    /// Objects.
    pub p: u32,
    /// Edge of an object in cells.
    pub r: f64,
    /// p·r³/N³.
    pub q_formula: f64,
    /// p·(r+1)³/N³, clipped at the border.
    pub q_touched: f64,
    /// References a cell as built; or, not built, `q_touched`.
    pub q: f64,
    /// Whether both structures were built; else the bytes are those of the model.
    pub built: bool,
    /// 2N³(q+2).
    pub ssm_formula: f64,
    /// 4N³(q+2).
    pub ssm_formula_4: f64,
    /// `ssm-list` as built.
    pub ssm_built: f64,
    /// 3Np bits.
    pub bmssm_formula: f64,
    /// `bmssm-dense` as built.
    pub bmssm_built: f64,
    /// (16/3)·((q+2)/p)·N².
    pub nu_formula: f64,
    /// The same with ids of 4 bytes.
    pub nu_formula_4: f64,
    /// As built.
    pub nu_built: f64,
    /// The formula of the special case: (16/3)N², 16N²/p or (32/3)N²/p.
    pub nu_case: f64,
}

/// Where ν_mem is 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Crossing {
    /// Which of [`CASES`].
    pub case: String,
    /// Objects.
    pub p: u32,
    /// By the formula with the case's q, ids of 2 bytes.
    pub formula: f64,
    /// With ids of 4 bytes.
    pub formula_4: f64,
    /// Between the built N, on a straight line in logarithms; `None` where no two lie on both sides.
    pub built: Option<f64>,
}

/// All of §5's memory.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// Every case, N and p that can be had.
    pub points: Vec<Point>,
    /// Where ν_mem is 1.
    pub crossings: Vec<Crossing>,
}

/// The edge in cells that realises a case, if there is one.
fn edge(case: &str, n: u32, p: u32) -> Option<f64> {
    let (n, p) = (f64::from(n), f64::from(p));
    match case {
        // Objects as large as the scene: every cell holds all.
        "large" => Some(n * 2.0),
        // (r+1)³·p = N³
        "one a cell" => Some(n / p.cbrt() - 1.0).filter(|r| *r > 0.0),
        _ => Some(0.01).filter(|r| p * (r + 1.0f64).powi(3) / n.powi(3) <= 0.1),
    }
}

fn point(case: &str, n: u32, p: u32) -> Option<Point> {
    let r = edge(case, n, p)?;
    let cells = f64::from(n).powi(3);
    let objects = f64::from(p);
    // An object is no larger than the scene, and touches no more cells than there are.
    let held = r.min(f64::from(n));
    let q_formula = objects * held.powi(3) / cells;
    let q_touched = objects * (r + 1.0).min(f64::from(n)).powi(3) / cells;
    let built = build(n, p, r, q_touched * cells);
    let q = built.map_or(q_touched, |(q, ..)| q);
    let wide = if p > 65_535 { 4.0 } else { 2.0 };
    // `ssm-list` keeps positions of 4 bytes in any case.
    let model = (cells * (wide + 4.0) + cells * q * wide, bmssm_bytes(n, p));
    let (ssm_built, bmssm_built) = built.map_or(model, |(_, ssm, bmssm)| (ssm, bmssm));
    let (ssm_2, ssm_4, bmssm) = (ssm_bytes(n, q, 2.0), ssm_bytes(n, q, 4.0), bmssm_bytes(n, p));
    let square = f64::from(n).powi(2);
    let nu_case = match case {
        "large" => 16.0 / 3.0 * square,
        "one a cell" => 16.0 * square / objects,
        _ => 32.0 / 3.0 * square / objects,
    };
    Some(Point {
        case: case.into(),
        n,
        p,
        r: held,
        q_formula,
        q_touched,
        q,
        built: built.is_some(),
        ssm_formula: ssm_2,
        ssm_formula_4: ssm_4,
        ssm_built,
        bmssm_formula: bmssm,
        bmssm_built,
        nu_formula: ssm_2 / bmssm,
        nu_formula_4: ssm_4 / bmssm,
        nu_built: ssm_built / bmssm_built,
        nu_case,
    })
}

/// References a cell, bytes of `ssm-list`, bytes of `bmssm-dense`; `None` if that is too much.
fn build(n: u32, p: u32, r: f64, references: f64) -> Option<(f64, f64, f64)> {
    if references > MAX_REFERENCES {
        return None;
    }
    let boxes = boxes(p, r / f64::from(n), 5 + u64::from(n));
    let objects = Boxes::new(&boxes);
    let ids = 0..p;
    let bounds = ids.clone().fold(Aabb::EMPTY, |all, id| all.union(objects.bounds(id)));
    let grid = accel::grid::Grid::new(bounds, [n; 3]).ok()?;
    let touched = |id: u32| {
        let slices = [0, 1, 2].map(|axis| grid.slices(axis, &objects.bounds(id)).len() as u64);
        slices.iter().product::<u64>()
    };
    let q = ids.map(touched).sum::<u64>() as f64 / grid.cells() as f64;
    let scene = scene(boxes);
    let bytes = |builder: &dyn Builder| {
        let built = builder.build(&scene, &Workload::GENERAL).ok()?;
        Some(built.footprint().bytes(Group::Structure) as f64)
    };
    let mut dense = BmssmDense::default();
    dense.settings.resolution = Resolution::Each([n; 3]);
    let mut list = SsmList::default();
    list.set("resolution", &n.to_string()).ok()?;
    Some((q, bytes(&list)?, bytes(&dense)?))
}

/// Cases up to N = `most_n` and p = `most_p`.
pub fn evaluate(most_n: u32, most_p: u32) -> Memory {
    let mut memory = Memory::default();
    for case in CASES {
        for p in OBJECTS.into_iter().filter(|p| *p <= most_p) {
            let points: Vec<Point> =
                RESOLUTIONS.into_iter().filter(|n| *n <= most_n).filter_map(|n| point(case, n, p)).collect();
            let q = match case {
                "large" => f64::from(p),
                "one a cell" => 1.0,
                _ => 0.0,
            };
            let built = points.windows(2).find_map(|pair| {
                let [a, b] = [&pair[0], &pair[1]].map(|x| (f64::from(x.n).ln(), x.nu_built.ln()));
                (a.1 < 0.0 && b.1 >= 0.0).then(|| (a.0 + (b.0 - a.0) * a.1 / (a.1 - b.1)).exp())
            });
            memory.crossings.push(Crossing {
                case: case.into(),
                p,
                formula: crossing(p, q, 2.0),
                formula_4: crossing(p, q, 4.0),
                built,
            });
            memory.points.extend(points);
        }
    }
    memory
}

#[cfg(test)]
mod tests {
    use super::*;

    /// M_BMSSM as built is 3·N·p bits up to word padding; the special cases are those of the formula.
    #[test]
    fn maps_as_built_are_the_formula_up_to_padding() {
        let memory = evaluate(32, 10_000);
        assert!(memory.points.iter().filter(|p| p.built).count() >= 12);
        for point in memory.points.iter().filter(|p| p.built) {
            let padding = 3.0 * f64::from(point.n) * 8.0;
            let more = point.bmssm_built - point.bmssm_formula;
            assert!((0.0..padding).contains(&more), "{point:?}");
            assert!(
                (point.nu_formula
                    - 16.0 / 3.0 * (point.q + 2.0) / f64::from(point.p) * f64::from(point.n * point.n))
                .abs()
                    < 1e-9 * point.nu_formula
            );
            match point.case.as_str() {
                "large" => assert!((point.nu_formula / point.nu_case - 1.0).abs() < 0.03, "{point:?}"),
                "one a cell" => assert!((point.q - 1.0).abs() < 0.35, "{point:?}"),
                _ => assert!(point.q <= 0.12 && point.nu_formula < 1.1 * point.nu_case, "{point:?}"),
            }
        }
    }

    #[test]
    fn at_the_crossing_the_memories_are_equal() {
        for (p, q, width) in [(1_000_000, 1.0, 2.0), (5000, 0.0, 4.0)] {
            let n = crossing(p, q, width);
            let nu = width * n.powi(3) * (q + 2.0) / (0.375 * n * f64::from(p));
            assert!((nu - 1.0).abs() < 1e-12);
        }
        assert!((crossing(1_000_000, 1.0, 2.0) - 250.0).abs() < 1.0, "about 250 for a million small objects");
    }
}
