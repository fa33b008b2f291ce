//! `cargo xtask fuzz --planted`: faults put into copies of the sources one after another, and how soon the fuzzers find each.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use super::tool::Tool;
use crate::places::Places;
use crate::shell::output;

/// Seconds that a fault may stay unfound.
const SECONDS: u64 = 60;

/// A fault that a target has to find.
struct Fault {
    /// The fuzz target.
    target: &'static str,
    /// What is wrong with it.
    what: &'static str,
    /// A file of the checkout, a text that stands in it once, and what is put in its place.
    file: &'static str,
    text: &'static str,
    replaced: &'static str,
}

/// One a reader at least, and one a structure with maps or cells; those of one crate follow each other, as a crate is compiled again
/// for each.
const FAULTS: [Fault; 12] = [
    Fault {
        target: "obj",
        what: "coordinates that are not finite are taken",
        file: "crates/scenes/src/reader/obj.rs",
        text: "polygons.mesh.triangles.is_empty() || !polygons.mesh.positions.iter().all(|p| p.is_finite())",
        replaced: "polygons.mesh.triangles.is_empty()",
    },
    Fault {
        target: "ply",
        what: "a face may name a vertex that is not there",
        file: "crates/scenes/src/reader/ply.rs",
        text: "if index < 0 || index as usize >= vertices {",
        replaced: "if index < 0 || index as usize > vertices {",
    },
    Fault {
        target: "rays",
        what: "numbers that make no ray are taken",
        file: "crates/scenes/src/exchange/rays.rs",
        text: "    ray.validate().map_err(|source| RaysCsvError::Ray { line, source })?;\n",
        replaced: "    let _ = line;\n",
    },
    Fault {
        target: "scene",
        what: "a number of objects overflows",
        file: "crates/scenes/src/generate/mod.rs",
        text: "base.saturating_pow(exponent)",
        replaced: "base.pow(exponent)",
    },
    Fault {
        target: "settings",
        what: "two of a grid's resolutions are taken for each other",
        file: "crates/ssm/src/resolution.rs",
        text: "Ok([x, y, z]) => [*x, *y, *z],",
        replaced: "Ok([x, y, z]) => [*x, *z, *y],",
    },
    Fault {
        target: "record",
        what: "an outcome is written as another",
        file: "crates/harness/src/record/outcome.rs",
        text: "Outcome::Skipped(_) => Kind::Skipped,",
        replaced: "Outcome::Skipped(_) => Kind::Failed,",
    },
    Fault {
        target: "structures",
        what: "ssm: an object is not registered in its last cell",
        file: "crates/ssm/src/compact/bricks.rs",
        text: "((range.end - 1) >> (SHIFT * levels)) + 1",
        replaced: "((range.end - 1) >> (SHIFT * levels)).max((range.start >> (SHIFT * levels)) + 1)",
    },
    Fault {
        target: "structures",
        what: "ssm: the walk of a ray whose direction is infinite has no end",
        file: "crates/ssm/src/compact/segment.rs",
        text: "s.select(moves, per_cell, zero)",
        replaced: "s.select(s.lt(s.abs(delta), s.splat(self.parallel[axis])), zero, per_cell)",
    },
    Fault {
        target: "structures",
        what: "ssm-list: the walk ends at the first cell with a hit, wherever that lies",
        file: "crates/ssm/src/list.rs",
        text: "limit = segment.limit(best.t);",
        replaced: "limit = 0.0;",
    },
    Fault {
        target: "structures",
        what: "bmssm-dense: an object is not registered in its last slice",
        file: "crates/bmssm/src/dense/axis.rs",
        text: ".take(slices.end as usize)",
        replaced: ".take(slices.end.max(slices.start + 2) as usize - 1)",
    },
    Fault {
        target: "structures",
        what: "bmssm: an object is not registered in the slice in which it ends",
        file: "crates/bmssm/src/general/maps.rs",
        text: "s.le(s.splat(slice as f32), end)",
        replaced: "s.le(s.splat((slice + 1) as f32), end)",
    },
    Fault {
        target: "structures",
        what: "bmssm: the walk ends at the first block with a hit, wherever that lies",
        file: "crates/bmssm/src/general/trace.rs",
        text: "limit = segment.limit(best.t);",
        replaced: "limit = 0.0;",
    },
];

/// Plants each fault in a copy of the checkout, and says how long its target takes to find it.
///
/// # Errors
/// What can't be copied or built, and the faults that were not found in time.
pub fn run(places: &Places, tool: Tool) -> Result<(), String> {
    let folder = tempfile::tempdir().map_err(|why| format!("no temporary folder: {why}"))?;
    let copy = folder.path();
    copy_sources(&places.root, copy)?;
    let mut unfound = Vec::new();
    println!("| target | fault | found after |\n|---|---|---:|");
    for Fault { target, what, file, text, replaced } in FAULTS {
        let path = copy.join(file);
        let sound = fs::read_to_string(&path).map_err(|why| format!("{file}: {why}"))?;
        let write = |text: &str| fs::write(&path, text).map_err(|why| format!("{file}: {why}"));
        write(&sound.replacen(text, replaced, 1))?;
        let found = find(copy, tool, target);
        write(&sound)?;
        match found? {
            Some(seconds) => println!("| {target} | {what} | {seconds:.1} s |"),
            None => {
                println!("| {target} | {what} | not in {SECONDS} s |");
                unfound.push(what);
            }
        }
    }
    if unfound.is_empty() { Ok(()) } else { Err(format!("not found: {}", unfound.join("; "))) }
}

/// Builds a target and lets it run, one process and one thread, from its corpus. Seconds until it ended by a finding.
fn find(copy: &Path, tool: Tool, target: &str) -> Result<Option<f64>, String> {
    let artifacts = copy.join("fuzz/artifacts").join(target);
    // What an earlier fault left there is none of this one.
    let _ = fs::remove_dir_all(&artifacts);
    output(&mut tool.build(copy, target))?;
    let began = Instant::now();
    let ended = tool.run(copy, target, &format!("-max_total_time={SECONDS}")).output();
    let ended = ended.map_err(|why| format!("{target} cannot be run: {why}"))?;
    let seconds = began.elapsed().as_secs_f64();
    let found = fs::read_dir(&artifacts).is_ok_and(|mut files| files.next().is_some());
    if !found && !ended.status.success() {
        return Err(format!("{target} failed: {}", String::from_utf8_lossy(&ended.stderr)));
    }
    Ok(found.then_some(seconds))
}

/// Copies the files that git knows, as they are now.
fn copy_sources(root: &Path, copy: &Path) -> Result<(), String> {
    for file in output(Command::new("git").current_dir(root).args(["ls-files"]))?.lines() {
        let to = copy.join(file);
        fs::create_dir_all(to.parent().expect("a file lies in a folder"))
            .and_then(|()| fs::copy(root.join(file), &to))
            .map_err(|why| format!("{file}: {why}"))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fault_can_be_planted() {
        let root = Places::of_this_checkout().root;
        for Fault { target, file, text, replaced, .. } in FAULTS {
            let sound = fs::read_to_string(root.join(file)).unwrap();
            assert_eq!(sound.matches(text).count(), 1, "{file}: {text}");
            assert_ne!(text, replaced);
            assert!(super::super::TARGETS.contains(&target), "{target}");
        }
    }
}
