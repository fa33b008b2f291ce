//! The one place that names all structures.
//!
//! Adding a structure is adding an [`Entry`] to a file of `entries/`: everything else derives from it.

mod build;
mod entries;
mod error;
mod kernel;
mod look;
mod settings;

pub use build::{BuildFailure, guarded_build, guarded_build_unless};
pub use entries::keep_to_one_thread;
pub use error::RegistryError;
pub use kernel::{AUTO, ChosenKernel};
pub use look::{Look, Shape, look};
pub use settings::{KERNEL, SIMD, Setting, Settings, StructureSpec};

use accel::{Accel, Builder, RaySet, Scene, Workload};
use baselines::Brute;
use primitives::KernelId;
use scenes::near::near;
use std::sync::{Arc, LazyLock};

/// Makes a builder from settings.
pub type Make = fn(&Settings) -> Result<Box<dyn Builder>, RegistryError>;

/// A structure: all that lists, help, completions, default sets, checks, recommendations and pictures know of it.
#[derive(Clone, Copy)]
pub struct Entry {
    /// Its id.
    pub id: &'static str,
    /// What it is, in a line.
    pub description: &'static str,
    /// Where the method is published.
    pub source: &'static str,
    /// Version of the library behind it.
    pub version: fn() -> String,
    /// The settings it takes.
    pub settings: &'static [Setting],
    /// How it takes part in a comparison.
    pub traits: Traits,
    /// Settings worth checking besides the default ones and those of [`Traits::any_kernel`], as `name=value,…`.
    pub variants: &'static [&'static str],
    /// Settings that may suit a user better than the default ones, likewise.
    pub trials: &'static [&'static str],
    /// How it looks in pictures.
    pub look: Look,
    /// Makes a builder.
    pub make: Make,
    /// Why this program was built without it, if it was.
    pub absent: Option<fn() -> String>,
}

impl Entry {
    /// A built-in structure of which nothing more is said.
    pub const fn new(id: &'static str, make: Make) -> Self {
        Self {
            id,
            description: "",
            source: "",
            version: || env!("CARGO_PKG_VERSION").to_owned(),
            settings: &[],
            traits: Traits::BUILT_IN,
            variants: &[],
            trials: &[],
            look: Look::OTHER,
            make,
            absent: None,
        }
    }

    /// The settings that checks try: the default ones, the variants, and other kernels where it suits any.
    pub fn tried(&self) -> impl Iterator<Item = &'static str> {
        let kernels: &[_] = if self.traits.any_kernel {
            &["kernel=watertight", "kernel=quantised", "kernel=box"]
        } else {
            &[]
        };
        std::iter::once("").chain(self.variants.iter().copied()).chain(kernels.iter().copied())
    }
}

/// How a structure takes part in a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Traits {
    /// Part of the default comparison.
    pub default: bool,
    /// Uses the suite's kernels (setting `kernel`): must equal brute force bit for bit.
    pub built_in: bool,
    /// Its time per ray grows with the number of objects: it gets fewer rays.
    pub linear: bool,
    /// What is built depends on the workload: another build for every raster.
    pub by_workload: bool,
    /// Its memory comes from this program's allocator, so that peaks can be counted.
    pub counted: bool,
    /// Suits scenes of any size, so that it is worth trying with every kernel.
    pub any_kernel: bool,
    /// Its leaks are counted beside those of kernels that promise none.
    pub leaks: bool,
}

impl Traits {
    /// One of the suite's own structures.
    pub const BUILT_IN: Self = Self {
        default: true,
        built_in: true,
        linear: false,
        by_workload: false,
        counted: true,
        any_kernel: false,
        leaks: false,
    };
    /// A structure from elsewhere with a ray-triangle test of its own.
    pub const EXTERNAL: Self = Self { built_in: false, ..Self::BUILT_IN };
}

impl Traits {
    /// Whether such a structure is given fewer rays than the set has. A raster that it was built for
    /// is traced as it is.
    pub fn subsamples(&self, rays: &RaySet) -> bool {
        self.linear && !(self.by_workload && matches!(rays, RaySet::Raster(_)))
    }
}

/// A structure that this program was built without.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Absent {
    /// Its id.
    pub id: &'static str,
    /// Why it is absent.
    pub reason: String,
}

/// A structure with its settings, ready to build once its kernel is decided.
#[derive(Clone)]
pub struct Choice {
    /// As asked for.
    pub spec: StructureSpec,
    /// What is known of it.
    pub entry: &'static Entry,
    /// Its ray-triangle test.
    pub kernel: ChosenKernel,
    /// Makes it.
    pub builder: Arc<dyn Builder>,
}

impl Choice {
    /// A structure that need not be among [`entries`].
    ///
    /// # Errors
    /// Unknown settings and bad values.
    pub fn of(entry: &'static Entry, spec: &StructureSpec) -> Result<Self, RegistryError> {
        let kernel = ChosenKernel::of(entry, spec);
        let builder = kernel.builder(entry, spec)?;
        Ok(Self { spec: spec.clone(), entry, kernel, builder })
    }

    /// The name of the ray-triangle test: one of the suite's, `own` for an external structure's, or `auto` while
    /// it is not decided.
    pub fn kernel(&self) -> &'static str {
        self.kernel.name()
    }

    /// Why this kernel was chosen; empty where the user did, unless it is lossy.
    pub fn reason(&self) -> &str {
        self.kernel.reason()
    }
}

