//! A picture in memory.
//!
//! In: pixels, 8 bits of red, green and blue each. Out: PNG bytes, the same for the same pixels.

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

/// RGB pixels, rows from the top.
pub(super) struct Raster {
    /// Width and height, pixels.
    pub size_px: (u32, u32),
    /// Three bytes per pixel.
    pub rgb: Vec<u8>,
}

impl Raster {
    /// White picture.
    pub(super) fn white(size_px: (u32, u32)) -> Self {
        Self { size_px, rgb: vec![255; size_px.0 as usize * size_px.1 as usize * 3] }
    }

    /// Sets one pixel, which must lie inside.
    pub(super) fn set(&mut self, x: u32, y: u32, colour: [u8; 3]) {
        let start = (y as usize * self.size_px.0 as usize + x as usize) * 3;
        self.rgb[start..start + 3].copy_from_slice(&colour);
    }

    /// Darkens (`light` below 1) or lightens (above 1) one pixel, which must lie inside.
    pub(super) fn shade(&mut self, x: u32, y: u32, light: f32) {
        let start = (y as usize * self.size_px.0 as usize + x as usize) * 3;
        for value in &mut self.rgb[start..start + 3] {
            let colour = f32::from(*value);
            let shaded = if light <= 1.0 { colour * light } else { colour + (255.0 - colour) * (light - 1.0) };
            *value = shaded.round().clamp(0.0, 255.0) as u8;
        }
    }

    /// Mixes a colour into one pixel, of which it covers the part 0 to 1; nothing where the pixel lies outside.
    pub(super) fn blend(&mut self, (x, y): (i32, i32), colour: [u8; 3], part: f64) {
        let (width, height) = self.size_px;
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return };
        if x >= width || y >= height || part <= 0.0 {
            return;
        }
        if part >= 1.0 - 1.0 / 256.0 {
            return self.set(x, y, colour);
        }
        let weight = (part * 256.0) as u16;
        let start = (y as usize * width as usize + x as usize) * 3;
        for (value, new) in self.rgb[start..start + 3].iter_mut().zip(colour) {
            let change = (u16::from(value.abs_diff(new)) * weight / 256) as u8;
            *value = if new > *value { *value + change } else { *value - change };
        }
    }

    /// The picture as a PNG file.
    ///
    /// Fast compression: a gear has a thousand pictures, and the last tenth of their bytes would take five times as
    /// long. One filter for all rows makes equal rows and slow changes zeros; a choice row by row takes nearly twice as
    /// long for a twentieth of the bytes.
    pub(super) fn png(&self) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Paeth)
            .write_image(&self.rgb, self.size_px.0, self.size_px.1, ExtendedColorType::Rgb8)
            .map_err(|error| error.to_string())?;
        Ok(bytes)
    }
}
