//! Holds functions, patches and sets of solids to far finer searches: `cargo run --release -p rayscale-solids --example certify -- 1000000`
//! takes so many rays a kind and ends with code 1 if a crossing is missed or invented; a kind's name after the number leaves the others out.

use accel::solid::{Combination, Cone, Csg, Expression, Implicit, Patch, Sphere};
use accel::testing::random;
use accel::{Aabb, Ray, Solid, Vec3};
use glam::DVec3;
use solids::{Crossing, Crossings};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

/// Shapes with thin walls, cusps and many roots on a line.
const SHAPES: [&str; 5] = [
    "sin(6*x)*cos(6*y) + sin(6*y)*cos(6*z) + sin(6*z)*cos(6*x)",
    "(x^2 + 9/4*y^2 + z^2 - 1)^3 - x^2*z^3 - 9/80*y^2*z^3",
    "(x^2 + y^2 + z^2 + 0.8)^2 - 3.4*(x^2 + y^2)",
    "(sin(5*x)*cos(5*y) + sin(5*y)*cos(5*z) + sin(5*z)*cos(5*x))^2 - 0.01",
    "x^4 - 2*x^2 + y^4 - 2*y^2 + z^4 - 2*z^2 + 1.8",
];

/// Steps of the finer search along a ray, before it looks between them.
const STEPS: u32 = 1000;

/// What was found of a kind.
#[derive(Default)]
struct Found {
    rays: u64,
    crossings: u64,
    /// Crossings that the search sees and the solid does not tell.
    missed: u64,
    /// Crossings that are told and lie farther from the surface than the bound.
    beside: u64,
    /// Rays aimed at a point of the surface that pass by it as they are rounded.
    passed: u64,
    /// Rays that don't leave as often as they enter.
    unpaired: u64,
    /// The farthest, in the solid's size.
    farthest: f64,
}

fn at(ray: &Ray, t: f64) -> DVec3 {
    ray.origin.as_dvec3() + ray.direction.as_dvec3() * t
}

fn told(solid: &impl Crossings, ray: &Ray) -> Vec<Crossing> {
    let mut out = Vec::new();
    solid.crossings(&Ray { t_min: -1e6, ..*ray }, &mut out);
    out
}

/// A ray from somewhere about towards somewhere inside.
fn aimed(random: &mut impl FnMut() -> f32) -> Ray {
    let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
    let (origin, to) = (point(3.0), point(1.0));
    Ray::new(origin, if origin == to { Vec3::X } else { to - origin })
}

/// Counts changes of sign of a function along the way through a box that no crossing tells, by a search that knows only the
/// function's values: at steps, and between them wherever its size has a least value, so that two roots between steps are seen
/// as well. Of a dip that is hardly deeper than rounding nothing is asked.
fn search(ray: &Ray, bounds: &Aabb, crossings: &[Crossing], value: impl Fn(DVec3) -> f64) -> u64 {
    let Some((near, far)) = bounds.overlap(ray.origin, ray.direction) else { return 0 };
    let place = |i: u32| near + (far - near) * (f64::from(i) + 0.5) / f64::from(STEPS);
    let along = |t: f64| value(at(ray, t));
    let mut roots = Vec::new();
    let [mut first, mut middle] = [0, 1].map(|i| along(place(i)));
    for i in 2..=STEPS {
        // A step beyond the last one stands for the end.
        let last = if i < STEPS { along(place(i)) } else { middle };
        let [from, to] = [place(i - 2), place(i.min(STEPS - 1))];
        if (first < 0.0) != (middle < 0.0) {
            roots.push(root_between(&along, from, place(i - 1)));
        } else if (middle < 0.0) == (last < 0.0) && middle.abs() < first.abs() && middle.abs() <= last.abs() {
            let dip = least(&along, from, to);
            if (along(dip) < 0.0) != (middle < 0.0) && along(dip).abs() > SHALLOW {
                roots.extend([root_between(&along, from, dip), root_between(&along, dip, to)]);
            }
        }
        (first, middle) = (middle, last);
    }
    let slack = (far - near) * 1e-7;
    let mut told = crossings.iter().map(|crossing| crossing.t).peekable();
    let mut missed = 0;
    for root in roots {
        while told.next_if(|t| *t < root - slack).is_some() {}
        missed += u64::from(told.next_if(|t| *t <= root + slack).is_none());
    }
    missed
}

/// Values that rounding may account for.
const SHALLOW: f64 = 1e-12;

/// Where the sign changes between two places of different signs.
fn root_between(along: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let sign = along(low) < 0.0;
    for _ in 0..48 {
        let middle = 0.5 * (low + high);
        if (along(middle) < 0.0) == sign { low = middle } else { high = middle }
    }
    low
}

