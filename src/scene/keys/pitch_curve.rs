//! Keys of pitch curves: the gear's own, and that of the driver whose mate it is.
//!
//! Each kind of curve is written once and listed under both tables that may hold it.

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

/// A round curve, under the given path.
const fn circle(path: &'static str) -> KeySection {
    const KEYS: &[Key] = &[];
    KeySection::new(path, Role::Variant, KEYS, "A round gear: r = module x teeth / 2.")
}

/// An ellipse of order n, under the given path.
const fn ellipse(path: &'static str) -> KeySection {
    const KEYS: &[Key] = &[
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
    ];
    KeySection::new(
        path,
        Role::Variant,
        KEYS,
        "Ellipse of order n turning about its focus: r = a (1 - k^2) / (1 - k cos n phi).",
    )
}

/// Of every curve by a ratio.
const CENTER_DISTANCE: Key = Key {
    name: "center_distance_mm",
    kind: Kind::Number(Range::above(0.0, 20000.0)),
    unit: "mm",
    default: Default::LeftOut("solved so that the curve closes on its teeth"),
    example: "120.0",
    teach: "C of the pair. Leave it out, and the size is solved so that the perimeter is pi x module x teeth.",
};

/// The driver of a sinusoidal ratio, under the given path.
const fn sinusoidal_ratio(path: &'static str) -> KeySection {
    const KEYS: &[Key] = &[
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
            kind: Kind::Number(Range::closed(-100.0, 100.0)),
            unit: "",
            default: Default::Required,
            example: "0.1",
            teach: "b, how far the ratio swings; smaller than c. Negative: it falls first.",
        },
        CENTER_DISTANCE,
    ];
    KeySection::new(
        path,
        Role::Variant,
        KEYS,
        "Driver of a pair with the ratio i(phi) = c + b sin n phi: r = C / (1 + i).",
    )
}

/// Pascal's limacon, under the given path.
const fn pascal(path: &'static str) -> KeySection {
    const KEYS: &[Key] = &[ORDER, ECCENTRICITY, MEAN_RADIUS];
    KeySection::new(path, Role::Variant, KEYS, "Pascal's limacon: r = R (1 + k cos n phi).")
}

/// A Fourier series, under the given path.
const fn fourier(path: &'static str) -> KeySection {
    const KEYS: &[Key] = &[
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
    ];
    KeySection::new(
        path,
        Role::Variant,
        KEYS,
        "Any smooth curve by its harmonics: r = R (1 + sum of c_j cos j phi + s_j sin j phi).",
    )
}

/// The radius by a formula, under the given path.
const fn radius_formula(path: &'static str) -> KeySection {
    const KEYS: &[Key] = &[
        Key {
            name: "radius",
            kind: Kind::Formula,
            unit: "",
            default: Default::Required,
            example: "\"1 + 0.1*cos(2*phi)\"",
            teach: "The radius over its scale, by the polar angle phi in rad: numbers, pi, + - * / ^ and brackets; \
                sin, cos, tan, sqrt, exp.",
        },
        Key {
            name: "scale_mm",
            kind: Kind::Number(Range::above(0.0, 20000.0)),
            unit: "mm",
            default: Default::LeftOut("solved so that the curve closes on its teeth"),
            example: "45.0",
            teach: "What the formula is multiplied by; 1 where it gives mm. Leave it out, and the size is solved so \
                that the perimeter is pi x module x teeth.",
        },
    ];
    KeySection::new(path, Role::Variant, KEYS, "Any smooth curve by a formula of its radius.")
}

/// The ratio by a formula, under the given path.
const fn ratio_formula(path: &'static str) -> KeySection {
    const KEYS: &[Key] = &[
        Key {
            name: "ratio",
            kind: Kind::Formula,
            unit: "",
            default: Default::Required,
            example: "\"1 + 0.1*sin(2*phi)\"",
            teach: "i, the angular speed of this gear over that of its mate, by the polar angle phi of this gear in \
                rad; of a ring below 1. Numbers, pi, + - * / ^ and brackets; sin, cos, tan, sqrt, exp.",
        },
        CENTER_DISTANCE,
    ];
    KeySection::new(
        path,
        Role::Variant,
        KEYS,
        "Any smooth ratio by a formula: r = C / (1 + i) of an external gear, r = C / (1 - i) of a ring.",
    )
}

