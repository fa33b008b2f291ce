//! From text to nodes, by recursive descent.

use super::{Function, Node, Operation};

/// Why a text is no expression.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {reason}")]
pub struct ParseError {
    /// Where, counted in characters from 1.
    pub column: usize,
    /// What is wrong there.
    pub reason: String,
}

/// Parentheses and signs within each other, so that no text fills the stack.
const DEEPEST: u32 = 200;

/// Nodes of one expression.
const MAX: usize = 4096;

/// The largest exponent.
const HIGHEST: f64 = 64.0;

/// The nodes of an expression, its value the last.
pub fn nodes(text: &str) -> Result<Vec<Node>, ParseError> {
    let mut parser = Parser { characters: text.chars().collect(), at: 0, nodes: Vec::new(), depth: 0 };
    let value = parser.sum()?;
    parser.skip_blanks();
    if let Some(other) = parser.peek() {
        return parser.fail(format!("`{other}` where an operator or the end is expected"));
    }
    let mut nodes = parser.nodes;
    // The value of a single variable may be that of a node in the middle.
    nodes.truncate(usize::from(value) + 1);
    Ok(nodes)
}

struct Parser {
    characters: Vec<char>,
    at: usize,
    nodes: Vec<Node>,
    depth: u32,
}

impl Parser {
    fn sum(&mut self) -> Result<u16, ParseError> {
        self.chain("+-", [Operation::Add, Operation::Sub], Self::product)
    }

    fn product(&mut self) -> Result<u16, ParseError> {
        self.chain("*/", [Operation::Mul, Operation::Div], Self::signed)
    }

    /// What binds more, joined from the left by two signs of the same rank.
    fn chain(
        &mut self,
        signs: &str,
        [first, second]: [Operation; 2],
        part: impl Fn(&mut Self) -> Result<u16, ParseError>,
    ) -> Result<u16, ParseError> {
        let mut left = part(self)?;
        while let Some(sign) = self.take_one_of(signs) {
            let right = part(self)?;
            left = self.two(if signs.starts_with(sign) { first } else { second }, left, right)?;
        }
        Ok(left)
    }

    /// A sign binds less than a power: −x² is −(x²).
    fn signed(&mut self) -> Result<u16, ParseError> {
        self.deeper()?;
        let value = match self.take_one_of("+-") {
            Some('-') => {
                let value = self.signed()?;
                self.one(Function::Neg, value)?
            }
            Some(_) => self.signed()?,
            None => self.powers()?,
        };
        self.depth -= 1;
        Ok(value)
    }

    fn powers(&mut self) -> Result<u16, ParseError> {
        let base = self.atom()?;
        if self.take_one_of("^").is_none() {
            return Ok(base);
        }
        self.skip_blanks();
        let at = self.at;
        let exponent = self.signed()?;
        match self.nodes[usize::from(exponent)] {
            Node::Constant(n) if (0.0..=HIGHEST).contains(&n) && n.fract() == 0.0 => {
                self.push(Node::Power(base, n as u32))
            }
            _ => {
                self.at = at;
                self.fail(format!("an exponent must be a whole number from 0 to {HIGHEST}"))
            }
        }
    }

    fn atom(&mut self) -> Result<u16, ParseError> {
        self.skip_blanks();
        match self.peek() {
            Some('(') => {
                self.at += 1;
                let value = self.sum()?;
                self.expect(')')?;
                Ok(value)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => self.name(),
            Some(other) => self.fail(format!("`{other}` where a value is expected")),
            None => self.fail("ends where a value is expected"),
        }
    }

    fn number(&mut self) -> Result<u16, ParseError> {
        let first = self.at;
        while let Some(c) = self.peek() {
            let exponent = self.at > first && matches!(self.characters[self.at - 1], 'e' | 'E');
            if !(c.is_ascii_digit()
                || c == '.'
                || matches!(c, 'e' | 'E')
                || exponent && matches!(c, '+' | '-'))
            {
                break;
            }
            self.at += 1;
        }
        let text: String = self.characters[first..self.at].iter().collect();
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => self.push(Node::Constant(value)),
            _ => {
                self.at = first;
                self.fail(format!("`{text}` is no number"))
            }
        }
    }

    fn name(&mut self) -> Result<u16, ParseError> {
        let first = self.at;
        while self.peek().is_some_and(|c| c.is_alphanumeric() || c == '_') {
            self.at += 1;
        }
        let name: String = self.characters[first..self.at].iter().collect();
        let function = match name.as_str() {
            "x" => return self.push(Node::Variable(0)),
            "y" => return self.push(Node::Variable(1)),
            "z" => return self.push(Node::Variable(2)),
            "pi" => return self.push(Node::Constant(std::f64::consts::PI)),
            "sqrt" => Function::Sqrt,
            "abs" => Function::Abs,
            "exp" => Function::Exp,
            "ln" => Function::Ln,
            "sin" => Function::Sin,
            "cos" => Function::Cos,
            "min" => return self.among(Operation::Min),
            "max" => return self.among(Operation::Max),
            _ => {
                self.at = first;
                return self.fail(format!(
                    "`{name}` is unknown; there are x, y, z, pi, sqrt, abs, exp, ln, sin, cos, min, max"
                ));
            }
        };
        self.expect('(')?;
        let value = self.sum()?;
        self.expect(')')?;
        self.one(function, value)
    }

