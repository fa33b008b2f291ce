//! Lanes of `f32` at run time: one trait, a portable implementation and one for each
//! instruction set, chosen once per batch of rays.
//!
//! Every operation is a single IEEE operation per lane (no fused multiply-add, no
//! reciprocal estimates), so code written over [`Simd`] gives the same bits at every
//! [`Level`].
//!
//! A [`Task`] and everything it calls down to the lane operations must be
//! `#[inline(always)]`: what stays outside the function that enables the instruction
//! set is compiled without it, and each operation becomes a call. Closures can't be so marked; where
//! they hold lane operations (also inside `map` of an array) they are slow, though right.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "aarch64")]
mod neon;
pub mod path;
mod portable;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod registers;
mod scalar;

pub use portable::Portable;
pub use scalar::Scalar;

#[cfg(target_arch = "x86_64")]
use registers::entered;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use registers::{intrinsic, registers};

use crate::bits::next_lane;
use crate::row::{ROW, Row};
use accel::settings::one_of;

/// Lists of ids, one behind another.
#[derive(Debug)]
pub struct Lists<'a> {
    /// List k from `k·stride` on.
    pub ids: &'a mut [u16],
    /// From one list to the next.
    pub stride: usize,
    /// How many ids each list holds.
    pub lens: &'a mut [u32; ROW],
}

/// Ids that are distributed at once.
pub const SHARE: usize = 32;

