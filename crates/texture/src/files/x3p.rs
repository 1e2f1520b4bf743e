//! X3P (ISO 25178-72:2017): a zip with an XML record, heights as raw numbers, and checksums.
//!
//! Written so that every reader that was tried opens it: heights as f64 in metres, deflated; revision `ISO5436 -
//! 2000`; MD5 of `main.xml` in lower case; NaN for what was not measured. Record 2 carries the notes in its comment.
//! The format demands dates: the epoch stands for "not recorded", because the same scene must give the same bytes.
//!
//! Read: types D, F, L and I (with increment and offset), validity bits, both revisions. A checksum of `data.bin` where
//! one of `main.xml` should stand is accepted, because a common writer puts it there.

use std::fmt::{Display, Write as _};
use std::io::{Cursor, Read, Write};

use md5::{Digest, Md5};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

use super::bounds::{factor, kept_number, points};
use super::{Raw, SurfaceFile, notes_json, notes_of};
use crate::surface::Surface;
use crate::text::quoted;

const MAIN: &str = "main.xml";
const DATA: &str = "bindata/data.bin";
const CHECKSUM: &str = "md5checksum.hex";
const NOT_RECORDED: &str = "1970-01-01T00:00:00Z";
/// Namespace of ISO 25178-72, named after the standard before it; its schema stands under it.
const NAMESPACE: &str = "http://www.opengps.eu/2008/ISO5436_2";
/// Namespace of schema instances.
const INSTANCE: &str = "http://www.w3.org/2001/XMLSchema-instance";
/// Most bytes of the XML record: notes hold a scene and the record of a run.
const MOST_MAIN: usize = 16 << 20;
/// Most bytes of the file with the checksum.
const MOST_CHECKSUM: usize = 4 << 10;
/// Micrometres in a metre.
const UM_PER_M: f64 = 1e6;

/// Level of deflate: last bits of heights are noise, and more work on them than this takes twice the time for files
/// that are 3 % smaller.
const LEVEL: i64 = 4;

pub(super) fn encode(file: &SurfaceFile) -> Result<Vec<u8>, String> {
    let heights = file.surface.heights_um().iter();
    let data: Vec<u8> = heights.flat_map(|z| (z / UM_PER_M).to_le_bytes()).collect();
    let main = main_xml(file, &hex(&data).to_uppercase());
    let checksum = format!("{} *{MAIN}\n", hex(main.as_bytes()));
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(LEVEL))
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    for (name, bytes) in [(MAIN, main.as_bytes()), (DATA, &data), (CHECKSUM, checksum.as_bytes())] {
        zip.start_file(name, options).map_err(|reason| reason.to_string())?;
        zip.write_all(bytes).map_err(|reason| reason.to_string())?;
    }
    Ok(zip.finish().map_err(|reason| reason.to_string())?.into_inner())
}

fn main_xml(file: &SurfaceFile, data_checksum: &str) -> String {
    let surface = &file.surface;
    let axis = |name: &str, spacing_um: f64| {
        format!(
            "      <{name}>\n        <AxisType>I</AxisType>\n        <DataType>D</DataType>\n        \
             <Increment>{:e}</Increment>\n        <Offset>0</Offset>\n      </{name}>\n",
            spacing_um / UM_PER_M
        )
    };
    let comment = if file.notes.is_empty() {
        String::new()
    } else {
        let json = notes_json(&file.notes).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        format!("    <Comment>{json}</Comment>\n")
    };
    let version = env!("CARGO_PKG_VERSION");
    format!(
        r#"<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<p:ISO5436_2 xmlns:p="{NAMESPACE}" xmlns:xsi="{INSTANCE}" xsi:schemaLocation="{NAMESPACE} {NAMESPACE}/ISO5436_2.xsd">
  <Record1>
    <Revision>ISO5436 - 2000</Revision>
    <FeatureType>SUR</FeatureType>
    <Axes>
{}{}      <CZ>
        <AxisType>A</AxisType>
        <DataType>D</DataType>
      </CZ>
    </Axes>
  </Record1>
  <Record2>
    <Date>{NOT_RECORDED}</Date>
    <Creator>gearcut {version}</Creator>
    <Instrument>
      <Manufacturer>gearcut</Manufacturer>
      <Model>simulation</Model>
      <Serial>not available</Serial>
      <Version>{version}</Version>
    </Instrument>
    <CalibrationDate>{NOT_RECORDED}</CalibrationDate>
    <ProbingSystem>
      <Type>Software</Type>
      <Identification>dexels along the target's normals</Identification>
    </ProbingSystem>
{comment}  </Record2>
  <Record3>
    <MatrixDimension>
      <SizeX>{}</SizeX>
      <SizeY>{}</SizeY>
      <SizeZ>1</SizeZ>
    </MatrixDimension>
    <DataLink>
      <PointDataLink>{DATA}</PointDataLink>
      <MD5ChecksumPointData>{data_checksum}</MD5ChecksumPointData>
    </DataLink>
  </Record3>
  <Record4>
    <ChecksumFile>{CHECKSUM}</ChecksumFile>
  </Record4>
</p:ISO5436_2>
"#,
        axis("CX", surface.dx_um()),
        axis("CY", surface.dy_um()),
        surface.nx(),
        surface.ny(),
    )
}

