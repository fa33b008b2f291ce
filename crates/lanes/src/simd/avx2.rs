//! Eight lanes of AVX2.

use super::{Simd, Task, entered, intrinsic, registers};
use std::arch::x86_64::*;

/// Proof that AVX2 is present: only [`run`] makes one.
#[derive(Clone, Copy, Debug)]
pub struct Avx2(());

// Virtual machines may hide some of it, and LZCNT, hidden, counts wrongly instead of failing.
entered!(Avx2, "avx2" "bmi1" "bmi2" "lzcnt" "popcnt");

impl Simd for Avx2 {
    registers! {
        8 of __m256, __m256, __m256i;
        splat _mm256_set1_ps; load _mm256_loadu_ps; store _mm256_storeu_ps;
        integers load _mm256_loadu_si256; store _mm256_storeu_si256;
        roots _mm256_sqrt_ps;
        floats add = _mm256_add_ps, sub = _mm256_sub_ps, mul = _mm256_mul_ps, div = _mm256_div_ps, min = _mm256_min_ps, max = _mm256_max_ps;
        comparisons lt = _mm256_cmp_ps::<_CMP_LT_OQ>, le = _mm256_cmp_ps::<_CMP_LE_OQ>, eq = _mm256_cmp_ps::<_CMP_EQ_OQ>;
        masks and = _mm256_and_ps, or = _mm256_or_ps;
    }

    #[inline(always)]
    fn apart<T: Task>(self, task: T) -> T::Out {
        self.enter(task)
    }

    #[inline(always)]
    fn abs(self, a: Self::F) -> Self::F {
        intrinsic!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), a))
    }
    #[inline(always)]
    fn select(self, m: Self::M, a: Self::F, b: Self::F) -> Self::F {
        intrinsic!(_mm256_blendv_ps(b, a, m))
    }
    #[inline(always)]
    fn bits(self, m: Self::M) -> u32 {
        intrinsic!(_mm256_movemask_ps(m)).cast_unsigned()
    }
    #[inline(always)]
    fn mask(self, bits: u32) -> Self::M {
        intrinsic!({
            let lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let all = _mm256_set1_epi32(bits.cast_signed());
            _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(all, lane), lane))
        })
    }
    #[inline(always)]
    fn splat_u(self, v: u32) -> Self::U {
        intrinsic!(_mm256_set1_epi32(v.cast_signed()))
    }
    #[inline(always)]
    fn select_u(self, m: Self::M, a: Self::U, b: Self::U) -> Self::U {
        intrinsic!(_mm256_castps_si256(_mm256_blendv_ps(_mm256_castsi256_ps(b), _mm256_castsi256_ps(a), m)))
    }
    #[inline(always)]
    fn lt_u(self, a: Self::U, b: Self::U) -> Self::M {
        // AVX2 compares signed integers only; moving both by 2³¹ keeps the order.
        intrinsic!({
            let half = _mm256_set1_epi32(i32::MIN);
            _mm256_castsi256_ps(_mm256_cmpgt_epi32(_mm256_xor_si256(b, half), _mm256_xor_si256(a, half)))
        })
    }
    #[inline(always)]
    fn load_bytes_as_floats(self, from: &[u8]) -> Self::F {
        let from = &from[..8];
        // SAFETY: the token proves the feature; the slice has 8 bytes.
        unsafe { _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64(from.as_ptr().cast()))) }
    }
    #[inline(always)]
    fn load_short(self, from: &[u16]) -> Self::F {
        let from = &from[..8];
        // SAFETY: the token proves the feature; the slice has 8 short integers.
        unsafe { _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(_mm_loadu_si128(from.as_ptr().cast()))) }
    }
}
