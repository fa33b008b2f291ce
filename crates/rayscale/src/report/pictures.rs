//! Pictures of a record's scenes, for those that are on this machine.

use super::html::{Picture, Pictures};
use crate::picture::{Shading, shade, write_png};
use crate::rays::perspective;
use crate::record::{Record, SceneEntry};
use crate::{registry, scene};
use accel::{Need, RaySet};

const COLS: u32 = 480;
const ROWS: u32 = 320;

/// A picture of every scene that can be had here and is, by its checksum, the one measured.
pub fn pictures(record: &Record) -> Pictures {
    let with_picture = |entry: &SceneEntry| Some((entry.id.clone(), vec![render(entry)?]));
    record.scenes.iter().filter_map(with_picture).collect()
}

fn render(entry: &SceneEntry) -> Option<Picture> {
    let scene = scene::load(&entry.id.parse().ok()?).ok()?;
    if scene::checksum(&scene.geometry) != entry.checksum {
        return None;
    }
    let raster = perspective(&scene.view, ROWS, COLS);
    let rays = RaySet::Raster(raster);
    let grid = registry::parse("ssm").ok()?;
    let accel = grid.builder.build(&scene, &Need::of(&rays)).ok()?;
    let mut hits = vec![None; rays.len()];
    accel.trace(&rays, &mut hits);
    let mut png = Vec::new();
    write_png(&shade(&scene.geometry, &raster, &hits, Shading::Light), &mut png).ok()?;
    Some(Picture { png, caption: format!("{}, as its primary rays see it", entry.id) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn only_the_very_scene_measured_is_shown() {
        let mut record = testing::record();
        record.scenes[0].id = "unit-one".into();
        let unit = scene::load(&"unit-one".parse().unwrap()).unwrap();
        assert!(pictures(&record).is_empty(), "another checksum, and a scene that nobody knows");
        record.scenes[0].checksum = scene::checksum(&unit.geometry);
        let found = pictures(&record);
        assert_eq!(found.len(), 1);
        assert!(found["unit-one"][0].png.starts_with(b"\x89PNG"));
    }
}
