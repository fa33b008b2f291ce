//! A picture held to the exact one.

use super::shade::{Shading, depth, shade};
use accel::{Geometry, Hit, Raster};
use harness::units;
use image::imageops::{FilterType, crop_imm, replace, resize};
use image::{Rgba, RgbaImage};
use judge::{Counts, Kind};
use serde::Serialize;

/// How wrong a picture is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Wrongness {
    /// Pixels by kind.
    pub counts: Counts,
    /// Pixels whose colour is not the exact picture's.
    pub colours: u64,
    /// Largest difference of a channel, of 255.
    pub shading_largest: f64,
    /// Its mean over all pixels.
    pub shading_mean: f64,
    /// Largest difference of depth, in extents of the scene, where both hit.
    pub depth_largest: f64,
    /// Its mean over those pixels.
    pub depth_mean: f64,
}

impl Wrongness {
    /// The pixels by kind, in words.
    pub fn kinds(&self) -> String {
        let Counts { holes, phantoms, displaced, swapped, .. } = self.counts;
        format!(
            "{holes} holes, {phantoms} phantoms, {displaced} displaced, {swapped} on another object in the same place"
        )
    }

    /// By how much colours and depths are off, in words.
    pub fn sizes(&self) -> String {
        format!(
            "shading off by {} of 255 at most, {} on average, depth by {} of the extent at most, {} on average",
            units::figure(self.shading_largest),
            units::figure(self.shading_mean),
            units::figure(self.depth_largest),
            units::figure(self.depth_mean),
        )
    }
}

/// A picture, the exact one, and where they differ.
pub struct Compared {
    /// As the structure sees it.
    pub picture: RgbaImage,
    /// As it is.
    pub exact: RgbaImage,
    /// Pale, with wrong pixels in colour: vermilion for holes, blue for phantoms, sky blue for displaced hits, orange for other
    /// objects.
    pub marked: RgbaImage,
    /// The figures.
    pub wrong: Wrongness,
    kinds: Vec<Option<Kind>>,
}

/// Of the palette of Okabe and Ito, which the colour-blind can tell apart; a tie is no error.
const fn colour(kind: Kind) -> Option<Rgba<u8>> {
    match kind {
        Kind::Hole => Some(Rgba([213, 94, 0, 255])),
        Kind::Phantom => Some(Rgba([0, 114, 178, 255])),
        Kind::Displaced => Some(Rgba([86, 180, 233, 255])),
        Kind::Swapped => Some(Rgba([230, 159, 0, 255])),
        Kind::Tie => None,
    }
}

/// Compares the pictures of two lists of hits, of which the second is exact; `kinds` says what is wrong with each of the first.
///
/// # Panics
/// If there is not one hit and kind for each pixel.
pub fn compare(
    geometry: &Geometry,
    raster: &Raster,
    [hits, exact]: [&[Option<Hit>]; 2],
    kinds: Vec<Option<Kind>>,
    shading: Shading,
) -> Compared {
    assert_eq!(kinds.len(), raster.len(), "one kind for each pixel");
    let bounds = geometry.bounds();
    let extent = (bounds.max.as_dvec3() - bounds.min.as_dvec3()).max_element();
    let extent = if extent > 0.0 { extent } else { 1.0 };
    let picture = shade(geometry, raster, hits, shading);
    let right = shade(geometry, raster, exact, shading);
    let mut wrong = Wrongness::default();
    kinds.iter().for_each(|kind| wrong.counts.add(*kind));
    for (a, b) in picture.pixels().zip(right.pixels()) {
        let off = a.0.iter().zip(b.0).map(|(a, b)| f64::from(a.abs_diff(b))).fold(0.0, f64::max);
        wrong.colours += u64::from(off > 0.0);
        wrong.shading_largest = wrong.shading_largest.max(off);
        wrong.shading_mean += off / raster.len().max(1) as f64;
    }
    let mut both = 0u64;
    for (i, pair) in hits.iter().zip(exact).enumerate() {
        let (Some(a), Some(b)) = pair else { continue };
        let ray = raster.ray((i / raster.cols as usize) as u32, (i % raster.cols as usize) as u32);
        let off = f64::from((depth(&ray, a) - depth(&ray, b)).abs()) / extent;
        both += 1;
        wrong.depth_largest = wrong.depth_largest.max(off);
        wrong.depth_mean += off;
    }
    wrong.depth_mean /= both.max(1) as f64;
    let mut marked = picture.clone();
    for (pixel, kind) in marked.pixels_mut().zip(&kinds) {
        *pixel = kind.and_then(colour).unwrap_or_else(|| super::difference::pale(*pixel));
    }
    Compared { picture, exact: right, marked, wrong, kinds }
}

