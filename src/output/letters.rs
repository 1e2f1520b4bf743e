//! Letters as pixels: the embedded font, every letter drawn once at each size.
//!
//! In: words and a size. Out: their width, and how much of which pixels they cover.
//!
//! The law: letters follow each other by their advances and kerning, each set to whole pixels and beginning with its
//! ink, without its left bearing. So a letter's pixels depend on the letter and the size alone, and can be kept: a run
//! draws some hundred letters a hundred thousand times. Every thread keeps its own, so that none waits for another.
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
fn width(words: &str, size: f64) -> Result<u32, String> {
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

/// Width of a text, pixels.
///
/// # Errors
/// The embedded font cannot be read.
pub(super) fn text_width_px(words: &str, em_px: f64) -> Result<f64, String> {
    /// Measured at this many times the size, because widths are whole pixels.
    const FINER: f64 = 16.0;
    Ok(f64::from(width(words, em_px * font::LINE_HEIGHT_EM * FINER)?) / FINER)
}

/// `em_px`, or less where the words would be longer than `room_px`.
///
/// # Errors
/// The embedded font cannot be read.
pub(super) fn fitting_em_px(words: &str, em_px: f64, room_px: f64) -> Result<f64, String> {
    Ok(em_px * (room_px / text_width_px(words, em_px)?.max(1.0)).min(1.0))
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

    const WORDS: [&str; 4] = ["Finish: tooth 7, left flank", "−12.5 µm", "AVATAR To.", "  Σφ²  "];

    fn gathered(words: &str, size: f64) -> Ink {
        let mut pixels = Vec::new();
        draw(words, size, |x, y, part| pixels.push((x, y, part))).expect("the embedded font");
        pixels
    }

    /// All letters anew, straight from the font.
    fn anew(words: &str, size: f64) -> Ink {
        let font = FontRef::try_from_slice(font::NOTO_SANS).expect("the embedded font");
        let size = size as f32;
        let scaled = font.as_scaled(size);
        let (mut x, mut pixels) = (0.0, Vec::new());
        for (index, letter) in words.char_indices() {
            if let Some(before) = words[..index].chars().next_back() {
                x += scaled.kern(font.glyph_id(before), font.glyph_id(letter));
            }
            if let Some(outline) = font.outline_glyph(scaled.scaled_glyph(letter)) {
                let top = (size / 2.0 + outline.px_bounds().min.y) as i32;
                outline.draw(|across, down, part| pixels.push((x as i32 + across as i32, top + down as i32, part)));
            }
            x += scaled.h_advance(font.glyph_id(letter));
        }
        pixels.retain(|pixel| pixel.2 != 0.0);
        pixels
    }

    #[test]
    fn kept_letters_cover_what_letters_drawn_anew_cover() {
        for size in [15.0 * font::LINE_HEIGHT_EM * 4.0, 20.0 * font::LINE_HEIGHT_EM, 217.31] {
            for words in WORDS {
                assert_eq!(gathered(words, size), anew(words, size), "{words} at {size}, first");
                assert_eq!(gathered(words, size), anew(words, size), "{words} at {size}, kept");
            }
        }
        assert_ne!(gathered("AV", 20.0), anew("A V", 20.0), "the comparison sees a gap");
    }

    /// What scenes may have printed has a glyph; a letter of another script has none.
    #[test]
    fn every_letter_of_a_printed_text_is_in_the_font() {
        let font = embedded().expect("the embedded font");
        let missing = |letter: &char| font.glyph_id(*letter).0 == 0;
        let letters = crate::scene::keys::PRINTED.into_iter().flat_map(|[from, to]| from..=to);
        assert_eq!(letters.filter(missing).collect::<String>(), "");
        assert!(missing(&'ж'), "the comparison sees a letter that is not there");
    }

    /// In the font's table a digit is 572 of 1000 units wide; digits are not kerned.
    #[test]
    fn widths_are_those_of_the_font() {
        let digit_em = 0.572;
        for count in [1_usize, 7, 40] {
            let width_em = text_width_px(&"5".repeat(count), 100.0).expect("the embedded font") / 100.0;
            assert!((width_em - digit_em * count as f64).abs() < 1e-3, "{count} digits are {width_em} em wide");
        }
        let half = fitting_em_px("5555", 20.0, 2.0 * digit_em * 20.0).expect("the embedded font");
        assert!((half - 10.0).abs() < 0.02, "{half}");
    }

    #[test]
    fn a_thread_keeps_no_more_letters_than_it_may() {
        for size in 0..MOST_KEPT + 10 {
            let _pixels = gathered(".", 10.0 + 0.01 * size as f64);
        }
        assert!(KEPT.with_borrow(HashMap::len) <= MOST_KEPT);
    }
}
