//! How large a crate may grow before it should be several.

/// Lines of source without tests.
const MAX_LINES: usize = 6_000;

/// What is wrong with a crate of this many lines.
pub fn fault(name: &str, lines: usize) -> Option<String> {
    (lines > MAX_LINES).then(|| format!("{name} has {lines} lines without tests, more than {MAX_LINES}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_line_too_many_is_a_fault() {
        assert_eq!(fault("x", MAX_LINES), None);
        assert!(fault("x", MAX_LINES + 1).unwrap().contains("x has 6001 lines"));
    }
}
