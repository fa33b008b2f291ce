//! Functions of x, y and z, written as text.

mod parse;

pub use parse::ParseError;

use std::fmt;

/// Numbers of some kind that expressions are evaluated in. All functions are total: what isn't defined below 0 counts there as
/// at 0.
pub trait Arithmetic: Copy {
    /// A constant.
    fn constant(value: f64) -> Self;
    /// a + b
    fn add(self, other: Self) -> Self;
    /// a − b
    fn sub(self, other: Self) -> Self;
    /// a·b
    fn mul(self, other: Self) -> Self;
    /// a/b
    fn div(self, other: Self) -> Self;
    /// −a
    fn neg(self) -> Self;
    /// aⁿ
    fn power(self, n: u32) -> Self;
    /// The root of a, or of 0.
    fn sqrt(self) -> Self;
    /// |a|
    fn abs(self) -> Self;
    /// eᵃ
    fn exp(self) -> Self;
    /// The natural logarithm of a, or of 0.
    fn ln(self) -> Self;
    /// sin a
    fn sin(self) -> Self;
    /// cos a
    fn cos(self) -> Self;
    /// The lesser.
    fn min(self, other: Self) -> Self;
    /// The greater.
    fn max(self, other: Self) -> Self;
}

/// What a node does with the values of nodes before it, given by number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Node {
    Constant(f64),
    /// x, y or z.
    Variable(u8),
    One(Function, u16),
    Power(u16, u32),
    Two(Operation, u16, u16),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Function {
    Neg,
    Sqrt,
    Abs,
    Exp,
    Ln,
    Sin,
    Cos,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Add,
    Sub,
    Mul,
    Div,
    Min,
    Max,
}

/// A function of x, y and z: what is written twice is computed once.
#[derive(Clone, PartialEq)]
pub struct Expression {
    text: String,
    /// The last is the value; never empty.
    nodes: Vec<Node>,
}

impl fmt::Debug for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Expression({})", self.text)
    }
}

/// Nodes whose values need no allocation.
const FEW: usize = 48;

impl Expression {
    /// Reads an expression: numbers, `x`, `y`, `z`, `pi`, `+ - * /`, `^` with a whole exponent from 0 to 64, parentheses, and
    /// `sqrt`, `abs`, `exp`, `ln`, `sin`, `cos` of one and `min`, `max` of two or more.
    ///
    /// # Errors
    /// [`ParseError`] says where it is no expression, and why.
    pub fn parse(text: &str) -> Result<Self, ParseError> {
        let nodes = parse::nodes(text)?;
        Ok(Self { text: text.to_owned(), nodes })
    }

    /// As it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Bytes that it holds beside itself.
    pub fn bytes(&self) -> usize {
        self.text.capacity() + crate::vec_bytes(&self.nodes)
    }

    /// Its value.
    pub fn value<A: Arithmetic>(&self, at: [A; 3]) -> A {
        let zero = A::constant(0.0);
        if self.nodes.len() <= FEW {
            self.evaluated(at, &mut [zero; FEW])
        } else {
            self.evaluated(at, &mut vec![zero; self.nodes.len()])
        }
    }

    fn evaluated<A: Arithmetic>(&self, at: [A; 3], values: &mut [A]) -> A {
        for (i, node) in self.nodes.iter().enumerate() {
            let of = |node: u16| values[usize::from(node)];
            values[i] = match *node {
                Node::Constant(value) => A::constant(value),
                Node::Variable(axis) => at[usize::from(axis)],
                Node::Power(a, n) => of(a).power(n),
                Node::One(function, a) => match function {
                    Function::Neg => of(a).neg(),
                    Function::Sqrt => of(a).sqrt(),
                    Function::Abs => of(a).abs(),
                    Function::Exp => of(a).exp(),
                    Function::Ln => of(a).ln(),
                    Function::Sin => of(a).sin(),
                    Function::Cos => of(a).cos(),
                },
                Node::Two(operation, a, b) => match operation {
                    Operation::Add => of(a).add(of(b)),
                    Operation::Sub => of(a).sub(of(b)),
                    // A square is never below 0.
                    Operation::Mul if a == b => of(a).power(2),
                    Operation::Mul => of(a).mul(of(b)),
                    Operation::Div => of(a).div(of(b)),
                    Operation::Min => of(a).min(of(b)),
                    Operation::Max => of(a).max(of(b)),
                },
            };
        }
        values[self.nodes.len() - 1]
    }
}

impl Arithmetic for f64 {
    fn constant(value: f64) -> Self {
        value
    }
    fn add(self, other: Self) -> Self {
        self + other
    }
    fn sub(self, other: Self) -> Self {
        self - other
    }
    fn mul(self, other: Self) -> Self {
        self * other
    }
    fn div(self, other: Self) -> Self {
        self / other
    }
    fn neg(self) -> Self {
        -self
    }
    fn power(self, n: u32) -> Self {
        // By squares, so that it is the same everywhere.
        let (mut result, mut base, mut n) = (1.0, self, n);
        while n > 0 {
            if n & 1 == 1 {
                result *= base;
            }
            base *= base;
            n >>= 1;
        }
        result
    }
    fn sqrt(self) -> Self {
        self.max(0.0).sqrt()
    }
    fn abs(self) -> Self {
        self.abs()
    }
    fn exp(self) -> Self {
        libm::exp(self)
    }
    fn ln(self) -> Self {
        libm::log(self.max(0.0))
    }
    fn sin(self) -> Self {
        libm::sin(self)
    }
    fn cos(self) -> Self {
        libm::cos(self)
    }
    fn min(self, other: Self) -> Self {
        self.min(other)
    }
    fn max(self, other: Self) -> Self {
        self.max(other)
    }
}

