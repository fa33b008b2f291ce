//! What tests of the command line share.

use assert_cmd::Command;
use std::path::{Path, PathBuf};

/// The program with these arguments.
pub fn rayscale<A: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = A>) -> Command {
    let mut command = Command::cargo_bin("rayscale").expect("the binary of this package");
    command.args(arguments);
    command
}

/// A folder of its own for a test.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    /// A path in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file into the folder.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, content).expect("a file in a temporary folder");
        path
    }

    /// The text of a file in the folder.
    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).expect("a text file")
    }

    pub fn folder(&self) -> &Path {
        self.0.path()
    }
}

/// Two triangles in the plane z = 0, the second in the plane z = 1, as one quad and one triangle.
pub const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3 4\nf 5 6 7\n";

/// Rays down the z axis: through the upper triangle, through the quad's two halves, past everything.
pub const RAYS: &str = "ox,oy,oz,dx,dy,dz,t_min,t_max
0.25,0.25,3,0,0,-1,0,inf
0.75,0.5,3,0,0,-2,0,inf
0.25,0.25,3,0,0,-1,2.5,inf
5,5,3,0,0,-1,0,1e30
";
