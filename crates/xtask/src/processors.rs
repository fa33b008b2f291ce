//! `cargo xtask processors`: the program on emulated processors that lack instructions, held to itself on this one.

use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode};

use crate::host::apt_install;
use crate::places::Places;
use crate::shell::{cargo, output, there_is};

const EMULATOR: &str = "qemu-x86_64-static";

/// What QEMU calls them, and what they lack beside AVX-512. On one with AVX2 and without BMI1, of which there is none, the C
/// library of Debian 12 itself ends by an illegal instruction.
const PROCESSORS: [(&str, &str); 7] = [
    ("core2duo", "SSE 4, POPCNT, AVX, BMI, LZCNT"),
    ("Nehalem", "AVX, BMI, LZCNT"),
    ("SandyBridge", "AVX2, BMI, LZCNT"),
    ("Haswell,-abm", "LZCNT"),
    ("Haswell,-bmi2", "BMI2"),
    ("Haswell,-popcnt", "POPCNT"),
    ("Haswell", "nothing else"),
];

const SCENES: [&str; 3] = ["unit-coplanar", "small-10k", "unit-equal"];
const STRUCTURES: [&str; 8] = [
    "minmax:kernel=exact",
    "sphere",
    "bmssm-dense",
    "bmssm",
    "bmssm:kernel=exact",
    "ssm-list",
    "ssm",
    "ssm:kernel=watertight",
];

/// Rays of the random cases that each processor holds to brute force: as many as the marathon does together.
const RAYS: &str = "1";

/// Builds the program for any processor, and fails where an emulated one gives another answer than this one.
pub fn run(places: &Places) -> ExitCode {
    match compare(places) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("xtask: {why}");
            ExitCode::FAILURE
        }
    }
}

fn compare(places: &Places) -> Result<(), String> {
    if !cfg!(target_arch = "x86_64") {
        return Err("these are processors of x86-64: there is nothing to compare with here".to_owned());
    }
    if !there_is(EMULATOR) {
        apt_install(&["qemu-user-static"])?;
    }
    output(cargo().current_dir(&places.root).args(["build", "--release", "-p", "rayscale"]))?;
    let program = places.root.join("target/release/rayscale");
    let folder = std::env::temp_dir().join(format!("rayscale-processors-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let done = on_all(&program, &folder);
    // What is left over is the system's to clear away.
    let _ = fs::remove_dir_all(&folder);
    done
}

fn on_all(program: &Path, folder: &Path) -> Result<(), String> {
    let mut expected = Vec::new();
    let rays = folder.join("rays.csv");
    fs::write(&rays, some_rays()).map_err(|e| format!("{}: {e}", rays.display()))?;
    for scene in SCENES {
        for structure in STRUCTURES {
            let hits = traced(&mut Command::new(program), scene, structure, &rays, folder)?;
            expected.push((scene, structure, hits));
        }
    }
    for (processor, lacks) in PROCESSORS {
        let emulated = || {
            let mut command = Command::new(EMULATOR);
            command.args(["-cpu", processor]).arg(program);
            command
        };
        let mut rays_traced = 0;
        for (scene, structure, expected) in &expected {
            let hits = traced(&mut emulated(), scene, structure, &rays, folder)?;
            if hits != *expected {
                return Err(format!(
                    "{processor}: {structure} on {scene} gives other hits than this processor"
                ));
            }
            rays_traced += hits.lines().count() - 1;
        }
        let record = folder.join(format!("{processor}.json"));
        let mut marathon = emulated();
        marathon.args(["check", "--quiet", "--until", RAYS, "--marathon"]).arg(&record);
        output(&mut marathon).map_err(|why| format!("{processor}: random cases: {why}"))?;
        println!(
            "{processor}, without {lacks}: {rays_traced} rays as on this processor, random cases as brute force"
        );
    }
    Ok(())
}

/// Rays about the origin of coordinates, as CSV.
fn some_rays() -> String {
    let mut state = 1u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 23) - 1.0
    };
    let mut text = String::from("ox,oy,oz,dx,dy,dz,t_min,t_max\n");
    for _ in 0..2000 {
        let numbers: Vec<String> = (0..6).map(|_| number().to_string()).collect();
        text += &numbers.join(",");
        text += ",0,inf\n";
    }
    text
}

/// The hits as CSV.
fn traced(
    program: &mut Command,
    scene: &str,
    structure: &str,
    rays: &Path,
    folder: &Path,
) -> Result<String, String> {
    let out = folder.join("hits.csv");
    let trace = ["trace", "--quiet", "--scene", scene, "--structure", structure, "--rays"];
    output(program.args(trace).arg(rays).arg("--out").arg(&out))?;
    fs::read_to_string(&out).map_err(|e| format!("{}: {e}", out.display()))
}
