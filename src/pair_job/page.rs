//! The page of a pair: `report.html`.
//!
//! In: a rolled pair with its findings and charts. Out: one page: key numbers, the ratio that the pair is for,
//! transmission error with its waves, backlash, contact with its patterns, interference, double-flank rolling, centre
//! distance.

use super::charts::{self, NamedLines};
use super::fit::Fit;
use super::options::PairOptions;
use super::quantities::{
    BACKLASH, CENTER_DISTANCE, CONTACT, DOUBLE_FLANK, FLANKS_ROLLED, INTERFERENCE, PAIR, RATIO, TRANSMISSION_ERROR,
};
use super::rolled::RolledPair;
use super::teeth::ToothContact;
use super::view;
use crate::findings::{Findings, QuantityGroup};
use crate::number_text::plain;
use crate::output::folder::OutputFolder;
use crate::output::range_chart::{RangeChart, RangeSeries};
use crate::output::report::{Block, Page, PageSection};
use crate::scene::Scene;
use crate::steps;
use crate::steps::report::facts::gear_words;
use crate::steps::report::{page_of, quantities};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;

/// What the page shows beside numbers and charts: pictures with their PNG, and its end.
pub struct PageParts {
    /// Contact patterns, one for each gear that has one.
    pub patterns: Vec<(String, Vec<u8>)>,
    /// The gears rolling.
    pub animation: Vec<u8>,
    /// Its end: [`ending`].
    pub end: [PageSection; 2],
}

/// What is needed to roll the pair again.
#[derive(Debug, Clone)]
pub struct PairRecord {
    /// Name of the backend that cut the flanks.
    pub backend: String,
    /// Both scenes, every value written out.
    pub scenes: [String; 2],
}

/// The page.
pub fn page(
    scenes: [&Scene; 2],
    options: &PairOptions,
    rolled: &RolledPair,
    found: &Findings,
    lines: &[NamedLines],
    parts: PageParts,
) -> Page {
    let viewer = view::viewer(rolled, options.marking_um);
    let chart = |name: &str| {
        let found = lines.iter().find(|(own, _)| *own == name);
        found.map(|(_, chart)| Block::Lines(chart.clone()))
    };
    let table = |group: &QuantityGroup| found.group(group).map(|section| Block::Table(quantities::table(section)));
    let part_of = |group: &QuantityGroup, side| {
        found.group(group).and_then(|section| section.side(side)).map(|part| Block::Table(quantities::table(part)))
    };
    let double_flank = found.parts(&DOUBLE_FLANK).iter().map(|part| Some(Block::Table(quantities::table(part))));
    let part = |blocks: Vec<Option<Block>>| blocks.into_iter().flatten().collect::<Vec<_>>();
    let rolling = Block::Picture("The gears in mesh, first pitches; contacts are marked".to_owned(), parts.animation);
    let patterns = parts.patterns.into_iter().map(|(words, png)| Some(Block::Picture(words, png)));
    let mut contact = part(vec![chart("contact_ratio"), Some(Block::Ranges(by_tooth(rolled)))]);
    contact.extend(patterns.flatten());
    contact.extend(part(vec![part_of(&CONTACT, Side::Right), part_of(&CONTACT, Side::Left)]));
    let sections = vec![
        PageSection::new(
            "ratio",
            "Ratio",
            "What the pair is for: the ratio of the speeds by the pitch curves, and the one that the flanks \
            achieve.",
            part(vec![chart("ratio"), table(&RATIO), Some(rolling)]),
        ),
        PageSection::new(
            "transmission-error",
            "Transmission error",
            "Rotation of B less that of the pitch curves, without load. Long waves are longer than two teeth; the rest \
            comes with the teeth.",
            part(vec![
                chart("transmission_error"),
                charts::waves(found).map(Block::Bars),
                part_of(&TRANSMISSION_ERROR, Side::Right),
                part_of(&TRANSMISSION_ERROR, Side::Left),
            ]),
        ),
        PageSection::new(
            "backlash",
            "Backlash",
            "What B can turn while A is held, at the pitch point across the line of centres and normal to the flanks. \
            Below zero the pair jams.",
            part(vec![chart("backlash"), table(&BACKLASH)]),
        ),
        PageSection::new(
            "contact",
            "Contact",
            "Where flanks come nearer to each other than the marking compound is thick. Heights count from the pitch \
            curve, u from the form point.",
            contact,
        ),
        PageSection::new(
            "interference",
            "Interference",
            "How deep tip corners are in the mate where the pitch curves want them, in the middle of the play, or how \
            far they are clear of it there. What edges do where one side bears is among the contact.",
            part(vec![table(&INTERFERENCE)]),
        ),
        PageSection::new(
            "double-flank",
            "Double-flank rolling",
            "The centre distance at which both flanks touch, less the nominal one.",
            part(std::iter::once(chart("double_flank")).chain(double_flank).collect()),
        ),
        PageSection::new(
            "center-distance",
            "Centre distance",
            distance_words(&rolled.fit),
            part(vec![table(&CENTER_DISTANCE), table(&PAIR)]),
        ),
    ];
    let gears = scenes.iter().zip(["A drives", "B is driven"]);
    Page {
        what: "rolling report",
        subtitle: format!(
            "{} flanks, {} positions in a period; axes {} mm apart",
            found.group(&PAIR).map_or("", |pair| pair.text(&FLANKS_ROLLED)),
            rolled.period.moments.len(),
            plain(rolled.fit.pitch.center_distance_mm() + rolled.meshing.center_distance_error_mm()),
        ),
        operations: gears.map(|(scene, role)| format!("{role}: {}. {}", scene.name, gear_words(scene))).collect(),
        done: "rolled over a whole period",
        viewer,
        sections: sections.into_iter().map(|section| with_marking(section, options)).chain(parts.end).collect(),
        ..page_of(found)
    }
}

