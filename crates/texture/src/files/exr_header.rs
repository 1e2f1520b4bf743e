//! One order for the attributes of an EXR header.
//!
//! In: the bytes of a single-part EXR file. Out: the same file with its header attributes sorted by name.
//!
//! The crate that writes EXR keeps free attributes in a hash map, whose order changes from run to run. Readers do not
//! care, but "same scene, same bytes" does. Sorting moves whole attributes inside the header and changes no length, so
//! every offset in the file stays right.
//!
//! Layout (OpenEXR file layout, "Header"): magic number and version, 4 bytes each; then attributes, each a
//! null-terminated name, a null-terminated type, the value's length as i32 (little endian) and the value; then one null
//! byte.

use crate::error::FileFault;

/// Where the first attribute begins: behind magic number and version.
const HEADER_START: usize = 8;

/// Sorts the attributes of the first header in place.
pub(super) fn sort_attributes(file: &mut [u8]) -> Result<(), FileFault> {
    let mut attributes: Vec<&[u8]> = Vec::new();
    let mut rest = file.get(HEADER_START..).ok_or("an EXR file is longer than this")?;
    while rest.first().is_some_and(|&first| first != 0) {
        let length = attribute_length(rest).ok_or("the EXR header ends early")?;
        let (attribute, behind) = rest.split_at(length);
        attributes.push(attribute);
        rest = behind;
    }
    // Names are unique and end with a null byte, so that comparing whole attributes compares names.
    attributes.sort_unstable();
    let sorted = attributes.concat();
    file[HEADER_START..HEADER_START + sorted.len()].copy_from_slice(&sorted);
    Ok(())
}

/// Bytes that the attribute at the start of `bytes` takes; none if it does not end there.
fn attribute_length(bytes: &[u8]) -> Option<usize> {
    let name_end = bytes.iter().position(|&byte| byte == 0)? + 1;
    let type_end = name_end + bytes[name_end..].iter().position(|&byte| byte == 0)? + 1;
    let value_start = type_end + 4;
    let value_length = i32::from_le_bytes(bytes.get(type_end..value_start)?.try_into().ok()?);
    let length = value_start.checked_add(usize::try_from(value_length).ok()?)?;
    (length <= bytes.len()).then_some(length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_are_sorted_and_nothing_else_moves() {
        let attribute = |name: &str, value: &[u8]| {
            let length = i32::try_from(value.len()).expect("short").to_le_bytes();
            [name.as_bytes(), b"\0string\0", &length, value].concat()
        };
        let (a, ab, b) = (attribute("a", b"\0z\0"), attribute("ab", b""), attribute("b", b"first"));
        let around = |header: &[Vec<u8>]| [b"magicver".to_vec(), header.concat(), b"\0pixels".to_vec()].concat();
        let mut file = around(&[b.clone(), ab.clone(), a.clone()]);
        sort_attributes(&mut file).expect("a sound header");
        assert_eq!(file, around(&[a, ab, b]));
    }

    #[test]
    fn a_header_that_ends_early_is_an_error() {
        assert!(sort_attributes(&mut [0; 4]).is_err());
        assert!(sort_attributes(b"magicverbroken".to_vec().as_mut_slice()).is_err());
    }
}
