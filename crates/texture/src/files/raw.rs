//! Numbers out of bytes, little endian: headers, and heights of every type that the formats have.

use crate::error::FileFault;

/// Reads numbers from bytes, little endian; running out of them is an error that names the place.
pub(super) struct Bytes<'a>(pub(super) &'a [u8]);

impl<'a> Bytes<'a> {
    pub(super) fn at(&self, start: usize, length: usize) -> Result<&'a [u8], FileFault> {
        start.checked_add(length).and_then(|end| self.0.get(start..end)).ok_or_else(|| {
            let (end, until) = (self.0.len(), start + length);
            format!("the file ends at byte {end} before what must be at {start} to {until}").into()
        })
    }

    pub(super) fn array<const N: usize>(&self, start: usize) -> Result<[u8; N], FileFault> {
        Ok(self.at(start, N)?.try_into().expect("a slice of N bytes"))
    }

    pub(super) fn u16(&self, start: usize) -> Result<u16, FileFault> {
        Ok(u16::from_le_bytes(self.array(start)?))
    }

    pub(super) fn i16(&self, start: usize) -> Result<i16, FileFault> {
        Ok(i16::from_le_bytes(self.array(start)?))
    }

    pub(super) fn i32(&self, start: usize) -> Result<i32, FileFault> {
        Ok(i32::from_le_bytes(self.array(start)?))
    }

    pub(super) fn u32(&self, start: usize) -> Result<u32, FileFault> {
        Ok(u32::from_le_bytes(self.array(start)?))
    }

    pub(super) fn f32(&self, start: usize) -> Result<f32, FileFault> {
        Ok(f32::from_le_bytes(self.array(start)?))
    }

    pub(super) fn f64(&self, start: usize) -> Result<f64, FileFault> {
        Ok(f64::from_le_bytes(self.array(start)?))
    }
}

/// Number types of raw heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Raw {
    U8,
    U16,
    U32,
    I8,
    I16,
    I32,
    F32,
    F64,
}

impl Raw {
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Little-endian values; `count` of them must be there.
    pub(super) fn values(self, bytes: &[u8], count: usize) -> Result<Vec<f64>, FileFault> {
        let size = self.bytes();
        let wanted = count.checked_mul(size).ok_or("the size in the header is too large")?;
        if bytes.len() < wanted {
            return Err(format!("{count} heights need {wanted} bytes, but only {} are there", bytes.len()).into());
        }
        let value = |raw: &[u8]| match (self, raw) {
            (Self::U8, &[a]) => f64::from(a),
            (Self::U16, &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
            (Self::U32, &[a, b, c, d]) => f64::from(u32::from_le_bytes([a, b, c, d])),
            (Self::I8, &[a]) => f64::from(i8::from_le_bytes([a])),
            (Self::I16, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
            (Self::I32, &[a, b, c, d]) => f64::from(i32::from_le_bytes([a, b, c, d])),
            (Self::F32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            (Self::F64, &[a, b, c, d, e, f, g, h]) => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
            _ => f64::NAN,
        };
        Ok(bytes[..wanted].chunks_exact(size).map(value).collect())
    }

    /// The smallest value of a type with sign: how SDF marks what was not measured. Types without sign have no mark:
    /// their smallest value is a height.
    pub(super) fn mark_of_holes(self) -> Option<f64> {
        match self {
            Self::U8 | Self::U16 | Self::U32 => None,
            Self::I8 => Some(f64::from(i8::MIN)),
            Self::I16 => Some(f64::from(i16::MIN)),
            Self::I32 => Some(f64::from(i32::MIN)),
            Self::F32 => Some(f64::from(f32::MIN)),
            Self::F64 => Some(f64::MIN),
        }
    }
}
