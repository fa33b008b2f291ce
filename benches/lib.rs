//! Criterion benches over the registry of `rayscale`.
