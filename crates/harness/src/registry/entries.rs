//! The structures.

use super::{Absent, Entry, KERNEL, RegistryError, SIMD, Settings, Traits};
use accel::Builder;
#[cfg(feature = "embree")]
use adapter_embree::{Denormals, EmbreeBuilder, Isa, PacketFlag, Quality, Variant, WrapperBuilder};
use adapter_obvhs::{ObvhsBuilder, Preset, Variant as Tree};
use baselines::{Brute, MinMax, Sphere};
use bmssm::dense::BmssmDense;
use bmssm::fast::Bmssm;
use ssm::{Ssm, SsmList};

fn own() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

/// A builder by its defaults and its own `set`.
macro_rules! set {
    ($kind:ty) => {
        |settings: &Settings| -> Result<Box<dyn Builder>, RegistryError> {
            let mut builder = <$kind>::default();
            settings.pairs().try_for_each(|(name, value)| builder.set(name, value))?;
            Ok(Box::new(builder))
        }
    };
}

fn obvhs(tree: Tree, settings: &Settings) -> Result<Box<dyn Builder>, RegistryError> {
    let preset = settings.read("preset", "fastest, medium or very-slow", Preset::from_id)?;
    let compressed = settings.read("triangles", "full or compressed", |id| {
        ["full", "compressed"].iter().position(|known| *known == id).map(|place| place == 1)
    })?;
    Ok(Box::new(ObvhsBuilder {
        preset: preset.unwrap_or_default(),
        compressed: compressed.unwrap_or(false),
        ..ObvhsBuilder::new(tree)
    }))
}

const OBVHS: Entry = Entry {
    id: "obvhs-bvh2",
    description: "obvhs' binary BVH",
    source: "obvhs",
    version: obvhs_version,
    settings: &[
        ("preset", "time for the build: fastest, medium or very-slow"),
        ("triangles", "full, or compressed: edges in 16-bit floats, which is lossy"),
    ],
    traits: Traits::EXTERNAL,
    variants: &["preset=fastest", "preset=very-slow", "triangles=compressed"],
    make: |s| obvhs(Tree::Bvh2, s),
};

fn obvhs_version() -> String {
    adapter_obvhs::VERSION.to_owned()
}

#[cfg(feature = "embree")]
fn embree(variant: Variant, settings: &Settings) -> Result<Box<dyn Builder>, RegistryError> {
    let default = EmbreeBuilder::new(variant);
    let quality = settings.read("quality", "low, medium or high", Quality::from_id)?;
    let denormals = settings.read("denormals", "keep or flush", |id| {
        [Denormals::Keep, Denormals::Flush].into_iter().find(|d| d.id() == id)
    })?;
    let isa = settings.read("isa", "sse2, sse4.2, avx, avx2 or avx512", Isa::from_id)?;
    let coherent = settings.read("coherent", "rasters, on or off", PacketFlag::from_id)?;
    Ok(Box::new(EmbreeBuilder {
        quality: quality.unwrap_or(default.quality),
        denormals: denormals.unwrap_or(default.denormals),
        isa,
        coherent: coherent.unwrap_or(default.coherent),
        ..default
    }))
}

#[cfg(feature = "embree")]
fn embree_version() -> String {
    adapter_embree::version().map_or_else(
        |error| format!("unknown: {error}"),
        |(major, minor, patch)| format!("{major}.{minor}.{patch}"),
    )
}

#[cfg(feature = "embree")]
const EMBREE: Entry = Entry {
    id: "embree",
    description: "Embree's BVH, one ray at a time (rtcIntersect1, rtcOccluded1)",
    source: "Wald et al. 2014, Embree 4",
    version: embree_version,
    settings: &[
        ("quality", "build quality: low, medium or high"),
        ("denormals", "keep, or flush: denormal numbers count as zero in queries"),
        (
            "isa",
            "the widest instructions it may use: sse2, sse4.2, avx, avx2 or avx512; the processor's best",
        ),
    ],
    traits: Traits { counted: false, ..Traits::EXTERNAL },
    variants: &["quality=high", "quality=low"],
    make: |s| embree(Variant::Plain, s),
};

