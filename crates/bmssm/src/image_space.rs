//! A view's image space: which rows and columns of pixels can see a box.
//!
//! The rays of a raster are the meets of row planes and column planes, for perspective through
//! the eye (Skala 1993, §2, §4). A point is seen by the plane of row y or column x where its
//! image coordinate equals y + ½ or x + ½. Ranges are conservative: they hold every pixel whose
//! ray, rounded to `f32` as [`Raster::ray`] makes it, meets the box by [`Aabb::overlap`] at some
//! t ≥ 0.

use accel::{Aabb, Projection, Raster};
use std::ops::Range;

/// Rounding of a raster's rays, relative to the sum of the sizes of its terms.
const RAY_ROUNDING: f64 = 1.0 / (1 << 22) as f64;
/// Largest absolute rounding of `f32` products near zero.
const UNDERFLOW: f64 = f32::MIN_POSITIVE as f64 / (1 << 14) as f64;
/// Rounding of the projection itself and of `Aabb::overlap`, relative to the sum of the sizes of a dot
/// product's terms.
const ROUNDING: f64 = 1.0 / (1u64 << 48) as f64;

type Vector = [f64; 3];

/// The pixels that may see a box.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels {
    /// Rows whose plane meets the box.
    pub rows: Range<u32>,
    /// Columns whose plane meets the box.
    pub cols: Range<u32>,
    /// Lower bound of the t of any hit in the box by a ray of the raster.
    pub near: f32,
}

impl Pixels {
    /// Whether no ray of the raster can hit the box (Skala 1993, §2, "image consistency").
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty() || self.cols.is_empty()
    }
}

/// Maps boxes to the pixels of a raster.
#[derive(Clone, Debug)]
pub struct ImageSpace {
    projection: Projection,
    rows: u32,
    cols: u32,
    origin: Vector,
    /// Coordinates as linear forms of a point's offset from `origin`: t, column, row; for perspective
    /// the latter two are multiplied by t.
    forms: [Vector; 3],
    /// How far the rounding of rays moves a point of the image, in pixels: columns, rows.
    margin: [f64; 2],
    /// Relative error of t.
    t_error: f64,
    /// How far the rounding of a parallel ray's origin moves it along the ray.
    t_moved: f64,
}

/// A box's corner in image space, with bounds of its error.
#[derive(Clone, Copy, Default)]
struct Corner {
    t: f64,
    scaled: [f64; 2],
    t_error: f64,
    scaled_error: [f64; 2],
}

/// A closed range of an image coordinate.
#[derive(Clone, Copy)]
struct Span {
    low: f64,
    high: f64,
}

impl Span {
    const EMPTY: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };

    #[inline(always)]
    fn include(&mut self, low: f64, high: f64) {
        self.low = self.low.min(low);
        self.high = self.high.max(high);
    }
}

impl ImageSpace {
    /// The image space of a raster.
    pub fn new(raster: &Raster) -> Self {
        let vector = |v: accel::Vec3| [0, 1, 2].map(|a| f64::from(v[a]));
        let (forward, right, down) = (vector(raster.forward), vector(raster.right), vector(raster.down));
        let origin = vector(raster.origin);
        let (cols, rows) = (f64::from(raster.cols), f64::from(raster.rows));

        // Products of two `f32` are exact in `f64`, so each minor is off by one rounding at most.
        let normals = [cross(right, down), cross(down, forward), cross(forward, right)];
        let determinant = dot(forward, normals[0]);
        let forms = normals.map(|n| n.map(|v| v / determinant));
        let determinant_error = ROUNDING * dot_abs(forward, normals[0]) / determinant.abs();

        let base = match raster.projection {
            Projection::Parallel => origin,
            Projection::Perspective => forward,
        };
        let moved: Vector = [0, 1, 2].map(|a| {
            (base[a].abs() + cols * right[a].abs() + rows * down[a].abs()) * RAY_ROUNDING + UNDERFLOW
        });
        let along = forms.map(|form| dot_abs(form, moved));
        let (margin, t_error) = match raster.projection {
            Projection::Parallel => {
                ([(along[1], cols), (along[2], rows)].map(|(m, n)| m + 2.0 * n * determinant_error), 0.0)
            }
            // A ray through (1 + dt, x + dx, y + dy) meets the image at (x + dx) / (1 + dt).
            Projection::Perspective => {
                ([(along[1], cols), (along[2], rows)].map(|(m, n)| 2.0 * (m + n * along[0])), along[0])
            }
        };
        let t_error = t_error + 2.0 * determinant_error;
        // With a relative error that large nothing is known of where rays go.
        let margin = if t_error < 0.25 { margin } else { [f64::INFINITY; 2] };
        let (rows, cols) = (raster.rows, raster.cols);
        Self { projection: raster.projection, rows, cols, origin, forms, margin, t_error, t_moved: along[0] }
    }

    /// The pixels that may see `bounds`; all of them where the raster's arithmetic is beyond all bounds.
    #[inline(always)]
    pub fn pixels(&self, bounds: &Aabb) -> Pixels {
        let (spans, t) = match self.projection {
            Projection::Parallel => self.parallel(bounds),
            Projection::Perspective => {
                self.before_the_eye(bounds).unwrap_or_else(|| self.perspective(bounds))
            }
        };
        let [mut cols, mut rows] = spans;
        for (span, margin) in [&mut cols, &mut rows].into_iter().zip(self.margin) {
            *span = Span { low: span.low - margin, high: span.high + margin };
        }
        let near = t - t.abs() * (self.t_error * 2.0 + 2.0 * accel::objects::T_SLACK);
        let near = if near > 0.0 { (near as f32).next_down() } else { 0.0 };
        Pixels { rows: centres(rows, self.rows), cols: centres(cols, self.cols), near }
    }

