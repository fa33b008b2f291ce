//! Four lanes of NEON, which every aarch64 processor has.

use super::{Simd, Task, intrinsic, registers};
use std::arch::aarch64::*;

/// Proof that NEON is present.
#[derive(Clone, Copy, Debug)]
pub struct Neon(());

/// Runs `task` with NEON.
pub(super) fn run<T: Task>(task: T) -> T::Out {
    task.run(Neon(()))
}

const LANE_BITS: [u32; 4] = [1, 2, 4, 8];

impl Simd for Neon {
    registers! {
        4 of float32x4_t, uint32x4_t, uint32x4_t;
        splat vdupq_n_f32; load vld1q_f32; store vst1q_f32;
        integers load vld1q_u32; store vst1q_u32;
        roots vsqrtq_f32;
        floats add = vaddq_f32, sub = vsubq_f32, mul = vmulq_f32, div = vdivq_f32, min = vminq_f32, max = vmaxq_f32;
        comparisons lt = vcltq_f32, le = vcleq_f32, eq = vceqq_f32;
        masks and = vandq_u32, or = vorrq_u32;
    }

    #[inline(always)]
    fn abs(self, a: Self::F) -> Self::F {
        intrinsic!(vabsq_f32(a))
    }
    #[inline(always)]
    fn select(self, m: Self::M, a: Self::F, b: Self::F) -> Self::F {
        intrinsic!(vbslq_f32(m, a, b))
    }
    #[inline(always)]
    fn bits(self, m: Self::M) -> u32 {
        // SAFETY: NEON is always present; the constant has 4 integers.
        unsafe { vaddvq_u32(vandq_u32(m, vld1q_u32(LANE_BITS.as_ptr()))) }
    }
    #[inline(always)]
    fn mask(self, bits: u32) -> Self::M {
        // SAFETY: NEON is always present; the constant has 4 integers.
        unsafe {
            let lanes = vld1q_u32(LANE_BITS.as_ptr());
            vceqq_u32(vandq_u32(vdupq_n_u32(bits), lanes), lanes)
        }
    }
    #[inline(always)]
    fn splat_u(self, v: u32) -> Self::U {
        intrinsic!(vdupq_n_u32(v))
    }
    #[inline(always)]
    fn select_u(self, m: Self::M, a: Self::U, b: Self::U) -> Self::U {
        intrinsic!(vbslq_u32(m, a, b))
    }
    #[inline(always)]
    fn lt_u(self, a: Self::U, b: Self::U) -> Self::M {
        intrinsic!(vcltq_u32(a, b))
    }
    #[inline(always)]
    fn load_short(self, from: &[u16]) -> Self::F {
        let from = &from[..4];
        // SAFETY: NEON is always present; the slice has 4 short integers.
        unsafe { vcvtq_f32_u32(vmovl_u16(vld1_u16(from.as_ptr()))) }
    }
}
