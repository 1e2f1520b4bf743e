//! The same surface through every format; files of other programs; damaged files.

use super::exr_map::{ExrMap, MapChannel, Samples, write_exr_map};
use super::grid::{MapAxis, MapGrid};
use super::*;
use std::path::PathBuf;

const FORMATS: [(Format, &str); 6] = [
    (Format::X3p, "s.x3p"),
    (Format::SdfBinary, "s.sdf"),
    (Format::SdfAscii, "s_ascii.sdf"),
    (Format::Sur, "s.sur"),
    (Format::Npy, "s.npy"),
    (Format::Csv, "s.csv"),
];

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

/// Not symmetric in any way, with a hole.
fn sample() -> SurfaceFile {
    let mut heights: Vec<f64> = (0..35).map(|i| 0.1 * f64::from(i * i % 17) - 0.7).collect();
    heights[12] = f64::NAN;
    SurfaceFile {
        surface: Surface::new(7, 5, 2.0, 3.0, heights).expect("a grid"),
        notes: vec![
            ("frame".to_owned(), "x along the tooth, y along the profile; a * and a \"quote\"".to_owned()),
            ("scene".to_owned(), "[gear]\nmodule_mm = 3.0 # \u{b5}m < > &\n".to_owned()),
        ],
    }
}

fn close(a: &Surface, b: &Surface, share: f64) -> bool {
    let same = |p: f64, q: f64| (p.is_nan() && q.is_nan()) || (p - q).abs() <= share * 2.0;
    (a.nx(), a.ny()) == (b.nx(), b.ny())
        && (a.dx_um() - b.dx_um()).abs() <= share * a.dx_um()
        && (a.dy_um() - b.dy_um()).abs() <= share * a.dy_um()
        && a.heights_um().iter().zip(b.heights_um()).all(|(&p, &q)| same(p, q))
}

#[test]
fn every_format_gives_back_what_it_was_given_and_the_same_bytes_again() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let given = sample();
    for (format, name) in FORMATS {
        let path = folder.path().join(name);
        write_surface(&path, format, &given).expect("written");
        let bytes = std::fs::read(&path).expect("there");
        write_surface(&path, format, &given).expect("written");
        assert_eq!(std::fs::read(&path).expect("there"), bytes, "{format:?}");
        let back = read_surface(&path, None).expect("read");
        let share = if format == Format::Sur { 1e-6 } else { 1e-15 };
        assert!(close(&back.surface, &given.surface, share), "{format:?}: {:?}", back.surface);
        if format != Format::Sur {
            assert_eq!(back.notes, given.notes, "{format:?}");
        }
    }
}

/// Heights with a hole, and other channels; the heights alone.
fn sample_map() -> (ExrMap, Vec<f32>) {
    let axis = |name: &str, step_mm: f64, count: usize| MapAxis {
        name: name.into(),
        meaning: name.into(),
        start_mm: 0.5,
        step_mm,
        count,
    };
    let heights: Vec<f32> =
        (0..35_u16).map(|i| if i == 12 { f32::NAN } else { f32::from(i * i % 17) * 1e-3 }).collect();
    let channel = |name: &str, unit: &str, samples| MapChannel {
        name: name.into(),
        unit: unit.into(),
        definition: name.into(),
        samples,
    };
    let map = ExrMap {
        frame: "a flank".into(),
        grid: MapGrid { u: axis("u", 0.003, 5), v: axis("v", 0.002, 7) },
        channels: vec![
            channel("pass_id", "1", Samples::U32((0..35).collect())),
            channel("stock", "mm", Samples::F32(vec![1.0; 35])),
            channel("height_mm", "mm", Samples::F32(heights.clone())),
        ],
        notes: vec![("scene".into(), "[gear]".into())],
    };
    (map, heights)
}

