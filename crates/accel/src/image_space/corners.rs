//! The image of a box near the eye or around it, by its corners.

use super::{Spans, Vector, dot, dot_abs};
use crate::tolerance::PROJECTION;

/// A closed range of an image coordinate.
pub(super) type Span = Spans<1>;

impl Span {
    fn include(&mut self, low: f64, high: f64) {
        self.low[0] = self.low[0].min(low);
        self.high[0] = self.high[0].max(high);
    }
}

/// A box's corner in image space, with bounds of its error.
#[derive(Clone, Copy, Default)]
struct Corner {
    t: f64,
    scaled: [f64; 2],
    t_error: f64,
    scaled_error: [f64; 2],
}

/// Ranges of columns and rows of the box between two offsets from the eye, wherever it is, and the least t of its
/// corners.
#[inline(never)]
pub(super) fn about_the_eye(forms: &[Vector; 3], low: Vector, high: Vector) -> ([Span; 2], f64) {
    let corners: [Corner; 8] = std::array::from_fn(|i| {
        let point: Vector = std::array::from_fn(|a| if i >> a & 1 == 0 { low[a] } else { high[a] });
        let [t, col, row] = forms.map(|form| dot(form, point));
        let [te, ce, re] = forms.map(|form| dot_abs(form, point) * PROJECTION);
        Corner { t, scaled: [col, row], t_error: te, scaled_error: [ce, re] }
    });
    let least_t = corners.iter().map(|c| c.t - c.t_error).fold(f64::INFINITY, f64::min);
    let mut spans = [Span::EMPTY; 2];
    for corner in &corners {
        corner.include(&mut spans);
    }
    if least_t <= 0.0 {
        for front in corners.iter().filter(|c| c.is_front()) {
            for back in corners.iter().filter(|c| c.is_back()) {
                front.include_crossing(back, &mut spans);
            }
        }
    }
    (spans, least_t)
}

impl Corner {
    /// Errors of this many times the bound still divide well.
    const CLEAR: f64 = 4.0;

    fn is_front(&self) -> bool {
        self.t > Self::CLEAR * self.t_error
    }

    fn is_back(&self) -> bool {
        self.t < -Self::CLEAR * self.t_error
    }

    /// Adds where the corner itself is seen, if it is not behind the eye.
    fn include(&self, spans: &mut [Span; 2]) {
        if self.is_back() {
            return;
        }
        for (axis, span) in spans.iter_mut().enumerate() {
            let (scaled, error) = (self.scaled[axis], self.scaled_error[axis]);
            if self.is_front() {
                let at = scaled / self.t;
                let off = 2.0 * (error + at.abs() * self.t_error) / self.t;
                span.include(at - off, at + off);
            } else if scaled.abs() <= error {
                span.include(f64::NEG_INFINITY, f64::INFINITY);
            } else {
                // About in the eye plane: seen from some place on to infinity.
                let at = (scaled.abs() - error) / (2.0 * Self::CLEAR * self.t_error);
                if scaled > 0.0 {
                    span.include(at, f64::INFINITY);
                } else {
                    span.include(f64::NEG_INFINITY, -at);
                }
            }
        }
    }

    /// Adds the infinity towards which the image of the line to a corner behind the eye runs.
    fn include_crossing(&self, back: &Self, spans: &mut [Span; 2]) {
        let share = self.t / (self.t - back.t);
        for (axis, span) in spans.iter_mut().enumerate() {
            let step = back.scaled[axis] - self.scaled[axis];
            let at = self.scaled[axis] + step * share;
            // The share is off by less than the errors of t over their difference.
            let error = 4.0 * (self.scaled_error[axis] + back.scaled_error[axis])
                + 4.0 * step.abs() * (self.t_error + back.t_error) / (self.t - back.t);
            if at >= -error {
                span.high[0] = f64::INFINITY;
            }
            if at <= error {
                span.low[0] = f64::NEG_INFINITY;
            }
        }
    }
}
