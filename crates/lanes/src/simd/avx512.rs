//! Sixteen lanes of AVX-512.

use super::path::{Path, SLICES};
use super::{Simd, Task};
use accel::tolerance::TRIM;
use std::arch::x86_64::*;

/// Proof that AVX-512 F, BW, DQ and VL are present: only [`run`] makes one.
#[derive(Clone, Copy, Debug)]
pub struct Avx512(());

/// Runs `task` with AVX-512.
///
/// The caller has checked `Level::Avx512.available()`.
pub(super) fn run<T: Task>(task: T) -> T::Out {
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt")]
    fn inner<T: Task>(task: T) -> T::Out {
        task.run(Avx512(()))
    }
    // SAFETY: `Level::run` calls this only where the features were detected; every
    // processor with AVX-512 VL has AVX2, BMI, LZCNT and POPCNT.
    unsafe { inner(task) }
}

/// Wraps intrinsics without preconditions but their instruction set.
macro_rules! intrinsic {
    ($e:expr) => {
        // SAFETY: the token `Avx512` exists only where the features were detected, and
        // the intrinsic touches no memory.
        unsafe { $e }
    };
}

impl Simd for Avx512 {
    const LANES: usize = 16;
    type F = __m512;
    type M = __mmask16;
    type U = __m512i;

    #[inline(always)]
    fn splat(self, v: f32) -> Self::F {
        intrinsic!(_mm512_set1_ps(v))
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> Self::F {
        let from = &from[..16];
        // SAFETY: the token proves the features; the slice has 16 floats.
        unsafe { _mm512_loadu_ps(from.as_ptr()) }
    }
    #[inline(always)]
    fn store(self, v: Self::F, to: &mut [f32]) {
        let to = &mut to[..16];
        // SAFETY: the token proves the features; the slice has 16 floats.
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), v) }
    }
    #[inline(always)]
    fn add(self, a: Self::F, b: Self::F) -> Self::F {
        intrinsic!(_mm512_add_ps(a, b))
    }
    #[inline(always)]
    fn sub(self, a: Self::F, b: Self::F) -> Self::F {
        intrinsic!(_mm512_sub_ps(a, b))
    }
    #[inline(always)]
    fn mul(self, a: Self::F, b: Self::F) -> Self::F {
        intrinsic!(_mm512_mul_ps(a, b))
    }
    #[inline(always)]
    fn div(self, a: Self::F, b: Self::F) -> Self::F {
        intrinsic!(_mm512_div_ps(a, b))
    }
    #[inline(always)]
    fn abs(self, a: Self::F) -> Self::F {
        intrinsic!(_mm512_abs_ps(a))
    }
    #[inline(always)]
    fn min(self, a: Self::F, b: Self::F) -> Self::F {
        intrinsic!(_mm512_min_ps(a, b))
    }
    #[inline(always)]
    fn max(self, a: Self::F, b: Self::F) -> Self::F {
        intrinsic!(_mm512_max_ps(a, b))
    }
    #[inline(always)]
    fn lt(self, a: Self::F, b: Self::F) -> Self::M {
        intrinsic!(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b))
    }
    #[inline(always)]
    fn le(self, a: Self::F, b: Self::F) -> Self::M {
        intrinsic!(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b))
    }
    #[inline(always)]
    fn eq(self, a: Self::F, b: Self::F) -> Self::M {
        intrinsic!(_mm512_cmp_ps_mask::<_CMP_EQ_OQ>(a, b))
    }
    #[inline(always)]
    fn and(self, a: Self::M, b: Self::M) -> Self::M {
        a & b
    }
    #[inline(always)]
    fn or(self, a: Self::M, b: Self::M) -> Self::M {
        a | b
    }
    #[inline(always)]
    fn select(self, m: Self::M, a: Self::F, b: Self::F) -> Self::F {
        intrinsic!(_mm512_mask_blend_ps(m, b, a))
    }
    #[inline(always)]
    fn bits(self, m: Self::M) -> u32 {
        u32::from(m)
    }
    #[inline(always)]
    fn mask(self, bits: u32) -> Self::M {
        bits as u16
    }
    #[inline(always)]
    fn splat_u(self, v: u32) -> Self::U {
        intrinsic!(_mm512_set1_epi32(v.cast_signed()))
    }
    #[inline(always)]
    fn select_u(self, m: Self::M, a: Self::U, b: Self::U) -> Self::U {
        intrinsic!(_mm512_mask_blend_epi32(m, b, a))
    }
    #[inline(always)]
    fn lt_u(self, a: Self::U, b: Self::U) -> Self::M {
        intrinsic!(_mm512_cmplt_epu32_mask(a, b))
    }
    #[inline(always)]
    fn load_u(self, from: &[u32]) -> Self::U {
        let from = &from[..16];
        // SAFETY: the token proves the features; the slice has 16 integers.
        unsafe { _mm512_loadu_epi32(from.as_ptr().cast()) }
    }
    #[inline(always)]
    fn load_short(self, from: &[u16]) -> Self::F {
        let from = &from[..16];
        // SAFETY: the token proves the features; the slice has 16 short integers.
        unsafe { _mm512_cvtepi32_ps(_mm512_cvtepu16_epi32(_mm256_loadu_si256(from.as_ptr().cast()))) }
    }
    #[inline(always)]
    fn store_u(self, v: Self::U, to: &mut [u32]) {
        let to = &mut to[..16];
        // SAFETY: the token proves the features; the slice has 16 integers.
        unsafe { _mm512_storeu_epi32(to.as_mut_ptr().cast(), v) }
    }

    /// All eight steps at once: words are looked up by permuting a register.
    #[inline(always)]
    fn path_union(self, maps: [&[u64; SLICES]; 3], path: &Path) -> u64 {
        // SAFETY: the token proves the features; each map has the eight words that are loaded.
        unsafe {
            let word = |map: &[u64; SLICES]| _mm512_loadu_epi64(map.as_ptr().cast());
            let [a, b, c] = [word(maps[0]), word(maps[1]), word(maps[2])];
            let slice = _mm256_setr_ps(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0);
            let next = _mm256_setr_ps(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0);
            let (low, high) = (_mm256_set1_ps(path.low), _mm256_set1_ps(path.high));
            let left = _mm256_sub_ps(_mm256_max_ps(slice, low), low);
            let right = _mm256_sub_ps(_mm256_min_ps(next, high), low);
            let b = touched(b, left, right, path.start[0], path.slope[0]);
            let c = touched(c, left, right, path.start[1], path.slope[1]);
            let in_reach = _mm256_set1_ps((SLICES - 1) as f32);
            let begun = _mm256_cmp_ps_mask::<_CMP_GT_OQ>(next, _mm256_min_ps(low, in_reach));
            let not_over = _mm256_cmp_ps_mask::<_CMP_LE_OQ>(slice, _mm256_max_ps(high, _mm256_setzero_ps()));
            let met = _mm512_maskz_and_epi64(begun & not_over, a, _mm512_and_epi64(b, c));
            _mm512_reduce_or_epi64(met).cast_unsigned()
        }
    }
}