/// Half a step of 2^-20 mm is 0.48 nm; lengths that f32 does not know as closely, and places without one, stay.
#[test]
fn lengths_of_maps_are_within_half_a_nanometre() {
    let lengths = [0.0, 1e-7, -3.3e-4, 0.123_456_79, -15.999_999, 16.000_002, -1e30, f32::MAX];
    let channel = MapChannel::lengths_mm("height_mm", "a height", &lengths);
    let Samples::F32(rounded) = &channel.samples else { panic!("lengths are floats") };
    for (of, is) in lengths.iter().zip(rounded) {
        assert!((f64::from(*of) - f64::from(*is)).abs() <= 0.5 / f64::from(1 << 20), "{of} became {is}");
    }
    assert_eq!((rounded[1].to_bits(), rounded[5], rounded[7]), (0, lengths[5], f32::MAX), "whole steps, and no others");
    let coarse = MapChannel::coarse_lengths_mm("thickness_mm", "a thickness", &[4.0e-6, 3.0e-6]).samples;
    assert_eq!(coarse, Samples::F32(vec![1.0 / f32::from(2_u8).powi(17), 0.0]), "7.6 nm or nothing");
    let Samples::F32(none) = MapChannel::lengths_mm("height_mm", "none", &[f32::NAN]).samples else { panic!("floats") };
    assert!(none[0].is_nan());
}

/// Maps have v (x here) along their rows and u (y) from row to row; ids are no heights.
#[test]
fn our_maps_are_surfaces() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("map.exr");
    let (map, heights) = sample_map();
    write_exr_map(&path, &map).expect("written");
    let file = read_surface(&path, None).expect("a surface");
    let expected = heights.iter().map(|z| f64::from(*z) * 1e3).collect();
    assert!(close(&file.surface, &Surface::new(7, 5, 2.0, 3.0, expected).expect("a grid"), 1e-12));
    assert!(
        file.notes.contains(&("scene".into(), "[gear]".into())) && file.notes[0] == ("frame".into(), "a flank".into())
    );
}

#[test]
fn the_reference_files_hold_the_reference_surface() {
    let truth: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(data("formats/truth.json")).expect("a copy")).expect("JSON");
    let heights: Vec<f64> = truth["heights_m"]
        .as_array()
        .expect("rows")
        .iter()
        .flat_map(|row| row.as_array().expect("a row"))
        .map(|z| z.as_f64().expect("a height") * 1e6)
        .collect();
    let surface = Surface::new(5, 3, 2.0, 3.0, heights.clone()).expect("a grid");
    for name in ["tiny_double.x3p", "tiny_int16.x3p", "tiny_double.sdf", "tiny_ascii.sdf", "tiny.sur", "tiny.gwy"] {
        let read = read_surface(&data("formats").join(name), None).expect(name);
        assert!(close(&read.surface, &surface, 1e-7), "{name}: {:?}", read.surface);
    }
    let mut holed = heights;
    holed[7] = f64::NAN;
    let read = read_surface(&data("formats/tiny_nan.x3p"), None).expect("read");
    assert!(close(&read.surface, &Surface::new(5, 3, 2.0, 3.0, holed).expect("a grid"), 1e-7));
}

/// The surface of `tests/data/dialects`, 10 x 8 points 2 x 3 um apart, in the words of other programs.
fn of_dialects() -> Surface {
    let text = std::fs::read_to_string(data("dialects/heights_um.txt")).expect("there");
    let heights = text.split_whitespace().map(|word| word.parse().expect("a height")).collect();
    Surface::new(10, 8, 2.0, 3.0, heights).expect("a grid")
}

fn surface_of(measured: &MeasuredFile) -> &Surface {
    let MeasuredContent::Surface(surface) = &measured.content else { panic!("no surface: {measured:?}") };
    surface
}

#[test]
fn dialects_of_other_programs_hold_the_same_surface() {
    for (name, share, remark) in [
        ("bcr.sdf", 1e-12, ""),
        ("gwyddion.sdf", 1e-12, ""),
        ("compressed.sur", 5e-5, ""),
        ("surface_of_type_1.sur", 5e-5, "calls itself a profile, but holds 8 lines"),
        ("in_a_folder.x3p", 5e-4, ""),
        ("heights_in_xml.x3p", 1e-12, ""),
        ("gwyddion.txt", 1e-12, ""),
    ] {
        let read = read(&data("dialects").join(name), &Given::default()).expect(name);
        assert!(close(surface_of(&read), &of_dialects(), share), "{name}: {read:?}");
        assert!(read.remarks.concat().contains(remark), "{name}: {:?}", read.remarks);
    }
}

