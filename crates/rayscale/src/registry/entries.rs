//! The structures.

use super::{Absent, Entry, KERNEL, SIMD, Traits};
use accel::baseline::{Brute, MinMax, Sphere};

fn own() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

static ALL: &[Entry] = &[
    Entry {
        id: "brute",
        description: "no structure: every object tested for every ray; the reference for hits",
        source: "",
        version: own,
        settings: &[KERNEL, SIMD],
        traits: Traits { default: false, linear: true, ..Traits::OWN },
        variants: &["simd=portable", "kernel=watertight"],
        make: |s| Ok(Box::new(Brute { kernel: s.kernel()?, simd: s.simd()? })),
    },
    Entry {
        id: "minmax",
        description: "every object's box tested for every ray, then detail tests",
        source: "Skala 1993, §2–3",
        version: own,
        settings: &[KERNEL],
        traits: Traits { linear: true, ..Traits::OWN },
        variants: &["kernel=watertight"],
        make: |s| Ok(Box::new(MinMax { kernel: s.kernel()? })),
    },
    Entry {
        id: "sphere",
        description: "every object's bounding sphere tested for every ray, then detail tests",
        source: "Skala 1993, §4",
        version: own,
        settings: &[KERNEL],
        traits: Traits { linear: true, ..Traits::OWN },
        variants: &["kernel=watertight"],
        make: |s| Ok(Box::new(Sphere { kernel: s.kernel()? })),
    },
];

pub(super) fn all() -> &'static [Entry] {
    ALL
}

pub(super) fn absent() -> Vec<Absent> {
    let embree = ["embree", "embree-robust", "embree-compact", "embree-packet"];
    let absent = embree.into_iter().filter(|id| !ALL.iter().any(|entry| entry.id == *id));
    absent.map(|id| Absent { id, reason: embree_missing() }).collect()
}

/// Why there is no Embree: what set-up wrote down, if it ran.
fn embree_missing() -> String {
    let note = concat!(env!("CARGO_MANIFEST_DIR"), "/../../.setup/embree-missing.txt");
    let said = std::fs::read_to_string(note).ok().map(|text| text.trim().to_owned());
    said.filter(|text| !text.is_empty()).unwrap_or_else(|| "built without the feature `embree`".to_owned())
}