/// Where the size of a function is least between two places, or where its sign differs from that at both, by the golden section.
fn least(along: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let sign = if along(low) < 0.0 { -1.0 } else { 1.0 };
    let size = |t: f64| sign * along(t);
    let part = 0.5 * (5f64.sqrt() - 1.0);
    let mut places = [high - part * (high - low), low + part * (high - low)];
    let mut sizes = places.map(size);
    for _ in 0..40 {
        if sizes[0] < 0.0 {
            return places[0];
        }
        if sizes[0] < sizes[1] {
            high = places[1];
            (places[1], sizes[1]) = (places[0], sizes[0]);
            places[0] = high - part * (high - low);
            sizes[0] = size(places[0]);
        } else {
            low = places[0];
            (places[0], sizes[0]) = (places[1], sizes[1]);
            places[1] = low + part * (high - low);
            sizes[1] = size(places[1]);
        }
    }
    0.5 * (low + high)
}

fn implicit(rays: u64) -> Found {
    let mut random = random(1);
    let bounds = Aabb { min: Vec3::splat(-1.5), max: Vec3::splat(1.5) };
    let shapes = SHAPES.map(|text| {
        let function = Arc::new(Expression::parse(text).expect("an expression"));
        Implicit::new(function, bounds)
    });
    let mut found = Found::default();
    for i in 0..rays {
        let shape = &shapes[i as usize % shapes.len()];
        let ray = aimed(&mut random);
        let crossings = told(shape, &ray);
        found.missed += search(&ray, &bounds, &crossings, |p| shape.function.value(p.to_array()));
        found.unpaired += crossings.len() as u64 % 2;
        for crossing in &crossings {
            let p = at(&ray, crossing.t);
            let face = (p.abs() - 1.5).abs().min_element();
            let value = shape.gradient(p);
            // How far F's root is along the ray, from F and its slope; steep enough that this tells.
            let slope = value.slope.dot(ray.direction.as_dvec3().normalize());
            if slope.abs() > 1e-2 && face > 1e-9 {
                found.note(value.value.abs() / slope.abs() / 3.0);
            }
        }
        found.count(&crossings);
    }
    found
}

fn patches(rays: u64) -> Found {
    let mut random = random(2);
    let mut found = Found::default();
    let mut patch = None;
    for i in 0..rays {
        if i.is_multiple_of(64) {
            patch = None;
        }
        let patch = patch.get_or_insert_with(|| {
            Patch::new(std::array::from_fn(|_| {
                std::array::from_fn(|_| Vec3::new(random(), random(), random()))
            }))
        });
        let origin = Vec3::new(random(), random(), random()) * 3.0;
        // A point of the patch that the ray goes through, give or take the rounding of its direction.
        let [u, v] = [0.5 + 0.49 * f64::from(random()), 0.5 + 0.49 * f64::from(random())];
        let target = patch.at(u, v);
        let ray = Ray::new(origin, (target - origin.as_dvec3()).as_vec3());
        let crossings = told(patch, &ray);
        // The ray is rounded and may pass by a point that the exact one meets: what counts is where it meets the patch itself.
        match root(patch, &ray, [u, v]) {
            Some(t) => {
                let close = 1e-6 / f64::from(ray.direction.length());
                let missed = !crossings.iter().any(|c| (c.t - t).abs() < close);
                found.missed += u64::from(missed);
                if missed {
                    println!("missed: {patch:?} {ray:?} at {u} {v}, t {t}: {crossings:?}");
                }
            }
            None => found.passed += 1,
        }
        for crossing in &crossings {
            // u and v are told in single precision, which moves the point by more than the bound: nearest from there.
            let p = at(&ray, crossing.t);
            found.note(nearest(patch, [f64::from(crossing.u), f64::from(crossing.v)], p) / 2.0);
        }
        found.count(&crossings);
    }
    found
}

/// Where a ray's line meets a patch next to a place on it, by Newton's steps in the two distances from the line, made shorter where
/// they lead astray; `None` where they lead to no place within the patch, as where the line passes by a fold.
fn root(patch: &Patch, ray: &Ray, [mut u, mut v]: [f64; 2]) -> Option<f64> {
    let direction = ray.direction.as_dvec3().normalize();
    let (x, y) = direction.any_orthonormal_pair();
    let seen = |p: DVec3| glam::DVec2::new(p.dot(x), p.dot(y));
    let rest = |u: f64, v: f64| seen(patch.at(u, v) - ray.origin.as_dvec3());
    let mut away = rest(u, v);
    for _ in 0..200 {
        let [a, b] = patch.tangents(u, v).map(seen);
        let det = a.perp_dot(b);
        let step = [away.perp_dot(b) / det, a.perp_dot(away) / det];
        let mut part = 1.0;
        loop {
            let (next_u, next_v) = (u - step[0] * part, v - step[1] * part);
            let next = rest(next_u, next_v);
            if next.length() < away.length() {
                (u, v, away) = (next_u, next_v, next);
                break;
            }
            part *= 0.5;
            if part < 1e-6 || !next.is_finite() {
                let inside = [u, v].iter().all(|p| (0.0..=1.0).contains(p));
                let t = (patch.at(u, v) - ray.origin.as_dvec3()).dot(direction)
                    / f64::from(ray.direction.length());
                return (away.length() < 1e-14 && inside).then_some(t);
            }
        }
    }
    None
}

