//! The table of quantities: what is said of a quantity is said once, in its row, and an entry is a row with a value.
//!
//! In: `rows!` with key, unit and definition of each quantity, and what only some have: title,
//! symbol, source, level, the reasons for which there may be no value. Out: a static [`QuantityRow`] for each, and the
//! [`QuantityGroup`] of them. What processes share is in [`super::quantities`]; a process lists its own beside its
//! scene keys.
//!
//! ```text
//! rows! {
//!     /// Chips of an operation.
//!     CHIPS: "chips", "Chips and cutting forces", "operations.<operation>.chips";
//!     LARGEST_SECTION: "largest_section", "mm^2", "largest section of all chips of a stroke, transverse plane"
//!         => titled("largest chip section"), symbol("A"), or(&[IDLE]);
//!     IDLE_STROKES: "idle_strokes", "strokes", "strokes in which no cutter tooth meets material";
//! }
//!
//! CHIPS.section([
//!     LARGEST_SECTION.of_or(largest.map(|of| of.area_mm2), IDLE).at(place),    // a number, or none for a reason
//!     IDLE_STROKES.of(chips.idle()),                                           // a count, as its type says
//! ])
//! Table::over("strokes", "Strokes", strokes).column(&LARGEST_SECTION, |stroke| stroke.area_mm2) // as a column
//! section.value(&LARGEST_SECTION)                                                              // as a look-up
//! ```
//!
//! A reason that is a constant is one of its row's; one that depends on the scene is a `String`. The type of the value
//! says what it is: f64 a number, an integer a count, text words.
//!
//! Roads not taken: an enum of all quantities, which a process could not add to; a struct with a field for each
//! quantity, which every renderer had to know.

/// Unit of a column whose values have that of another column, row by row.
pub const BY_ROW: &str = "that of the row";

/// How far up a quantity is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// First of all: summary, report, every comparison.
    Headline,
    /// On the terminal, after the headline.
    Summary,
    /// In files.
    Detail,
}

/// How a column is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnChart {
    /// Bars, one for each row.
    Bars,
    /// A curve through all rows.
    Curve,
}

/// What a key reads as when it is given no title of its own; keys have the spelling of code.
pub(super) fn title_of(key: &str) -> String {
    key.replace('_', " ").replace("center", "centre")
}

/// What a quantity is, whatever its value.
#[derive(Debug, PartialEq)]
pub struct QuantityRow {
    /// Key among its neighbours.
    pub key: &'static str,
    /// Unit; `"1"` for a pure number, empty for words, [`BY_ROW`].
    pub unit: &'static str,
    /// What its value is.
    pub definition: &'static str,
    /// Symbol of the standard; empty where there is none.
    pub symbol: &'static str,
    /// Standard or paper that defines it; empty where the definition is all.
    pub source: &'static str,
    /// How far up it is shown, unless its entry says otherwise.
    pub level: Level,
    /// Reasons for which there may be no value; reasons that depend on the scene apart.
    pub reasons: &'static [&'static str],
    /// How comparisons draw it as a column, if they do.
    pub chart: Option<ColumnChart>,
    title: &'static str,
}

/// Rows that belong together: the entries of a section, the columns of a table, or one subject.
#[derive(Debug)]
pub struct QuantityGroup {
    /// Key of the section that has them, or the subject.
    pub key: &'static str,
    /// Title of the section, or of the subject.
    pub title: &'static str,
    /// Where in `results.json` they are, as paths.
    pub place: &'static str,
    /// The rows.
    pub rows: &'static [&'static QuantityRow],
}

/// Declares rows and the group that lists them; see [`crate::findings::row`].
macro_rules! rows {
    ($(#[$meta:meta])* $group:ident: $group_key:literal, $title:literal, $place:literal;
     $($row:ident: $key:literal, $unit:literal, $definition:literal
        $(=> $($part:ident($($argument:expr),*)),+)?;)+) => {
        $(
            #[doc = $definition]
            pub static $row: $crate::findings::QuantityRow =
                $crate::findings::QuantityRow::new($key, $unit, $definition)$($(.$part($($argument),*))+)?;
        )+
        $(#[$meta])*
        pub static $group: $crate::findings::QuantityGroup =
            $crate::findings::QuantityGroup { key: $group_key, title: $title, place: $place, rows: &[$(&$row),+] };
    };
}
pub(crate) use rows;

impl QuantityGroup {
    /// A section whose own keys are names of parts, or whose rows another group lists.
    pub const fn of_parts(key: &'static str, title: &'static str) -> Self {
        Self { key, title, place: "", rows: &[] }
    }
}

impl QuantityRow {
    /// A detail that always has a value, called as its key.
    pub const fn new(key: &'static str, unit: &'static str, definition: &'static str) -> Self {
        Self {
            key,
            unit,
            definition,
            symbol: "",
            source: "",
            level: Level::Detail,
            reasons: &[],
            chart: None,
            title: "",
        }
    }

    /// What it is called where people read it.
    #[must_use]
    pub const fn titled(self, title: &'static str) -> Self {
        Self { title, ..self }
    }

    /// With the symbol of the standard.
    #[must_use]
    pub const fn symbol(self, symbol: &'static str) -> Self {
        Self { symbol, ..self }
    }

    /// With the standard or paper that defines it.
    #[must_use]
    pub const fn source(self, source: &'static str) -> Self {
        Self { source, ..self }
    }

    /// The terminal shows it.
    #[must_use]
    pub const fn shown(self) -> Self {
        Self { level: Level::Summary, ..self }
    }

    /// With the reasons for which there may be no value.
    #[must_use]
    pub const fn or(self, reasons: &'static [&'static str]) -> Self {
        Self { reasons, ..self }
    }

    /// As a column, drawn as bars by comparisons.
    #[must_use]
    pub const fn bars(self) -> Self {
        Self { chart: Some(ColumnChart::Bars), ..self }
    }

    /// As a column, drawn as a curve by comparisons.
    #[must_use]
    pub const fn curve(self) -> Self {
        Self { chart: Some(ColumnChart::Curve), ..self }
    }

    /// Its symbol, or what it is called where it has none.
    pub fn symbol_or_title(&self) -> String {
        if self.symbol.is_empty() { self.title() } else { self.symbol.to_owned() }
    }

    /// What it is called where people read it: its key in words unless it has a title.
    pub fn title(&self) -> String {
        if self.title.is_empty() { title_of(self.key) } else { self.title.to_owned() }
    }
}
