//! Real roots of polynomials, none stepped over.

/// Appends to `out`, in order, where the polynomial changes sign in [low, high]: between two neighbouring roots of its
/// derivative, found in the same way, it rises or falls all the way, so that there is one change or none. `c[i]` is the
/// coefficient of tⁱ. Zero counts as below zero; where it only touches zero from below there is no change, and from above there may
/// be two that are equal.
///
/// What is certain is the sign as it is computed, by Horner's scheme in `f64`: a root is off by what rounding the value, some
/// 2^-51 of the sum of its terms' sizes, moves it.
pub fn sign_changes<const N: usize>(c: [f64; N], low: f64, high: f64, out: &mut Roots) {
    changes(&c, low, high, out);
}

/// The highest degree that is needed.
const DEGREE: usize = 4;

/// Up to [`DEGREE`] roots.
#[derive(Clone, Copy, Debug, Default)]
pub struct Roots {
    all: [f64; DEGREE],
    count: usize,
}

impl Roots {
    fn push(&mut self, root: f64) {
        self.all[self.count] = root;
        self.count += 1;
    }

    /// In order.
    pub fn as_slice(&self) -> &[f64] {
        &self.all[..self.count]
    }
}

fn changes(c: &[f64], low: f64, high: f64, out: &mut Roots) {
    let [rest @ .., top] = c else { return };
    if rest.is_empty() {
        return;
    }
    if *top == 0.0 {
        return changes(rest, low, high, out);
    }
    if let [constant, slope] = c {
        let root = -constant / slope;
        if low <= root && root <= high {
            out.push(root);
        }
        return;
    }
    let mut derivative = [0.0; DEGREE];
    for (i, slot) in derivative.iter_mut().enumerate().take(rest.len()) {
        *slot = (i + 1) as f64 * c[i + 1];
    }
    let mut turns = Roots::default();
    changes(&derivative[..rest.len()], low, high, &mut turns);
    let mut from = (low, value(c, low));
    for turn in turns.as_slice().iter().copied().chain([high]) {
        let to = (turn, value(c, turn));
        if (from.1 <= 0.0) != (to.1 <= 0.0) {
            out.push(between(c, &derivative[..rest.len()], from, to));
        }
        from = to;
    }
}

fn value(c: &[f64], t: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// The change of sign in a range where there is one: Newton's steps while they stay in what bisection leaves.
fn between(c: &[f64], derivative: &[f64], a: (f64, f64), b: (f64, f64)) -> f64 {
    let ((mut below, mut above), mut t) = if a.1 <= 0.0 { ((a.0, b.0), a.0) } else { ((b.0, a.0), b.0) };
    t = 0.5 * (t + if t == a.0 { b.0 } else { a.0 });
    // Each bisection halves the range; 2 · 64 of either kind of step take any range of usual numbers to its last bit.
    for step in 0..128 {
        let f = value(c, t);
        if f <= 0.0 {
            below = t
        } else {
            above = t
        }
        let newton = t - f / value(derivative, t);
        let (low, high) = (below.min(above), below.max(above));
        let middle = 0.5 * (low + high);
        let next = if step % 8 < 7 && low < newton && newton < high { newton } else { middle };
        if next == t || next <= low || high <= next {
            return next.clamp(low, high);
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn of(c: [f64; 5]) -> Vec<f64> {
        let mut out = Roots::default();
        sign_changes(c, -10.0, 10.0, &mut out);
        out.as_slice().to_vec()
    }

    /// (t − r₁)(t − r₂)(t − r₃)(t − r₄)
    fn with_roots(r: [f64; 4]) -> [f64; 5] {
        let mut c = [1.0, 0.0, 0.0, 0.0, 0.0];
        for (degree, root) in r.into_iter().enumerate() {
            for i in (0..=degree + 1).rev() {
                c[i] = if i > 0 { c[i - 1] } else { 0.0 } - root * c[i];
            }
        }
        c
    }

    #[test]
    fn known_roots_are_found() {
        for roots in [[-3.0, -1.0, 2.0, 5.0], [-0.5, 0.25, 0.5, 8.0]] {
            let found = of(with_roots(roots));
            assert_eq!(found.len(), 4, "{found:?}");
            assert!(found.iter().zip(roots).all(|(a, b)| (a - b).abs() < 1e-13), "{found:?}");
        }
        assert_eq!(of([1.0, 0.0, 0.0, 0.0, 1.0]), []);
        assert_eq!(of([-1.0, 0.0, 0.0, 1.0, 0.0]), [1.0]);
        assert_eq!(of([0.0; 5]), []);
    }

    proptest! {
        #[test]
        fn no_change_of_sign_is_stepped_over(mut roots in prop::array::uniform4(-8.0..8.0f64)) {
            roots.sort_by(f64::total_cmp);
            let c = with_roots(roots);
            let found = of(c);
            let gap = roots.windows(2).map(|w| w[1] - w[0]).fold(1.0, f64::min);
            prop_assert!(found.len().is_multiple_of(2));
            if gap > 1e-3 {
                prop_assert_eq!(found.len(), 4);
                for (found, root) in found.iter().zip(roots) {
                    prop_assert!((found - root).abs() < 1e-11 / gap, "{} for {}", found, root);
                }
            }
        }
    }
}
