//! Bytes of a text file as characters: UTF-8, UTF-16 of both byte orders, and what is left as Latin-1.
//!
//! Byte order marks decide; without one, zeros in every second byte are UTF-16. Bytes that are no UTF-8 are Latin-1 if
//! none of them is a control character: then every letter is right for Western Europe, and numbers in any case.

use crate::error::FileFault;

/// Bytes at the start by which UTF-16 without a mark is known.
const LOOKED_AT: usize = 256;

/// The text, and its encoding where that is not UTF-8.
pub(crate) fn characters(bytes: &[u8]) -> Result<(String, Option<&'static str>), FileFault> {
    let (text, encoding) = if let Some(rest) = bytes.strip_prefix(b"\xef\xbb\xbf") {
        (std::str::from_utf8(rest).map_err(|_| "the file is no text: its UTF-8 is damaged")?.to_owned(), None)
    } else if let Some(rest) = bytes.strip_prefix(b"\xff\xfe") {
        (utf16(rest, u16::from_le_bytes)?, Some("UTF-16"))
    } else if let Some(rest) = bytes.strip_prefix(b"\xfe\xff") {
        (utf16(rest, u16::from_be_bytes)?, Some("UTF-16"))
    } else if zeros(bytes, 1) {
        (utf16(bytes, u16::from_le_bytes)?, Some("UTF-16"))
    } else if zeros(bytes, 0) {
        (utf16(bytes, u16::from_be_bytes)?, Some("UTF-16"))
    } else if let Ok(text) = std::str::from_utf8(bytes) {
        (text.to_owned(), None)
    } else {
        (bytes.iter().map(|&byte| char::from(byte)).collect(), Some("Latin-1"))
    };
    let strange = |c: char| c == '\0' || (encoding.is_some() && c.is_control() && !matches!(c, '\t' | '\r' | '\n'));
    if let Some(place) = text.find(strange) {
        let line = text[..place].matches('\n').count() + 1;
        return Err(format!("the file is no text: line {line} has a control character").into());
    }
    // Line ends of old Macintosh programs.
    let text = if text.contains('\r') && !text.contains('\n') { text.replace('\r', "\n") } else { text };
    Ok((text, encoding))
}

/// Zeros, and only there, in every second byte from `first`.
fn zeros(bytes: &[u8], first: usize) -> bool {
    let pairs = bytes[..bytes.len().min(LOOKED_AT)].chunks_exact(2);
    pairs.len() >= 2 && pairs.into_iter().all(|pair| pair[first] == 0 && pair[1 - first] != 0)
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String, FileFault> {
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    let damaged = || "the file is no text: its UTF-16 is damaged".into();
    if bytes.len() % 2 == 1 {
        return Err(damaged());
    }
    char::decode_utf16(units).collect::<Result<_, _>>().map_err(|_| damaged())
}
