//! Formulas of the polar angle phi as text, with their derivatives.
//!
//! In: text such as `1 + 0.3*sin(2*phi)`. Out: a [`Formula`], whose value comes as a [`Jet`]: all derivatives follow
//! from the series, none is asked of the user. What is no formula is refused with the place in the text.
//!
//! Grammar, from the loosest to the tightest: `+ -`, `* /`, a minus before a value, `^` with a whole number. Values are
//! numbers, `phi` (rad), `pi`, brackets, and `sin cos tan sqrt exp` of brackets. There is no other variable and no
//! condition: a curve that is put together of pieces is a table of points.

use super::Jet;
use std::ops::Range;

/// Brackets and signs inside each other at most: deeper ones would end the stack.
const DEEPEST: u32 = 40;
/// Largest exponent.
const LARGEST_EXPONENT: u32 = 24;

/// A formula of phi.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    text: String,
    term: Term,
}

/// Why a text is no formula.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FormulaFault {
    /// Bytes of the text.
    pub at: Range<usize>,
    /// What is wrong there.
    pub message: String,
}

#[derive(Debug, Clone, PartialEq)]
enum Term {
    Number(f64),
    Phi,
    Negative(Box<Term>),
    Two(Arithmetic, Box<Term>, Box<Term>),
    Power(Box<Term>, u32),
    Of(FormulaFunction, Box<Term>),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Arithmetic {
    Add,
    Subtract,
    Multiply,
    Divide,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FormulaFunction {
    Sin,
    Cos,
    Tan,
    Sqrt,
    Exp,
}

/// Names of functions.
const FUNCTIONS: [(&str, FormulaFunction); 5] = [
    ("sin", FormulaFunction::Sin),
    ("cos", FormulaFunction::Cos),
    ("tan", FormulaFunction::Tan),
    ("sqrt", FormulaFunction::Sqrt),
    ("exp", FormulaFunction::Exp),
];

impl Formula {
    /// Reads a formula.
    ///
    /// # Errors
    /// The first place at which the text is none.
    pub fn parse(text: &str) -> Result<Self, FormulaFault> {
        let mut reader = FormulaReader { text, at: 0, depth: 0 };
        let term = reader.sum()?;
        if reader.peek().is_some() {
            return Err(reader.stray("this belongs to nothing: an operator is missing before it"));
        }
        Ok(Self { text: text.to_owned(), term })
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Value and derivatives at `phi_rad`; not finite where a divisor is zero or the root of a negative number is
    /// taken.
    pub fn at<const N: usize>(&self, phi_rad: f64) -> Jet<N> {
        self.term.at(&Jet::variable(phi_rad))
    }
}

impl Term {
    fn at<const N: usize>(&self, phi: &Jet<N>) -> Jet<N> {
        match self {
            Self::Number(number) => Jet::constant(*number),
            Self::Phi => *phi,
            Self::Negative(term) => -term.at(phi),
            Self::Two(operation, a, b) => {
                let (a, b) = (a.at(phi), b.at(phi));
                match operation {
                    Arithmetic::Add => a + b,
                    Arithmetic::Subtract => a - b,
                    Arithmetic::Multiply => a * b,
                    Arithmetic::Divide => a / b,
                }
            }
            Self::Power(term, exponent) => {
                let base = term.at(phi);
                (0..*exponent).fold(Jet::constant(1.0), |power, _| power * base)
            }
            Self::Of(function, term) => {
                let x = term.at(phi);
                match function {
                    FormulaFunction::Sin => x.sin_cos().0,
                    FormulaFunction::Cos => x.sin_cos().1,
                    FormulaFunction::Tan => {
                        let (sin, cos) = x.sin_cos();
                        sin / cos
                    }
                    FormulaFunction::Sqrt => x.sqrt(),
                    FormulaFunction::Exp => x.exp(),
                }
            }
        }
    }
}

struct FormulaReader<'a> {
    text: &'a str,
    at: usize,
    depth: u32,
}

type Read = Result<Term, FormulaFault>;

impl FormulaReader<'_> {
    /// The next character that is no blank.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn takes(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.at += wanted.len_utf8();
        }
        found
    }

    /// A fault at the next character, or behind the last one.
    fn fault(&mut self, message: impl Into<String>) -> FormulaFault {
        let length = self.peek().map_or(0, char::len_utf8);
        FormulaFault { at: self.at..self.at + length, message: message.into() }
    }

    /// A character where the formula should go on otherwise; a comma is mostly a decimal one.
    fn stray(&mut self, message: &str) -> FormulaFault {
        match self.peek() {
            Some(',') => self.fault("numbers have a point, such as 0.3, and a function takes one value"),
            _ => self.fault(message),
        }
    }

    fn sum(&mut self) -> Read {
        let mut sum = self.product()?;
        loop {
            let operation = if self.takes('+') {
                Arithmetic::Add
            } else if self.takes('-') {
                Arithmetic::Subtract
            } else {
                return Ok(sum);
            };
            sum = Term::Two(operation, Box::new(sum), Box::new(self.product()?));
        }
    }

    fn product(&mut self) -> Read {
        let mut product = self.signed()?;
        loop {
            let operation = if self.takes('*') {
                Arithmetic::Multiply
            } else if self.takes('/') {
                Arithmetic::Divide
            } else {
                return Ok(product);
            };
            product = Term::Two(operation, Box::new(product), Box::new(self.signed()?));
        }
    }

    fn signed(&mut self) -> Read {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.fault("brackets and signs are nested too deeply"));
        }
        let term = if self.takes('-') {
            Term::Negative(Box::new(self.signed()?))
        } else if self.takes('+') {
            self.signed()?
        } else {
            self.power()?
        };
        self.depth -= 1;
        Ok(term)
    }

    fn power(&mut self) -> Read {
        let base = self.value()?;
        if !self.takes('^') {
            return Ok(base);
        }
        self.peek();
        let start = self.at;
        let fault = |at| FormulaFault {
            at,
            message: format!("an exponent is a whole number from 0 to {LARGEST_EXPONENT}; roots are sqrt(...)"),
        };
        match self.number()? {
            Some(number) if number.fract() == 0.0 && (0.0..=f64::from(LARGEST_EXPONENT)).contains(&number) => {
                Ok(Term::Power(Box::new(base), number as u32))
            }
            Some(_) => Err(fault(start..self.at)),
            None => Err(fault(self.fault("").at)),
        }
    }

    fn value(&mut self) -> Read {
        if let Some(number) = self.number()? {
            return Ok(Term::Number(number));
        }
        match self.peek() {
            Some('(') => self.brackets(),
            Some(letter) if letter.is_alphabetic() || letter == '_' => self.named(),
            None => Err(self.fault("the formula ends where a value is missing")),
            Some(other) => Err(self.fault(format!("`{other}` is no value"))),
        }
    }

    fn brackets(&mut self) -> Read {
        let open = self.at;
        self.at += 1;
        let inside = self.sum()?;
        if self.takes(')') {
            return Ok(inside);
        }
        match self.peek() {
            None => Err(FormulaFault { at: open..open + 1, message: "this bracket is never closed".to_owned() }),
            Some(_) => Err(self.stray("an operator or a closing bracket is missing before this")),
        }
    }

    fn named(&mut self) -> Read {
        let start = self.at;
        let rest = &self.text[start..];
        let length = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        let name = &rest[..length];
        let at = start..start + length;
        self.at = at.end;
        match name {
            "phi" | "φ" => return Ok(Term::Phi),
            "pi" | "π" => return Ok(Term::Number(std::f64::consts::PI)),
            _ => {}
        }
        let Some((_, function)) = FUNCTIONS.iter().find(|(known, _)| *known == name) else {
            let known = FUNCTIONS.map(|(name, _)| name).join(", ");
            return Err(FormulaFault {
                at,
                message: format!("`{name}` is not known: there are phi (rad), pi, and {known} of brackets"),
            });
        };
        if self.peek() != Some('(') {
            let message = format!("`{name}` is a function: its argument goes into brackets, {name}(2*phi)");
            return Err(FormulaFault { at, message });
        }
        Ok(Term::Of(*function, Box::new(self.brackets()?)))
    }

    /// A number without a sign, if one begins here.
    fn number(&mut self) -> Result<Option<f64>, FormulaFault> {
        if !self.peek().is_some_and(|c| c.is_ascii_digit() || c == '.') {
            return Ok(None);
        }
        let rest = &self.text[self.at..];
        let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
        let mut length = digits(rest);
        if rest[length..].starts_with('.') {
            length += 1 + digits(&rest[length + 1..]);
        }
        // An exponent has digits; `2e` is two and a name.
        if rest[length..].starts_with(['e', 'E']) {
            let sign = usize::from(rest[length + 1..].starts_with(['+', '-']));
            let exponent = digits(&rest[length + 1 + sign..]);
            length += if exponent > 0 { 1 + sign + exponent } else { 0 };
        }
        let at = self.at..self.at + length;
        self.at = at.end;
        match rest[..length].parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(FormulaFault { at, message: format!("`{}` is no number", &rest[..length]) }),
        }
    }
}

#[cfg(test)]
mod tests;
