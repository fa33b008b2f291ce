//! The suite's own structures.

use crate::registry::{Entry, KERNEL, RegistryError, SIMD, Settings, Shape, Traits, look};
use accel::Builder;
use baselines::{Brute, MinMax, Sphere};
use bmssm::suite::dense::BmssmDense;
use bmssm::suite::fast::Bmssm;
use ssm::suite::{Ssm, SsmList};

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

const BUILT_IN: Entry = Entry::new("", |_| unreachable!("every structure says how it is made"));

/// A test of bounding volumes, one for each object.
const BOUNDING: Entry = Entry {
    settings: &[KERNEL],
    traits: Traits { linear: true, ..Traits::BUILT_IN },
    variants: &["kernel=watertight"],
    ..BUILT_IN
};

pub const ENTRIES: &[Entry] = &[
    Entry {
        id: "brute",
        look: look("#939393", "#cfcfcf", Shape::Square),
        description: "no structure: every object tested for every ray; the reference for hits",
        settings: &[KERNEL, SIMD],
        traits: Traits { default: false, linear: true, ..Traits::BUILT_IN },
        variants: &[
            "simd=portable",
            "kernel=watertight",
            "kernel=quantised,simd=portable",
            "kernel=box,simd=portable",
        ],
        make: |s| Ok(Box::new(Brute { kernel: s.kernel()?, simd: s.simd()? })),
        ..BUILT_IN
    },
    Entry {
        id: "minmax",
        look: look("#6a6a6a", "#9b9b9b", Shape::Triangle),
        description: "every object's box tested for every ray, then detail tests",
        source: "Skala 1993, §2–3",
        make: |s| Ok(Box::new(MinMax { kernel: s.kernel()? })),
        ..BOUNDING
    },
    Entry {
        id: "sphere",
        look: look("#3c3c3c", "#666666", Shape::Circle),
        description: "every object's bounding sphere tested for every ray, then detail tests",
        source: "Skala 1993, §4",
        make: |s| Ok(Box::new(Sphere { kernel: s.kernel()? })),
        ..BOUNDING
    },
    Entry {
        id: "bmssm-dense",
        look: look("#38120a", "#98562a", Shape::Square),
        description: "the paper's bit maps as plain bit vectors",
        source: "Skala 1993, §2, §5, appendix",
        settings: &bmssm::suite::dense::Settings::NAMES,
        traits: Traits { by_workload: true, linear: true, ..Traits::BUILT_IN },
        variants: &[
            "resolution=1",
            "resolution=4",
            "resolution=3x17x5,simd=portable",
            "loop=appendix,resolution=8",
            "mailbox=on",
            "levels=on,resolution=8",
            "kernel=watertight",
        ],
        make: set!(BmssmDense),
        ..BUILT_IN
    },
    Entry {
        id: "bmssm",
        look: look("#da670c", "#e65315", Shape::Circle),
        description: "bit maps over blocks of 64 objects: in image space for rasters, in space for lists",
        source: "after Skala 1993",
        settings: &bmssm::suite::fast::Settings::NAMES,
        traits: Traits { by_workload: true, any_kernel: true, ..Traits::BUILT_IN },
        variants: &["exact_split=256", "simd=portable", "tile=2,depth_bits=0,large=1"],
        make: set!(Bmssm),
        ..BUILT_IN
    },
    Entry {
        id: "ssm-list",
        look: look("#4c3806", "#e0cb61", Shape::Triangle),
        description: "uniform grid: a counter, a pointer and ids for each cell",
        source: "Skala 1993, §5",
        settings: &SsmList::NAMES,
        variants: &[
            "resolution=1",
            "resolution=4",
            "resolution=3x17x5",
            "density=40",
            "mailbox=on",
            "kernel=watertight",
        ],
        make: set!(SsmList),
        ..BUILT_IN
    },
    Entry {
        id: "ssm",
        look: look("#7f6c2a", "#efb21f", Shape::Diamond),
        description: "compact uniform grid: one index per cell and one number per reference",
        source: "Lagae & Dutré 2008",
        settings: &Ssm::NAMES,
        traits: Traits { any_kernel: true, ..Traits::BUILT_IN },
        variants: &[
            "resolution=1",
            "resolution=4",
            "resolution=3x17x5,simd=portable",
            "density=40",
            "divide=off",
            "density=0.05,divide=0.5",
        ],
        make: set!(Ssm),
        ..BUILT_IN
    },
];
