//! Exact answers to sets of rays.

use accel::{RaySet, Vec3};
use oracle::{ExactHit, Oracle};
use rayon::prelude::*;

/// The exact nearest hit of a ray, rounded once at the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueHit {
    /// The object, the lowest number of those at exactly the same t.
    pub object: u32,
    /// The nearest `f64` to t.
    pub t: f64,
    /// The nearest `f32` to t.
    pub rounded: f32,
    /// The weight of the second corner.
    pub u: f64,
    /// The weight of the third.
    pub v: f64,
}

impl TrueHit {
    /// The oracle's hit, rounded.
    pub fn of((object, hit): &(u32, ExactHit)) -> Self {
        Self {
            object: *object,
            t: hit.t.to_f64(),
            rounded: hit.t.to_f32(),
            u: hit.u.to_f64(),
            v: hit.v.to_f64(),
        }
    }

    /// Whether t is not zero and less than the least normal `f32`: structures may refuse such hits.
    pub fn is_denormal(&self) -> bool {
        self.t != 0.0 && self.t.abs() < f64::from(f32::MIN_POSITIVE)
    }
}

/// The exact answers to a set of rays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Truth(pub Vec<Option<TrueHit>>);

/// Rays between two reports of progress.
const STEP: usize = 1 << 16;

/// Rays that a thread decides in turn: neighbours meet the same part of the tree.
const CHUNK: usize = 1 << 10;

impl Truth {
    /// What the oracle says, on all threads of the current pool; `heard` is told how many rays are decided.
    pub fn of(oracle: &Oracle, rays: &RaySet, heard: &mut dyn FnMut(usize)) -> Self {
        let mut all = vec![None; rays.len()];
        for (step, answers) in all.chunks_mut(STEP).enumerate() {
            answers.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, answers)| {
                for (i, answer) in answers.iter_mut().enumerate() {
                    let ray = rays.ray(step * STEP + chunk * CHUNK + i);
                    *answer = oracle.closest(&ray).as_ref().map(TrueHit::of);
                }
            });
            heard(rays.len().min((step + 1) * STEP));
        }
        Self(all)
    }
}

/// The point with the weights `u` and `v` of a triangle, in `f64`.
pub fn point([a, b, c]: [Vec3; 3], u: f64, v: f64) -> [f64; 3] {
    let at = |axis: usize| {
        let [a, b, c] = [a, b, c].map(|corner| f64::from(corner[axis]));
        a + (b - a) * u + (c - a) * v
    };
    [at(0), at(1), at(2)]
}
