//! Pictures of a record's scenes, for those that are on this machine.

use super::judged;
use accel::{Geometry, Hit, RaySet, Scene, Workload};
use harness::guard::guard;
use harness::record::{Record, SceneEntry};
use harness::registry::{self, guarded_build};
use harness::units;
use image::RgbaImage;
use report::html::{Picture, Pictures};
use report::picture::{Compared, Differences, Shading, compare, difference, shade, write_png};
use scenes::rays::perspective;
use std::collections::BTreeMap;

const COLS: u32 = 480;
const ROWS: u32 = 320;

/// Of so many structures at most is shown where they are wrong; those that are wrong most often.
const SHOWN: usize = 2;

/// Pictures of every scene that can be had here and is, by its checksum, the one measured: the scene, and where
/// structures that gave wrong answers see something else.
pub fn pictures(record: &Record) -> Pictures {
    let mut all = Pictures::new();
    for entry in &record.scenes {
        let Some(scene) = measured(entry) else { continue };
        if let Some(pictures) = render(record, entry, &scene) {
            all.scenes.insert(entry.id.clone(), pictures);
        }
        all.worst.extend(worst(record, &scene));
    }
    all
}

/// The scene, if it can be had here and is the one measured.
fn measured(entry: &SceneEntry) -> Option<Scene> {
    let scene = scenes::load(&entry.id.parse().ok()?).ok()?;
    (scenes::checksum(&scene.geometry) == entry.checksum).then_some(scene)
}

/// The structures whose images have the most visible errors, each where it is worst, enlarged.
fn worst(record: &Record, scene: &Scene) -> Vec<Picture> {
    if !matches!(scene.geometry, Geometry::Triangles(_)) {
        return Vec::new();
    }
    let raster = perspective(&scene.view, ROWS, COLS);
    let rays = RaySet::Raster(raster);
    let exact = judged::exact(scene, &rays);
    let mut all: Vec<(&str, Compared)> = Vec::new();
    let mut kernels = Vec::new();
    // Built-in structures of one kernel have the same answers: the first of them stands for all.
    let mut first = |structure: &&str| {
        let choice = registry::parse(structure).ok();
        let linear = choice.as_ref().is_none_or(|choice| choice.entry.traits.linear);
        let kernel = choice.and_then(|choice| choice.built_in_kernel());
        let known = kernel.is_some_and(|kernel| kernels.contains(&kernel));
        if !linear {
            kernels.extend(kernel);
        }
        !linear && !known
    };
    let structures: Vec<&str> =
        record.structure_ids().into_iter().filter(|structure| first(structure)).collect();
    for structure in structures {
        let Some(found) = hits(structure, scene, &rays) else { continue };
        let kinds = judged::kinds(scene, &rays, &found, &exact);
        let compared = compare(&scene.geometry, &raster, [&found, &exact], kinds, Shading::Light);
        let wrong = compared.wrong.counts.visible();
        // Structures of one kernel are wrong in the same places.
        if wrong > 0 && !all.iter().any(|(_, known)| known.wrong.counts == compared.wrong.counts) {
            all.push((structure, compared));
        }
    }
    all.sort_by_key(|(_, compared)| std::cmp::Reverse(compared.wrong.counts.visible()));
    all.truncate(SHOWN);
    all.iter().filter_map(|(structure, compared)| enlarged(&scene.id, structure, compared)).collect()
}

/// Pixels of a side of what is enlarged, and how many times.
const ENLARGED: (u32, u32) = (24, 8);

fn enlarged(scene: &str, structure: &str, compared: &Compared) -> Option<Picture> {
    let (side, times) = ENLARGED;
    let (x, y) = compared.worst(side)?;
    let wrong = &compared.wrong;
    let caption = format!(
        "{structure} on {scene}: of {} pixels {}; {}. Shown: {side} × {side} pixels from column {x}, row {y}, {times} times as large",
        units::count(wrong.counts.rays),
        wrong.kinds(),
        wrong.sizes(),
    );
    Some(Picture { png: png(&compared.enlarged((x, y), side, times))?, caption })
}

fn render(record: &Record, entry: &SceneEntry, scene: &Scene) -> Option<Vec<Picture>> {
    let raster = perspective(&scene.view, ROWS, COLS);
    let rays = RaySet::Raster(raster);
    let right = hits("ssm", scene, &rays)?;
    let picture = shade(&scene.geometry, &raster, &right, Shading::Light);
    let mut all =
        vec![Picture { png: png(&picture)?, caption: format!("{}, as its primary rays see it", entry.id) }];
    for structure in wrong_most_often(record, &entry.id) {
        let Some(found) = hits(structure, scene, &rays) else { continue };
        let (marked, differences) = mark(&picture, &found, &right);
        if differences.total() > 0 {
            let Differences { pixels, missed, invented, object, .. } = differences;
            let caption = format!(
                "{structure} against the suite's structures: of {} pixels {missed} missed (vermilion), {invented} \
                 invented (blue), {object} on another object (orange); marks are larger than the pixels",
                units::count(pixels),
            );
            all.push(Picture { png: png(&marked)?, caption });
        }
    }
    Some(all)
}

