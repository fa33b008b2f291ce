//! A view's image space: which rows and columns of pixels can see a box.
//!
//! The rays of a raster are the meets of row planes and column planes, for perspective through
//! the eye (Skala 1993, §2, §4). A point is seen by the plane of row y or column x where its
//! image coordinate equals y + ½ or x + ½. Ranges are conservative: they hold every pixel whose
//! ray, rounded to `f32` as [`Raster::ray`] makes it, meets the box by [`Aabb::overlap`] at some
//! t ≥ 0.

mod corners;

use crate::tolerance::{PROJECTION, RASTER_ROUNDING, RASTER_UNDERFLOW, T_SLACK};
use crate::{Aabb, Projection, Raster};
use std::ops::Range;

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

/// A closed range of an image coordinate, for each of `L` boxes.
#[derive(Clone, Copy)]
struct Spans<const L: usize> {
    low: [f64; L],
    high: [f64; L],
}

impl<const L: usize> Spans<L> {
    const EMPTY: Self = Self { low: [f64::INFINITY; L], high: [f64::NEG_INFINITY; L] };
}

/// Offsets of the corners of `L` boxes from the origin, axis by axis.
#[derive(Clone, Copy)]
struct Offsets<const L: usize> {
    low: [[f64; L]; 3],
    high: [[f64; L]; 3],
}

/// [`Pixels`] of `L` boxes.
#[derive(Clone, Copy)]
pub struct PixelLanes<const L: usize> {
    rows: [[u32; L]; 2],
    cols: [[u32; L]; 2],
    near: [f32; L],
}

impl<const L: usize> PixelLanes<L> {
    /// Those of one box.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Pixels {
        let range = |of: &[[u32; L]; 2]| of[0][lane]..of[1][lane];
        Pixels { rows: range(&self.rows), cols: range(&self.cols), near: self.near[lane] }
    }
}

/// The row and column of the pixel of a raster whose ray this is, bit for bit.
pub fn pixel_of(raster: &Raster, ray: &crate::Ray) -> Option<(u32, u32)> {
    let find = |[rows, cols]: [Range<u32>; 2]| {
        rows.flat_map(|row| cols.clone().map(move |col| (row, col)))
            .find(|&(row, col)| raster.ray(row, col) == *ray)
    };
    let around = |place: f64, pixels: u32| {
        let pixel = place.floor().clamp(0.0, f64::from(pixels.max(1) - 1)) as u32;
        pixel.saturating_sub(1)..(pixel + 2).min(pixels)
    };
    let near = ImageSpace::new(raster).locate(ray);
    near.and_then(|(x, y)| find([around(y, raster.rows), around(x, raster.cols)]))
        // Rounding may hide where a ray passes an image that is almost a line or a point.
        .or_else(|| find([0..raster.rows, 0..raster.cols]))
}

