//! Units of length as files write them, with the micro sign of every alphabet.

use std::fmt;

/// A unit of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LengthUnit {
    /// Metre.
    Metre,
    /// Centimetre.
    Centimetre,
    /// Millimetre.
    Millimetre,
    /// Micrometre.
    Micrometre,
    /// Nanometre.
    Nanometre,
    /// Angstrom.
    Angstrom,
    /// Picometre.
    Picometre,
    /// Inch.
    Inch,
    /// Thousandth of an inch.
    Mil,
    /// Millionth of an inch.
    Microinch,
}

/// Every unit: as messages and options write it, its micrometres, and how files write it (in small letters).
const UNITS: [(LengthUnit, &str, f64, &[&str]); 10] = [
    (LengthUnit::Metre, "m", 1e6, &["m", "meter", "metre", "meters", "metres"]),
    (LengthUnit::Centimetre, "cm", 1e4, &["cm"]),
    (LengthUnit::Millimetre, "mm", 1e3, &["mm", "millimeter", "millimetre", "millimeters", "millimetres"]),
    (
        LengthUnit::Micrometre,
        "um",
        1.0,
        &["um", "\u{b5}m", "\u{3bc}m", "micron", "microns", "micrometer", "micrometre", "micrometers", "micrometres"],
    ),
    (LengthUnit::Nanometre, "nm", 1e-3, &["nm", "nanometer", "nanometre", "nanometers", "nanometres"]),
    (LengthUnit::Angstrom, "angstrom", 1e-4, &["angstrom", "\u{e5}", "\u{212b}"]),
    (LengthUnit::Picometre, "pm", 1e-6, &["pm"]),
    (LengthUnit::Inch, "inch", 25_400.0, &["inch", "inches", "in"]),
    (LengthUnit::Mil, "mil", 25.4, &["mil", "mils", "thou"]),
    (LengthUnit::Microinch, "uin", 0.0254, &["uin", "\u{b5}in", "\u{3bc}in", "microinch", "microinches"]),
];

impl LengthUnit {
    /// The unit of a name, if it is one; capitals count where they make another unit, `Mm` and `Pm`.
    pub fn of(name: &str) -> Option<Self> {
        let name = name.trim();
        if name == "Mm" || name == "Pm" {
            return None;
        }
        let small = name.to_lowercase();
        UNITS.iter().find(|(.., names)| names.contains(&small.as_str())).map(|(unit, ..)| *unit)
    }

    /// Micrometres in this unit.
    pub fn um(self) -> f64 {
        self.row().2
    }

    fn row(self) -> &'static (Self, &'static str, f64, &'static [&'static str]) {
        UNITS.iter().find(|(unit, ..)| *unit == self).expect("every unit has its row")
    }
}

impl fmt::Display for LengthUnit {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.row().1)
    }
}

impl std::str::FromStr for LengthUnit {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let all: Vec<&str> = UNITS.iter().map(|(_, name, ..)| *name).collect();
        Self::of(name).ok_or_else(|| format!("not a unit of length; use one of {}", all.join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_have_their_si_values_in_every_spelling() {
        for (name, um) in [
            ("m", 1e6),
            ("cm", 1e4),
            ("mm", 1e3),
            ("MM", 1e3),
            ("um", 1.0),
            ("\u{b5}m", 1.0),
            ("\u{3bc}m", 1.0),
            ("Microns", 1.0),
            ("nm", 1e-3),
            ("\u{c5}", 1e-4),
            ("\u{212b}", 1e-4),
            ("pm", 1e-6),
            ("in", 25.4e3),
            ("mil", 25.4),
            ("\u{b5}in", 0.0254),
        ] {
            assert_eq!(LengthUnit::of(name).map(LengthUnit::um), Some(um), "{name}");
        }
        for name in ["", "V", "Mm", "deg", "mmm", "n m", "Pa"] {
            assert_eq!(LengthUnit::of(name), None, "{name}");
        }
        assert_eq!("nm".parse(), Ok(LengthUnit::Nanometre));
        assert!("furlong".parse::<LengthUnit>().expect_err("none").contains("um"));
    }
}
