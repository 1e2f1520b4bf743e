//! Pictures of maps: colours stand where the values are, pictures are complete, equal and fast.
//!
//! With `GEARCUT_KEEP=folder` the pictures are kept there for a look.

use std::path::PathBuf;

use crate::fixtures::picture::Picture;
use gearcut::colormap::ColourScale;
use gearcut::output::contact_sheet::{ContactSheet, Thumbnail, write_contact_sheet};
use gearcut::output::grid::{MapAxis, MapGrid};
use gearcut::output::map_png::{MapPicture, write_map_png};

/// Where pictures go: the folder that the user named, else one that vanishes.
struct Album {
    folder: PathBuf,
    _vanishes: Option<tempfile::TempDir>,
}

impl Album {
    fn new() -> Self {
        if let Some(folder) = std::env::var_os("GEARCUT_KEEP") {
            std::fs::create_dir_all(&folder).expect("the folder to keep pictures in");
            return Self { folder: folder.into(), _vanishes: None };
        }
        let vanishes = tempfile::tempdir().expect("a folder for the test");
        Self { folder: vanishes.path().to_owned(), _vanishes: Some(vanishes) }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }
}

fn grid(u_count: usize, v_count: usize, u_mm: f64, v_mm: f64) -> MapGrid {
    let axis = |name: &str, meaning: &str, length_mm: f64, count: usize| MapAxis {
        name: name.into(),
        meaning: meaning.into(),
        start_mm: 0.5 * length_mm / count as f64,
        step_mm: length_mm / count as f64,
        count,
    };
    MapGrid {
        u: axis("u", "arc length from the form point", u_mm, u_count),
        v: axis("v", "along the tooth", v_mm, v_count),
    }
}

/// Something like feed marks and a form deviation, µm, with a hole.
fn flank(grid: &MapGrid, phase: f64) -> Vec<f32> {
    (0..grid.count())
        .map(|index| {
            let (u, v) = grid.place_mm(index);
            if (u - 2.0).hypot(v - 24.0) < 0.8 {
                return f32::NAN;
            }
            (3.0 * (0.3 * v + phase).sin() + 1.2 * (5.0 * u + 0.4 * v).cos() + 0.8 * (u - 3.5)) as f32
        })
        .collect()
}

fn picture<'a>(grid: &'a MapGrid, values: &'a [f32], scale: ColourScale) -> MapPicture<'a> {
    MapPicture {
        missing: "no pass came here",
        title: "Finish, tooth 7, left flank",
        quantity: "normal deviation",
        unit: "µm",
        grid,
        values,
        scale,
    }
}

/// The map lies in a box that the first and last cells' colours give away: four cells in four corners.
#[test]
fn known_cells_have_known_colours() {
    let album = Album::new();
    let grid = grid(2, 3, 8.0, 24.0);
    // u = 0: 0 10 20, u = 1: 30 40 NaN; u grows upward, v to the right.
    let values = [0.0, 10.0, 20.0, 30.0, 40.0, f32::NAN];
    let scale = ColourScale::Sequential { low: 0.0, high: 40.0 };
    let path = album.path("six_cells.png");
    write_map_png(&path, &picture(&grid, &values, scale)).expect("a sound map");
    let image = Picture::open(&path);
    let (left, top, width, height) = (84, 58, 1080, 360);
    for (index, &value) in values.iter().enumerate() {
        let (u, v) = (index as u32 / 3, index as u32 % 3);
        // An eighth in from the cell's corner: the marks of the extremes stand in the middles.
        let x = left + (8 * v + 1) * width / 24;
        let y = top + height - 1 - (8 * u + 1) * height / 16;
        assert_eq!(image.pixel(x, y), scale.colour(value), "cell {index}");
    }
    assert_eq!(image.pixel(left + width + 10, top + 100), [255, 255, 255], "paper beside the map");
}

#[test]
fn flank_maps_are_equal_each_time_and_leave_no_label_at_the_edge() {
    let album = Album::new();
    let fine = grid(75, 300, 7.0, 30.0);
    let values = flank(&fine, 0.0);
    let path = album.path("flank.png");
    write_map_png(&path, &picture(&fine, &values, ColourScale::diverging_over([&values[..]]))).expect("a sound map");
    let first = std::fs::read(&path).expect("just written");
    write_map_png(&path, &picture(&fine, &values, ColourScale::diverging_over([&values[..]]))).expect("a sound map");
    assert!(first == std::fs::read(&path).expect("just written"), "the same map gave other bytes");
    assert_white_edge(&Picture::open(&path));
}

