//! The one font of all pictures, inside the program.
//!
//! In: nothing. Out: its bytes and its measures.
//!
//! Pictures are the same on every machine only if the letters are: system fonts differ, so a subset of Noto Sans
//! (SIL Open Font License 1.1, see `assets/OFL.txt`) travels with the program: Latin, Greek, the mathematical signs.
//!
//! Road not taken: outlines instead of text in SVG files. Text stays searchable and editable; a list of families lets a
//! viewer without Noto Sans take its own sans serif.

/// Line height of the font in em, from its header (1069 + 293 of 1000 units); `ab_glyph` scales by it.
pub(super) const LINE_HEIGHT_EM: f64 = 1.362;
/// Height of capital letters and digits in em, from the font's header.
pub(super) const CAPITAL_HEIGHT_EM: f64 = 0.714;

/// The font itself.
pub(super) const NOTO_SANS: &[u8] = include_bytes!("../../assets/NotoSans-Regular.ttf");
