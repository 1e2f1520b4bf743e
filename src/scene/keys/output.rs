//! Keys of the dexel fields, of what is written, and of the head of the printed report.

use super::{Default, Key, KeySection, Kind, Range, Role};

/// Letters that a field of the report's head has room for.
const FIELD: Kind = Kind::Text { most: 60 };

/// A field of the report's head; `empty` says what is printed where it is left out.
const fn field(name: &'static str, empty: &'static str, example: &'static str, teach: &'static str) -> Key {
    Key { name, kind: FIELD, unit: "", default: Default::LeftOut(empty), example, teach }
}

/// `[fields]`, `[output]` and `[report]`.
pub(super) static SECTIONS: &[KeySection] = &[
    KeySection::new("fields", Role::Plain, &[], "The dexel fields on which the cut is computed."),
    KeySection::new(
        "fields.flank",
        Role::Plain,
        &[
            Key {
                name: "profile_spacing_um",
                kind: Kind::Number(Range::closed(0.1, 1000.0)),
                unit: "um",
                default: Default::Number(5.0),
                example: "5.0",
                teach: "Distance of dexels along the profile; a feed mark at 4200 strokes is about 45 um wide.",
            },
            Key {
                name: "lead_spacing_um",
                kind: Kind::Number(Range::closed(0.1, 10000.0)),
                unit: "um",
                default: Default::Number(50.0),
                example: "50.0",
                teach: "Distance of dexels along the tooth.",
            },
        ],
        "Rays along the normals of the target flanks: half the spacing along the profile doubles time and \
            memory.",
    ),
    KeySection::new(
        "fields.blank",
        Role::Plain,
        &[
            Key {
                name: "spacing_mm",
                kind: Kind::Number(Range::closed(0.001, 10.0)),
                unit: "mm",
                default: Default::Number(0.1),
                example: "0.1",
                teach: "Distance of the rays in both directions; meshes and pictures resolve as much.",
            },
            Key {
                name: "slice_spacing_mm",
                kind: Kind::Number(Range::closed(0.01, 1000.0)),
                unit: "mm",
                default: Default::Number(2.5),
                example: "2.5",
                teach: "Largest distance of transverse slices of hobbed gears, and of shaped ones where the feed goes \
                    on during a stroke, the guide leads the cutter aside or the work wobbles; else all sections are \
                    equal and one slice is enough. While the axes rest, one slice in the middle from twice \
                    the face on: the default where sections lie within a tenth of spacing_mm of the middle one; \
                    else the face, or half of it where the guide is bent.",
            },
        ],
        "Rays through the whole blank: material removed, gouges, interference, meshes.",
    ),
    KeySection::new(
        "output",
        Role::Plain,
        &[
            Key {
                name: "map_spacing_mm",
                kind: Kind::Number(Range::closed(0.001, 10.0)),
                unit: "mm",
                default: Default::Number(0.1),
                example: "0.1",
                teach: "Spacing of written maps; the fields keep their own.",
            },
            Key {
                name: "mesh_spacing_mm",
                kind: Kind::Number(Range::closed(0.001, 10.0)),
                unit: "mm",
                default: Default::Number(0.1),
                example: "0.1",
                teach: "Spacing of vertices on meshes; those within 1 um of the triangles between the others are left \
                    out.",
            },
            Key::word(
                "flank_pictures",
                &["chosen", "all"],
                "chosen",
                "\"all\"",
                "Flanks that are drawn by themselves: those with texture windows and those with the largest and the \
                    smallest deviation, mark and stock; or all. The sheets show every flank, and every flank has its \
                    EXR.",
            ),
            Key {
                name: "folder",
                kind: Kind::Path,
                unit: "",
                default: Default::LeftOut("out/ and the name of the scene"),
                example: "\"out/my_gear\"",
                teach: "Where results are written; --out on the command line wins.",
            },
            Key {
                name: "gcode",
                kind: Kind::Word(&["linear", "none"]),
                unit: "",
                default: Default::Word("linear"),
                example: "\"linear\"",
                teach: "Form of the axis programs: straight lines in inverse time, or none.",
            },
            Key::word(
                "post",
                &["plain", "linuxcnc", "siemens", "fanuc"],
                "plain",
                "\"siemens\"",
                "Control that reads the programs: none in particular, or LinuxCNC, SINUMERIK, FANUC with their own \
                    rules of numbers, dwells, comments, safe start and retract (docs/gcode.md).",
            ),
            Key {
                name: "gcode_contour_error_um",
                kind: Kind::Number(Range::closed(0.0001, 1000.0)),
                unit: "um",
                default: Default::Number(1.0),
                example: "1.0",
                teach: "Largest displacement on the cutter's flanks that the straight lines of a program may cause.",
            },
        ],
        "What is written.",
    ),
    KeySection::new(
        "report",
        Role::Plain,
        &[
            field("part", "the name of the scene", "\"Pump gear\"", "Name of the part."),
            field("drawing", "an empty field", "\"4711-02 B\"", "Number of the drawing, with its revision."),
            field("customer", "an empty field", "\"Example Ltd\"", "For whom the gear is."),
            field(
                "date",
                "an empty field",
                "\"2026-05-04\"",
                "Date of the report, printed as it is written. The clock is never read: the same scene gives the same \
                    bytes on every day. --set report.date=... takes that of today.",
            ),
            Key::word("paper", &["a4", "letter"], "a4", "\"letter\"", "Paper of report.pdf: A4, or US Letter."),
        ],
        "Fields at the head of every page of report.pdf.",
    ),
];
