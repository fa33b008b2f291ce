//! Imports that lead back to where they began.

use std::collections::BTreeSet;
use std::fmt;

use petgraph::algo::tarjan_scc;
use petgraph::graphmap::DiGraphMap;

use super::arrows::Arrows;

/// Nodes each of which leads to every other, with the arrows among them.
#[derive(Debug, PartialEq, Eq)]
pub struct Cycle {
    arrows: Vec<String>,
}

/// The strongly connected components of more than one node.
pub fn of(arrows: &Arrows) -> Vec<Cycle> {
    let graph: DiGraphMap<&str, ()> = arrows.pairs().map(|(from, to)| (from, to, ())).collect();
    let mut cycles: Vec<Cycle> = tarjan_scc(&graph)
        .into_iter()
        .filter(|component| component.len() > 1)
        .map(|component| {
            let members: BTreeSet<&str> = component.into_iter().collect();
            let within = |from: &str, to: &str| members.contains(from) && members.contains(to);
            Cycle { arrows: arrows.lines(within) }
        })
        .collect();
    cycles.sort_by(|a, b| a.arrows.cmp(&b.arrows));
    cycles
}

impl fmt::Display for Cycle {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "circular imports: {}", self.arrows.join("; "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cycle_count(pairs: &[(&str, &str)]) -> usize {
        let mut arrows = Arrows::default();
        for (from, to) in pairs {
            arrows.add(from, to, "a use");
        }
        of(&arrows).len()
    }

    #[test]
    fn a_chain_has_no_ring_and_a_way_back_makes_one() {
        assert_eq!(cycle_count(&[("a", "b"), ("b", "c"), ("a", "c")]), 0);
        assert_eq!(cycle_count(&[("a", "b"), ("b", "c"), ("c", "a")]), 1);
        assert_eq!(cycle_count(&[("a", "b"), ("b", "a"), ("b", "c"), ("c", "d"), ("d", "c")]), 2);
    }

    #[test]
    fn a_ring_names_its_own_arrows_only() {
        let mut arrows = Arrows::default();
        arrows.add("a", "b", "b::x");
        arrows.add("b", "a", "a::y");
        arrows.add("b", "c", "c::z");
        let text = of(&arrows)[0].to_string();
        assert!(text.contains("a -> b (b::x)") && text.contains("b -> a (a::y)"), "{text}");
        assert!(!text.contains("c::z"), "{text}");
    }
}