/// Header names in capitals, line ends of Windows, an umlaut of Latin-1 in the maker's name.
#[test]
fn headers_of_sdf_are_read_in_any_case_and_encoding() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let text = std::fs::read_to_string(data("dialects/bcr.sdf")).expect("there");
    let (header, heights) = text.split_once('*').expect("a star");
    for (start, header) in [("aISO-1.0", header.to_uppercase()), ("aBCR-0.0", header.to_lowercase())] {
        let header = header.replacen(header.lines().next().expect("a line"), start, 1).replace("NONE", "M\u{fc}ller");
        let text = format!("{header}*{heights}").replace('\n', "\r\n");
        let latin: Vec<u8> = text.chars().map(|c| u8::try_from(u32::from(c)).expect("Latin-1")).collect();
        let path = folder.path().join("s.sdf");
        std::fs::write(&path, latin).expect("written");
        let read = read(&path, &Given::default()).expect(start);
        assert!(close(surface_of(&read), &of_dialects(), 1e-12), "{read:?}");
    }
}

/// Types of heights of the BCR dialect, whole numbers without sign among them: 0 is a height.
#[test]
fn binary_bcr_has_types_without_sign() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("s.sdf");
    let steps = [7_u16, 0, 65535, 3, 1, 2];
    for (code, bytes) in [
        (0_u8, steps.iter().map(|&s| s.min(255) as u8).collect::<Vec<u8>>()),
        (1, steps.iter().flat_map(|s| s.to_le_bytes()).collect()),
        (2, steps.iter().flat_map(|&s| u32::from(s).to_le_bytes()).collect()),
    ] {
        let mut file = b"bBCR-1.0".to_vec();
        file.extend([b' '; 34]);
        file.extend([3_u16, 2].iter().flat_map(|n| n.to_le_bytes()));
        file.extend([2e-6_f64, 3e-6, 1e-8, -1.0].iter().flat_map(|n| n.to_le_bytes()));
        file.extend([0, code, 0]);
        file.extend(bytes);
        std::fs::write(&path, file).expect("written");
        let read = read(&path, &Given::default()).expect("a surface");
        let most = if code == 0 { 2.55 } else { 655.35 };
        let expected = Surface::new(3, 2, 2.0, 3.0, vec![0.07, 0.0, most, 0.03, 0.01, 0.02]).expect("a grid");
        assert!(close(surface_of(&read), &expected, 1e-12), "{code}: {read:?}");
    }
}

fn zipped(entries: &[(&str, &[u8])]) -> Vec<u8> {
    use std::io::Write as _;
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        zip.start_file(*name, zip::write::SimpleFileOptions::default()).expect("started");
        zip.write_all(bytes).expect("written");
    }
    zip.finish().expect("a zip").into_inner()
}

