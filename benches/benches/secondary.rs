//! Lists of rays, in rays per second.

use benches::trace;
use criterion::{Criterion, criterion_group, criterion_main};
use scenes::rays::RaysId;

fn secondary(c: &mut Criterion) {
    trace(c, &[RaysId::Diffuse, RaysId::Random]);
}

criterion_group!(benches, secondary);
criterion_main!(benches);
