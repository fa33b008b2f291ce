//! Running other programs.

use std::path::Path;
use std::process::{Command, ExitCode, Stdio};

/// Runs a program quietly and returns its standard output.
///
/// # Errors
/// One sentence with the end of what the program complained of.
pub fn output(command: &mut Command) -> Result<String, String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let done = command.stdin(Stdio::null()).output().map_err(|e| format!("{name} cannot be run: {e}"))?;
    if done.status.success() {
        return Ok(String::from_utf8_lossy(&done.stdout).into_owned());
    }
    let complaint = String::from_utf8_lossy(&done.stderr);
    let mut tail: Vec<&str> = complaint.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    tail.drain(..tail.len().saturating_sub(2));
    let tail: String = tail.join(" / ").chars().take(300).collect();
    Err(format!("{name} failed ({}): {tail}", done.status))
}

/// Runs cargo and hands on its exit code.
pub fn run_to_end(command: &mut Command) -> ExitCode {
    match command.status() {
        Ok(status) => {
            let code = status.code().and_then(|code| u8::try_from(code).ok());
            ExitCode::from(code.unwrap_or(1))
        }
        Err(e) => {
            eprintln!("xtask: cargo cannot be run: {e}");
            ExitCode::FAILURE
        }
    }
}

/// Whether a program can be started at all.
pub fn there_is(program: &str) -> bool {
    Command::new(program)
        .arg("--version")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok()
}

/// SHA-256 of a file in lower-case hexadecimal, by the tool the system has for it.
pub fn sha256(path: &Path) -> Result<String, String> {
    let text = if there_is("sha256sum") {
        output(Command::new("sha256sum").arg("--binary").arg(path))?
    } else {
        output(Command::new("shasum").args(["-a", "256"]).arg(path))?
    };
    // A leading backslash marks a file name that the tool had to escape.
    let digest = text.trim_start_matches('\\').split_whitespace().next();
    digest.map(str::to_owned).ok_or_else(|| "sha256sum printed nothing".to_owned())
}

/// Fails unless a file has the SHA-256 it should have.
pub fn check_sha256(path: &Path, wanted: &str) -> Result<(), String> {
    let found = sha256(path)?;
    if found == wanted {
        Ok(())
    } else {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Err(format!("{name} has SHA-256 {found}, not {wanted}"))
    }
}

/// The cargo of nightly Rust, by way of rustup.
pub fn nightly() -> Command {
    let mut command = Command::new("cargo");
    command.arg("+nightly");
    command
}

/// The cargo that runs this program.
pub fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sha256_of_a_known_text_and_of_another() {
        let path = std::env::temp_dir().join(format!("xtask-sha-{}", std::process::id()));
        std::fs::write(&path, "abc").unwrap();
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        check_sha256(&path, abc).unwrap();
        std::fs::write(&path, "abd").unwrap();
        assert!(check_sha256(&path, abc).unwrap_err().contains("not ba7816bf"));
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn a_failing_program_says_why() {
        let error = output(Command::new("sh").args(["-c", "echo first >&2; echo no >&2; exit 3"]));
        let error = error.unwrap_err();
        assert!(error.contains("sh failed") && error.ends_with("first / no"), "{error}");
        let error = output(&mut Command::new("no-such-program-here")).unwrap_err();
        assert!(error.contains("no-such-program-here cannot be run"), "{error}");
    }
}
