//! What holds for all verbs.

use crate::common::rayscale;
use predicates::prelude::*;

#[test]
fn without_arguments_it_says_what_to_do() {
    rayscale([""; 0]).assert().success().stdout(predicate::str::contains("rayscale help VERB"));
    let out = rayscale(["--json"]).assert().success().get_output().stdout.clone();
    let json: serde_json::Value = serde_json::from_slice(&out).expect("JSON");
    assert!(json["verbs"].as_array().is_some_and(|verbs| !verbs.is_empty()));
}

#[test]
fn bad_usage_ends_with_2() {
    rayscale(["completion"]).assert().code(2).stderr(predicate::str::contains("completions"));
    rayscale(["--threads", "0"]).assert().code(2);
}

#[test]
fn completions_know_the_verbs() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        rayscale(["completions", shell]).assert().success().stdout(predicate::str::contains("completions"));
    }
}
