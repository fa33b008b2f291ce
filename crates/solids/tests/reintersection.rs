//! Rays from hits never hit the same place again.

#[path = "../examples/reintersection.rs"]
mod example;

use accel::testing::KINDS;
use example::{is_convex, run};

#[test]
fn rays_from_hits_do_not_hit_the_same_place() {
    for (kind, exact) in KINDS.into_iter().map(|kind| (kind, false)).chain([("sphere", true)]) {
        let found = run(kind, exact, 60, 60);
        assert!(found.rays > 3000 && found.below == 0, "{kind}: {found:?}");
        assert!(found.again == 0 || !is_convex(kind), "{kind}: {found:?}");
    }
}
