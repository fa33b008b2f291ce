//! What a reported hit is worth.

use super::intersect::ExactHit;
use accel::Hit;

/// How a reported answer compares with the exact one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// Both miss, or both hit the same object.
    Agree,
    /// The ray hits something, and no hit was reported.
    Missed,
    /// A hit was reported, and the ray hits nothing.
    False,
    /// Both hit, but not the same object.
    WrongObject,
}

/// A verdict and the error of t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// Which kind of answer it is.
    pub verdict: Verdict,
    /// Reported t − exact nearest t, in ulps of `f32` at the exact t, where both hit.
    pub t_ulp_error: Option<f64>,
}

/// Judges a `reported` nearest hit by the exact one, as from [`super::closest`].
pub fn classify(reported: Option<Hit>, exact: Option<&(u32, ExactHit)>) -> Judgement {
    let (verdict, t_ulp_error) = match (reported, exact) {
        (None, None) => (Verdict::Agree, None),
        (None, Some(_)) => (Verdict::Missed, None),
        (Some(_), None) => (Verdict::False, None),
        (Some(reported), Some((object, hit))) => {
            let verdict = if reported.object == *object { Verdict::Agree } else { Verdict::WrongObject };
            (verdict, Some(hit.t_ulp_error(reported.t)))
        }
    };
    Judgement { verdict, t_ulp_error }
}
