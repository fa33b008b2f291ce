//! `rayscale render`

use super::hits::trace;
use crate::console::Console;
use crate::error::Error;
use crate::options::{CameraOptions, KernelOptions, shadings, structures};
use crate::verb::{Outcome, Verb};
use accel::{Raster, RaySet, Scene};
use clap::{Args, ValueEnum};
use harness::output::write_whole;
use harness::registry::Choice;
use harness::units;
use image::RgbaImage;
use report::picture::{self, Differences, Shading, difference, shade};
use scenes::SceneSpec;
use scenes::rays::{parallel, perspective};
use std::fmt::Write;
use std::path::PathBuf;
use std::str::FromStr;

/// Render a scene to a PNG by any structure, or show where two structures' hits differ
#[derive(Debug, Args)]
#[command(after_help = "\
The scene is an id of `rayscale scenes`, a definition or a mesh; structures are listed by
`rayscale structures`, their settings follow after a colon. Uses all cores unless --threads
says otherwise. Where nothing is hit the picture is transparent.

With --against, the picture is grey and the pixels that differ in any bit are in colour:
vermilion where the first structure misses a hit, blue where it invents one, orange where it
hits another object, sky blue where it hits the same object elsewhere. Exit code 1 if any does.

Examples:
  rayscale render bumps-200k --out bumps.png
  rayscale render model.obj --structure ssm --shade normal --size 1024x768 --out model.png
  rayscale render model.obj --up z --eye 4,-3,2 --target 0,0,1 --fov 30 --out model.png
  rayscale render sponza --projection parallel --shade object --out sponza.png
  rayscale render stadium --structure ssm:kernel=watertight --against brute --out difference.png")]
pub struct Render {
    /// Scene: an id, a definition or a mesh
    scene: String,
    #[command(flatten)]
    camera: CameraOptions,
    /// The file to write
    #[arg(long, value_name = "FILE.png")]
    out: PathBuf,
    /// Structure that finds the hits, with settings
    #[arg(long, value_name = "ID[:NAME=VALUE,…]", default_value = "ssm", value_parser = structures(), hide_possible_values = true)]
    structure: String,
    #[command(flatten)]
    kernel: KernelOptions,
    /// Another structure: show where its hits differ
    #[arg(long, value_name = "ID[:NAME=VALUE,…]", value_parser = structures(), hide_possible_values = true)]
    against: Option<String>,
    /// Pixels: columns x rows, or one number for both
    #[arg(long, value_name = "COLS[xROWS]", default_value = "512")]
    size: Size,
    /// Camera
    #[arg(long, value_enum, default_value_t = Camera::Perspective)]
    projection: Camera,
    /// What the colours say
    #[arg(long, value_parser = shadings(), default_value = "light")]
    shade: Shading,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Camera {
    /// Rays from the scene's eye
    Perspective,
    /// Parallel rays, framing the whole scene
    Parallel,
}

/// Columns and rows of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Size {
    cols: u32,
    rows: u32,
}

/// Pixels that a picture may have: their hits and colours take 2 GiB.
const MOST_PIXELS: u64 = 1 << 26;

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (cols, rows) = text.split_once('x').unwrap_or((text, text));
        let number = |text: &str| match text.parse() {
            Ok(n) if n > 0 => Ok(n),
            _ => Err("must be a number of pixels such as 512, or 640x480, each at least 1".to_owned()),
        };
        let size = Self { cols: number(cols)?, rows: number(rows)? };
        if u64::from(size.cols) * u64::from(size.rows) > MOST_PIXELS {
            return Err(format!("more than {} pixels", units::count(MOST_PIXELS)));
        }
        Ok(size)
    }
}

impl Verb for Render {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let choice = self.kernel.choose_one(&self.structure)?;
        let plain = KernelOptions::default();
        let against = self.against.as_deref().map(|text| plain.choose_one(text)).transpose()?;
        let spec: SceneSpec = self.camera.named(&self.scene).parse()?;
        let scene = console.scene(&spec)?;
        let raster = self.raster(&scene);
        let rays = RaySet::Raster(raster);
        let first = trace(console, &choice, &scene, &rays)?;
        let picture = shade(&scene.geometry, &raster, &first.hits, self.shade);
        let hits = first.hits.iter().flatten().count();
        let mut facts = serde_json::json!({
            "scene": scene.id, "structure": choice.spec.to_string(), "kernel": first.kernel,
            "kernel_reason": first.reason, "out": self.out,
            "cols": raster.cols, "rows": raster.rows, "hits": hits,
        });
        let mut text = format!(
            "{}: {} × {} pixels, {} of {} hit, by {} → {}",
            scene.id,
            raster.cols,
            raster.rows,
            units::count(hits as u64),
            units::count(raster.len() as u64),
            choice.spec,
            self.out.display()
        );
        let Some(against) = against else {
            self.write(&picture)?;
            console.result(&facts, text)?;
            return Ok(Outcome::Done);
        };
        let second = trace(console, &against, &scene, &rays)?;
        let (picture, differences) = difference(&picture, &first.hits, &second.hits);
        self.write(&picture)?;
        facts["against"] = against.spec.to_string().into();
        facts["differences"] = serde_json::json!(differences);
        // Writing to a string does not fail.
        let _ = write!(text, "\n{}", in_words(&choice, &against, &differences));
        console.result(&facts, text)?;
        Ok(if differences.total() == 0 { Outcome::Done } else { Outcome::Failed })
    }
}

impl Render {
    fn raster(&self, scene: &Scene) -> Raster {
        let Size { cols, rows } = self.size;
        match self.projection {
            Camera::Perspective => perspective(&scene.view, rows, cols),
            Camera::Parallel => parallel(&scene.view, &scene.geometry.bounds(), rows, cols),
        }
    }

    fn write(&self, picture: &RgbaImage) -> Result<(), Error> {
        let written =
            write_whole(&self.out, |out| picture::write_png(picture, out).map_err(std::io::Error::other));
        written.map_err(|error| Error::io(self.out.display(), error))
    }
}

fn in_words(first: &Choice, other: &Choice, differences: &Differences) -> String {
    let Differences { pixels, missed, invented, object, place } = *differences;
    let pixels = units::count(pixels);
    if differences.total() == 0 {
        return format!("{} and {} agree in every bit of {pixels} pixels", first.spec, other.spec);
    }
    format!(
        "{} of {pixels} pixels differ from {}: {missed} missed, {invented} invented, {object} on another object, \
         {place} elsewhere on the same object",
        units::count(differences.total()),
        other.spec,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!("640x480".parse(), Ok(Size { cols: 640, rows: 480 }));
        assert_eq!("64".parse(), Ok(Size { cols: 64, rows: 64 }));
        for bad in ["", "0", "64x0", "x", "64x", "-1", "1e3", "99999x99999", "4294967296"] {
            assert!(bad.parse::<Size>().is_err(), "{bad}");
        }
    }
}