/// A spline through points, under the given path.
const fn table(path: &'static str) -> KeySection {
    const KEYS: &[Key] = &[
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
            teach: "The same points from a CSV file with the header phi_deg,radius_mm (# begins a comment); a wish for \
                a motion with the header phi_deg,mate_deg, angles of the mate at angles of this gear over a whole \
                turn, both ends included; or the curve round the origin of a drawing (.dxf). The path is relative to \
                the scene.",
        },
        Key {
            name: "scale_to_close",
            kind: Kind::Boolean,
            unit: "",
            default: Default::LeftOut("scaled by at most 1 %; points that need more are refused"),
            example: "true",
            teach: "Scale the radii by any factor so that the perimeter is exactly pi x module x teeth; false takes \
                the points as they are.",
        },
    ];
    KeySection {
        path,
        role: Role::Variant,
        keys: KEYS,
        groups: &[Group { names: &["points_deg_mm", "file"], required: true }],
        teach: "Periodic spline through given points.",
    }
}

/// `[gear.pitch_curve]` and what is inside it.
pub(super) static SECTIONS: &[KeySection] = &[
    KeySection::new(
        "gear.pitch_curve",
        Role::Choice { default: Some("circle"), what: "pitch curve" },
        &[],
        "Shape of the closed pitch curve r(phi) on which the tooth spaces are rolled; a space is centred on phi \
            = 0.",
    ),
    circle("gear.pitch_curve.circle"),
    ellipse("gear.pitch_curve.ellipse"),
    sinusoidal_ratio("gear.pitch_curve.sinusoidal_ratio"),
    pascal("gear.pitch_curve.pascal"),
    fourier("gear.pitch_curve.fourier"),
    radius_formula("gear.pitch_curve.radius_formula"),
    ratio_formula("gear.pitch_curve.ratio_formula"),
    table("gear.pitch_curve.table"),
    KeySection::new(
        "gear.pitch_curve.mate",
        Role::Variant,
        &[
            Key {
                name: "driver_teeth",
                kind: Kind::Whole { min: 4, max: 2000 },
                unit: "",
                default: Default::Required,
                example: "34",
                teach: "Number of teeth of the driver. After one turn of this gear the driver must look the same as \
                    before it.",
            },
            Key {
                name: "start_deg",
                kind: Kind::Number(Range::closed(-360.0, 360.0)),
                unit: "deg",
                default: Default::LeftOut("the middle of the driver's first tooth, so that the gears mesh"),
                example: "0.0",
                teach: "Polar angle of the driver that meets this gear's polar angle 0.",
            },
        ],
        "The gear that runs with a driver: r2 = a - r1, for an internal gear r2 = a + r1. The distance of the \
            axes a is solved so that the curve closes.",
    ),
    KeySection::new(
        "gear.pitch_curve.mate.driver",
        Role::Choice { default: Some("circle"), what: "pitch curve of the driver" },
        &[],
        "Shape of the driver's pitch curve.",
    ),
    circle("gear.pitch_curve.mate.driver.circle"),
    ellipse("gear.pitch_curve.mate.driver.ellipse"),
    sinusoidal_ratio("gear.pitch_curve.mate.driver.sinusoidal_ratio"),
    pascal("gear.pitch_curve.mate.driver.pascal"),
    fourier("gear.pitch_curve.mate.driver.fourier"),
    radius_formula("gear.pitch_curve.mate.driver.radius_formula"),
    ratio_formula("gear.pitch_curve.mate.driver.ratio_formula"),
    table("gear.pitch_curve.mate.driver.table"),
];
