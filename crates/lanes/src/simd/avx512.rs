//! Sixteen lanes of AVX-512.

use super::path::{BESIDE, Hull, Path, PathRows, SLICES};
use super::{Lists, SHARE, Simd, Task, entered, intrinsic, registers};
use crate::row::{ROW, Row};
use accel::tolerance::TRIM;
use std::arch::x86_64::*;

/// Proof that AVX-512 F, BW, DQ, VL, VBMI and VBMI2 are present: only [`run`] makes one.
#[derive(Clone, Copy, Debug)]
pub struct Avx512(());

entered!(
    Avx512,
    "avx512f" "avx512bw" "avx512dq" "avx512vl" "avx512vbmi" "avx512vbmi2" "avx2" "bmi1" "bmi2" "lzcnt" "popcnt"
);

impl Simd for Avx512 {
    registers! {
        16 of __m512, __mmask16, __m512i;
        splat _mm512_set1_ps; load _mm512_loadu_ps; store _mm512_storeu_ps;
        integers load _mm512_loadu_epi32; store _mm512_storeu_epi32;
        roots _mm512_sqrt_ps;
        floats add = _mm512_add_ps, sub = _mm512_sub_ps, mul = _mm512_mul_ps, div = _mm512_div_ps, min = _mm512_min_ps, max = _mm512_max_ps;
        comparisons lt = _mm512_cmp_ps_mask::<_CMP_LT_OQ>, le = _mm512_cmp_ps_mask::<_CMP_LE_OQ>, eq = _mm512_cmp_ps_mask::<_CMP_EQ_OQ>;
        masks and = _kand_mask16, or = _kor_mask16;
    }

    #[inline(always)]
    fn apart<T: Task>(self, task: T) -> T::Out {
        self.enter(task)
    }

