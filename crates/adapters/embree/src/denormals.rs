//! Denormal numbers taken as zero, the mode that Embree asks its callers to set.

use std::marker::PhantomData;

/// Whether queries run with denormal numbers taken as zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Denormals {
    /// As IEEE 754 has them.
    #[default]
    Keep,
    /// Denormal inputs and results are zero (FTZ and DAZ of MXCSR; on x86-64 only).
    Flush,
}

impl Denormals {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Keep, Self::Flush];

    /// Its name as a setting.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Keep => "keep",
            Self::Flush => "flush",
        }
    }
}

/// Flush-to-zero and denormals-are-zero, bits 15 and 6 of MXCSR.
#[cfg(target_arch = "x86_64")]
const FTZ_DAZ: u32 = 1 << 15 | 1 << 6;

/// Sets the mode of the current thread and restores what was there when dropped.
#[derive(Debug)]
pub struct DenormalsGuard {
    #[cfg(target_arch = "x86_64")]
    before: u32,
    /// The register belongs to the thread.
    _of_this_thread: PhantomData<*const ()>,
}

impl DenormalsGuard {
    /// Sets the mode. Elsewhere than on x86-64 nothing is set.
    ///
    /// # Safety
    /// Rust code is compiled for the default mode: with [`Denormals::Flush`], no floating-point
    /// arithmetic of Rust may run before the guard is dropped. Moving values and calling foreign
    /// code is all right.
    #[inline]
    pub unsafe fn set(mode: Denormals) -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let before = read_mxcsr();
            if mode == Denormals::Flush {
                // SAFETY: the caller runs no floating-point arithmetic; the bits are defined.
                unsafe { write_mxcsr(before | FTZ_DAZ) };
            }
            Self { before, _of_this_thread: PhantomData }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            let _ = mode;
            Self { _of_this_thread: PhantomData }
        }
    }
}

impl Drop for DenormalsGuard {
    #[inline]
    fn drop(&mut self) {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: the value was read from this thread's register.
        unsafe {
            write_mxcsr(self.before);
        }
    }
}

#[cfg(target_arch = "x86_64")]
fn read_mxcsr() -> u32 {
    let mut value = 0_u32;
    // SAFETY: stores four bytes to a place that is writable and big enough.
    unsafe {
        std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut value, options(nostack, preserves_flags));
    }
    value
}

/// # Safety
/// `value` must set no reserved bit, and Rust's arithmetic must not run in another mode than the
/// default.
#[cfg(target_arch = "x86_64")]
unsafe fn write_mxcsr(value: u32) {
    // SAFETY: loads four bytes from a readable place; the caller vouches for the value.
    unsafe {
        std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const value, options(nostack, preserves_flags));
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;

    #[test]
    fn the_mode_is_set_and_restored() {
        let before = read_mxcsr();
        // SAFETY: no arithmetic in between.
        let guard = unsafe { DenormalsGuard::set(Denormals::Flush) };
        let within = read_mxcsr();
        drop(guard);
        assert_eq!(read_mxcsr(), before);
        // valgrind emulates the default mode only.
        let emulated = std::env::var("LD_PRELOAD").is_ok_and(|libraries| libraries.contains("vgpreload"));
        assert_eq!(within & FTZ_DAZ, if emulated { before & FTZ_DAZ } else { FTZ_DAZ });
        // SAFETY: nothing is changed.
        let guard = unsafe { DenormalsGuard::set(Denormals::Keep) };
        assert_eq!(read_mxcsr(), before);
        drop(guard);
    }
}
