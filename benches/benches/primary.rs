//! Rasters, in rays per second.

use benches::{SCENES, structures, trace};
use criterion::{Criterion, criterion_group, criterion_main};
use scenes::rays::RaysId;

fn primary(c: &mut Criterion) {
    trace(c, &SCENES, &[RaysId::Parallel, RaysId::Perspective], &structures());
}

criterion_group!(benches, primary);
criterion_main!(benches);
