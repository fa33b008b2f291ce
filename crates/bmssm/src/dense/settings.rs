//! What `bmssm-dense` can be told.

use super::Resolution;
use accel::settings::{self, none_of, one_of, switch};
use lanes::Level;
use primitives::KernelId;
use std::fmt;

/// How the bits of a word are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loop {
    /// 32-bit words, bit by bit, each object tested by itself: the loop of the paper's appendix.
    Appendix,
    /// 64-bit words by find-first-set, handed to objects packed in blocks.
    Words,
}

/// Settings of `bmssm-dense`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The ray-triangle test.
    pub kernel: KernelId,
    /// The instruction set.
    pub simd: Level,
    /// Slices along x, y and z for general rays.
    pub resolution: Resolution,
    /// How the bits of a word are taken.
    pub walk: Loop,
    /// Whether a general ray passes over objects it tested in an earlier cell.
    pub mailbox: bool,
    /// Whether there are maps above the maps of space, which tell the words that are not zero.
    pub levels: bool,
    /// Most bytes the maps may take; `None` for what the machine has to give.
    pub memory: Option<u128>,
}

impl Default for Settings {
    /// The paper's method by 64-bit words, N from the scene.
    fn default() -> Self {
        Self {
            kernel: KernelId::MollerTrumbore,
            simd: Level::best(),
            resolution: Resolution::Auto,
            walk: Loop::Words,
            mailbox: false,
            levels: false,
            memory: None,
        }
    }
}

impl Settings {
    /// Names and meanings, for help texts.
    pub const NAMES: [(&str, &str); 7] = [
        ("kernel", "ray-triangle test; quantised and box are lossy"),
        ("simd", "instruction set"),
        ("resolution", "slices per axis: auto, 64, or 64x32x16"),
        ("loop", "words (64 bits, find-first-set) or appendix (32 bits, bit by bit)"),
        ("mailbox", "on: test no object twice for a ray; off: as in the paper"),
        (
            "levels",
            "on: maps above maps for rays of any kind, so that empty words are passed over; off: as in the paper",
        ),
        ("memory", "most bytes the maps may take"),
    ];

    /// Changes one setting.
    ///
    /// # Errors
    /// Says what is wrong.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), String> {
        match name {
            "kernel" => self.kernel = KernelId::parse(value)?,
            "simd" => self.simd = Level::parse(value)?,
            "resolution" => self.resolution = Resolution::parse(value)?,
            "loop" => self.walk = one_of(value, [Loop::Appendix, Loop::Words], |walk| walk.id())?,
            "mailbox" => self.mailbox = switch(value)?,
            "levels" => self.levels = switch(value)?,
            "memory" => self.memory = Some(settings::bytes(value)?),
            _ => return Err(none_of(name, Self::NAMES.map(|(name, _)| name))),
        }
        Ok(())
    }
}

impl Loop {
    /// Name as used in settings and records.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Appendix => "appendix",
            Self::Words => "words",
        }
    }
}

impl fmt::Display for Settings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kernel, simd, resolution, walk, mailbox, levels, memory } = self;
        let [mailbox, levels] = [mailbox, levels].map(|on| if *on { "on" } else { "off" });
        write!(
            f,
            "kernel={kernel} simd={} resolution={resolution} loop={} mailbox={mailbox} levels={levels}",
            simd.id(),
            walk.id()
        )?;
        memory.map_or(Ok(()), |bytes| write!(f, " memory={bytes}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_is_read_as_it_is_written() {
        let mut settings = Settings::default();
        let text = "kernel=watertight simd=portable resolution=64x32x16 loop=appendix mailbox=on levels=on memory=123";
        for (name, value) in text.split(' ').map(|pair| pair.split_once('=').unwrap()) {
            settings.set(name, value).unwrap();
        }
        assert_eq!(settings.to_string(), text);
    }

    #[test]
    fn nonsense_is_refused_by_name() {
        for (name, _) in Settings::NAMES {
            let problem = Settings::default().set(name, "?").unwrap_err();
            assert!(problem.contains("'?'"), "{name}: {problem}");
        }
        assert!(Settings::default().set("colour", "red").unwrap_err().contains("resolution"));
        assert!(Settings::default().set("resolution", "0").is_err());
    }
}
