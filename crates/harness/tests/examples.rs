//! The examples run, and are as short as they promise.

/// Includes each example and runs its `main` in a test of its name.
macro_rules! examples {
    ($($name:ident in $path:literal;)*) => {$(
        #[path = $path]
        mod $name;

        #[test]
        fn $name() {
            $name::main().unwrap_or_else(|error| panic!("{error}"));
            let lines = include_str!($path).lines().count();
            assert!(lines <= 90, "{lines} lines");
        }
    )*};
}

examples! {
    own_structure in "../examples/own_structure.rs";
    structures in "../examples/structures.rs";
}
