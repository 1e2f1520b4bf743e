//! Keys of the gear and of its pitch curve.

use super::{Default, Group, Key, KeySection, Kind, Range, Role};

/// Order n of a curve: how many times it repeats in one turn.
const ORDER: Key = Key {
    name: "order",
    kind: Kind::Whole { min: 1, max: 24 },
    unit: "",
    default: Default::Required,
    example: "2",
    teach: "How many times the curve repeats in one turn: 1 an eccentric oval, 2 an oval, 3 a rounded triangle.",
};

/// Eccentricity k, common to ellipse and limacon.
const ECCENTRICITY: Key = Key {
    name: "eccentricity",
    kind: Kind::Number(Range::below(0.0, 1.0)),
    unit: "",
    default: Default::Required,
    example: "0.1",
    teach: "k, how far the curve departs from a circle (0 is a circle). It turns concave beyond 1 / (n^2 - 1) for an \
        ellipse, beyond 1 / (n^2 + 1) for a limacon.",
};

/// Mean radius R, common to limacon and Fourier series.
const MEAN_RADIUS: Key = Key {
    name: "mean_radius_mm",
    kind: Kind::Number(Range::above(0.0, 20000.0)),
    unit: "mm",
    default: Default::LeftOut("solved so that the curve closes on its teeth"),
    example: "45.0",
    teach: "R. Leave it out, and the size is solved so that the perimeter is pi x module x teeth.",
};

/// `[gear]` and what is inside it.
pub(super) static SECTIONS: &[KeySection] = &[
    KeySection {
        path: "gear",
        role: Role::Plain,
        keys: &[
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
                name: "helix_angle_deg",
                kind: Kind::Number(Range::closed(0.0, 45.0)),
                unit: "deg",
                default: Default::Number(0.0),
                example: "10.5",
                teach: "Helix angle on the pitch curve; 0 is a spur gear. Module and pressure angle are those of the \
                    normal section. Not every process cuts helical gears; one that does not refuses them.",
            },
            Key {
                name: "hand",
                kind: Kind::Word(&["right", "left"]),
                unit: "",
                default: Default::Word("right"),
                example: "\"right\"",
                teach: "Hand of the helix.",
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
                teach: "How far the blank's outline stands over the pitch curve.",
            },
            Key {
                name: "bore_diameter_mm",
                kind: Kind::Number(Range::closed(0.0, 10000.0)),
                unit: "mm",
                default: Default::Number(0.0),
                example: "20.0",
                teach: "Bore around the gear axis, for meshes and pictures; 0 is a solid blank.",
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
        ],
        groups: &[],
        teach: "The gear to cut and its blank.",
    },
    KeySection {
        path: "gear.pitch_curve",
        role: Role::Choice { default: Some("circle"), what: "pitch curve" },
        keys: &[],
        groups: &[],
        teach: "Shape of the closed pitch curve r(phi) on which the tooth spaces are rolled; a space is centred on phi \
            = 0.",
    },
    KeySection {
        path: "gear.pitch_curve.circle",
        role: Role::Variant,
        keys: &[],
        groups: &[],
        teach: "A round gear: r = module x teeth / 2.",
    },
    KeySection {
        path: "gear.pitch_curve.ellipse",
        role: Role::Variant,
        keys: &[
            ORDER,
            ECCENTRICITY,
            Key {
                name: "semi_major_axis_mm",
                kind: Kind::Number(Range::above(0.0, 20000.0)),
                unit: "mm",
                default: Default::LeftOut("solved so that the curve closes on its teeth"),
                example: "61.11",
                teach: "a. Leave it out, and the size is solved so that the perimeter is pi x module x teeth.",
            },
        ],
        groups: &[],
        teach: "Ellipse of order n turning about its focus: r = a (1 - k^2) / (1 - k cos n phi).",
    },
    KeySection {
        path: "gear.pitch_curve.sinusoidal_ratio",
        role: Role::Variant,
        keys: &[
            ORDER,
            Key {
                name: "mean_ratio",
                kind: Kind::Number(Range::above(0.0, 100.0)),
                unit: "",
                default: Default::Required,
                example: "1.0",
                teach: "c, the ratio about which the transmission swings.",
            },
            Key {
                name: "ratio_amplitude",
                kind: Kind::Number(Range::closed(0.0, 100.0)),
                unit: "",
                default: Default::Required,
                example: "0.1",
                teach: "b, how far the ratio swings; smaller than c.",
            },
            Key {
                name: "center_distance_mm",
                kind: Kind::Number(Range::above(0.0, 20000.0)),
                unit: "mm",
                default: Default::LeftOut("solved so that the curve closes on its teeth"),
                example: "120.0",
                teach: "C of the pair. Leave it out, and the size is solved so that the perimeter is pi x module x \
                    teeth.",
            },
        ],
        groups: &[],
        teach: "Driver of a pair with the ratio i(phi) = c + b sin n phi: r = C / (1 + i).",
    },
    KeySection {
        path: "gear.pitch_curve.pascal",
        role: Role::Variant,
        keys: &[ORDER, ECCENTRICITY, MEAN_RADIUS],
        groups: &[],
        teach: "Pascal's limacon: r = R (1 + k cos n phi).",
    },
    KeySection {
        path: "gear.pitch_curve.fourier",
        role: Role::Variant,
        keys: &[
            Key {
                name: "cosine",
                kind: Kind::Numbers { range: Range::closed(-1.0, 1.0), most: 64 },
                unit: "relative to R",
                default: Default::EmptyList,
                example: "[0.0, 0.08]",
                teach: "c_1, c_2, ...: the factors of cos phi, cos 2 phi, ...",
            },
            Key {
                name: "sine",
                kind: Kind::Numbers { range: Range::closed(-1.0, 1.0), most: 64 },
                unit: "relative to R",
                default: Default::EmptyList,
                example: "[0.0, 0.0, 0.02]",
                teach: "s_1, s_2, ...: the factors of sin phi, sin 2 phi, ...",
            },
            MEAN_RADIUS,
        ],
        groups: &[],
        teach: "Any smooth curve by its harmonics: r = R (1 + sum of c_j cos j phi + s_j sin j phi).",
    },
    KeySection {
        path: "gear.pitch_curve.table",
        role: Role::Variant,
        keys: &[
            Key {
                name: "points_deg_mm",
                kind: Kind::Points {
                    angle: Range::below(0.0, 360.0),
                    radius: Range::above(0.0, 20000.0),
                    fewest: 4,
                    most: 100_000,
                },
                unit: "deg, mm",
                default: Default::OneOfGroup,
                example: "[[0.0, 60.0], [90.0, 50.0], [180.0, 60.0], [270.0, 50.0]]",
                teach: "Polar angles, increasing, and radii; the curve closes by itself, so the first point is not \
                    repeated at 360.",
            },
            Key {
                name: "file",
                kind: Kind::Path,
                unit: "",
                default: Default::OneOfGroup,
                example: "\"points.csv\"",
                teach: "The same points from a CSV file with the header phi_deg,radius_mm; the path is relative to the \
                    scene, # begins a comment.",
            },
            Key {
                name: "scale_to_close",
                kind: Kind::Boolean,
                unit: "",
                default: Default::Boolean(true),
                example: "true",
                teach: "Scale the radii so that the perimeter is exactly pi x module x teeth; measured points seldom \
                    close by themselves.",
            },
        ],
        groups: &[Group { names: &["points_deg_mm", "file"], required: true }],
        teach: "Periodic spline through given points.",
    },
];
