//! The program that made a record.

use serde::{Deserialize, Serialize};

/// The program that made a record.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Suite {
    /// Version of the package.
    pub version: String,
    /// Commit, with `+` behind it where files differed; empty where there is no git.
    pub git: String,
    /// Build profile.
    pub profile: String,
    /// Flags given to the compiler.
    pub rustflags: String,
    /// Compiler's version.
    pub rustc: String,
}

impl Suite {
    /// This program.
    pub fn this() -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            git: env!("RAYSCALE_GIT").to_owned(),
            profile: env!("RAYSCALE_PROFILE").to_owned(),
            rustflags: env!("RAYSCALE_RUSTFLAGS").to_owned(),
            rustc: env!("RAYSCALE_RUSTC").to_owned(),
        }
    }
}
