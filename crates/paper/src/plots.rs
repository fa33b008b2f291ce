//! Plots of the record, as SVG.

use super::printed::{OBJECTS, SIDES};
use super::{Paper, Table, memory};
use plotters::coord::Shift;
use plotters::coord::combinators::BindKeyPoints;
use plotters::prelude::*;
use std::ops::Range;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), String>;

/// All plots: file name and contents.
///
/// # Errors
/// What the plotting library says.
pub fn all(paper: &Paper) -> Result<Vec<(&'static str, String)>, String> {
    let mut plots = vec![
        ("nu.svg", draw((1200, 800), |area| speed(area, paper))?),
        ("candidates.svg", draw((800, 450), |area| candidates(area, paper))?),
        ("memory.svg", draw((1300, 420), |area| memory_ratio(area, paper))?),
    ];
    if paper.consistency.is_some() {
        plots.push(("consistency.svg", draw((800, 400), |area| consistency(area, paper))?));
    }
    Ok(plots)
}

fn draw(size: (u32, u32), plot: impl FnOnce(&Area) -> Drawn) -> Result<String, String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE).map_err(text)?;
        plot(&area)?;
        area.present().map_err(text)?;
    }
    Ok(svg)
}

fn text(error: impl ToString) -> String {
    error.to_string()
}

/// A line of a chart: its name, its points, and whether it is drawn as marks only.
struct Series {
    name: String,
    points: Vec<(f64, f64)>,
    color: usize,
    marks: bool,
}

/// Width of the column right of a chart that names its lines.
const KEY: u32 = 120;

/// A chart with both axes logarithmic.
fn chart(area: &Area, title: &str, axes: [&str; 2], series: &[Series]) -> Drawn {
    let positive = |v: &f64| *v > 0.0 && v.is_finite();
    let range = |of: fn(&(f64, f64)) -> f64| {
        let values = series.iter().flat_map(|s| s.points.iter().map(of)).filter(positive);
        let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
        if low < high { low / 1.15..high * 1.15 } else { 0.5..2.0 }
    };
    let axis = |range: Range<f64>| range.clone().log_scale().with_key_points(ticks(&range));
    let (plot, key) = area.split_horizontally(area.dim_in_pixel().0.saturating_sub(KEY));
    let mut chart = ChartBuilder::on(&plot)
        .caption(title, ("sans-serif", 18))
        .margin(10)
        .x_label_area_size(38)
        .y_label_area_size(62)
        .build_cartesian_2d(axis(range(|p| p.0)), axis(range(|p| p.1)))
        .map_err(text)?;
    let label = |v: &f64| v.to_string();
    let mut mesh = chart.configure_mesh();
    mesh.x_desc(axes[0]).y_desc(axes[1]).x_label_formatter(&label).y_label_formatter(&label);
    mesh.draw().map_err(text)?;
    for one in series {
        let color = Palette99::pick(one.color).to_rgba();
        let points = one.points.iter().copied().filter(|(_, y)| positive(y));
        let drawn = if one.marks {
            chart.draw_series(points.map(|p| Circle::new(p, 4, color.stroke_width(1))))
        } else {
            chart.draw_series(LineSeries::new(points, color.stroke_width(2)))
        };
        drawn.map_err(text)?;
    }
    let named = series.iter().filter(|one| !one.name.is_empty());
    for (one, y) in named.zip((60..).step_by(20)) {
        let color = Palette99::pick(one.color).to_rgba();
        let line = PathElement::new([(4, y), (20, y)], color.stroke_width(2));
        key.draw(&line).map_err(text)?;
        key.draw(&Text::new(one.name.as_str(), (26, y - 6), ("sans-serif", 12))).map_err(text)?;
    }
    Ok(())
}

/// Where a logarithmic axis is labelled: at 1, 2 and 5 times powers of ten, or at the powers alone where
/// those would crowd.
fn ticks(range: &Range<f64>) -> Vec<f64> {
    let within = |steps: &[f64]| -> Vec<f64> {
        let powers = (-12..=15).map(|power| 10f64.powi(power));
        let all = powers.flat_map(|power| steps.iter().map(move |step| step * power));
        all.filter(|tick| range.contains(tick)).collect()
    };
    let fine = within(&[1.0, 2.0, 5.0]);
    if fine.len() <= 8 { fine } else { within(&[1.0]) }
}

