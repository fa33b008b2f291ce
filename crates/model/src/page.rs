//! Table, conclusions, charts and the page of them.

use crate::record::{Form, Model, ModelRow, SceneRows};
use harness::units::{self, figure as digits, short};
use report::chart::palette::{self, Shape};
use report::chart::{Axis, Line, Mark, Plot, Sheet, Sign};
use report::table::{Table, Value, figure};
use std::fmt::Write;

/// All forms of all scenes; rows on the front have a star.
pub fn table(model: &Model) -> Table {
    let mut table = Table::new([
        "scene".into(),
        "form".into(),
        figure("objects"),
        figure("MB of scene"),
        figure("MB of structure"),
        figure("build ms"),
        figure("ns/ray, image"),
        figure("ns/ray, list"),
        figure("wrong %"),
        figure("holes"),
        figure("extra"),
        figure("other"),
        figure("displaced"),
        figure("off by, 99 %, pixels"),
        figure("largest, pixels"),
        figure("normal, 99 %, °"),
    ]);
    for scene in &model.scenes {
        for row in &scene.rows {
            table.push(cells(scene, row));
        }
    }
    table
}

fn cells(scene: &SceneRows, row: &ModelRow) -> Vec<Value> {
    let number = |value: f64| Value::figure(Some(value), digits);
    let errors = &row.errors;
    let star = if row.front { " *" } else { "" };
    vec![
        Value::text(&scene.scene),
        Value::text(format!("{}{star}", row.form)),
        Value::count(row.objects),
        number(row.scene_bytes as f64 / 1e6),
        number(row.structure_bytes as f64 / 1e6),
        number((row.build_ns + row.tessellate_ns) / 1e6),
        number(row.image_ns),
        Value::figure(row.list_ns, digits),
        number(errors.wrong_part() * 100.0),
        Value::count(errors.holes),
        Value::count(errors.extra),
        Value::count(errors.other),
        Value::count(errors.displaced),
        number(errors.pixels_off.p99),
        number(errors.pixels_off.largest),
        number(errors.degrees.p99),
    ]
}

/// A sentence or two for each scene: which level is enough, and what it costs beside the true objects.
pub fn conclusions(model: &Model) -> Vec<String> {
    model.scenes.iter().filter_map(|scene| conclusion(model, scene)).collect()
}

fn conclusion(model: &Model, scene: &SceneRows) -> Option<String> {
    let truth = scene.truth()?;
    let size = format!("at {}² pixels", model.pixels);
    let Some(row) = scene.enough(model.max_wrong) else {
        let best =
            scene.rows.iter().filter(|row| row.form != Form::True).min_by_key(|row| row.errors.wrong())?;
        return Some(format!(
            "{}: {size} no level is indistinguishable; {} is the nearest, with {} % of the pixels wrong ({}).",
            scene.scene,
            best.form,
            digits(best.errors.wrong_part() * 100.0),
            scene.ended
        ));
    };
    let times = |of: &dyn Fn(&ModelRow) -> f64| short(of(row) / of(truth).max(f64::MIN_POSITIVE));
    let list = match (row.list_ns, truth.list_ns) {
        (Some(level), Some(truth)) => format!(", {} times on a list", short(level / truth)),
        _ => String::new(),
    };
    Some(format!(
        "{}: {size} {} is indistinguishable ({} % of the pixels wrong, of {} % allowed): {} times the bytes, {} times the \
         time on the image{list}.",
        scene.scene,
        row.form,
        digits(row.errors.wrong_part() * 100.0),
        digits(model.max_wrong * 100.0),
        times(&|row| row.bytes() as f64),
        times(&|row| row.image_ns),
    ))
}

/// Where a form without a wrong pixel is drawn, in parts of all.
const NONE: f64 = 1e-6;

