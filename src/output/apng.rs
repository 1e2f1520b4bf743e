//! Pictures that follow each other, as one animated PNG.
//!
//! In: frames of equal size. Out: an APNG that browsers and most viewers play, and others show as its first frame.

use crate::output::atomic::write_atomically;
use crate::output::raster::Raster;
use gearcut_core::{Error, Result};
use std::io;
use std::path::Path;

/// A frame: a finished picture with its title and scale bar.
pub struct AnimationFrame(pub(super) Raster);

/// Writes frames that each stay for `frame_ms` milliseconds, the last one `hold_ms`, over and over.
///
/// # Errors
/// No frame, frames of different sizes, and files that cannot be written.
pub fn write_apng(path: &Path, frames: &[AnimationFrame], frame_ms: u16, hold_ms: u16) -> Result<()> {
    let refused = |reason: &str| Err(Error::Output { path: path.to_owned(), reason: reason.to_owned() });
    let Some(AnimationFrame(first)) = frames.first() else { return refused("there is no frame") };
    if frames.iter().any(|AnimationFrame(frame)| frame.size_px != first.size_px) {
        return refused("frames have different sizes");
    }
    write_atomically(path, |sink| {
        let mut encoder = png::Encoder::new(sink, first.size_px.0, first.size_px.1);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_filter(png::Filter::Adaptive);
        encoder.set_animated(frames.len() as u32, 0).map_err(io::Error::other)?;
        encoder.set_frame_delay(frame_ms, 1000).map_err(io::Error::other)?;
        let mut writer = encoder.write_header().map_err(io::Error::other)?;
        for (index, AnimationFrame(frame)) in frames.iter().enumerate() {
            if index + 1 == frames.len() {
                writer.set_frame_delay(hold_ms, 1000).map_err(io::Error::other)?;
            }
            writer.write_image_data(&frame.rgb).map_err(io::Error::other)?;
        }
        writer.finish().map_err(io::Error::other)
    })
}
