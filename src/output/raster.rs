//! A picture in memory.
//!
//! In: pixels, 8 bits of red, green and blue each. Out: PNG bytes, the same for the same pixels.
//!
//! Maps, sheets and charts have a few hundred colours: those of the scale, and where letters fade into the paper. They
//! are written as numbers of 256 colours, a fifth of the bytes. The most frequent stay what they are; of the others one
//! stands for those that are within 4 of 255 in every channel. Drawn bodies keep all their colours.

use std::collections::HashMap;

use png::{BitDepth, ColorType, Compression, DeflateCompression, Encoder, Filter};

/// Colours that a byte can number.
const NUMBERED: usize = 256;
/// More colours than this belong to a drawn body.
const OF_MAPS: usize = 4096;
/// Most frequent colours that stay what they are.
const EXACT: usize = 128;
/// How far another colour may be moved to be numbered, of 255: not seen, at the edges of letters least of all. Maps,
/// sheets and charts of a shaped gear need 170 to 256 colours then.
const NEAREST: u8 = 4;
/// Level of deflate for numbers, which have no filter: higher ones take longer and save nothing.
const NUMBERS_LEVEL: u8 = 6;

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
    /// Fast compression of drawn bodies: the last tenth of their bytes would take five times as long. One filter for
    /// all rows makes equal rows and slow changes zeros; a choice row by row takes nearly twice as long for a twentieth
    /// of the bytes.
    pub(super) fn png(&self) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, self.size_px.0, self.size_px.1);
        encoder.set_depth(BitDepth::Eight);
        let numbered = numbered(&self.rgb);
        let data = if let Some((colours, numbers)) = &numbered {
            encoder.set_color(ColorType::Indexed);
            encoder.set_palette(colours.as_flattened());
            encoder.set_deflate_compression(DeflateCompression::Level(NUMBERS_LEVEL));
            encoder.set_filter(Filter::NoFilter);
            numbers
        } else {
            encoder.set_color(ColorType::Rgb);
            encoder.set_compression(Compression::Fast);
            encoder.set_filter(Filter::Paeth);
            &self.rgb
        };
        let mut writer = encoder.write_header().map_err(|error| error.to_string())?;
        writer.write_image_data(data).map_err(|error| error.to_string())?;
        writer.finish().map_err(|error| error.to_string())?;
        Ok(bytes)
    }
}

/// The most frequent colours and the number of every pixel's; none where they stand for the picture too badly.
fn numbered(rgb: &[u8]) -> Option<(Vec<[u8; 3]>, Vec<u8>)> {
    let (pixels, _) = rgb.as_chunks::<3>();
    let runs = || pixels.chunk_by(|a, b| a == b);
    let mut counts: HashMap<[u8; 3], usize> = HashMap::new();
    for run in runs() {
        *counts.entry(run[0]).or_default() += run.len();
        if counts.len() > OF_MAPS {
            return None;
        }
    }
    let mut colours: Vec<([u8; 3], usize)> = counts.into_iter().collect();
    colours.sort_unstable_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    let all: Vec<[u8; 3]> = colours.iter().map(|(colour, _)| *colour).collect();
    let off = |a: [u8; 3], b: [u8; 3]| (0..3).map(|k| a[k].abs_diff(b[k])).max().unwrap_or_default();
    let exact = if all.len() <= NUMBERED { NUMBERED } else { EXACT };
    let mut kept: Vec<[u8; 3]> = Vec::with_capacity(NUMBERED);
    let mut numbers: HashMap<[u8; 3], u8> = HashMap::new();
    for colour in all {
        let nearest = (0..=u8::MAX).zip(&kept).min_by_key(|(_, of)| off(**of, colour));
        let near = nearest.filter(|(_, of)| kept.len() >= exact && off(**of, colour) <= NEAREST);
        let number = near.map_or_else(|| u8::try_from(kept.len()).ok(), |(number, _)| Some(number))?;
        if near.is_none() {
            kept.push(colour);
        }
        numbers.insert(colour, number);
    }
    let of_pixels = runs().flat_map(|run| std::iter::repeat_n(numbers[&run[0]], run.len())).collect();
    Some((kept, of_pixels))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of so many greens and blues, in stripes ten pixels wide, the first colours more often.
    fn striped(colours: u32) -> Raster {
        let mut raster = Raster::white((400, 300));
        for i in 0..400 * 300 {
            let stripe = i / 10 % (colours + 64) % colours;
            raster.set(i % 400, i / 400, [7, (stripe / 8) as u8, (stripe % 8 * 3) as u8]);
        }
        raster
    }

    fn read(raster: &Raster) -> (Vec<u8>, usize) {
        let bytes = raster.png().expect("a picture");
        let mut decoder = png::Decoder::new(std::io::Cursor::new(&bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().expect("a PNG");
        let mut rgb = vec![0; reader.output_buffer_size().expect("it fits into memory")];
        let read = reader.next_frame(&mut rgb).expect("a whole picture");
        assert_eq!((read.width, read.height), raster.size_px);
        (rgb, bytes.len())
    }

    #[test]
    fn pictures_of_few_colours_are_numbered_and_exact() {
        let raster = striped(256);
        let (rgb, bytes) = read(&raster);
        assert_eq!(rgb, raster.rgb);
        assert!(raster.png().expect("a picture")[25] == 3 && bytes < 20_000, "{bytes} bytes");
    }

    #[test]
    fn rare_colours_become_near_ones_and_many_stay_what_they_are() {
        let raster = striped(280);
        let (rgb, _) = read(&raster);
        let moved = rgb.iter().zip(&raster.rgb).map(|(a, b)| a.abs_diff(*b));
        assert!(moved.clone().any(|by| by > 0) && moved.clone().all(|by| by <= NEAREST));
        // Colours far from each other are more than can be numbered.
        let raster = striped(2040);
        assert_eq!(read(&raster).0, raster.rgb);
        assert_eq!(raster.png().expect("a picture")[25], 2);
    }
}
