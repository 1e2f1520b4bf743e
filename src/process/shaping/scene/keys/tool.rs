//! Keys of the shaper cutter.

use crate::scene::drawn_profile::TOLERANCE;
use crate::scene::keys::{Default, Group, Key, KeySection, Kind, Range, Role};
use crate::scene::tool_wear;

/// Section of how flanks are ground.
pub const GRINDING: &str = "tool.shaper_cutter.grinding";
/// Section of the edges' roughness.
pub const EDGE_ROUGHNESS: &str = "tool.shaper_cutter.edge_roughness";
/// Section of the edges' rounding.
pub const EDGE_ROUNDING: &str = "tool.shaper_cutter.edge_rounding";
/// Section of what builds up on edges.
pub const BUILT_UP_EDGE: &str = "tool.shaper_cutter.built_up_edge";
/// Section of the cutter's wear.
pub const WEAR: &str = "tool.shaper_cutter.wear";
/// Section of a contour in place of involute teeth.
pub const PROFILE: &str = "tool.shaper_cutter.profile";
/// Keys of a built-up edge, each of which needs all others.
pub const BUILT_UP_EDGE_KEYS: [&str; 9] = [
    "density_per_mm2",
    "speeds_m_per_min",
    "full_speeds_m_per_min",
    "chip_um",
    "chip_exponent",
    "depth_um",
    "width_um",
    "scratch_share",
    "scratch_length_um",
];
/// Cutting speeds, m/min.
const SPEEDS: Range = Range::closed(0.0, 1000.0);

