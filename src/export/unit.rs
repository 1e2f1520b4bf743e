//! Units of length of exported files, and numbers in them.

/// Unit of length of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileUnit {
    /// Millimetre.
    Millimetre,
    /// Inch of 25.4 mm.
    Inch,
}

impl FileUnit {
    /// Its length, mm.
    pub fn mm(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Inch => 25.4,
        }
    }

    /// Its word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Inch => "inch",
        }
    }

    /// A length of so many mm in this unit, to a tenth of a nanometre.
    pub fn shown(self, length_mm: f64) -> String {
        let digits = match self {
            Self::Millimetre => 7,
            Self::Inch => 9,
        };
        fixed(length_mm / self.mm(), digits)
    }
}

/// A number with so many digits behind the point, zero without a sign.
pub fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    if text.bytes().all(|c| matches!(c, b'-' | b'0' | b'.')) { text.trim_start_matches('-').to_owned() } else { text }
}
