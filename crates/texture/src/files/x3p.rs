//! X3P (ISO 25178-72:2017): a zip with an XML record, heights as raw numbers, and checksums.
//!
//! Written so that every reader that was tried opens it: heights as f64 in metres, deflated; revision `ISO5436 -
//! 2000`; MD5 of `main.xml` in lower case; NaN for what was not measured. Record 2 carries the notes in its comment.
//! The format demands dates: the epoch stands for "not recorded", because the same scene must give the same bytes.
//!
//! Read: surfaces (SUR) and profiles (PRF), types D, F, L and I (with increment and offset), heights in a binary file
//! or as text in the record, validity bits, both revisions; archives with everything in a folder, or with backslashes
//! in their names; records in UTF-8, UTF-16 and Latin-1. A checksum of `data.bin` where one of `main.xml` should be is
//! accepted, because a common writer puts it there.

use crate::error::FileFault;
use std::fmt::{Display, Write as _};
use std::io::{Cursor, Read, Write};

use md5::{Digest, Md5};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

use super::bounds::{factor, height, kept_number, points};
use super::content::{MeasuredContent, MeasuredFile};
use super::raw::Raw;
use super::text::characters;
use super::{SurfaceFile, notes_json, notes_of};
use crate::text::quoted;

const MAIN: &str = "main.xml";
const DATA: &str = "bindata/data.bin";
const CHECKSUM: &str = "md5checksum.hex";
const NOT_RECORDED: &str = "1970-01-01T00:00:00Z";
/// Namespace of ISO 25178-72, named after the standard before it; its schema stands under it.
const NAMESPACE: &str = "http://www.opengps.eu/2008/ISO5436_2";
/// Namespace of schema instances.
const INSTANCE: &str = "http://www.w3.org/2001/XMLSchema-instance";
/// Most bytes of the XML record, which may hold heights as text: some two million of them, of which the document takes
/// half a gigabyte.
const MOST_MAIN: usize = 64 << 20;
/// Most bytes of the file with the checksum.
const MOST_CHECKSUM: usize = 4 << 10;
/// Micrometres in a metre.
const UM_PER_M: f64 = 1e6;

/// Level of deflate: last bits of heights are noise, and more work on them than this takes twice the time for files
/// that are 3 % smaller.
const LEVEL: i64 = 4;