static ALL: &[Entry] = &[
    Entry {
        id: "brute",
        description: "no structure: every object tested for every ray; the reference for hits",
        source: "",
        version: own,
        settings: &[KERNEL, SIMD],
        traits: Traits { default: false, linear: true, ..Traits::BUILT_IN },
        variants: &[
            "simd=portable",
            "kernel=watertight",
            "kernel=quantised,simd=portable",
            "kernel=box,simd=portable",
        ],
        make: |s| Ok(Box::new(Brute { kernel: s.kernel()?, simd: s.simd()? })),
    },
    Entry {
        id: "minmax",
        description: "every object's box tested for every ray, then detail tests",
        source: "Skala 1993, §2–3",
        version: own,
        settings: &[KERNEL],
        traits: Traits { linear: true, ..Traits::BUILT_IN },
        variants: &["kernel=watertight"],
        make: |s| Ok(Box::new(MinMax { kernel: s.kernel()? })),
    },
    Entry {
        id: "sphere",
        description: "every object's bounding sphere tested for every ray, then detail tests",
        source: "Skala 1993, §4",
        version: own,
        settings: &[KERNEL],
        traits: Traits { linear: true, ..Traits::BUILT_IN },
        variants: &["kernel=watertight"],
        make: |s| Ok(Box::new(Sphere { kernel: s.kernel()? })),
    },
    Entry {
        id: "bmssm-dense",
        description: "the paper's bit maps as plain bit vectors",
        source: "Skala 1993, §2, §5, appendix",
        version: own,
        settings: &bmssm::dense::Settings::NAMES,
        traits: Traits { by_need: true, linear: true, ..Traits::BUILT_IN },
        variants: &[
            "resolution=1",
            "resolution=4",
            "resolution=3x17x5,simd=portable",
            "loop=appendix,resolution=8",
            "mailbox=on",
            "kernel=watertight",
        ],
        make: set!(BmssmDense),
    },
    Entry {
        id: "bmssm",
        description: "bit maps over blocks of 64 objects: in image space for rasters, in space for lists",
        source: "after Skala 1993",
        version: own,
        settings: &bmssm::fast::Settings::NAMES,
        traits: Traits { by_need: true, ..Traits::BUILT_IN },
        variants: &[
            "stretch=256",
            "simd=portable",
            "kernel=watertight",
            "tile=2,depth_bits=0,apart=1",
            "kernel=quantised",
            "kernel=box",
        ],
        make: set!(Bmssm),
    },
    Entry {
        id: "ssm-list",
        description: "uniform grid: a counter, a pointer and ids for each cell",
        source: "Skala 1993, §5",
        version: own,
        settings: &ssm::Settings::NAMES,
        traits: Traits::BUILT_IN,
        variants: &["resolution=1", "resolution=4", "resolution=3x17x5", "density=40", "kernel=watertight"],
        make: set!(SsmList),
    },
    Entry {
        id: "ssm",
        description: "compact uniform grid: one index per cell and one number per reference",
        source: "Lagae & Dutré 2008",
        version: own,
        settings: &Ssm::NAMES,
        traits: Traits::BUILT_IN,
        variants: &[
            "resolution=1",
            "resolution=4",
            "resolution=3x17x5,simd=portable",
            "density=40",
            "divide=off",
            "density=0.05,divide=0.5",
            "kernel=watertight",
            "kernel=quantised",
            "kernel=box",
        ],
        make: set!(Ssm),
    },
    OBVHS,
    Entry {
        id: "obvhs-cwbvh",
        description: "obvhs' compressed wide BVH",
        source: "Ylitie, Karras & Laine 2017, obvhs",
        make: |s| obvhs(Tree::CwBvh, s),
        ..OBVHS
    },
    #[cfg(feature = "embree")]
    EMBREE,
    #[cfg(feature = "embree")]
    Entry {
        id: "embree-robust",
        description: "Embree with RTC_SCENE_FLAG_ROBUST",
        variants: &[],
        make: |s| embree(Variant::Robust, s),
        ..EMBREE
    },
    #[cfg(feature = "embree")]
    Entry {
        id: "embree-compact",
        description: "Embree with RTC_SCENE_FLAG_COMPACT",
        variants: &[],
        make: |s| embree(Variant::Compact, s),
        ..EMBREE
    },
    #[cfg(feature = "embree")]
    Entry {
        id: "embree-packet",
        description: "Embree, packets of 16 rays (rtcIntersect16, rtcOccluded16)",
        settings: &[
            EMBREE.settings[0],
            EMBREE.settings[1],
            EMBREE.settings[2],
            ("coherent", "packets that are said to be coherent: those of rasters, on for all, off for none"),
        ],
        variants: &["coherent=on", "coherent=off"],
        make: |s| embree(Variant::Packet, s),
        ..EMBREE
    },
    #[cfg(feature = "embree")]
    Entry {
        id: "embree-rs",
        description: "Embree's single rays through the safe API of embree4-rs, which has no test for occlusion",
        source: "embree4-rs 0.0.16",
        settings: &[],
        traits: Traits { default: false, ..EMBREE.traits },
        variants: &[],
        make: |_| Ok(Box::new(WrapperBuilder)),
        ..EMBREE
    },
];

/// Has libraries that bring threads of their own keep to those of the caller, in this process from now on. To be
/// called before anything is built.
pub fn keep_to_one_thread() {
    #[cfg(feature = "embree")]
    adapter_embree::keep_to_one_thread();
}

pub(super) fn all() -> &'static [Entry] {
    ALL
}

pub(super) fn absent() -> Vec<Absent> {
    let embree = ["embree", "embree-robust", "embree-compact", "embree-packet", "embree-rs"];
    let absent = embree.into_iter().filter(|id| !ALL.iter().any(|entry| entry.id == *id));
    absent.map(|id| Absent { id, reason: embree_missing() }).collect()
}

/// Why there is no Embree: what set-up wrote down before the program was built, if it ran.
fn embree_missing() -> String {
    option_env!("RAYSCALE_EMBREE_MISSING").unwrap_or("built without the feature `embree`").to_owned()
}
