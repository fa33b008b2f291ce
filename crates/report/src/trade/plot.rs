//! The plot: ns per ray against errors in a million rays, a chart for each scene.

use crate::chart::palette::{self, Shape};
use crate::chart::{Axis, Line, Mark, Plot, Sheet, Sign};
use harness::record::{Intersector, id_of};
use harness::units::{figure, short};
use primitives::KernelId;
use trade::curve::Precise;
use trade::{Trade, TradeRow};

const COLUMNS: usize = 3;
const SIZE: (f64, f64) = (330.0, 240.0);

/// Rows without an error are drawn here, below one in a million rays.
const NONE: f64 = 0.3;

/// The shapes of points: one for each kernel in their order, the last for external intersectors.
const SHAPES: [Shape; KernelId::ALL.len() + 1] = [
    Shape::Circle,
    Shape::Square,
    Shape::Triangle,
    Shape::Diamond,
    Shape::Star,
    Shape::Plus,
    Shape::Bar,
    Shape::Cross,
];

/// The plot as SVG: colours are structures, shapes are kernels, filled points form the Pareto front.
pub fn svg(trade: &Trade) -> String {
    let mut families: Vec<&str> = Vec::new();
    for family in trade.rows.iter().map(family) {
        if !families.contains(&family) {
            families.push(family);
        }
    }
    let structures = families.iter().enumerate().map(|(i, family)| Sign {
        shape: Some(Shape::Circle),
        class: format!("mark s{i}"),
        name: (*family).to_owned(),
    });
    let kernels = KernelId::ALL.map(Intersector::BuiltIn).into_iter().chain([Intersector::External]);
    let kernels = kernels.map(|kernel| Sign {
        shape: Some(shape(&kernel)),
        class: "crossing".into(),
        name: match &kernel {
            Intersector::External => "an external structure's own".into(),
            kernel => kernel.name().to_owned(),
        },
    });
    let sheet = Sheet {
        columns: COLUMNS,
        plots: trade.scenes.iter().map(|scene| plot(&scene.id, &trade.rows, &families)).collect(),
        key: vec![structures.collect(), kernels.collect()],
        note: "colour: structure; shape: ray-triangle test; filled: nothing else of the scene is as fast and as right"
            .into(),
        colours: families.iter().map(|family| palette::of(family).light).collect(),
    };
    sheet.file()
}

fn family(row: &TradeRow) -> &str {
    id_of(&row.structure)
}

/// The shape of a kernel's points.
fn shape(kernel: &Intersector) -> Shape {
    let place = match kernel {
        Intersector::BuiltIn(kernel) => KernelId::ALL.iter().position(|known| known == kernel),
        Intersector::External | Intersector::Unknown(_) => None,
    };
    SHAPES[place.unwrap_or(SHAPES.len() - 1)]
}

fn plot(scene: &str, rows: &[TradeRow], families: &[&str]) -> Plot {
    let mut points: Vec<(&TradeRow, (f64, f64))> =
        rows.iter().filter(|row| row.scene == scene).filter_map(|row| Some((row, row.point()?))).collect();
    // The front last, so that nothing covers it.
    points.sort_by_key(|(row, _)| row.front);
    let mark = |(row, (ns, errors)): &(&TradeRow, (f64, f64))| {
        let class = families.iter().position(|known| *known == family(row)).unwrap_or(families.len());
        Mark {
            value: (*ns, errors.max(NONE)),
            shape: shape(&row.kernel),
            class: format!("mark {}s{class}", if row.front { "" } else { "hollow " }),
            tip: format!("{}: {} ns, {} in a million", row.structure, figure(*ns), figure(*errors)),
            label: None,
        }
    };
    let errors = |rate: f64| if rate <= NONE { "none".to_owned() } else { short(rate) };
    Plot {
        name: scene.to_owned(),
        size: SIZE,
        horizontal: Axis::new("ns per ray →", points.iter().map(|(_, (ns, _))| *ns), short),
        vertical: Axis {
            ticks: &[NONE, 1.0, 1e2, 1e4, 1e6],
            ..Axis::new("↑ visible errors in a million ordinary rays", [], errors)
        },
        lines: Vec::new(),
        marks: points.iter().map(mark).collect(),
    }
}