pub(super) fn encode(file: &SurfaceFile) -> Result<Vec<u8>, FileFault> {
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

pub(super) fn decode(bytes: &[u8]) -> Result<MeasuredFile, FileFault> {
    let mut archive = Archive::open(bytes)?;
    let main = archive.entry(MAIN, MOST_MAIN)?;
    let (text, encoding) = characters(&main).map_err(|reason| format!("{MAIN}: {reason}"))?;
    let document = roxmltree::Document::parse(&text).map_err(|reason| format!("{MAIN}: {reason}"))?;
    let record = XmlRecord(document.root_element());
    let feature = record.text("Record1/FeatureType")?;
    if !["SUR", "PRF"].contains(&feature) {
        return Err(format!("the file holds `{}`, neither a surface (SUR) nor a profile (PRF)", quoted(feature)).into());
    }
    let (nx, ny, nz) = (record.size("SizeX")?, record.size("SizeY")?, record.size("SizeZ")?);
    if nz != 1 {
        return Err(format!("the file holds {nz} layers; only one is read").into());
    }
    let raw = match record.text("Record1/Axes/CZ/DataType")? {
        "D" => Raw::F64,
        "F" => Raw::F32,
        "L" => Raw::I32,
        "I" => Raw::I16,
        other => return Err(FileFault::NotRead(format!("heights of type `{}` are not read", quoted(other)))),
    };
    let count = points(nx, ny)?;
    // The place of the heights: a file of the archive, or the record itself.
    let link = record.text("Record3/DataLink/PointDataLink").ok();
    let data = link.map(|link| archive.entry(link, count * raw.bytes())).transpose()?.unwrap_or_default();
    if let Ok(name) = record.text("Record4/ChecksumFile")
        && (link.is_some() || archive.has(name))
    {
        check_main(&archive.entry(name, MOST_CHECKSUM)?, &main, &data)?;
    }
    if let (Some(link), Ok(checksum)) = (link, record.text("Record3/DataLink/MD5ChecksumPointData"))
        && !checksum.is_empty()
        && !checksum.eq_ignore_ascii_case(&hex(&data))
    {
        return Err(
            format!("{} does not have the checksum that {MAIN} gives: the file is damaged", quoted(link)).into()
        );
    }
    let numbers = match link {
        Some(_) => raw.values(&data, count)?,
        None => record.list(count)?,
    };
    let [step, offset] = if matches!(raw, Raw::F64 | Raw::F32) {
        [1.0, 0.0]
    } else {
        [
            factor("the increment of heights", record.number("Record1/Axes/CZ/Increment")?)?,
            record.number("Record1/Axes/CZ/Offset").unwrap_or(0.0),
        ]
    };
    let mut heights: Vec<f64> = numbers.into_iter().map(|z| kept_number(z, (z * step + offset) * UM_PER_M)).collect();
    if let Ok(link) = record.text("Record3/DataLink/ValidPointsLink") {
        let valid = archive.entry(link, count.next_multiple_of(64) / 8)?;
        for (i, z) in heights.iter_mut().enumerate() {
            if valid.get(i / 8).is_some_and(|byte| byte >> (i % 8) & 1 == 0) {
                *z = f64::NAN;
            }
        }
    }
    let spacing = |axis: &str| -> Result<f64, FileFault> {
        match record.text(&format!("Record1/Axes/{axis}/AxisType"))? {
            "I" => Ok(record.number(&format!("Record1/Axes/{axis}/Increment"))? * UM_PER_M),
            other => Err(format!("axis {axis} is of type `{}`; only regular grids (I) are read", quoted(other)).into()),
        }
    };
    let dx = spacing("CX")?;
    // A profile has one axis; what it says of the other is nothing.
    let dy = if ny == 1 { dx } else { spacing("CY")? };
    let content = MeasuredContent::new(nx, ny, dx, dy, heights)?;
    let mut measured = MeasuredFile::new(content, notes_of(record.text("Record2/Comment").unwrap_or_default()));
    measured.remarks.extend(encoding.map(|encoding| format!("encoding of {MAIN}: {encoding}")));
    measured.remarks.extend(record.rotation());
    Ok(measured)
}

fn check_main(checksum: &[u8], main: &[u8], data: &[u8]) -> Result<(), FileFault> {
    let given = String::from_utf8_lossy(checksum).split_whitespace().next().unwrap_or_default().to_lowercase();
    if given == hex(main) || given == hex(data) {
        return Ok(());
    }
    Err(format!("{MAIN} does not have the checksum in {CHECKSUM}: the file is damaged").into())
}

/// The zip, whose files may all be in one folder.
struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    /// Names as they are written in it.
    names: Vec<String>,
    /// What is before `main.xml` in its name.
    folder: String,
}

impl<'a> Archive<'a> {
    fn open(bytes: &'a [u8]) -> Result<Self, FileFault> {
        let zip = ZipArchive::new(Cursor::new(bytes)).map_err(|reason| reason.to_string())?;
        let names: Vec<String> = zip.file_names().filter_map(|name| Some(name.ok()?.into_owned())).collect();
        let plain: Vec<String> = names.iter().map(|name| slashed(name)).collect();
        let mut places = plain.iter().filter(|name| name.rsplit('/').next() == Some(MAIN));
        let folder = match (places.next(), places.next()) {
            // Several: that of the archive itself counts.
            _ if plain.iter().any(|name| name == MAIN) => String::new(),
            (Some(only), None) => only[..only.len() - MAIN.len()].to_owned(),
            (None, _) => return Err(format!("the archive has no {MAIN}: it is a zip, but no X3P").into()),
            _ => return Err(format!("the archive has several {MAIN}: keep one").into()),
        };
        Ok(Self { zip, names, folder })
    }

