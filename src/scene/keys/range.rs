//! A range of numbers whose ends may or may not belong to it.
//!
//! One type serves the check, the words of a message and the bounds of the JSON schema, so that an open end is
//! open in all three.

use std::fmt;

/// Numbers from `min` to `max`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Lower end.
    pub min: f64,
    /// Upper end.
    pub max: f64,
    /// The lower end itself is not allowed.
    pub above_min: bool,
    /// The upper end itself is not allowed.
    pub below_max: bool,
}

impl Range {
    /// Both ends allowed.
    pub const fn closed(min: f64, max: f64) -> Self {
        Self { min, max, above_min: false, below_max: false }
    }

    /// Upper end allowed, lower end not.
    pub const fn above(min: f64, max: f64) -> Self {
        Self { min, max, above_min: true, below_max: false }
    }

    /// Lower end allowed, upper end not.
    pub const fn below(min: f64, max: f64) -> Self {
        Self { min, max, above_min: false, below_max: true }
    }

    /// Whether `number` lies in the range; NaN never does.
    pub fn contains(&self, number: f64) -> bool {
        let from_below = if self.above_min { number > self.min } else { number >= self.min };
        let from_above = if self.below_max { number < self.max } else { number <= self.max };
        from_below && from_above
    }

    /// A number as short as it can be read back: `30`, `0.1348`.
    pub fn short(number: f64) -> String {
        format!("{number}")
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let above = if self.above_min { "above " } else { "" };
        let below = if self.below_max { "below " } else { "" };
        write!(f, "{above}{} to {below}{}", Self::short(self.min), Self::short(self.max))
    }
}
