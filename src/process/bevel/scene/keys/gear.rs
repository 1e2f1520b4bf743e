//! Keys of the blank's cones.

use crate::scene::keys::{Default, Key, KeySection, Kind, Range, Role};

/// An angle that must be written.
const fn angle(name: &'static str, example: &'static str, teach: &'static str) -> Key {
    let kind = Kind::Number(Range::above(0.0, 90.0));
    Key { name, kind, unit: "deg", default: Default::Required, example, teach }
}

/// A height that must be written.
const fn height(name: &'static str, example: &'static str, teach: &'static str) -> Key {
    let kind = Kind::Number(Range::above(0.0, 100.0));
    Key { name, kind, unit: "mm", default: Default::Required, example, teach }
}

/// `[gear.bevel]`.
pub(super) static SECTIONS: &[KeySection] = &[KeySection::new(
    "gear.bevel",
    Role::Plain,
    &[
        angle("pitch_angle_deg", "43.025", "Pitch angle, between axis and pitch cone."),
        angle("face_angle_deg", "45.025", "Face angle: of the cone of the tips."),
        angle("root_angle_deg", "41.025", "Root angle: of the cone of the roots."),
        height("addendum_mm", "2.5", "Addendum at the outer cone distance."),
        height("dedendum_mm", "3.225", "Dedendum at the outer cone distance."),
        Key {
            name: "mate_teeth",
            kind: Kind::Whole { min: 4, max: 2000 },
            unit: "",
            default: Default::LeftOut("the pitch angle is not checked"),
            example: "45",
            teach: "Number of teeth of the mate; with the shaft angle it says which pitch angle belongs to the pair.",
        },
        Key::number(
            "shaft_angle_deg",
            "deg",
            Range::above(0.0, 180.0),
            90.0,
            "90.0",
            "Angle between both axes of the pair.",
        ),
        Key::number(
            "hypoid_offset_mm",
            "mm",
            Range::closed(-500.0, 500.0),
            0.0,
            "0.0",
            "Offset a of the pair's axes, the same in both scenes; 0 on spiral bevel gears. Positive where the \
            pinion's axis has the larger y of the gear's machine.",
        ),
    ],
    "Cones of a bevel gear; only scenes with a face-mill head have them. gear.module_mm is the outer transverse \
        module, so that the outer cone distance is module x teeth / (2 sin pitch angle), and gear.face_width_mm is \
        measured along the pitch cone.",
)];
