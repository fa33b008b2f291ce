//! Lets the binary find Embree when it is called directly: beside it in `../lib/rayscale`, or where it was linked.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Set by the build script of embree4-sys; absent without the feature `embree`.
    if let Ok(dir) = std::env::var("DEP_EMBREE4_LIBDIR") {
        println!("cargo::rustc-link-arg-bins=-Wl,-rpath,$ORIGIN/../lib/rayscale:{dir}");
    }
}
