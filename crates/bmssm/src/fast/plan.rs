//! What is built for a scene and a workload, and why.

use super::Settings;
use crate::general::Storage;
use crate::{general, raster};
use accel::{Raster, Workload};
use lanes::BLOCK;
use std::fmt;

/// What is built, and why. A structure for one image has no maps along the image's depth, as its rays need none
/// (Skala 1993, §6); without an image there are no image maps, without other rays no maps in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Number of objects.
    pub objects: usize,
    /// The image to be served and its maps.
    pub raster: Option<(Raster, raster::Settings)>,
    /// The maps for all other rays.
    pub general: Option<general::Settings>,
    /// Bytes that it will take, geometry copies included: for rays of any kind the most at any moment of building, for an image
    /// about what is held where objects are small and all are seen.
    pub bytes: u128,
    /// Those of them that rays of any kind take.
    pub beside: u128,
    reasons: Vec<String>,
}

impl Plan {
    /// Plans for a scene of so many objects, to take at most `limit` bytes where that can be.
    /// `copy` tells what a copy of the geometry takes for a number of slots.
    pub fn new(
        settings: &Settings,
        objects: usize,
        workload: &Workload,
        limit: u128,
        copy: impl Fn(usize) -> u128,
    ) -> Self {
        let mut reasons = Vec::new();
        let (mut bytes, mut beside) = (0, 0);
        let raster = workload.raster.map(|image| {
            reasons.push(format!(
                "image maps over {} row and {} column slices of {} pixels: the workload names a raster; none in depth",
                image.rows.div_ceil(raster::THICKNESS),
                image.cols.div_ceil(raster::THICKNESS),
                raster::THICKNESS
            ));
            bytes += objects as u128 * u128::from(RASTER_BYTES);
            (image, settings.raster())
        });
        let general = workload.general.then(|| {
            let threads = accel::parallel::threads();
            let takes = |storage| {
                general::bytes(objects, threads, storage, |slots| match storage {
                    Storage::Rows => copy(slots),
                    Storage::Boxes | Storage::Scene => (slots * size_of::<u32>()) as u128,
                })
            };
            let fits = |storage: &Storage| bytes + takes(*storage) <= limit;
            let (storage, why) = match settings.geometry {
                Some(storage) => (storage, "as set"),
                None => match Storage::ALL.into_iter().find(fits) {
                    Some(Storage::Rows) => (Storage::Rows, "a copy for speed"),
                    storage => (storage.unwrap_or(Storage::Scene), "copies would take more than there is"),
                },
            };
            beside = takes(storage);
            bytes += beside;
            let exact_split = exact_split(settings, objects, &mut reasons);
            reasons.push(format!("geometry={}: {why}", storage.id()));
            general::Settings { simd: settings.simd, exact_split, storage }
        });
        Self { objects, raster, general, bytes, beside, reasons }
    }
}

/// Per object: maps, and a copy of its geometry.
const RASTER_BYTES: u32 = 16 + 52;

fn exact_split(settings: &Settings, objects: usize, reasons: &mut Vec<String>) -> usize {
    let (exact_split, why) = match settings.exact_split {
        Some(exact_split) => (exact_split, "as set"),
        None => (general::EXACT_SPLIT, "the default"),
    };
    reasons.push(format!(
        "{} blocks of up to {BLOCK} objects with {} slices an axis, split by clusters of neighbours down to \
         {exact_split} objects ({why}) and then object by object: the workload names rays of any kind",
        objects.div_ceil(BLOCK),
        lanes::path::SLICES
    ));
    exact_split
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.reasons.join("\n"))
    }
}
