//! Which crate may depend on which: `layers.toml`.

use std::collections::BTreeMap;
use std::str::FromStr;

use serde::Deserialize;

use super::crates::Crate;

/// Layers from the lowest up, and narrower rules for single crates.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layers {
    /// A crate may depend on those of lower layers only.
    layers: Vec<Vec<String>>,
    /// All that a crate may depend on, where that is less than its layer allows.
    #[serde(default)]
    depends_on: BTreeMap<String, Vec<String>>,
    /// All that may depend on a crate, where that is fewer than higher layers.
    #[serde(default)]
    used_by: BTreeMap<String, Vec<String>>,
}

impl FromStr for Layers {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|e| format!("layers.toml: {e}"))
    }
}

impl Layers {
    /// One sentence for each crate that has no place, and for each dependency that isn't allowed.
    pub fn faults(&self, crates: &[Crate]) -> Vec<String> {
        let mut faults = Vec::new();
        for one in crates {
            let Some(own) = self.layer(&one.name) else {
                faults.push(format!("{} has no place in layers.toml", one.name));
                continue;
            };
            for used in &one.dependencies {
                if let Some(why) = self.forbids(&one.name, own, used) {
                    faults.push(format!("{} may not depend on {used}: {why}", one.name));
                }
            }
        }
        faults
    }

    fn forbids(&self, user: &str, own: usize, used: &str) -> Option<&str> {
        if self.layer(used).is_some_and(|layer| layer >= own) {
            return Some("it is no lower in the layers");
        }
        if self.depends_on.get(user).is_some_and(|allowed| !allowed.iter().any(|name| name == used)) {
            return Some("it isn't among the few that `depends_on` allows");
        }
        if self.used_by.get(used).is_some_and(|allowed| !allowed.iter().any(|name| name == user)) {
            return Some("`used_by` keeps that for others");
        }
        None
    }

    fn layer(&self, name: &str) -> Option<usize> {
        self.layers.iter().position(|layer| layer.iter().any(|one| one == name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"
        layers = [["contract"], ["oracle", "grid", "tree"], ["harness"], ["program"]]
        [depends_on]
        harness = ["contract", "grid", "tree", "oracle"]
        [used_by]
        oracle = ["harness"]
    "#;

    fn faults(from: &str, to: &str) -> Vec<String> {
        let one = |name: &str, dependencies: &[&str]| Crate {
            name: name.to_owned(),
            dependencies: dependencies.iter().map(|&d| d.to_owned()).collect(),
            entries: Vec::new(),
        };
        TEXT.parse::<Layers>().unwrap().faults(&[one(from, &[to])])
    }

    #[test]
    fn arrows_down_are_allowed() {
        for (from, to) in
            [("grid", "contract"), ("harness", "oracle"), ("program", "harness"), ("program", "grid")]
        {
            assert!(faults(from, to).is_empty(), "{from} -> {to}");
        }
    }

    #[test]
    fn planted_arrows_up_and_across_are_refused() {
        for (from, to) in
            [("contract", "grid"), ("grid", "tree"), ("harness", "program"), ("program", "oracle")]
        {
            assert_eq!(faults(from, to).len(), 1, "{from} -> {to}");
        }
    }

    #[test]
    fn a_crate_without_a_place_and_a_misspelt_key_are_refused() {
        assert!(faults("new", "contract")[0].contains("no place"));
        assert!("layers = []\nuse_by = 1".parse::<Layers>().is_err());
    }
}