    #[inline(always)]
    fn mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F {
        intrinsic!(_mm512_fmadd_ps(a, b, c))
    }
    #[inline(always)]
    fn mul_sub(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F {
        intrinsic!(_mm512_fmsub_ps(a, b, c))
    }
    #[inline(always)]
    fn abs(self, a: Self::F) -> Self::F {
        intrinsic!(_mm512_abs_ps(a))
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
    fn load_short(self, from: &[u16]) -> Self::F {
        let from = &from[..16];
        // SAFETY: the token proves the features; the slice has 16 short integers.
        unsafe { _mm512_cvtepi32_ps(_mm512_cvtepu16_epi32(_mm256_loadu_si256(from.as_ptr().cast()))) }
    }

    #[inline(always)]
    fn load_quads(self, from: &[&[f32; 4]; ROW]) -> [Self::F; 4] {
        // SAFETY: the token proves the features; each place has four floats.
        unsafe {
            let mut rows = [_mm512_setzero_ps(); 4];
            for (i, row) in rows.iter_mut().enumerate() {
                let mut quads = [_mm_setzero_ps(); 4];
                for (k, quad) in quads.iter_mut().enumerate() {
                    *quad = _mm_loadu_ps(from[i + 4 * k].as_ptr());
                }
                let low = _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(quads[0]), quads[1]);
                let high = _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(quads[2]), quads[3]);
                *row = _mm512_insertf32x8::<1>(_mm512_castps256_ps512(low), high);
            }
            let [a, b, c, d] = rows;
            let ab = [_mm512_unpacklo_ps(a, b), _mm512_unpackhi_ps(a, b)];
            let cd = [_mm512_unpacklo_ps(c, d), _mm512_unpackhi_ps(c, d)];
            let mut columns = [a; 4];
            for half in 0..2 {
                let (ab, cd) = (_mm512_castps_pd(ab[half]), _mm512_castps_pd(cd[half]));
                columns[2 * half] = _mm512_castpd_ps(_mm512_unpacklo_pd(ab, cd));
                columns[2 * half + 1] = _mm512_castpd_ps(_mm512_unpackhi_pd(ab, cd));
            }
            columns
        }
    }
    #[inline(always)]
    fn store_quads(self, [a, b, c, d]: [Self::F; 4]) -> [[f32; 4]; ROW] {
        let mut quads = [[0.0; 4]; ROW];
        // SAFETY: the token proves the features; each place has four floats.
        unsafe {
            let ab = [_mm512_unpacklo_ps(a, b), _mm512_unpackhi_ps(a, b)];
            let cd = [_mm512_unpacklo_ps(c, d), _mm512_unpackhi_ps(c, d)];
            for i in 0..4 {
                let (ab, cd) = (_mm512_castps_pd(ab[i / 2]), _mm512_castps_pd(cd[i / 2]));
                let row = if i % 2 == 0 { _mm512_unpacklo_pd(ab, cd) } else { _mm512_unpackhi_pd(ab, cd) };
                let row = _mm512_castpd_ps(row);
                _mm_storeu_ps(quads[i].as_mut_ptr(), _mm512_extractf32x4_ps::<0>(row));
                _mm_storeu_ps(quads[i + 4].as_mut_ptr(), _mm512_extractf32x4_ps::<1>(row));
                _mm_storeu_ps(quads[i + 8].as_mut_ptr(), _mm512_extractf32x4_ps::<2>(row));
                _mm_storeu_ps(quads[i + 12].as_mut_ptr(), _mm512_extractf32x4_ps::<3>(row));
            }
        }
        quads
    }
    #[inline(always)]
    fn load_bytes(self, from: &[u8]) -> Self::U {
        let from = &from[..16];
        // SAFETY: the token proves the features; the slice has 16 bytes.
        unsafe { _mm512_cvtepu8_epi32(_mm_loadu_si128(from.as_ptr().cast())) }
    }
    #[inline(always)]
    fn lookup(self, table: [&Row; 4], at: Self::U) -> Self::F {
        let [a, b, c, d] =
            [self.load(&table[0].0), self.load(&table[1].0), self.load(&table[2].0), self.load(&table[3].0)];
        intrinsic!({
            let upper = _mm512_test_epi32_mask(at, _mm512_set1_epi32(32));
            let (low, high) = (_mm512_permutex2var_ps(a, at, b), _mm512_permutex2var_ps(c, at, d));
            _mm512_mask_blend_ps(upper, low, high)
        })
    }
    #[inline(always)]
    fn load_bytes_as_floats(self, from: &[u8]) -> Self::F {
        let from = &from[..16];
        // SAFETY: the token proves the features; the slice has 16 bytes.
        unsafe { _mm512_cvtepi32_ps(_mm512_cvtepu8_epi32(_mm_loadu_si128(from.as_ptr().cast()))) }
    }
    #[inline(always)]
    fn lookup_bytes(self, table: &[u8; 64], at: Self::U) -> Self::F {
        const LOWEST: u64 = 0x1111_1111_1111_1111;
        // SAFETY: the token proves the features; the table has 64 bytes.
        unsafe {
            let table = _mm512_loadu_epi8(table.as_ptr().cast());
            _mm512_cvtepi32_ps(_mm512_maskz_permutexvar_epi8(LOWEST, at, table))
        }
    }
    #[inline(always)]
    fn compress(self, bits: u64, from: &[u8; 64], to: &mut [u8; 64]) {
        // SAFETY: the token proves the features; both arrays have 64 bytes.
        unsafe {
            let from = _mm512_loadu_epi8(from.as_ptr().cast());
            _mm512_storeu_epi8(to.as_mut_ptr().cast(), _mm512_maskz_compress_epi8(bits, from));
        }
    }
    #[inline(always)]
    fn permute(self, v: Self::F, at: Self::U) -> Self::F {
        intrinsic!(_mm512_permutexvar_ps(at, v))
    }
    #[inline(always)]
    fn set_bits(self, bits: u64, to: &mut [u8; 64]) -> usize {
        const NUMBERS: [u8; 64] = {
            let mut numbers = [0; 64];
            let mut i = 0;
            while i < 64 {
                numbers[i] = i as u8;
                i += 1;
            }
            numbers
        };
        // SAFETY: the token proves the features; both arrays have 64 bytes.
        unsafe {
            let numbers = _mm512_loadu_epi8(NUMBERS.as_ptr().cast());
            _mm512_storeu_epi8(to.as_mut_ptr().cast(), _mm512_maskz_compress_epi8(bits, numbers));
        }
        bits.count_ones() as usize
    }
    #[inline(always)]
    fn distribute(self, ids: &[u16; SHARE], marks: &[u16; SHARE], lists: &mut Lists) {
        let Lists { ids: lists, stride, lens } = lists;
        // SAFETY: the token proves the features; both arrays have 32 integers.
        let (ids, marks) =
            unsafe { (_mm512_loadu_epi16(ids.as_ptr().cast()), _mm512_loadu_epi16(marks.as_ptr().cast())) };
        for (list, len) in lens.iter_mut().enumerate() {
            let first = list * *stride + *len as usize;
            let to = &mut lists[first..first + SHARE];
            // SAFETY: the token proves the features; the slice has 32 integers.
            unsafe {
                let marked = _mm512_test_epi16_mask(marks, _mm512_set1_epi16((1u16 << list).cast_signed()));
                _mm512_storeu_epi16(to.as_mut_ptr().cast(), _mm512_maskz_compress_epi16(marked, ids));
                *len += marked.count_ones();
            }
        }
    }

