//! Lines of a text file with their numbers, in bounded memory whatever the file holds.

use crate::error::SceneError;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// Longer lines are taken for a sign that this is no text.
const LONGEST: u64 = 1 << 20;

/// What some editors put before UTF-8 text.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// A reader of lines.
pub struct Lines<R> {
    path: PathBuf,
    input: BufReader<R>,
    line: Vec<u8>,
    number: u64,
}

impl<R: Read> Lines<R> {
    pub fn new(path: &Path, input: R) -> Self {
        Self {
            path: path.to_owned(),
            input: BufReader::with_capacity(1 << 16, input),
            line: Vec::new(),
            number: 0,
        }
    }

    /// Moves on to the next line; false at the end.
    ///
    /// # Errors
    /// Unreadable files; lines that no text file has.
    pub fn advance(&mut self) -> Result<bool, SceneError> {
        self.line.clear();
        let read = self.input.by_ref().take(LONGEST).read_until(b'\n', &mut self.line);
        let read = read.map_err(|source| SceneError::Io { path: self.path.clone(), source })?;
        if read == 0 {
            return Ok(false);
        }
        self.number += 1;
        if self.number == 1 && self.line.starts_with(BYTE_ORDER_MARK) {
            self.line.drain(..BYTE_ORDER_MARK.len());
        }
        if self.line.contains(&0) {
            return Err(self.syntax("a zero byte: this is not a text file".into()));
        }
        if read as u64 == LONGEST {
            return Err(self.syntax(format!("more than {LONGEST} bytes in one line: this is not a mesh")));
        }
        Ok(true)
    }

    /// The current line's words, comments after `comment` left out.
    pub fn words(&self, comment: Option<u8>) -> impl Iterator<Item = &[u8]> {
        let end = comment.and_then(|c| self.line.iter().position(|b| *b == c)).unwrap_or(self.line.len());
        self.line[..end].split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
    }

    /// The current line's number, from 1; at the end the number of lines.
    pub fn number(&self) -> u64 {
        self.number
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn syntax(&self, reason: String) -> SceneError {
        SceneError::Syntax { path: self.path.clone(), line: self.number, reason }
    }

    pub fn too_large(&self, what: &'static str, most: usize) -> SceneError {
        SceneError::TooLarge { path: self.path.clone(), what, most: most as u64 }
    }
}

/// A word for a message: printable and short.
pub fn show(word: &[u8]) -> String {
    let text: String =
        word.iter().take(32).flat_map(|b| std::ascii::escape_default(*b)).map(char::from).collect();
    if word.len() > 32 { text + "…" } else { text }
}