/// Colours of the curve's structures, in the order in which they appear.
fn structures(curve: &[Precise]) -> Vec<&str> {
    let mut all: Vec<&str> = Vec::new();
    for row in curve {
        if !all.contains(&row.structure.as_str()) {
            all.push(&row.structure);
        }
    }
    all
}

/// The curve of precision as SVG: bytes a triangle against visible errors, a chart for each scene; none without a curve.
pub fn curve_svg(trade: &Trade) -> Option<String> {
    let families = structures(&trade.curve);
    let mut scenes: Vec<&str> = Vec::new();
    for row in &trade.curve {
        if !scenes.contains(&row.scene.as_str()) {
            scenes.push(&row.scene);
        }
    }
    if scenes.is_empty() {
        return None;
    }
    let sign = |(i, family): (usize, &&str)| Sign {
        shape: Some(Shape::Circle),
        class: format!("mark s{i}"),
        name: (*family).to_owned(),
    };
    let shapes = SORTS.iter().map(|(sort, shape)| Sign {
        shape: Some(*shape),
        class: "crossing".into(),
        name: (*sort).to_owned(),
    });
    let sheet = Sheet {
        columns: 2,
        plots: scenes.iter().map(|scene| curve_plot(scene, &trade.curve, &families)).collect(),
        key: vec![families.iter().enumerate().map(sign).collect(), shapes.collect()],
        note: "numbers: bits of a coordinate; filled: nothing else is as small, as fast and as right".into(),
        colours: families.iter().map(|family| palette::of(family).light).collect(),
    };
    Some(sheet.file())
}

/// Sorts of precision with their shapes; the last for all others.
const SORTS: [(&str, Shape); 4] = [
    ("lattice over the scene", Shape::Circle),
    ("lattice over a block", Shape::Square),
    ("grown", Shape::Triangle),
    ("floats, boxes", Shape::Diamond),
];

fn sort(row: &Precise) -> usize {
    let name = row.precision.as_str();
    SORTS.len()
        - 1
        - [name.ends_with("grown"), name.ends_with("over a block"), name.ends_with("over the scene")]
            .iter()
            .position(|is| *is)
            .map_or(0, |i| i + 1)
}

