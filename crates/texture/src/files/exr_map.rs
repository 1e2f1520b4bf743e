//! Maps as 32-bit OpenEXR: lengths to a nanometre, named channels, and a header that explains them.
//!
//! In: a grid, channels of f32 or u32 with unit and definition, the frame, and notes such as the scene and the run
//! record. Out: one scan-line EXR with lossless ZIP compression, row = u (first row = first u), column = v; and back
//! again.
//!
//! Header attributes: `program`, `frame`; per axis `u.name`, `u.meaning`, `u.start_mm`, `u.step_mm` and the same for v;
//! per channel `channel.<name>.unit` and `.definition`; every note under its own name. Texts are UTF-8. The same map
//! gives the same bytes.
//!
//! Road not taken: one EXR with a layer per surface. A viewer would open 84 layers to show one, and a run could not
//! write one and forget it before the next.

use super::kind::FileKind;
use crate::error::FileFault;
use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    LineOrder, ReadChannels, ReadLayers, SmallVec, Text, WritableImage,
};

use super::bounds::{self, MOST_BYTES_OF_MAPS, unreadable, values};
use super::exr_header::sort_attributes;
use super::grid::{MapAxis, MapGrid};
use crate::atomic::write_bytes_atomically;
use crate::{Error, Result};

/// Values of one channel, in the grid's order.
#[derive(Debug, Clone, PartialEq)]
pub enum Samples {
    /// Measured values; NaN where there is none.
    F32(Vec<f32>),
    /// Identifiers and counts.
    U32(Vec<u32>),
}

impl Samples {
    fn count(&self) -> usize {
        match self {
            Self::F32(values) => values.len(),
            Self::U32(values) => values.len(),
        }
    }
}

/// One named channel of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapChannel {
    /// Name with the unit as suffix where there is one, such as `height_mm`.
    pub name: String,
    /// Unit, such as `mm`; `1` for identifiers and counts.
    pub unit: String,
    /// What the values are, in a sentence.
    pub definition: String,
    /// The values.
    pub samples: Samples,
}

impl MapChannel {
    /// Lengths in mm; NaN where there is none. Below 16 mm they are rounded to whole 2^-20 mm (0.95 nm): f32 has
    /// further digits there, which mean nothing and are two thirds of a packed file.
    pub fn lengths_mm(name: &str, definition: &str, values: &[f32]) -> Self {
        Self::rounded_mm(name, definition, values, (1 << 20) as f32)
    }

    /// Lengths in mm that are not known to a nanometre, such as the thickness of a chip: as [`Self::lengths_mm`], in
    /// whole 2^-17 mm (7.6 nm).
    pub fn coarse_lengths_mm(name: &str, definition: &str, values: &[f32]) -> Self {
        Self::rounded_mm(name, definition, values, (1 << 17) as f32)
    }

    fn rounded_mm(name: &str, definition: &str, values: &[f32], per_mm: f32) -> Self {
        let rounded = |&mm: &f32| if mm.abs() < 16.0 { (mm * per_mm).round_ties_even() / per_mm } else { mm };
        Self {
            name: name.to_owned(),
            unit: "mm".to_owned(),
            definition: definition.to_owned(),
            samples: Samples::F32(values.iter().map(rounded).collect()),
        }
    }
}

/// A map with everything needed to understand it.
#[derive(Debug, Clone, PartialEq)]
pub struct ExrMap {
    /// Where the values lie.
    pub grid: MapGrid,
    /// Frame that u and v are measured in, in a sentence.
    pub frame: String,
    /// Channels, sorted by name (the format asks for it).
    pub channels: Vec<MapChannel>,
    /// Further header texts by name, sorted by name: `scene`, `run` and the like.
    pub notes: Vec<(String, String)>,
}

/// Writes a map.
///
/// # Errors
/// Values that do not fill the grid, no channels, header names used twice, and files that cannot be written.
pub fn write_exr_map(path: &Path, map: &ExrMap) -> Result<()> {
    let bytes = encode(map).map_err(|fault| Error::Unwritable { path: path.to_owned(), fault })?;
    write_bytes_atomically(path, &bytes)
}

/// Reads a map that [`write_exr_map`] wrote.
///
/// # Errors
/// Files that cannot be read, are damaged, or were written by another program.
pub fn read_exr_map(path: &Path) -> Result<ExrMap> {
    let ((), bytes) = bounds::read(path, |_| Ok(((), MOST_BYTES_OF_MAPS)))?;
    decode(&bytes).map_err(unreadable(path, Some(FileKind::Exr.name())))
}