/// One line of ours and marks of the print for each size.
fn by_size(table: &Table) -> Vec<Series> {
    let mut series = Vec::new();
    for (col, side) in SIDES.iter().enumerate() {
        let at = |row: usize| f64::from(OBJECTS[row]);
        let ours = table.ours.iter().enumerate().map(|(row, v)| (at(row), v[col])).collect();
        let printed = table.printed.iter().enumerate();
        let printed = printed.filter_map(|(row, v)| Some((at(row), v[col]?))).collect();
        series.push(Series { name: format!("s = {side}"), points: ours, color: col, marks: false });
        series.push(Series { name: String::new(), points: printed, color: col, marks: true });
    }
    series
}

fn speed(area: &Area, paper: &Paper) -> Drawn {
    for (panel, key) in area.split_evenly((2, 2)).iter().zip(["2", "3", "4", "5"]) {
        if let Some(table) = paper.tables.get(key) {
            let title = format!("Table {key}: lines ours, circles printed");
            chart(panel, &title, ["objects p", "ν"], &by_size(table))?;
        }
    }
    Ok(())
}

fn candidates(area: &Area, paper: &Paper) -> Drawn {
    let Some(table) = paper.tables.get("7") else { return Ok(()) };
    let mut series = by_size(table);
    for values in table.variants.iter().filter(|(name, _)| name.contains("end of the 99")).map(|(_, v)| v) {
        for col in 0..SIDES.len() {
            let points =
                values.iter().enumerate().map(|(row, v)| (f64::from(OBJECTS[row]), v[col])).collect();
            series.push(Series { name: String::new(), points, color: col, marks: false });
        }
    }
    let title = "Table 7: median and 99 % range of seeds, circles printed";
    chart(area, title, ["objects p", "largest number of candidates"], &series)
}

fn memory_ratio(area: &Area, paper: &Paper) -> Drawn {
    for (panel, case) in area.split_evenly((1, 3)).iter().zip(memory::CASES) {
        let mut series = Vec::new();
        for (color, p) in memory::OBJECTS.iter().enumerate() {
            let points: Vec<_> =
                paper.memory.points.iter().filter(|point| point.case == case && point.p == *p).collect();
            if points.is_empty() {
                continue;
            }
            let formula = points.iter().map(|point| (f64::from(point.n), point.nu_formula)).collect();
            let built = points.iter().filter(|point| point.built);
            let built = built.map(|point| (f64::from(point.n), point.nu_built)).collect();
            series.push(Series { name: format!("p = {p}"), points: formula, color, marks: false });
            series.push(Series { name: String::new(), points: built, color, marks: true });
        }
        let ends = [memory::RESOLUTIONS[0], memory::RESOLUTIONS[memory::RESOLUTIONS.len() - 1]];
        let one = ends.map(|n| (f64::from(n), 1.0)).to_vec();
        series.push(Series { name: "equal memory".into(), points: one, color: 98, marks: false });
        chart(panel, &format!("{case}: circles as built"), ["N", "M_SSM / M_BMSSM"], &series)?;
    }
    Ok(())
}

fn consistency(area: &Area, paper: &Paper) -> Drawn {
    let Some(shown) = &paper.consistency else { return Ok(()) };
    let line = |name: &str, color, of: fn(&super::consistency::Resolution) -> usize| {
        let points = shown.resolutions.iter().map(|r| (f64::from(r.pixels), of(r) as f64));
        Series { name: name.into(), points: points.collect(), color, marks: false }
    };
    let series = [
        line("no ray can hit", 0, |r| r.unseen),
        line("visible and lost", 1, |r| r.visible_lost),
        line("hit first by some ray", 2, |r| r.visible),
    ];
    chart(
        area,
        &format!("Objects of {} by resolution", shown.scene),
        ["rows and columns", "objects"],
        &series,
    )
}

#[cfg(test)]
mod tests {
    use super::ticks;

    #[test]
    fn labels_do_not_crowd() {
        assert_eq!(ticks(&(350.0..7000.0)), [500.0, 1000.0, 2000.0, 5000.0]);
        assert_eq!(ticks(&(0.3..400_000.0)), [1.0, 10.0, 100.0, 1000.0, 10_000.0, 100_000.0]);
    }
}
