//! Words of gear geometry that every floor uses.
//!
//! Seen against the gear's z axis, polar angles and arcs of the pitch curve grow counter-clockwise.

/// Left or right flank of a gear tooth: left is the one at the larger arc of the pitch curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// Larger arc; cut by the cutter's left (counter-clockwise) flanks.
    Left,
    /// Smaller arc; cut by the cutter's right flanks.
    Right,
}

impl Side {
    /// sigma: +1 for left, -1 for right.
    pub fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    /// `left` or `right`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// Hand of a helix: of the gear's teeth or of the hob's thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hand {
    /// Rises to the right when seen with the axis upright.
    Right,
    /// Rises to the left.
    Left,
}

impl Hand {
    /// +1 for right, -1 for left.
    pub fn sign(self) -> f64 {
        match self {
            Self::Right => 1.0,
            Self::Left => -1.0,
        }
    }

    /// `right` or `left`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Left => "left",
        }
    }
}
