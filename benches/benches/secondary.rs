//! Lists of rays, in rays per second.

use benches::{SCENES, structures, trace};
use criterion::{Criterion, criterion_group, criterion_main};
use scenes::rays::RaysId;

fn secondary(c: &mut Criterion) {
    trace(c, &SCENES, &[RaysId::Diffuse, RaysId::Random], &structures());
}

criterion_group!(benches, secondary);
criterion_main!(benches);
