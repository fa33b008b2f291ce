//! Which triangles the rays of a cell of pixels pass by, told by the triangles' edges (J. Pineda, *A Parallel Algorithm for
//! Polygon Rasterization*, SIGGRAPH 1988).
//!
//! Across a raster an edge function is linear in column and row. So it is greatest in one of a cell's corners, and where it is
//! below zero even there, the whole cell is outside of the edge. Sixteen triangles are held against a cell at once.

use crate::kernel::{EdgeError, cross3, dot3, size3, sub3};
use accel::tolerance::{CORNERS, EDGE, EDGE_UNDERFLOW};
use accel::{Projection, Vec3};
use lanes::packet::{Vec3Lanes, splat3};
use lanes::{ROW, Row, Simd, Tile};

/// For each edge the greatest value in a cell at the tile's middle, and its steps from column to column and from row to row.
pub(super) const ROWS: usize = 9;

/// The rays of a tile, as kernels see them.
#[derive(Clone, Copy)]
pub(super) struct TileRays {
    projection: Projection,
    /// The origin of the middle ray, and its direction.
    origin: Vec3,
    direction: Vec3,
    /// From one column to the next, and from one row to the next.
    right: Vec3,
    down: Vec3,
    /// Sum of the greatest sizes of a direction's components, and of the terms that make an origin and its way from the middle
    /// one.
    direction_size: f32,
    origin_size: f32,
    half: [f32; 2],
    half_cell: f32,
}

impl TileRays {
    /// Of a tile, with the mesh `scale` times as large.
    #[inline(always)]
    pub fn new(tile: &Tile, scale: f32) -> Self {
        let Tile { raster, middle: [x, y], half, half_cell, .. } = *tile;
        let [origin, forward] = [raster.origin * scale, raster.forward * scale];
        let [right, down] = [raster.right * scale, raster.down * scale];
        let offset = right * x + down * y;
        let sizes = right.abs() * (x + half[0]) + down.abs() * (y + half[1]);
        let size = |fixed: Vec3| fixed.abs().element_sum();
        let change = size(right) * half[0] + size(down) * half[1];
        let (origin, direction, origin_size, direction_size) = match raster.projection {
            Projection::Parallel => {
                (origin + offset, forward, size(origin) + size(sizes) + change, size(forward))
            }
            Projection::Perspective => (origin, forward + offset, 0.0, size(forward) + size(sizes)),
        };
        let projection = raster.projection;
        Self { projection, origin, direction, right, down, direction_size, origin_size, half, half_cell }
    }
}

/// A function of column and row for each of `LANES` triangles: its value in the tile's middle, and its steps.
#[derive(Clone, Copy)]
struct Linear<S: Simd> {
    value: S::F,
    steps: [S::F; 2],
}

impl<S: Simd> Linear<S> {
    /// The product of `other` and what differs among the rays, which is `at_middle` in the tile's middle: their direction, or
    /// the way to their origin.
    #[inline(always)]
    fn of(s: S, rays: &TileRays, at_middle: Vec3Lanes<S>, other: Vec3Lanes<S>) -> Self {
        let (right, down) = (splat3(s, rays.right), splat3(s, rays.down));
        Self { value: dot3(s, at_middle, other), steps: [dot3(s, right, other), dot3(s, down, other)] }
    }

    /// By how much it changes at most so far from a place.
    #[inline(always)]
    fn change(&self, s: S, half: [f32; 2]) -> S::F {
        let [x, y] = self.steps;
        s.add(s.mul(s.abs(x), s.splat(half[0])), s.mul(s.abs(y), s.splat(half[1])))
    }
}

