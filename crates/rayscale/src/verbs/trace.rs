//! `rayscale trace`

use super::hits::trace;
use crate::console::Console;
use crate::error::{Error, check_place};
use crate::options::{KernelOptions, structures};
use crate::verb::{Outcome, Verb};
use accel::input::check_ray;
use accel::{Ray, RaySet, Scene};
use clap::Args;
use harness::output::write_whole;
use harness::units;
use scenes::SceneSpec;
use scenes::exchange::{RaysCsvError, read_rays, write_hits};
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// Trace rays of a CSV file and write the nearest hits as CSV
#[derive(Debug, Args)]
#[command(after_help = "\
RAYS.csv has a ray a line, with or without a header:
  ox,oy,oz,dx,dy,dz,t_min,t_max
Points of the ray are o + t·d for t from t_min to t_max, both included; t_max may be `inf`;
d need not be of unit length and t is in units of it. Numbers are read as single precision.

HITS.csv has a line for each ray, numbered from 0, after a header:
  ray,object,t,u,v
The object is the triangle's number from 0 in file order, polygons fanned from their first
corner; u and v are the weights of its second and third corner; all four are empty on a miss.
Of hits at equal t the lowest object counts. Numbers are in the shortest form that reads back
to the same single-precision bits. HITS.csv appears when all of it is there, or not at all.

The ray-triangle test is moller-trumbore unless --kernel says otherwise; foreign structures
(obvhs-*, embree-*) bring their own. Uses all cores unless --threads says otherwise.

Examples:
  rayscale trace --scene model.obj --rays rays.csv --structure ssm --out hits.csv
  rayscale trace --scene model.obj --rays rays.csv --structure brute --kernel watertight --out hits.csv
  rayscale trace --scene model.obj --rays rays.csv --structure bmssm --kernel auto --max-error 0.5 --out hits.csv")]
pub struct Trace {
    /// Scene: a mesh, an id or a definition
    #[arg(long, value_name = "FILE.obj")]
    scene: SceneSpec,
    /// The rays
    #[arg(long, value_name = "RAYS.csv")]
    rays: PathBuf,
    /// Structure that finds the hits, with settings
    #[arg(long, value_name = "ID[:NAME=VALUE,…]", value_parser = structures(), hide_possible_values = true)]
    structure: String,
    /// The file to write
    #[arg(long, value_name = "HITS.csv")]
    out: PathBuf,
    #[command(flatten)]
    kernel: KernelOptions,
}

impl Verb for Trace {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let choice = self.kernel.choose_one(&self.structure)?;
        self.spare_the_rays()?;
        check_place(&self.out)?;
        let rays = read(&self.rays)?;
        let scene = console.scene(&self.scene)?;
        self.check_reach(&rays, &scene)?;
        let traced = trace(console, &choice, &scene, &RaySet::List(rays))?;
        let written = write_whole(&self.out, |out| write_hits(out, &traced.hits));
        written.map_err(|error| Error::io(self.out.display(), error))?;
        let (rays, hits) = (traced.hits.len(), traced.hits.iter().flatten().count());
        let (build, trace) = (traced.build.as_nanos() as u64, traced.trace.as_nanos() as u64);
        console.result(
            &serde_json::json!({
                "scene": scene.id, "structure": choice.spec.to_string(), "kernel": traced.kernel,
                "kernel_reason": traced.reason,
                "rays": rays, "hits": hits, "build_ns": build, "trace_ns": trace, "out": self.out.to_string_lossy(),
            }),
            format!(
                "{} rays, {} hits by {} (built in {}, traced in {}) → {}",
                units::count(rays as u64),
                units::count(hits as u64),
                choice.spec,
                units::time(build as f64),
                units::time(trace as f64),
                self.out.display()
            ),
        )?;
        Ok(Outcome::Done)
    }
}

impl Trace {
    /// No ray may begin farther away than structures are right for.
    fn check_reach(&self, rays: &[Ray], scene: &Scene) -> Result<(), Error> {
        let bounds = scene.geometry.bounds();
        let far = rays.iter().enumerate().find_map(|(i, ray)| Some((i, check_ray(&bounds, ray).err()?)));
        far.map_or(Ok(()), |(i, error)| {
            let what = format!("{}, ray {i}: {error}", self.rays.display());
            Err(Error::usage(what, "begin the ray nearer to the scene"))
        })
    }

    /// The hits must not take the place of the rays.
    fn spare_the_rays(&self) -> Result<(), Error> {
        let same = |a: &Path, b: &Path| matches!((fs::canonicalize(a), fs::canonicalize(b)), (Ok(a), Ok(b)) if a == b);
        if same(&self.rays, &self.out) {
            let what = format!("{}: the hits would replace the rays", self.out.display());
            return Err(Error::usage(what, "give --out another name"));
        }
        Ok(())
    }
}

fn read(path: &Path) -> Result<Vec<Ray>, Error> {
    let file = File::open(path).map_err(|error| Error::io(path.display(), error))?;
    read_rays(BufReader::new(file)).map_err(|error| match error {
        RaysCsvError::Read(error) => Error::io(path.display(), error),
        slip => Error::usage(
            format!("{}, {slip}", path.display()),
            "correct the line; `rayscale help trace` says what a ray looks like",
        ),
    })
}
