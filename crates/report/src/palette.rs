//! How each structure looks in every picture: one colour for each theme, and one shape.
//!
//! Families share a hue near one of Okabe and Ito's palette (2008), members of a family differ in
//! lightness. The shades were spread so that any two stay apart for people without one of the
//! three cones too; the tests hold them to that. Shapes differ as well.

use harness::record::id_of;

/// The shape of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// ●
    Circle,
    /// ■
    Square,
    /// ▲
    Triangle,
    /// ◆
    Diamond,
}

/// How a structure looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Colour on a light ground, as `#rrggbb`.
    pub light: &'static str,
    /// Colour on a dark ground, as `#rrggbb`.
    pub dark: &'static str,
    /// Shape of its points.
    pub shape: Shape,
}

const fn look(light: &'static str, dark: &'static str, shape: Shape) -> Look {
    Look { light, dark, shape }
}

/// Id and look of every structure.
const LOOKS: [(&str, Look); 14] = [
    ("bmssm", look("#da670c", "#e65315", Shape::Circle)),
    ("bmssm-dense", look("#38120a", "#98562a", Shape::Square)),
    ("ssm", look("#7f6c2a", "#efb21f", Shape::Diamond)),
    ("ssm-list", look("#4c3806", "#e0cb61", Shape::Triangle)),
    ("obvhs-bvh2", look("#02a464", "#02a666", Shape::Triangle)),
    ("obvhs-cwbvh", look("#13623c", "#3ffda4", Shape::Diamond)),
    ("embree", look("#0969b8", "#63befd", Shape::Square)),
    ("embree-robust", look("#0b3759", "#b2dffe", Shape::Diamond)),
    ("embree-compact", look("#1997f6", "#336ba2", Shape::Circle)),
    ("embree-packet", look("#4603b4", "#a027e8", Shape::Triangle)),
    ("embree-rs", look("#8a48fc", "#d25afc", Shape::Square)),
    ("minmax", look("#6a6a6a", "#9b9b9b", Shape::Triangle)),
    ("sphere", look("#3c3c3c", "#666666", Shape::Circle)),
    ("brute", look("#939393", "#cfcfcf", Shape::Square)),
];

/// The look of structures that are none of the suite's.
const OTHER: Look = look("#bb6cac", "#f723c7", Shape::Diamond);

/// The look of a structure, named by its id with or without settings.
pub fn of(structure: &str) -> Look {
    let id = id_of(structure);
    LOOKS.iter().find(|(known, _)| *known == id).map_or(OTHER, |(_, look)| *look)
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::registry;

    /// Linear intensities of a `#rrggbb` colour.
    fn linear(colour: &str) -> [f64; 3] {
        [1, 3, 5].map(|at| {
            let x = f64::from(u8::from_str_radix(&colour[at..at + 2], 16).unwrap()) / 255.0;
            if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
        })
    }

    /// Contrast of two colours (WCAG 2.1).
    fn contrast(a: &str, b: &str) -> f64 {
        let luminance = |colour: &str| {
            let [r, g, b] = linear(colour);
            0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05
        };
        let (a, b) = (luminance(a), luminance(b));
        a.max(b) / a.min(b)
    }

    /// CIELAB, D65.
    fn lab([r, g, b]: [f64; 3]) -> [f64; 3] {
        let xyz = [
            (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.95047,
            0.2126 * r + 0.7152 * g + 0.0722 * b,
            (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.08883,
        ];
        let [x, y, z] = xyz.map(|t| if t > 0.008856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 });
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    /// Full protanopia, deuteranopia and tritanopia (Machado, Oliveira & Fernandes 2009), and
    /// full colour vision.
    const VISIONS: [[[f64; 3]; 3]; 4] = [
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    ];

    fn seen(vision: &[[f64; 3]; 3], colour: &str) -> [f64; 3] {
        let rgb = linear(colour);
        lab(vision.map(|row| row.iter().zip(rgb).map(|(m, c)| m * c).sum::<f64>().clamp(0.0, 1.0)))
    }

    fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    }

    #[test]
    fn every_structure_has_a_look_of_its_own() {
        let ids =
            registry::entries().iter().map(|e| e.id).chain(registry::absent().into_iter().map(|a| a.id));
        for id in ids {
            assert_ne!(of(id), OTHER, "{id}");
        }
        for (i, (id, look)) in LOOKS.iter().enumerate() {
            assert!(
                LOOKS[..i].iter().all(|(_, other)| other.light != look.light && other.dark != look.dark),
                "{id}"
            );
        }
        assert_eq!(of("ssm:n=4"), of("ssm"));
        assert_eq!(of("mine"), OTHER);
    }

    #[test]
    fn colours_stand_out_from_the_ground() {
        for (id, look) in LOOKS.iter().chain([&("other", OTHER)]) {
            assert!(contrast(look.light, "#ffffff") >= 3.0, "{id}: {}", contrast(look.light, "#ffffff"));
            assert!(contrast(look.dark, "#15181d") >= 3.0, "{id}: {}", contrast(look.dark, "#15181d"));
        }
    }

    #[test]
    fn colours_are_apart_for_the_colour_blind_too() {
        // Twelve of such units are told apart at a glance; one can just be seen side by side.
        let all: Vec<_> = LOOKS.iter().chain([&("other", OTHER)]).collect();
        for (i, (a, x)) in all.iter().enumerate() {
            for (b, y) in &all[..i] {
                for (vision, matrix) in VISIONS.iter().enumerate() {
                    for (one, two) in [(x.light, y.light), (x.dark, y.dark)] {
                        let apart = distance(seen(matrix, one), seen(matrix, two));
                        assert!(apart > 12.0, "{a} {b}: {apart:.1} in vision {vision}");
                    }
                }
            }
        }
    }
}