    /// All eight steps at once: words are looked up by permuting a register.
    #[inline(always)]
    fn path_union(self, maps: [&[u64; SLICES]; 3], path: &Path) -> u64 {
        // SAFETY: the token proves the features; each map has the eight words that are loaded.
        unsafe {
            let Steps { words: [a, b, c], slice, next, low, high, left, right } =
                steps(maps, path.low, path.high);
            let b = touched(b, left, right, path.start[0], path.slope[0]);
            let c = touched(c, left, right, path.start[1], path.slope[1]);
            let in_reach = _mm256_set1_ps((SLICES - 1) as f32);
            let begun = _mm256_cmp_ps_mask::<_CMP_GT_OQ>(next, _mm256_min_ps(low, in_reach));
            let not_over = _mm256_cmp_ps_mask::<_CMP_LE_OQ>(slice, _mm256_max_ps(high, _mm256_setzero_ps()));
            let met = _mm512_maskz_and_epi64(begun & not_over, a, _mm512_and_epi64(b, c));
            _mm512_reduce_or_epi64(met).cast_unsigned()
        }
    }

    /// All eight steps of both at once: the even lanes are the first path's, the odd ones the second's, so that either's slices are
    /// the lower halves of eight words, shifted for the second.
    #[inline(always)]
    fn path_unions(self, maps: [[&[u64; SLICES]; 3]; 2], paths: &PathRows, lanes: [usize; 2]) -> [u64; 2] {
        let [low, high, start_b, start_c, slope_b, slope_c] = paths.0.each_ref().map(|row| self.load(&row.0));
        // SAFETY: the token proves the features; each map has the eight words that are loaded.
        unsafe {
            let which = _mm512_set1_epi64((lanes[0] | lanes[1] << 32).cast_signed() as i64);
            let both = |row: __m512| _mm512_permutexvar_ps(which, row);
            let (low, high) = (both(low), both(high));
            let slice = _mm512_setr_ps(0., 0., 1., 1., 2., 2., 3., 3., 4., 4., 5., 5., 6., 6., 7., 7.);
            let next = _mm512_add_ps(slice, _mm512_set1_ps(1.0));
            let (zero, last) = (_mm512_setzero_ps(), _mm512_set1_ps((SLICES - 1) as f32));
            let left = _mm512_sub_ps(_mm512_max_ps(slice, low), low);
            let right = _mm512_sub_ps(_mm512_min_ps(next, high), low);
            let slices =
                |position: __m512| _mm512_cvttps_epi32(_mm512_min_ps(_mm512_max_ps(position, zero), last));
            let touched = |start: __m512, slope: __m512| {
                let (start, slope) = (both(start), both(slope));
                let p = _mm512_add_ps(start, _mm512_mul_ps(slope, left));
                let q = _mm512_add_ps(start, _mm512_mul_ps(slope, right));
                let far = _mm512_sub_ps(_mm512_max_ps(p, q), _mm512_set1_ps(TRIM));
                [slices(_mm512_min_ps(p, q)), slices(far)]
            };
            let ([b, b_far], [c, c_far]) = (touched(start_b, slope_b), touched(start_c, slope_c));
            let begun = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(next, _mm512_min_ps(low, last));
            let met = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(begun, slice, _mm512_max_ps(high, zero));
            let steps = [0x5555, 0xaaaa].map(|lanes| _pext_u32(u32::from(met), lanes) as u8);
            let union = |maps: [&[u64; SLICES]; 3], steps: u8, [b, b_far, c, c_far]: [__m512i; 4]| {
                let [words, of_b, of_c] = maps.map(|map| _mm512_loadu_epi64(map.as_ptr().cast()));
                let b =
                    _mm512_or_epi64(_mm512_permutexvar_epi64(b, of_b), _mm512_permutexvar_epi64(b_far, of_b));
                let c =
                    _mm512_or_epi64(_mm512_permutexvar_epi64(c, of_c), _mm512_permutexvar_epi64(c_far, of_c));
                _mm512_maskz_and_epi64(steps, words, _mm512_and_epi64(b, c))
            };
            let slices = [b, b_far, c, c_far];
            let first = union(maps[0], steps[0], slices);
            let second = union(maps[1], steps[1], slices.map(|slice| _mm512_srli_epi64::<32>(slice)));
            let pairs =
                _mm512_or_epi64(_mm512_unpacklo_epi64(first, second), _mm512_unpackhi_epi64(first, second));
            let four = _mm256_or_si256(_mm512_castsi512_si256(pairs), _mm512_extracti64x4_epi64::<1>(pairs));
            let two = _mm_or_si128(_mm256_castsi256_si128(four), _mm256_extracti128_si256::<1>(four));
            [_mm_cvtsi128_si64(two), _mm_extract_epi64::<1>(two)].map(i64::cast_unsigned)
        }
    }