/// The words of the slices between two positions in each of eight steps.
///
/// # Safety
/// The processor has AVX-512 F and VL.
#[inline(always)]
unsafe fn touched(map: __m512i, left: __m256, right: __m256, start: f32, slope: f32) -> __m512i {
    // SAFETY: the caller vouches for the instruction set; no memory is touched.
    unsafe {
        let (start, slope) = (_mm256_set1_ps(start), _mm256_set1_ps(slope));
        let p = _mm256_add_ps(start, _mm256_mul_ps(slope, left));
        let q = _mm256_add_ps(start, _mm256_mul_ps(slope, right));
        let near = lookup(map, _mm256_min_ps(p, q));
        let far = lookup(map, _mm256_sub_ps(_mm256_max_ps(p, q), _mm256_set1_ps(TRIM)));
        _mm512_or_epi64(near, far)
    }
}

/// The words of the slices of eight positions.
///
/// # Safety
/// The processor has AVX-512 F and VL.
#[inline(always)]
unsafe fn lookup(map: __m512i, position: __m256) -> __m512i {
    // SAFETY: the caller vouches for the instruction set; no memory is touched.
    unsafe {
        let last = _mm256_set1_ps((SLICES - 1) as f32);
        let inside = _mm256_min_ps(_mm256_max_ps(position, _mm256_setzero_ps()), last);
        let index = _mm512_cvtepi32_epi64(_mm256_cvttps_epi32(inside));
        _mm512_permutexvar_epi64(index, map)
    }
}
