//! Broken surface files: every one is refused with its reason, none ends the program or fills the memory.

use gearcut_texture::files::{Format, SurfaceFile, read_surface, write_surface};
use gearcut_texture::{Error, Surface};
use std::path::{Path, PathBuf};

const BEYOND: &str = "beyond +-1e6 um (1 m)";
const TOO_MANY: &str = "more than 8000000, which take 1 GB";
const NO_NUMBER: &str = "must be a number other than 0";

/// Every file of the folder, and words that its reason must hold.
const REASONS: [(&str, &str); 63] = [
    ("compressed.sdf", "compressed SDF files are not read"),
    ("compressed.sur", "an object of type 0"),
    ("cut_off.npy", "the array of 3 x 3 is cut off"),
    ("cut_off.sdf", "9 heights need 72 bytes"),
    ("cut_off.x3p", "invalid Zip archive"),
    ("data_too_short.x3p", "9 heights need 72 bytes"),
    ("directory_lies_about_its_size.x3p", "bindata/data.bin"),
    ("empty.csv", "no row of numbers"),
    ("escape_codes.csv", "line 4: `0,\u{fffd}[2J\u{fffd}]0;title\u{fffd}` is no row of heights"),
    ("escape_codes_in_spacing.csv", "line 2: `dx_um = \u{fffd}[31m`: `\u{fffd}[31m` is no length"),
    ("header_cut_off.exr", "missing bytes"),
    ("header_cut_off.sur", "the file ends at byte 300"),
    ("height_beyond_f64.csv", BEYOND),
    ("height_over_a_metre.csv", "point 2 in row 2 is 1.000001e6 um"),
    ("heights_in_mm.npy", "its heights are in \"mm\""),
    ("heights_infinite_in_um.x3p", BEYOND),
    ("heights_overflow.csv", "point 1 in row 1 is 1e308 um"),
    ("heights_overflow.npy", BEYOND),
    ("heights_overflow.x3p", BEYOND),
    ("increment_overflows.x3p", BEYOND),
    ("increment_zero.x3p", NO_NUMBER),
    ("inflates_to_more_than_its_matrix.x3p", "inflates to more than the 32 bytes"),
    ("matrix_overflows.x3p", TOO_MANY),
    ("matrix_too_large.x3p", TOO_MANY),
    ("more_heights_than_points_ascii.sdf", "do not fill a grid of 2 x 2"),
    ("no_spacing.npy", "--spacing-um"),
    ("no_surface.bin", "not an X3P"),
    ("no_text.csv", "line 4: `\u{ff}\u{fe},0` is no row of heights"),
    ("no_unit.csv", "a table of 4 x 2 heights; no line says the unit of its heights"),
    ("no_zip.x3p", "invalid Zip archive"),
    ("nothing_but_holes.csv", "no row of numbers"),
    ("object_larger_than_the_file.gwy", "the file ends at byte"),
    ("of_another_program.exr", "block position"),
    ("offset_is_no_number.sur", "the offset of heights is NaN"),
    ("product_of_sides_overflows.npy", TOO_MANY),
    ("record_is_no_xml.x3p", "main.xml: expected 'b' tag"),
    ("record_of_entities.x3p", "DTD"),
    ("rows_cut_off.al3d", "the file ends at byte 1141"),
    ("rows_of_different_length.csv", "line 5 has 3 heights"),
    ("scale_infinite.sdf", NO_NUMBER),
    ("scale_overflows.sdf", BEYOND),
    ("scale_overflows_ascii.sdf", BEYOND),
    ("side_negative.sdf", "a side of -2 points"),
    ("side_negative.sur", "a side of -2 points"),
    ("spacing_beyond_range.csv", "a spacing of 1e300 um is out of range"),
    ("spacing_is_no_number.x3p", "not NaN x 1 um"),
    ("spacing_zero.al3d", "`PixelSizeXMeter` of the AL3D file is `0`"),
    ("spacing_zero.csv", "not 0 x 1 um"),
    ("step_infinite.sur", NO_NUMBER),
    ("step_makes_kilometres.sur", BEYOND),
    ("stream_inflates_to_more.sur", "does not inflate to the 320 bytes"),
    ("streams_without_end.sur", "the file ends at byte"),
    ("tags_without_number.al3d", "`TagCount` of the AL3D file is `1e9`"),
    ("too_many_points.al3d", TOO_MANY),
    ("too_many_points.exr", "more than 100000000 values"),
    ("too_many_points.sdf", TOO_MANY),
    ("too_many_points.sur", TOO_MANY),
    ("too_many_points_ascii.sdf", "`NumPoints = 1e+30` is not a count"),
    ("two_columns.csv", "two columns of 3 lines"),
    ("type_with_escape_codes.npy", "`\u{fffd}[31m`"),
    ("unit_is_no_length.sur", "`\u{fffd}[31mV`"),
    ("version_with_escape_codes.sdf", "`bISO-\u{fffd}[m`"),
    ("word_among_heights_ascii.sdf", "`\u{fffd}[31m` is not a height"),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken")
}

