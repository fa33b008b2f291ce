//! The camera of the scenes that a verb works on.

use clap::Args;
use scenes::camera::{fov, point, up};

/// From where scenes are looked at. What is not told is as the scene says it; an OBJ file, which says
/// nothing, is framed upright with y up.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Camera")]
pub struct CameraOptions {
    /// What points up in images: an axis such as y or -z, or a vector
    #[arg(long, value_name = "AXIS|X,Y,Z", allow_hyphen_values = true, value_parser = checked(up))]
    up: Option<String>,
    /// Where the camera is
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = checked(point))]
    eye: Option<String>,
    /// What it looks at
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = checked(point))]
    target: Option<String>,
    /// Vertical opening angle in degrees
    #[arg(long, value_name = "DEGREES", value_parser = checked(fov))]
    fov: Option<String>,
}

/// A parser that keeps the text which `read` accepts: it becomes part of the scene's name.
fn checked<T: 'static>(
    read: fn(&str) -> Result<T, String>,
) -> impl Fn(&str) -> Result<String, String> + Clone + Send + Sync {
    move |text| read(text).map(|_| text.split_whitespace().collect())
}

impl CameraOptions {
    /// `scene` with its camera, as scenes are named: `model.obj` → `model.obj@up=z`. So records say what was seen.
    pub fn named(&self, scene: &str) -> String {
        let told = [("up", &self.up), ("eye", &self.eye), ("target", &self.target), ("fov", &self.fov)];
        let suffix =
            told.iter().filter_map(|(name, text)| text.as_ref().map(|text| format!("@{name}={text}")));
        scene.to_owned() + &suffix.collect::<String>()
    }
}
