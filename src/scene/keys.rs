//! Scene keys: name, kind, unit, range, default and a sentence for each; and the sections that all processes share.
//!
//! A section holds keys; a section may offer a choice, where the name of the table written inside it picks the variant
//! (`[gear.pitch_curve.ellipse]`). What only some processes read stands in their folders; [`super::KeyTable`] puts both
//! together. The reader checks files against that table, and the JSON schema, the key reference and the template are
//! printed from it, so none of them can fall behind.
//!
//! Road not taken: structs with derived deserialisation. They report one problem at a time, lose the place of
//! a value inside a choice, and keep ranges, units and sentences somewhere else.

mod gear;
pub mod machine_errors;
mod material;
mod measure;
mod output;
mod picture;
mod pitch_curve;
mod process;
mod range;
mod texture;

pub use gear::HELIX;
pub use range::Range;

/// One key of the scene file.
#[derive(Debug)]
pub struct Key {
    /// Name inside its section, unit included: `module_mm`.
    pub name: &'static str,
    /// What may be written.
    pub kind: Kind,
    /// Unit as printed to the reader; empty for counts, ratios and words.
    pub unit: &'static str,
    /// What holds when the key is not written.
    pub default: Default,
    /// Value to start from, as TOML: used by the template.
    pub example: &'static str,
    /// What the key does, in one or two sentences.
    pub teach: &'static str,
}

/// What may be written for a key.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// Any number in the range; whole numbers are numbers too.
    Number(Range),
    /// Whole number, both ends included.
    Whole {
        /// Smallest.
        min: u32,
        /// Largest.
        max: u32,
    },
    /// `true` or `false`.
    Boolean,
    /// One of a few words.
    Word(&'static [&'static str]),
    /// Name of an operation; folders are named after it.
    Name,
    /// Path of a file or folder.
    Path,
    /// Text that is printed, on one line, of letters that the font has: [`PRINTED`].
    Text {
        /// Longest text, letters.
        most: usize,
    },
    /// Formula of the polar angle phi, in rad.
    Formula,
    /// List of numbers, each in the range, at most `most` of them.
    Numbers {
        /// Range of each number.
        range: Range,
        /// Longest list.
        most: usize,
    },
    /// Two numbers, each in the range.
    Pair(Range),
    /// List of points, each `[angle, radius]` with its ranges.
    Points {
        /// Range of the angle.
        angle: Range,
        /// Range of the radius.
        radius: Range,
        /// Shortest list.
        fewest: usize,
        /// Longest list.
        most: usize,
    },
}

/// Letters that a text may have which is printed, from and to: what the embedded font has of Latin, Greek and quotes.
pub const PRINTED: [[char; 2]; 7] = [
    [' ', '~'],
    ['\u{a0}', '\u{17f}'],
    ['\u{384}', '\u{38a}'],
    ['\u{38e}', '\u{3a1}'],
    ['\u{3a3}', '\u{3e1}'],
    ['\u{2013}', '\u{2015}'],
    ['\u{2018}', '\u{201e}'],
];

/// What holds when a key is not written.
#[derive(Debug, Clone, Copy)]
pub enum Default {
    /// The key must be written.
    Required,
    /// One of a group of keys must be written; the group's rule says so.
    OneOfGroup,
    /// This number.
    Number(f64),
    /// This whole number.
    Whole(u32),
    /// This switch position.
    Boolean(bool),
    /// This word.
    Word(&'static str),
    /// A list without entries.
    EmptyList,
    /// A value that follows from other keys, in words.
    Derived(&'static str),
    /// No value; the words say what happens instead.
    LeftOut(&'static str),
}

/// Keys of which at most one may be written.
#[derive(Debug)]
pub struct Group {
    /// The keys' names.
    pub names: &'static [&'static str],
    /// One of them must be written.
    pub required: bool,
}

/// One table of the scene file, as the shared sections or a process list it.
#[derive(Debug)]
pub struct KeySection {
    /// Path with `[]` after the name of a list: `operation[].infeed.plunge`; the whole file is the empty path.
    pub path: &'static str,
    /// How it stands in the file.
    pub role: Role,
    /// Its keys, in the order in which they are printed.
    pub keys: &'static [Key],
    /// Keys that exclude each other.
    pub groups: &'static [Group],
    /// What the section is about, in one or two sentences.
    pub teach: &'static str,
}

impl KeySection {
    /// A section whose keys do not exclude each other.
    pub const fn new(path: &'static str, role: Role, keys: &'static [Key], teach: &'static str) -> Self {
        Self { path, role, keys, groups: &[], teach }
    }
}

/// Keys that a process adds to a shared section.
#[derive(Debug)]
pub struct Addition {
    /// Path of the section.
    pub path: &'static str,
    /// The keys, printed after those of the section. One that the section has already, a key of words, takes its place:
    /// the process knows more words.
    pub keys: &'static [Key],
    /// Which of them exclude each other.
    pub groups: &'static [Group],
}

/// How a section stands in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// A table, there even when it is not written.
    Plain,
    /// A list of tables, `[[operation]]`.
    List {
        /// Shortest list that may be written.
        fewest: usize,
    },
    /// A table that holds exactly one of its variants, as a table of that name.
    Choice {
        /// Variant that holds when none is written; `None`: one must be written.
        default: Option<&'static str>,
        /// The thing to choose, in words: "pitch curve".
        what: &'static str,
    },
    /// One variant of the choice that its path begins with.
    Variant,
}

/// The file as a whole.
const ROOT: KeySection = KeySection { path: "", role: Role::Plain, keys: &[], groups: &[], teach: "The scene." };

/// The sections that all processes share, each after the one that holds it.
pub(super) fn shared() -> impl Iterator<Item = &'static KeySection> {
    static FIRST: &[KeySection] = &[ROOT];
    [
        FIRST,
        gear::SECTIONS,
        pitch_curve::SECTIONS,
        material::SECTIONS,
        process::SECTIONS,
        machine_errors::SECTIONS,
        texture::SECTIONS,
        output::SECTIONS,
        measure::SECTIONS,
        picture::SECTIONS,
    ]
    .into_iter()
    .flatten()
}