/// Asks for the memory of something that is soon to be read, where there is an instruction for it.
#[inline(always)]
pub fn prefetch<T: ?Sized>(what: &T) {
    #[cfg(target_arch = "x86_64")]
    for line in (0..size_of_val(what)).step_by(LINE) {
        let first = std::ptr::from_ref(what).cast::<i8>();
        // SAFETY: SSE, which every x86-64 has, and a hint that reads nothing; the place is within `what`.
        unsafe {
            use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
            _mm_prefetch::<_MM_HINT_T0>(first.add(line));
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = what;
}

/// Bytes that come from memory together.
#[cfg(target_arch = "x86_64")]
const LINE: usize = 64;

/// Proof that an instruction set is present, and its operations.
pub trait Simd: Copy + Send + Sync + 'static {
    /// Number of lanes; divides [`ROW`].
    const LANES: usize;
    /// `LANES` floats.
    type F: Copy;
    /// `LANES` truth values.
    type M: Copy;
    /// `LANES` unsigned integers.
    type U: Copy;

    /// Runs a task as a function of its own, compiled once for all callers: for work that takes much longer than a call.
    #[inline(never)]
    fn apart<T: Task>(self, task: T) -> T::Out {
        task.run(self)
    }

    /// All lanes `v`.
    fn splat(self, v: f32) -> Self::F;
    /// The first `LANES` floats of a slice.
    ///
    /// # Panics
    /// If the slice is shorter.
    fn load(self, from: &[f32]) -> Self::F;
    /// Writes the lanes to the front of a slice.
    ///
    /// # Panics
    /// If the slice is shorter than `LANES`.
    fn store(self, v: Self::F, to: &mut [f32]);
    /// a + b
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    /// a − b
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    /// a · b
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    /// a / b
    fn div(self, a: Self::F, b: Self::F) -> Self::F;
    /// a·b + c, rounded once or twice, whichever is quicker: for what bounds allow for, as instruction sets differ.
    #[inline(always)]
    fn mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F {
        self.add(self.mul(a, b), c)
    }
    /// a·b − c, rounded as [`Simd::mul_add`].
    #[inline(always)]
    fn mul_sub(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F {
        self.sub(self.mul(a, b), c)
    }
    /// √a, correctly rounded; NaN below 0
    fn sqrt(self, a: Self::F) -> Self::F;
    /// |a|
    fn abs(self, a: Self::F) -> Self::F;
    /// The lesser; which of the operands where one is NaN or both are zero is not said.
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
    /// The greater; which of the operands where one is NaN or both are zero is not said.
    fn max(self, a: Self::F, b: Self::F) -> Self::F;
    /// a < b, false on NaN
    fn lt(self, a: Self::F, b: Self::F) -> Self::M;
    /// a ≤ b, false on NaN
    fn le(self, a: Self::F, b: Self::F) -> Self::M;
    /// a = b, false on NaN
    fn eq(self, a: Self::F, b: Self::F) -> Self::M;
    /// Both.
    fn and(self, a: Self::M, b: Self::M) -> Self::M;
    /// Either.
    fn or(self, a: Self::M, b: Self::M) -> Self::M;
    /// Where `m`: a, elsewhere b.
    fn select(self, m: Self::M, a: Self::F, b: Self::F) -> Self::F;
    /// Bit i is lane i.
    fn bits(self, m: Self::M) -> u32;
    /// Lane i is bit i; bits from `LANES` on are ignored.
    fn mask(self, bits: u32) -> Self::M;
    /// All lanes `v`.
    fn splat_u(self, v: u32) -> Self::U;
    /// Where `m`: a, elsewhere b.
    fn select_u(self, m: Self::M, a: Self::U, b: Self::U) -> Self::U;
    /// a < b, unsigned
    fn lt_u(self, a: Self::U, b: Self::U) -> Self::M;
    /// The first `LANES` integers of a slice.
    ///
    /// # Panics
    /// If the slice is shorter.
    fn load_u(self, from: &[u32]) -> Self::U;
    /// Writes the lanes to the front of a slice.
    ///
    /// # Panics
    /// If the slice is shorter than `LANES`.
    fn store_u(self, v: Self::U, to: &mut [u32]);
    /// The first `LANES` short integers of a slice as floats, which is exact.
    ///
    /// # Panics
    /// If the slice is shorter.
    fn load_short(self, from: &[u16]) -> Self::F;

    /// Element i of the result holds element i of each of the first `LANES` places.
    #[inline(always)]
    fn load_quads(self, from: &[&[f32; 4]; ROW]) -> [Self::F; 4] {
        let mut rows = [[0.0; ROW]; 4];
        for (lane, from) in from.iter().enumerate().take(Self::LANES) {
            for (row, value) in rows.iter_mut().zip(*from) {
                row[lane] = *value;
            }
        }
        [self.load(&rows[0]), self.load(&rows[1]), self.load(&rows[2]), self.load(&rows[3])]
    }

    /// The inverse of [`Simd::load_quads`]: place i of the result holds lane i of each, up to `LANES`.
    #[inline(always)]
    fn store_quads(self, from: [Self::F; 4]) -> [[f32; 4]; ROW] {
        let mut rows = [[0.0; ROW]; 4];
        for (row, from) in rows.iter_mut().zip(from) {
            self.store(from, row);
        }
        let mut quads = [[0.0; 4]; ROW];
        for (lane, quad) in quads.iter_mut().enumerate().take(Self::LANES) {
            *quad = [rows[0][lane], rows[1][lane], rows[2][lane], rows[3][lane]];
        }
        quads
    }

    /// The first `LANES` bytes of a slice.
    ///
    /// # Panics
    /// If the slice is shorter.
    #[inline(always)]
    fn load_bytes(self, from: &[u8]) -> Self::U {
        let mut wide = [0; ROW];
        for (wide, byte) in wide.iter_mut().zip(&from[..Self::LANES]) {
            *wide = u32::from(*byte);
        }
        self.load_u(&wide)
    }

    /// The entries of a table of 64, in rows of 16, whose numbers the lanes hold; only their lowest six bits count.
    #[inline(always)]
    fn lookup(self, table: [&Row; 4], at: Self::U) -> Self::F {
        let (mut places, mut found) = ([0; ROW], [0.0; ROW]);
        self.store_u(at, &mut places);
        for (found, place) in found.iter_mut().zip(places).take(Self::LANES) {
            *found = table[place as usize / ROW % 4].0[place as usize % ROW];
        }
        self.load(&found)
    }

    /// The first `LANES` bytes as floats.
    ///
    /// # Panics
    /// If the slice is shorter.
    #[inline(always)]
    fn load_bytes_as_floats(self, from: &[u8]) -> Self::F {
        let mut values = [0.0; ROW];
        for (value, byte) in values.iter_mut().zip(&from[..Self::LANES]) {
            *value = f32::from(*byte);
        }
        self.load(&values)
    }

    /// What a table of bytes holds at these places, each below 64, as floats.
    #[inline(always)]
    fn lookup_bytes(self, table: &[u8; 64], at: Self::U) -> Self::F {
        let (mut places, mut values) = ([0; ROW], [0.0; ROW]);
        self.store_u(at, &mut places);
        for (value, place) in values.iter_mut().zip(places).take(Self::LANES) {
            *value = f32::from(table[place as usize % 64]);
        }
        self.load(&values)
    }

    /// Writes the bytes whose bits are set to the front of `to`; what comes after them is anything.
    #[inline(always)]
    fn compress(self, mut bits: u64, from: &[u8; 64], to: &mut [u8; 64]) {
        for to in to.iter_mut().take(bits.count_ones() as usize) {
            *to = from[bits.trailing_zeros() as usize];
            bits &= bits - 1;
        }
    }

    /// The lanes of `v` whose numbers `at` holds; only their lowest bits count.
    #[inline(always)]
    fn permute(self, v: Self::F, at: Self::U) -> Self::F {
        let (mut places, mut from, mut found) = ([0; ROW], [0.0; ROW], [0.0; ROW]);
        self.store_u(at, &mut places);
        self.store(v, &mut from);
        for (found, place) in found.iter_mut().zip(places).take(Self::LANES) {
            *found = from[place as usize % Self::LANES];
        }
        self.load(&found)
    }

    /// Writes the numbers of the bits that are set, lowest first, to the front of `to`, and tells how many they are. What
    /// comes after them in `to` may change as well.
    #[inline(always)]
    fn set_bits(self, mut bits: u64, to: &mut [u8; 64]) -> usize {
        let count = bits.count_ones() as usize;
        for to in &mut to[..count] {
            *to = bits.trailing_zeros() as u8;
            bits &= bits - 1;
        }
        count
    }

    /// Appends each of the ids to the lists whose bits are set in its marks. What comes after a list may change as well.
    ///
    /// # Panics
    /// If a list has no room for [`SHARE`] more.
    #[inline(always)]
    fn distribute(self, ids: &[u16; SHARE], marks: &[u16; SHARE], lists: &mut Lists) {
        for (id, marks) in ids.iter().zip(marks) {
            let mut marks = u32::from(*marks);
            while let Some(list) = next_lane(&mut marks) {
                lists.ids[list * lists.stride + lists.lens[list] as usize] = *id;
                lists.lens[list] += 1;
            }
        }
    }

    /// The bits that a path through three maps meets; see [`path::Path`].
    #[inline(always)]
    fn path_union(self, maps: [&[u64; path::SLICES]; 3], path: &path::Path) -> u64 {
        path::union(maps, path)
    }

    /// [`Simd::path_union`] of two of the paths, each through maps of its own.
    #[inline(always)]
    fn path_unions(
        self,
        maps: [[&[u64; path::SLICES]; 3]; 2],
        paths: &path::PathRows,
        lanes: [usize; 2],
    ) -> [u64; 2] {
        [0, 1].map(|i| self.path_union(maps[i], &paths.path(lanes[i])))
    }

    /// The bits that a hull through three maps touches; see [`path::Hull`].
    #[inline(always)]
    fn hull_union(self, maps: [&[u64; path::SLICES]; 3], hull: &path::Hull) -> u64 {
        path::hull_union(maps, hull)
    }

    /// The least lane, of numbers.
    #[inline(always)]
    fn least(self, v: Self::F) -> f32 {
        let lanes = stored(self, v, f32::INFINITY);
        lanes.iter().fold(f32::INFINITY, |least, lane| if *lane < least { *lane } else { least })
    }

    /// The greatest lane, of numbers.
    #[inline(always)]
    fn most(self, v: Self::F) -> f32 {
        let lanes = stored(self, v, f32::NEG_INFINITY);
        lanes.iter().fold(f32::NEG_INFINITY, |most, lane| if *lane > most { *lane } else { most })
    }
}

/// The lanes, with `beyond` behind them.
#[inline(always)]
fn stored<S: Simd>(s: S, v: S::F, beyond: f32) -> [f32; ROW] {
    let mut lanes = [beyond; ROW];
    s.store(v, &mut lanes);
    lanes
}

/// Work that is compiled once for each instruction set.
pub trait Task {
    /// What it computes.
    type Out;
    /// Does the work. Must be `#[inline(always)]`.
    fn run<S: Simd>(self, s: S) -> Self::Out;
}

/// An instruction set that may be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Level {
    /// Plain Rust, on every machine.
    Portable,
    /// x86-64 with AVX2, BMI1, BMI2, LZCNT and POPCNT.
    Avx2,
    /// x86-64 with all of that and AVX-512 F, BW, DQ, VL, VBMI and VBMI2: Intel's processors since Ice Lake, AMD's since Zen 4.
    Avx512,
    /// aarch64, where it is always present.
    Neon,
}

impl Level {
    /// All levels there are, narrowest first.
    pub const ALL: [Self; 4] = [Self::Portable, Self::Neon, Self::Avx2, Self::Avx512];

    /// Name as used in settings and records.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
            Self::Neon => "neon",
        }
    }

    /// The level of that name.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|level| level.id() == id)
    }

    /// A setting's value: the level of that name, if this machine has it.
    ///
    /// # Errors
    /// There is none of that name here; the text says which there are.
    pub fn parse(value: &str) -> Result<Self, String> {
        one_of(value, Self::here(), |level| level.id())
    }

    /// Whether this machine has it.
    pub fn available(self) -> bool {
        match self {
            Self::Portable => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => avx2::present(),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => avx512::present(),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => true,
            #[allow(unreachable_patterns)]
            _ => false,
        }
    }

    /// The levels of this machine, narrowest first.
    pub fn here() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|level| level.available())
    }

    /// The widest level of this machine.
    pub fn best() -> Self {
        Self::here().last().unwrap_or(Self::Portable)
    }

    /// Runs `task` at this level; where the machine lacks it, portably.
    #[inline]
    pub fn run<T: Task>(self, task: T) -> T::Out {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 if self.available() => avx512::run(task),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 if self.available() => avx2::run(task),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => neon::run(task),
            _ => task.run(Portable),
        }
    }
}

#[cfg(test)]
mod tests;
