//! The kinds of solids and what each is told.

use super::fields::Table;
use crate::reader;
use accel::solid::{
    Combination, Cone, Csg, Disc, Expression, Facets, Group, Implicit, Patch, Quadric, Sphere, Torus,
};
use accel::{Aabb, Solid};
use std::sync::Arc;

const KINDS: [&str; 13] = [
    "triangle", "box", "sphere", "cone", "cylinder", "disc", "quadric", "torus", "implicit", "patch",
    "facets", "csg", "group",
];

/// The solid that a table says; fields that are left over and values out of range are for [`Table::finish`].
pub fn read(table: &mut Table<'_>) -> Result<Solid, String> {
    Ok(match table.kind()?.as_str() {
        "triangle" => Solid::Triangle(table.points("corners")?),
        "box" => Solid::Box(bounds(table)?),
        "sphere" => Solid::Sphere(Sphere { center: table.point("center")?, radius: table.number("radius")? }),
        "cone" => Solid::Cone(Cone {
            base: table.point("base")?,
            base_radius: table.number("base_radius")?,
            top: table.point("top")?,
            top_radius: table.number_or("top_radius", 0.0)?,
        }),
        "cylinder" => {
            let (base, top, radius) = (table.point("base")?, table.point("top")?, table.number("radius")?);
            Solid::Cone(Cone { base, base_radius: radius, top, top_radius: radius })
        }
        "disc" => Solid::Disc(Disc {
            center: table.point("center")?,
            normal: table.point("normal")?,
            radius: table.number("radius")?,
        }),
        "quadric" => {
            Solid::Quadric(Quadric { coefficients: table.numbers("coefficients")?, bounds: bounds(table)? })
        }
        "torus" => Solid::Torus(Torus {
            center: table.point("center")?,
            axis: table.point("axis")?,
            major: table.number("major")?,
            minor: table.number("minor")?,
        }),
        "implicit" => {
            let text = table.text("function")?;
            let function =
                Expression::parse(text).map_err(|slip| table.refuse("function", &slip.to_string()))?;
            Solid::Implicit(Implicit::new(Arc::new(function), bounds(table)?))
        }
        "patch" => {
            let points = table.points::<16>("points")?;
            Solid::Patch(Patch::new(std::array::from_fn(|j| std::array::from_fn(|i| points[4 * j + i]))))
        }
        "facets" => {
            let path = table.path("file")?;
            let polygons = reader::mesh(&path)
                .map_err(|error| table.refuse("file", &format!("can't be had: {error}")))?;
            Solid::Facets(Facets::new(Arc::new(polygons.mesh)))
        }
        "csg" => csg(table)?,
        "group" => Solid::Group(Group::new(parts(table)?)),
        _ => return Err(table.unknown_kind(&KINDS)),
    })
}

fn bounds(table: &mut Table<'_>) -> Result<Aabb, String> {
    Ok(Aabb { min: table.point("min")?, max: table.point("max")? })
}

fn csg(table: &mut Table<'_>) -> Result<Solid, String> {
    let name = table.text("combination")?;
    let combination = Combination::parse(name).ok_or_else(|| {
        table.refuse("combination", &format!("must be union, intersection or difference, not `{name}`"))
    })?;
    Csg::of(combination, parts(table)?).ok_or_else(|| table.refuse("parts", "are none"))
}

/// The solids that are parts of one.
fn parts(table: &mut Table<'_>) -> Result<Vec<Solid>, String> {
    let parts = table.parts("parts")?.into_iter().map(|mut part| {
        let solid = read(&mut part)?;
        part.finish(&solid)?;
        Ok(solid)
    });
    parts.collect()
}
