//! A browser has no files, so none of its builds has the codec of OpenEXR, whose vectors not every browser knows.

use super::ExrMap;
use crate::error::FileFault;

const WHY: &str = "this build, for browsers, has no OpenEXR";

pub(super) fn encode(_: &ExrMap) -> Result<Vec<u8>, FileFault> {
    Err(WHY.into())
}

pub(in crate::files) fn decode(_: &[u8]) -> Result<ExrMap, FileFault> {
    Err(WHY.into())
}
