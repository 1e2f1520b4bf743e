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

    /// Picture of half the size, each pixel the mean of four; smooths what was drawn at twice the size.
    pub(super) fn halved(&self) -> Self {
        let (width, height) = (self.size_px.0 / 2, self.size_px.1 / 2);
        let row_bytes = self.size_px.0 as usize * 3;
        let mut half = Self::white((width, height));
        for (y, row) in half.rgb.chunks_exact_mut(width as usize * 3).enumerate() {
            for (i, value) in row.iter_mut().enumerate() {
                let at = 2 * y * row_bytes + (i / 3) * 6 + i % 3;
                let sum: u16 =
                    [at, at + 3, at + row_bytes, at + row_bytes + 3].map(|k| u16::from(self.rgb[k])).iter().sum();
                *value = ((sum + 2) / 4) as u8;
            }
        }
        half
    }

    /// The picture as a PNG file.
    ///
    /// Fast compression: a gear has a thousand pictures, and the last tenth of their bytes would take five times as
    /// long. The filter is chosen row by row: equal rows and slow changes both become zeros.
    pub(super) fn png(&self) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive)
            .write_image(&self.rgb, self.size_px.0, self.size_px.1, ExtendedColorType::Rgb8)
            .map_err(|error| error.to_string())?;
        Ok(bytes)
    }
}
