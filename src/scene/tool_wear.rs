//! `[tool.NAME.wear]`: how a tool wears, for every tool whose chips are followed along its edge.
//!
//! In: values of the section. Out: [`WearSpec`]; a limit without a life, and constants outside of their ranges, are
//! refused.

use super::keys::{Default, Group, Key, KeySection, Kind, Range, Role};
use super::problems::Found;
use super::values::Values;

const MM_PER_M: f64 = 1e3;
const S_PER_MIN: f64 = 60.0;

/// What is known of the length of cut L_1 that an edge lasts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WearLife {
    /// L_1 with the ends of its range.
    Length {
        /// L_1, mm.
        mm: f64,
        /// Ends; `None` where no range is named, mm.
        ends_mm: Option<[f64; 2]>,
    },
    /// Gears that this tool was seen to cut until the limit: L_1 is fitted.
    Gears(f64),
}

/// How a tool wears.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WearSpec {
    /// Wear VB at which the tool is reground, mm.
    pub limit_mm: f64,
    /// L_1.
    pub life: WearLife,
    /// x.
    pub thickness_exponent: f64,
    /// Ends of its range, if it has one.
    pub thickness_exponent_ends: Option<[f64; 2]>,
    /// h_1, mm.
    pub thickness_mm: f64,
    /// v_1, mm/s; `None`: the tool's own in the finishing operation.
    pub speed_mm_per_s: Option<f64>,
    /// n.
    pub taylor_exponent: f64,
}

/// The section of a tool.
pub(crate) const fn section(path: &'static str) -> KeySection {
    KeySection {
        path,
        role: Role::Plain,
        keys: KEYS,
        groups: &[Group { names: &["life_m", "gears_to_limit"], required: false }],
        teach: "Wear of the tool's teeth by Taylor's law with the chip's thickness; none is computed without \
            limit_mm.",
    }
}

const KEYS: &[Key] = &[
    Key::optional(
        "limit_mm",
        "mm",
        Range::above(0.0, 5.0),
        "no wear is computed",
        "0.2",
        "Width VB of the worn flank at which the tool is reground; needs life_m or gears_to_limit.",
    ),
    Key::optional(
        "life_m",
        "m",
        Range::above(0.0, 1e6),
        "gears_to_limit says how long an edge lasts",
        "20.0",
        "L_1: length of cut after which an edge is worn to limit_mm by chips of thickness_mm at speed_m_per_min.",
    ),
    Key {
        name: "life_range_m",
        kind: Kind::Pair(Range::above(0.0, 1e6)),
        unit: "m",
        default: Default::LeftOut("no interval"),
        example: "[18.0, 22.0]",
        teach: "Smallest and largest L_1 that is taken for possible; results get intervals by it.",
    },
    Key {
        name: "gears_to_limit",
        kind: Kind::Whole { min: 2, max: 1_000_000 },
        unit: "",
        default: Default::LeftOut("life_m says how long an edge lasts"),
        example: "12",
        teach: "Gears of this scene that the tool was seen to cut until limit_mm: L_1 is fitted to them.",
    },
    Key::number(
        "thickness_exponent",
        "",
        Range::closed(0.0, 10.0),
        1.0,
        "1.0",
        "x: life falls with the chip's thickness to this power; at 1 an edge wears by the volume that passes over \
        a length of it.",
    ),
    Key {
        name: "thickness_exponent_range",
        kind: Kind::Pair(Range::closed(0.0, 10.0)),
        unit: "",
        default: Default::LeftOut("no interval"),
        example: "[0.5, 1.5]",
        teach: "Smallest and largest x that is taken for possible; results get intervals by it.",
    },
    Key::number(
        "thickness_mm",
        "mm",
        Range::closed(0.001, 10.0),
        0.1,
        "0.1",
        "h_1: chip thickness for which L_1 holds. Near the mean thickness at the place that wears first, L_1 \
        hardly depends on x.",
    ),
    Key {
        name: "speed_m_per_min",
        kind: Kind::Number(Range::above(0.0, 10_000.0)),
        unit: "m/min",
        default: Default::Derived("the tool's own in the finishing operation"),
        example: "70.0",
        teach: "v_1: cutting speed for which L_1 holds: of a hob that of its tip, of a shaper cutter the largest of \
            a stroke.",
    },
    Key::number(
        "taylor_exponent",
        "",
        Range::closed(0.05, 1.0),
        0.125,
        "0.125",
        "n of Taylor's v T^n = C: life as a time falls with the speed to the power 1/n; 1/8 is Taylor's for \
        high-speed steel (1907).",
    ),
];

