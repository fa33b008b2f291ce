//! What every instruction set does by one intrinsic a function, as a table of names.

/// Wraps intrinsics without preconditions but their instruction set.
macro_rules! intrinsic {
    ($e:expr) => {
        // SAFETY: the token exists only where the instruction set was detected, and the intrinsic touches no memory.
        #[allow(unused_unsafe)]
        unsafe {
            $e
        }
    };
}
pub(super) use intrinsic;

/// The function that enters an instruction set from a type that proves its presence, by the features it consists of: those
/// that are detected are those that are enabled.
#[cfg(target_arch = "x86_64")]
macro_rules! entered {
    ($token:ident, $($feature:tt)*) => {
        /// Whether this machine has all that is enabled.
        pub(super) fn present() -> bool {
            $(is_x86_feature_detected!($feature))&&*
        }

        /// Runs `task` with these instructions.
        ///
        /// The caller has checked that the level is available.
        pub(super) fn run<T: Task>(task: T) -> T::Out {
            $token(()).apart(task)
        }

        impl $token {
            /// Compiled once for each task, and never into its callers.
            #[inline(always)]
            fn enter<T: Task>(self, task: T) -> T::Out {
                #[inline(never)]
                $(#[target_feature(enable = $feature)])*
                fn inner<T: Task>(task: T) -> T::Out {
                    task.run($token(()))
                }
                // SAFETY: the token exists only where `present` found every feature enabled here.
                unsafe { inner(task) }
            }
        }
    };
}
#[cfg(target_arch = "x86_64")]
pub(super) use entered;

/// In an `impl` of [`Simd`](super::Simd): the number of lanes and the types of registers, how they are filled, loaded and
/// stored, and what is one intrinsic without preconditions but the instruction set.
macro_rules! registers {
    (
        $lanes:literal of $f:ty, $m:ty, $u:ty;
        splat $splat:path; load $load:path; store $store:path;
        integers load $load_integers:path; store $store_integers:path;
        roots $root:path;
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
            intrinsic!($splat(v))
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
        #[inline(always)]
        fn load_u(self, from: &[u32]) -> Self::U {
            let from = &from[..$lanes];
            // SAFETY: the token exists only where the instruction set was detected; the slice has as many integers.
            unsafe { $load_integers(from.as_ptr().cast()) }
        }
        #[inline(always)]
        fn store_u(self, v: Self::U, to: &mut [u32]) {
            let to = &mut to[..$lanes];
            // SAFETY: the token exists only where the instruction set was detected; the slice has as many integers.
            unsafe { $store_integers(to.as_mut_ptr().cast(), v) }
        }
        #[inline(always)]
        fn sqrt(self, a: Self::F) -> Self::F {
            intrinsic!($root(a))
        }
        $(
            #[inline(always)]
            fn $float(self, a: Self::F, b: Self::F) -> Self::F {
                intrinsic!($of_floats(a, b))
            }
        )*
        $(
            #[inline(always)]
            fn $compare(self, a: Self::F, b: Self::F) -> Self::M {
                intrinsic!($of_both(a, b))
            }
        )*
        $(
            #[inline(always)]
            fn $mask(self, a: Self::M, b: Self::M) -> Self::M {
                intrinsic!($of_masks(a, b))
            }
        )*
    };
}
pub(super) use registers;