/// Writes, for triangles with these corners as kernels see them, what [`survivors`] looks at, from lane `at` on. Those that no ray of
/// the tile hits are told.
#[inline(always)]
pub(super) fn prepare<S: Simd>(
    s: S,
    rays: &TileRays,
    error: EdgeError,
    [a, b, c]: [Vec3Lanes<S>; 3],
    rows: &mut [Row],
    at: usize,
) -> S::M {
    let rows = &mut rows[..ROWS];
    let (edge1, edge2) = (sub3(s, b, a), sub3(s, c, a));
    let from_a = sub3(s, splat3(s, rays.origin), a);
    let direction = splat3(s, rays.direction);
    let (u, v, sum) = match rays.projection {
        Projection::Parallel => {
            let of_u = cross3(s, direction, edge2);
            let zero = s.splat(0.0);
            (
                Linear::of(s, rays, from_a, of_u),
                Linear::of(s, rays, from_a, cross3(s, edge1, direction)),
                Linear { value: dot3(s, edge1, of_u), steps: [zero, zero] },
            )
        }
        Projection::Perspective => (
            Linear::of(s, rays, direction, cross3(s, edge2, from_a)),
            Linear::of(s, rays, direction, cross3(s, from_a, edge1)),
            Linear::of(s, rays, direction, cross3(s, edge2, edge1)),
        ),
    };
    let slack = slack(s, rays, error, size3(s, from_a), s.add(size3(s, edge1), size3(s, edge2)));
    // Which side is the inner one depends on the sign of the sum, which has to be the same in the whole tile.
    let least = s.add(sum.change(s, rays.half), slack);
    let (front, back) = (s.lt(least, sum.value), s.lt(sum.value, s.sub(s.splat(0.0), least)));
    let known = s.or(front, back);
    let third = Linear {
        value: s.sub(s.sub(sum.value, u.value), v.value),
        steps: [
            s.sub(s.sub(sum.steps[0], u.steps[0]), v.steps[0]),
            s.sub(s.sub(sum.steps[1], u.steps[1]), v.steps[1]),
        ],
    };
    let sign = s.select(back, s.splat(-1.0), s.splat(1.0));
    let mut outside = s.mask(0);
    for (edge, rows) in [u, v, third].iter().zip(rows.chunks_exact_mut(3)) {
        let value = s.add(s.mul(edge.value, sign), slack);
        let far = s.add(value, edge.change(s, rays.half));
        outside = s.or(outside, s.lt(far, s.splat(0.0)));
        let most = s.add(value, edge.change(s, [rays.half_cell; 2]));
        s.store(s.select(known, most, s.splat(f32::INFINITY)), &mut rows[0].0[at..]);
        s.store(s.mul(edge.steps[0], sign), &mut rows[1].0[at..]);
        s.store(s.mul(edge.steps[1], sign), &mut rows[2].0[at..]);
    }
    s.and(known, outside)
}

/// By how much an edge function may be wrong, for triangles with edges of this size whose first corner is so far from the origin.
#[inline(always)]
fn slack<S: Simd>(s: S, rays: &TileRays, error: EdgeError, way: S::F, edges: S::F) -> S::F {
    let direction = s.splat(rays.direction_size);
    let way = s.add(s.add(way, s.splat(rays.origin_size)), edges);
    let (part, other) = match error {
        EdgeError::Edge => (EDGE, edges),
        EdgeError::Corners => (CORNERS, way),
    };
    let tiny = s.splat(EDGE_UNDERFLOW);
    // Eight times as large, so that where sums of determinants overflow this does, and is no bound.
    let sizes = s.mul(s.mul(s.splat(8.0), s.add(direction, tiny)), s.mul(way, other));
    s.add(s.mul(sizes, s.splat(part / 8.0)), s.mul(tiny, s.add(s.splat(1.0), s.add(direction, way))))
}