/// Backslashes between folders, records in UTF-16 and Latin-1, holes as empty heights; zips that are no X3P.
#[test]
fn archives_of_other_zips_are_read_or_named() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("s.x3p");
    let refused = |bytes: &[u8]| {
        std::fs::write(&path, bytes).expect("written");
        read(&path, &Given::default())
    };
    let axes = "<Record1><FeatureType>SUR</FeatureType><Axes><CX><AxisType>I</AxisType><Increment>2e-6</Increment></CX>\
                <CY><AxisType>I</AxisType><Increment>3e-6</Increment></CY><CZ><DataType>D</DataType></CZ></Axes>\
                </Record1>";
    let record = |data: &str| {
        format!(
            "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\">{axes}<Record2><Comment>gr\u{fc}n</Comment>\
             </Record2><Record3><MatrixDimension><SizeX>3</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ></MatrixDimension>\
             {data}\
             </Record3></p:ISO5436_2>"
        )
    };
    let heights: Vec<u8> = [1e-6, -2e-6, 3e-6, 4e-6, f64::NAN, 6e-6_f64].iter().flat_map(|z| z.to_le_bytes()).collect();
    let expected = Surface::new(3, 2, 2.0, 3.0, vec![1.0, -2.0, 3.0, 4.0, f64::NAN, 6.0]).expect("a grid");
    let link = record("<DataLink><PointDataLink>bindata\\data.bin</PointDataLink></DataLink>");
    let list = ["1e-6", "-2e-6", "3e-6", "4e-6", "", "6e-6"].map(|z| format!("<Datum>{z}</Datum>")).concat();
    let list = record(&format!("<DataList>{list}</DataList>"));
    let utf16: Vec<u8> = [0xff, 0xfe].into_iter().chain(list.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    let latin: Vec<u8> = link.chars().map(|c| u8::try_from(u32::from(c)).expect("Latin-1")).collect();
    for bytes in [
        zipped(&[("main.xml", link.as_bytes()), ("bindata\\data.bin", &heights)]),
        zipped(&[("scan\\main.xml", &latin), ("scan\\bindata\\data.bin", &heights), ("readme.txt", b"no")]),
        zipped(&[("a/b/main.xml", link.as_bytes()), ("a/b/bindata/data.bin", &heights)]),
        zipped(&[("main.xml", &utf16)]),
    ] {
        let read = refused(&bytes).expect("a surface");
        assert!(close(surface_of(&read), &expected, 1e-12), "{read:?}");
        assert_eq!(read.notes, [("comment".to_owned(), "gr\u{fc}n".to_owned())]);
    }
    for (bytes, words) in [
        (zipped(&[("word/document.xml", b"x")]), "it is a zip, but no X3P"),
        (zipped(&[("a/main.xml", b"x"), ("b/main.xml", b"x")]), "several main.xml"),
        (zipped(&[("main.xml", record("").as_bytes())]), "neither Record3/DataLink nor Record3/DataList"),
        (zipped(&[("main.xml", list.replacen("<Datum>3e-6</Datum>", "", 1).as_bytes())]), "6 points, but not as many"),
        (zipped(&[("main.xml", list.replacen("<Datum>3e-6", "<Datum>3,0", 1).as_bytes())]), "Datum 3 in main.xml"),
        (zipped(&[("main.xml", link.as_bytes())]), "no such file"),
    ] {
        let reason = refused(&bytes).expect_err(words).to_string();
        assert!(reason.contains(words), "{reason}");
    }
}

/// One row of any format is a profile; where a surface is needed it is refused as one.
#[test]
fn one_row_is_a_profile() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let profile = |path: &Path| {
        let measured = read(path, &Given::default()).unwrap_or_else(|reason| panic!("{reason}"));
        let MeasuredContent::Trace(trace) = measured.content else { panic!("{path:?} is a surface") };
        trace
    };
    // 8 waves of amplitude 0.5 um in steps of 0.1 nm, 0.5 um apart.
    let trace = profile(&data("dialects/profile.pro"));
    assert_eq!((trace.heights_um().len(), trace.spacing_um()), (400, 0.5));
    for (i, z) in trace.heights_um().iter().enumerate() {
        let wave = 0.5 * (std::f64::consts::TAU * i as f64 / 50.0).sin();
        assert!((z - wave).abs() < 6e-5, "{i}: {z} {wave}");
    }
    assert!(read_surface(&data("dialects/profile.pro"), None).expect_err("no surface").to_string().contains("profile"));
    let text = std::fs::read_to_string(data("dialects/bcr.sdf")).expect("there");
    let sdf = folder.path().join("p.sdf");
    let one = text.replace("NumPoints = 10", "NumPoints = 80").replace("NumProfiles = 8", "NumProfiles = 1");
    std::fs::write(&sdf, one).expect("written");
    assert_eq!(profile(&sdf).heights_um(), of_dialects().heights_um());
    let x3p = folder.path().join("p.x3p");
    let record = "<p xmlns=\"x\"><Record1><FeatureType>PRF</FeatureType><Axes><CX><AxisType>I</AxisType>\
                  <Increment>5e-7</Increment></CX><CZ><DataType>L</DataType><Increment>1e-9</Increment></CZ></Axes>\
                  </Record1>\
                  <Record3><MatrixDimension><SizeX>12</SizeX><SizeY>1</SizeY><SizeZ>1</SizeZ></MatrixDimension>\
                  <DataLink>\
                  <PointDataLink>d</PointDataLink></DataLink></Record3></p>";
    let steps = [100_i32, -250, 7, 0, 1, 2, 3, 4, 5, 6, 7, -8];
    let heights: Vec<u8> = steps.iter().flat_map(|z| z.to_le_bytes()).collect();
    std::fs::write(&x3p, zipped(&[("main.xml", record.as_bytes()), ("d", &heights)])).expect("written");
    let trace = profile(&x3p);
    let near = |(um, &step): (&f64, &i32)| (um - f64::from(step) * 1e-3).abs() < 1e-12;
    assert!(trace.heights_um().iter().zip(&steps).all(near), "{trace:?}");
    assert!((trace.spacing_um() - 0.5).abs() < 1e-12);
}

