//! Solids given by implicit functions.

use crate::interval::{Interval, Slope};
use crate::local::Local;
use crate::{Crossing, Crossings};
use accel::solid::{Arithmetic, Implicit, Shape};
use accel::{Ray, Surface};
use glam::DVec3;

/// Roots farther apart than this part of the ray's way through the box are told apart; nearer ones are where F changes its sign
/// over such a step, or are none where it doesn't.
pub const WIDTH: f64 = 1.0 / (1u64 << 32) as f64;

/// Steps after which what is left of a ray is told by the signs at its ends: only rays that lie in the surface take so many.
const MAX: usize = 1 << 16;

/// F along a line, with t from 0 at the beginning of its way through the box to 1 at its end.
struct Along<'a> {
    solid: &'a Implicit,
    origin: DVec3,
    delta: DVec3,
}

impl Along<'_> {
    fn value(&self, s: f64) -> f64 {
        self.solid.function.value((self.origin + self.delta * s).to_array())
    }

    /// Whether it is inside at a place: there F's sign is that of its computed value, wherever it is asked for again.
    fn is_inside(&self, s: f64) -> bool {
        self.value(s) < 0.0
    }

    fn at(&self, s: Interval) -> [Interval; 3] {
        [0, 1, 2].map(|i| Interval::point(self.delta[i]).mul(s).add(Interval::point(self.origin[i])))
    }

    /// What F and its derivative can be from one place to another: the lesser of what interval arithmetic says of F and of what
    /// its derivative allows from the middle on, which is the sharper one over short ways.
    fn range(&self, s: Interval) -> Slope {
        let place = self.at(s);
        let seeds = [0, 1, 2].map(|i| Slope { value: place[i], slope: Interval::point(self.delta[i]) });
        let Slope { value, slope } = self.solid.function.value(seeds);
        if !value.holds_zero() {
            return Slope { value, slope };
        }
        let middle = 0.5 * (s.low + s.high);
        let from = self.solid.function.value(self.at(Interval::point(middle)));
        let centered = slope.mul(s.sub(Interval::point(middle))).add(from);
        Slope { value: value.within(centered), slope }
    }

    /// Whether F is so close to 0 all along that its rounding hides its sign: the line lies in the surface.
    fn is_hidden(&self, s: Interval, range: Interval) -> bool {
        let here = self.solid.function.value(self.at(Interval::point(0.5 * (s.low + s.high))));
        here.holds_zero() && range.width() <= 4.0 * here.width()
    }

    /// Where the sign changes between two places of different signs, to the last digits: by the secant through both ends, or the
    /// middle where that doesn't shorten the way.
    fn root(&self, s: Interval, inside: bool) -> f64 {
        let Interval { mut low, mut high } = s;
        let (mut at_low, mut at_high) = (self.value(low), self.value(high));
        for step in 0..200 {
            let width = high - low;
            if width <= 2.0 * f64::EPSILON * high.abs().max(f64::MIN_POSITIVE) {
                break;
            }
            let secant = low - at_low * (width / (at_high - at_low));
            // A little beyond the secant's root, so that both ends close in.
            let aside = if step % 2 == 0 { 1e-3 * width } else { 0.0 };
            let aside = if (secant - low) < (high - secant) { aside } else { -aside };
            let guess = secant + aside;
            let middle = 0.5 * (low + high);
            let guess = if step % 3 != 2 && guess > low && guess < high { guess } else { middle };
            if !(guess > low && guess < high) {
                break;
            }
            let value = self.value(guess);
            if (value < 0.0) == inside {
                (low, at_low) = (guess, value);
            } else {
                (high, at_high) = (guess, value);
            }
        }
        high
    }

    /// Calls `found` with each change of sign in `wanted`, or a little beside, in order, until it says that it has enough.
    ///
    /// Halves of the way in which F can't be 0 are passed over; where it can't turn, the signs at both ends tell whether there is
    /// one root or none (A. Knoll et al. 2009, "Fast Ray Tracing of Arbitrary Implicit Surfaces with Interval and Affine Arithmetic",
    /// Computer Graphics Forum 28(1); D. Mitchell 1990, "Robust Ray Intersection with Interval Arithmetic"). So none is stepped
    /// over that is farther than [`WIDTH`] from the next. A part's signs are those at its ends, whatever is asked for, so that
    /// changes come in pairs and a root doesn't depend on the range.
    fn changes(&self, ends: [bool; 2], wanted: Interval, mut found: impl FnMut(f64, bool) -> bool) {
        let mut waiting = vec![Part { s: Interval::new(0.0, 1.0), ends }];
        let mut steps = 0;
        while let Some(Part { s, ends }) = waiting.pop() {
            if s.high < wanted.low || s.low > wanted.high {
                continue;
            }
            steps += 1;
            let Slope { value, slope } = self.range(s);
            let told = !value.holds_zero()
                || s.width() <= WIDTH
                || !slope.holds_zero()
                || steps > MAX
                || self.is_hidden(s, value);
            if told {
                if ends[0] != ends[1] && found(self.root(s, ends[0]), ends[1]) {
                    return;
                }
                continue;
            }
            let middle = 0.5 * (s.low + s.high);
            let inside = self.is_inside(middle);
            waiting.push(Part { s: Interval::new(middle, s.high), ends: [inside, ends[1]] });
            waiting.push(Part { s: Interval::new(s.low, middle), ends: [ends[0], inside] });
        }
    }
}

/// A part of the way, and whether its ends are inside.
struct Part {
    s: Interval,
    ends: [bool; 2],
}

/// By which part of t, and of the numbers that it comes from, the range that is searched is wider than the ray's.
const SLACK: f64 = 1e-6;

/// Calls `found` with each crossing in the ray's range up to `t_max`, in order, until it says that it has enough.
fn each(solid: &Implicit, ray: &Ray, t_max: f32, mut found: impl FnMut(Crossing) -> bool) {
    let Some(line) = Local::of(&solid.bounds(), DVec3::ZERO, ray) else { return };
    let Local { near, far, moved, .. } = line;
    let (offset, factor) = solid.frame();
    let along = Along {
        solid,
        origin: (line.origin + line.direction * near - offset) * factor,
        delta: line.direction * (far - near) * factor,
    };
    let place = |t: f32, side: f64| {
        let t = f64::from(t);
        let s = (t - moved - near + side * SLACK * (t.abs() + moved.abs() + near.abs())) / (far - near);
        if s.is_nan() { f64::INFINITY * side } else { s }
    };
    let wanted = Interval::new(place(ray.t_min, -1.0), place(t_max, 1.0));
    let ends = [along.is_inside(0.0), along.is_inside(1.0)];
    let mut offer = |t: f64, enters: bool| {
        let crossing = Crossing::at(moved + t, enters);
        crossing.within(ray, t_max) && found(crossing)
    };
    if ends[0] && offer(near, true) {
        return;
    }
    let mut enough = false;
    along.changes(ends, wanted, |s, enters| {
        enough = offer(near + s * (far - near), enters);
        enough
    });
    if !enough && ends[1] {
        offer(far, false);
    }
}

impl Crossings for Implicit {
    fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        each(self, ray, ray.t_max, |crossing| {
            out.push(crossing);
            false
        });
    }

    fn nearest(&self, ray: &Ray, t_max: f32) -> Option<Surface> {
        let mut nearest = None;
        each(self, ray, t_max, |crossing| {
            nearest = Some(crossing.surface());
            true
        });
        nearest
    }
}

#[cfg(test)]
mod tests;
