//! The structures of obvhs.

use crate::registry::{Entry, RegistryError, Settings, Shape, Traits, look};
use accel::Builder;
use accel::settings::one_of;
use adapter_obvhs::{ObvhsBuilder, Preset, Variant as Tree};

fn obvhs(tree: Tree, settings: &Settings) -> Result<Box<dyn Builder>, RegistryError> {
    let preset = settings.read("preset", |id| one_of(id, Preset::ALL, |preset| preset.id()))?;
    let compressed = settings.read("triangles", |id| {
        one_of(id, [false, true], |compressed| if *compressed { "compressed" } else { "full" })
    })?;
    Ok(Box::new(ObvhsBuilder {
        preset: preset.unwrap_or_default(),
        compressed: compressed.unwrap_or(false),
        ..ObvhsBuilder::new(tree)
    }))
}

const OBVHS: Entry = Entry {
    look: look("#02a464", "#02a666", Shape::Triangle),
    description: "obvhs' binary BVH",
    source: "obvhs",
    version: obvhs_version,
    settings: &[
        ("preset", "time for the build: fastest, medium or very-slow"),
        ("triangles", "full, or compressed: edges in 16-bit floats, which is lossy"),
    ],
    traits: Traits::EXTERNAL,
    trials: &["preset=fastest"],
    variants: &["preset=fastest", "preset=very-slow", "triangles=compressed"],
    ..Entry::new("obvhs-bvh2", |s| obvhs(Tree::Bvh2, s))
};

fn obvhs_version() -> String {
    adapter_obvhs::VERSION.to_owned()
}

pub const ENTRIES: &[Entry] = &[
    OBVHS,
    Entry {
        id: "obvhs-cwbvh",
        look: look("#13623c", "#3ffda4", Shape::Diamond),
        description: "obvhs' compressed wide BVH",
        source: "Ylitie, Karras & Laine 2017, obvhs",
        make: |s| obvhs(Tree::CwBvh, s),
        ..OBVHS
    },
];