/// Written by gwyfile 0.3.0, another program's writer: two channels, the first of volts, the second of heights in nm
/// over mm, with a mask.
#[test]
fn channels_of_gwyddion_are_read_by_their_units() {
    let path = data("written_elsewhere/gwyfile.gwy");
    let heights: Vec<f64> = (0..12).map(|i| 0.25 * f64::from(i * i % 7) - 0.5).collect();
    let whole = read(&path, &Given::default()).expect("a surface");
    let expected = Surface::new(4, 3, 500.0, 1000.0, heights.clone()).expect("a grid");
    assert!(close(surface_of(&whole), &expected, 1e-12), "{whole:?}");
    assert!(whole.remarks[0].contains("channel 1 `Topography` of 2") && whole.remarks[1].contains("mask"), "{whole:?}");
    let unmasked = read(&data("formats/tiny.gwy"), &Given { use_mask: true, ..Given::default() });
    assert!(unmasked.expect_err("no mask").to_string().contains("has no mask"));
    let masked = read(&path, &Given { use_mask: true, ..Given::default() }).expect("a surface");
    let mut holed = heights;
    holed[5] = f64::NAN;
    holed[10] = f64::NAN;
    assert!(
        close(surface_of(&masked), &Surface::new(4, 3, 500.0, 1000.0, holed).expect("a grid"), 1e-12),
        "{masked:?}"
    );
}

/// Heights whose range no texture has: the unit is doubted, in every format.
#[test]
fn a_range_that_no_texture_has_is_doubted() {
    for (factor, doubted) in [(1.0, false), (1e-6, true), (1e6, true), (0.0, true)] {
        let heights = of_dialects().heights_um().iter().map(|z| z * factor * 0.1).collect();
        let surface = Surface::new(10, 8, 2.0, 3.0, heights).expect("a grid");
        let measured = MeasuredFile::new(MeasuredContent::Surface(surface), Vec::new());
        assert_eq!(measured.doubt().is_some(), doubted, "{factor}: {:?}", measured.doubt());
    }
}

/// Every byte cut off and many bytes changed: a reason, never a panic.
#[test]
fn damaged_files_are_refused() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    for (format, name) in FORMATS {
        let path = folder.path().join(name);
        write_surface(&path, format, &sample()).expect("written");
        let bytes = std::fs::read(&path).expect("there");
        for length in (0..bytes.len()).step_by(13) {
            std::fs::write(&path, &bytes[..length]).expect("written");
            let _refused_or_read = read_surface(&path, None);
        }
        for place in (0..bytes.len()).step_by(9) {
            let mut changed = bytes.clone();
            changed[place] ^= 0x5a;
            std::fs::write(&path, &changed).expect("written");
            let _refused_or_read = read_surface(&path, None);
        }
    }
    // 5,000 mutants of the dialects: bytes changed, doubled, left out; read in time and memory, or refused.
    let dialects =
        ["bcr.sdf", "gwyddion.txt", "compressed.sur", "profile.pro", "in_a_folder.x3p", "heights_in_xml.x3p"];
    let others =
        ["formats/tiny.gwy", "written_elsewhere/gwyfile.gwy", "written_elsewhere/hole_surfalize.al3d"].map(data);
    let sources: Vec<PathBuf> = dialects.iter().map(|name| data("dialects").join(name)).chain(others).collect();
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for source in &sources {
        let bytes = std::fs::read(source).expect("there");
        for _ in 0..5000 / sources.len() {
            let mut changed = bytes.clone();
            for _ in 0..=random(4) {
                let place = random(changed.len());
                match random(4) {
                    0 => changed[place] ^= 1 << random(8),
                    1 => changed[place] = [0, 0x7f, 0x80, 0xff, b'9', b'-', b',', b'e'][random(8)],
                    2 => drop(changed.drain(place..(place + 1 + random(9)).min(changed.len()))),
                    _ => {
                        let part = changed[place..(place + 1 + random(40)).min(changed.len())].to_vec();
                        changed.splice(place..place, part);
                    }
                }
                if changed.is_empty() {
                    changed.push(0);
                }
            }
            if let Ok(kind) = FileKind::of(&changed[..changed.len().min(64)], source) {
                let _refused_or_read = decoded(kind, &changed, source, &Given::default());
            }
        }
    }
    let path = folder.path().join("map.exr");
    write_exr_map(&path, &sample_map().0).expect("written");
    let bytes = std::fs::read(&path).expect("there");
    for place in (0..bytes.len()).step_by(3) {
        let mut changed = bytes.clone();
        changed[place] ^= 0x5a;
        std::fs::write(&path, &changed).expect("written");
        let _refused_or_read = read_surface(&path, None);
        std::fs::write(&path, &bytes[..place]).expect("written");
        let _refused_or_read = read_surface(&path, None);
    }
    let path = folder.path().join("x.x3p");
    write_surface(&path, Format::X3p, &sample()).expect("written");
    let mut bytes = std::fs::read(&path).expect("there");
    bytes.truncate(bytes.len() / 2);
    std::fs::write(&path, bytes).expect("written");
    assert!(read_surface(&path, None).expect_err("half a zip").to_string().contains("x.x3p"));
}

