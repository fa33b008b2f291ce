use super::*;

/// Applies every operation to rows of awkward values and gathers the bits.
struct Everything;

impl Task for Everything {
    type Out = Vec<u32>;

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Vec<u32> {
        let values = [0.0, -0.0, 1.0, -1.5, 1e-40, 3e38, -3e38, f32::INFINITY];
        let a: [f32; ROW] = std::array::from_fn(|i| values[i % 8]);
        let b: [f32; ROW] = std::array::from_fn(|i| values[(i * 3 + i / 8 + 1) % 8]);
        let mut out = Vec::new();
        let mut masks = [0u32; 5];
        for at in (0..ROW).step_by(S::LANES) {
            let (x, y) = (s.load(&a[at..]), s.load(&b[at..]));
            let lt = s.lt(x, y);
            for (mask, m) in masks.iter_mut().zip([
                lt,
                s.le(x, y),
                s.and(s.eq(x, y), s.le(x, y)),
                s.or(lt, s.mask(0x5555 >> at)),
                s.lt_u(s.splat_u(0x7fff_ffff), s.select_u(lt, s.splat_u(0x8000_0000), s.splat_u(1))),
            ]) {
                *mask |= s.bits(m) << at;
            }
            let computed = [
                s.add(x, y),
                s.sub(x, y),
                s.mul(x, y),
                s.abs(s.div(x, y)),
                s.sqrt(s.abs(s.div(x, y))),
                s.abs(s.min(x, y)),
                s.abs(s.max(x, y)),
                s.select(lt, x, s.splat(7.0)),
            ];
            for v in computed {
                let mut lanes = [0.0; ROW];
                s.store(v, &mut lanes);
                // NaNs may differ in sign and payload between instruction sets.
                out.extend(lanes[..S::LANES].iter().map(|l| if l.is_nan() { u32::MAX } else { l.to_bits() }));
            }
            let short: [u16; ROW] = std::array::from_fn(|i| (i * 4099) as u16);
            let wide: [u32; ROW] = std::array::from_fn(|i| 0xf000_0000 + i as u32);
            let mut floats = [0.0; ROW];
            s.store(s.load_short(&short[at..]), &mut floats);
            out.extend(floats[..S::LANES].iter().map(|l| l.to_bits()));
            let bytes: [u8; ROW] = std::array::from_fn(|i| (i * 37) as u8);
            let places = s.load_bytes(&bytes[at..]);
            let table: [Row; 4] = std::array::from_fn(|k| Row(std::array::from_fn(|i| (16 * k + i) as f32)));
            s.store(s.lookup([&table[0], &table[1], &table[2], &table[3]], places), &mut floats);
            out.extend(floats[..S::LANES].iter().map(|l| l.to_bits()));
            s.store(s.permute(x, places), &mut floats);
            for (lane, found) in floats.iter().enumerate().take(S::LANES) {
                let from = a[at + usize::from(bytes[at + lane]) % S::LANES];
                assert_eq!(found.to_bits(), from.to_bits());
            }
            let quads: [[f32; 4]; ROW] =
                std::array::from_fn(|i| std::array::from_fn(|k| (4 * (i + at) + k) as f32));
            let columns = s.load_quads(&std::array::from_fn(|i| &quads[i]));
            assert_eq!(s.store_quads(columns)[..S::LANES], quads[..S::LANES]);
            for column in columns {
                s.store(column, &mut floats);
                out.extend(floats[..S::LANES].iter().map(|l| l.to_bits()));
            }
            let mut ids = [0; ROW];
            s.store_u(s.load_u(&wide[at..]), &mut ids);
            out.extend(&ids[..S::LANES]);
            s.store_u(s.select_u(lt, s.splat_u(1), s.splat_u(0)), &mut ids);
            out.extend(&ids[..S::LANES].iter().map(|id| id + 10).collect::<Vec<_>>());
        }
        out.sort_unstable();
        out.extend(masks);
        out
    }
}

#[test]
fn all_levels_compute_the_same_bits() {
    let reference = Everything.run(Portable);
    assert!(reference.len() > 100);
    assert_eq!(Everything.run(Scalar), reference, "scalar");
    for level in Level::here() {
        assert_eq!(level.run(Everything), reference, "{level:?}");
    }
}

/// Bytes as floats in order and at places, and those whose bits are set.
struct Bytes(u64, [u8; 64]);