fn curve_plot(scene: &str, curve: &[Precise], families: &[&str]) -> Plot {
    let here: Vec<&Precise> = curve.iter().filter(|row| row.scene == scene).collect();
    let value = |row: &Precise| (row.bytes_per_triangle, row.errors.visible_per_million().max(NONE));
    let class = |row: &Precise| families.iter().position(|known| *known == row.structure).unwrap_or(0);
    let mark = |row: &&Precise| Mark {
        value: value(row),
        shape: SORTS[sort(row)].1,
        class: format!("mark {}s{}", if row.front { "" } else { "hollow " }, class(row)),
        tip: format!("{}, {}: {} B", row.structure, row.precision, figure(row.bytes_per_triangle)),
        label: row.bits.filter(|_| sort(row) == 0 && class(row) == 0).map(|bits| bits.to_string()),
    };
    let line = |family: &usize| {
        let mut along: Vec<(f64, f64)> =
            here.iter().filter(|row| class(row) == *family && sort(row) == 0).map(|row| value(row)).collect();
        along.sort_by(|a, b| a.0.total_cmp(&b.0));
        Line::new(along, "grid")
    };
    let errors = |rate: f64| if rate <= NONE { "none".to_owned() } else { short(rate) };
    Plot {
        name: scene.to_owned(),
        size: (420.0, 280.0),
        horizontal: Axis::new("bytes a triangle →", here.iter().map(|row| row.bytes_per_triangle), short),
        vertical: Axis {
            ticks: &[NONE, 1.0, 1e2, 1e4, 1e6],
            ..Axis::new("↑ visible errors in a million ordinary rays", [], errors)
        },
        lines: (0..families.len()).map(|family| line(&family)).collect(),
        marks: here.iter().map(mark).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::width;
    use harness::machine::Machine;
    use harness::record::{Outcome, SceneEntry, Suite};
    use judge::Tolerance;
    use trade::Accuracy;

    fn trade(scenes: usize, structures: usize) -> Trade {
        let mut trade = Trade {
            format: 1,
            tolerance: Tolerance::VISIBLE,
            curve: Vec::new(),
            extremes: Vec::new(),
            leaving: Vec::new(),
            command: String::new(),
            suite: Suite::this(),
            machine: Machine::here(),
            scenes: Vec::new(),
            rows: Vec::new(),
            skipped: Vec::new(),
        };
        for scene in 0..scenes {
            let id = format!("a-scene-of-some-length-{scene}");
            for structure in 0..structures {
                trade.rows.push(TradeRow {
                    scene: id.clone(),
                    structure: format!("structure-{structure}:kernel=exact"),
                    kernel: Intersector::BuiltIn(KernelId::ALL[structure % KernelId::ALL.len()]),
                    kernel_reason: String::new(),
                    ns_per_ray: Some(3.0 * 7f64.powi(structure as i32 % 6)),
                    bytes: None,
                    ordinary: None,
                    hunting: None,
                    sets: Vec::new(),
                    accuracy: Some(Accuracy { rays: 1000, missed: structure as u64, ..Accuracy::default() }),
                    front: structure == 0,
                    outcome: Outcome::Measured,
                });
            }
            trade.scenes.push(SceneEntry {
                id,
                objects: 1,
                kind: "triangles".into(),
                source: String::new(),
                checksum: String::new(),
            });
        }
        trade
    }

    fn number(tag: &str, name: &str) -> f64 {
        tag.split(&format!("{name}=\"")).nth(1).unwrap().split('"').next().unwrap().parse().unwrap()
    }

    /// Left, right and baseline of every text.
    fn texts(image: &str) -> Vec<(f64, f64, f64)> {
        let tags = image.split("<text ").skip(1);
        let texts = tags.map(|tag| {
            let (head, rest) = tag.split_once('>').unwrap();
            let width = width(&rest.split('<').next().unwrap().replace("&gt;", ">"));
            let shift = match head {
                head if head.contains("\"end\"") => 1.0,
                head if head.contains("\"middle\"") => 0.5,
                _ => 0.0,
            };
            let left = number(head, "x") - width * shift;
            (left, left + width, number(head, "y"))
        });
        texts.collect()
    }

    #[test]
    fn no_text_covers_another_or_leaves_the_picture() {
        for (scenes, structures) in [(1, 3), (9, 12), (14, 10)] {
            let image = svg(&trade(scenes, structures));
            let all = texts(&image);
            assert!(all.len() > scenes * 7 + structures);
            let (width, height) = (number(&image, "width"), number(&image, "height"));
            for (i, a) in all.iter().enumerate() {
                assert!(a.0 >= 0.0 && a.1 <= width && a.2 > 8.0 && a.2 < height, "{a:?} leaves the picture");
                for b in &all[..i] {
                    let beside = a.1 <= b.0 || b.1 <= a.0;
                    assert!(beside || (a.2 - b.2).abs() >= 8.0, "{a:?} covers {b:?}");
                }
            }
            let signs = structures + SHAPES.len();
            assert_eq!(image.matches("<path ").count(), scenes * structures + signs);
            assert_eq!(image.matches("class=\"mark s0\"").count(), scenes + 1, "the front is filled");
        }
    }
}