/// White space between enlarged pictures.
const GAP: u32 = 8;

impl Compared {
    /// The corner of the square of `side` pixels with the most visible errors; `None` where there is none.
    pub fn worst(&self, side: u32) -> Option<(u32, u32)> {
        let (width, height) = self.picture.dimensions();
        let side = side.min(width).min(height);
        let shows = |kind: &Option<Kind>| kind.is_some_and(|kind| Kind::VISIBLE.contains(&kind));
        // Sums over all rectangles from the first pixel on, so that each square takes four of them.
        let stride = width as usize + 1;
        let mut sums = vec![0u32; stride * (height as usize + 1)];
        for y in 0..height as usize {
            for x in 0..width as usize {
                let here = u32::from(shows(&self.kinds[y * width as usize + x]));
                let (above, left) = (sums[y * stride + x + 1], sums[(y + 1) * stride + x]);
                sums[(y + 1) * stride + x + 1] = here + above + left - sums[y * stride + x];
            }
        }
        let count = |x: u32, y: u32| {
            let at = |x: u32, y: u32| sums[y as usize * stride + x as usize];
            at(x + side, y + side) + at(x, y) - at(x + side, y) - at(x, y + side)
        };
        let corners = (0..=height - side).flat_map(|y| (0..=width - side).map(move |x| (x, y)));
        let best = corners.max_by_key(|(x, y)| (count(*x, *y), std::cmp::Reverse((*y, *x))))?;
        (count(best.0, best.1) > 0).then_some(best)
    }

    /// A square enlarged: as the structure sees it, as it is, and what is wrong, side by side.
    pub fn enlarged(&self, (x, y): (u32, u32), side: u32, times: u32) -> RgbaImage {
        let side = side.min(self.picture.width()).min(self.picture.height());
        let size = side * times;
        let mut out = RgbaImage::from_pixel(3 * size + 2 * GAP, size, Rgba([255, 255, 255, 0]));
        for (i, picture) in [&self.picture, &self.exact, &self.marked].into_iter().enumerate() {
            let part = crop_imm(picture, x, y, side, side).to_image();
            let part = resize(&part, size, size, FilterType::Nearest);
            replace(&mut out, &part, i64::from(i as u32 * (size + GAP)), 0);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::{Mesh, Projection, Vec3};

    #[test]
    fn kinds_are_coloured_and_differences_measured() {
        let positions = vec![Vec3::ZERO, Vec3::X * 8.0, Vec3::Y * 8.0];
        let mesh = Geometry::Triangles(Mesh { positions, triangles: vec![[0, 1, 2], [0, 1, 2]] });
        let raster = Raster {
            projection: Projection::Parallel,
            rows: 2,
            cols: 4,
            origin: Vec3::new(0.0, 0.0, 5.0),
            forward: Vec3::NEG_Z,
            right: Vec3::X,
            down: Vec3::Y,
        };
        let hit = |t, object| Some(Hit { t, object, u: 0.1, v: 0.1 });
        let exact = vec![hit(5.0, 0); 8];
        let mut hits = exact.clone();
        let mut kinds = vec![None; 8];
        (hits[6], kinds[6]) = (None, Some(Kind::Hole));
        (hits[7], kinds[7]) = (hit(7.0, 0), Some(Kind::Displaced));
        (hits[0], kinds[0]) = (hit(5.0, 1), Some(Kind::Swapped));
        let found = compare(&mesh, &raster, [&hits, &exact], kinds, Shading::Light);
        assert_eq!((found.wrong.counts.visible(), found.wrong.counts.swapped), (2, 1));
        assert_eq!((found.wrong.depth_largest, found.wrong.depth_mean), (0.25, 0.25 / 7.0));
        assert!(found.wrong.shading_largest == 255.0 && found.wrong.colours >= 1);
        assert_eq!(Some(*found.marked.get_pixel(2, 1)), colour(Kind::Hole));
        assert_eq!(found.worst(2), Some((2, 0)));
        assert_eq!(found.enlarged((2, 0), 2, 10).dimensions(), (3 * 20 + 2 * GAP, 20));
        let none = compare(&mesh, &raster, [&exact, &exact], vec![None; 8], Shading::Light);
        assert_eq!((none.worst(2), none.wrong.colours, none.wrong.shading_mean), (None, 0, 0.0));
    }
}
