//! Rasters, in rays per second.

use benches::trace;
use criterion::{Criterion, criterion_group, criterion_main};
use scenes::rays::RaysId;

fn primary(c: &mut Criterion) {
    trace(c, &[RaysId::Parallel, RaysId::Perspective]);
}

criterion_group!(benches, primary);
criterion_main!(benches);
