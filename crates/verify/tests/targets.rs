//! Every target of the fuzzers on its corpus, on damaged copies of it, and on noise.

use scenes::Random;
use std::path::Path;
use std::time::Duration;
use verify::{Numbers, patience, targets};

/// Inputs of each kind for a target.
const EACH: u64 = 1000;

fn corpus(target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(target);
    let mut files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty(), "{} holds something", folder.display());
    files.iter().map(|file| std::fs::read(file).unwrap()).collect()
}

/// Bytes changed, doubled, left out, or put in from elsewhere.
fn damaged(numbers: &mut Random, all: &[Vec<u8>]) -> Vec<u8> {
    let pick = |numbers: &mut Random| all[numbers.below(all.len())].clone();
    let mut bytes = pick(numbers);
    for _ in 0..=numbers.below(4) {
        if bytes.is_empty() {
            return bytes;
        }
        let at = numbers.below(bytes.len());
        let end = at + numbers.below(bytes.len() - at + 1);
        match numbers.below(5) {
            0 => bytes[at] = Numbers::bits(numbers) as u8,
            1 => drop(bytes.drain(at..end)),
            2 => {
                let again = bytes[at..end].to_vec();
                bytes.splice(at..at, again);
            }
            3 => {
                let other = pick(numbers);
                let len = numbers.below(other.len() + 1);
                bytes.splice(at..end, other[..len].iter().copied());
            }
            _ => bytes[at] ^= 1 << numbers.below(8),
        }
        bytes.truncate(1 << 14);
    }
    bytes
}

/// Long past what a target takes: what runs then has no end.
const PATIENCE: Duration = Duration::from_secs(300);

fn run(name: &'static str) {
    patience::within(PATIENCE, move || run_all(name)).expect("an input is worked on without end");
}

fn run_all(name: &str) {
    let (_, target) = targets::ALL.into_iter().find(|(known, _)| *known == name).expect("a target");
    let all = corpus(name);
    all.iter().for_each(|bytes| target(bytes));
    let mut numbers = Random::new(1);
    for _ in 0..EACH {
        target(&damaged(&mut numbers, &all));
        let len = numbers.below(600);
        let noise: Vec<u8> = (0..len).map(|_| Numbers::bits(&mut numbers) as u8).collect();
        target(&noise);
    }
}

#[test]
fn obj() {
    run("obj");
}

#[test]
fn ply() {
    run("ply");
}

#[test]
fn rays() {
    run("rays");
}

#[test]
fn scene() {
    run("scene");
}

#[test]
fn record() {
    run("record");
}

#[test]
fn settings() {
    run("settings");
}

#[test]
fn structures() {
    run("structures");
}
