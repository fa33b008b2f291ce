//! How large a crate may grow before it should be several.

/// Lines of source without tests.
const MOST_LINES: usize = 6_000;

/// What is wrong with a crate of this many lines.
pub fn fault(name: &str, lines: usize) -> Option<String> {
    (lines > MOST_LINES).then(|| format!("{name} has {lines} lines without tests, more than {MOST_LINES}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_line_too_many_is_a_fault() {
        assert_eq!(fault("x", MOST_LINES), None);
        assert!(fault("x", MOST_LINES + 1).unwrap().contains("x has 6001 lines"));
    }
}
