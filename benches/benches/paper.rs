//! Small scenes, such as the paper had: its structures and their rivals beside today's.

use benches::{PAPER_SCENES, all_structures, trace};
use criterion::{Criterion, criterion_group, criterion_main};
use scenes::rays::RaysId;

fn paper(c: &mut Criterion) {
    trace(c, &PAPER_SCENES, &[RaysId::Parallel, RaysId::Random], &all_structures());
}

criterion_group!(benches, paper);
criterion_main!(benches);
