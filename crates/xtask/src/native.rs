//! Programs compiled for the machine that builds them.

use std::process::Command;

use crate::places::Places;

/// Has cargo compile for this machine's processor, in a target folder of its own so that the usual one keeps what it
/// has. Flags that name a processor are left as they are.
pub fn for_this_machine<'c>(command: &'c mut Command, places: &Places) -> &'c mut Command {
    let flags = std::env::var("RUSTFLAGS").unwrap_or_default();
    command.env("RUSTFLAGS", with_native(&flags)).env("CARGO_TARGET_DIR", places.native_target())
}

fn with_native(flags: &str) -> String {
    if flags.contains("target-cpu") {
        return flags.to_owned();
    }
    format!("{flags} -Ctarget-cpu=native").trim_start().to_owned()
}

#[cfg(test)]
mod tests {
    use super::with_native;

    #[test]
    fn a_processor_that_is_named_is_kept() {
        assert_eq!(with_native(""), "-Ctarget-cpu=native");
        assert_eq!(with_native("-g"), "-g -Ctarget-cpu=native");
        assert_eq!(with_native("-C target-cpu=x86-64-v3"), "-C target-cpu=x86-64-v3");
    }
}
