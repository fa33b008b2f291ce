//! Embree 4: what the system has, the distribution's package, or the library that the Python wheel
//! `embreex` carries.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::host::{Distribution, apt_install};
use crate::pip::{self, Wheel};
use crate::places::Places;
use crate::shell::output;

/// The file that the linker looks for.
const LINK_NAME: &str = "libembree4.so";

/// Name of the folder that holds the wheel's library, for each version its own.
pub const FOLDER: &str = "embreex-4.4.0.post1";

const WHEEL: Wheel = Wheel {
    requirement: "embreex==4.4.0.post1",
    tags: ["3.11", "cp311", "manylinux_2_28_x86_64"],
    sha256: "2cd0f7d5c6342e6247e31f700761689cae7829454d8c6de0c41e62124a023e1f",
};

/// A shared library of Embree 4.
pub struct Embree {
    /// Folder of `libembree4.so`.
    pub lib: PathBuf,
    /// Where it comes from, for the record.
    pub source: String,
}

/// The Embree recorded before, the system's, the distribution's or the wheel's: the first there is.
///
/// # Errors
/// One sentence saying why there is none.
pub fn find_or_install(places: &Places) -> Result<Embree, String> {
    if let Some(embree) = recorded(places).or_else(|| fetched_before(places)).or_else(on_this_system) {
        return Ok(embree);
    }
    if !cfg!(target_os = "linux") {
        return Err("no Embree 4 in the usual places, and set-up can install it on Linux only".into());
    }
    let distribution = Distribution::here();
    let mut reasons = Vec::new();
    if distribution.packages_embree4() {
        match apt_install(&["libembree-dev"]) {
            Ok(()) => match on_this_system() {
                Some(Embree { lib, .. }) => {
                    return Ok(Embree { lib, source: "the distribution's package libembree-dev".to_owned() });
                }
                None => reasons.push("libembree-dev brought no libembree4.so".to_owned()),
            },
            Err(why) => reasons.push(why),
        }
    }
    match from_wheel(places) {
        Ok(embree) => Ok(embree),
        Err(why) => {
            reasons.push(why);
            Err(reasons.join("; "))
        }
    }
}

fn recorded(places: &Places) -> Option<Embree> {
    let text = std::fs::read_to_string(places.embree_record()).ok()?;
    let value = |key: &str| text.lines().find_map(|line| line.strip_prefix(key));
    let lib = PathBuf::from(value("lib=")?);
    let source = value("source=").unwrap_or("recorded before").to_owned();
    lib.join(LINK_NAME).exists().then_some(Embree { lib, source })
}

fn fetched_before(places: &Places) -> Option<Embree> {
    let lib = places.setup.join(FOLDER);
    lib.join(LINK_NAME).exists().then(|| Embree { lib, source: format!("wheel {}", WHEEL.requirement) })
}

fn on_this_system() -> Option<Embree> {
    let arch = std::env::consts::ARCH;
    let folders = [
        format!("/usr/lib/{arch}-linux-gnu"),
        "/usr/local/lib".to_owned(),
        "/usr/local/lib64".to_owned(),
        "/usr/lib64".to_owned(),
        "/usr/lib".to_owned(),
    ];
    let lib = folders.into_iter().map(PathBuf::from).find(|dir| dir.join(LINK_NAME).exists())?;
    Some(Embree { lib, source: "found on the system".to_owned() })
}

fn from_wheel(places: &Places) -> Result<Embree, String> {
    if std::env::consts::ARCH != "x86_64" {
        return Err("the wheel embreex is for x86_64 only".to_owned());
    }
    let scratch = places.scratch("embree")?;
    let unpacked = pip::fetch(&WHEEL, &scratch)?.join("embreex.libs");
    let library = std::fs::read_dir(&unpacked)
        .map_err(|e| format!("the wheel has no folder embreex.libs: {e}"))?
        .flatten()
        .map(|entry| entry.path())
        .find(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            name.starts_with("libembree4-") && name.contains(".so")
        })
        .ok_or("the wheel has no libembree4")?;
    loads(&library)?;
    link(&library, &unpacked)?;
    let lib = places.setup.join(FOLDER);
    if lib.exists() {
        std::fs::remove_dir_all(&lib).map_err(|e| e.to_string())?;
    }
    std::fs::rename(&unpacked, &lib).map_err(|e| format!("cannot move Embree to {}: {e}", lib.display()))?;
    Ok(Embree { lib, source: format!("wheel {}", WHEEL.requirement) })
}

/// Loads the library once: an older C library, or a missing C++ one, shows here and not in a link.
fn loads(library: &Path) -> Result<(), String> {
    let probe = "import ctypes, sys; ctypes.CDLL(sys.argv[1])";
    output(Command::new("python3").args(["-c", probe]).arg(library))
        .map(drop)
        .map_err(|why| format!("the wheel's Embree does not load here: {why}"))
}

#[cfg(unix)]
fn link(library: &Path, dir: &Path) -> Result<(), String> {
    let name = library.file_name().unwrap_or_default();
    std::os::unix::fs::symlink(name, dir.join(LINK_NAME)).map_err(|e| format!("cannot link {LINK_NAME}: {e}"))
}

#[cfg(not(unix))]
fn link(_: &Path, _: &Path) -> Result<(), String> {
    Err("only Unix systems are supported".to_owned())
}