/// A value with its derivatives in x, y and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    /// The value.
    pub value: f64,
    /// The derivatives.
    pub slope: glam::DVec3,
}

impl Gradient {
    /// The coordinates of a point.
    pub fn at(point: glam::DVec3) -> [Self; 3] {
        [0, 1, 2].map(|axis| Self { value: point[axis], slope: glam::DVec3::AXES[axis] })
    }

    fn through(self, value: f64, slope: f64) -> Self {
        Self { value, slope: self.slope * slope }
    }
}

impl Arithmetic for Gradient {
    fn constant(value: f64) -> Self {
        Self { value, slope: glam::DVec3::ZERO }
    }
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: self.slope - other.slope }
    }
    fn mul(self, other: Self) -> Self {
        let slope = self.slope * other.value + other.slope * self.value;
        Self { value: self.value * other.value, slope }
    }
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self { value, slope: (self.slope - other.slope * value) / other.value }
    }
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
    fn power(self, n: u32) -> Self {
        let slope = if n == 0 { 0.0 } else { f64::from(n) * Arithmetic::power(self.value, n - 1) };
        self.through(Arithmetic::power(self.value, n), slope)
    }
    fn sqrt(self) -> Self {
        let root = Arithmetic::sqrt(self.value);
        self.through(root, if root > 0.0 { 0.5 / root } else { 0.0 })
    }
    fn abs(self) -> Self {
        self.through(self.value.abs(), self.value.signum())
    }
    fn exp(self) -> Self {
        let value = libm::exp(self.value);
        self.through(value, value)
    }
    fn ln(self) -> Self {
        self.through(Arithmetic::ln(self.value), if self.value > 0.0 { 1.0 / self.value } else { 0.0 })
    }
    fn sin(self) -> Self {
        self.through(libm::sin(self.value), libm::cos(self.value))
    }
    fn cos(self) -> Self {
        self.through(libm::cos(self.value), -libm::sin(self.value))
    }
    fn min(self, other: Self) -> Self {
        if other.value < self.value { other } else { self }
    }
    fn max(self, other: Self) -> Self {
        if other.value > self.value { other } else { self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    fn value(text: &str, at: [f64; 3]) -> f64 {
        Expression::parse(text).unwrap().value(at)
    }

    #[test]
    fn precedence_and_functions() {
        assert_eq!(value("1 + 2*x^2 - -y/4", [3.0, 8.0, 0.0]), 21.0);
        assert_eq!(value("-x^2", [3.0, 0.0, 0.0]), -9.0);
        assert_eq!(value("2^3^2", [0.0; 3]), 512.0);
        assert_eq!(value("6 / 3 / 2 - 1 - 1", [0.0; 3]), -1.0);
        assert_eq!(value("max(x, y, z) + min(x, y) + abs(-z)", [1.0, 2.0, 3.0]), 7.0);
        assert_eq!(value("sqrt(4) + sqrt(-1) + exp(0) + ln(1) + cos(0) + sin(0)", [0.0; 3]), 4.0);
        assert_eq!(value(".5e1 + 1E-1", [0.0; 3]), 5.1);
        assert_eq!(value("cos(pi)", [0.0; 3]), -1.0);
    }

    #[test]
    fn what_is_written_twice_is_computed_once() {
        let once = Expression::parse("x*x + y").unwrap().nodes.len();
        assert_eq!(Expression::parse("(x*x + y) - (x*x + y)").unwrap().nodes.len(), once + 1);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn slopes_are_those_of_small_steps(x in 0.5f64..2.0, y in 0.5f64..2.0, z in 0.5f64..2.0) {
            let f = "x^3*y - sin(x*z)/(1 + y^2) + sqrt(x + z)*exp(-y) + ln(x) - abs(cos(z) - 2) + min(x, y + 5) - max(z, x - 5)";
            let f = Expression::parse(f).unwrap();
            let at = DVec3::new(x, y, z);
            let slope = f.value(Gradient::at(at)).slope;
            for axis in 0..3 {
                let step = DVec3::AXES[axis] * 1e-6;
                let near = (f.value((at + step).to_array()) - f.value((at - step).to_array())) / 2e-6;
                prop_assert!((slope[axis] - near).abs() < 1e-6 * (1.0 + near.abs()), "{} {}", slope[axis], near);
            }
        }

        #[test]
        fn no_text_panics(text in "[xyz0-9.^*/+() a-z,-]{0,40}") {
            if let Ok(f) = Expression::parse(&text) {
                let _ = f.value([1.0, 2.0, 3.0]);
            }
        }
    }
}
