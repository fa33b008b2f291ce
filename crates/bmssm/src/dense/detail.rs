//! Detail tests of the objects whose bits are set in a word.

use accel::{Nearest, Objects, Ray};
use lanes::{Blocks, Level, Portable, Simd, Task};

/// A way from a word of candidates to hits.
pub trait Detail: Send + Sync {
    /// A prepared ray.
    type Ray: Copy;

    /// Runs a task that makes such tests, at `level` if they are made in lanes.
    fn run<T: Task>(&self, level: Level, task: T) -> T::Out;

    /// Prepares a ray.
    fn ray(&self, ray: &Ray) -> Self::Ray;

    /// Tests the objects of word `index` whose bits are set.
    fn closest<S: Simd>(&self, s: S, index: usize, word: u64, ray: &Self::Ray, best: &mut Nearest);

    /// Whether any of them is hit at t in the ray's range.
    fn any<S: Simd>(&self, s: S, index: usize, word: u64, ray: &Self::Ray, t_max: f32) -> bool;

    /// Decides what tests left open.
    #[inline(always)]
    fn resolve(&self, ray: &Self::Ray, best: &mut Nearest) {
        let _ = (ray, best);
    }

    /// Bytes of copied geometry.
    fn bytes(&self) -> usize;
}

/// The loop of the appendix: words of 32 bits, shifted out one at a time.
pub struct Appendix<O>(pub O);

impl<O: Objects> Appendix<O> {
    /// Calls `test` with each candidate until it says to stop.
    #[inline(always)]
    fn visit(index: usize, word: u64, mut test: impl FnMut(u32) -> bool) {
        for (half, mask) in [word as u32, (word >> 32) as u32].into_iter().enumerate() {
            let mut mask = mask;
            let mut object = (index * 64 + half * 32) as u32;
            while mask != 0 {
                if mask & 1 != 0 && !test(object) {
                    return;
                }
                mask >>= 1;
                object += 1;
            }
        }
    }
}

impl<O: Objects> Detail for Appendix<O> {
    type Ray = Ray;

    fn run<T: Task>(&self, _: Level, task: T) -> T::Out {
        task.run(Portable)
    }

    #[inline(always)]
    fn ray(&self, ray: &Ray) -> Ray {
        *ray
    }

    #[inline(always)]
    fn closest<S: Simd>(&self, _: S, index: usize, word: u64, ray: &Ray, best: &mut Nearest) {
        Self::visit(index, word, |object| {
            self.0.closest(object, ray, best);
            true
        });
    }

    #[inline(always)]
    fn any<S: Simd>(&self, _: S, index: usize, word: u64, ray: &Ray, t_max: f32) -> bool {
        let mut any = false;
        Self::visit(index, word, |object| {
            any = self.0.intersect(object, ray, t_max).is_some();
            !any
        });
        any
    }

    fn bytes(&self) -> usize {
        0
    }
}

/// Words of 64 bits, handed whole to objects packed in blocks of 64.
pub struct Words<B>(pub B);

impl<B: Blocks> Detail for Words<B> {
    type Ray = B::One;

    fn run<T: Task>(&self, level: Level, task: T) -> T::Out {
        level.run(task)
    }

    #[inline(always)]
    fn ray(&self, ray: &Ray) -> B::One {
        self.0.one(ray)
    }

    #[inline(always)]
    fn closest<S: Simd>(&self, s: S, index: usize, word: u64, ray: &B::One, best: &mut Nearest) {
        self.0.closest(s, index, word, ray, best);
    }

    #[inline(always)]
    fn resolve(&self, ray: &B::One, best: &mut Nearest) {
        self.0.resolve(ray, best);
    }

    #[inline(always)]
    fn any<S: Simd>(&self, s: S, index: usize, word: u64, ray: &B::One, t_max: f32) -> bool {
        self.0.any(s, index, word, ray, t_max)
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}
