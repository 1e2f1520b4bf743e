//! Keys of the machine around the cut, of the dexel fields and of what is written.

use super::{Default, Key, Kind, Range, Role, Section};

/// A limit of an axis, where known.
const fn limit(name: &'static str, unit: &'static str, example: &'static str, teach: &'static str) -> Key {
    Key {
        name,
        kind: Kind::Number(Range::above(0.0, 1e7)),
        unit,
        default: Default::LeftOut("not limited"),
        example,
        teach,
    }
}

/// An end of the evaluated profile.
const fn profile_end(name: &'static str, words: &'static str, example: &'static str, teach: &'static str) -> Key {
    Key {
        name,
        kind: Kind::Number(Range::closed(-100.0, 100.0)),
        unit: "mm",
        default: Default::LeftOut(words),
        example,
        teach,
    }
}

/// `[machine]` and what is inside it.
pub(super) static BEFORE_OPERATIONS: &[Section] = &[
    Section {
        path: "machine",
        role: Role::Plain,
        keys: &[
            Key {
                name: "double_strokes_per_minute",
                kind: Kind::Number(Range::above(0.0, 5000.0)),
                unit: "1/min",
                default: Default::Number(400.0),
                example: "400.0",
                teach: "Speed of the ram: one double stroke is a cutting stroke and its return.",
            },
            Key {
                name: "approach_mm",
                kind: Kind::Number(Range::closed(0.0, 100.0)),
                unit: "mm",
                default: Default::Number(3.0),
                example: "3.0",
                teach: "Travel of the ram above the face before the cut.",
            },
            Key {
                name: "overrun_mm",
                kind: Kind::Number(Range::closed(0.0, 100.0)),
                unit: "mm",
                default: Default::Number(3.0),
                example: "3.0",
                teach: "Travel of the ram below the face after the cut.",
            },
            Key {
                name: "back_off_mm",
                kind: Kind::Number(Range::closed(0.0, 20.0)),
                unit: "mm",
                default: Default::Number(0.5),
                example: "0.5",
                teach: "How far the cutter is lifted off along the line of centres during the return stroke.",
            },
            Key {
                name: "work_eccentricity_um",
                kind: Kind::Number(Range::closed(0.0, 1000.0)),
                unit: "um",
                default: Default::Number(0.0),
                example: "10.0",
                teach: "Mounting error: distance of the gear axis from the axis of the work spindle.",
            },
            Key {
                name: "work_eccentricity_angle_deg",
                kind: Kind::Number(Range::closed(-360.0, 360.0)),
                unit: "deg",
                default: Default::Number(0.0),
                example: "0.0",
                teach: "Direction of that error in the gear, counted from phi = 0.",
            },
        ],
        groups: &[],
        teach: "The machine around the cut.",
    },
    Section {
        path: "machine.limits",
        role: Role::Plain,
        keys: &[
            limit("work_speed_deg_per_s", "deg/s", "60.0", "Largest speed of the work spindle; 1 rpm is 6 deg/s."),
            limit("cutter_speed_deg_per_s", "deg/s", "120.0", "Largest speed of the cutter spindle."),
            limit("center_distance_speed_mm_per_s", "mm/s", "50.0", "Largest speed of the radial axis."),
            limit("work_acceleration_deg_per_s2", "deg/s^2", "600.0", "Largest acceleration of the work spindle."),
            limit("cutter_acceleration_deg_per_s2", "deg/s^2", "1200.0", "Largest acceleration of the cutter spindle."),
            limit(
                "center_distance_acceleration_mm_per_s2",
                "mm/s^2",
                "500.0",
                "Largest acceleration of the radial axis.",
            ),
        ],
        groups: &[],
        teach: "Largest speeds and accelerations of the axes; the peaks of every operation are held against them.",
    },
];

/// `[fields]`, `[measure]` and `[output]`.
pub(super) static AFTER_OPERATIONS: &[Section] = &[
    Section {
        path: "fields",
        role: Role::Plain,
        keys: &[],
        groups: &[],
        teach: "The dexel fields on which the cut is computed.",
    },
    Section {
        path: "fields.flank",
        role: Role::Plain,
        keys: &[
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
        groups: &[],
        teach: "Rays along the normals of the target flanks: half the spacing along the profile doubles time and \
            memory.",
    },
    Section {
        path: "fields.blank",
        role: Role::Plain,
        keys: &[
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
                    on during a stroke; with the axes at rest all sections are equal and one slice stands for the \
                    face.",
            },
        ],
        groups: &[],
        teach: "Rays through the whole blank: material removed, gouges, interference, meshes.",
    },
    Section {
        path: "fields.chips",
        role: Role::Plain,
        keys: &[Key {
            name: "spacing_mm",
            kind: Kind::Number(Range::closed(0.002, 2.0)),
            unit: "mm",
            default: Default::Derived("module_mm / 60"),
            example: "0.05",
            teach: "Distance of the rays through a tooth space and of the places along the cutter's edge.",
        }],
        groups: &[],
        teach: "The rays on which chips are followed from stroke to stroke; half the spacing doubles the time.",
    },
    Section {
        path: "measure",
        role: Role::Plain,
        keys: &[
            profile_end(
                "profile_start_height_mm",
                "from the form point, 5 % left out",
                "-2.0",
                "Lower end of the evaluated profile, as height over the pitch curve along its normal.",
            ),
            profile_end(
                "profile_end_height_mm",
                "to the tip, 5 % left out",
                "2.5",
                "Upper end of the evaluated profile, as height over the pitch curve along its normal.",
            ),
        ],
        groups: &[],
        teach: "Where profiles are evaluated.",
    },
    Section {
        path: "output",
        role: Role::Plain,
        keys: &[
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
                teach: "Spacing of vertices on meshes; rows along the tooth are left out where the surface is straight \
                    to 0.1 um.",
            },
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
                kind: Kind::Word(&["linear", "paper_g84", "none"]),
                unit: "",
                default: Default::Word("linear"),
                example: "\"linear\"",
                teach: "Form of the axis programs: straight lines in inverse time, the one-block form of Gao et al. \
                    2017 (not to be run: G84 taps on most machines), or none.",
            },
            Key {
                name: "gcode_contour_error_um",
                kind: Kind::Number(Range::closed(0.0001, 1000.0)),
                unit: "um",
                default: Default::Number(1.0),
                example: "1.0",
                teach: "Largest displacement on the cutter's flanks that the straight lines of a program may cause.",
            },
        ],
        groups: &[],
        teach: "What is written.",
    },
];