/// MD5 in lower case.
fn hex(bytes: &[u8]) -> String {
    Md5::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

pub(super) fn decode(bytes: &[u8]) -> Result<SurfaceFile, String> {
    let mut zip = ZipArchive::new(Cursor::new(bytes)).map_err(|reason| reason.to_string())?;
    let main = entry(&mut zip, MAIN, MOST_MAIN)?;
    let text = std::str::from_utf8(&main).map_err(|_| format!("{MAIN} is not UTF-8"))?;
    let document = roxmltree::Document::parse(text).map_err(|reason| format!("{MAIN}: {reason}"))?;
    let record = XmlRecord(document.root_element());
    let feature = record.text("Record1/FeatureType")?;
    if feature != "SUR" {
        return Err(format!("the file holds `{}`, not a surface (SUR)", quoted(feature)));
    }
    let (nx, ny, nz) = (record.size("SizeX")?, record.size("SizeY")?, record.size("SizeZ")?);
    if nz != 1 {
        return Err(format!("the file holds {nz} layers; only one is read"));
    }
    let link = record
        .text("Record3/DataLink/PointDataLink")
        .map_err(|_| "the heights stand as text in the XML record; only those in a binary file are read".to_owned())?;
    let raw = match record.text("Record1/Axes/CZ/DataType")? {
        "D" => Raw::F64,
        "F" => Raw::F32,
        "L" => Raw::I32,
        "I" => Raw::I16,
        other => return Err(format!("heights of type `{}` are not read", quoted(other))),
    };
    let count = points(nx, ny)?;
    let data = entry(&mut zip, link, count * raw.bytes())?;
    if let Ok(name) = record.text("Record4/ChecksumFile") {
        check_main(&entry(&mut zip, name, MOST_CHECKSUM)?, &main, &data)?;
    }
    if let Ok(checksum) = record.text("Record3/DataLink/MD5ChecksumPointData")
        && !checksum.is_empty()
        && !checksum.eq_ignore_ascii_case(&hex(&data))
    {
        return Err(format!("{} does not have the checksum that {MAIN} gives: the file is damaged", quoted(link)));
    }
    let [step, offset] = if matches!(raw, Raw::F64 | Raw::F32) {
        [1.0, 0.0]
    } else {
        [
            factor("the increment of heights", record.number("Record1/Axes/CZ/Increment")?)?,
            record.number("Record1/Axes/CZ/Offset").unwrap_or(0.0),
        ]
    };
    let mut heights: Vec<f64> =
        raw.values(&data, count)?.into_iter().map(|z| kept_number(z, (z * step + offset) * UM_PER_M)).collect();
    if let Ok(link) = record.text("Record3/DataLink/ValidPointsLink") {
        let valid = entry(&mut zip, link, count.next_multiple_of(64) / 8)?;
        for (i, z) in heights.iter_mut().enumerate() {
            if valid.get(i / 8).is_some_and(|byte| byte >> (i % 8) & 1 == 0) {
                *z = f64::NAN;
            }
        }
    }
    let spacing = |axis: &str| -> Result<f64, String> {
        match record.text(&format!("Record1/Axes/{axis}/AxisType"))? {
            "I" => Ok(record.number(&format!("Record1/Axes/{axis}/Increment"))? * UM_PER_M),
            other => Err(format!("axis {axis} is of type `{}`; only regular grids (I) are read", quoted(other))),
        }
    };
    let surface = Surface::new(nx, ny, spacing("CX")?, spacing("CY")?, heights)?;
    Ok(SurfaceFile { surface, notes: notes_of(record.text("Record2/Comment").unwrap_or_default()) })
}

fn check_main(checksum: &[u8], main: &[u8], data: &[u8]) -> Result<(), String> {
    let given = String::from_utf8_lossy(checksum).split_whitespace().next().unwrap_or_default().to_lowercase();
    if given == hex(main) || given == hex(data) {
        return Ok(());
    }
    Err(format!("{MAIN} does not have the checksum in {CHECKSUM}: the file is damaged"))
}

/// One file of the archive, of `most` bytes at most: what its directory says is looked at before it is inflated, and
/// what comes out is counted.
fn entry(zip: &mut ZipArchive<Cursor<&[u8]>>, name: &str, most: usize) -> Result<Vec<u8>, String> {
    let failed = |reason: &dyn Display| format!("{}: {reason}", quoted(name));
    let file = zip.by_name(name).map_err(|reason| failed(&reason))?;
    let too_large = || failed(&format!("it inflates to more than the {most} bytes that the record gives it"));
    if file.size() > most as u64 {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    file.take(most as u64 + 1).read_to_end(&mut bytes).map_err(|reason| failed(&reason))?;
    if bytes.len() > most { Err(too_large()) } else { Ok(bytes) }
}

/// The XML record.
struct XmlRecord<'a>(roxmltree::Node<'a, 'a>);

impl<'a> XmlRecord<'a> {
    /// Text at a path of element names.
    fn text(&self, path: &str) -> Result<&'a str, String> {
        let mut node = self.0;
        for name in path.split('/') {
            node = node
                .children()
                .find(|child| child.tag_name().name() == name)
                .ok_or_else(|| format!("{MAIN} has no {path}"))?;
        }
        Ok(node.text().unwrap_or_default().trim())
    }

    fn number(&self, path: &str) -> Result<f64, String> {
        let text = self.text(path)?;
        text.parse().map_err(|_| format!("{path} in {MAIN} is `{}`, not a number", quoted(text)))
    }

    fn size(&self, name: &str) -> Result<usize, String> {
        let text = self.text(&format!("Record3/MatrixDimension/{name}"))?;
        text.parse().map_err(|_| format!("{name} in {MAIN} is `{}`, not a count", quoted(text)))
    }
}
