//! Letters as pixels: the embedded font, every letter drawn once at each size.
//!
//! In: words and a size. Out: their width, and how much of which pixels they cover.
//!
//! The law: letters follow each other by their advances and kerning, each set to whole pixels (as plotters' bitmap
//! backend sets them, pixel for pixel). So a letter's pixels depend on the letter and the size alone, and can be kept:
//! a run draws some hundred letters a hundred thousand times. Every thread keeps its own, so that none waits for
//! another.
//!
//! Road not taken: whole texts kept. Most titles and values are drawn once; it is their letters that come again.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::OnceLock;

use ab_glyph::{Font, FontRef, ScaleFont};

use crate::output::font;

/// Letters that a thread keeps at most: titles that are fitted into their room have sizes of their own.
const MOST_KEPT: usize = 4096;

/// Pixels of a letter and how much of each it covers: across from the letter's left end, down from the text's corner.
type Ink = Vec<(i32, i32, f32)>;

thread_local! {
    static KEPT: RefCell<HashMap<(char, u32), Rc<Ink>>> = RefCell::default();
}

/// Gives every pixel that the words touch and how much of it one letter covers, from the text's upper left corner;
/// `size` is the height of a line, pixels.
///
/// # Errors
/// The embedded font cannot be read.
pub(super) fn draw(words: &str, size: f64, mut pixel: impl FnMut(i32, i32, f32)) -> Result<(), String> {
    let size = size as f32;
    let font = embedded()?;
    let scaled = font.as_scaled(size);
    let (mut x, mut before) = (0.0_f32, None);
    for letter in words.chars() {
        let id = scaled.glyph_id(letter);
        if let Some(before) = before.replace(id) {
            x += scaled.kern(before, id);
        }
        let shift = x as i32;
        for &(across, down, part) in ink(font, letter, size).iter() {
            pixel(across + shift, down, part);
        }
        x += scaled.h_advance(id);
    }
    Ok(())
}

/// Width of the words in whole pixels; `size` as for [`draw`].
///
/// # Errors
/// The embedded font cannot be read.
pub(super) fn width(words: &str, size: f64) -> Result<u32, String> {
    let scaled = embedded()?.as_scaled(size as f32);
    let (mut x, mut before) = (0.0_f32, None);
    for letter in words.chars() {
        let id = scaled.glyph_id(letter);
        x += scaled.h_advance(id);
        if let Some(before) = before.replace(id) {
            x += scaled.kern(before, id);
        }
    }
    Ok((x as i32).unsigned_abs())
}

fn embedded() -> Result<&'static FontRef<'static>, String> {
    static FONT: OnceLock<Option<FontRef<'static>>> = OnceLock::new();
    let font = FONT.get_or_init(|| FontRef::try_from_slice(font::NOTO_SANS).ok());
    font.as_ref().ok_or_else(|| "the embedded font cannot be read".to_owned())
}

fn ink(font: &FontRef<'static>, letter: char, size: f32) -> Rc<Ink> {
    KEPT.with_borrow_mut(|kept| {
        if kept.len() >= MOST_KEPT {
            kept.clear();
        }
        kept.entry((letter, size.to_bits())).or_insert_with(|| Rc::new(drawn(font, letter, size))).clone()
    })
}

fn drawn(font: &FontRef<'static>, letter: char, size: f32) -> Ink {
    let mut ink = Vec::new();
    // Spaces have no outline.
    if let Some(outline) = font.outline_glyph(font.as_scaled(size).scaled_glyph(letter)) {
        let top = (size / 2.0 + outline.px_bounds().min.y) as i32;
        outline.draw(|across, down, part| {
            if part != 0.0 {
                ink.push((across as i32, down as i32 + top, part));
            }
        });
    }
    ink
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotters::style::{FontDesc, FontFamily, FontStyle};
    use std::convert::Infallible;

    const WORDS: [&str; 4] = ["Finish: tooth 7, left flank", "−12.5 µm", "AVATAR To.", "  Σφ²  "];

    fn gathered(words: &str, size: f64) -> Ink {
        let mut pixels = Vec::new();
        draw(words, size, |x, y, part| pixels.push((x, y, part))).expect("the embedded font");
        pixels
    }

    /// plotters draws every letter anew: the peer.
    #[test]
    fn kept_letters_cover_what_letters_drawn_anew_cover() {
        font::register().expect("the embedded font");
        for size in [15.0 * font::LINE_HEIGHT_EM * 4.0, 20.0 * font::LINE_HEIGHT_EM, 217.31] {
            for words in WORDS {
                let peer = FontDesc::new(FontFamily::Name(font::FAMILY), size, FontStyle::Normal);
                let mut anew = Vec::new();
                let drawn: Result<Result<(), Infallible>, _> = peer.draw(words, (0, 0), |x, y, part| {
                    if part != 0.0 {
                        anew.push((x, y, part));
                    }
                    Ok(())
                });
                assert!(drawn.is_ok());
                assert_eq!(gathered(words, size), anew, "{words} at {size}, first");
                assert_eq!(gathered(words, size), anew, "{words} at {size}, kept");
                assert_eq!(width(words, size).expect("a width"), peer.box_size(words).expect("a width").0);
            }
        }
    }

    #[test]
    fn a_thread_keeps_no_more_letters_than_it_may() {
        for size in 0..MOST_KEPT + 10 {
            let _pixels = gathered(".", 10.0 + 0.01 * size as f64);
        }
        assert!(KEPT.with_borrow(HashMap::len) <= MOST_KEPT);
    }
}