fn hits(structure: &str, scene: &Scene, rays: &RaySet) -> Option<Vec<Option<Hit>>> {
    let choice = registry::parse(structure).ok()?;
    let accel = guarded_build(&choice, scene, &Workload::of(rays)).ok()?;
    let mut hits = vec![None; rays.len()];
    guard("tracing", || accel.trace(rays, &mut hits)).ok()?;
    Some(hits)
}

fn png(picture: &RgbaImage) -> Option<Vec<u8>> {
    let mut png = Vec::new();
    write_png(picture, &mut png).ok()?;
    Some(png)
}

/// Structures by their wrong answers on a scene, over all ray sets; those without any are left out.
fn wrong_most_often<'r>(record: &'r Record, scene: &str) -> Vec<&'r str> {
    let mut wrong: BTreeMap<&str, u64> = BTreeMap::new();
    for cell in record.cells.iter().filter(|cell| cell.scene == scene) {
        if let Some(e) = cell.check.as_ref().and_then(|check| check.errors) {
            *wrong.entry(&cell.structure).or_default() += e.missed + e.false_hits + e.wrong_object;
        }
    }
    let mut order: Vec<_> = wrong.into_iter().filter(|(_, n)| *n > 0).collect();
    order.sort_by_key(|(_, n)| std::cmp::Reverse(*n));
    order.into_iter().take(SHOWN).map(|(structure, _)| structure).collect()
}

/// Where `found` has another object than `right`, with marks that can be seen. The last bits of a hit's place are
/// no matter here: every ray-triangle test has its own.
fn mark(picture: &RgbaImage, found: &[Option<Hit>], right: &[Option<Hit>]) -> (RgbaImage, Differences) {
    let same = |(a, b): (&Option<Hit>, &Option<Hit>)| a.map(|h| h.object) == b.map(|h| h.object);
    let right: Vec<Option<Hit>> =
        found.iter().zip(right).map(|(a, b)| if same((a, b)) { *a } else { *b }).collect();
    let (plain, differences) = difference(picture, found, &right);
    let mut marked = plain.clone();
    let (width, height) = plain.dimensions();
    for (i, _) in found.iter().zip(&right).enumerate().filter(|(_, pair)| !same(*pair)) {
        let (x, y) = (i as u32 % width, i as u32 / width);
        for row in y.saturating_sub(MARK)..=(y + MARK).min(height - 1) {
            for column in x.saturating_sub(MARK)..=(x + MARK).min(width - 1) {
                marked.put_pixel(column, row, *plain.get_pixel(x, y));
            }
        }
    }
    (marked, differences)
}

/// A mark reaches so many pixels to each side.
const MARK: u32 = 2;

#[cfg(test)]
mod tests {
    use super::*;
    use harness::testing;

    #[test]
    fn only_the_very_scene_measured_is_shown() {
        let mut record = testing::record();
        record.scenes[0].id = "unit-one".into();
        let unit = scenes::load(&"unit-one".parse().unwrap()).unwrap();
        assert!(pictures(&record).scenes.is_empty(), "another checksum, and a scene that nobody knows");
        record.scenes[0].checksum = scenes::checksum(&unit.geometry);
        let found = pictures(&record).scenes;
        assert_eq!(found.len(), 1);
        assert!(found["unit-one"][0].png.starts_with(b"\x89PNG"));
    }

    #[test]
    fn marks_are_where_another_object_is_seen() {
        let hit = |t, object| Some(Hit { t, object, u: 0.0, v: 0.0 });
        let mut right = vec![hit(1.0, 1); 20 * 20];
        let found = right.clone();
        right[0] = None;
        right[10 * 20 + 10] = hit(1.0, 2);
        right[399] = hit(1.5, 1);
        let picture = RgbaImage::from_pixel(20, 20, image::Rgba([90, 90, 90, 255]));
        let (marked, differences) = mark(&picture, &found, &right);
        assert_eq!((differences.invented, differences.object, differences.total()), (1, 1, 2));
        let pale = *marked.get_pixel(19, 19);
        let coloured = |x, y| *marked.get_pixel(x, y) != pale;
        assert!(coloured(0, 0) && coloured(2, 2) && !coloured(3, 3));
        assert!(coloured(10, 10) && coloured(12, 8) && !coloured(13, 10));
        assert_eq!(marked.pixels().filter(|p| **p != pale).count(), 9 + 25);
    }

    #[test]
    fn those_who_are_wrong_most_often_come_first() {
        let mut record = testing::record();
        for (cell, missed) in record.cells.iter_mut().zip([1, 5, 0]) {
            cell.check.as_mut().unwrap().errors =
                Some(harness::record::Errors { missed, ..Default::default() });
        }
        assert_eq!(wrong_most_often(&record, "one"), ["b", "a"]);
        assert!(wrong_most_often(&record, "two").is_empty());
    }
}
