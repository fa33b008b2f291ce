//! Where two structures' hits differ.

use accel::Hit;
use image::{Rgba, RgbaImage};
use serde::Serialize;

/// How many pixels differ, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Differences {
    /// Pixels compared.
    pub pixels: u64,
    /// Hit by the other only.
    pub missed: u64,
    /// Hit by the first only.
    pub invented: u64,
    /// Different objects.
    pub object: u64,
    /// The same object at another t, u or v.
    pub place: u64,
}

impl Differences {
    /// Pixels that differ in any way.
    pub const fn total(&self) -> u64 {
        self.missed + self.invented + self.object + self.place
    }

    fn count(&mut self, kind: Option<Kind>) {
        self.pixels += 1;
        match kind {
            None => {}
            Some(Kind::Missed) => self.missed += 1,
            Some(Kind::Invented) => self.invented += 1,
            Some(Kind::Object) => self.object += 1,
            Some(Kind::Place) => self.place += 1,
        }
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Missed,
    Invented,
    Object,
    Place,
}

impl Kind {
    fn of(hit: Option<&Hit>, other: Option<&Hit>) -> Option<Self> {
        match (hit, other) {
            (None, None) => None,
            (None, Some(_)) => Some(Self::Missed),
            (Some(_), None) => Some(Self::Invented),
            (Some(a), Some(b)) if a.same_bits(b) => None,
            (Some(a), Some(b)) if a.object == b.object => Some(Self::Place),
            (Some(_), Some(_)) => Some(Self::Object),
        }
    }

    /// Of the palette of Okabe and Ito, which the colour-blind can tell apart.
    const fn colour(self) -> Rgba<u8> {
        match self {
            Self::Missed => Rgba([213, 94, 0, 255]),
            Self::Invented => Rgba([0, 114, 178, 255]),
            Self::Object => Rgba([230, 159, 0, 255]),
            Self::Place => Rgba([86, 180, 233, 255]),
        }
    }
}

/// `picture` in pale grey, with the pixels in colour whose `hits` are not, bit for bit, `other`:
/// vermilion for missed, blue for invented, orange for another object, sky blue for another
/// place on the same object.
///
/// # Panics
/// If the sizes don't fit.
pub fn difference(
    picture: &RgbaImage,
    hits: &[Option<Hit>],
    other: &[Option<Hit>],
) -> (RgbaImage, Differences) {
    assert_eq!(hits.len(), other.len(), "two hits for each pixel");
    assert_eq!(hits.len() as u64, u64::from(picture.width()) * u64::from(picture.height()));
    let mut differences = Differences::default();
    let mut out = picture.clone();
    for ((pixel, hit), other) in out.pixels_mut().zip(hits).zip(other) {
        let kind = Kind::of(hit.as_ref(), other.as_ref());
        differences.count(kind);
        *pixel = kind.map_or_else(|| pale(*pixel), Kind::colour);
    }
    (out, differences)
}

pub(super) fn pale(Rgba([r, g, b, alpha]): Rgba<u8>) -> Rgba<u8> {
    let grey = (u32::from(r) + u32::from(g) + u32::from(b)) / 3;
    let grey = (155 + grey * 90 / 255) as u8;
    Rgba([grey, grey, grey, alpha])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_counted_and_coloured() {
        let hit = |t, object| Some(Hit { t, object, u: 0.0, v: 0.0 });
        let hits = [None, hit(1.0, 1), hit(1.0, 1), hit(1.0, 1), hit(0.0, 1), None];
        let other = [hit(1.0, 1), None, hit(1.0, 2), hit(1.5, 1), hit(-0.0, 1), None];
        let (picture, differences) = difference(&RgbaImage::new(6, 1), &hits, &other);
        assert_eq!(differences, Differences { pixels: 6, missed: 1, invented: 1, object: 1, place: 2 });
        assert_eq!(differences.total(), 5);
        assert_eq!(*picture.get_pixel(0, 0), Kind::Missed.colour());
        assert_eq!(picture.get_pixel(5, 0).0[3], 0, "equal misses stay transparent");
    }
}
