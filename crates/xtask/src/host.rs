//! The operating system and its packages.

use std::io::IsTerminal;
use std::process::Command;

use crate::shell::{output, there_is};

/// Name and version of a Linux distribution, as `os-release` gives them.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Distribution {
    /// `debian`, `ubuntu`, ...; empty where there is no `os-release`.
    pub id: String,
    /// Major and minor version; (0, 0) where none is given.
    pub version: (u32, u32),
}

impl Distribution {
    /// The distribution that this program runs on.
    pub fn here() -> Self {
        let text = std::fs::read_to_string("/etc/os-release").unwrap_or_default();
        Self::parse(&text)
    }

    fn parse(os_release: &str) -> Self {
        let value = |key: &str| {
            os_release
                .lines()
                .filter_map(|line| line.split_once('='))
                .find(|(k, _)| k.trim() == key)
                .map(|(_, v)| v.trim().trim_matches(['"', '\'']).to_owned())
                .unwrap_or_default()
        };
        let version = value("VERSION_ID");
        let mut numbers = version.split('.').map(|n| n.parse().unwrap_or(0));
        Self { id: value("ID"), version: (numbers.next().unwrap_or(0), numbers.next().unwrap_or(0)) }
    }

    /// Whether its package `libembree-dev` is Embree 4 (earlier ones carry Embree 3).
    pub fn packages_embree4(&self) -> bool {
        match self.id.as_str() {
            "debian" => self.version >= (13, 0),
            "ubuntu" => self.version >= (24, 10),
            _ => false,
        }
    }
}

/// Installs packages with apt-get, as root or through sudo, reading the package lists anew when the
/// first try fails (a fresh machine has none, an old one has outdated ones).
pub fn apt_install(packages: &[&str]) -> Result<(), String> {
    if !there_is("apt-get") {
        return Err("this system has no apt-get".to_owned());
    }
    println!("  installing {}", packages.join(" "));
    let install = || {
        let mut command = apt()?;
        command.args(["install", "-y", "-q", "--no-install-recommends"]);
        output(command.args(packages)).map(drop)
    };
    install().or_else(|_| {
        apt_update()?;
        install()
    })
}

/// Reads apt's package lists anew.
pub fn apt_update() -> Result<(), String> {
    output(apt()?.args(["update", "-q"])).map(drop)
}

fn apt() -> Result<Command, String> {
    let user = output(Command::new("id").arg("-u"))?;
    if user.trim() == "0" {
        let mut command = Command::new("apt-get");
        command.env("DEBIAN_FRONTEND", "noninteractive");
        return Ok(command);
    }
    if !there_is("sudo") {
        return Err("installing packages needs root or sudo".to_owned());
    }
    let mut command = Command::new("sudo");
    if !std::io::stdin().is_terminal() {
        command.arg("-n");
    }
    command.args(["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"]);
    Ok(command)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn has_embree4(text: &str) -> bool {
        Distribution::parse(text).packages_embree4()
    }

    #[test]
    fn knows_where_embree_4_is_packaged() {
        assert!(!has_embree4("ID=debian\nVERSION_ID=\"12\"\n"));
        assert!(has_embree4("NAME=x\nID=debian\nVERSION_ID=\"13\"\n"));
        assert!(!has_embree4("ID=ubuntu\nVERSION_ID=\"24.04\"\n"));
        assert!(has_embree4("ID=ubuntu\nVERSION_ID='24.10'\n"));
        assert!(has_embree4("ID=ubuntu\nVERSION_ID=\"26.04\"\n"));
        assert!(!has_embree4("ID=fedora\nVERSION_ID=42\n"));
        assert!(!has_embree4("ID=debian\n"));
        assert!(!has_embree4(""));
    }
}
