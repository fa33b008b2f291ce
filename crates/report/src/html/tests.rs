//! The page as a whole.

use super::*;
use harness::record::{Errors, MemoryRow, Outcome, Timing};
use harness::testing;

/// A record with something for every section.
pub fn full() -> Record {
    let mut record = testing::record();
    record.memory = [8, 16, 32, 64].map(|n| MemoryRow::by_formula("one", 1000, n, 1.0)).into();
    record.cells[0].check.as_mut().unwrap().errors = Some(Errors {
        missed: 1,
        false_hits: 2,
        wrong_object: 3,
        kinds: None,
        t_ulp_p99: 1.5,
        t_ulp_max: 4.0,
        rays_exact: 9,
    });
    record
}

fn pictures() -> Pictures {
    let picture = Picture { png: vec![1, 2, 3], caption: "one & only".into() };
    let worst = vec![Picture { caption: "where it is worst".into(), ..picture.clone() }];
    Pictures { worst, ..[("one".to_owned(), vec![picture])].into() }
}

#[test]
fn every_section_is_there_and_in_the_navigation() {
    let page = html(&full(), &pictures());
    for id in [
        "summary",
        "speed",
        "memory",
        "scenes",
        "ratio",
        "errors",
        "worst",
        "all",
        "structures-section",
        "machine",
    ] {
        assert!(page.contains(&format!("<section id=\"{id}\">")), "{id}");
        assert!(page.contains(&format!("<a href=\"#{id}\">")), "{id}");
    }
    assert!(page.contains("data:image/png;base64,AQID") && page.contains("one &amp; only"));
}

#[test]
fn nothing_is_fetched() {
    let page = html(&full(), &pictures());
    for forbidden in ["http:", "https:", "src=\"/", "@import", "url(", "<link", "fetch(", "XMLHttp"] {
        assert!(!page.contains(forbidden), "{forbidden}");
    }
}

#[test]
fn names_from_outside_stay_text() {
    let mut record = full();
    let evil = "<script>alert(1)</script>\"'&";
    for cell in &mut record.cells {
        cell.scene = format!("{}{evil}", cell.scene);
        cell.structure = format!("{}{evil}", cell.structure);
        cell.outcome = Outcome::Failed(evil.into());
        cell.plan = evil.into();
    }
    for scene in &mut record.scenes {
        scene.id = format!("{}{evil}", scene.id);
        scene.source = evil.into();
    }
    record.command = evil.into();
    record.skipped[0].reason = evil.into();
    let page = html(&record, &Pictures::new());
    assert!(!page.contains("<script>alert"), "escaped everywhere");
    assert_eq!(page.matches("<script>").count(), 1);
}

#[test]
fn an_empty_record_makes_a_page() {
    let mut record = testing::record();
    record.cells.clear();
    record.scenes.clear();
    record.structures.clear();
    record.memory.clear();
    let page = html(&record, &Pictures::new());
    assert!(page.contains("No answer was checked") && page.ends_with("</html>\n"));
}

#[test]
fn elements_are_closed() {
    let page = html(&full(), &pictures());
    for element in [
        "section", "details", "figure", "svg", "g", "table", "tr", "td", "th", "ul", "li", "p", "div", "text",
    ] {
        let opened =
            page.matches(&format!("<{element}>")).count() + page.matches(&format!("<{element} ")).count();
        assert_eq!(opened, page.matches(&format!("</{element}>")).count(), "{element}");
    }
}

#[test]
fn dates() {
    for (unix, day) in [
        (0, "1970-01-01"),
        (951_782_400, "2000-02-29"),
        (1_700_000_000, "2023-11-14"),
        (4_107_542_400, "2100-03-01"),
    ] {
        assert_eq!(super::day(unix), day);
    }
    assert_eq!(super::day(u64::MAX), "on an unknown day");
}

#[test]
fn figures_at_the_ends_of_all_numbers_make_a_page_at_once() {
    let mut record = full();
    for (cell, ns) in record.cells.iter_mut().zip([5e-324, 1e308].into_iter().cycle()) {
        cell.ns_per_ray = Some(Timing { median: ns, mad: 1e308, min: 5e-324 });
        cell.build_ns = vec![u64::MAX, 0];
        cell.trace_ns = vec![u64::MAX, 0];
        cell.bytes.as_mut().unwrap().structure = u64::MAX;
    }
    let page = html(&record, &Pictures::new());
    assert!(page.contains("1.00e299 s") && page.ends_with("</html>\n"));
}