    /// The name in the archive of a file that the record names.
    fn name(&self, name: &str) -> Option<&String> {
        let wanted = slashed(name);
        let wanted = wanted.trim_start_matches("./").trim_start_matches('/');
        let wanted = format!("{}{wanted}", self.folder);
        self.names.iter().find(|name| slashed(name) == wanted)
    }

    fn has(&self, name: &str) -> bool {
        self.name(name).is_some()
    }

    /// One file of the archive, of `most` bytes at most: what its directory says is looked at before it is inflated,
    /// and what comes out is counted.
    fn entry(&mut self, name: &str, most: usize) -> Result<Vec<u8>, FileFault> {
        let failed = |reason: &dyn Display| format!("{}: {reason}", quoted(name));
        let found = self.name(name).ok_or_else(|| failed(&"the archive has no such file"))?.clone();
        let file = self.zip.by_name(&found).map_err(|reason| failed(&reason))?;
        let too_large = || {
            FileFault::TooLarge(failed(&format!("it inflates to more than the {most} bytes that the record gives it")))
        };
        if file.size() > most as u64 {
            return Err(too_large());
        }
        let mut bytes = Vec::new();
        file.take(most as u64 + 1).read_to_end(&mut bytes).map_err(|reason| failed(&reason))?;
        if bytes.len() > most { Err(too_large()) } else { Ok(bytes) }
    }
}

/// A name with slashes between its folders, as the format has them.
fn slashed(name: &str) -> String {
    name.replace('\\', "/")
}

/// The XML record.
struct XmlRecord<'a>(roxmltree::Node<'a, 'a>);

impl<'a> XmlRecord<'a> {
    /// Text at a path of element names.
    fn text(&self, path: &str) -> Result<&'a str, FileFault> {
        let mut node = self.0;
        for name in path.split('/') {
            node = node
                .children()
                .find(|child| child.tag_name().name() == name)
                .ok_or_else(|| format!("{MAIN} has no {path}"))?;
        }
        Ok(node.text().unwrap_or_default().trim())
    }

    fn number(&self, path: &str) -> Result<f64, FileFault> {
        let text = self.text(path)?;
        text.parse().map_err(|_| format!("{path} in {MAIN} is `{}`, not a number", quoted(text)).into())
    }

    fn size(&self, name: &str) -> Result<usize, FileFault> {
        let text = self.text(&format!("Record3/MatrixDimension/{name}"))?;
        text.parse().map_err(|_| format!("{name} in {MAIN} is `{}`, not a count", quoted(text)).into())
    }

    /// `count` heights that are text in the record; an empty one is a hole.
    fn list(&self, count: usize) -> Result<Vec<f64>, FileFault> {
        let list = self.0.descendants().find(|node| node.tag_name().name() == "DataList");
        let list =
            list.ok_or_else(|| format!("{MAIN} has neither Record3/DataLink nor Record3/DataList: no heights"))?;
        let data = list.children().filter(|node| node.tag_name().name() == "Datum");
        let value = |(i, node): (usize, roxmltree::Node)| {
            let text = node.text().unwrap_or_default().trim();
            let hole = text.is_empty() || text.eq_ignore_ascii_case("nan");
            if hole {
                Ok(f64::NAN)
            } else {
                height(text).map_err(|fault| FileFault::Malformed(format!("Datum {} in {MAIN}: {fault}", i + 1)))
            }
        };
        // One more than there should be is enough to see that they do not fit.
        let values = data.take(count + 1).enumerate().map(value).collect::<Result<Vec<f64>, FileFault>>()?;
        if values.len() == count {
            Ok(values)
        } else {
            Err(format!("{count} points, but not as many heights in {MAIN}").into())
        }
    }

    /// A remark where the record turns the surface in space, which is not done.
    fn rotation(&self) -> Option<String> {
        let is = |i: usize, j: usize| {
            let text = self.text(&format!("Record1/Axes/Rotation/r{i}{j}")).ok()?;
            Some((text.parse::<f64>().ok()? - f64::from(u8::from(i == j))).abs() < 1e-9)
        };
        let turned = (1..=3).any(|i| (1..=3).any(|j| is(i, j) == Some(false)));
        turned.then(|| "the record turns the surface in space, which is not done: axes are the instrument's".to_owned())
    }
}
