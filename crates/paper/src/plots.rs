//! Plots of the record, as SVG.

use super::printed::{OBJECTS, SIDES};
use super::{Paper, Table, memory};
use harness::units::short;
use report::chart::palette::{SERIES, Shape};
use report::chart::{Axis, Line, Mark, Plot, Sheet, Sign};

/// All plots: file name and contents.
pub fn all(paper: &Paper) -> Vec<(&'static str, String)> {
    let mut plots = vec![
        ("nu.svg", speed(paper)),
        ("candidates.svg", candidates(paper)),
        ("memory.svg", memory_ratio(paper)),
    ];
    plots.extend(consistency(paper).map(|plot| ("consistency.svg", plot)));
    plots
}

/// Points in one colour, joined or as circles.
struct Series {
    points: Vec<(f64, f64)>,
    colour: usize,
    joined: bool,
}

const SIZE: (f64, f64) = (430.0, 320.0);

/// A chart with both axes logarithmic; the line of `level` is dotted.
fn chart(name: &str, axes: [&str; 2], series: &[Series], level: Option<f64>) -> Plot {
    let positive = |v: &f64| *v > 0.0 && v.is_finite();
    let shown = |one: &Series| one.points.iter().copied().filter(|(_, y)| positive(y)).collect::<Vec<_>>();
    let (mut lines, mut marks) = (Vec::new(), Vec::new());
    lines.extend(level.map(|level| Line::level(level, "even")));
    for one in series {
        if one.joined {
            lines.push(Line::new(shown(one), &format!("line s{}", one.colour)));
        } else {
            marks.extend(shown(one).into_iter().map(|value| Mark {
                value,
                shape: Shape::Circle,
                class: format!("mark hollow s{}", one.colour),
                tip: format!("{}, {}", short(value.0), short(value.1)),
                label: None,
            }));
        }
    }
    let all: Vec<(f64, f64)> = series.iter().flat_map(shown).collect();
    Plot {
        name: name.to_owned(),
        size: SIZE,
        horizontal: Axis::new(&format!("{} →", axes[0]), all.iter().map(|p| p.0), short),
        vertical: Axis::new(&format!("↑ {}", axes[1]), all.iter().map(|p| p.1).chain(level), short),
        lines,
        marks,
    }
}

/// Charts with the names of their lines, and what the circles are.
fn sheet(columns: usize, plots: Vec<Plot>, names: impl IntoIterator<Item = String>, circles: &str) -> String {
    let lines = names.into_iter().enumerate().map(|(i, name)| Sign {
        shape: None,
        class: format!("line s{i}"),
        name,
    });
    Sheet { columns, plots, key: vec![lines.collect()], note: circles.into(), colours: SERIES.to_vec() }
        .file()
}

/// One line of ours and circles of the print for each size.
fn by_size(table: &Table) -> Vec<Series> {
    let at = |row: usize| f64::from(OBJECTS[row]);
    let of_size = |colour: usize| {
        let ours = table.ours.iter().enumerate().map(|(row, v)| (at(row), v[colour])).collect();
        let printed = table.printed.iter().enumerate();
        let printed = printed.filter_map(|(row, v)| Some((at(row), v[colour]?))).collect();
        [Series { points: ours, colour, joined: true }, Series { points: printed, colour, joined: false }]
    };
    (0..SIDES.len()).flat_map(of_size).collect()
}

fn sizes() -> impl Iterator<Item = String> {
    SIDES.iter().map(|side| format!("s = {side}"))
}

fn speed(paper: &Paper) -> String {
    let plot = |key: &str| {
        let table = paper.tables.get(key)?;
        Some(chart(&format!("Table {key}"), ["objects p", "ν"], &by_size(table), None))
    };
    let plots = ["2", "3", "4", "5"].into_iter().filter_map(plot).collect();
    sheet(2, plots, sizes(), "lines: ours; circles: printed")
}

fn candidates(paper: &Paper) -> String {
    let plot = paper.tables.get("7").map(|table| {
        let mut series = by_size(table);
        for values in table.variants.iter().filter(|(name, _)| name.contains("end of the 99")).map(|(_, v)| v)
        {
            series.extend((0..SIDES.len()).map(|colour| Series {
                points: values.iter().zip(OBJECTS).map(|(v, p)| (f64::from(p), v[colour])).collect(),
                colour,
                joined: true,
            }));
        }
        chart("Table 7", ["objects p", "largest number of candidates"], &series, None)
    });
    sheet(1, plot.into_iter().collect(), sizes(), "lines: median and 99 % range of seeds; circles: printed")
}

fn memory_ratio(paper: &Paper) -> String {
    let plot = |case: &str| {
        let mut series = Vec::new();
        for (colour, p) in memory::OBJECTS.iter().enumerate() {
            let points = || paper.memory.points.iter().filter(|point| point.case == case && point.p == *p);
            let formula = points().map(|point| (f64::from(point.n), point.nu_formula)).collect();
            let built = points().filter(|point| point.built);
            let built = built.map(|point| (f64::from(point.n), point.nu_built)).collect();
            series.push(Series { points: formula, colour, joined: true });
            series.push(Series { points: built, colour, joined: false });
        }
        chart(case, ["N", "M_SSM / M_BMSSM"], &series, Some(1.0))
    };
    let plots = memory::CASES.iter().map(|case| plot(case)).collect();
    let names = memory::OBJECTS.iter().map(|p| format!("p = {}", short(f64::from(*p))));
    sheet(3, plots, names, "lines: formula; circles: as built; dotted: equal memory")
}

fn consistency(paper: &Paper) -> Option<String> {
    let shown = paper.consistency.as_ref()?;
    let line = |colour, of: fn(&super::consistency::Resolution) -> usize| Series {
        points: shown.resolutions.iter().map(|r| (f64::from(r.pixels), of(r) as f64)).collect(),
        colour,
        joined: true,
    };
    let series = [line(0, |r| r.unseen), line(1, |r| r.visible_lost), line(2, |r| r.visible)];
    let name = format!("Objects of {} by resolution", shown.scene);
    let plot = chart(&name, ["rows and columns", "objects"], &series, None);
    let names = ["no ray can hit", "visible and lost", "hit first by some ray"].map(str::to_owned);
    Some(sheet(1, vec![plot], names, ""))
}
