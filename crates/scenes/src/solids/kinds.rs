//! The kinds of solids and what each is told.

use super::fields::Table;
use accel::solid::{Cone, Disc, Quadric, Sphere, Torus};
use accel::{Aabb, Solid};

const KINDS: [&str; 8] = ["triangle", "box", "sphere", "cone", "cylinder", "disc", "quadric", "torus"];

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
        _ => return Err(table.unknown_kind(&KINDS)),
    })
}

fn bounds(table: &mut Table<'_>) -> Result<Aabb, String> {
    Ok(Aabb { min: table.point("min")?, max: table.point("max")? })
}