/// Of the triangles in [`ROW`] lanes those that rays may hit in a cell with its middle so far from the tile's, as bits.
#[inline(always)]
pub(super) fn survivors<S: Simd>(s: S, rows: &[Row], [x, y]: [f32; 2]) -> u32 {
    let rows = &rows[..ROWS];
    let (x, y) = (s.splat(x), s.splat(y));
    let mut culled = 0;
    for at in (0..ROW).step_by(S::LANES) {
        let mut outside = s.mask(0);
        for edge in rows.chunks_exact(3) {
            let [most, right, down] =
                [s.load(&edge[0].0[at..]), s.load(&edge[1].0[at..]), s.load(&edge[2].0[at..])];
            let most = s.add(most, s.add(s.mul(right, x), s.mul(down, y)));
            // Not a number is below nothing.
            outside = s.or(outside, s.lt(most, s.splat(0.0)));
        }
        culled |= s.bits(outside) << at;
    }
    !culled & 0xffff
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::KernelId;
    use crate::triangles::Triangles;
    use crate::{TriangleKernel, WithKernel};
    use accel::{Mesh, Raster};
    use lanes::{Blocks, Level, PackedObjects, Task};
    use proptest::prelude::*;

    /// Pixels across a cell, and cells across a tile.
    const CELL: u32 = 4;
    const CELLS: u32 = 5;

    /// What becomes of the triangles of a mesh in the cells of one tile.
    struct Culled<'a> {
        mesh: &'a Mesh,
        raster: &'a Raster,
        /// The tile's first row and column of cells.
        first: [u32; 2],
        half_cell: f32,
        level: Level,
    }

    /// Triangles in cells that no ray hits, those of them that are culled, and those that are culled and hit.
    #[derive(Debug, Default, PartialEq)]
    struct Counted {
        missed: u32,
        culled: u32,
        wrong: u32,
    }

    struct InLanes<'a, B>(&'a B, Tile<'a>, [u32; 2]);

    impl<B: Blocks> Task for InLanes<'_, B> {
        /// Those that survive the tile, and for each cell those that survive it.
        type Out = (u32, Vec<u32>);

        #[inline(always)]
        fn run<S: Simd>(self, s: S) -> Self::Out {
            let mut rows = vec![Row([0.0; ROW]); B::CULLING_ROWS];
            let shown = self.0.prepare_culling(s, 0, &self.1, &mut rows);
            let mut cells = Vec::new();
            for cell in 0..CELLS * CELLS {
                let [row, col] = self.2;
                cells.push(B::survivors(s, &rows, self.1.cell(row + cell / CELLS, col + cell % CELLS)));
            }
            (shown, cells)
        }
    }

    impl WithKernel for Culled<'_> {
        type Out = Counted;

        fn kernel<K: TriangleKernel>(self) -> Counted {
            let Self { mesh, raster, first, half_cell, level } = self;
            let triangles = Triangles::<K>::new(mesh);
            let count = mesh.triangles.len() as u32;
            let blocks = triangles.blocks("test", &(0..count).collect::<Vec<_>>()).unwrap();
            let [row, col] = first;
            let mut tile = Tile::new(raster, row..row + CELLS, col..col + CELLS, CELL);
            tile.half_cell = half_cell;
            let (shown, cells) = level.run(InLanes(&blocks, tile, first));
            let hit = |id: u32, cell: u32| {
                let (row, col) = ((row + cell / CELLS) * CELL, (col + cell % CELLS) * CELL);
                let corners = triangles.frame.corners(&triangles.corners(id));
                (0..CELL * CELL).any(|i| {
                    let ray = triangles.frame.ray(&raster.ray(row + i / CELL, col + i % CELL));
                    K::test(&K::one(&ray), &corners, f32::INFINITY).is_some()
                })
            };
            let mut counted = Counted::default();
            for (cell, survivors) in (0..).zip(cells) {
                for id in 0..count {
                    let (hit, culled) = (hit(id, cell), (survivors & shown) >> id & 1 == 0);
                    counted.missed += u32::from(!hit);
                    counted.culled += u32::from(culled);
                    counted.wrong += u32::from(culled && hit);
                }
            }
            counted
        }
    }

    /// Triangles of all sizes: some of their corners are on rays, some share an edge, some are seen edge on.
    fn triangles(raster: &Raster, picks: &[u32]) -> Mesh {
        let mut numbers = accel::testing::Numbers(u64::from(picks[0]));
        let mut mesh = Mesh::default();
        for (i, pick) in (0..).zip(picks) {
            let ray = |n: u32| raster.ray(n / 7 % 23, n % 29);
            let on = |n: u32| ray(n).origin + ray(n).direction * (1.0 + (n % 5) as f32 / 4.0);
            let mut near = |from: Vec3, size: f32| {
                from + (numbers.vec3() * 2.0 - 1.0) * (size * raster.right.length() * 20.0)
            };
            let first = on(*pick);
            let corners = match pick % 5 {
                0 => [first, on(pick / 3), on(pick / 11)],
                1 => [first, near(first, 0.2), near(first, 0.2)],
                2 => [first, on(pick / 3), near(first, 1.0)],
                3 => [first, first + ray(*pick).direction, near(first, 3.0)],
                _ => [near(first, 0.0), near(first, 9.0), near(first, 0.05)],
            };
            mesh.positions.extend(corners);
            mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        mesh
    }

    /// Images from a lattice, and others; `exponent` scales all of it.
    fn raster(projection: Projection, seed: u32, exponent: i32) -> Raster {
        let mut numbers = accel::testing::Numbers(u64::from(seed));
        let scale = 2f32.powi(exponent);
        let step = if seed.is_multiple_of(2) { 0.125 } else { 0.1 * (0.5 + numbers.unit()) };
        let tilt = if seed % 4 < 2 { Vec3::ZERO } else { numbers.vec3() * step };
        Raster {
            projection,
            rows: 64,
            cols: 64,
            origin: (numbers.vec3() * 8.0).round() * scale,
            forward: Vec3::new(-2.0, -2.0, 4.0) * scale,
            right: (Vec3::X * step + tilt * 0.25) * scale,
            down: (Vec3::Y * step + Vec3::new(tilt.y, tilt.z, tilt.x) * 0.25) * scale,
        }
    }

    fn counted(kernel: KernelId, raster: &Raster, picks: &[u32], half_cell: f32, level: Level) -> Counted {
        let mesh = triangles(raster, picks);
        kernel.with(Culled { mesh: &mesh, raster, first: [1, 2], half_cell, level })
    }

    fn culls(kernel: KernelId) -> bool {
        struct Has;
        impl WithKernel for Has {
            type Out = bool;
            fn kernel<K: TriangleKernel>(self) -> bool {
                K::EDGE_ERROR.is_some()
            }
        }
        kernel.with(Has)
    }

    proptest! {
        #[test]
        fn what_is_culled_is_not_hit(
            parallel: bool,
            seed: u32,
            exponent in prop_oneof![Just(0), -60..60i32, -140..120i32],
            picks in prop::collection::vec(0..1_000_000u32, 1..=ROW),
        ) {
            let projection = if parallel { Projection::Parallel } else { Projection::Perspective };
            let raster = raster(projection, seed, exponent);
            for kernel in KernelId::ALL.into_iter().filter(|kernel| culls(*kernel)) {
                let mut before = None;
                for level in Level::here() {
                    let counted = counted(kernel, &raster, &picks, 1.5, level);
                    prop_assert_eq!(counted.wrong, 0, "{} {:?}", kernel, level);
                    prop_assert_eq!(before.get_or_insert(counted.culled), &counted.culled);
                }
            }
        }
    }

    /// In all of 200 scenes, with cells of a size.
    fn in_many_scenes(kernel: KernelId, half_cell: f32) -> Counted {
        let mut sum = Counted::default();
        for seed in 0..200 {
            let projection = [Projection::Parallel, Projection::Perspective][seed as usize % 2];
            let picks: Vec<u32> = (0..ROW as u32).map(|i| (seed * 7919 + i * 104_729) % 999_983).collect();
            let of = counted(kernel, &raster(projection, seed / 2, 0), &picks, half_cell, Level::best());
            sum.missed += of.missed;
            sum.culled += of.culled;
            sum.wrong += of.wrong;
        }
        sum
    }

    #[test]
    fn most_triangles_beside_a_cell_are_culled() {
        for kernel in KernelId::ALL {
            let Counted { missed, culled, wrong } = in_many_scenes(kernel, 1.5);
            assert_eq!(wrong, 0, "{kernel}");
            assert_eq!(culled > missed / 2, culls(kernel), "{kernel}: {culled} of {missed}");
        }
    }

    #[test]
    fn cells_taken_for_points_cull_triangles_that_are_hit() {
        let kernels = KernelId::ALL.into_iter().filter(|kernel| culls(*kernel));
        assert!(kernels.map(|kernel| in_many_scenes(kernel, 0.0).wrong).all(|wrong| wrong > 100));
    }
}
