//! `rayscale check --verify`: named questions for every structure.

use crate::console::Console;
use crate::error::Error;
use crate::verb::Outcome;
use harness::registry;
use harness::units;
use report::table::{Column, Table, Value};
use verify::groups::{self, Verdict, Verification};

/// Asks, and prints a row for each question and a column for each structure.
pub fn verify(console: &Console, pattern: &str, structures: &[String]) -> Result<Outcome, Error> {
    for name in structures {
        registry::find(name)?;
    }
    let asked: Vec<_> = groups::all().into_iter().filter(|group| group.name.contains(pattern)).collect();
    if asked.is_empty() {
        return Err(Error::unknown("question", pattern, groups::all().iter().map(|group| group.name)));
    }
    let bar = console.bar(asked.len() as u64, "asking");
    let begun = |group: &groups::Group| {
        bar.inc(1);
        bar.set_message(format!("{}: {}", group.name, group.about));
    };
    let verification = console.in_pool(0, || groups::run(pattern, structures, begun))?;
    bar.finish_and_clear();
    console.result(&verification, text(&verification))?;
    Ok(if verification.is_sound() { Outcome::Done } else { Outcome::Failed })
}

fn text(verification: &Verification) -> String {
    let mut structures: Vec<&str> = Vec::new();
    let mut questions: Vec<&str> = Vec::new();
    for row in &verification.rows {
        if !structures.contains(&row.structure) {
            structures.push(row.structure);
        }
        if !questions.contains(&row.group) {
            questions.push(row.group);
        }
    }
    let names = std::iter::once("question").chain(structures.iter().copied());
    let mut table = Table::new(names.map(Column::from));
    let (mut notes, mut faults) = (Vec::new(), String::new());
    for question in questions {
        let rows = verification.rows.iter().filter(|row| row.group == question);
        let cells = rows.map(|row| match &row.verdict {
            Verdict::Passed { checks } => format!("{} ✓", units::count(*checks)),
            Verdict::Counted { checks, wrong } => {
                format!("{} of {}", units::count(*wrong), units::count(*checks))
            }
            Verdict::NotAsked { why } => {
                let note = notes.iter().position(|known| known == why).unwrap_or_else(|| {
                    notes.push(*why);
                    notes.len() - 1
                });
                format!("– ({})", note + 1)
            }
            Verdict::Wrong { what } => {
                faults += &format!("\n{question}, {}: {what}", row.structure);
                "WRONG".to_owned()
            }
        });
        let cells: Vec<String> = std::iter::once(question.to_owned()).chain(cells).collect();
        table.push(cells.iter().map(Value::text));
    }
    let notes: String = notes.iter().enumerate().map(|(i, why)| format!("\n({}) {why}", i + 1)).collect();
    let meaning = "✓: so many checks, all as promised; `n of m`: a library that promises nothing of the kind gave n wrong \
                   answers; –: not asked";
    format!("{}\n{meaning}{notes}{faults}", table.text())
}
