//! The lines of a comparison: every quantity under its path, with one value per result, and the figures of the
//! inspection, which stand in a table.
//!
//! Lines of the headline are there even where no result has a value; others only where one has.

use std::collections::HashMap;

use super::Compared;
use super::quantities::FIGURE_OF_FLANK;
use crate::findings::quantities::OPERATIONS;
use crate::findings::quantities::inspection::{FIGURE, FIGURES, INSPECTION, LEFT, NAME, RIGHT};
use crate::findings::{Entry, Findings, Level, Quantity};

/// Keys of quantities that say where something was looked at: they are shown, but not subtracted.
const PLACES: [&str; 3] = ["tooth", "center_profile", "center_lead"];

/// One line of the comparison.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    /// Path in the tree; the key alone in the headline.
    pub name: String,
    /// What people call it: its title behind those of its sections.
    pub title: String,
    /// How far up the first result that has it shows it.
    pub level: Level,
    /// One per result, in order; none where it has no such path.
    pub quantities: Vec<Option<Quantity>>,
}

/// The headline, then everything else, in the order in which the results first have it.
pub(super) fn lines(results: &[Compared]) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    let mut at: HashMap<String, usize> = HashMap::new();
    for headline in [true, false] {
        for (index, one) in results.iter().enumerate() {
            for (name, entry) in named(&one.findings, headline) {
                let line = *at.entry(name.clone()).or_insert_with(|| {
                    let quantities = vec![None; results.len()];
                    lines.push(Line { name, title: entry.heading(), level: entry.level, quantities });
                    lines.len() - 1
                });
                lines[line].quantities[index] = Some(entry.quantity);
            }
        }
    }
    lines.retain(|line| line.level == Level::Headline || line.is_known());
    lines
}

/// Entries of the headline by key, or all others by path.
fn named(findings: &Findings, headline: bool) -> Vec<(String, Entry)> {
    if headline {
        return findings.headline.iter().map(|entry| (entry.key.clone(), entry.clone())).collect();
    }
    let mut named = Vec::new();
    let mut titles: HashMap<String, Vec<String>> = HashMap::new();
    findings.walk(&mut |path, section| {
        let above = path.rsplit_once('.').and_then(|(above, _)| titles.get(above)).cloned().unwrap_or_default();
        // That an operation is one of the operations says nothing.
        let own = Some(section.title.clone()).filter(|_| section.key != OPERATIONS.key);
        let titled: Vec<String> = above.into_iter().chain(own).collect();
        named.extend(section.entries.iter().map(|entry| {
            let title = plain_title(&titled, entry);
            (format!("{path}.{}", entry.key), Entry { title, ..entry.clone() })
        }));
        titles.insert(path.to_owned(), titled);
    });
    named.extend(
        figures(findings).into_iter().map(|entry| (format!("{}.{}.{}", INSPECTION.key, FIGURES.key, entry.key), entry)),
    );
    named
}

/// Titles of sections and of a quantity as a reader says them: `Rough: unevenness, mean, max`.
fn plain_title(sections: &[String], own: &Entry) -> String {
    // Symbols stay as they are.
    let small = |title: &str| {
        let mut letters = title.chars();
        match (letters.next(), letters.next()) {
            (Some(first), Some(second)) if second.is_lowercase() => {
                first.to_lowercase().chain(title.chars().skip(1)).collect()
            }
            _ => title.to_owned(),
        }
    };
    let Some((first, others)) = sections.split_first() else { return own.heading() };
    let rest: Vec<String> = others.iter().map(|title| small(title)).chain([own.title.clone()]).collect();
    format!("{first}: {}", rest.join(", "))
}

/// Figures of the inspection: of the worst left and right flank, or of both sides together.
fn figures(findings: &Findings) -> Vec<Entry> {
    let Some(table) = findings.group(&INSPECTION).and_then(|section| section.table_of(&FIGURES)) else {
        return Vec::new();
    };
    let mut found = Vec::new();
    let sides = table.values(&LEFT).zip(table.values(&RIGHT));
    for ((symbol, name), sides) in table.words(&FIGURE).zip(table.words(&NAME)).zip(sides) {
        let (Some(symbol), Some(name)) = (symbol, name) else { continue };
        let mut add = |side: &str, title: &str, value_um: f64| {
            let entry = FIGURE_OF_FLANK.of(value_um).remarked(&format!(": {name}{title}"));
            let key = format!("{}{side}", name.replace(' ', "_"));
            found.push(entry.keyed(key).titled(format!("{name}{title} {symbol}")));
        };
        match sides {
            (Some(left_um), Some(right_um)) => {
                add("_left", ", left", left_um);
                add("_right", ", right", right_um);
            }
            (Some(both_um), None) | (None, Some(both_um)) => add("", "", both_um),
            (None, None) => {}
        }
    }
    found
}

impl Line {
    fn is_known(&self) -> bool {
        self.quantities.iter().flatten().any(|quantity| quantity.why().is_none())
    }

    /// Any of them, for unit and definition.
    pub(super) fn either(&self) -> Option<&Quantity> {
        self.quantities.iter().flatten().next()
    }

    /// The last step of its path.
    pub(super) fn key(&self) -> &str {
        self.name.rsplit('.').next().unwrap_or(&self.name)
    }

    /// How many results have a number here.
    fn count_numbers(&self) -> usize {
        self.quantities.iter().flatten().filter(|quantity| quantity.value().is_some()).count()
    }

    /// Whether some results have a number here and others none.
    pub(super) fn is_one_sided(&self) -> bool {
        (1..self.quantities.len()).contains(&self.count_numbers())
    }

    /// Whether two results or more have a number here.
    pub(super) fn is_shared(&self) -> bool {
        self.count_numbers() > 1
    }

    fn is_place(&self) -> bool {
        PLACES.contains(&self.key())
    }

    /// The first value and that of each result after it, where both are numbers of one unit and no places.
    pub(super) fn pairs(&self) -> impl Iterator<Item = Option<[f64; 2]>> {
        let first = self.quantities.first().and_then(Option::as_ref).filter(|_| !self.is_place());
        self.quantities.iter().skip(1).map(move |other| {
            let (first, other) = (first?, other.as_ref()?);
            (first.unit() == other.unit()).then_some(())?;
            Some([first.value()?, other.value()?])
        })
    }

    /// Values less the first one, of the results after it.
    pub(super) fn differences(&self) -> impl Iterator<Item = Option<f64>> {
        self.pairs().map(|pair| pair.map(|[first, other]| other - first))
    }

    /// Values of the results after the first one over its value. Over nothing but rounding there is none.
    pub(super) fn ratios(&self) -> impl Iterator<Item = Option<f64>> {
        self.pairs().map(|pair| {
            let [first, other] = pair.filter(|[first, _]| !is_rounding(*first))?;
            Some(other / first).filter(|ratio| ratio.is_finite())
        })
    }
}

/// Whether a value is nothing but rounding, in every unit that results have, and as a ratio; the exact one is in the
/// file.
pub(super) fn is_rounding(value: f64) -> bool {
    value.abs() < 1e-9
}
