//! `rayscale trace`

use super::hits::{Traced, trace, trace_all};
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
use scenes::exchange::{RaysCsvError, read_rays, write_all_hits, write_hits};
use std::fs::{self, File};
use std::io::{self, BufReader, Write};
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
Of hits at equal t the lowest object counts. With --all there is a line for each crossing of
the ray, by t and then by object: all triangles that share an edge are crossed where it is met.
Numbers are in the shortest form that reads back
to the same single-precision bits. HITS.csv appears when all of it is there, or not at all.

The ray-triangle test is moller-trumbore unless --kernel says otherwise; external structures
(obvhs-*, embree-*) bring their own. Uses all cores unless --threads says otherwise.

Examples:
  rayscale trace --scene model.obj --rays rays.csv --structure ssm --out hits.csv
  rayscale trace --scene model.obj --rays rays.csv --structure brute --kernel watertight --out hits.csv
  rayscale trace --scene model.obj --rays rays.csv --structure bmssm --kernel auto --max-error 0.5 --out hits.csv
  rayscale trace --scene model.obj --rays rays.csv --structure bmssm --kernel exact --all --out hits.csv")]
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
    /// Every crossing of each ray in order, not the nearest only
    #[arg(long)]
    all: bool,
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
        let rays = RaySet::List(rays);
        if self.all {
            let traced = trace_all(console, &choice, &scene, &rays)?;
            let hits = traced.hits.iter().map(Vec::len).sum();
            self.finish(console, &scene, traced, (hits, "crossings"), |out, hits| write_all_hits(out, hits))
        } else {
            let traced = trace(console, &choice, &scene, &rays)?;
            let hits = traced.hits.iter().flatten().count();
            self.finish(console, &scene, traced, (hits, "hits"), |out, hits| write_hits(out, hits))
        }
    }
}

impl Trace {
    /// Writes what was found and says what it took.
    fn finish<T>(
        &self,
        console: &Console,
        scene: &Scene,
        traced: Traced<T>,
        (hits, what): (usize, &str),
        write: impl Fn(&mut dyn Write, &[T]) -> io::Result<()>,
    ) -> Result<Outcome, Error> {
        let written = write_whole(&self.out, |out| write(out, &traced.hits));
        written.map_err(|error| Error::io(self.out.display(), error))?;
        let rays = traced.hits.len();
        let (build, trace) = (traced.build.as_nanos() as u64, traced.trace.as_nanos() as u64);
        console.result(
            &serde_json::json!({
                "scene": scene.id, "structure": traced.structure.to_string(), "kernel": traced.kernel,
                "kernel_reason": traced.reason,
                "rays": rays, "hits": hits, "build_ns": build, "trace_ns": trace, "out": self.out.to_string_lossy(),
            }),
            format!(
                "{} rays, {} {what} by {} (built in {}, traced in {}) → {}",
                units::count(rays as u64),
                units::count(hits as u64),
                traced.structure,
                units::time(build as f64),
                units::time(trace as f64),
                self.out.display()
            ),
        )?;
        Ok(Outcome::Done)
    }

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
