//! Embree's structures. Without the feature `embree` they are known and absent.

use crate::registry::{Entry, Shape, Traits, look};
use library::{ABSENT, Variant, make, version, wrapper};

const SOLIDS: (&str, &str) =
    ("solids", "user: solids by the suite's tests; native: by Embree's own where it has the kind");

const EMBREE: Entry = Entry {
    look: look("#0969b8", "#63befd", Shape::Square),
    description: "Embree's BVH, one ray at a time (rtcIntersect1, rtcOccluded1)",
    source: "Wald et al. 2014, Embree 4",
    version,
    settings: &[
        ("quality", "build quality: low, medium or high"),
        ("denormals", "keep, or flush: denormal numbers count as zero in queries"),
        (
            "isa",
            "the widest instructions it may use: sse2, sse4.2, avx, avx2 or avx512; the processor's best",
        ),
        SOLIDS,
    ],
    traits: Traits { counted: false, leaks: true, ..Traits::EXTERNAL },
    variants: &["quality=high", "quality=low"],
    trials: &["quality=high", "quality=low"],
    absent: ABSENT,
    ..Entry::new("embree", |s| make(Variant::Plain, s))
};

pub const ENTRIES: &[Entry] = &[
    EMBREE,
    Entry {
        id: "embree-robust",
        look: look("#0b3759", "#b2dffe", Shape::Diamond),
        description: "Embree with RTC_SCENE_FLAG_ROBUST",
        variants: &[],
        trials: &[],
        make: |s| make(Variant::Robust, s),
        ..EMBREE
    },
    Entry {
        id: "embree-compact",
        look: look("#1997f6", "#336ba2", Shape::Circle),
        description: "Embree with RTC_SCENE_FLAG_COMPACT",
        traits: Traits { leaks: false, ..EMBREE.traits },
        variants: &[],
        trials: &[],
        make: |s| make(Variant::Compact, s),
        ..EMBREE
    },
    Entry {
        id: "embree-packet",
        look: look("#4603b4", "#a027e8", Shape::Triangle),
        description: "Embree, packets of 16 rays (rtcIntersect16, rtcOccluded16)",
        settings: &[
            EMBREE.settings[0],
            EMBREE.settings[1],
            EMBREE.settings[2],
            SOLIDS,
            ("coherent", "packets that are said to be coherent: those of rasters, on for all, off for none"),
        ],
        trials: &[],
        traits: Traits { leaks: false, ..EMBREE.traits },
        variants: &["coherent=on", "coherent=off"],
        make: |s| make(Variant::Packet, s),
        ..EMBREE
    },
    Entry {
        id: "embree-rs",
        look: look("#8a48fc", "#d25afc", Shape::Square),
        description: "Embree's single rays through the safe API of embree4-rs, which has no test for occlusion",
        source: "embree4-rs 0.0.16",
        settings: &[],
        traits: Traits { default: false, leaks: false, ..EMBREE.traits },
        variants: &[],
        trials: &[],
        make: wrapper,
        ..EMBREE
    },
];

/// Has Embree keep to the threads of the caller, in this process from now on.
pub fn keep_to_one_thread() {
    library::keep_to_one_thread();
}

#[cfg(feature = "embree")]
mod library {
    use crate::registry::{RegistryError, Settings};
    use accel::Builder;
    use accel::settings::one_of;
    use adapter_embree::{Denormals, EmbreeBuilder, Isa, PacketFlag, Quality, SolidKinds, WrapperBuilder};
    pub use adapter_embree::{Variant, keep_to_one_thread};

    /// Why there is no Embree.
    pub const ABSENT: Option<fn() -> String> = None;

    pub fn make(variant: Variant, settings: &Settings) -> Result<Box<dyn Builder>, RegistryError> {
        let default = EmbreeBuilder::new(variant);
        let quality = settings.read("quality", |id| one_of(id, Quality::ALL, |quality| quality.id()))?;
        let denormals = settings.read("denormals", |id| one_of(id, Denormals::ALL, |d| d.id()))?;
        let isa = settings.read("isa", |id| one_of(id, Isa::ALL, |isa| isa.id()))?;
        let coherent = settings.read("coherent", |id| one_of(id, PacketFlag::ALL, |flag| flag.id()))?;
        let solids = settings.read("solids", |id| one_of(id, SolidKinds::ALL, |kinds| kinds.id()))?;
        Ok(Box::new(EmbreeBuilder {
            solids: solids.unwrap_or(default.solids),
            quality: quality.unwrap_or(default.quality),
            denormals: denormals.unwrap_or(default.denormals),
            isa,
            coherent: coherent.unwrap_or(default.coherent),
            ..default
        }))
    }

    pub fn wrapper(_: &Settings) -> Result<Box<dyn Builder>, RegistryError> {
        Ok(Box::new(WrapperBuilder))
    }

    pub fn version() -> String {
        adapter_embree::version().map_or_else(
            |error| format!("unknown: {error}"),
            |(major, minor, patch)| format!("{major}.{minor}.{patch}"),
        )
    }
}

#[cfg(not(feature = "embree"))]
mod library {
    use crate::registry::{RegistryError, Settings};
    use accel::Builder;

    /// Why there is no Embree: what set-up wrote down before the program was built, if it ran.
    pub const ABSENT: Option<fn() -> String> = Some(reason);

    fn reason() -> String {
        option_env!("RAYSCALE_EMBREE_MISSING").unwrap_or("built without the feature `embree`").to_owned()
    }

    #[derive(Clone, Copy)]
    pub enum Variant {
        Plain,
        Robust,
        Compact,
        Packet,
    }

    pub fn make(_: Variant, _: &Settings) -> Result<Box<dyn Builder>, RegistryError> {
        Err(RegistryError::Absent { id: "embree".to_owned(), reason: reason() })
    }

    pub fn wrapper(settings: &Settings) -> Result<Box<dyn Builder>, RegistryError> {
        make(Variant::Plain, settings)
    }

    pub fn version() -> String {
        String::new()
    }

    pub fn keep_to_one_thread() {}
}
