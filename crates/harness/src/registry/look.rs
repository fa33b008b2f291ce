//! How a structure looks in every picture.

/// The shape of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// ●
    Circle,
    /// ■
    Square,
    /// ▲
    Triangle,
    /// ◆
    Diamond,
    /// ★
    Star,
    /// ✚
    Plus,
    /// ▬
    Bar,
    /// ✖
    Cross,
}

/// How a structure looks: one colour for each theme, and one shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Colour on a light ground, as `#rrggbb`.
    pub light: &'static str,
    /// Colour on a dark ground, as `#rrggbb`.
    pub dark: &'static str,
    /// Shape of its points.
    pub shape: Shape,
}

/// A look by its parts.
pub const fn look(light: &'static str, dark: &'static str, shape: Shape) -> Look {
    Look { light, dark, shape }
}

impl Look {
    /// The look of structures that say nothing of theirs.
    pub const OTHER: Self = look("#bb6cac", "#f723c7", Shape::Diamond);
}