    /// About where a ray of the raster passes the image: column and row, in pixels from its outer corner.
    pub fn locate(&self, ray: &accel::Ray) -> Option<(f64, f64)> {
        let vector = |v: accel::Vec3| [0, 1, 2].map(|a| f64::from(v[a]));
        let [t, x, y] = match self.projection {
            Projection::Parallel => {
                let origin = vector(ray.origin);
                let offset = [0, 1, 2].map(|a| origin[a] - self.origin[a]);
                let [_, x, y] = self.forms.map(|form| dot(form, offset));
                [1.0, x, y]
            }
            Projection::Perspective => self.forms.map(|form| dot(form, vector(ray.direction))),
        };
        (x / t).is_finite().then_some((x / t, y / t))
    }

    /// Ranges of columns and rows, and the least t.
    #[inline(always)]
    fn parallel(&self, bounds: &Aabb) -> ([Span; 2], f64) {
        let [low, high] = self.offsets(bounds);
        // A loop, as closures given to `map` may be compiled without the instruction set of the caller.
        let mut ranges = [Span::EMPTY; 3];
        for (range, form) in ranges.iter_mut().zip(&self.forms) {
            let (mut least, mut most, mut error) = (0.0, 0.0, 0.0);
            for axis in 0..3 {
                let (a, b) = (form[axis] * low[axis], form[axis] * high[axis]);
                least += if a < b { a } else { b };
                most += if a < b { b } else { a };
                error += if a.abs() > b.abs() { a.abs() } else { b.abs() };
            }
            *range = Span { low: least - error * ROUNDING, high: most + error * ROUNDING };
        }
        ([ranges[1], ranges[2]], ranges[0].low - self.t_moved)
    }

    /// [`ImageSpace::perspective`] for a box well before the eye: about the image of its centre, column or row c,
    /// the form of c' - c is (scaled - c t) / t, whose numerator is small over the whole box.
    #[inline(always)]
    fn before_the_eye(&self, bounds: &Aabb) -> Option<([Span; 2], f64)> {
        let [low, high] = self.offsets(bounds);
        let (mut center, mut half) = ([0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            (center[axis], half[axis]) = ((low[axis] + high[axis]) * 0.5, (high[axis] - low[axis]) * 0.5);
        }
        let [depth, ref scaled @ ..] = self.forms;
        let middle = dot(depth, center);
        let error = (dot_abs(depth, center) + dot_abs(depth, half)) * ROUNDING;
        let least = middle - dot_abs(depth, half) - error;
        // NaN is not well before the eye.
        if !(least > 0.9375 * middle && least > 16.0 * error) {
            return None;
        }
        let (from_middle, from_least) = (1.0 / middle, 1.0 / least);
        let mut spans = [Span::EMPTY; 2];
        for (span, form) in spans.iter_mut().zip(scaled) {
            let at = dot(*form, center) * from_middle;
            let (mut numerator, mut reach, mut error) = (0.0, 0.0, 0.0);
            for axis in 0..3 {
                let shifted = form[axis] - at * depth[axis];
                numerator += shifted * center[axis];
                reach += shifted.abs() * half[axis];
                let size = form[axis].abs() + (at * depth[axis]).abs();
                error += size * (center[axis].abs() + half[axis]);
            }
            let reach = (numerator.abs() + reach + error * ROUNDING) * from_least * (1.0 + ROUNDING);
            span.include(at - reach, at + reach);
        }
        Some((spans, least))
    }

    #[inline(never)]
    fn perspective(&self, bounds: &Aabb) -> ([Span; 2], f64) {
        let [low, high] = self.offsets(bounds);
        let corners: [Corner; 8] = std::array::from_fn(|i| {
            let point: Vector = std::array::from_fn(|a| if i >> a & 1 == 0 { low[a] } else { high[a] });
            let [t, col, row] = self.forms.map(|form| dot(form, point));
            let [te, ce, re] = self.forms.map(|form| dot_abs(form, point) * ROUNDING);
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

    #[inline(always)]
    fn offsets(&self, bounds: &Aabb) -> [Vector; 2] {
        let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            low[axis] = f64::from(bounds.min[axis]) - self.origin[axis];
            high[axis] = f64::from(bounds.max[axis]) - self.origin[axis];
        }
        [low, high]
    }
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
                span.high = f64::INFINITY;
            }
            if at <= error {
                span.low = f64::NEG_INFINITY;
            }
        }
    }
}

/// The pixels 0..n whose centre lies in the span, or all if it is not known.
#[inline(always)]
fn centres(span: Span, n: u32) -> Range<u32> {
    if span.low.is_nan() || span.high.is_nan() {
        return 0..n;
    }
    let count = f64::from(n);
    // Conversions of what is not negative round down; `ceil` and `floor` are calls on old machines.
    let low = (span.low - 0.5).clamp(0.0, count);
    let first = low as u32 + u32::from(low > f64::from(low as u32));
    let end = (span.high + 0.5).clamp(0.0, count) as u32;
    if first < end { first..end } else { 0..0 }
}

fn cross(a: Vector, b: Vector) -> Vector {
    let minor = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

#[inline(always)]
fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The sum of the sizes of a dot product's terms.
#[inline(always)]
fn dot_abs(a: Vector, b: Vector) -> f64 {
    (a[0] * b[0]).abs() + (a[1] * b[1]).abs() + (a[2] * b[2]).abs()
}

#[cfg(test)]
mod tests;
