//! Tables of every dialect: the right heights, or a refusal that says what the table is. Nothing in between.

use super::super::content::{Given, MeasuredContent, MeasuredFile};
use super::super::units::LengthUnit;
use super::decode;

/// Heights, um, of 4 columns and 5 rows; their signs, digits and order tell every mistake.
const MAP: [[f64; 4]; 5] = [
    [-1.92, -0.369, 1.126, 1.016],
    [0.307, -0.328, -0.059, -0.33],
    [0.992, -1.064, -1.342, 0.171],
    [0.811, -0.608, -0.093, 0.652],
    [1.565, 1.69, 1.456, 1.527],
];
const UM: Given = Given { spacing_um: Some([2.0, 3.0]), height_unit: Some(LengthUnit::Micrometre), ..NOTHING };
const NOTHING: Given = Given { spacing_um: None, height_unit: None, spacing_unit: None, use_mask: false };

fn read(text: &str, given: &Given) -> Result<MeasuredFile, crate::FileFault> {
    decode(text.as_bytes(), given)
}

fn refused(text: &str, given: &Given) -> String {
    match read(text, given) {
        Ok(found) => panic!("taken as {found:?}: {text}"),
        Err(fault) => fault.to_string(),
    }
}

/// The heights in a unit, between separators, with a decimal sign.
fn table(per_um: f64, separator: &str, decimal: char, end: &str) -> String {
    let cell =
        |z: &f64| format!("{:.*}", if per_um >= 1.0 { 3 } else { 12 }, z * per_um).replace('.', &decimal.to_string());
    let row = |row: &[f64; 4]| row.iter().map(cell).collect::<Vec<_>>().join(separator) + end;
    MAP.iter().map(row).collect::<Vec<_>>().join("\n") + "\n"
}

fn is_map(found: &MeasuredFile) -> bool {
    let MeasuredContent::Surface(surface) = &found.content else { return false };
    (surface.nx(), surface.ny()) == (4, 5)
        && (surface.dx_um() - 2.0).abs() < 1e-9
        && (surface.dy_um() - 3.0).abs() < 1e-9
        && surface.heights_um().iter().zip(MAP.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-6)
}

fn trace(found: &MeasuredFile) -> (&[f64], f64) {
    let MeasuredContent::Trace(trace) = &found.content else { panic!("{found:?}") };
    (trace.heights_um(), trace.spacing_um())
}

