//! Charts of known figures.

use super::*;
use crate::aggregate::by_kind;
use crate::chart::Styles;
use harness::record::Record;
use harness::testing;

/// Lists of rays that three structures answer: `embree` is faster, `small` takes less memory, `worse` is neither.
fn lists() -> Record {
    let mut record = testing::record();
    record.cells.clear();
    for scene in ["one", "two"] {
        for rays in ["shadow", "diffuse"] {
            for (structure, ns, bytes) in [
                ("embree", 100.0, 64_000),
                ("small:geometry=quantised", 150.0, 8_000),
                ("worse", 160.0, 9_000),
            ] {
                let mut cell = testing::cell(scene, rays, structure, ns);
                let memory = cell.bytes.get_or_insert_default();
                (memory.structure, memory.geometry_copy) = (bytes / 2, bytes / 2);
                record.cells.push(cell);
            }
        }
    }
    record
}

#[test]
fn memory_against_speed_is_relative_to_embree_and_fills_the_front() {
    let record = lists();
    let kinds = by_kind(&record, 1);
    let styles = Styles::new(record.cells.iter().map(|cell| cell.structure.as_str()));
    let chart = pareto(&kinds[0], &styles).unwrap().0.into_string();
    for part in [
        "time per ray / embree",
        "structure and copies per object",
        "class=\"mark s0\"",
        "class=\"mark s1\"",
        "class=\"mark hollow s2\"",
        "small:geometry=quantised: 150 ns per ray (1.5× the time of embree)",
        "(0.125×), on the front (geometric means over 2 scenes and 2 ray sets)",
        "class=\"front\"",
    ] {
        assert!(chart.contains(part), "no {part} in {chart}");
    }
}

#[test]
fn figures_at_the_ends_of_all_numbers_make_a_chart() {
    let mut record = lists();
    for (cell, ns) in record.cells.iter_mut().zip([5e-324, 1e308, 1.0].into_iter().cycle()) {
        cell.ns_per_ray.as_mut().unwrap().median = ns;
    }
    let styles = Styles::new([]);
    for of in by_kind(&record, 1) {
        assert!(pareto(&of, &styles).is_none() || !of.rows.is_empty());
        let cells: Vec<_> = record.cells.iter().filter(|cell| cell.scene == "one").collect();
        assert!(growth(&cells, "growth", &styles).is_some() && bars(&cells, "bars", &styles).is_some());
    }
}
