//! Holds the parity of points in and around closed meshes to an oracle: `parity [POINTS]`, by default 1,000,000.
//!
//! The truth comes from integers, along another line than the one that `accel::parity` takes: a line in general position that meets
//! the mesh within triangles only. A quarter of the points lie on corners, edges and faces or next to them, another quarter far away.

use accel::parity::{Location, locate};
use accel::{Mesh, Ray, Vec3};
use oracle::{Rational, intersect};
use scenes::Random;
use std::process::ExitCode;
use verify::Numbers;
use verify::cases::closed;

/// A closed mesh of any size, somewhere.
fn mesh(numbers: &mut impl Numbers) -> Mesh {
    let count = numbers.below(240);
    let (scale, offset) = (10f32.powf(numbers.unit() * 3.0), vec3(numbers));
    let mut mesh = closed(numbers, count);
    mesh.positions.iter_mut().for_each(|p| *p = (*p + offset) * scale);
    mesh
}

fn vec3(numbers: &mut impl Numbers) -> Vec3 {
    Vec3::new(numbers.unit(), numbers.unit(), numbers.unit())
}

/// Somewhere about the mesh.
fn point(mesh: &Mesh, numbers: &mut impl Numbers) -> Vec3 {
    let bounds = mesh.bounds();
    let size = bounds.extent().max_element();
    let free = vec3(numbers);
    let kind = numbers.unit();
    if kind < 0.0 {
        return bounds.center() + free * size * 0.7;
    }
    if kind < 0.5 {
        return bounds.center() + free * size * 10f32.powf(5.0 + 5.0 * numbers.unit());
    }
    let triangle = ((numbers.unit() + 1.0) * 0.5 * mesh.triangles.len() as f32) as usize;
    let [a, b, c] = mesh.corners(triangle.min(mesh.triangles.len() - 1));
    let on = match (kind * 100.0) as u32 % 3 {
        0 => a,
        1 => (a + b) * 0.5,
        _ => (a + b + c) / 3.0,
    };
    if numbers.unit() < 0.0 { on } else { on + free * size * 1e-6 }
}

/// By a line in general position.
fn truth(mesh: &Mesh, point: Vec3, numbers: &mut impl Numbers) -> Location {
    let (zero, one) = (Rational::from(0.0), Rational::from(1.0));
    'line: loop {
        let ray = Ray::new(point, vec3(numbers));
        let mut crossed = 0;
        for triangle in 0..mesh.triangles.len() {
            let Some(hit) = intersect(&ray, &mesh.corners(triangle)) else { continue };
            if hit.t == zero {
                return Location::Surface;
            }
            let rest = one.clone() - &hit.u;
            if hit.u == zero || hit.v == zero || rest == hit.v {
                continue 'line;
            }
            crossed += 1;
        }
        return if crossed % 2 == 1 { Location::Inside } else { Location::Outside };
    }
}

fn main() -> ExitCode {
    let count = std::env::args().nth(1).map_or(Ok(1_000_000), |count| count.parse());
    let Ok(count) = count else {
        eprintln!("usage: parity [POINTS]");
        return ExitCode::from(2);
    };
    let mut numbers = Random::new(97);
    let mut body = mesh(&mut numbers);
    let (mut meshes, mut inside, mut surface, mut wrong) = (1, 0, 0, 0);
    for i in 1..=count {
        if i % 100 == 0 {
            body = mesh(&mut numbers);
            meshes += 1;
        }
        let point = point(&body, &mut numbers);
        let expected = truth(&body, point, &mut numbers);
        let found = locate((&body).into(), 0..body.triangles.len() as u32, point);
        inside += u32::from(expected == Location::Inside);
        surface += u32::from(expected == Location::Surface);
        if found != expected {
            wrong += 1;
            println!("{point} is {expected:?}, not {found:?}, of {body:?}");
        }
    }
    println!(
        "{count} points about {meshes} meshes, {inside} inside and {surface} on the surface: {wrong} wrong"
    );
    ExitCode::from(u8::from(wrong != 0))
}