/// Every header, separator, decimal sign and encoding together: the map, or a refusal. Never other heights.
#[test]
fn nothing_is_silently_wrong_in_a_corpus_of_headers() {
    let units = [
        ("m", 1e-6),
        ("mm", 1e-3),
        ("um", 1.0),
        ("\u{b5}m", 1.0),
        ("\u{3bc}m", 1.0),
        ("nm", 1e3),
        ("\u{c5}", 1e4),
        ("mil", 1.0 / 25.4),
        ("V", 1.0),
        ("a.u.", 1.0),
    ];
    let lines = [
        "# Value units: {}",
        "# height_unit = {}",
        "Z unit;{}",
        "\"Unit\",\"{}\"",
        "Height unit\t{}",
        "",
        "Heights are in {}",
        "Z-Werte [{}]",
    ];
    let spacings = [
        "# dx_um = 2\n# dy_um = 3\n",
        "# Channel: H\n# Width: 8.00 \u{b5}m\n# Height: 15.00 \u{b5}m\n",
        "x spacing = 2 um\ny spacing = 0.003 mm\n",
        "",
    ];
    let (mut read_right, mut refusals, mut quotes) = (0, 0, 0);
    for (unit, per_um) in units {
        for line in lines {
            for spacing in spacings {
                for (separator, decimal, end) in [
                    (",", '.', ""),
                    (";", '.', ""),
                    (";", ',', ""),
                    ("\t", ',', "\t"),
                    ("\t", '.', ""),
                    (" ", '.', ""),
                    ("  ", ',', ""),
                    (",", ',', ""),
                    (";", '.', ";"),
                ] {
                    let named = line.replace("{}", unit);
                    let text = format!("{spacing}{named}\n{}", table(per_um, separator, decimal, end));
                    let utf16: Vec<u8> =
                        [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
                    let latin: Option<Vec<u8>> = text.chars().map(|c| u8::try_from(u32::from(c)).ok()).collect();
                    for bytes in [Some(text.clone().into_bytes()), Some(utf16), latin].into_iter().flatten() {
                        for given in [NOTHING, Given::spacing(Some([2.0, 3.0])), UM] {
                            match decode(&bytes, &given) {
                                // Heights in another unit than the one given are those of a file that does not say
                                // its own, or says it in words that are quoted.
                                Ok(found) if given.height_unit.is_some() && !is_map(&found) => {
                                    let quoted = found.remarks.iter().any(|remark| remark.contains("not understood"));
                                    assert!(line.is_empty() || quoted, "{found:?}\n{text}");
                                    quotes += usize::from(quoted);
                                }
                                Ok(found) => {
                                    assert!(is_map(&found), "{found:?}\n{text}");
                                    read_right += 1;
                                }
                                Err(reason) => {
                                    let reason = reason.to_string();
                                    let way_out = ["--", "line ", "leave the option out"];
                                    assert!(way_out.iter().any(|words| reason.contains(words)), "{reason}\n{text}");
                                    refusals += 1;
                                }
                            }
                        }
                    }
                }
            }
        }
    }
    assert!(
        read_right > 3000 && refusals > 3000 && quotes > 100,
        "{read_right} right, {refusals} refused, {quotes} with the line quoted"
    );
}

#[test]
fn a_unit_that_is_not_said_must_be_given_and_must_not_contradict() {
    for (unit, per_um) in [("nm", 1e3), ("mm", 1e-3), ("um", 1.0)] {
        let height_unit = LengthUnit::of(unit);
        let found = read(&table(per_um, " ", '.', ""), &Given { height_unit, ..UM }).expect("a map");
        assert!(is_map(&found), "{unit}: {found:?}");
    }
    let bare = table(1.0, ";", ',', "");
    let reason = refused(&bare, &Given::spacing(Some([2.0, 3.0])));
    assert!(reason.contains("a table of 4 x 5 heights") && reason.contains("--height-unit"), "{reason}");
    let reason = refused(&bare, &Given { spacing_um: None, ..UM });
    assert!(reason.contains("--spacing-um"), "{reason}");
    let said = format!("# Value units: m\n{}", table(1e-6, " ", '.', ""));
    assert!(refused(&said, &UM).contains("in m, not in um"));
    let reason = refused(&format!("Roughness in \u{b5}m\n{bare}"), &Given::spacing(Some([2.0, 3.0])));
    assert!(reason.contains("Roughness in"), "{reason}");
    for said in ["Z scale = 0.5\n", "Height factor: 2\n", "# data multiplier = 1e-9\n"] {
        assert!(refused(&format!("{said}{bare}"), &UM).contains("multiplied"), "{said}");
    }
    assert!(read(&format!("Z scale = 1\n{bare}"), &UM).is_ok());
}

#[test]
fn gwyddions_sides_are_points_times_spacing() {
    let head = "# Channel: Height\n# Width: 8.00 \u{b5}m\n# Height: 15.00 \u{b5}m\n# Value units: m\n";
    let text = format!("{head}{}", table(1e-6, "\t", '.', ""));
    assert!(is_map(&read(&text, &NOTHING).expect("a map")));
    // What is given may have more digits, but not other ones.
    assert!(read(&text, &Given::spacing(Some([2.0004, 3.0]))).is_ok());
    assert!(refused(&text, &Given::spacing(Some([2.1, 3.0]))).contains("2 x 3 um apart"));
    // Other programs mean the distance of the first and the last point by it.
    let other = text.replace("# Channel: Height\n", "");
    assert!(refused(&other, &NOTHING).contains("--spacing-um"));
}

#[test]
fn exports_with_quoted_cells_are_understood() {
    let head = "\"Model\",\"VK-X1000\"\n\"XY calibration\",\"2000\",\"nm\"\n\"Horizontal\",\"4\"\n\
                \"Vertical\",\"5\"\n\"Unit\",\"nm\"\n";
    let found = read(&format!("{head}{}", table(1e3, ",", '.', "")), &NOTHING).expect("a map");
    let MeasuredContent::Surface(surface) = found.content else { panic!("a map") };
    assert_eq!((surface.dx_um(), surface.dy_um()), (2.0, 2.0));
    assert!((surface.row(4)[3] - 1.527).abs() < 1e-12);
    let wrong = head.replace("\"4\"", "\"6\"");
    assert!(refused(&format!("{wrong}{}", table(1e3, ",", '.', "")), &NOTHING).contains("says 6 points"));
}

#[test]
fn numbers_in_quotation_marks_are_numbers() {
    for (separator, decimal) in [(";", '.'), (";", ','), (",", '.'), ("\t", ',')] {
        let plain = table(1.0, separator, decimal, "");
        let row = |line: &str| format!("\"{}\"", line.replace(separator, &format!("\"{separator}\"")));
        let text = plain.lines().map(row).collect::<Vec<_>>().join("\n");
        assert!(is_map(&read(&text, &UM).unwrap_or_else(|reason| panic!("{reason}: {text}"))), "{text}");
    }
    let reason = refused("\"1,5\",\"2,5\"\n\"3,5\",\"4,5\"\n", &UM);
    assert!(reason.contains("line 1") && reason.contains("in quotation marks"), "{reason}");
}

/// A unit that is named in words which are not understood: what is given counts, and the line is told.
#[test]
fn a_line_that_was_not_understood_is_told_beside_a_given_unit() {
    for line in ["Data in nm", "Z-Werte [in]", "unit: furlong", "all in m, pixels of 0.002 x 0.003 mm"] {
        let found = read(&format!("{line}\n{}", table(1.0, ";", '.', "")), &UM).expect("a map");
        let quoted = format!("line 1: `{line}`");
        assert!(found.remarks.iter().any(|remark| remark.contains(&quoted)), "{:?}", found.remarks);
    }
}

#[test]
fn commas_that_may_be_either_are_refused() {
    for text in ["0,307,-0,328\n0,992,-1,064\n", "-0,369\n1,126\n2,5\n", "1.920,5;2.000,1\n1,5;2,5\n"] {
        let reason = refused(text, &UM);
        assert!(reason.contains("line 1") && reason.contains("comma"), "{reason}");
    }
    let whole = read("# dx_um = 1\n# dy_um = 1\n1,2,3\n4,5,6\n", &Given { spacing_um: None, ..UM }).expect("a map");
    assert_eq!(whole.content.heights_um(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    let german = read("0,5 1,5 2,5 3,5\n4,5 5,5 6,5 7,5\n", &UM).expect("decimal commas");
    assert_eq!(german.content.heights_um()[..3], [0.5, 1.5, 2.5]);
}

#[test]
fn a_separator_at_every_end_is_no_column_and_one_at_some_is_an_error() {
    let found = read(&table(1.0, ";", '.', ";"), &UM).expect("a map");
    assert!(is_map(&found) && found.remarks[0].contains("at the end of every line"), "{found:?}");
    let some = table(1.0, ";", '.', "").replacen('\n', ";\n", 1);
    assert!(refused(&some, &UM).contains("line 2 has 4 heights"));
    // In a file of this program it stands before a hole.
    let own = "# gearcut surface: heights in um\n# dx_um = 2\n# dy_um = 3\n1,2,\n3,4,\n";
    let found = read(own, &NOTHING).expect("a map");
    assert_eq!(found.content.heights_um().iter().filter(|z| z.is_nan()).count(), 2);
}

#[test]
fn points_x_y_z_make_a_grid_in_any_order() {
    let given = Given { spacing_unit: Some(LengthUnit::Millimetre), spacing_um: None, ..UM };
    let mut points: Vec<String> = (0..20)
        .map(|i| {
            format!(
                "{:.3} {:.3} {}",
                0.1 + 0.002 * f64::from(i % 4),
                7.0 + 0.003 * f64::from(i / 4),
                MAP[i as usize / 4][i as usize % 4]
            )
        })
        .collect();
    assert!(is_map(&read(&points.join("\n"), &given).expect("a map")));
    points.rotate_left(7);
    points.swap(3, 11);
    assert!(is_map(&read(&points.join("\n"), &given).expect("a map")));
    let reason = refused(&points.join("\n"), &Given::spacing(Some([2.0, 2.0])));
    assert!(reason.contains("x, y and z of 4 x 5 points") && reason.contains("--spacing-unit"), "{reason}");
    assert!(
        refused(&points.join("\n"), &Given { spacing_um: Some([2.0, 2.0]), ..given }).contains("um apart, not 2 x 2")
    );
    let missing = read(&points[1..].join("\n"), &given).expect("a map with a hole");
    assert_eq!(missing.content.heights_um().iter().filter(|z| z.is_nan()).count(), 1);
    assert!(missing.remarks.iter().any(|remark| remark.starts_with("1 places")), "{:?}", missing.remarks);
    let twice = format!("{}\n{}", points.join("\n"), points[0]);
    assert!(refused(&twice, &given).contains("three columns"), "a point twice");
    assert!(refused("0.1 0.2 1\n0.35 0.7 2\n0.9 0.1 3\n", &given).contains("regular grid"));
    let named = format!("x [mm]\ty [mm]\tz [\u{b5}m]\n{}", points.join("\n").replace(' ', "\t"));
    assert!(is_map(&read(&named, &NOTHING).expect("names with units")));
}

#[test]
fn positions_and_heights_are_a_profile() {
    let line = |i: i32| format!("{:.1}\t{:.4}", 0.5 * f64::from(i), f64::from(i * i % 7));
    let lines = (0..40).map(line).collect::<Vec<_>>().join("\n");
    let given = Given { spacing_unit: Some(LengthUnit::Micrometre), spacing_um: None, ..UM };
    let found = read(&lines, &given).expect("a profile");
    let (heights, spacing_um) = trace(&found);
    assert_eq!((heights.len(), heights[3], spacing_um), (40, 2.0, 0.5));
    let reason = refused(&lines, &Given::spacing(Some([0.5, 0.5])));
    assert!(reason.contains("a profile of 40 points") && reason.contains("--spacing-unit"), "{reason}");
    let named = format!("Position [mm]\tHeight [nm]\n{lines}");
    let found = read(&named, &NOTHING).expect("names with units");
    let (heights, spacing_um) = trace(&found);
    assert!((heights[3] - 0.002).abs() < 1e-12 && (spacing_um - 500.0).abs() < 1e-9, "{spacing_um}");
    assert!(refused("0 1\n1 2\n3 5\n4 1\n", &given).contains("equal distances"));
    assert!(refused("5 1\n3 2\n4 5\n4 1\n", &given).contains("equal distances"));
    // One column and one row are profiles as well.
    let column: String = (0..12).map(|i| (i * i % 5).to_string() + "\n").collect();
    let said = format!("# spacing = 0.5 um\n{column}");
    for text in [said.clone(), said.replace('\n', " ").replacen("um ", "um\n", 1)] {
        let found = read(&text, &Given { spacing_um: None, ..UM }).expect("a profile");
        let (heights, spacing_um) = trace(&found);
        assert_eq!((heights.len(), &heights[..4], spacing_um), (12, &[0.0, 1.0, 4.0, 4.0][..], 0.5));
    }
    let more: Vec<String> = lines.lines().map(|line| format!("{line}\t1.5\t{}", line.len() % 3)).collect();
    assert!(refused(&more.join("\n"), &UM).contains("positions beside heights"));
}

#[test]
fn cells_that_are_none_are_named_by_line_and_column() {
    let reason = refused("# t\n1 2 3 4\n1 2 x 4\n", &UM);
    assert!(reason.contains("line 3, column 3: `x`"), "{reason}");
    for (text, words) in [
        ("x,3,1,2\n1,2,3,4\n", "line 1"),
        ("Wyko ASCII Data File Format 0\t0\t1\nX Size\t4\n1 2\n", "waves of light"),
        ("Value units: V\n1 2 3 4\n", "`V` is no unit of length"),
        ("# dx = two\n1 2 3 4\n", "no length"),
        ("", "no row of numbers"),
        ("a title\n", "no row of numbers"),
    ] {
        assert!(refused(text, &UM).contains(words), "{text}: {}", refused(text, &UM));
    }
    assert!(decode(b"1 2\x00 3\n", &UM).expect_err("a zero").to_string().contains("line 1 has a control character"));
    assert!(decode(b"\xff\xfe1", &UM).expect_err("half a character").to_string().contains("UTF-16"));
}
