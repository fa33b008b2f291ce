//! The HTML report in a real browser: nothing on the console, nothing on the network, no text
//! over other text or cut, and tables that sort and filter. Skipped where there is no Chromium.

use crate::common::Folder;
use crate::records::large;
use report::html::{Pictures, html};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Chromium by the variable `CHROMIUM` or by its usual names.
fn chromium() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("CHROMIUM") {
        return Some(named.into());
    }
    let path = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome-stable", "google-chrome"];
    std::env::split_paths(&path)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|file| file.is_file())
}

/// The page's document after its scripts have run, and what Chromium said on standard error.
fn open(browser: &Path, folder: &Folder, page: &Path) -> (String, String) {
    let mut command = Command::new(browser);
    command.args([
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-quic",
        "--no-first-run",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-sync",
        "--host-resolver-rules=MAP * ~NOTFOUND",
        "--disable-dev-shm-usage",
        "--enable-logging=stderr",
        "--virtual-time-budget=30000",
        "--timeout=300000",
        "--dump-dom",
    ]);
    command.arg(format!("--user-data-dir={}", folder.path("profile").display()));
    let output = command.arg(format!("file://{}", page.display())).output().expect("Chromium starts");
    (
        String::from_utf8_lossy(&output.stdout).into_owned(),
        String::from_utf8_lossy(&output.stderr).into_owned(),
    )
}

#[test]
fn the_report_is_sound_in_a_browser() {
    let Some(browser) = chromium() else {
        eprintln!("skipped: no Chromium (install it, or name it in the variable CHROMIUM)");
        return;
    };
    let folder = Folder::new();
    let report = html(&large(), &Pictures::new());
    let quoted = serde_json::to_string(&report).expect("a string").replace('<', "\\u003c");
    let page = format!(
        "<!DOCTYPE html><meta charset=\"utf-8\"><pre id=\"result\"></pre><script>const report={quoted};{}</script>",
        include_str!("browser.js")
    );
    let (dom, said) = open(&browser, &folder, &folder.write("driver.html", page));
    let start = dom.find("<pre id=\"result\">").expect("the driver's result") + "<pre id=\"result\">".len();
    let end = start + dom[start..].find("</pre>").expect("the result's end");
    let result = dom[start..end].replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    let result: Value =
        serde_json::from_str(&result).unwrap_or_else(|error| panic!("{error}: {result}\n{said}"));
    assert_eq!(result["done"], true, "{result:#}");
    let faults = result["faults"].as_array().expect("a list");
    assert!(faults.is_empty(), "{faults:#?}");
    let console: Vec<&str> = said.lines().filter(|line| line.contains(":CONSOLE")).collect();
    assert!(console.is_empty(), "{console:#?}");
}
