//! What machine this is.

use serde::{Deserialize, Serialize};
use std::fs;
use std::hint::black_box;

/// Where a record was made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// The processor's name.
    pub cpu: String,
    /// The widest instruction set that the suite uses here.
    pub isa: String,
    /// Threads that this process may run at once.
    pub cores: usize,
    /// Operating system.
    pub os: String,
    /// Main memory in bytes, 0 where unknown.
    pub memory_bytes: u64,
    /// Whether denormal results were flushed to zero (FTZ) in the threads that measured.
    pub flush_to_zero: bool,
    /// Whether denormal operands counted as zero (DAZ) there.
    pub denormals_are_zero: bool,
}

impl Machine {
    /// This machine, and the floating-point mode of the calling thread.
    pub fn here() -> Self {
        let release = release().unwrap_or_default();
        Self {
            cpu: field("/proc/cpuinfo", "model name").unwrap_or_else(|| "unknown".to_owned()),
            isa: format!("{} {}", std::env::consts::ARCH, lanes::Level::best().id()),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            os: format!("{} {release}", std::env::consts::OS).trim().to_owned(),
            memory_bytes: memory().unwrap_or(0),
            flush_to_zero: flushes(),
            denormals_are_zero: ignores_denormals(),
        }
    }
}

/// Whether a denormal result becomes zero in this thread.
pub fn flushes() -> bool {
    black_box(f32::MIN_POSITIVE) * black_box(0.5) == 0.0
}

/// Whether a denormal operand counts as zero in this thread.
pub fn ignores_denormals() -> bool {
    black_box(f32::from_bits(1)) * black_box(2f32.powi(100)) == 0.0
}

fn field(file: &str, name: &str) -> Option<String> {
    let text = fs::read_to_string(file).ok()?;
    let line = text.lines().find(|line| line.starts_with(name))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

fn memory() -> Option<u64> {
    let kib: u64 = field("/proc/meminfo", "MemTotal")?.split_whitespace().next()?.parse().ok()?;
    Some(kib * 1024)
}

fn release() -> Option<String> {
    let text = fs::read_to_string("/etc/os-release").ok()?;
    let name = text.lines().find_map(|line| line.strip_prefix("PRETTY_NAME="))?;
    Some(name.trim_matches('"').to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rust_leaves_denormals_alone() {
        let here = Machine::here();
        assert!(!here.flush_to_zero && !here.denormals_are_zero);
        assert!(here.cores >= 1 && !here.cpu.is_empty());
    }
}
