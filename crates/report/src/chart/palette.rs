//! How each structure looks in every picture: one colour for each theme, and one shape.
//!
//! Families share a hue near one of Okabe and Ito's palette (2008), members of a family differ in
//! lightness. The shades were spread so that any two stay apart for people without one of the
//! three cones too; the tests hold them to that. Shapes differ as well.

pub use harness::registry::{Look, Shape};

use harness::record::id_of;
use harness::registry;

/// The look of a structure, named by its id with or without settings.
pub fn of(structure: &str) -> Look {
    registry::look_of(id_of(structure))
}

/// Radius of a point's marker.
pub const MARKER: f64 = 4.5;

/// A shape's outline about (0, 0) as an SVG path, about [`MARKER`] wide to each side.
pub const fn outline(shape: Shape) -> &'static str {
    match shape {
        Shape::Circle => "M-4.5,0A4.5,4.5 0 1 0 4.5,0A4.5,4.5 0 1 0 -4.5,0Z",
        Shape::Square => "M-4,-4H4V4H-4Z",
        Shape::Triangle => "M0,-5.4L5,3.6H-5Z",
        Shape::Diamond => "M0,-5.6L5.6,0L0,5.6L-5.6,0Z",
        Shape::Star => "M0,-6L1.6,-2L6,-1.6L2.6,1.2L3.8,5.4L0,3L-3.8,5.4L-2.6,1.2L-6,-1.6L-1.6,-2Z",
        Shape::Plus => "M-1.5,-5H1.5V-1.5H5V1.5H1.5V5H-1.5V1.5H-5V-1.5H-1.5Z",
        Shape::Bar => "M-5,-2.5H5V2.5H-5Z",
        Shape::Cross => "M-4,-4L0,-1.5L4,-4L1.5,0L4,4L0,1.5L-4,4L-1.5,0Z",
    }
}

/// Colours of series that are no structures, for figures in print (Okabe & Ito 2008, the yellow darkened).
pub const SERIES: [&str; 8] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#9a7d0a", "#000000", "#7a7a7a"];

#[cfg(test)]
mod tests {
    use super::*;

    /// Every structure with its look, and the look of others.
    fn looks() -> Vec<(&'static str, Look)> {
        let ids = registry::entries().iter().map(|e| e.id);
        let ids = ids.chain(registry::absent().into_iter().map(|a| a.id));
        ids.map(|id| (id, of(id))).chain([("other", Look::OTHER)]).collect()
    }

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
            assert_ne!(of(id), Look::OTHER, "{id}");
        }
        let looks = looks();
        for (i, (id, look)) in looks.iter().enumerate() {
            assert!(
                looks[..i].iter().all(|(_, other)| other.light != look.light && other.dark != look.dark),
                "{id}"
            );
        }
        assert_eq!(of("ssm:n=4"), of("ssm"));
        assert_eq!(of("mine"), Look::OTHER);
    }

    #[test]
    fn colours_stand_out_from_the_ground() {
        for (id, look) in looks() {
            assert!(contrast(look.light, "#ffffff") >= 3.0, "{id}: {}", contrast(look.light, "#ffffff"));
            assert!(contrast(look.dark, "#15181d") >= 3.0, "{id}: {}", contrast(look.dark, "#15181d"));
        }
    }

    #[test]
    fn colours_are_apart_for_the_colour_blind_too() {
        // Twelve of such units are told apart at a glance; one can just be seen side by side.
        let all = looks();
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
