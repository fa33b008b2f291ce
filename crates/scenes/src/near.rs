//! Suggestions for names that are nearly right.

/// How alike two names must be, on a scale from 0 to 1, for one to be suggested for the other.
const LIKENESS: f64 = 0.72;
const MAX: usize = 3;

/// Up to three of `names` that resemble `name`, the likest first.
pub fn near<'n>(name: &str, names: impl IntoIterator<Item = &'n str>) -> Vec<String> {
    let name = name.to_lowercase();
    let mut near: Vec<(f64, &str)> = names
        .into_iter()
        .map(|known| (strsim::jaro_winkler(&name, &known.to_lowercase()), known))
        .filter(|(likeness, _)| *likeness >= LIKENESS)
        .collect();
    near.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    near.into_iter().take(MAX).map(|(_, known)| known.to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_find_their_names() {
        let names = ["bmssm", "bmssm-dense", "ssm", "obvhs-cwbvh", "embree"];
        assert_eq!(near("embre", names)[0], "embree");
        assert_eq!(near("BMSM", names)[0], "bmssm");
        assert_eq!(near("obvhs-cwvbh", names)[0], "obvhs-cwbvh");
        assert!(near("xyzzy", names).is_empty());
    }
}