/// Charts as SVG, two a scene: wrong pixels against time and against bytes.
pub fn charts(model: &Model) -> String {
    let plots = model.scenes.iter().flat_map(|scene| {
        [
            plot(
                scene,
                "time",
                Axis::new("ns a ray of the image →", scene.rows.iter().map(|r| r.image_ns), short),
                |row| row.image_ns,
            ),
            plot(
                scene,
                "memory",
                Axis::new(
                    "bytes of scene and structure →",
                    scene.rows.iter().map(|r| r.bytes() as f64),
                    short,
                ),
                |row| row.bytes() as f64,
            ),
        ]
    });
    let sign = |class: &str, shape: Shape, name: &str| Sign {
        shape: Some(shape),
        class: format!("mark {class}"),
        name: name.to_owned(),
    };
    let sheet = Sheet {
        columns: 2,
        plots: plots.collect(),
        key: vec![vec![
            sign("s0", Shape::Star, "true objects"),
            sign("s1", Shape::Circle, "tessellated, by level"),
        ]],
        note: format!(
            "wrong: holes, extra, another object, or more than {} pixels off; filled: nothing else is as fast and as right",
            model.max_displacement
        ),
        colours: ["bmssm", "ssm"].map(|family| palette::of(family).light).to_vec(),
    };
    sheet.file()
}

fn plot(scene: &SceneRows, what: &str, horizontal: Axis, x: impl Fn(&ModelRow) -> f64) -> Plot {
    let value = |row: &ModelRow| (x(row), row.errors.wrong_part().max(NONE));
    let mark = |row: &ModelRow| {
        let (class, shape, label) = match row.form {
            Form::True => ("s0", Shape::Star, "true".to_owned()),
            Form::Level(level) => ("s1", Shape::Circle, level.to_string()),
        };
        Mark {
            value: value(row),
            shape,
            class: format!("mark {}{class}", if row.front { "" } else { "hollow " }),
            tip: format!("{}: {} % wrong", row.form, digits(row.errors.wrong_part() * 100.0)),
            label: Some(label),
        }
    };
    let parts =
        |part: f64| if part <= NONE { "none".to_owned() } else { format!("{} %", short(part * 100.0)) };
    let levels = scene.rows.iter().filter(|row| row.form != Form::True).map(value);
    Plot {
        name: format!("{}: {what}", scene.scene),
        size: (400.0, 260.0),
        horizontal,
        vertical: Axis {
            ticks: &[NONE, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0],
            ..Axis::new("↑ wrong pixels", [], parts)
        },
        lines: vec![Line::new(levels, "grid")],
        marks: scene.rows.iter().map(mark).collect(),
    }
}

/// The page as Markdown; the charts lie beside it as `model.svg`.
pub fn page(model: &Model) -> String {
    let mut out = String::from("# The cost of modelling\n\n");
    for line in conclusions(model) {
        let _ = writeln!(out, "- {line}");
    }
    let _ = writeln!(
        out,
        "\nEach scene as its true objects and as triangles at rising levels, every one with twice the edges around (level 0: 6), by \
         `{}`. A pixel is *wrong* where the true surface is missed (*holes*), where something is shown and there is nothing (*extra*), \
         where another object is shown, or where the right one is more than {} widths of a pixel from its true surface, measured across \
         it (*displaced*). A level is called indistinguishable where at most {} % of the pixels that show anything are wrong. The \
         reference is the true objects in double precision; their own row is in the precision that they are traced with. Normals are \
         the facets'; interpolated ones would be nearer. ns a ray: the least of the samples; a star: nothing else is as fast and as \
         right.\n\n![Wrong pixels against time and bytes](model.svg)\n",
        model.structure,
        digits(model.max_displacement),
        digits(model.max_wrong * 100.0)
    );
    for scene in &model.scenes {
        let _ = writeln!(out, "- {}: {}; {}.", scene.scene, scene.kinds, scene.ended);
    }
    let _ = writeln!(out, "\n{}", table(model).markdown());
    let _ = writeln!(
        out,
        "{}; {} pixels a side; made by `{}`.",
        machine(model),
        units::count(u64::from(model.pixels)),
        model.command
    );
    out
}

fn machine(model: &Model) -> String {
    format!("{}, {}", model.machine.cpu, model.machine.isa)
}
