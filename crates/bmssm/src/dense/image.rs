//! Maps of an image: R for rows, S for columns (Skala 1993, §2, §4).

use super::Axis;
use accel::image_space::ImageSpace;
use accel::{Bounds, BuildError, Raster};

/// The bit maps of a raster. Every primary ray is the meet of a row plane and a column plane, so
/// ⁱR & ʲS are its candidates; there are no slices in depth, "not convenient for primary ray
/// tracing" (§6).
#[derive(Clone, Debug)]
pub struct ImageMaps {
    /// The raster they are made for.
    pub raster: Raster,
    /// R: which objects' boxes each row plane meets.
    pub rows: Axis,
    /// S: which objects' boxes each column plane meets.
    pub cols: Axis,
}

/// Which objects the planes of an image meet (Skala 1993, §2, "image consistency").
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coverage {
    /// V: objects met by some row plane.
    pub rows: Vec<u64>,
    /// W: objects met by some column plane.
    pub cols: Vec<u64>,
    objects: usize,
}

impl ImageMaps {
    /// Maps the boxes of `objects`. An object behind the eye has no bit.
    ///
    /// # Panics
    /// If memory doesn't hold the maps.
    pub fn new<B: Bounds>(objects: &B, raster: Raster) -> Self {
        Self::try_new(objects, raster).unwrap_or_else(|error| panic!("{error}"))
    }

    /// As [`ImageMaps::new`].
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if memory doesn't hold the maps.
    pub fn try_new<B: Bounds>(objects: &B, raster: Raster) -> Result<Self, BuildError> {
        let space = ImageSpace::new(&raster);
        let mut rows = Axis::try_new(raster.rows as usize, objects.len())?;
        let mut cols = Axis::try_new(raster.cols as usize, objects.len())?;
        for id in 0..objects.len() as u32 {
            let pixels = space.pixels(&objects.bounds(id));
            rows.touch(pixels.rows, id);
            cols.touch(pixels.cols, id);
        }
        Ok(Self { raster, rows, cols })
    }

    /// Bytes of the maps of so many objects.
    pub fn bytes_of(raster: &Raster, objects: usize) -> u128 {
        Axis::bytes_of(raster.rows as usize, objects) + Axis::bytes_of(raster.cols as usize, objects)
    }

    /// Number of candidates of a pixel: the bits of ⁱʲQ.
    ///
    /// # Panics
    /// If there is no such pixel.
    pub fn candidates(&self, row: u32, col: u32) -> u32 {
        let words = self.rows.slice(row).iter().zip(self.cols.slice(col));
        words.map(|(r, s)| (r & s).count_ones()).sum()
    }

    /// V and W.
    pub fn coverage(&self) -> Coverage {
        Coverage { rows: self.rows.coverage(), cols: self.cols.coverage(), objects: self.rows.objects() }
    }
}

impl Coverage {
    /// The objects that no ray of the image can hit: those with a 0 in V or in W, in ascending order.
    pub fn unseen(&self) -> Vec<u32> {
        let seen = |id: usize| (self.rows[id / 64] & self.cols[id / 64]) >> (id % 64) & 1 == 1;
        (0..self.objects).filter(|id| !seen(*id)).map(|id| id as u32).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::{Aabb, Projection, Vec3};
    use primitives::Boxes;

    #[test]
    fn objects_between_the_planes_or_beside_the_image_are_unseen() {
        let raster = Raster {
            projection: Projection::Parallel,
            rows: 4,
            cols: 4,
            origin: Vec3::ZERO,
            forward: Vec3::Z,
            right: Vec3::X,
            down: Vec3::Y,
        };
        let cube = |x: f32, y: f32, side: f32| {
            let min = Vec3::new(x, y, 1.0);
            Aabb { min, max: min + side }
        };
        let boxes = [cube(0.4, 0.4, 0.2), cube(0.6, 0.4, 0.2), cube(1.4, 1.4, 0.8), cube(7.0, 0.0, 1.0)];
        let maps = ImageMaps::new(&Boxes::new(&boxes), raster);
        let coverage = maps.coverage();
        assert_eq!(coverage.rows, [0b1111]);
        assert_eq!(coverage.cols, [0b0101]);
        assert_eq!(coverage.unseen(), [1, 3]);
        assert_eq!((maps.candidates(0, 0), maps.candidates(1, 1), maps.candidates(3, 3)), (1, 1, 0));
    }
}
