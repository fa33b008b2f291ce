//! `rayscale render`

use super::hits::trace;
use super::judged;
use crate::console::Console;
use crate::error::{Error, check_place};
use crate::options::{CameraOptions, KernelOptions, shadings, structures};
use crate::verb::{Outcome, Verb};
use accel::input::check_ray;
use accel::{Geometry, Hit, Raster, RaySet, Scene};
use clap::{Args, ValueEnum};
use harness::output::write_whole;
use harness::registry::Choice;
use harness::units;
use image::RgbaImage;
use report::picture::{self, Differences, Shading, difference, shade};
use scenes::SceneSpec;
use scenes::rays::{parallel, perspective};
use std::fmt::Write;
use std::path::{Path, PathBuf};
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

With --against exact, exact arithmetic judges every pixel: vermilion for holes, blue for phantoms,
sky blue for hits displaced by more than 10^-5 of the scene, orange for another object in the same
place, which nobody sees. The picture itself is written beside it, as NAME.picture.png, and how far
shading and depth are off is said. Exit code 1 if a pixel is wrong in a way that shows.

Examples:
  rayscale render bumps-200k --out bumps.png
  rayscale render model.obj --structure ssm --shade normal --size 1024x768 --out model.png
  rayscale render model.obj --up z --eye 4,-3,2 --target 0,0,1 --fov 30 --out model.png
  rayscale render sponza --projection parallel --shade object --out sponza.png
  rayscale render stadium --structure ssm:kernel=watertight --against brute --out difference.png
  rayscale render needles --structure bmssm:kernel=quantised --against exact --out difference.png")]
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
    /// Another structure: show where its hits differ; or `exact`: show what is wrong
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

/// What `--against` names to have exact arithmetic judge.
const EXACT: &str = "exact";

/// Pixels that a picture may have: their hits and colours take 2 GiB.
const MAX_PIXELS: u64 = 1 << 26;

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (cols, rows) = text.split_once('x').unwrap_or((text, text));
        let number = |text: &str| match text.parse() {
            Ok(n) if n > 0 => Ok(n),
            _ => Err("must be a number of pixels such as 512, or 640x480, each at least 1".to_owned()),
        };
        let size = Self { cols: number(cols)?, rows: number(rows)? };
        if u64::from(size.cols) * u64::from(size.rows) > MAX_PIXELS {
            return Err(format!("more than {} pixels", units::count(MAX_PIXELS)));
        }
        Ok(size)
    }
}

impl Verb for Render {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let choice = self.kernel.choose_one(&self.structure)?;
        let plain = KernelOptions::default();
        let judged = self.against.as_deref() == Some(EXACT);
        let against = self.against.as_deref().filter(|_| !judged);
        let against = against.map(|text| plain.choose_one(text)).transpose()?;
        check_place(&self.out)?;
        let spec: SceneSpec = self.camera.named(&self.scene).parse()?;
        let scene = console.scene(&spec)?;
        let raster = self.raster(&scene);
        let rays = RaySet::Raster(raster);
        check_camera(&rays, &scene)?;
        let first = trace(console, &choice, &scene, &rays)?;
        let picture = shade(&scene.geometry, &raster, &first.hits, self.shade);
        let hits = first.hits.iter().flatten().count();
        let mut facts = serde_json::json!({
            "scene": scene.id, "structure": choice.spec.to_string(), "kernel": first.kernel,
            "kernel_reason": first.reason, "out": self.out.to_string_lossy(),
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
        if judged {
            return self.judge(console, &scene, &raster, &first.hits, (facts, text));
        }
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

/// A camera whose corner rays can be traced has no others: the rest lies between them.
fn check_camera(rays: &RaySet, scene: &Scene) -> Result<(), Error> {
    let RaySet::Raster(raster) = rays else { return Ok(()) };
    let (bounds, cols) = (scene.geometry.bounds(), raster.cols as usize);
    let corners = [0, cols - 1, rays.len() - cols, rays.len() - 1];
    corners.into_iter().try_for_each(|i| check_ray(&bounds, &rays.ray(i))).map_err(|error| {
        Error::usage(
            format!("{}: the camera's rays can't be traced: {error}", scene.id),
            "choose another --eye, --target, --fov or scale",
        )
    })
}

impl Render {
    fn raster(&self, scene: &Scene) -> Raster {
        let Size { cols, rows } = self.size;
        match self.projection {
            Camera::Perspective => perspective(&scene.view, rows, cols),
            Camera::Parallel => parallel(&scene.view, &scene.geometry.bounds(), rows, cols),
        }
    }

    /// Shows what is wrong with the hits by exact arithmetic, and how far the picture is off.
    fn judge(
        &self,
        console: &Console,
        scene: &Scene,
        raster: &Raster,
        hits: &[Option<Hit>],
        (mut facts, mut text): (serde_json::Value, String),
    ) -> Result<Outcome, Error> {
        if !matches!(scene.geometry, Geometry::Triangles(_)) {
            return Err(Error::usage(
                format!("{}: exact arithmetic knows triangles only", scene.id),
                "compare with a structure instead, such as `brute`",
            ));
        }
        let rays = RaySet::Raster(*raster);
        let compared = console.in_pool(0, || {
            let exact = judged::exact(scene, &rays);
            let kinds = judged::kinds(scene, &rays, hits, &exact);
            picture::compare(&scene.geometry, raster, [hits, &exact], kinds, self.shade)
        })?;
        self.write(&compared.marked)?;
        let beside = self.out.with_extension("picture.png");
        write_picture(&beside, &compared.picture)?;
        let wrong = &compared.wrong;
        facts["against"] = EXACT.into();
        facts["picture"] = serde_json::json!(beside);
        facts["wrong"] = serde_json::json!(wrong);
        // Writing to a string does not fail.
        let _ = write!(
            text,
            "\n{} of {} pixels are wrong in a way that shows: {}\nWith {}\nThe picture: {}",
            units::count(wrong.counts.visible()),
            units::count(wrong.counts.rays),
            wrong.kinds(),
            wrong.sizes(),
            beside.display(),
        );
        console.result(&facts, text)?;
        Ok(if wrong.counts.visible() == 0 { Outcome::Done } else { Outcome::Failed })
    }

    fn write(&self, picture: &RgbaImage) -> Result<(), Error> {
        write_picture(&self.out, picture)
    }
}

fn write_picture(path: &Path, picture: &RgbaImage) -> Result<(), Error> {
    let written = write_whole(path, |out| picture::write_png(picture, out).map_err(std::io::Error::other));
    written.map_err(|error| Error::io(path.display(), error))
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
