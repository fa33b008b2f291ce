//! The tables as printed (Skala 1993, §6). `NAN` stands where the print has no value.

use std::sync::LazyLock;

/// Numbers of objects: the rows of Tables 2–7, p in the paper.
pub const OBJECTS: [u32; 7] = [400, 630, 1000, 1600, 2500, 4000, 6300];

/// Sides of the boxes in pixels: the columns of Tables 2–7.
pub const SIDES: [u32; 6] = [10, 16, 25, 40, 63, 100];

/// A number for each of [`OBJECTS`] and [`SIDES`].
pub type Cells = [[f64; 6]; 7];

/// No value is legible.
const GONE: f64 = f64::NAN;

/// Tables 2 to 7: table, p, and a number for each of [`SIDES`], none where the print has none.
const TABLES: &str = include_str!("printed.csv");

fn table(number: u32) -> Cells {
    let mut cells = [[GONE; SIDES.len()]; OBJECTS.len()];
    for line in TABLES.lines().skip(1) {
        let (of, row) = line.split_once(',').expect("a table's number");
        let (objects, row) = row.split_once(',').expect("a number of objects");
        let at = OBJECTS.iter().position(|p| p.to_string() == objects).expect("a row of the tables");
        if of == number.to_string() {
            for (cell, value) in cells[at].iter_mut().zip(row.split(',')) {
                *cell = value.parse().unwrap_or(GONE);
            }
        }
    }
    cells
}

/// Table 2: ν against the min-max test, parallel rays.
pub static TABLE_2: LazyLock<Cells> = LazyLock::new(|| table(2));

/// Table 3: ν against the sphere (circle) test, parallel rays.
pub static TABLE_3: LazyLock<Cells> = LazyLock::new(|| table(3));

/// Table 4: ν against the min-max test, perspective. The rows from p = 1600 on are cut short in print.
pub static TABLE_4: LazyLock<Cells> = LazyLock::new(|| table(4));

/// Table 5: ν against the sphere test, perspective. The rows from p = 1600 on are cut short in print.
pub static TABLE_5: LazyLock<Cells> = LazyLock::new(|| table(5));

/// Table 6: Mean number of candidates of a ray.
pub static TABLE_6: LazyLock<Cells> = LazyLock::new(|| table(6));

/// Table 7: Largest number of candidates of any ray.
pub static TABLE_7: LazyLock<Cells> = LazyLock::new(|| table(7));

/// Columns of Table 1: operations.
pub const OPERATIONS: [&str; 5] = [":=", "<", "±", "×", "÷"];

/// Table 1, PC 486 33 MHz, "selected for evaluation": rows int and float, in 1/10 s for 5,000,000 operations.
pub const TABLE_1: [[f64; 5]; 2] = [[5.0, 9.0, 3.0, 26.0, 44.0], [33.0, 50.0, 16.0, 20.0, 114.0]];

/// Table 1, PC 386DX/387 25 MHz; of its row int only two values are legible.
pub const TABLE_1_386: [[f64; 5]; 2] = [[14.0, GONE, GONE, 40.0, GONE], [204.0, 260.0, 80.0, 82.0, 154.0]];

/// Cost of a `for` cycle on the 486 (§3), in the unit of Table 1.
pub const CYCLE: f64 = 18.0;

/// T_BMSSM of §3, in the unit of Table 1.
pub const T_BMSSM: f64 = 90.0;

/// Nanoseconds in the unit of Table 1: 1/10 s for 5,000,000 operations.
pub const UNIT_NS: f64 = 1e8 / 5e6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read_whole() {
        let tables = [&*TABLE_2, &*TABLE_3, &*TABLE_4, &*TABLE_5, &*TABLE_6, &*TABLE_7];
        let legible = |cells: &Cells| cells.iter().flatten().filter(|value| value.is_finite()).count();
        assert_eq!(tables.map(legible), [42, 42, 21, 21, 42, 42]);
        assert_eq!((TABLE_2[0][0], TABLE_4[3][2], TABLE_7[6][5]), (10.38, 290.28, 1054.0));
    }
}
