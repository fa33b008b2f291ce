//! Holds the parity of points in and around closed meshes to an oracle: `parity [POINTS]`, by default 1,000,000.
//!
//! The truth comes from integers, along another line than the one that `accel::parity` takes: a line in general position that meets
//! the mesh within triangles only. A quarter of the points lie on corners, edges and faces or next to them, another quarter far away.

use accel::parity::{Location, locate};
use accel::testing::random;
use accel::{Mesh, Ray, Vec3};
use oracle::{Rational, intersect};
use std::process::ExitCode;

/// Rings of corners between two poles, closed.
fn ball(random: &mut impl FnMut() -> f32) -> Mesh {
    let mut count = |least: u32, more: f32| least + (more * (random() + 1.0) * 0.5) as u32;
    let (around, rings) = (count(3, 8.0), count(1, 6.0));
    let (scale, offset) = (10f32.powf(random() * 3.0), Vec3::new(random(), random(), random()));
    let mut mesh = Mesh { positions: vec![Vec3::Y, Vec3::NEG_Y], triangles: Vec::new() };
    for ring in 0..rings {
        let up = std::f32::consts::PI * (ring + 1) as f32 / (rings + 1) as f32;
        for place in 0..around {
            let turn = std::f32::consts::TAU * place as f32 / around as f32;
            let rough = 0.8 + 0.2 * random();
            mesh.positions.push(Vec3::new(turn.cos() * up.sin(), up.cos(), turn.sin() * up.sin()) * rough);
        }
    }
    mesh.positions.iter_mut().for_each(|p| *p = (*p + offset) * scale);
    let at = |ring: u32, place: u32| 2 + ring * around + place % around;
    for place in 0..around {
        mesh.triangles.push([0, at(0, place + 1), at(0, place)]);
        for ring in 1..rings {
            let [a, b] = [at(ring - 1, place), at(ring - 1, place + 1)];
            let [c, d] = [at(ring, place), at(ring, place + 1)];
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
        mesh.triangles.push([1, at(rings - 1, place), at(rings - 1, place + 1)]);
    }
    mesh
}

/// Somewhere about the mesh.
fn point(mesh: &Mesh, random: &mut impl FnMut() -> f32) -> Vec3 {
    let bounds = mesh.bounds();
    let size = bounds.extent().max_element();
    let free = Vec3::new(random(), random(), random());
    let kind = random();
    if kind < 0.0 {
        return bounds.center() + free * size * 0.7;
    }
    if kind < 0.5 {
        return bounds.center() + free * size * 10f32.powf(5.0 + 5.0 * random());
    }
    let triangle = ((random() + 1.0) * 0.5 * mesh.triangles.len() as f32) as usize;
    let [a, b, c] = mesh.corners(triangle.min(mesh.triangles.len() - 1));
    let on = match (kind * 100.0) as u32 % 3 {
        0 => a,
        1 => (a + b) * 0.5,
        _ => (a + b + c) / 3.0,
    };
    if random() < 0.0 { on } else { on + free * size * 1e-6 }
}

/// By a line in general position.
fn truth(mesh: &Mesh, point: Vec3, random: &mut impl FnMut() -> f32) -> Location {
    let (zero, one) = (Rational::from(0.0), Rational::from(1.0));
    'line: loop {
        let ray = Ray::new(point, Vec3::new(random(), random(), random()));
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
    let mut random = random(97);
    let mut mesh = ball(&mut random);
    let (mut meshes, mut inside, mut surface, mut wrong) = (1, 0, 0, 0);
    for i in 1..=count {
        if i % 100 == 0 {
            mesh = ball(&mut random);
            meshes += 1;
        }
        let point = point(&mesh, &mut random);
        let expected = truth(&mesh, point, &mut random);
        let found = locate((&mesh).into(), 0..mesh.triangles.len() as u32, point);
        inside += u32::from(expected == Location::Inside);
        surface += u32::from(expected == Location::Surface);
        if found != expected {
            wrong += 1;
            println!("{point} is {expected:?}, not {found:?}, of {mesh:?}");
        }
    }
    println!(
        "{count} points about {meshes} meshes, {inside} inside and {surface} on the surface: {wrong} wrong"
    );
    ExitCode::from(u8::from(wrong != 0))
}