/// How far a point is from a patch, by steps along the tangents.
fn nearest(patch: &Patch, [mut u, mut v]: [f64; 2], point: DVec3) -> f64 {
    let mut best = patch.at(u, v).distance(point);
    for _ in 0..6 {
        let ([a, b], rest) = (patch.tangents(u, v), point - patch.at(u, v));
        let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
        let det = aa * bb - ab * ab;
        u += (rest.dot(a) * bb - rest.dot(b) * ab) / det;
        v += (rest.dot(b) * aa - rest.dot(a) * ab) / det;
        best = best.min(patch.at(u, v).distance(point));
    }
    best
}

fn sets(rays: u64) -> Found {
    let mut random = random(3);
    let mut found = Found::default();
    for _ in 0..rays {
        let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
        let ball = Sphere { center: point(0.5), radius: 0.6 };
        let block = Aabb::of_points([point(1.0), point(1.0)]);
        let bore = Cone { base: point(1.0), base_radius: 0.3, top: point(1.0), top_radius: 0.2 };
        let body = Csg::new(Combination::Union, Solid::Sphere(ball), Solid::Box(block));
        let part = Csg::new(Combination::Difference, Solid::Csg(body), Solid::Cone(bore));
        let ray = aimed(&mut random);
        let crossings = told(&part, &ray);
        let value = |p: DVec3| {
            let in_ball = p.distance(ball.center.as_dvec3()) - f64::from(ball.radius);
            let beside = (block.min.as_dvec3() - p).max(p - block.max.as_dvec3()).max_element();
            in_ball.min(beside).max(-of_cone(&bore, p))
        };
        let bounds = Aabb { min: Vec3::splat(-1.5), max: Vec3::splat(1.5) };
        found.missed += search(&ray, &bounds, &crossings, value);
        found.unpaired += crossings.len() as u64 % 2;
        found.count(&crossings);
    }
    found
}

/// Below 0 inside.
fn of_cone(cone: &Cone, p: DVec3) -> f64 {
    let (base, top) = (cone.base.as_dvec3(), cone.top.as_dvec3());
    let (height, axis) = ((top - base).length(), (top - base).normalize());
    let along = (p - base).dot(axis);
    let slope = (f64::from(cone.top_radius) - f64::from(cone.base_radius)) / height;
    let radius = f64::from(cone.base_radius) + slope * along;
    ((p - base - axis * along).length() - radius).max(-along).max(along - height)
}

impl Found {
    fn count(&mut self, crossings: &[Crossing]) {
        self.rays += 1;
        self.crossings += crossings.len() as u64;
    }

    /// A crossing so far from the surface, in the solid's size.
    fn note(&mut self, away: f64) {
        self.beside += u64::from(away > BOUND);
        self.farthest = self.farthest.max(away);
    }

    fn is_sound(&self) -> bool {
        self.missed + self.beside + self.unpaired == 0
    }
}

/// How far from the surface a crossing may be, in the solid's size: 2^-32.
const BOUND: f64 = 1.0 / (1u64 << 32) as f64;

fn main() -> ExitCode {
    let rays = std::env::args().nth(1).and_then(|count| count.parse().ok()).unwrap_or(10_000);
    let mut sound = true;
    println!("kind      rays  crossings  missed  passed by  beside  unpaired  farthest  seconds");
    let only = std::env::args().nth(2);
    for (kind, study) in [("implicit", implicit as fn(u64) -> Found), ("patch", patches), ("csg", sets)] {
        if only.as_ref().is_some_and(|only| only != kind) {
            continue;
        }
        let start = Instant::now();
        let found = study(rays);
        sound &= found.is_sound();
        let Found { rays, crossings, missed, passed, beside, unpaired, farthest } = found;
        let seconds = start.elapsed().as_secs_f64();
        println!(
            "{kind}  {rays}  {crossings}  {missed}  {passed}  {beside}  {unpaired}  {farthest:.1e}  {seconds:.0}"
        );
    }
    if sound { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
