//! The examples run, and are as short as they promise.

/// Includes each example and runs its `main` in a test of its name.
macro_rules! examples {
    ($($(#[$when:meta])* $name:ident in $path:literal;)*) => {$(
        $(#[$when])*
        #[path = $path]
        mod $name;

        $(#[$when])*
        #[test]
        fn $name() {
            $name::main().unwrap_or_else(|error| panic!("{error}"));
            let lines = include_str!($path).lines().count();
            assert!(lines <= 90, "{lines} lines");
        }
    )*};
}

examples! {
    bmssm in "../examples/bmssm.rs";
    bmssm_dense in "../examples/bmssm_dense.rs";
    #[cfg(feature = "embree")]
    embree in "../examples/embree.rs";
    minmax in "../examples/minmax.rs";
    obvhs in "../examples/obvhs.rs";
    own_structure in "../examples/own_structure.rs";
    ssm in "../examples/ssm.rs";
    ssm_list in "../examples/ssm_list.rs";
}