/// The reason, which names the file and steers no terminal.
fn refused(path: &Path) -> String {
    let message = read_surface(path, None).expect_err(&path.to_string_lossy()).to_string();
    assert!(message.contains(&*path.to_string_lossy()), "{message}");
    assert!(!message.contains(|c: char| c.is_control()), "{message:?}");
    message
}

#[test]
fn every_broken_file_is_refused_with_its_reason() {
    let mut names: Vec<String> = std::fs::read_dir(folder())
        .expect("the folder")
        .map(|entry| entry.expect("an entry").path())
        // JSON belongs to the NPY file of its name.
        .filter(|path| path.extension() != Some("json".as_ref()))
        .filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    assert_eq!(names, REASONS.map(|(name, _)| name), "the folder and the list");
    for (name, words) in REASONS {
        let message = refused(&folder().join(name));
        assert!(message.contains(words), "{name}: {message}");
    }
}

/// 65535 x 65535 points in 113 bytes.
#[test]
fn a_small_file_cannot_declare_a_large_surface() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("sparse.sdf");
    let mut bytes = std::fs::read(self::folder().join("cut_off.sdf")).expect("there");
    bytes[42..46].copy_from_slice(&[0xff; 4]); // 65535 x 65535
    std::fs::write(&path, bytes).expect("written");
    assert!(refused(&path).contains(TOO_MANY));
}

/// Zeros deflated to a thousandth of their size: what a surface takes in memory is no matter of the file's bytes. One
/// row less than the most is read.
#[test]
fn a_compressed_file_is_bounded_by_its_points() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let (fits, bomb) = (folder.path().join("fits.x3p"), folder.path().join("bomb.x3p"));
    let surface = Surface::new(2000, 4000, 1.0, 1.0, vec![0.0; 8_000_000]).expect("a grid");
    write_surface(&fits, Format::X3p, &SurfaceFile { surface, notes: Vec::new() }).expect("written");
    assert!(std::fs::metadata(&fits).expect("there").len() < 100_000);
    assert_eq!(read_surface(&fits, None).expect("the most points").surface.ny(), 4000);
    let surface = Surface::new(2000, 4001, 1.0, 1.0, vec![0.0; 8_002_000]).expect("a grid");
    write_surface(&bomb, Format::X3p, &SurfaceFile { surface, notes: Vec::new() }).expect("written");
    let message = refused(&bomb);
    assert!(message.contains("2000 x 4001 points") && message.contains(TOO_MANY), "{message}");
}

/// A file that claims 4 TB costs no memory and no time: a hole of the disk, whose length alone is looked at.
#[test]
fn a_file_larger_than_its_format_is_refused_by_its_length() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    for (name, head) in [("large.sur", &b"DIGITAL SURF"[..]), ("large.csv", b"# dx_um = 1\n")] {
        let path = folder.path().join(name);
        std::fs::write(&path, head).expect("written");
        let file = std::fs::OpenOptions::new().write(true).open(&path).expect("opened");
        if file.set_len(1 << 42).is_ok() {
            assert!(refused(&path).contains("larger than"), "{name}");
        }
    }
}

#[test]
fn folders_are_refused() {
    assert!(refused(&folder()).contains("it is a folder"));
}

#[cfg(unix)]
#[test]
fn devices_and_pipes_are_refused_before_they_are_opened() {
    assert!(refused(Path::new("/dev/zero")).contains("regular file"));
    let folder = tempfile::tempdir().expect("a folder for the test");
    let pipe = folder.path().join("pipe.csv");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    if made.is_ok_and(|status| status.success()) {
        assert!(refused(&pipe).contains("pipe"));
    }
}

#[test]
fn the_file_beside_an_npy_file_is_bounded_and_must_be_sound() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("s.npy");
    let surface = Surface::new(2, 2, 1.0, 1.0, vec![0.0, 1.0, 2.0, 3.0]).expect("a grid");
    write_surface(&path, Format::Npy, &SurfaceFile { surface, notes: Vec::new() }).expect("written");
    assert!(read_surface(&path, None).is_ok());
    let beside = folder.path().join("s.npy.json");
    std::fs::write(&beside, "{\"dx_um\": 1,").expect("written");
    assert!(refused(&path).contains("s.npy.json"));
    std::fs::write(&beside, vec![b' '; (16 << 20) + 1]).expect("written");
    assert!(refused(&path).contains("larger than"));
}

#[test]
fn a_file_that_is_not_there_is_the_systems_error() {
    let missing = read_surface(Path::new("no_such_file.x3p"), None).expect_err("absent");
    assert!(matches!(missing, Error::Io { action: "cannot read", .. }), "{missing}");
}
