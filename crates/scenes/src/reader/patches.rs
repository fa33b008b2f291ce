//! Patch files in the form of Newell's teapot: the number of patches, sixteen numbers of vertices for each, the number of vertices,
//! and three coordinates for each; commas or blanks part numbers, and vertices count from 1.

use crate::error::SceneError;
use accel::solid::Patch;
use accel::{Solid, Vec3};
use std::path::Path;

/// Vertices that a patch names.
const NET: usize = 16;

/// Whether a file is one of patches, by its name.
pub fn is_patches(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("bpt"))
}

/// Reads a file of bicubic Bézier patches.
///
/// # Errors
/// Unreadable files, lines that say too few or too many numbers or none, vertices that don't exist or aren't finite; each with the
/// line.
pub fn patches(path: &Path) -> Result<Vec<Solid>, SceneError> {
    let text =
        std::fs::read_to_string(path).map_err(|source| SceneError::Io { path: path.to_owned(), source })?;
    parse(path, &text)
}

/// The lines that say something, with their numbers.
struct Statements<'a> {
    path: &'a Path,
    lines: Box<dyn Iterator<Item = (u64, Vec<&'a str>)> + 'a>,
    last: u64,
}

impl<'a> Statements<'a> {
    fn of(path: &'a Path, text: &'a str) -> Self {
        let words = |line: &'a str| {
            let line = line.split('#').next().unwrap_or("");
            line.split(|c: char| c == ',' || c.is_whitespace())
                .filter(|word| !word.is_empty())
                .collect::<Vec<_>>()
        };
        let lines = (1..).zip(text.lines().map(words)).filter(|(_, words)| !words.is_empty());
        Self { path, lines: Box::new(lines), last: text.lines().count() as u64 }
    }

    fn slip<T>(&self, line: u64, reason: String) -> Result<T, SceneError> {
        Err(SceneError::Syntax { path: self.path.to_owned(), line, reason })
    }

    fn next(&mut self, what: &str) -> Result<(u64, Vec<&'a str>), SceneError> {
        match self.lines.next() {
            Some(statement) => Ok(statement),
            None => self.slip(self.last.max(1), format!("the file ends where {what} is expected")),
        }
    }

    /// A line of one number of things.
    fn count(&mut self, what: &str) -> Result<usize, SceneError> {
        let (line, words) = self.next(&format!("the number of {what}"))?;
        match words[..] {
            [word] => match word.parse() {
                Ok(count) => Ok(count),
                Err(_) => self.slip(line, format!("`{word}` is no number of {what}")),
            },
            _ => self.slip(line, format!("{} numbers where the number of {what} is expected", words.len())),
        }
    }
}

fn parse(path: &Path, text: &str) -> Result<Vec<Solid>, SceneError> {
    let mut statements = Statements::of(path, text);
    let count = statements.count("patches")?;
    let mut nets = Vec::new();
    for number in 1..=count {
        let (line, words) = statements.next(&format!("patch {number} of {count}"))?;
        if words.len() != NET {
            return statements
                .slip(line, format!("patch {number} has {} points instead of {NET}", words.len()));
        }
        let mut net = [0usize; NET];
        for (place, word) in net.iter_mut().zip(&words) {
            *place = match word.parse() {
                Ok(index) => index,
                Err(_) => {
                    return statements
                        .slip(line, format!("patch {number}: `{word}` is no number of a vertex"));
                }
            };
        }
        nets.push((line, net));
    }
    let vertices = statements.count("vertices")?;
    let mut points = Vec::new();
    for number in 1..=vertices {
        let (line, words) = statements.next(&format!("vertex {number} of {vertices}"))?;
        let numbers: Option<Vec<f32>> = words.iter().map(|word| word.parse().ok()).collect();
        let Some([x, y, z]) = numbers.as_deref() else {
            return statements
                .slip(line, format!("vertex {number} is not three numbers: `{}`", words.join(" ")));
        };
        let point = Vec3::new(*x, *y, *z);
        if !point.is_finite() {
            return statements.slip(line, format!("vertex {number} is at {point}, which is not finite"));
        }
        points.push(point);
    }
    if let Some((line, words)) = statements.lines.next() {
        return statements.slip(line, format!("`{}` after the last vertex", words.join(" ")));
    }
    if nets.is_empty() {
        return statements.slip(1, "there is no patch".into());
    }
    let patch = |(line, net): (u64, [usize; NET])| {
        let mut corners = [[Vec3::ZERO; 4]; 4];
        for (i, index) in net.into_iter().enumerate() {
            corners[i / 4][i % 4] = match index.checked_sub(1).and_then(|index| points.get(index)) {
                Some(point) => *point,
                None => {
                    let reason =
                        format!("the patch names vertex {index}, but there are {} vertices", points.len());
                    return Err(SceneError::Syntax { path: path.to_owned(), line, reason });
                }
            };
        }
        Ok(Solid::Patch(Patch::new(corners)))
    };
    nets.into_iter().map(patch).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(indices: &str, more: &str) -> String {
        let vertices: String = (0..16).map(|i| format!("{},{},{}\n", i % 4, i / 4, i % 3)).collect();
        format!("1\n{indices}\n16\n{vertices}{more}")
    }

    const ALL: &str = "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16";

    fn slip(text: &str) -> String {
        parse(Path::new("a.bpt"), text).unwrap_err().to_string()
    }

    #[test]
    fn a_patch_is_read_row_by_row() {
        let solids = parse(Path::new("a.bpt"), &file(ALL, "")).unwrap();
        let [Solid::Patch(patch)] = &solids[..] else { panic!("a patch") };
        assert_eq!(patch.net()[1][2], Vec3::new(2.0, 1.0, 0.0));
        assert_eq!(parse(Path::new("a.bpt"), &file(&ALL.replace(',', " "), "\n# end\n")).unwrap().len(), 1);
    }

    #[test]
    fn slips_are_told_with_file_line_and_reason() {
        let short = ALL.rsplit_once(',').unwrap().0;
        assert_eq!(slip(&file(short, "")), "a.bpt, line 2: patch 1 has 15 points instead of 16");
        assert_eq!(
            slip(&file(&ALL.replace("16", "17"), "")),
            "a.bpt, line 2: the patch names vertex 17, but there are 16 vertices"
        );
        assert_eq!(
            slip(&file(&ALL.replace("16", "x"), "")),
            "a.bpt, line 2: patch 1: `x` is no number of a vertex"
        );
        assert_eq!(slip(&file(ALL, "1,2,3")), "a.bpt, line 20: `1 2 3` after the last vertex");
        assert_eq!(slip("2\n1 2"), "a.bpt, line 2: patch 1 has 2 points instead of 16");
        assert_eq!(
            slip(&file(ALL, "").replace("3,3,0", "3,nan,0")),
            "a.bpt, line 19: vertex 16 is at [3, NaN, 0], which is not finite"
        );
        assert_eq!(
            slip(&file(ALL, "").replace("3,3,0", "3,0")),
            "a.bpt, line 19: vertex 16 is not three numbers: `3 0`"
        );
        assert_eq!(slip("0\n0\n"), "a.bpt, line 1: there is no patch");
        assert_eq!(slip(""), "a.bpt, line 1: the file ends where the number of patches is expected");
    }
}