    /// All eight slices at once.
    #[inline(always)]
    fn hull_union(self, maps: [&[u64; SLICES]; 3], hull: &Hull) -> u64 {
        // SAFETY: the token proves the features; each map has the eight words that are loaded.
        unsafe {
            let Steps { words: [a, b, c], slice, next, low, high, left, right } =
                steps(maps, hull.low, hull.high);
            let met =
                _mm256_cmp_ps_mask::<_CMP_GT_OQ>(next, low) & _mm256_cmp_ps_mask::<_CMP_LE_OQ>(slice, high);
            let (b, met) = within(b, left, right, &hull.sides[0], met);
            let (c, met) = within(c, left, right, &hull.sides[1], met);
            let met = _mm512_maskz_and_epi64(met, a, _mm512_and_epi64(b, c));
            _mm512_reduce_or_epi64(met).cast_unsigned()
        }
    }

    #[inline(always)]
    fn least(self, v: Self::F) -> f32 {
        intrinsic!(_mm512_reduce_min_ps(v))
    }

    #[inline(always)]
    fn most(self, v: Self::F) -> f32 {
        intrinsic!(_mm512_reduce_max_ps(v))
    }
}

/// Eight steps of a slice each, the words of all three maps there, and where a range begins and ends in each of them.
struct Steps {
    words: [__m512i; 3],
    slice: __m256,
    next: __m256,
    low: __m256,
    high: __m256,
    /// From the beginning of the range on.
    left: __m256,
    right: __m256,
}

/// # Safety
/// The processor has AVX-512 F and VL.
#[inline(always)]
unsafe fn steps(maps: [&[u64; SLICES]; 3], low: f32, high: f32) -> Steps {
    // SAFETY: the caller vouches for the instruction set; each map has the eight words that are loaded.
    unsafe {
        let words = maps.map(|map| _mm512_loadu_epi64(map.as_ptr().cast()));
        let slice = _mm256_setr_ps(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0);
        let next = _mm256_setr_ps(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0);
        let (low, high) = (_mm256_set1_ps(low), _mm256_set1_ps(high));
        let left = _mm256_sub_ps(_mm256_max_ps(slice, low), low);
        let right = _mm256_sub_ps(_mm256_min_ps(next, high), low);
        Steps { words, slice, next, low, high, left, right }
    }
}

/// The words between two lines in each of eight steps, and which of the steps `met` have any.
///
/// # Safety
/// The processor has AVX-512 F and VL.
#[inline(always)]
unsafe fn within(
    map: __m512i,
    left: __m256,
    right: __m256,
    [low, high]: &[[f32; 2]; 2],
    met: u8,
) -> (__m512i, u8) {
    // SAFETY: the caller vouches for the instruction set; no memory is touched.
    unsafe {
        let (start, slope) = (_mm256_set1_ps(low[0]), _mm256_set1_ps(low[1]));
        let p = _mm256_add_ps(start, _mm256_mul_ps(slope, left));
        let q = _mm256_add_ps(start, _mm256_mul_ps(slope, right));
        let near = _mm256_min_ps(p, q);
        let (start, slope) = (_mm256_set1_ps(high[0]), _mm256_set1_ps(high[1]));
        let p = _mm256_add_ps(start, _mm256_mul_ps(slope, left));
        let q = _mm256_add_ps(start, _mm256_mul_ps(slope, right));
        let far = _mm256_max_ps(p, q);
        let met = met
            & _mm256_cmp_ps_mask::<_CMP_GE_OQ>(far, _mm256_set1_ps(-BESIDE))
            & _mm256_cmp_ps_mask::<_CMP_LE_OQ>(near, _mm256_set1_ps(SLICES as f32 + BESIDE));
        let (mut at, end) = (slices(near), slices(far));
        let mut words = _mm512_permutexvar_epi64(at, map);
        loop {
            let more = _mm512_cmplt_epi64_mask(at, end) & met;
            if more == 0 {
                return (words, met);
            }
            at = _mm512_mask_add_epi64(at, more, at, _mm512_set1_epi64(1));
            words = _mm512_or_epi64(words, _mm512_permutexvar_epi64(at, map));
        }
    }
}

/// The slices of eight positions, those outside counting to the nearest.
///
/// # Safety
/// The processor has AVX-512 F and VL.
#[inline(always)]
unsafe fn slices(position: __m256) -> __m512i {
    // SAFETY: the caller vouches for the instruction set; no memory is touched.
    unsafe {
        let last = _mm256_set1_ps((SLICES - 1) as f32);
        let inside = _mm256_min_ps(_mm256_max_ps(position, _mm256_setzero_ps()), last);
        _mm512_cvtepi32_epi64(_mm256_cvttps_epi32(inside))
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
    unsafe { _mm512_permutexvar_epi64(slices(position), map) }
}
