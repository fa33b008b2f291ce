//! All that a ray may meet, however far away.

use super::SpaceMaps;
use super::trace::Built;
use accel::Ray;
use accel::dda::Walk;
use lanes::ones;

impl<O, D> Built<O, D> {
    /// Appends the objects that ⁱR & ʲS & ᵏT names in any cell on the ray's way, or ⁱR & ʲS for a ray of the image where there
    /// are maps of nothing else.
    ///
    /// # Panics
    /// If the structure was built for one image, and the ray is none of it.
    pub(super) fn gather(&self, ray: &Ray, found: &mut Vec<u32>) {
        let mut met = vec![0u64; self.objects.div_ceil(64)];
        match (&self.space, &self.image) {
            (Some(maps), _) => through_cells(maps, ray, &mut met),
            (None, Some(maps)) if !self.general => {
                let raster = &maps.raster;
                let pixel = |i: usize| (i as u32 / raster.cols, i as u32 % raster.cols);
                let mut pixels = (0..raster.len()).map(pixel);
                let pixel = pixels.find(|&(row, col)| raster.ray(row, col) == *ray);
                let (row, col) = pixel.unwrap_or_else(|| panic!("built for the rays of one image only"));
                for (met, (r, s)) in met.iter_mut().zip(maps.rows.slice(row).iter().zip(maps.cols.slice(col)))
                {
                    *met = r & s;
                }
            }
            _ => {}
        }
        for (index, word) in met.into_iter().enumerate() {
            found.extend(ones(word).map(|bit| (index * 64 + bit) as u32));
        }
    }
}

fn through_cells(maps: &SpaceMaps, ray: &Ray, met: &mut [u64]) {
    let Some(segment) = maps.grid.clip(ray) else { return };
    for cell in Walk::new(&maps.grid, &segment) {
        let [r, s, t] = maps.cell(cell.slice);
        for (met, ((r, s), t)) in met.iter_mut().zip(r.iter().zip(s).zip(t)) {
            *met |= r & s & t;
        }
    }
}
