//! Which parts of a result are written.
//!
//! In: names of parts, as they are typed after `--only`. Out: [`Parts`]. The numbers (`results.json`, `run.json`,
//! `tables/`, `inspection_charts.csv`) are always written. What is not asked for is neither drawn nor computed; what
//! is asked for has the same bytes as in a whole result.

/// A part that can be left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// `maps/`, `allowance/`, `deviation/`: every flank as PNG and EXR.
    Maps,
    /// `pictures/`: sheets of all flanks, charts over the teeth, drawn gears.
    Pictures,
    /// `mesh/`: the gear and every flank.
    Meshes,
    /// `texture/`: surfaces of the texture windows.
    Texture,
    /// `chips/` and `load/`, as far as the process has them: charts and maps of chips.
    Chips,
    /// `axes/`: tables, charts and programs of the axes.
    Axes,
    /// `report.html`, `report.pdf`, `inspection.svg`, `inspection.pdf`.
    Report,
}

/// The word for no part beyond the numbers.
pub const NUMBERS: &str = "numbers";

impl Part {
    /// All of them, in the order in which they are named.
    pub const ALL: [Self; 7] =
        [Self::Maps, Self::Pictures, Self::Meshes, Self::Texture, Self::Chips, Self::Axes, Self::Report];

    /// How it is called on the command line and in `run.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Maps => "maps",
            Self::Pictures => "pictures",
            Self::Meshes => "meshes",
            Self::Texture => "texture",
            Self::Chips => "chips",
            Self::Axes => "axes",
            Self::Report => "report",
        }
    }
}

/// A measurement that can be left out where nobody keeps its numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Texture windows.
    Texture,
    /// Rays through the whole blank; only shaped gears, whose chips do not come from there, can do without.
    Blank,
    /// The ledger of a shaper's chips, and the wear that follows from it.
    Chips,
    /// Stock in a shaped gear's roots.
    Roots,
    /// Allowances of a shaped gear's earlier operations on the pitch curve.
    Allowances,
}

impl Stage {
    const ALL: [Self; 5] = [Self::Texture, Self::Blank, Self::Chips, Self::Roots, Self::Allowances];

    /// Where its numbers are found: sections, those below an operation by their own keys, and keys of the headline.
    fn places(self) -> &'static [&'static str] {
        match self {
            Self::Texture => &["texture", "roughness", "marks"],
            Self::Blank => &["blank"],
            Self::Chips => &[
                "chips",
                "deflection",
                "vibration",
                "largest_chip_thickness",
                "largest_cutting_force",
                "removed_volume",
                "removal_rate",
                "largest_chip_section",
                "entry_cutting_force",
                "idle_strokes",
                "tool_wear",
            ],
            Self::Roots => &["root_stock"],
            Self::Allowances => &["allowance", "unevenness", "unevenness_max", "unevenness_mean"],
        }
    }

    /// Whether it finds what is at a path, or may find what a pattern with `*` means.
    fn finds(self, path: &str) -> bool {
        let mut keys = path.split('.');
        let place = match keys.next() {
            Some("operations") => keys.nth(1),
            first => first,
        };
        place.is_some_and(|place| place.contains('*') || self.places().contains(&place))
    }
}

/// The measurements that a run makes beside those of flanks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stages {
    /// One bit for each stage.
    bits: u8,
}

impl Stages {
    /// Every one.
    pub const ALL: Self = Self { bits: u8::MAX };

    /// Those that quantities at these paths need.
    pub fn of_paths(paths: &[String]) -> Self {
        let needed = Stage::ALL.into_iter().filter(|stage| paths.iter().any(|path| stage.finds(path)));
        Self { bits: needed.fold(0, |bits, stage| bits | 1 << stage as u8) }
    }

    /// Whether a stage is among them.
    pub fn has(self, stage: Stage) -> bool {
        self.bits & 1 << stage as u8 != 0
    }

    /// Whether what is found at a path comes from these stages or from flanks.
    pub fn find(self, path: &str) -> bool {
        Stage::ALL.into_iter().all(|stage| self.has(stage) || !stage.finds(path))
    }
}

/// A choice of parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parts {
    /// One bit for each part.
    bits: u8,
}

impl Parts {
    /// The numbers alone.
    pub const NONE: Self = Self { bits: 0 };

    /// The whole result.
    pub fn all() -> Self {
        Self::of(Part::ALL)
    }

    /// These parts and the numbers.
    pub fn of(parts: impl IntoIterator<Item = Part>) -> Self {
        Self { bits: parts.into_iter().fold(0, |bits, part| bits | 1 << part as u8) }
    }

    /// The parts of these names; `numbers` and names of no part add nothing.
    pub fn named<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        let part = |name| Part::ALL.into_iter().find(|part| part.name() == name);
        Self::of(names.into_iter().filter_map(part))
    }

    /// Whether a part is written.
    pub fn has(self, part: Part) -> bool {
        self.bits & 1 << part as u8 != 0
    }

    /// Whether any of these is written.
    pub fn has_any(self, parts: &[Part]) -> bool {
        parts.iter().any(|&part| self.has(part))
    }

    /// Names of what is written, the numbers first.
    pub fn names(self) -> Vec<&'static str> {
        let parts = Part::ALL.into_iter().filter(|&part| self.has(part)).map(Part::name);
        std::iter::once(NUMBERS).chain(parts).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_choose_parts_and_come_back() {
        let some = Parts::named(["report", NUMBERS, "maps"]);
        assert_eq!(some, Parts::of([Part::Maps, Part::Report]));
        assert_eq!(some.names(), ["numbers", "maps", "report"]);
        assert!(some.has_any(&[Part::Meshes, Part::Maps]) && !some.has_any(&[Part::Meshes, Part::Axes]));
        assert_eq!(Parts::named([NUMBERS]), Parts::NONE);
        assert_eq!(Parts::named(Parts::all().names()), Parts::all());
    }
}