impl ImageSpace {
    /// The image space of a raster.
    pub fn new(raster: &Raster) -> Self {
        let vector = |v: crate::Vec3| [0, 1, 2].map(|a| f64::from(v[a]));
        let (forward, right, down) = (vector(raster.forward), vector(raster.right), vector(raster.down));
        let origin = vector(raster.origin);
        let (cols, rows) = (f64::from(raster.cols), f64::from(raster.rows));

        // Products of two `f32` are exact in `f64`, so each minor is off by one rounding at most.
        let normals = [cross(right, down), cross(down, forward), cross(forward, right)];
        let determinant = dot(forward, normals[0]);
        let forms = normals.map(|n| n.map(|v| v / determinant));
        let determinant_error = PROJECTION * dot_abs(forward, normals[0]) / determinant.abs();

        let base = match raster.projection {
            Projection::Parallel => origin,
            Projection::Perspective => forward,
        };
        let moved: Vector = [0, 1, 2].map(|a| {
            (base[a].abs() + cols * right[a].abs() + rows * down[a].abs()) * RASTER_ROUNDING
                + RASTER_UNDERFLOW
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
        self.pixels_of(&[*bounds]).lane(0)
    }

    /// [`ImageSpace::pixels`] of several boxes: loops over lanes, which compilers make vectors of.
    #[inline(always)]
    pub fn pixels_of<const L: usize>(&self, bounds: &[Aabb; L]) -> PixelLanes<L> {
        let mut offsets = Offsets { low: [[0.0; L]; 3], high: [[0.0; L]; 3] };
        for axis in 0..3 {
            for (lane, Aabb { min, max }) in bounds.iter().enumerate() {
                offsets.low[axis][lane] = f64::from(min[axis]) - self.origin[axis];
                offsets.high[axis][lane] = f64::from(max[axis]) - self.origin[axis];
            }
        }
        let ([cols, rows], t) = match self.projection {
            Projection::Parallel => self.parallel(&offsets),
            Projection::Perspective => self.perspective(&offsets),
        };
        let mut near = [0.0; L];
        for lane in 0..L {
            let least = t[lane] - t[lane].abs() * (self.t_error * 2.0 + 2.0 * T_SLACK);
            let least = if least > 0.0 { least as f32 } else { 0.0 };
            // The next number down, if that isn't negative.
            near[lane] = f32::from_bits(least.to_bits().saturating_sub(1));
        }
        let rows = centres(&rows, self.margin[1], self.rows);
        PixelLanes { rows, cols: centres(&cols, self.margin[0], self.cols), near }
    }

    /// About where a ray of the raster passes the image: column and row, in pixels from its outer corner.
    fn locate(&self, ray: &crate::Ray) -> Option<(f64, f64)> {
        let vector = |v: crate::Vec3| [0, 1, 2].map(|a| f64::from(v[a]));
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
    fn parallel<const L: usize>(&self, offsets: &Offsets<L>) -> ([Spans<L>; 2], [f64; L]) {
        let Offsets { low, high } = offsets;
        // A loop, as closures given to `map` may be compiled without the instruction set of the caller.
        let mut ranges = [Spans::EMPTY; 3];
        for (range, form) in ranges.iter_mut().zip(&self.forms) {
            let (mut least, mut most, mut error) = ([0.0; L], [0.0; L], [0.0; L]);
            for axis in 0..3 {
                for lane in 0..L {
                    let (a, b) = (form[axis] * low[axis][lane], form[axis] * high[axis][lane]);
                    least[lane] += if a < b { a } else { b };
                    most[lane] += if a < b { b } else { a };
                    error[lane] += if a.abs() > b.abs() { a.abs() } else { b.abs() };
                }
            }
            for lane in 0..L {
                range.low[lane] = least[lane] - error[lane] * PROJECTION;
                range.high[lane] = most[lane] + error[lane] * PROJECTION;
            }
        }
        let [mut t, cols, rows] = ranges;
        t.low.iter_mut().for_each(|t| *t -= self.t_moved);
        ([cols, rows], t.low)
    }

    /// Ranges of columns and rows, and the least t.
    ///
    /// For a box well before the eye: about the image of its centre, column or row c, the form of c' - c is
    /// (scaled - c t) / t, whose numerator is small over the whole box. For others [`corners::about_the_eye`].
    #[inline(always)]
    fn perspective<const L: usize>(&self, offsets: &Offsets<L>) -> ([Spans<L>; 2], [f64; L]) {
        let (mut center, mut half) = ([[0.0; L]; 3], [[0.0; L]; 3]);
        for axis in 0..3 {
            for lane in 0..L {
                let (low, high) = (offsets.low[axis][lane], offsets.high[axis][lane]);
                (center[axis][lane], half[axis][lane]) = ((low + high) * 0.5, (high - low) * 0.5);
            }
        }
        let [depth, ref scaled @ ..] = self.forms;
        let (mut least, mut from_middle, mut from_least) = ([0.0; L], [0.0; L], [0.0; L]);
        let mut before = [false; L];
        for lane in 0..L {
            let (center, half) = (point(&center, lane), point(&half, lane));
            let middle = dot(depth, center);
            let error = (dot_abs(depth, center) + dot_abs(depth, half)) * PROJECTION;
            least[lane] = middle - dot_abs(depth, half) - error;
            // NaN is not well before the eye.
            before[lane] = (least[lane] > 0.9375 * middle) & (least[lane] > 16.0 * error);
            (from_middle[lane], from_least[lane]) = (1.0 / middle, 1.0 / least[lane]);
        }
        let mut spans = [Spans::EMPTY; 2];
        for (span, form) in spans.iter_mut().zip(scaled) {
            for lane in 0..L {
                let (center, half) = (point(&center, lane), point(&half, lane));
                let at = dot(*form, center) * from_middle[lane];
                let (mut numerator, mut reach, mut error) = (0.0, 0.0, 0.0);
                for axis in 0..3 {
                    let shifted = form[axis] - at * depth[axis];
                    numerator += shifted * center[axis];
                    reach += shifted.abs() * half[axis];
                    let size = form[axis].abs() + (at * depth[axis]).abs();
                    error += size * (center[axis].abs() + half[axis]);
                }
                let reach =
                    (numerator.abs() + reach + error * PROJECTION) * from_least[lane] * (1.0 + PROJECTION);
                (span.low[lane], span.high[lane]) = (at - reach, at + reach);
            }
        }
        for lane in 0..L {
            if !before[lane] {
                let low = point(&offsets.low, lane);
                let (exact, t) = corners::about_the_eye(&self.forms, low, point(&offsets.high, lane));
                for (span, exact) in spans.iter_mut().zip(exact) {
                    (span.low[lane], span.high[lane]) = (exact.low[0], exact.high[0]);
                }
                least[lane] = t;
            }
        }
        (spans, least)
    }
}

/// First and end of the pixels of 0..n whose centre lies in the span widened by the margin, or of all if it is
/// not known.
#[inline(always)]
fn centres<const L: usize>(span: &Spans<L>, margin: f64, n: u32) -> [[u32; L]; 2] {
    let (mut firsts, mut ends) = ([0; L], [0; L]);
    let count = f64::from(n);
    for lane in 0..L {
        let (low, high) = (span.low[lane] - margin, span.high[lane] + margin);
        let unknown = low.is_nan() | high.is_nan();
        // Conversions of what is not negative round down; `ceil` and `floor` are calls on old machines.
        let low = (low - 0.5).clamp(0.0, count);
        let first = low as u32 + u32::from(low > f64::from(low as u32));
        let end = (high + 0.5).clamp(0.0, count) as u32;
        let none = first >= end;
        firsts[lane] = if unknown | none { 0 } else { first };
        ends[lane] = if unknown {
            n
        } else if none {
            0
        } else {
            end
        };
    }
    [firsts, ends]
}

#[inline(always)]
fn point<const L: usize>(lanes: &[[f64; L]; 3], lane: usize) -> Vector {
    [lanes[0][lane], lanes[1][lane], lanes[2][lane]]
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
