//! What `bmssm` can be told. Every choice of the plan can be overridden.

use crate::general::Storage;
use crate::{general, raster};
use accel::settings::{self, none_of, number, one_of};
use lanes::{BLOCK, Level};
use primitives::KernelId;
use std::fmt;

/// Settings of `bmssm`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The ray-triangle test.
    pub kernel: KernelId,
    /// The instruction set.
    pub simd: Level,
    /// Objects up to which a part of the scene is split object by object, larger ones by clusters of neighbours;
    /// `None` leaves it to the plan.
    pub exact_split: Option<usize>,
    /// Where the objects are tested by rays of any kind; `None` leaves it to the plan.
    pub geometry: Option<Storage>,
    /// Slices across a tile of an image.
    pub tile: u32,
    /// How much longer a block of an image is in depth than it is wide: a power of two's exponent.
    pub depth_bits: u32,
    /// Objects that span more slices of an image than this are kept apart from smaller ones.
    pub large: u32,
    /// Most bytes that the structure may take; `None` for what the machine has to give.
    pub memory: Option<u128>,
}

impl Default for Settings {
    fn default() -> Self {
        let raster::Settings { kernel, simd, tile, depth_bits, large } = raster::Settings::default();
        Self { kernel, simd, exact_split: None, geometry: None, tile, depth_bits, large, memory: None }
    }
}

impl Settings {
    /// Names and meanings, for help texts.
    pub const NAMES: [(&str, &str); 8] = [
        ("kernel", "ray-triangle test; quantised and box are lossy"),
        ("simd", "instruction set"),
        (
            "exact_split",
            "objects that are split one by one and not by clusters: auto, or 64 to 4096; fewer build faster and trace slower",
        ),
        (
            "geometry",
            "what rays of any kind are tested with: auto, rows (copied for speed), boxes (copied in their place) or scene (nothing copied)",
        ),
        ("tile", "slices of 4 pixels across a tile of an image, 1 to 16"),
        ("depth_bits", "how much longer than wide a block of an image is, as a power of two, 0 to 8"),
        ("large", "slices of an image above which objects are kept apart from smaller ones"),
        ("memory", "most bytes the structure may take"),
    ];

    /// Changes one setting.
    ///
    /// # Errors
    /// Says what is wrong.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), String> {
        match name {
            "kernel" => self.kernel = KernelId::parse(value)?,
            "simd" => self.simd = Level::parse(value)?,
            "exact_split" if value == "auto" => self.exact_split = None,
            "exact_split" => self.exact_split = Some(number(value, BLOCK, general::MAX_EXACT_SPLIT)?),
            "geometry" if value == "auto" => self.geometry = None,
            "geometry" => self.geometry = Some(one_of(value, Storage::ALL, |storage| storage.id())?),
            "tile" => self.tile = number(value, 1, 16)?,
            "depth_bits" => self.depth_bits = number(value, 0, 8)?,
            "large" => self.large = number(value, 1, 1 << 16)?,
            "memory" => self.memory = Some(settings::bytes(value)?),
            _ => return Err(none_of(name, Self::NAMES.map(|(name, _)| name))),
        }
        Ok(())
    }

    pub(super) fn raster(&self) -> raster::Settings {
        let Self { kernel, simd, tile, depth_bits, large, .. } = *self;
        raster::Settings { kernel, simd, tile, depth_bits, large }
    }
}

impl fmt::Display for Settings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kernel, simd, exact_split, geometry, tile, depth_bits, large, memory } = self;
        let geometry = geometry.map_or("auto", Storage::id);
        let exact_split = exact_split.map_or("auto".to_owned(), |exact_split| exact_split.to_string());
        write!(
            f,
            "kernel={kernel} simd={} exact_split={exact_split} geometry={geometry} tile={tile} depth_bits={depth_bits} large={large}",
            simd.id()
        )?;
        memory.map_or(Ok(()), |bytes| write!(f, " memory={bytes}"))
    }
}