/// What the section on the centre distance says of these gears.
fn distance_words(fit: &Fit) -> &'static str {
    if fit.round_involutes {
        "What 10 µm more do. Involutes on round gears turn as evenly at any distance."
    } else if fit.no_involutes().is_some() {
        "What 10 µm more do. Drawn teeth are made for one distance; at another the ratio changes with every tooth."
    } else {
        "What 10 µm more do. Non-circular gears turn less evenly at another distance than their own."
    }
}

/// The files, and what is needed to roll the pair again; `flanks` says where they come from.
///
/// # Errors
/// The folder cannot be read.
pub fn ending(folder: &OutputFolder, flanks: &str, record: &PairRecord) -> Result<[PageSection; 2]> {
    let words = ["A", "B"].map(|gear| format!("The scene of gear {gear}, every value written out"));
    let scenes = [0, 1].map(|k| (words[k].as_str(), record.scenes[k].as_str()));
    steps::report::ending(folder, ["Flanks", flanks], &scenes)
}

/// The lead of the section on contact names the marking.
fn with_marking(mut section: PageSection, options: &PairOptions) -> PageSection {
    if section.id == "contact" {
        section.lead = format!("{} Marking: {} µm.", section.lead, plain(options.marking_um));
    }
    section
}

/// Where contact begins and ends on the teeth of A.
fn by_tooth(rolled: &RolledPair) -> RangeChart {
    let teeth = rolled.fit.pitch.teeth().count[0];
    let series = |name: &str, found: &[ToothContact]| RangeSeries {
        name: name.to_owned(),
        values: (1..=i64::from(teeth))
            .map(|tooth| {
                let [low, high] = found.iter().find(|contact| contact.tooth == tooth)?.heights_mm[0];
                Some([low, 0.5 * (low + high), high])
            })
            .collect(),
    };
    RangeChart {
        title: "Where contact begins and ends on A: height over the pitch curve".to_owned(),
        category_name: "tooth of A".to_owned(),
        categories: (1..=teeth).map(|tooth| tooth.to_string()).collect(),
        unit: "mm".to_owned(),
        series: vec![series("right flanks", &rolled.teeth[0]), series("left flanks", &rolled.teeth[1])],
    }
}
