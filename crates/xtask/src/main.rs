//! `cargo xtask compare | test | setup`.

fn main() {}
