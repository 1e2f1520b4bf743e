//! What a file is: by its first bytes, and by its ending where it is text.

use crate::error::FileFault;
use std::path::Path;

use super::bounds::{MOST_BYTES_OF_MAPS, MOST_BYTES_OF_NUMBERS, MOST_BYTES_OF_TEXT};

/// Formats that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FileKind {
    X3p,
    SdfBinary,
    SdfAscii,
    Sur,
    Gwy,
    Al3d,
    Npy,
    Exr,
    Text,
}

/// First bytes of what is read.
const STARTS: [(&[u8], FileKind); 11] = [
    (b"PK\x03\x04", FileKind::X3p),
    (b"bISO-", FileKind::SdfBinary),
    (b"bBCR-", FileKind::SdfBinary),
    (b"aISO-", FileKind::SdfAscii),
    (b"aBCR-", FileKind::SdfAscii),
    (b"DIGITAL SURF", FileKind::Sur),
    (b"DSCOMPRESSED", FileKind::Sur),
    (b"GWYP", FileKind::Gwy),
    (b"AliconaImaging", FileKind::Al3d),
    (b"\x93NUMPY", FileKind::Npy),
    (&[0x76, 0x2f, 0x31, 0x01], FileKind::Exr),
];

/// Endings of text.
const TEXT: [&str; 7] = ["csv", "txt", "asc", "xyz", "tsv", "prn", "dat"];

/// First bytes of instruments' formats that are known and not read: nothing was at hand to hold their heights against.
const INSTRUMENTS: [(&[u8], &str); 9] = [
    (&[0x88, 0x1b, 0x03, 0x6f], "a Zygo MetroPro file (DAT)"),
    (&[0x88, 0x1b, 0x03, 0x70], "a Zygo MetroPro file (DAT)"),
    (&[0x88, 0x1b, 0x03, 0x71], "a Zygo MetroPro file (DAT)"),
    (b"\x89HDF", "an HDF5 file, as Zygo's DATX is"),
    (&[1, 0, b'D', b'i', b'r', b'e', b'c', b't', b'o', b'r', b'y'], "a Wyko file (OPD)"),
    (b"VK4", "a Keyence file (VK4)"),
    (b"VK6", "a Keyence file (VK6)"),
    (b"VK7", "a Keyence file (VK7)"),
    (b"KPK0", "a Keyence file (ZAG or ZON)"),
];
/// Endings of such formats without a mark of their own.
const INSTRUMENT_ENDINGS: [(&str, &str); 6] = [
    ("plu", "a Sensofar file (PLU)"),
    ("plux", "a Sensofar file (PLUX)"),
    ("nms", "a NanoFocus file (NMS)"),
    ("zag", "a Keyence file (ZAG)"),
    ("opd", "a Wyko file (OPD)"),
    ("datx", "a Zygo file (DATX)"),
];

impl FileKind {
    /// Of the first bytes of a file.
    pub(super) fn of(head: &[u8], path: &Path) -> Result<Self, FileFault> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let instrument = INSTRUMENTS.iter().find(|(start, _)| head.starts_with(start)).map(|(_, what)| what);
        let by_ending = || INSTRUMENT_ENDINGS.iter().find(|(known, _)| *known == ending).map(|(_, what)| what);
        if let Some(what) = instrument.or_else(by_ending) {
            return Err(FileFault::NotRead(format!(
                "it is {what}, which is not read: save it as X3P where it was measured, or convert it (docs/howto.md)"
            )));
        }
        // Text may begin with a byte order mark or blank lines.
        let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
        let starts = |(start, kind): &&(&[u8], Self)| {
            if *kind == Self::SdfAscii { text.starts_with(start) } else { head.starts_with(start) }
        };
        if let Some((_, kind)) = STARTS.iter().find(starts) {
            Ok(*kind)
        } else if TEXT.contains(&ending.as_str()) {
            Ok(Self::Text)
        } else {
            Err(format!(
                "not an X3P, SDF, SUR, GWY, AL3D, NPY, EXR or text file; text has one of the endings {}",
                TEXT.join(", ")
            )
            .into())
        }
    }

    /// What the format is called.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::X3p => "X3P",
            Self::SdfBinary | Self::SdfAscii => "SDF",
            Self::Sur => "SUR",
            Self::Gwy => "GWY",
            Self::Al3d => "AL3D",
            Self::Npy => "NPY",
            Self::Exr => "EXR",
            Self::Text => "text",
        }
    }

    /// Most bytes that a surface of this kind can have.
    pub(super) fn most_bytes(self) -> u64 {
        match self {
            Self::X3p | Self::SdfBinary | Self::Sur | Self::Npy | Self::Gwy | Self::Al3d => MOST_BYTES_OF_NUMBERS,
            Self::Exr => MOST_BYTES_OF_MAPS,
            Self::SdfAscii | Self::Text => MOST_BYTES_OF_TEXT,
        }
    }
}