/// `name` inside `path`.
pub fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

impl Key {
    /// A switch between words.
    pub const fn word(
        name: &'static str,
        words: &'static [&'static str],
        default: &'static str,
        example: &'static str,
        teach: &'static str,
    ) -> Self {
        Self { name, kind: Kind::Word(words), unit: "", default: Default::Word(default), example, teach }
    }

    /// A number with a default.
    pub const fn number(
        name: &'static str,
        unit: &'static str,
        range: Range,
        default: f64,
        example: &'static str,
        teach: &'static str,
    ) -> Self {
        Self { name, kind: Kind::Number(range), unit, default: Default::Number(default), example, teach }
    }

    /// A number that may be left out; `words` say what holds then.
    pub const fn optional(
        name: &'static str,
        unit: &'static str,
        range: Range,
        words: &'static str,
        example: &'static str,
        teach: &'static str,
    ) -> Self {
        Self { name, kind: Kind::Number(range), unit, default: Default::LeftOut(words), example, teach }
    }

    /// A limit of an axis, where known.
    pub const fn limit(name: &'static str, unit: &'static str, example: &'static str, teach: &'static str) -> Self {
        Self::optional(name, unit, Range::closed(1e-6, 1e7), "not limited", example, teach)
    }

    /// Whether it is the key `other` with more words.
    pub fn widens(&self, other: &Self) -> bool {
        match (self.kind, other.kind) {
            (Kind::Word(more), Kind::Word(words)) => words.iter().all(|word| more.contains(word)),
            _ => false,
        }
    }

    /// Unit and range in brackets, as messages print it: `(mm, 0.1 to 50)`.
    pub fn brackets(&self) -> String {
        let allowed = self.allowed();
        if self.unit.is_empty() { format!("({allowed})") } else { format!("({}, {allowed})", self.unit) }
    }

    /// What may be written, without the unit: `0.1 to 50`, `whole number, 4 to 2000`.
    pub fn allowed(&self) -> String {
        match self.kind {
            Kind::Number(range) => range.to_string(),
            Kind::Whole { min, max } => format!("whole number, {min} to {max}"),
            Kind::Boolean => "true or false".to_owned(),
            Kind::Word(words) => either(words.iter().map(|word| format!("\"{word}\""))),
            Kind::Name => "letters, digits, _ and -, in quotes".to_owned(),
            Kind::Path => "path in quotes".to_owned(),
            Kind::Text { most } => format!("1 to {most} letters, Latin or Greek, in quotes on one line"),
            Kind::Formula => "formula of phi (rad) in quotes".to_owned(),
            Kind::Numbers { range, most } => format!("list of at most {most} numbers, each {range}"),
            Kind::Pair(range) => format!("[first, last], each {range}"),
            Kind::Points { angle, radius, fewest, .. } => {
                format!("at least {fewest} points [angle, radius]; angle {angle}, radius {radius}")
            }
        }
    }

    /// What holds when the key is not written, as the reference prints it.
    pub fn default_text(&self) -> String {
        match self.default {
            Default::Required => "required".to_owned(),
            Default::OneOfGroup => "see the section's rule".to_owned(),
            Default::Number(number) => Range::short(number),
            Default::Whole(number) => number.to_string(),
            Default::Boolean(on) => on.to_string(),
            Default::Word(word) => format!("\"{word}\""),
            Default::EmptyList => "[]".to_owned(),
            Default::Derived(words) | Default::LeftOut(words) => words.to_owned(),
        }
    }
}

/// `a, b or c`.
pub fn either(words: impl Iterator<Item = String>) -> String {
    let mut words: Vec<String> = words.collect();
    let last = words.pop().unwrap_or_default();
    if words.is_empty() { last } else { format!("{} or {last}", words.join(", ")) }
}