    /// The least or greatest of two or more.
    fn among(&mut self, operation: Operation) -> Result<u16, ParseError> {
        self.expect('(')?;
        let mut value = self.sum()?;
        self.expect(',')?;
        loop {
            let next = self.sum()?;
            value = self.two(operation, value, next)?;
            if self.take_one_of(",").is_none() {
                break;
            }
        }
        self.expect(')')?;
        Ok(value)
    }

    fn one(&mut self, function: Function, value: u16) -> Result<u16, ParseError> {
        if let (Function::Neg, Node::Constant(constant)) = (function, self.nodes[usize::from(value)]) {
            return self.push(Node::Constant(-constant));
        }
        self.push(Node::One(function, value))
    }

    fn two(&mut self, operation: Operation, left: u16, right: u16) -> Result<u16, ParseError> {
        self.push(Node::Two(operation, left, right))
    }

    /// The node, which may be there already.
    fn push(&mut self, node: Node) -> Result<u16, ParseError> {
        let node = self.folded(node);
        if let Some(known) = self.nodes.iter().position(|known| *known == node) {
            return Ok(known as u16);
        }
        if self.nodes.len() == MAX {
            return self.fail(format!("more than {MAX} operations"));
        }
        self.nodes.push(node);
        Ok((self.nodes.len() - 1) as u16)
    }

    /// A power of a constant is a constant: exponents may be powers themselves.
    fn folded(&self, node: Node) -> Node {
        match node {
            Node::Power(base, n) => match self.nodes[usize::from(base)] {
                Node::Constant(base) => Node::Constant(super::Arithmetic::power(base, n)),
                _ => node,
            },
            _ => node,
        }
    }

    fn deeper(&mut self) -> Result<(), ParseError> {
        self.depth += 1;
        if self.depth > DEEPEST { self.fail(format!("more than {DEEPEST} levels deep")) } else { Ok(()) }
    }

    fn expect(&mut self, wanted: char) -> Result<(), ParseError> {
        self.skip_blanks();
        match self.peek() {
            Some(c) if c == wanted => {
                self.at += 1;
                Ok(())
            }
            Some(other) => self.fail(format!("`{other}` where `{wanted}` is expected")),
            None => self.fail(format!("ends where `{wanted}` is expected")),
        }
    }

    fn take_one_of(&mut self, wanted: &str) -> Option<char> {
        self.skip_blanks();
        let c = self.peek().filter(|c| wanted.contains(*c))?;
        self.at += 1;
        Some(c)
    }

    fn skip_blanks(&mut self) {
        while self.peek().is_some_and(char::is_whitespace) {
            self.at += 1;
        }
    }

    fn peek(&self) -> Option<char> {
        self.characters.get(self.at).copied()
    }

    fn fail<T>(&self, reason: impl Into<String>) -> Result<T, ParseError> {
        Err(ParseError { column: self.at + 1, reason: reason.into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_told_with_their_place() {
        let slip = |text: &str| nodes(text).expect_err(text).to_string();
        assert_eq!(slip(""), "column 1: ends where a value is expected");
        assert_eq!(slip("x^2 + "), "column 7: ends where a value is expected");
        assert_eq!(slip("x^y"), "column 3: an exponent must be a whole number from 0 to 64");
        assert_eq!(slip("x^2.5"), "column 3: an exponent must be a whole number from 0 to 64");
        assert_eq!(slip("sin x"), "column 5: `x` where `(` is expected");
        assert_eq!(slip("min(x)"), "column 6: `)` where `,` is expected");
        assert_eq!(slip("1 2"), "column 3: `2` where an operator or the end is expected");
        assert_eq!(slip("x $ y"), "column 3: `$` where an operator or the end is expected");
        assert_eq!(slip("1..2"), "column 1: `1..2` is no number");
        assert_eq!(slip("(x"), "column 3: ends where `)` is expected");
        assert!(slip("w + 1").starts_with("column 1: `w` is unknown"));
        assert!(slip(&"(".repeat(100_000)).contains("levels deep"));
        assert!(slip(&"-".repeat(100_000)).contains("levels deep"));
        let long = (0..5000).map(|i| format!("{i}*x")).collect::<Vec<_>>().join("+");
        assert!(slip(&long).contains("more than 4096 operations"));
    }
}