impl Task for Bytes {
    type Out = (Vec<f32>, Vec<f32>, Vec<u8>);

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Self::Out {
        let Self(bits, bytes) = self;
        let (mut floats, mut found) = ([0.0; 64], [0.0; 64]);
        for at in (0..64).step_by(S::LANES) {
            let places: [u8; 64] = std::array::from_fn(|i| (bits >> i) as u8 % 64);
            s.store(s.load_bytes_as_floats(&bytes[at..]), &mut floats[at..]);
            s.store(s.lookup_bytes(&bytes, s.load_bytes(&places[at..])), &mut found[at..]);
        }
        let mut kept = [0; 64];
        s.compress(bits, &bytes, &mut kept);
        (floats.to_vec(), found.to_vec(), kept[..bits.count_ones() as usize].to_vec())
    }
}

#[test]
fn bytes_are_the_same_at_every_level() {
    for bits in [0, u64::MAX, 0x8000_0000_0000_0001, 0x0123_4567_89ab_cdef] {
        let bytes = std::array::from_fn(|i| (i * 37 + 11) as u8);
        let floats: Vec<f32> = bytes.iter().map(|byte| f32::from(*byte)).collect();
        let at = |i: usize| floats[(bits >> i) as usize % 64];
        let kept = (0..64).filter(|i| bits >> i & 1 != 0).map(|i: usize| bytes[i]).collect();
        let expected = (floats.clone(), (0..64).map(at).collect(), kept);
        for level in Level::here() {
            assert_eq!(level.run(Bytes(bits, bytes)), expected, "{level:?}");
        }
    }
}

/// Numbers of set bits, and ids sorted to lists.
struct Sorted(u64);

impl Task for Sorted {
    type Out = (Vec<u8>, Vec<Vec<u16>>);

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Self::Out {
        let mut numbers = [0; 64];
        let len = s.set_bits(self.0, &mut numbers);
        const STRIDE: usize = 3 * SHARE;
        let (mut lists, mut lens) = ([0; STRIDE * ROW], [0; ROW]);
        for round in 0..2u16 {
            let ids = std::array::from_fn(|i| 1000 * round + i as u16);
            let marks = std::array::from_fn(|i| (self.0 >> (i as u16 % 7 * 5 + round)) as u16);
            s.distribute(&ids, &marks, &mut Lists { ids: &mut lists, stride: STRIDE, lens: &mut lens });
        }
        let list = |k: usize| lists[k * STRIDE..k * STRIDE + lens[k] as usize].to_vec();
        (numbers[..len].to_vec(), (0..ROW).map(list).collect())
    }
}

#[test]
fn bits_and_ids_are_sorted_alike() {
    for bits in [0, u64::MAX, 1, 1 << 63, 0x0123_4567_89ab_cdef, 0x8000_0001_0010_0500] {
        let reference = Sorted(bits).run(Portable);
        let numbers: Vec<u8> = (0..64).filter(|i| bits >> i & 1 != 0).collect();
        assert_eq!(reference.0, numbers);
        let marked = |i: usize, round: usize, k: usize| (bits >> (i % 7 * 5 + round)) as u16 >> k & 1 != 0;
        let count = |k| (0..2 * SHARE).filter(|n| marked(n % SHARE, n / SHARE, k)).count();
        assert!(reference.1.iter().enumerate().all(|(k, list)| list.len() == count(k)));
        for level in Level::here() {
            assert_eq!(level.run(Sorted(bits)), reference, "{level:?}");
        }
    }
}

#[test]
fn levels_go_by_name() {
    for level in Level::ALL {
        assert_eq!(Level::from_id(level.id()), Some(level));
    }
    assert!(Level::best().available());
}

mod paths {
    use super::super::path::{Hull, Path, PathRows, SLICES};
    use super::*;
    use proptest::prelude::*;

    /// What a union is made along.
    #[derive(Clone, Copy)]
    enum Along<'a> {
        Path(&'a Path),
        Hull(&'a Hull),
    }

    struct Union<'a>(&'a [[u64; SLICES]; 3], Along<'a>);

    impl Task for Union<'_> {
        type Out = u64;

        #[inline(always)]
        fn run<S: Simd>(self, s: S) -> u64 {
            let [a, b, c] = self.0;
            match self.1 {
                Along::Path(path) => s.path_union([a, b, c], path),
                Along::Hull(hull) => s.hull_union([a, b, c], hull),
            }
        }
    }