/// `[tool.shaper_cutter]` and what is inside it.
pub(super) static SECTIONS: &[KeySection] = &[
    KeySection::new(
        "tool.shaper_cutter",
        Role::Variant,
        &[
            Key {
                name: "teeth",
                kind: Kind::Whole { min: 5, max: 300 },
                unit: "",
                default: Default::Required,
                example: "20",
                teach: "Number of cutter teeth z0; module and pressure angle are the gear's.",
            },
            Key {
                name: "addendum_coefficient",
                kind: Kind::Number(Range::closed(0.1, 2.5)),
                unit: "modules",
                default: Default::Number(1.25),
                example: "1.25",
                teach: "Height of the cutter tooth over its pitch circle; 1.25 gives the gear a root clearance of a \
                    quarter module.",
            },
            Key {
                name: "dedendum_coefficient",
                kind: Kind::Number(Range::closed(0.1, 2.5)),
                unit: "modules",
                default: Default::Number(1.25),
                example: "1.25",
                teach: "Depth of the cutter's tooth space under its pitch circle; more than the gear's addendum, or \
                    the cutter tops the gear.",
            },
            Key {
                name: "profile_shift_coefficient",
                kind: Kind::Number(Range::closed(-2.0, 2.0)),
                unit: "modules",
                default: Default::Number(0.0),
                example: "0.0",
                teach: "Profile shift x0 of the cutter; a new cutter has a positive one that falls with every \
                    regrinding. Every operation is set to the depth at which the gear's teeth come out with the gear's \
                    own x, as shops set it by span or balls.",
            },
            Key {
                name: "thinning_mm",
                kind: Kind::Number(Range::closed(-5.0, 5.0)),
                unit: "mm",
                default: Default::Number(0.0),
                example: "0.3",
                teach: "Thickness taken off every cutter tooth on the pitch circle, as on a roughing cutter.",
            },
            Key {
                name: "rake_angle_deg",
                kind: Kind::Number(Range::closed(-20.0, 30.0)),
                unit: "deg",
                default: Default::Number(0.0),
                example: "5.0",
                teach: "Top rake of the dished rake face: inclines the flanks' edges and changes cutting forces; \
                    shapes only with [tool.shaper_cutter.grinding] (without it the profile is the edge's \
                    projection). 0: a flat face square to the stroke.",
            },
            Key {
                name: "runout_um",
                kind: Kind::Number(Range::closed(0.0, 1000.0)),
                unit: "um",
                default: Default::Number(0.0),
                example: "8.0",
                teach: "Distance of the cutter's profile axis from its spindle axis.",
            },
            Key {
                name: "runout_angle_deg",
                kind: Kind::Number(Range::closed(-360.0, 360.0)),
                unit: "deg",
                default: Default::Number(0.0),
                example: "0.0",
                teach: "Direction of the runout in the cutter, counted from cutter tooth 0.",
            },
            Key {
                name: "pitch_errors_um",
                kind: Kind::Numbers { range: Range::closed(-1000.0, 1000.0), most: 300 },
                unit: "um",
                default: Default::EmptyList,
                example: "[]",
                teach: "Cumulative pitch error of each cutter tooth on the pitch circle, positive counter-clockwise: \
                    one value per tooth, or none.",
            },
        ],
        "Shaper cutter by its profile projected on the transverse plane.",
    ),
    KeySection::new(
        PROFILE,
        Role::Plain,
        &[
            Key {
                name: "file",
                kind: Kind::Path,
                unit: "",
                default: Default::LeftOut("involute teeth"),
                example: "\"tooth.csv\"",
                teach: "Contour of one cutter tooth, open, from root over tip to root: a table headed x_mm,y_mm (or \
                    _um, _in), or a drawing (.dxf; layer TOOTH, if there is one). x runs across the tooth, y from the \
                    cutter's axis outwards along its centre line.",
            },
            TOLERANCE,
        ],
        "Cutter tooth that is drawn or measured: any profile. The gear is judged against what that edge generates. A \
            point where the contour turns by more than 11.5 deg, or lies 20 um beside the chord of its neighbours, is \
            a corner and stays one.",
    ),
    KeySection::new(
        GRINDING,
        Role::Plain,
        &[
            Key::number(
                "tip_relief_angle_deg",
                "deg",
                Range::closed(0.0, 20.0),
                0.0,
                "6.0",
                "Relief of the tip; that of the flanks follows from it. With a rake, edges are no involutes.",
            ),
            Key {
                name: "pressure_angle_deg",
                kind: Kind::Number(Range::closed(5.0, 45.0)),
                unit: "deg",
                default: Default::Derived("corrected for rake and relief"),
                example: "20.17",
                teach: "Pressure angle with which the flanks are ground, in the normal section as the gear's, within \
                    3 deg of it; tan(alpha) / (1 - tan(rake) tan(relief)) is usual.",
            },
        ],
        "How the cutter's flanks are ground: with rake and relief their projected edges deviate from involutes by some \
            micrometres, and so does every flank that they cut.",
    ),
    tool_wear::section(WEAR),
    KeySection {
        path: EDGE_ROUGHNESS,
        role: Role::Plain,
        keys: &[
            Key::optional(
                "rq_um",
                "um",
                Range::closed(0.0, 20.0),
                "smooth edges",
                "0.4",
                "Rq, root mean square height of the edge's roughness; needs correlation_length_um.",
            ),
            Key::optional(
                "correlation_length_um",
                "um",
                Range::closed(3.0, 1000.0),
                "none",
                "25.0",
                "Arc l along the edge at which the autocovariance Rq^2 exp(-(s / l)^2) has fallen to 1/e.",
            ),
            Key {
                name: "seed",
                kind: Kind::Whole { min: 0, max: u32::MAX },
                unit: "",
                default: Default::Whole(1),
                example: "1",
                teach: "Which cutter: each flank of each tooth has a roughness of its own.",
            },
            Key {
                name: "profile",
                kind: Kind::Path,
                unit: "",
                default: Default::LeftOut("none"),
                example: "\"edge.csv\"",
                teach: "Measured profile instead, the same on all flanks: a table headed position_um,height_um \
                    (or _mm, _nm), the position from the tip corner along the flank, heights out of the tooth.",
            },
        ],
        groups: &[Group { names: &["rq_um", "profile"], required: false }],
        teach: "Roughness of the cutter's edges along its flanks: every stroke copies what touches the gear.",
    },
    KeySection::new(
        EDGE_ROUNDING,
        Role::Plain,
        &[
            Key::optional(
                "radius_um",
                "um",
                Range::above(0.0, 200.0),
                "sharp edges",
                "5.0",
                "Radius r_beta of the cutting edge across its length; needs minimum_chip_share.",
            ),
            Key::optional(
                "minimum_chip_share",
                "",
                Range::above(0.0, 1.0),
                "none",
                "0.3",
                "Thickness h_min of the thinnest chip that is cut, over the radius; thinner ones are ploughed under.",
            ),
            Key {
                name: "recovery_share",
                kind: Kind::Number(Range::closed(0.0, 1.0)),
                unit: "",
                default: Default::Number(1.0),
                example: "1.0",
                teach: "Share of what is ploughed that springs back behind the edge; the rest stays pressed down.",
            },
        ],
        "Rounding of the cutter's edges: strokes that meet less than a thinnest chip cut nothing. Flanks, roots \
            and tips are then followed in strict order of strokes.",
    ),
    KeySection::new(
        BUILT_UP_EDGE,
        Role::Plain,
        &[
            Key::optional(
                "density_per_mm2",
                "1/mm^2",
                Range::above(0.0, 1000.0),
                "no marks",
                "20.0",
                "Marks to a square millimetre of flank where cutting speed and chip favour them most; needs all other \
                keys of the section.",
            ),
            Key {
                name: "speeds_m_per_min",
                kind: Kind::Pair(SPEEDS),
                unit: "m/min",
                default: Default::LeftOut("none"),
                example: "[2.0, 60.0]",
                teach: "Cutting speeds between which an edge builds up; there are no marks outside of them.",
            },
            Key {
                name: "full_speeds_m_per_min",
                kind: Kind::Pair(SPEEDS),
                unit: "m/min",
                default: Default::LeftOut("none"),
                example: "[10.0, 30.0]",
                teach: "Cutting speeds between which marks are densest; towards speeds_m_per_min the density falls in \
                    straight lines.",
            },
            Key::optional(
                "chip_um",
                "um",
                Range::above(0.0, 1000.0),
                "none",
                "0.5",
                "Thickness h_0 of the chip that left a place, from which on its density is full, or up to which, by \
                the exponent's sign.",
            ),
            Key::optional(
                "chip_exponent",
                "",
                Range::closed(-4.0, 4.0),
                "none",
                "1.0",
                "p: behind a chip h thick the density is min(1, (h / h_0)^p) of the full one.",
            ),
            Key::optional(
                "depth_um",
                "um",
                Range::above(0.0, 100.0),
                "none",
                "2.0",
                "Mean depth of marks in their middle; depths are exponential.",
            ),
            Key::optional(
                "width_um",
                "um",
                Range::above(0.0, 500.0),
                "none",
                "40.0",
                "Mean width of marks along the profile; widths and lengths are even between 0 and twice their means.",
            ),
            Key::optional(
                "scratch_share",
                "",
                Range::closed(0.0, 1.0),
                "none",
                "0.4",
                "Share of marks that are scratches; the others are pits, in the mean as long as wide.",
            ),
            Key::optional(
                "scratch_length_um",
                "um",
                Range::above(0.0, 5000.0),
                "none",
                "300.0",
                "Mean length of scratches along the stroke.",
            ),
        ],
        "Pits and scratches that fragments of a built-up edge tear into flanks (docs/edge.md). No key has a \
            default. Which marks, machine.errors.seed says.",
    ),
    KeySection::new(
        "tool.shaper_cutter.tip",
        Role::Choice { default: Some("sharp"), what: "tip" },
        &[],
        "Shape of the cutter's tip corners, which form the gear's root fillets.",
    ),
    KeySection::new("tool.shaper_cutter.tip.sharp", Role::Variant, &[], "Sharp corners."),
    KeySection::new(
        "tool.shaper_cutter.tip.round",
        Role::Variant,
        &[Key {
            name: "radius_mm",
            kind: Kind::Number(Range::above(0.0, 50.0)),
            unit: "mm",
            default: Default::Required,
            example: "0.6",
            teach: "Radius of the round; about 0.2 modules is common. The tip of a full-depth cutter of 20 deg has \
                room for 0.25 modules with 14 teeth, for 0.34 with 20, and for the 0.38 of ISO 53 from 27 on.",
        }],
        "Round tangent to flank and tip circle.",
    ),
    KeySection::new(
        "tool.shaper_cutter.tip.chamfer",
        Role::Variant,
        &[
            Key {
                name: "height_mm",
                kind: Kind::Number(Range::above(0.0, 50.0)),
                unit: "mm",
                default: Default::Required,
                example: "0.4",
                teach: "Where the chamfer meets the flank, counted down from the tip circle.",
            },
            Key {
                name: "angle_deg",
                kind: Kind::Number(Range { min: 0.0, max: 90.0, above_min: true, below_max: true }),
                unit: "deg",
                default: Default::Number(45.0),
                example: "45.0",
                teach: "Angle of the chamfer against the centre line of the tooth.",
            },
        ],
        "Straight chamfer between flank and tip circle.",
    ),
];
