//! Maps as the bytes of an OpenEXR file, and back; what is in them: [`super`].

use crate::error::FileFault;
use std::collections::HashMap;
use std::io::Cursor;

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    LineOrder, ReadChannels, ReadLayers, SmallVec, Text, WritableImage,
};

use super::{ExrMap, MapChannel, Samples};
use crate::files::bounds::MOST_VALUES;
use crate::files::exr_header::sort_attributes;
use crate::files::grid::{MapAxis, MapGrid};

impl Samples {
    fn count(&self) -> usize {
        match self {
            Self::F32(values) => values.len(),
            Self::U32(values) => values.len(),
        }
    }
}

/// Refuses a map whose header declares too many values.
fn values(nx: usize, ny: usize, channels: usize) -> Result<(), FileFault> {
    let count = nx.checked_mul(ny).and_then(|count| count.checked_mul(channels));
    count.filter(|&count| count <= MOST_VALUES).map(drop).ok_or_else(|| {
        FileFault::TooLarge(format!(
            "the header declares {nx} x {ny} points in {channels} channels, more than {MOST_VALUES} values: write the \
             map on a wider grid"
        ))
    })
}

pub(super) fn encode(map: &ExrMap) -> Result<Vec<u8>, FileFault> {
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
    fn text(&mut self, name: &str, text: &str) -> Result<(), FileFault> {
        self.add(name, AttributeValue::Text(utf8(text)))
    }

    fn add(&mut self, name: &str, value: AttributeValue) -> Result<(), FileFault> {
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

pub(in crate::files) fn decode(bytes: &[u8]) -> Result<ExrMap, FileFault> {
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

fn take_axis(header: &mut HashMap<Text, AttributeValue>, key: &str, count: usize) -> Result<MapAxis, FileFault> {
    let mut number = |name: &str| match header.remove(&utf8(&format!("{key}.{name}"))) {
        Some(AttributeValue::F64(value)) => Ok(value),
        _ => Err(FileFault::Malformed(format!("the header has no number `{key}.{name}`"))),
    };
    let (start_mm, step_mm) = (number("start_mm")?, number("step_mm")?);
    let name = take_text(header, &format!("{key}.name"))?;
    let meaning = take_text(header, &format!("{key}.meaning"))?;
    Ok(MapAxis { name, meaning, start_mm, step_mm, count })
}

fn take_text(header: &mut HashMap<Text, AttributeValue>, name: &str) -> Result<String, FileFault> {
    match header.remove(&utf8(name)) {
        Some(AttributeValue::Text(text)) => Ok(from_utf8(&text)),
        _ => Err(format!("the header has no text `{name}`").into()),
    }
}

fn from_utf8(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}
