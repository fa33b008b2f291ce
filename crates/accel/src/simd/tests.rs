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
            let mut ids = [0; ROW];
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

#[test]
fn levels_go_by_name() {
    for level in Level::ALL {
        assert_eq!(Level::from_id(level.id()), Some(level));
    }
    assert!(Level::best().available());
}