fn encode(map: &ExrMap) -> std::result::Result<Vec<u8>, FileFault> {
    let mut header = Header::default();
    header.text("program", "gearcut")?;
    header.text("frame", &map.frame)?;
    for (key, axis) in [("u", &map.grid.u), ("v", &map.grid.v)] {
        header.text(&format!("{key}.name"), &axis.name)?;
        header.text(&format!("{key}.meaning"), &axis.meaning)?;
        header.add(&format!("{key}.start_mm"), AttributeValue::F64(axis.start_mm))?;
        header.add(&format!("{key}.step_mm"), AttributeValue::F64(axis.step_mm))?;
    }
    let mut channels = SmallVec::new();
    for channel in &map.channels {
        if let Some(mismatch) = map.grid.mismatch(channel.samples.count()) {
            return Err(format!("channel {}: {mismatch}", channel.name).into());
        }
        header.text(&format!("channel.{}.unit", channel.name), &channel.unit)?;
        header.text(&format!("channel.{}.definition", channel.name), &channel.definition)?;
        let samples = match &channel.samples {
            Samples::F32(values) => FlatSamples::F32(values.clone()),
            Samples::U32(values) => FlatSamples::U32(values.clone()),
        };
        channels.push(AnyChannel::new(utf8(&channel.name), samples));
    }
    for (name, text) in &map.notes {
        header.text(name, text)?;
    }
    if channels.is_empty() {
        return Err("a map needs at least one channel".into());
    }
    let encoding =
        Encoding { compression: Compression::ZIP16, line_order: LineOrder::Increasing, ..Encoding::UNCOMPRESSED };
    let attributes = LayerAttributes { other: header.0, ..LayerAttributes::default() };
    let size = (map.grid.v.count, map.grid.u.count);
    let image = Image::from_layer(Layer::new(size, attributes, encoding, AnyChannels::sort(channels)));
    let mut bytes = Vec::new();
    // Maps are written from several threads already: the crate's own threads would only compete with them.
    image.write().non_parallel().to_buffered(Cursor::new(&mut bytes)).map_err(|error| error.to_string())?;
    sort_attributes(&mut bytes)?;
    Ok(bytes)
}

/// Attributes on their way into a file; a name cannot be used twice.
#[derive(Default)]
struct Header(HashMap<Text, AttributeValue>);

impl Header {
    fn text(&mut self, name: &str, text: &str) -> std::result::Result<(), FileFault> {
        self.add(name, AttributeValue::Text(utf8(text)))
    }

    fn add(&mut self, name: &str, value: AttributeValue) -> std::result::Result<(), FileFault> {
        match self.0.insert(utf8(name), value) {
            None => Ok(()),
            Some(_) => Err(format!("the header name `{name}` is used twice").into()),
        }
    }
}

/// EXR texts are bytes; the crate's own conversion would refuse everything beyond Latin-1.
fn utf8(text: &str) -> Text {
    Text::from_bytes_unchecked(SmallVec::from_slice(text.as_bytes()))
}

pub(super) fn decode(bytes: &[u8]) -> std::result::Result<ExrMap, FileFault> {
    // The crate takes the memory that the header asks for before it looks at the pixels.
    let headers = exr::meta::MetaData::read_from_buffered(bytes, false).map_err(|error| error.to_string())?.headers;
    for header in &headers {
        values(header.layer_size.x(), header.layer_size.y(), header.channels.list.len().max(1))?;
    }
    let image = exr::prelude::ReadImage::from_buffered(
        exr::image::read::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .non_parallel(),
        Cursor::new(bytes),
    )
    .map_err(|error| error.to_string())?;
    let layer = image.layer_data;
    let mut header = layer.attributes.other;
    if take_text(&mut header, "program").as_deref() != Ok("gearcut") {
        return Err("gearcut did not write this EXR file".into());
    }
    let frame = take_text(&mut header, "frame")?;
    let grid =
        MapGrid { u: take_axis(&mut header, "u", layer.size.y())?, v: take_axis(&mut header, "v", layer.size.x())? };
    let mut channels = Vec::new();
    for channel in layer.channel_data.list {
        let name = channel.name.to_string();
        let samples = match channel.sample_data {
            FlatSamples::F32(values) => Samples::F32(values),
            FlatSamples::U32(values) => Samples::U32(values),
            FlatSamples::F16(_) => return Err(format!("channel {name} has 16-bit values").into()),
        };
        channels.push(MapChannel {
            unit: take_text(&mut header, &format!("channel.{name}.unit"))?,
            definition: take_text(&mut header, &format!("channel.{name}.definition"))?,
            name,
            samples,
        });
    }
    let mut notes: Vec<(String, String)> = header
        .into_iter()
        .filter_map(|(name, value)| match value {
            AttributeValue::Text(text) => Some((from_utf8(&name), from_utf8(&text))),
            _ => None,
        })
        .collect();
    notes.sort();
    Ok(ExrMap { grid, frame, channels, notes })
}

fn take_axis(
    header: &mut HashMap<Text, AttributeValue>,
    key: &str,
    count: usize,
) -> std::result::Result<MapAxis, FileFault> {
    let mut number = |name: &str| match header.remove(&utf8(&format!("{key}.{name}"))) {
        Some(AttributeValue::F64(value)) => Ok(value),
        _ => Err(FileFault::Malformed(format!("the header has no number `{key}.{name}`"))),
    };
    let (start_mm, step_mm) = (number("start_mm")?, number("step_mm")?);
    let name = take_text(header, &format!("{key}.name"))?;
    let meaning = take_text(header, &format!("{key}.meaning"))?;
    Ok(MapAxis { name, meaning, start_mm, step_mm, count })
}

fn take_text(header: &mut HashMap<Text, AttributeValue>, name: &str) -> std::result::Result<String, FileFault> {
    match header.remove(&utf8(name)) {
        Some(AttributeValue::Text(text)) => Ok(from_utf8(&text)),
        _ => Err(format!("the header has no text `{name}`").into()),
    }
}

fn from_utf8(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}
