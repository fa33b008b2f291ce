//! `rayscale check --kinds`: every kind of solid through every structure.

use crate::console::Console;
use crate::error::Error;
use crate::options::Selection;
use crate::verb::Outcome;
use harness::registry;
use harness::units;
use report::table::{Column, Table, Value, figure};
use verify::kinds::{Tally, run};

/// So many rays a kind by the structures chosen, or by all of them.
pub fn kinds(console: &Console, rays: u64, selection: &Selection) -> Result<Outcome, Error> {
    let all = registry::defaults();
    let choices = selection.structures(&all)?;
    let specs: Vec<_> = choices.iter().map(|choice| choice.spec.clone()).collect();
    let tally = console.in_pool(0, || {
        run(rays, selection.seed, &specs, |kind| console.note(format_args!("{kind}: done")))
    })?;
    console.result(&tally, text(&tally))?;
    Ok(if tally.is_sound() { Outcome::Done } else { Outcome::Failed })
}

fn text(tally: &Tally) -> String {
    let mut table = Table::new(
        ["kind", "structure"]
            .map(Column::from)
            .into_iter()
            .chain(["rays", "hits", "differences"].map(figure)),
    );
    for row in &tally.rows {
        let [rays, hits, differences] = [row.rays, row.hits, row.differences].map(Value::count);
        let names = [&row.kind, &row.structure].map(Value::text);
        table.push(names.into_iter().chain([rays, hits, differences]));
    }
    let differences: u64 = tally.rows.iter().filter(|row| row.built_in).map(|row| row.differences).sum();
    let rays: u64 = tally.rows.iter().filter(|row| row.built_in).map(|row| row.rays).sum();
    let findings: String = tally.findings.iter().map(|what| format!("\n{what}")).collect();
    format!(
        "{}\n{} rays by the suite's own structures: {differences} differences{findings}",
        table.text(),
        units::count(rays)
    )
}
