//! The tables as printed (Skala 1993, §6). `NAN` stands where the print has no value.

/// Numbers of objects: the rows of Tables 2–7, p in the paper.
pub const OBJECTS: [u32; 7] = [400, 630, 1000, 1600, 2500, 4000, 6300];

/// Sides of the boxes in pixels: the columns of Tables 2–7.
pub const SIDES: [u32; 6] = [10, 16, 25, 40, 63, 100];

/// A number for each of [`OBJECTS`] and [`SIDES`].
pub type Cells = [[f64; 6]; 7];

const GONE: f64 = f64::NAN;

/// Table 2: ν against the min-max test, parallel rays.
pub const TABLE_2: Cells = [
    [10.38, 9.52, 8.04, 6.13, 4.74, 4.1],
    [11.39, 10.31, 8.55, 6.44, 4.9, 4.22],
    [11.96, 10.72, 8.83, 6.59, 4.98, 4.28],
    [12.65, 11.3, 9.22, 6.82, 5.15, 4.44],
    [13.06, 11.64, 9.48, 6.99, 5.26, 4.55],
    [13.72, 12.18, 9.86, 7.22, 5.39, 4.51],
    [14.03, 12.43, 10.03, 7.3, 5.43, 4.65],
];

/// Table 3: ν against the sphere (circle) test, parallel rays.
pub const TABLE_3: Cells = [
    [26.11, 23.4, 19.1, 13.79, 9.86, 7.64],
    [28.62, 25.3, 20.29, 14.43, 10.17, 7.82],
    [29.95, 26.23, 20.88, 14.73, 10.32, 7.92],
    [31.91, 27.77, 21.87, 15.24, 10.59, 8.11],
    [33.07, 28.71, 22.53, 15.63, 10.83, 8.29],
    [33.97, 29.4, 22.96, 15.83, 10.91, 8.35],
    [38.94, 33.64, 26.24, 18.03, 12.39, 9.48],
];

/// Table 4: ν against the min-max test, perspective. The rows from p = 1600 on are cut short in print.
pub const TABLE_4: Cells = [
    [346.57, 310.27, 253.1, 183.01, 130.76, 101.18],
    [379.94, 335.89, 269.4, 191.72, 135.1, 103.83],
    [399.93, 350.26, 278.72, 196.73, 137.8, 105.68],
    [423.53, 368.58, 290.28, GONE, GONE, GONE],
    [GONE, GONE, GONE, GONE, GONE, GONE],
    [GONE, GONE, GONE, GONE, GONE, GONE],
    [GONE, GONE, GONE, GONE, GONE, GONE],
];

/// Table 5: ν against the sphere test, perspective. The rows from p = 1600 on are cut short in print.
pub const TABLE_5: Cells = [
    [33.8, 30.48, 24.76, 17.89, 12.83, 9.88],
    [37.19, 32.76, 26.32, 18.73, 13.16, 10.15],
    [38.74, 33.93, 27.01, 19.05, 13.35, 10.24],
    [42.07, 36.58, 28.86, GONE, GONE, GONE],
    [GONE, GONE, GONE, GONE, GONE, GONE],
    [GONE, GONE, GONE, GONE, GONE, GONE],
    [GONE, GONE, GONE, GONE, GONE, GONE],
];

/// Table 6: Mean number of candidates of a ray.
pub const TABLE_6: Cells = [
    [0.72, 1.7, 3.9, 9.44, 21.99, 50.82],
    [1.14, 2.68, 6.15, 14.86, 34.69, 80.41],
    [1.8, 4.25, 9.76, 23.57, 54.82, 126.74],
    [2.89, 6.81, 15.66, 37.85, 87.94, 202.91],
    [4.51, 10.65, 24.46, 59.08, 137.34, 317.13],
    [7.23, 17.06, 39.23, 94.77, 220.22, 507.1],
    [11.39, 26.89, 61.83, 149.37, 347.27, 799.03],
];

/// Table 7: Largest number of candidates of any ray.
pub const TABLE_7: Cells = [
    [6.0, 8.0, 12.0, 21.0, 38.0, 80.0],
    [8.0, 11.0, 17.0, 33.0, 61.0, 121.0],
    [10.0, 15.0, 23.0, 48.0, 93.0, 192.0],
    [12.0, 20.0, 32.0, 65.0, 131.0, 304.0],
    [14.0, 26.0, 45.0, 94.0, 196.0, 436.0],
    [19.0, 36.0, 67.0, 141.0, 306.0, 689.0],
    [27.0, 49.0, 98.0, 206.0, 450.0, 1054.0],
];

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