    /// Unions along two of several paths, the second through the maps in another order.
    struct Unions<'a>(&'a [[u64; SLICES]; 3], &'a PathRows, [usize; 2]);

    impl Task for Unions<'_> {
        type Out = [u64; 2];

        #[inline(always)]
        fn run<S: Simd>(self, s: S) -> [u64; 2] {
            let [a, b, c] = self.0;
            s.path_unions([[a, b, c], [c, a, b]], self.1, self.2)
        }
    }

    proptest! {
        #[test]
        fn two_paths_meet_what_each_meets(
            maps in prop::array::uniform3(prop::array::uniform8(any::<u64>())),
            paths in prop::collection::vec(
                (-0.01f32..8.0, 0f32..8.0, prop::array::uniform2(-0.5f32..8.5), prop::array::uniform2(-1f32..=1.0)),
                ROW,
            ),
            lanes in prop::array::uniform2(0..ROW),
        ) {
            let mut rows = PathRows([Row([0.0; ROW]); 6]);
            for (lane, (low, length, start, slope)) in paths.into_iter().enumerate() {
                let fields = [low, (low + length).min(8.01), start[0], start[1], slope[0], slope[1]];
                rows.0.iter_mut().zip(fields).for_each(|(row, field)| row.0[lane] = field);
            }
            let [a, b, c] = maps;
            let alone = [([a, b, c], lanes[0]), ([c, a, b], lanes[1])]
                .map(|(maps, lane)| Union(&maps, Along::Path(&rows.path(lane))).run(Portable));
            for level in Level::here() {
                prop_assert_eq!(level.run(Unions(&maps, &rows, lanes)), alone, "{:?}", level);
            }
        }
    }

    proptest! {
        /// Every cell that the path passes contributes its bits, at every level; and where all words are
        /// different single bits, nothing farther than a slice away does.
        #[test]
        fn the_union_holds_the_cells_of_the_path(
            low in -0.01f32..8.0,
            length in 0f32..8.0,
            start in prop::array::uniform2(-0.5f32..8.5),
            slope in prop::array::uniform2(-1f32..=1.0),
            seed: u64,
        ) {
            let path = Path { low, high: (low + length).min(8.01), start, slope };
            let mut state = seed;
            let mut word = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                state ^ state >> 29
            };
            let maps = [0; 3].map(|_| [0; SLICES].map(|_| word()));
            let slice = |p: f32| (p.max(0.0) as usize).min(SLICES - 1);
            let mut passed = 0;
            let mut near = 0;
            for i in 0..=400 {
                let along = path.low + (path.high - path.low) * i as f32 / 400.0;
                let at = |k: usize| path.start[k] + path.slope[k] * (along - path.low);
                // Positions within the trim of a boundary may count to either side.
                let clear = |p: f32| (p - p.round()).abs() > 0.02;
                if clear(along) && clear(at(0)) && clear(at(1)) {
                    passed |= maps[0][slice(along)] & maps[1][slice(at(0))] & maps[2][slice(at(1))];
                }
                for (da, db, dc) in (0..27).map(|k| (k % 3, k / 3 % 3, k / 9)) {
                    let by = |p: f32, d: i32| slice(p + d as f32 - 1.0);
                    near |= maps[0][by(along, da)] & maps[1][by(at(0), db)] & maps[2][by(at(1), dc)];
                }
            }
            let reference = Union(&maps, Along::Path(&path)).run(Portable);
            prop_assert_eq!(passed & !reference, 0);
            prop_assert_eq!(reference & !near, 0);
            for level in Level::here() {
                prop_assert_eq!(level.run(Union(&maps, Along::Path(&path))), reference, "{:?}", level);
            }
        }
    }

    proptest! {
        /// Every cell of a point between the lines of a hull contributes its bits, at every level.
        #[test]
        fn the_union_holds_the_cells_of_the_hull(
            maps in prop::array::uniform3(prop::array::uniform8(any::<u64>())),
            low in -3f32..8.0,
            length in 0.01f32..12.0,
            lines in prop::array::uniform2((-4f32..9.0, 0f32..5.0, -1.5f32..1.5, -1.5f32..1.5)),
            points in prop::collection::vec((0f32..1.0, 0f32..1.0, 0f32..1.0), 50),
        ) {
            let sides = lines.map(|(start, width, slope, other)| [[start, slope], [start + width, other]]);
            let hull = Hull { low, high: low + length, sides };
            let reference = Union(&maps, Along::Hull(&hull)).run(Portable);
            for level in Level::here() {
                prop_assert_eq!(level.run(Union(&maps, Along::Hull(&hull))), reference, "{:?}", level);
            }
            for (along, a, b) in points {
                let left = along * length;
                let at = |side: usize, share: f32| {
                    let [near, far] = hull.sides[side].map(|[start, slope]| start + slope * left);
                    near + share * (far - near).max(0.0)
                };
                let point = [low + left, at(0, a), at(1, b)];
                // Beside the lines' rounding, and where they don't cross.
                let inside = |p: &f32| (0.0..SLICES as f32).contains(p) && (p - p.round()).abs() > 1e-3;
                if point.iter().all(inside) && (0..2).all(|side| at(side, 1.0) > at(side, 0.0)) {
                    let bits = (0..3).fold(u64::MAX, |bits, axis| bits & maps[axis][point[axis] as usize]);
                    prop_assert_eq!(bits & !reference, 0, "{:?} in {:?}", point, hull);
                }
            }
        }
    }

    /// Small objects on many paths, registered wider by `margin`, that the union misses.
    fn missed(margin: f32) -> usize {
        let mut state = 1u64;
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1 << 24) as f32
        };
        let lost = |_: &usize| {
            let [from, to] = [0, 1].map(|_| [0; 3].map(|_| 8.0 * number()));
            let along = number();
            // A point of the path: one that is in few slices, where trimming tells.
            let point = [0, 1, 2].map(|a| from[a] + (to[a] - from[a]) * along);
            let maps = point.map(|p| {
                let slice = |p: f32| (p.max(0.0) as usize).min(SLICES - 1);
                let (first, last) = (slice(p - margin), slice(p + margin));
                std::array::from_fn(|k| u64::from((first..=last).contains(&k)))
            });
            let way = [0, 1, 2].map(|a| to[a] - from[a]);
            let axis = (0..3).max_by(|a, b| way[*a].abs().total_cmp(&way[*b].abs())).unwrap_or(0);
            let (b, c) = ([1, 2, 0][axis], [2, 0, 1][axis]);
            let begin = if way[axis] < 0.0 { to } else { from };
            let path = Path {
                low: begin[axis],
                high: begin[axis] + way[axis].abs(),
                start: [begin[b], begin[c]],
                slope: [way[b] / way[axis], way[c] / way[axis]],
            };
            let maps: [[u64; SLICES]; 3] = [maps[axis], maps[b], maps[c]];
            Level::here().any(|level| level.run(Union(&maps, Along::Path(&path))) == 0)
        };
        // Miri is a thousand times as slow.
        (0..if cfg!(miri) { 2_000 } else { 20_000 }).filter(lost).count()
    }

    #[test]
    fn a_margin_too_small_for_the_trim_loses_objects() {
        assert_eq!(missed(accel::tolerance::LOCAL_MARGIN), 0);
        assert!(missed(0.0) > 0);
    }
}

#[test]
fn levels_are_read_or_named() {
    assert_eq!(Level::parse("portable"), Ok(Level::Portable));
    assert!(Level::parse("mmx").unwrap_err().contains("portable"));
}

/// Its square needs more digits than `f32` has.
const NEAR_ONE: f32 = 1.0 + 1.0 / 4096.0;

/// The square of that, and 1 added or taken off.
struct Fused;

impl Task for Fused {
    type Out = [f32; 2];

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> [f32; 2] {
        let (a, c) = (s.splat(NEAR_ONE), s.splat(1.0));
        [s.mul_add(a, a, c), s.mul_sub(a, a, c)].map(|v| s.most(v))
    }
}

#[test]
fn products_and_sums_are_rounded_once_or_twice() {
    let a = NEAR_ONE;
    let fused = [a.mul_add(a, 1.0), a.mul_add(a, -1.0)];
    let apart = [a * a + 1.0, a * a - 1.0];
    assert_ne!(fused[1], apart[1], "the difference shows how often it was rounded");
    for level in Level::here() {
        let found = level.run(Fused);
        assert!(found == fused || found == apart, "{level:?}: {found:?}");
    }
}
