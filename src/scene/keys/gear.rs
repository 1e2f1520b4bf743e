//! Keys of the gear and its blank.

use super::{Addition, Default, Key, KeySection, Kind, Range, Role};

/// `[gear]`.
pub(super) static SECTIONS: &[KeySection] = &[KeySection::new(
    "gear",
    Role::Plain,
    &[
        Key {
            name: "kind",
            kind: Kind::Word(&["external", "internal"]),
            unit: "",
            default: Default::Word("external"),
            example: "\"external\"",
            teach: "external: teeth outside, material inside the pitch curve; internal: a ring with its teeth inside. \
                    Not every process cuts them; one that does not refuses them.",
        },
        Key {
            name: "module_mm",
            kind: Kind::Number(Range::closed(0.1, 50.0)),
            unit: "mm",
            default: Default::Required,
            example: "3.0",
            teach: "Module m: every tooth takes pi x m of the pitch curve.",
        },
        Key {
            name: "teeth",
            kind: Kind::Whole { min: 4, max: 2000 },
            unit: "",
            default: Default::Required,
            example: "42",
            teach: "Number of teeth z on the closed pitch curve.",
        },
        Key {
            name: "pressure_angle_deg",
            kind: Kind::Number(Range::closed(5.0, 45.0)),
            unit: "deg",
            default: Default::Number(20.0),
            example: "20.0",
            teach: "Pressure angle of gear and cutter on the pitch curve.",
        },
        Key {
            name: "face_width_mm",
            kind: Kind::Number(Range::closed(0.1, 1000.0)),
            unit: "mm",
            default: Default::Derived("10 x module, at most 1000"),
            example: "30.0",
            teach: "Face width B of the blank.",
        },
        Key {
            name: "addendum_coefficient",
            kind: Kind::Number(Range::closed(0.1, 2.0)),
            unit: "modules",
            default: Default::Number(1.0),
            example: "1.0",
            teach: "Height of the blank's outline over the pitch curve, towards the tips of the teeth, less the \
                    profile shift.",
        },
        Key::number(
            "profile_shift_coefficient",
            "modules",
            Range::closed(-1.5, 1.5),
            0.0,
            "0.3",
            "Profile shift x: teeth are 2 x m tan(alpha) thicker on the pitch curve, tips and roots lie x modules \
             further towards the tips. Every operation gets it. In a ring that is the sign of DIN 3960, whose rings \
             have negative numbers of teeth; tables that count a ring's teeth as positive (JIS, KHK) have the other \
             one: their +0.3 is -0.3 here.",
        ),
        Key {
            name: "bore_diameter_mm",
            kind: Kind::Number(Range::closed(0.0, 10000.0)),
            unit: "mm",
            default: Default::Number(0.0),
            example: "20.0",
            teach: "Bore around the gear axis, for meshes and pictures; 0 is a solid blank.",
        },
        Key {
            name: "rim_mm",
            kind: Kind::Number(Range::above(0.0, 1000.0)),
            unit: "mm",
            default: Default::LeftOut("5 x module; external gears have none"),
            example: "10.0",
            teach: "Ring of an internal gear: it is round outside, so much larger than the largest radius of the pitch \
                    curve. The roots take about 1.25 modules of it.",
        },
        Key {
            name: "tooth_thickness_allowance_mm",
            kind: Kind::Number(Range::closed(-5.0, 5.0)),
            unit: "mm",
            default: Default::Number(0.0),
            example: "-0.08",
            teach: "Change of the tooth thickness on the pitch curve; negative makes thinner teeth and so \
                    backlash.",
        },
        Key {
            name: "center_distance_mm",
            kind: Kind::Number(Range::above(0.0, 20000.0)),
            unit: "mm",
            default: Default::LeftOut("that of the profile shifts of both gears; not for cutting"),
            example: "56.5",
            teach: "Distance of the axes at which `gearcut pair` rolls the gear with another one.",
        },
    ],
    "The gear to cut and its blank.",
)];

/// Keys of a process that cuts helical gears: it adds them to `[gear]`.
pub static HELIX: Addition = Addition {
    path: "gear",
    keys: &[
        Key {
            name: "helix_angle_deg",
            kind: Kind::Number(Range::closed(0.0, 45.0)),
            unit: "deg",
            default: Default::Number(0.0),
            example: "10.5",
            teach: "Helix angle on the pitch curve; 0 is a spur gear. Module and pressure angle are those of the \
                    normal section.",
        },
        Key {
            name: "hand",
            kind: Kind::Word(&["right", "left"]),
            unit: "",
            default: Default::Word("right"),
            example: "\"right\"",
            teach: "Hand of the helix.",
        },
    ],
    groups: &[],
};