/// What a section says; `None` where it names no limit, and no wear is computed.
pub(crate) fn spec(values: &Values, section: &str) -> Option<WearSpec> {
    let wear = values.view(section);
    let ends = |key: &str| wear.numbers(key).and_then(|ends| <[f64; 2]>::try_from(ends).ok());
    let life = match (wear.number("life_m"), wear.whole("gears_to_limit")) {
        (Some(m), _) => {
            WearLife::Length { mm: m * MM_PER_M, ends_mm: ends("life_range_m").map(|ends| ends.map(|m| m * MM_PER_M)) }
        }
        (None, Some(gears)) => WearLife::Gears(f64::from(gears)),
        (None, None) => return None,
    };
    Some(WearSpec {
        limit_mm: wear.number("limit_mm")?,
        life,
        thickness_exponent: wear.number("thickness_exponent")?,
        thickness_exponent_ends: ends("thickness_exponent_range"),
        thickness_mm: wear.number("thickness_mm")?,
        speed_mm_per_s: wear.number("speed_m_per_min").map(|m_per_min| m_per_min * MM_PER_M / S_PER_MIN),
        taylor_exponent: wear.number("taylor_exponent")?,
    })
}

/// A wear without a limit or a life, or with constants outside of their ranges.
pub(crate) fn check(found: &mut Found, section: &str) {
    let wear = found.view(section);
    let path = |key: &str| format!("{section}.{key}");
    let is_written = |key: &&str| found.values.is_written(section, key);
    let lives = ["life_m", "gears_to_limit"];
    let of_life = lives.iter().copied().find(|key| is_written(key));
    let others = ["life_range_m", "thickness_exponent_range"];
    let lonely = of_life.or(others.iter().copied().find(|key| is_written(key))).filter(|_| !is_written(&"limit_mm"));
    let has_limit = wear.number("limit_mm").is_some();
    if let Some(key) = lonely {
        let message = || format!("`{}` without `{}`: no wear is computed", path(key), path("limit_mm"));
        found.blame(
            true,
            &path(key),
            message,
            "write limit_mm, the VB at which the tool is reground (0.2 mm is usual)",
        );
    }
    let message =
        || format!("`{}` without `life_m` or `gears_to_limit`: nothing says how long an edge lasts", path("limit_mm"));
    let way_out = "write life_m (m of cut until limit_mm), or gears_to_limit (gears that this tool cut) to fit it";
    found.blame(has_limit && of_life.is_none(), &path("limit_mm"), message, way_out);
    let is_fitted = wear.whole("gears_to_limit").is_some();
    for (key, range) in [("life_m", "life_range_m"), ("thickness_exponent", "thickness_exponent_range")] {
        let Some(&[from, to]) = wear.numbers(range) else { continue };
        let blamed = path(range);
        let message = || format!("`{blamed}` = [{from}, {to}]: the first end is the larger one");
        found.blame(from > to, &blamed, message, "write the smaller one first");
        let Some(value) = wear.number(key) else {
            let message = || format!("`{blamed}` without `{}`: a fitted life has its interval from the fit", path(key));
            found.blame(is_fitted, &blamed, message, "leave it out, or write life_m in place of gears_to_limit");
            continue;
        };
        let message = || format!("`{blamed}` = [{from}, {to}] does not hold `{}` = {value}", path(key));
        found.blame(from <= to && (value < from || value > to), &blamed, message, "widen the range, or move the value");
    }
}
