//! Records for tests, made up.

use harness::clock::Clock;
use harness::machine::Machine;
use harness::record::*;

/// Name, ns per ray and bytes per object of each.
const STRUCTURES: [(&str, f64, f64); 12] = [
    ("minmax", 9000.0, 24.0),
    ("sphere", 12_000.0, 16.0),
    ("bmssm-dense", 900.0, 256.0),
    ("bmssm", 110.0, 14.0),
    ("ssm-list", 420.0, 90.0),
    ("ssm", 190.0, 31.0),
    ("obvhs-bvh2", 330.0, 140.0),
    ("obvhs-cwbvh", 210.0, 77.0),
    ("embree", 105.0, 66.0),
    ("embree-robust", 121.0, 66.5),
    ("embree-compact", 160.0, 31.5),
    ("embree-packet", 44.0, 66.0),
];
const SCENES: [(&str, u64, f64); 5] = [
    ("small-100k", 100_000, 1.6),
    ("stadium", 42_000, 2.3),
    ("bunny", 69_666, 0.9),
    ("dragon", 871_414, 1.3),
    ("sponza", 66_450, 0.8),
];
const RAYS: [(&str, f64); 7] = [
    ("parallel", 1.0),
    ("perspective", 1.1),
    ("shadow", 2.0),
    ("ambient", 1.4),
    ("diffuse", 3.5),
    ("random", 2.9),
    ("axis", 1.8),
];

/// A record as large as the default comparison's, with every kind of figure and fault.
pub fn large() -> Record {
    let mut state = 1u32;
    let mut noise = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        0.7 + f64::from(state >> 8) / f64::from(1 << 24) * 0.8
    };
    let mut cells = Vec::new();
    for (scene, objects, slow) in SCENES {
        for (rays, share) in RAYS {
            for (structure, ns, bytes) in STRUCTURES {
                if structure == "embree-packet" && !rays.starts_with('p') {
                    continue;
                }
                let figure = (ns * slow * share * noise(), bytes * noise());
                cells.push(cell(scene, objects, rays, structure, figure));
            }
        }
    }
    cells[7].outcome = Outcome::Unsupported(
        "obvhs-cwbvh does not serve this: a reason that is rather long, for a test of narrow pages".into(),
    );
    cells[7].ns_per_ray = None;
    let structure = |(id, ..): (&str, f64, f64)| Structure {
        id: id.into(),
        version: "0.1.0".into(),
        settings: "kernel=moller-trumbore simd=avx2 resolution=64x64x64".into(),
        description: format!("what {id} is, in a line"),
    };
    let scene = |(id, objects, _): (&str, u64, f64)| SceneEntry {
        id: id.into(),
        objects,
        kind: "triangles".into(),
        source: "generated, seed 1".into(),
        checksum: "0123456789abcdef".repeat(4),
    };
    let memory = |(id, objects, _): (&str, u64, f64)| {
        [8, 16, 32, 64, 128].map(|n| {
            let mut row = MemoryRow::by_formula(id, objects, n, 1.5);
            row.paper_layouts =
                Some(Layout { ssm: row.formula_4_byte.ssm, bmssm: row.formula_4_byte.bmssm * 1.05 });
            row.compact_layouts =
                Some(Layout { ssm: row.formula_4_byte.ssm * 0.4, bmssm: row.formula_4_byte.bmssm * 0.1 });
            row
        })
    };
    Record {
        format: FORMAT,
        started_unix: 1_760_000_000,
        command: "rayscale compare --full --scene small-100k --scene stadium --out reports/record.json"
            .into(),
        suite: Suite {
            version: "0.1.0".into(),
            git: "0123456789ab".into(),
            profile: "release".into(),
            rustflags: "-C target-cpu=native".into(),
            rustc: "rustc 1.95.0".into(),
        },
        machine: Machine {
            cpu: "A Processor With A Long Name @ 2.00GHz".into(),
            isa: "x86_64 avx512".into(),
            cores: 2,
            os: "linux".into(),
            memory_bytes: 24 << 30,
            flush_to_zero: false,
            denormals_are_zero: false,
        },
        run: Some(Run {
            size: 256,
            seed: 1,
            threads: 1,
            clock: Clock::Thread,
            rounds: 5,
            counters: false,
            complete: true,
        }),
        structures: STRUCTURES.map(structure).into(),
        scenes: SCENES.map(scene).into(),
        cells,
        memory: SCENES.into_iter().flat_map(memory).collect(),
        skipped: vec![Skipped { id: "bunny".into(), reason: "its mesh bunny.obj is not here".into() }],
    }
}

fn cell(scene: &str, objects: u64, rays: &str, structure: &str, (ns, bytes): (f64, f64)) -> Cell {
    let is_foreign = structure.starts_with("obvhs") || structure.starts_with("embree");
    let errors = Errors {
        missed: 3,
        false_hits: 1,
        wrong_object: 7,
        kinds: None,
        t_ulp_p99: 2.0,
        t_ulp_max: 1e6,
        rays_exact: 507,
    };
    let mut cell = Cell {
        scene: scene.into(),
        rays: rays.into(),
        query: if matches!(rays, "shadow" | "ambient") { Query::Occluded } else { Query::Closest },
        structure: structure.into(),
        kernel: Intersector::from(if is_foreign { "own" } else { "moller-trumbore" }.to_owned()),
        kernel_reason: String::new(),
        threads: 1,
        ray_count: 100_000,
        hits: 61_234,
        build_ns: [1.0, 1.1, 0.97]
            .map(|f| (objects as f64 * ns.ln() * 40.0 * f / (1.0 + ns / 900.0)) as u64)
            .into(),
        trace_ns: [1.0, 1.03, 0.98, 1.3, 1.01].map(|f| (ns * f * 100_000.0) as u64).into(),
        passes: Vec::new(),
        ns_per_ray: None,
        bytes: Some(Bytes {
            structure: (bytes * objects as f64) as u64,
            geometry_copy: objects * 4,
            peak_build: (!structure.starts_with("embree")).then_some(objects * 300),
            allocated: None,
            parts: Default::default(),
        }),
        plan: String::new(),
        counters: None,
        check: Some(Check {
            rays_checked: 20_000,
            differences: if is_foreign { 11 } else { 0 },
            errors: is_foreign.then_some(errors),
        }),
        outcome: Outcome::Measured,
    };
    cell.summarise();
    cell
}
