use super::*;
use crate::grid::MARGIN;
use crate::{Aabb, Ray, Vec3};
use proptest::prelude::*;

fn grid(resolution: [u32; 3]) -> Grid {
    Grid::new(Aabb { min: Vec3::ZERO, max: Vec3::ONE }, resolution).unwrap()
}

fn walk(grid: &Grid, ray: &Ray) -> Vec<Cell> {
    grid.clip(ray).map(|segment| Walk::new(grid, &segment).collect()).unwrap_or_default()
}

#[test]
fn a_diagonal_visits_cells_in_order() {
    let grid = grid([4, 4, 4]);
    let cells = walk(&grid, &Ray::new(Vec3::splat(-1.0), Vec3::ONE));
    assert_eq!(cells.first().map(|c| c.slice), Some([0; 3]));
    assert_eq!(cells.last().map(|c| c.slice), Some([3; 3]));
    assert_eq!(cells.len(), 10);
}

#[test]
fn a_ray_in_a_slice_plane_stays_in_one_row() {
    let grid = grid([4, 4, 4]);
    for zero in [0.0, -0.0] {
        let cells = walk(&grid, &Ray::new(Vec3::new(2.0, 0.5, 0.5), Vec3::new(-1.0, zero, zero)));
        let rows: Vec<_> = cells.iter().map(|c| c.slice).collect();
        assert_eq!(rows, [[3, 2, 2], [2, 2, 2], [1, 2, 2], [0, 2, 2]]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Every point of the exact ray has a visited cell within the margin: what the
    /// registration of boxes relies on.
    #[test]
    fn no_point_of_the_ray_is_far_from_a_visited_cell(
        resolution in prop::array::uniform3(prop_oneof![1u32..9, 100u32..4097]),
        origin in prop::array::uniform3(prop_oneof![-2f32..3.0, Just(0.0), Just(0.5), Just(1.0), Just(0.25)]),
        towards in prop::array::uniform3(prop_oneof![
            -1f32..1.0, Just(0.0), Just(-0.0), Just(1.0), Just(-1.0), Just(1e-30), Just(-1e-7)
        ]),
    ) {
        let direction = Vec3::from_array(towards);
        prop_assume!(direction != Vec3::ZERO);
        let grid = grid(resolution);
        let ray = Ray::new(Vec3::from_array(origin), direction);
        let cells = walk(&grid, &ray);
        let Some((near, far)) = grid.bounds().overlap(ray.origin, ray.direction).filter(|r| r.1 >= 0.0) else {
            return Ok(());
        };
        prop_assert!(!cells.is_empty());
        let near = near.max(0.0);
        let mut from = 0;
        for i in 0..=200 {
            let t = near + (far - near) * f64::from(i) / 200.0;
            let point = [0, 1, 2].map(|a| f64::from(ray.origin[a]) + t * f64::from(ray.direction[a]));
            let is_close = |cell: &Cell| (0..3).all(|a| {
                let n = f64::from(resolution[a]);
                let (low, high) = (f64::from(cell.slice[a]) / n, (f64::from(cell.slice[a]) + 1.0) / n);
                low - MARGIN <= point[a] && point[a] <= high + MARGIN
            });
            let found = cells[from..].iter().position(is_close);
            prop_assert!(found.is_some(), "{point:?} at t = {t} is in no visited cell");
            from = (from + found.unwrap()).saturating_sub(3);
        }
    }
}
