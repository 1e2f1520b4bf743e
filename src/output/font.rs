//! The one font of all pictures, inside the program.
//!
//! In: nothing. Out: the family name under which plotters finds the font, registered once per process.
//!
//! Pictures are the same on every machine only if the letters are: system fonts differ, so a subset of Noto Sans
//! (SIL Open Font License 1.1, see `assets/OFL.txt`) travels with the program: Latin, Greek, the mathematical signs.
//!
//! Road not taken: outlines instead of text in SVG files. Text stays searchable and editable; the family list lets a
//! viewer without Noto Sans take its own sans serif.

use std::sync::OnceLock;

use plotters::style::{FontStyle, register_font};

/// Family list as SVG files name it; plotters finds the embedded font under the whole list.
pub(super) const FAMILY: &str = "Noto Sans, DejaVu Sans, Arial, sans-serif";
/// Line height of the font in em, from its header (1069 + 293 of 1000 units); plotters scales bitmaps by it.
pub(super) const LINE_HEIGHT_EM: f64 = 1.362;
/// Height of capital letters and digits in em, from the font's header.
pub(super) const CAPITAL_HEIGHT_EM: f64 = 0.714;

/// The font itself.
pub(super) const NOTO_SANS: &[u8] = include_bytes!("../../assets/NotoSans-Regular.ttf");

/// Registers the font on the first call.
pub(super) fn register() -> Result<(), String> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    REGISTERED
        .get_or_init(|| register_font(FAMILY, FontStyle::Normal, NOTO_SANS).is_ok())
        .then_some(())
        .ok_or_else(|| "the embedded font cannot be read".to_owned())
}
