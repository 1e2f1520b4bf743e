//! EXR maps: everything comes back, the same map gives the same bytes, wrong maps are refused.

use std::path::Path;

use gearcut::output::exr_map::{ExrMap, MapChannel, Samples, read_exr_map, write_exr_map};
use gearcut::output::grid::{MapAxis, MapGrid};

fn axis(name: &str, meaning: &str, step_mm: f64, count: usize) -> MapAxis {
    MapAxis { name: name.into(), meaning: meaning.into(), start_mm: 0.1 + step_mm, step_mm, count }
}

/// 37 x 53 values, so that nothing is a multiple of the 16 lines of a block and nothing is square.
fn sample() -> ExrMap {
    let grid = MapGrid {
        u: axis("u", "arc length from the form point", 0.005, 37),
        v: axis("v", "along the tooth", 0.05, 53),
    };
    let mut heights: Vec<f32> = (0..grid.count()).map(|i| (i as f32 * 0.37).sin() * 1e-3).collect();
    heights[5] = f32::NAN;
    heights[6] = f32::MIN_POSITIVE / 2.0;
    heights[7] = f32::MAX;
    let passes = (0..grid.count()).map(|i| u32::MAX - i as u32).collect();
    let channel = |name: &str, unit: &str, definition: &str, samples| MapChannel {
        name: name.into(),
        unit: unit.into(),
        definition: definition.into(),
        samples,
    };
    ExrMap {
        frame: "flank frame of tooth 7, left: δ_d = 0 µm".into(),
        channels: vec![
            channel("height_mm", "mm", "normal deviation, positive = material left", Samples::F32(heights)),
            channel("pass_id", "1", "pass that left the point", Samples::U32(passes)),
        ],
        notes: vec![
            ("run".into(), format!(r#"{{"program": "gearcut", "long": "{}"}}"#, "x".repeat(70_000))),
            ("scene".into(), "first_cut".into()),
        ],
        grid,
    }
}

fn bits(samples: &Samples) -> Vec<u32> {
    match samples {
        Samples::F32(values) => values.iter().map(|x| x.to_bits()).collect(),
        Samples::U32(values) => values.clone(),
    }
}

fn write(map: &ExrMap, path: &Path) -> Vec<u8> {
    write_exr_map(path, map).expect("a sound map");
    std::fs::read(path).expect("just written")
}

#[test]
fn a_map_comes_back_bit_for_bit_with_its_header() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("map.exr");
    let map = sample();
    write(&map, &path);
    let back = read_exr_map(&path).expect("our own file");
    assert_eq!(back.grid, map.grid);
    assert_eq!(back.frame, map.frame);
    assert_eq!(back.notes, map.notes);
    assert_eq!(back.channels.len(), map.channels.len());
    for (back, there) in back.channels.iter().zip(&map.channels) {
        assert_eq!((&back.name, &back.unit, &back.definition), (&there.name, &there.unit, &there.definition));
        assert_eq!(bits(&back.samples), bits(&there.samples), "channel {}", there.name);
    }
}

/// Free attributes pass through a hash map with a new seed each time: eight files, one content.
#[test]
fn the_same_map_gives_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let first = write(&sample(), &folder.path().join("0.exr"));
    for name in 1..8 {
        assert!(write(&sample(), &folder.path().join(format!("{name}.exr"))) == first, "file {name} differs");
    }
}

#[test]
fn a_changed_value_changes_the_bytes() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("map.exr");
    let mut map = sample();
    let first = write(&map, &path);
    let Samples::F32(heights) = &mut map.channels[0].samples else { unreachable!("heights are f32") };
    heights[100] = f32::from_bits(heights[100].to_bits() ^ 1);
    assert!(write(&map, &path) != first);
}

#[test]
fn maps_that_make_no_sense_are_refused_with_the_reason() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("map.exr");
    let refused = |change: fn(&mut ExrMap), words: &str| {
        let mut map = sample();
        change(&mut map);
        let message = write_exr_map(&path, &map).expect_err(words).to_string();
        assert!(message.contains(words) && message.contains("map.exr"), "{message}");
        assert!(!path.exists());
    };
    refused(|map| map.grid.v.count = 54, "1961 values for a grid of 37 x 54");
    refused(|map| map.grid.u.step_mm = 0.0, "positive spacing");
    refused(|map| map.channels[1].name = "height_mm".into(), "used twice");
    refused(|map| map.notes[0].0 = "frame".into(), "used twice");
    refused(|map| map.channels.clear(), "at least one channel");
}

#[test]
fn a_file_that_is_no_map_of_ours_is_told_apart() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("map.exr");
    assert!(read_exr_map(&path).expect_err("absent").to_string().contains("map.exr"));
    let whole = write(&sample(), &path);
    for bytes in [&whole[..0], &whole[..40], &whole[..whole.len() - 100]] {
        std::fs::write(&path, bytes).expect("writable");
        assert!(read_exr_map(&path).is_err(), "{} bytes of {}", bytes.len(), whole.len());
    }
}
