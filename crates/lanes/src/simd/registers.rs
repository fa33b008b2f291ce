//! What every instruction set does by one intrinsic a function, as a table of names.

/// In an `impl` of [`Simd`](super::Simd): the number of lanes and the types of registers, how they are filled, loaded and
/// stored, and what is one intrinsic without preconditions but the instruction set.
macro_rules! registers {
    (
        $lanes:literal of $f:ty, $m:ty, $u:ty;
        splat $splat:path; load $load:path; store $store:path;
        floats $($float:ident = $of_floats:path),*;
        comparisons $($compare:ident = $of_both:path),*;
        masks $($mask:ident = $of_masks:path),*;
    ) => {
        const LANES: usize = $lanes;
        type F = $f;
        type M = $m;
        type U = $u;

        #[inline(always)]
        fn splat(self, v: f32) -> Self::F {
            // SAFETY: the token exists only where the instruction set was detected.
            #[allow(unused_unsafe)]
            unsafe {
                $splat(v)
            }
        }
        #[inline(always)]
        fn load(self, from: &[f32]) -> Self::F {
            let from = &from[..$lanes];
            // SAFETY: the token exists only where the instruction set was detected; the slice has as many floats.
            unsafe { $load(from.as_ptr()) }
        }
        #[inline(always)]
        fn store(self, v: Self::F, to: &mut [f32]) {
            let to = &mut to[..$lanes];
            // SAFETY: the token exists only where the instruction set was detected; the slice has as many floats.
            unsafe { $store(to.as_mut_ptr(), v) }
        }
        $(
            #[inline(always)]
            fn $float(self, a: Self::F, b: Self::F) -> Self::F {
                // SAFETY: the token exists only where the instruction set was detected; no memory is touched.
                #[allow(unused_unsafe)]
                unsafe {
                    $of_floats(a, b)
                }
            }
        )*
        $(
            #[inline(always)]
            fn $compare(self, a: Self::F, b: Self::F) -> Self::M {
                // SAFETY: the token exists only where the instruction set was detected; no memory is touched.
                #[allow(unused_unsafe)]
                unsafe {
                    $of_both(a, b)
                }
            }
        )*
        $(
            #[inline(always)]
            fn $mask(self, a: Self::M, b: Self::M) -> Self::M {
                // SAFETY: the token exists only where the instruction set was detected; no memory is touched.
                #[allow(unused_unsafe)]
                unsafe {
                    $of_masks(a, b)
                }
            }
        )*
    };
}
pub(super) use registers;
