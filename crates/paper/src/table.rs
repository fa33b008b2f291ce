//! Tables that hold the print beside today's figures.

use super::printed::{Cells, OBJECTS, SIDES};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A table of the paper and ours.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// What it shows.
    pub title: String,
    /// What the rows count.
    pub row_name: String,
    /// What the columns count.
    pub col_name: String,
    /// Names of the rows.
    pub rows: Vec<String>,
    /// Names of the columns.
    pub cols: Vec<String>,
    /// As printed, `None` where the print has no value.
    pub printed: Vec<Vec<Option<f64>>>,
    /// Ours, by the method that is nearest to the print.
    pub ours: Vec<Vec<f64>>,
    /// More of ours, by name.
    pub variants: BTreeMap<String, Vec<Vec<f64>>>,
    /// What is to be said.
    pub remarks: Vec<String>,
}

impl Table {
    /// A table of [`OBJECTS`] by [`SIDES`].
    pub fn of_cells(title: &str, row_name: &str, printed: &Cells, ours: Vec<Vec<f64>>) -> Self {
        Self {
            title: title.into(),
            row_name: row_name.into(),
            col_name: "side of the boxes in pixels".into(),
            rows: OBJECTS.map(|p| p.to_string()).to_vec(),
            cols: SIDES.map(|s| s.to_string()).to_vec(),
            printed: legible(printed),
            ours,
            ..Self::default()
        }
    }

    /// With more numbers of the same shape.
    #[must_use]
    pub fn with(mut self, name: &str, values: Vec<Vec<f64>>) -> Self {
        self.variants.insert(name.into(), values);
        self
    }

    /// With one more remark.
    #[must_use]
    pub fn remark(mut self, text: impl Into<String>) -> Self {
        self.remarks.push(text.into());
        self
    }
}

/// Values with `None` for NaN.
pub fn legible<const N: usize>(values: &[[f64; N]]) -> Vec<Vec<Option<f64>>> {
    values.iter().map(|row| row.iter().map(|v| (!v.is_nan()).then_some(*v)).collect()).collect()
}

/// A value for each of [`OBJECTS`] and [`SIDES`].
pub fn grid(of: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    (0..OBJECTS.len()).map(|row| (0..SIDES.len()).map(|col| of(row, col)).collect()).collect()
}

/// Spearman's rank correlation; ties share their mean rank. 0 where one side has no order.
pub fn rank_correlation(a: &[f64], b: &[f64]) -> f64 {
    let ranks = |values: &[f64]| -> Vec<f64> {
        let below = |v: f64| values.iter().filter(|w| **w < v).count() as f64;
        let equal = |v: f64| values.iter().filter(|w| **w == v).count() as f64;
        values.iter().map(|v| below(*v) + (equal(*v) - 1.0) / 2.0).collect()
    };
    let (a, b) = (ranks(a), ranks(b));
    let mean = (a.len() as f64 - 1.0) / 2.0;
    let product =
        |x: &[f64], y: &[f64]| -> f64 { x.iter().zip(y).map(|(x, y)| (x - mean) * (y - mean)).sum() };
    let size = (product(&a, &a) * product(&b, &b)).sqrt();
    if size > 0.0 { product(&a, &b) / size } else { 0.0 }
}

impl Table {
    /// Rank correlation of ours with the print: over all cells that the print has, and the mean over its whole
    /// columns (along the rows' count) and over its whole rows.
    pub fn trends(&self) -> [f64; 3] {
        let pairs = self.printed.iter().flatten().zip(self.ours.iter().flatten());
        let (printed, ours): (Vec<f64>, Vec<f64>) = pairs.filter_map(|(p, o)| Some(((*p)?, *o))).unzip();
        let whole: Vec<usize> =
            (0..self.printed.len()).filter(|row| self.printed[*row].iter().all(Option::is_some)).collect();
        let printed_at = |row: usize, col: usize| self.printed[row][col].unwrap_or_default();
        let mean = |of: Vec<f64>| of.iter().sum::<f64>() / of.len().max(1) as f64;
        let down = |col: usize| {
            let column = |of: &dyn Fn(usize) -> f64| whole.iter().map(|row| of(*row)).collect::<Vec<_>>();
            rank_correlation(&column(&|row| printed_at(row, col)), &column(&|row| self.ours[row][col]))
        };
        let along = |row: &usize| {
            let cols = 0..self.cols.len();
            rank_correlation(&cols.map(|col| printed_at(*row, col)).collect::<Vec<_>>(), &self.ours[*row])
        };
        [
            rank_correlation(&printed, &ours),
            mean((0..self.cols.len()).map(down).collect()),
            mean(whole.iter().map(along).collect()),
        ]
    }
}

impl Table {
    /// [`Table::trends`] as a sentence, with how many columns go the way of the print.
    pub fn trends_in_words(&self) -> String {
        let [all, down, along] = self.trends();
        let holds = match down {
            d if d > 0.5 => "the print's trend along p holds",
            d if d < -0.5 => "the print's trend along p is turned round",
            _ => "the print's trend along p is not seen",
        };
        format!(
            "Rank correlation with the print: along p {down:.2} on average over the columns, along s {along:.2} over the rows: \
             {holds}. Over all cells it is {all:.3}, which the sides of the boxes make high whatever p does."
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn correlation_knows_order_from_disorder() {
        let up = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(rank_correlation(&up, &[10.0, 20.0, 20.5, 90.0]), 1.0);
        assert_eq!(rank_correlation(&up, &[4.0, 3.0, 2.0, 1.0]), -1.0);
        assert!(rank_correlation(&up, &[2.0, 4.0, 1.0, 3.0]).abs() < 0.1);
        assert_eq!(rank_correlation(&up, &[7.0; 4]), 0.0);
        // Textbook: d² sums to 194 over 10 pairs, 1 − 6·194/990.
        let iq = [106.0, 100.0, 86.0, 101.0, 99.0, 103.0, 97.0, 113.0, 112.0, 110.0];
        let hours = [7.0, 27.0, 2.0, 50.0, 28.0, 29.0, 20.0, 12.0, 6.0, 17.0];
        assert!((rank_correlation(&iq, &hours) + 29.0 / 165.0).abs() < 1e-12);
    }

    #[test]
    fn trends_are_told_apart_by_direction() {
        let printed = std::array::from_fn(|row| std::array::from_fn(|col| (10 * row) as f64 - col as f64));
        let ours = grid(|row, col| -(row as f64) - 10.0 * col as f64);
        let [_, down, along] = Table::of_cells("", "", &printed, ours).trends();
        assert_eq!((down, along), (-1.0, 1.0));
    }
}