/// All structures of this program, in the order of reports.
pub fn entries() -> &'static [Entry] {
    static PRESENT: LazyLock<Vec<Entry>> =
        LazyLock::new(|| known().filter(|entry| entry.absent.is_none()).copied().collect());
    &PRESENT
}

/// The structures that this program was built without, with the reason.
pub fn absent() -> Vec<Absent> {
    known().filter_map(|entry| Some(Absent { id: entry.id, reason: entry.absent?() })).collect()
}

fn known() -> impl Iterator<Item = &'static Entry> {
    entries::FAMILIES.into_iter().flatten()
}

/// How the structure of that id looks.
pub fn look_of(id: &str) -> Look {
    known().find(|entry| entry.id == id).map_or(Look::OTHER, |entry| entry.look)
}

/// The structure of that id.
///
/// # Errors
/// [`RegistryError::Unknown`] with near ids, [`RegistryError::Absent`] with the reason.
pub fn find(id: &str) -> Result<&'static Entry, RegistryError> {
    if let Some(entry) = entries().iter().find(|entry| entry.id == id) {
        return Ok(entry);
    }
    if let Some(Absent { id, reason }) = absent().into_iter().find(|absent| absent.id == id) {
        return Err(RegistryError::Absent { id: id.to_owned(), reason });
    }
    let known = entries().iter().map(|entry| entry.id).chain(absent().into_iter().map(|a| a.id));
    Err(RegistryError::Unknown { id: id.to_owned(), near: near(id, known) })
}

/// A builder for a structure with settings.
///
/// # Errors
/// Unknown or absent structures, unknown settings, bad values: [`RegistryError`].
pub fn choose(spec: &StructureSpec) -> Result<Choice, RegistryError> {
    Choice::of(find(&spec.id)?, spec)
}

/// As [`choose`], from text.
///
/// # Errors
/// As [`choose`]; also what can't be read.
pub fn parse(text: &str) -> Result<Choice, RegistryError> {
    choose(&text.parse()?)
}

/// Something quick that answers what brute force would with that kernel.
///
/// # Panics
/// If it can't be built for want of memory, and brute force neither.
pub fn quick(scene: &Scene, kernel: KernelId) -> Box<dyn Accel + '_> {
    let grid = parse(&format!("ssm:kernel={kernel}")).ok();
    let built = grid.and_then(|choice| choice.builder.build(scene, &Workload::GENERAL).ok());
    built.unwrap_or_else(|| {
        Brute::new(kernel).build(scene, &Workload::GENERAL).expect("brute force serves every scene")
    })
}

/// The structures of the default comparison.
pub fn defaults() -> Vec<StructureSpec> {
    let all = entries().iter().filter(|entry| entry.traits.default);
    all.map(|entry| StructureSpec::plain(entry.id)).collect()
}

/// Structures with settings that may suit a user better than the default ones.
pub fn trials() -> Vec<StructureSpec> {
    let trials = entries().iter().flat_map(|entry| entry.trials.iter().map(move |s| (entry.id, s)));
    trials.map(|(id, settings)| format!("{id}:{settings}").parse().expect("trials are settings")).collect()
}

/// The structures that suit any scene, with each of these kernels.
pub fn with_kernels(kernels: impl IntoIterator<Item = KernelId> + Clone) -> Vec<StructureSpec> {
    let suit = entries().iter().filter(|entry| entry.traits.any_kernel);
    let each = suit.flat_map(|entry| kernels.clone().into_iter().map(move |kernel| (entry.id, kernel)));
    each.map(|(id, kernel)| StructureSpec::plain(id).with("kernel", kernel.id())).collect()
}

/// The structures that pass `takes`, each by all settings that checks try.
pub fn with_variants(takes: impl Fn(&Entry) -> bool) -> Vec<StructureSpec> {
    let entries = entries().iter().filter(|entry| takes(entry));
    let texts =
        entries.flat_map(|entry| entry.tried().map(move |settings| format!("{}:{settings}", entry.id)));
    texts.map(|text| text.parse().expect("variants are settings")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_structure_is_made_by_its_id_and_by_its_variants() {
        for entry in entries() {
            for settings in entry.tried() {
                let text = format!("{}:{settings}", entry.id);
                let choice = parse(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
                assert_eq!(choice.builder.id(), entry.id);
                assert!(!(entry.version)().is_empty());
            }
        }
    }

    #[test]
    fn ids_are_unique() {
        let mut ids: Vec<_> =
            entries().iter().map(|e| e.id).chain(absent().into_iter().map(|a| a.id)).collect();
        ids.sort_unstable();
        let count = ids.len();
        ids.dedup();
        assert_eq!(ids.len(), count);
    }

    #[test]
    fn slips_get_suggestions() {
        let error = parse("minimax").err().unwrap();
        assert!(error.to_string().contains("near: minmax"), "{error}");
        assert!(matches!(parse("brute:simd=mmx").err().unwrap(), RegistryError::Value { .. }));
        assert!(matches!(parse("brute:sind=avx2").err().unwrap(), RegistryError::UnknownSetting { .. }));
    }

    #[test]
    fn own_structures_take_a_kernel() {
        for entry in entries() {
            let takes = entry.settings.iter().any(|(name, _)| *name == "kernel");
            assert_eq!(takes, entry.traits.built_in, "{}", entry.id);
        }
        assert_eq!(parse("minmax:kernel=watertight").unwrap().kernel(), "watertight");
    }
}