/// A clipped label touches the border of the picture.
fn assert_white_edge(image: &Picture) {
    let (width, height) = image.size_px;
    let on_edge = |x: u32, y: u32| x < 3 || y < 3 || x + 3 >= width || y + 3 >= height;
    let stray = image.placed().find(|((x, y), pixel)| on_edge(*x, *y) && *pixel != [255; 3]);
    assert!(stray.is_none(), "ink at the picture's edge: {stray:?}");
    assert!(image.pixels.iter().any(|pixel| *pixel != [255; 3]), "an empty picture");
}

#[test]
fn unusual_maps_are_drawn_too() {
    let album = Album::new();
    let cases = [
        ("long_and_thin", grid(8, 1200, 0.4, 60.0)),
        ("short_and_high", grid(400, 50, 20.0, 6.0)),
        ("finer_than_pixels", grid(1400, 2400, 7.0, 30.0)),
        ("one_cell", grid(1, 1, 1.0, 1.0)),
    ];
    for (name, grid) in cases {
        let values = flank(&grid, 1.0);
        let path = album.path(&format!("{name}.png"));
        write_map_png(&path, &picture(&grid, &values, ColourScale::sequential_over([&values[..]]))).expect(name);
        assert_white_edge(&Picture::open(&path));
    }
    let grid = grid(75, 300, 7.0, 30.0);
    let nothing = vec![f32::NAN; grid.count()];
    let path = album.path("no_values.png");
    write_map_png(&path, &picture(&grid, &nothing, ColourScale::diverging_over([&nothing[..]]))).expect("grey");
    assert_white_edge(&Picture::open(&path));
    // A scale narrower than the values: the bar shows points at both ends.
    let values = flank(&grid, 0.0);
    let path = album.path("beyond_the_scale.png");
    write_map_png(&path, &picture(&grid, &values, ColourScale::Diverging { limit: 1e-6 })).expect("clamped");
    assert_white_edge(&Picture::open(&path));
}

#[test]
fn a_map_that_does_not_fill_its_grid_is_refused() {
    let album = Album::new();
    let grid = grid(2, 3, 8.0, 24.0);
    let path = album.path("refused.png");
    let scale = ColourScale::Diverging { limit: 1.0 };
    let message = write_map_png(&path, &picture(&grid, &[0.0; 5], scale)).expect_err("5 of 6").to_string();
    assert!(message.contains("refused.png") && message.contains("5 values for a grid of 2 x 3"), "{message}");
    let scale = ColourScale::Sequential { low: 1.0, high: f32::NAN };
    assert!(write_map_png(&path, &picture(&grid, &[0.0; 6], scale)).is_err());
    assert!(!path.exists());
}

/// 84 flanks on one sheet, and a sheet of three.
#[test]
fn a_whole_gear_is_drawn_on_one_sheet() {
    let album = Album::new();
    let grid = grid(75, 300, 7.0, 30.0);
    let flanks: Vec<_> = (0..84).map(|k| flank(&grid, 0.15 * f64::from(k))).collect();
    let scale = ColourScale::diverging_over(flanks.iter().map(Vec::as_slice));
    let labels: Vec<_> = (0..84).map(|k| format!("{} {}", k / 2 + 1, if k % 2 == 0 { "L" } else { "R" })).collect();
    let maps: Vec<_> =
        labels.iter().zip(&flanks).map(|(label, values)| Thumbnail { label, grid: &grid, values }).collect();
    let sheet = |maps| ContactSheet {
        missing: "no pass came here",
        title: "Finish, all flanks",
        quantity: "normal deviation",
        unit: "µm",
        scale,
        maps,
    };
    let path = album.path("sheet.png");
    write_contact_sheet(&path, &sheet(&maps)).expect("84 maps");
    assert_white_edge(&Picture::open(&path));
    let few = album.path("sheet_of_three.png");
    write_contact_sheet(&few, &sheet(&maps[..3])).expect("3 maps");
    assert_white_edge(&Picture::open(&few));
    assert!(write_contact_sheet(&few, &sheet(&[])).is_err());
}
