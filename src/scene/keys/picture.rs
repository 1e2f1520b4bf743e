//! Keys of the pictures.

use super::{Default, Key, KeySection, Kind, Range, Role};

/// `[[picture]]`.
pub(super) static SECTIONS: &[KeySection] = &[KeySection::new(
    "picture[]",
    Role::List { fewest: 0 },
    &[
        Key {
            name: "name",
            kind: Kind::Name,
            unit: "",
            default: Default::Derived("picture_1, picture_2, ..."),
            example: "\"gear\"",
            teach: "Name of the picture's files.",
        },
        Key {
            name: "view",
            kind: Kind::Word(&["gear", "tooth", "flank"]),
            unit: "",
            default: Default::Word("gear"),
            example: "\"gear\"",
            teach: "The whole gear; one tooth with its neighbours; or one flank, rolled out flat under raking light \
                with its heights exaggerated, so that feed marks show.",
        },
        Key {
            name: "tooth",
            kind: Kind::Whole { min: 1, max: 2000 },
            unit: "",
            default: Default::Whole(1),
            example: "1",
            teach: "Tooth of the views tooth and flank.",
        },
        Key {
            name: "side",
            kind: Kind::Word(&["left", "right"]),
            unit: "",
            default: Default::Word("left"),
            example: "\"left\"",
            teach: "Flank of the view flank; left is the one at the larger arc.",
        },
        Key {
            name: "colour",
            kind: Kind::Word(&["stock", "height", "pass", "clay"]),
            unit: "",
            default: Default::LeftOut("clay on a flank and after a single operation, else stock"),
            example: "\"stock\"",
            teach: "What colours show: the stock that the last operation found, the normal deviation from the target, \
                the pass that left the surface, or nothing.",
        },
        Key {
            name: "azimuth_deg",
            kind: Kind::Number(Range::closed(-360.0, 360.0)),
            unit: "deg",
            default: Default::LeftOut("-60 for the gear, -25 for a tooth, 0 for a flank"),
            example: "-60.0",
            teach: "Azimuth of the view: counter-clockwise from phi = 0 (gear), from the tooth's own direction \
                (tooth), or from the root towards larger leads (flank).",
        },
        Key {
            name: "elevation_deg",
            kind: Kind::Number(Range::closed(-90.0, 90.0)),
            unit: "deg",
            default: Default::LeftOut("40 for the gear, 35 for a tooth, 60 for a flank"),
            example: "40.0",
            teach: "Elevation of the view over the transverse plane, or over the rolled-out flank.",
        },
        Key {
            name: "extent_mm",
            kind: Kind::Number(Range::above(0.0, 50000.0)),
            unit: "mm",
            default: Default::LeftOut("the whole gear, three pitches round a tooth, 0.6 times the profile of a flank"),
            example: "20.0",
            teach: "Width of the picture at the object; smaller values look closer.",
        },
        Key {
            name: "exaggeration",
            kind: Kind::Number(Range::closed(1.0, 1e6)),
            unit: "",
            default: Default::LeftOut("chosen so that the marks show; the picture says it"),
            example: "1000.0",
            teach: "Factor on the heights of a flank.",
        },
        Key {
            name: "width_px",
            kind: Kind::Whole { min: 64, max: 8192 },
            unit: "pixels",
            default: Default::Whole(1000),
            example: "1000",
            teach: "Width of the picture without its legend.",
        },
        Key {
            name: "height_px",
            kind: Kind::Whole { min: 64, max: 8192 },
            unit: "pixels",
            default: Default::Whole(750),
            example: "750",
            teach: "Height of the picture without its title.",
        },
        Key {
            name: "exr",
            kind: Kind::Boolean,
            unit: "",
            default: Default::Boolean(false),
            example: "true",
            teach: "Write depth, normal, value and pass id of every pixel beside the picture, as EXR.",
        },
    ],
    "Pictures of the cut gear. A scene without this list draws the gear, tooth 1 and its left flank; picture = \
        [] draws none.",
)];
