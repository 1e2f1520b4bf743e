//! One value: of a quantity, or in a cell of a table.
//!
//! In: numbers, counts and words of Rust. Out: [`Datum`]; its type says what it is, and NaN and infinity are none: no
//! file has a word for them.

use serde_json::Value;

/// One value.
#[derive(Debug, Clone, PartialEq)]
pub enum Datum {
    /// A number in the column's unit.
    Number(f64),
    /// A count.
    Count(u64),
    /// A word.
    Word(String),
    /// None, for the column's reason.
    Undefined,
}

impl Datum {
    /// Its form in JSON; null where it is undefined.
    pub(super) fn to_json(&self) -> Value {
        match self {
            Self::Number(value) => (*value).into(),
            Self::Count(count) => (*count).into(),
            Self::Word(word) => word.as_str().into(),
            Self::Undefined => Value::Null,
        }
    }

    /// From its form in JSON.
    ///
    /// # Errors
    /// In words: another form.
    pub(super) fn from_json(value: &Value) -> Result<Self, String> {
        match value {
            Value::Null => Ok(Self::Undefined),
            Value::String(word) => Ok(Self::Word(word.clone())),
            Value::Number(number) => match (number.as_u64(), number.as_f64()) {
                (Some(count), _) => Ok(Self::Count(count)),
                (None, Some(value)) => Ok(Self::Number(value)),
                (None, None) => Err(format!("{number} is out of range")),
            },
            other => Err(format!("a value is a number, a text or null, not {other}")),
        }
    }

    /// The number or count.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Count(count) => Some(*count as f64),
            Self::Word(_) | Self::Undefined => None,
        }
    }

    /// The cell as the name of its row.
    pub fn name(&self) -> String {
        match self {
            Self::Number(value) => value.to_string(),
            Self::Count(count) => count.to_string(),
            Self::Word(word) => word.clone(),
            Self::Undefined => String::new(),
        }
    }
}

impl From<f64> for Datum {
    /// NaN and infinity become undefined: no file has a word for them.
    fn from(value: f64) -> Self {
        if value.is_finite() { Self::Number(value) } else { Self::Undefined }
    }
}

impl<T: Into<Datum>> From<Option<T>> for Datum {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Undefined, Into::into)
    }
}

impl From<u64> for Datum {
    fn from(count: u64) -> Self {
        Self::Count(count)
    }
}

impl From<u32> for Datum {
    fn from(count: u32) -> Self {
        Self::Count(count.into())
    }
}

impl From<usize> for Datum {
    fn from(count: usize) -> Self {
        Self::Count(count as u64)
    }
}

impl From<String> for Datum {
    fn from(word: String) -> Self {
        Self::Word(word)
    }
}

impl From<&str> for Datum {
    fn from(word: &str) -> Self {
        Self::Word(word.to_owned())
    }
}
