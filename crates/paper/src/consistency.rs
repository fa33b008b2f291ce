//! Image consistency (Skala 1993, §2): objects with a 0 in V or W can't be hit by any ray of the image.

use accel::{Accel, BuildError, Builder, Geometry, Hit, Raster, RaySet, Scene, Vec3, Workload};
use baselines::Brute;
use bmssm::suite::dense::{BmssmDense, ImageMaps};
use image::{Rgb, RgbImage};
use lanes::PackedObjects;
use primitives::KernelId;
use primitives::WithObjects;
use scenes::rays;
use serde::{Deserialize, Serialize};

/// An image of so many rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Resolution {
    /// Rows and columns.
    pub pixels: u32,
    /// Objects with a 0 in V: between the row planes, or outside.
    pub no_row: usize,
    /// Objects with a 0 in W.
    pub no_column: usize,
    /// Objects with a 0 in V or W.
    pub unseen: usize,
    /// Objects that some ray hits first.
    pub visible: usize,
    /// Of the objects visible in the finest image, those that no ray of this one can hit.
    pub visible_lost: usize,
    /// Of the unseen ones the first few.
    pub first_unseen: Vec<u32>,
}

/// A scene at falling resolution.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Consistency {
    /// The scene.
    pub scene: String,
    /// Its objects.
    pub objects: usize,
    /// From fine to coarse.
    pub resolutions: Vec<Resolution>,
    /// The resolution at which the unseen objects of the picture are unseen.
    pub marked_at: u32,
    /// Pixels of the picture that show such an object.
    pub marked_pixels: usize,
}

/// Rows and columns of the picture, and of the finest image.
const PICTURE: u32 = 1024;

/// Rows and columns of the images, from fine to coarse.
const FALLING: [u32; 6] = [1024, 512, 256, 128, 64, 32];

/// The image whose unseen objects the picture marks.
const MARKED_AT: u32 = 128;

struct Maps(Raster);

impl<'s> WithObjects<'s> for Maps {
    type Out = ImageMaps;
    fn objects<O: PackedObjects + 's>(self, objects: O) -> ImageMaps {
        ImageMaps::new(&objects, self.0)
    }
}

/// V and W at falling resolution, and a picture in which the objects unseen at 128 × 128 are red.
///
/// # Errors
/// Where the maps of the largest image would not fit in memory.
pub fn evaluate(scene: &Scene) -> Result<(Consistency, RgbImage), BuildError> {
    let mut out = Consistency {
        scene: scene.id.clone(),
        objects: scene.geometry.len(),
        marked_at: MARKED_AT,
        ..Consistency::default()
    };
    let mut finest = vec![false; out.objects];
    let mut picture = RgbImage::new(PICTURE, PICTURE);
    let mut shown = Vec::new();
    for pixels in FALLING {
        let raster = rays::perspective(&scene.view, pixels, pixels);
        let hits = trace(scene, raster)?;
        let coverage = primitives::with_objects(scene, KernelId::MollerTrumbore, Maps(raster)).coverage();
        let zeros = |map: &[u64]| out.objects - map.iter().map(|w| w.count_ones() as usize).sum::<usize>();
        let unseen = coverage.unseen();
        let mut visible = vec![false; out.objects];
        hits.iter().flatten().for_each(|hit| visible[hit.object as usize] = true);
        if pixels == FALLING[0] {
            finest.clone_from(&visible);
            shown = hits;
        }
        if pixels == MARKED_AT {
            let mut marked = vec![false; out.objects];
            unseen.iter().for_each(|id| marked[*id as usize] = true);
            let raster = rays::perspective(&scene.view, PICTURE, PICTURE);
            out.marked_pixels = paint(scene, &raster, &shown, &marked, &mut picture);
        }
        let resolution = Resolution {
            pixels,
            no_row: zeros(&coverage.rows),
            no_column: zeros(&coverage.cols),
            visible: visible.iter().filter(|v| **v).count(),
            visible_lost: unseen.iter().filter(|id| finest[**id as usize]).count(),
            first_unseen: unseen.iter().copied().take(8).collect(),
            unseen: unseen.len(),
        };
        out.resolutions.push(resolution);
    }
    Ok((out, picture))
}

fn trace(scene: &Scene, raster: Raster) -> Result<Vec<Option<Hit>>, BuildError> {
    let rays = RaySet::Raster(raster);
    let mut hits = vec![None; rays.len()];
    BmssmDense::default().build(scene, &Workload::of(&rays))?.trace(&rays, &mut hits);
    Ok(hits)
}

/// Shades by the angle of ray and surface, objects that are marked in red; returns their pixels.
fn paint(
    scene: &Scene,
    raster: &Raster,
    hits: &[Option<Hit>],
    marked: &[bool],
    picture: &mut RgbImage,
) -> usize {
    let Geometry::Triangles(mesh) = &scene.geometry else { return 0 };
    let mut count = 0;
    for (index, (hit, pixel)) in hits.iter().zip(picture.pixels_mut()).enumerate() {
        let Some(hit) = hit else {
            *pixel = Rgb([255, 255, 255]);
            continue;
        };
        let [a, b, c] = mesh.corners(hit.object as usize);
        let cols = raster.cols as usize;
        let ray = raster.ray((index / cols) as u32, (index % cols) as u32);
        let normal: Vec3 = (b - a).cross(c - a).normalize_or_zero();
        let light = 0.25 + 0.7 * normal.dot(ray.direction.normalize_or_zero()).abs();
        let grey = (light * 255.0) as u8;
        *pixel = if marked[hit.object as usize] { Rgb([grey, grey / 6, grey / 6]) } else { Rgb([grey; 3]) };
        count += usize::from(marked[hit.object as usize]);
    }
    count
}

/// Whether no object of `unseen` is hit by any ray of the raster, by brute force.
///
/// # Errors
/// As [`Builder::build`].
pub fn holds(scene: &Scene, raster: Raster, unseen: &[u32]) -> Result<bool, BuildError> {
    let rays = RaySet::Raster(raster);
    let mut hits = vec![None; rays.len()];
    let brute: Box<dyn Accel + '_> =
        Brute::new(KernelId::MollerTrumbore).build(scene, &Workload::of(&rays))?;
    brute.trace(&rays, &mut hits);
    Ok(!hits.iter().flatten().any(|hit| unseen.binary_search(&hit.object).is_ok()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenes::load;

    #[test]
    fn unseen_objects_are_hit_by_no_ray() {
        let scene = load(&"bumps-2k".parse().unwrap()).unwrap();
        let raster = rays::perspective(&scene.view, 24, 24);
        let maps = primitives::with_objects(&scene, KernelId::MollerTrumbore, Maps(raster));
        let unseen = maps.coverage().unseen();
        assert!(!unseen.is_empty() && unseen.len() < 2000);
        assert!(holds(&scene, raster, &unseen).unwrap());
        let all: Vec<u32> = (0..scene.geometry.len() as u32).collect();
        assert!(!holds(&scene, raster, &all).unwrap(), "some object is hit");
    }
}
