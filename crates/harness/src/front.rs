//! The Pareto front.

/// The points `(a, b)` that no other point beats in one figure without losing in the other, less being better: their
/// indices by the first figure. Of equal points all are on it or none.
pub fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|i, j| {
        let ((a, b), (c, d)) = (points[*i], points[*j]);
        a.total_cmp(&c).then(b.total_cmp(&d))
    });
    let mut last: Option<(f64, f64)> = None;
    order.retain(|i| {
        let better = last.is_none_or(|last| points[*i].1 < last.1 || points[*i] == last);
        if better {
            last = Some(points[*i]);
        }
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        assert_eq!(front(&[(1.0, 9.0), (2.0, 5.0), (3.0, 6.0), (4.0, 1.0), (2.0, 7.0)]), [0, 1, 3]);
        assert_eq!(front(&[(1.0, 2.0), (0.5, 3.0), (1.0, 2.0), (1.0, 3.0)]), [1, 0, 2]);
        assert_eq!(front(&[]), [0; 0]);
    }

    proptest! {
        #[test]
        fn it_is_what_its_definition_says(points in prop::collection::vec((0..6u8, 0..6u8), 0..12)) {
            let points: Vec<(f64, f64)> = points.iter().map(|(a, b)| (f64::from(*a), f64::from(*b))).collect();
            let beaten = |p: &(f64, f64)| {
                points.iter().any(|o| o.0 <= p.0 && o.1 <= p.1 && (o.0 < p.0 || o.1 < p.1))
            };
            let mut found = front(&points);
            found.sort_unstable();
            let expected: Vec<usize> = (0..points.len()).filter(|i| !beaten(&points[*i])).collect();
            prop_assert_eq!(found, expected);
        }
    }
}