#[test]
fn spacing_is_needed_once_and_must_not_contradict() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("plain.csv");
    std::fs::write(&path, "# height_unit = um\n# ny = 2\n1;2;3;9\n4;;6;9\n").expect("written");
    let reason = read_surface(&path, None).expect_err("no spacing").to_string();
    assert!(reason.contains("--spacing-um"), "{reason}");
    let read = read_surface(&path, Some([2.0, 4.0])).expect("spacing given");
    assert_eq!((read.surface.nx(), read.surface.ny(), read.surface.holes()), (4, 2, 1));
    let x3p = data("formats/tiny_double.x3p");
    assert!(read_surface(&x3p, Some([2.0, 3.0])).is_ok());
    assert!(read_surface(&x3p, Some([2.0, 2.0])).expect_err("contradicts").to_string().contains("2 x 3 um apart"));
    std::fs::write(&path, "# dx_um = 1\n# dy_um = 1\n1,2\n3,x\n").expect("written");
    assert!(read_surface(&path, None).expect_err("a word").to_string().contains("line 4, column 2: `x`"));
}

/// Files that surfalize, SurfaceTopography and x3pio wrote (`tests/interop/run --keep`): the same heights and spacing,
/// holes included.
#[test]
fn files_of_other_programs_hold_the_surface_they_were_given() {
    let folder = data("written_elsewhere");
    let text = std::fs::read_to_string(folder.join("truth.json")).expect("a copy");
    let truth: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let rows = truth["heights_um"].as_array().expect("rows");
    let columns = rows[0].as_array().expect("a row").len();
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let whole: Vec<f64> = rows.iter().flat_map(|row| row.as_array().expect("a row")).map(number).collect();
    let mut holed = whole.clone();
    let hole = [0, 1].map(|k| truth["hole"][k].as_u64().expect("an index") as usize);
    holed[hole[0] * columns + hole[1]] = f64::NAN;
    let spacing = ["dx_um", "dy_um"].map(|name| number(&truth[name]));
    let surface = |heights: &Vec<f64>| {
        Surface::new(columns, rows.len(), spacing[0], spacing[1], heights.clone()).expect("a grid")
    };
    for name in
        ["surfalize.x3p", "surfalize.sdf", "surfalize.sur", "surfalize.al3d", "surfacetopography.x3p", "x3pio.x3p"]
    {
        for (prefix, heights) in [("", &whole), ("hole_", &holed)] {
            let name = format!("{prefix}{name}");
            let read = read_surface(&folder.join(&name), None).unwrap_or_else(|reason| panic!("{name}: {reason}"));
            assert!(close(&read.surface, &surface(heights), 2e-6), "{name}: {:?}", read.surface);
        }
    }
}
