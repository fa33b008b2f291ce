//! What a user says of a scene's camera, in a definition's `[view]`, behind an `@`, or by options.

use accel::{Vec3, View};
use serde::Deserialize;

/// The parts of a camera that are told; the scene's own or the framing one has the others.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Camera {
    /// Where it is.
    pub eye: Option<[f32; 3]>,
    /// What it looks at.
    pub target: Option<[f32; 3]>,
    /// What points up in the image: an axis as `y` or `-z`, or a vector.
    pub up: Option<Up>,
    /// Vertical opening angle in degrees.
    pub fov: Option<f32>,
}

/// A direction that points up: never zero, always finite.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(try_from = "UpText")]
pub struct Up(Vec3);

impl Up {
    /// The direction.
    pub const fn vector(self) -> Vec3 {
        self.0
    }
}

#[derive(Deserialize)]
#[serde(untagged)]
enum UpText {
    Axis(String),
    Vector([f32; 3]),
}

impl TryFrom<UpText> for Up {
    type Error = String;

    fn try_from(text: UpText) -> Result<Self, String> {
        match text {
            UpText::Axis(text) => up(&text),
            UpText::Vector(v) => direction(Vec3::from_array(v)),
        }
    }
}

/// Reads a direction: an axis with or without its sign, or three numbers.
///
/// # Errors
/// In words, what is expected.
pub fn up(text: &str) -> Result<Up, String> {
    let (sign, axis) = match text.strip_prefix('-') {
        Some(axis) => (-1.0, axis),
        None => (1.0, text.strip_prefix('+').unwrap_or(text)),
    };
    match axis {
        "x" | "X" => Ok(Up(Vec3::X * sign)),
        "y" | "Y" => Ok(Up(Vec3::Y * sign)),
        "z" | "Z" => Ok(Up(Vec3::Z * sign)),
        _ => match point(text) {
            Ok(v) => direction(Vec3::from_array(v)),
            Err(_) => Err("expected an axis such as `y` or `-z`, or three numbers such as `0,1,0`".into()),
        },
    }
}

fn direction(v: Vec3) -> Result<Up, String> {
    let usable = v.is_finite() && v != Vec3::ZERO;
    if usable { Ok(Up(v)) } else { Err("`up` must be a finite vector other than zero".into()) }
}

/// Reads three finite numbers with commas between them.
///
/// # Errors
/// In words, what is expected.
pub fn point(text: &str) -> Result<[f32; 3], String> {
    let expected = || "expected three finite numbers, as in `1,2.5,-3`".to_owned();
    let numbers: Option<Vec<f32>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    let point: [f32; 3] = numbers.and_then(|n| n.try_into().ok()).ok_or_else(expected)?;
    if point.iter().all(|x| x.is_finite()) { Ok(point) } else { Err(expected()) }
}

/// Reads an opening angle in degrees.
///
/// # Errors
/// In words, what is expected.
pub fn fov(text: &str) -> Result<f32, String> {
    let angle = text.parse().ok().filter(|angle| is_angle(*angle));
    angle.ok_or_else(|| "expected degrees above 0 and below 180".to_owned())
}

fn is_angle(degrees: f32) -> bool {
    degrees > 0.0 && degrees < 180.0
}

impl Camera {
    /// Whether nothing is told.
    pub fn is_silent(&self) -> bool {
        *self == Self::default()
    }

    /// What is told here, and for the rest what `other` tells.
    pub fn or(self, other: Self) -> Self {
        Self {
            eye: self.eye.or(other.eye),
            target: self.target.or(other.target),
            up: self.up.or(other.up),
            fov: self.fov.or(other.fov),
        }
    }

    /// `view` with what is told in place of its own.
    pub fn apply(&self, view: &mut View) {
        view.eye = self.eye.map_or(view.eye, Vec3::from_array);
        view.target = self.target.map_or(view.target, Vec3::from_array);
        view.up = self.up.map_or(view.up, Up::vector);
        view.fov_y_degrees = self.fov.unwrap_or(view.fov_y_degrees);
    }
}

/// Whether images can be made of what the camera sees.
///
/// # Errors
/// In words, what is wrong with it.
pub fn validate(view: &View) -> Result<(), String> {
    let View { eye, target, up, fov_y_degrees } = *view;
    for (name, p) in [("eye", eye), ("target", target), ("up", up)] {
        if !p.is_finite() {
            return Err(format!("the camera's `{name}` is {p}, which is not finite in single precision"));
        }
    }
    let forward = target.as_dvec3() - eye.as_dvec3();
    if forward.length_squared() == 0.0 {
        return Err(format!("the camera's `eye` and `target` are one point, {eye}"));
    }
    let across = forward.normalize().cross(up.as_dvec3().normalize_or_zero());
    if across.length() < 1e-6 {
        return Err(format!("the camera's `up`, {up}, is zero or along its view; it must point across"));
    }
    if !is_angle(fov_y_degrees) {
        return Err(format!("the camera's `fov` is {fov_y_degrees}: it must be above 0 and below 180"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_axes_or_vectors() {
        for (text, v) in
            [("y", Vec3::Y), ("-Z", Vec3::NEG_Z), ("+x", Vec3::X), ("0, 2,-1", Vec3::new(0.0, 2.0, -1.0))]
        {
            assert_eq!(up(text).map(Up::vector), Ok(v), "{text}");
        }
        for text in ["", "w", "0,0,0", "1,2", "1,2,3,4", "nan,0,1", "inf,0,0", "--y"] {
            assert!(up(text).is_err(), "{text}");
        }
        assert!(
            point("1e39,0,0").is_err() && fov("0").is_err() && fov("180").is_err() && fov("nan").is_err()
        );
    }

    #[test]
    fn unusable_cameras_are_named() {
        let good = View { eye: Vec3::ZERO, target: Vec3::X, up: Vec3::Z, fov_y_degrees: 45.0 };
        assert_eq!(validate(&good), Ok(()));
        for (view, says) in [
            (View { eye: Vec3::X, ..good }, "one point"),
            (View { eye: Vec3::INFINITY, ..good }, "`eye`"),
            (View { target: Vec3::NAN, ..good }, "`target`"),
            (View { up: Vec3::X * 3.0, ..good }, "`up`"),
            (View { fov_y_degrees: 180.0, ..good }, "`fov`"),
        ] {
            let error = validate(&view).unwrap_err();
            assert!(error.contains(says), "{error}");
        }
        // A camera is as good at any scale.
        let tiny = View { target: Vec3::X * 1e-38, ..good };
        assert_eq!(validate(&tiny), Ok(()));
    }
}
