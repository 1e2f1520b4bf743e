//! The page of a study: which parameter moves which quantity, means along the parameters, all cases as dots, pairs of
//! parameters, and the best cases with their scenes; and all that is written beside the rows.

use super::effects::{Effect, VarianceShare};
use super::findings::{ParetoFront, StudyEffects, findings};
use super::kept::counted_missing;
use super::plan::StudyPlan;
use super::rows::{StudyColumn, StudyRows};
use crate::findings::{Findings, Notice, RESULTS_FILE, unit};
use crate::number_text::significant;
use crate::output::atomic::write_bytes_atomically;
use crate::output::bar_chart::BarSeries;
use crate::output::bar_panels::{BarPanel, BarPanels};
use crate::output::dot_chart::{Dot, DotAxis, DotChart};
use crate::output::folder::OutputFolder;
use crate::output::heat_chart::HeatChart;
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::output::report::{Block, FileLinks, Page, PageSection, PageTable, REPORT_FILE};
use crate::output::table::write_tables;
use crate::process;
use crate::scene::LoadedScene;
use crate::steps::report::facts::gear_words;
use crate::steps::report::page_of;
use gearcut_core::error::Result;
use std::collections::{BTreeMap, BTreeSet};

/// Digits in tables.
const DIGITS: u32 = 3;
/// Most values of either parameter over which means of both are shown.
const MOST_OF_A_PAIR: usize = 12;
/// Most rows of a table of best cases.
const MOST_BEST: usize = 25;
/// Most quantities on a page.
const MOST_QUANTITIES: usize = 24;
/// Shares below this are rounding, per cent.
const LEAST_PERCENT: f64 = 0.1;

/// Writes results, tables and the page beside the rows; gives what must be known of them.
///
/// # Errors
/// Files that cannot be written.
pub fn write(of: StudyOf, rows: &StudyRows, folder: &OutputFolder) -> Result<Vec<Notice>> {
    let found = StudyEffects::of(of.plan, rows);
    let tree = findings(&of.base.scene, rows, &found);
    write_tables(&tree, folder)?;
    write_scenes(of, rows, &found, folder)?;
    let mut files = folder.written()?;
    files.push(RESULTS_FILE.to_owned());
    page(of, rows, (&found, &tree), files).write(&folder.path(REPORT_FILE)?)?;
    folder.write_json(RESULTS_FILE, &tree.to_json())?;
    Ok(tree.warnings)
}

/// Scenes of the best cases.
fn write_scenes(of: StudyOf, rows: &StudyRows, found: &StudyEffects, folder: &OutputFolder) -> Result<()> {
    let best: BTreeSet<u64> = listed(found).map(|(place, _)| rows.cases[place]).collect();
    for case in best {
        if let Some(name) = of.scene_file(case) {
            let scene = of.base.with_settings(&of.plan.settings(case), process::table())?;
            write_bytes_atomically(&folder.path(name)?, scene.resolved_toml().as_bytes())?;
        }
    }
    Ok(())
}

/// The best cases that the page lists, with time and value.
fn listed<'a>(found: &'a StudyEffects) -> impl Iterator<Item = (usize, [f64; 2])> + use<'a> {
    found.fronts.iter().take(MOST_QUANTITIES).flat_map(|front| front.best.iter().take(MOST_BEST).copied())
}

/// What a study is of.
#[derive(Clone, Copy)]
pub struct StudyOf<'a> {
    /// The scene that its cases change.
    pub base: &'a LoadedScene,
    /// The cases.
    pub plan: &'a StudyPlan,
    /// Whether a case is two scenes.
    pub is_pair: bool,
}

impl StudyOf<'_> {
    /// The file beside the page with the scene of a case; none of a pair, and where scenes name files beside them.
    fn scene_file(self, case: u64) -> Option<String> {
        let is_whole = !self.is_pair && self.base.scene.process.files_read().is_empty();
        is_whole.then(|| format!("cases/case_{case}.toml"))
    }
}

fn page(of: StudyOf, rows: &StudyRows, (found, tree): (&StudyEffects, &Findings), files: Vec<String>) -> Page {
    let (base, plan) = (&of.base.scene, of.plan);
    let more = found.of.len().saturating_sub(MOST_QUANTITIES);
    let left_out = (more > 0).then(|| {
        Block::Note(format!(
            "{more} of {} quantities are not on this page; tables/effects.csv and tables/means.csv have all of them.",
            found.of.len()
        ))
    });
    let found = &found.first(MOST_QUANTITIES);
    let charts = [shares(rows, found), swings(rows, found)].into_iter().flatten().map(Block::Panels);
    let charts = left_out.into_iter().chain(charts);
    let effects = PageSection::new(
        "effects",
        "What moves what",
        "Share: the part of a quantity's variance over all cases that a parameter makes alone (Sobol's first-order \
         index) with its 95 % interval. What the shares lack of 100 % is what parameters do together, and chance. \
         Total share: what the parameter makes alone and together with others; only designs with pairs of cases \
         have it. Swing: largest less smallest mean of the quantity along the parameter.",
        charts.chain(found.of.iter().map(effects_table)).collect(),
    );
    let along = rows.parameters.iter().filter_map(|parameter| means_chart(parameter, found));
    let mut sections = vec![effects];
    let add = |id, title: &str, lead: &str, blocks: Vec<Block>| {
        (!blocks.is_empty()).then(|| PageSection::new(id, title, lead, blocks))
    };
    sections.extend(add(
        "means",
        "Along the parameters",
        "Means of the quantities over all cases with a value of the parameter, whatever the other parameters are; of \
         ranges over neighbouring cases.",
        along.map(Block::Lines).collect(),
    ));
    sections.extend(add(
        "cases",
        "Case by case",
        "All cases over the parameter that moves the quantity most. A dot says under the pointer which case it is.",
        found.of.iter().filter_map(|of| cases_chart(plan, rows, of)).map(Block::Dots).collect(),
    ));
    sections.extend(add(
        "pairs",
        "Two parameters together",
        "Means of a quantity over the two parameters that move it most.",
        found.of.iter().filter_map(pair_chart).map(Block::Heat).collect(),
    ));
    sections.extend(add(
        "best",
        "Best cases",
        "Time against each quantity: no other case is as fast and smaller in size, or as small and faster. The \
         settings repeat a case: gearcut cut with the scene of the study and --set for each of them. A dot of the line \
         leads to the whole scene, in cases/ beside this page.",
        found.fronts.iter().flat_map(|front| front_blocks(of, rows, front)).collect(),
    ));
    let missing = counted_missing(rows.missing.iter().map(String::as_str));
    let row = |([path, why], cases): (&[String; 2], &usize)| vec![path.clone(), cases.to_string(), why.clone()];
    let caption = if missing.len() > MOST_BEST {
        format!("Kept quantities without a value: {MOST_BEST} of {}; tables/missing.csv has all", missing.len())
    } else {
        "Kept quantities without a value".to_owned()
    };
    let without = (!missing.is_empty()).then(|| {
        Block::Table(PageTable {
            caption,
            columns: ["Quantity", "Cases", "Why"].map(str::to_owned).to_vec(),
            rows: missing.iter().take(MOST_BEST).map(row).collect(),
        })
    });
    sections.extend(add(
        "missing",
        "What has no value",
        "Cases in which a kept quantity has no value are not in what is said of it above.",
        without.into_iter().collect(),
    ));
    let links = FileLinks { what: "Beside this page".to_owned(), files, more: 0 };
    sections.push(PageSection::new("files", "Files", "", vec![Block::Files(vec![links])]));
    Page {
        what: "study",
        subtitle: format!("{} cases of {} parameters", plan.cases(), rows.parameters.len()),
        operations: vec![gear_words(base)],
        done: "all cases made",
        sections,
        ..page_of(tree)
    }
}

/// Panels of one value for each parameter, a panel for each quantity; none without quantities.
fn panels(
    rows: &StudyRows,
    found: &StudyEffects,
    (title, value_name): (&str, &str),
    value: impl Fn(&StudyColumn, &Effect) -> Option<(f64, String)>,
) -> Option<BarPanels> {
    let panel = |(quantity, on): &(&StudyColumn, Vec<(&StudyColumn, Effect)>)| {
        let of = |parameter: &StudyColumn| {
            let (_, effect) = on.iter().find(|(own, _)| own.name == parameter.name)?;
            value(quantity, effect)
        };
        let found: Vec<Option<(f64, String)>> = rows.parameters.iter().map(of).collect();
        let unit = found.iter().flatten().next()?.1.clone();
        Some(BarPanel {
            value_name: quantity.name.clone(),
            least_division: if unit == "%" { LEAST_PERCENT } else { least_division(&quantity.unit) },
            unit,
            series: vec![BarSeries {
                name: value_name.to_owned(),
                values: found.into_iter().map(|of| of.map(|of| of.0)).collect(),
            }],
            limits: Vec::new(),
        })
    };
    let panels: Vec<BarPanel> = found.of.iter().filter_map(panel).collect();
    (!panels.is_empty()).then(|| BarPanels {
        title: title.to_owned(),
        category_name: "parameter".to_owned(),
        categories: rows.parameters.iter().map(|of| of.name.clone()).collect(),
        panels,
    })
}

fn shares(rows: &StudyRows, found: &StudyEffects) -> Option<BarPanels> {
    let words = ("Share of the variance that each parameter makes alone", "share");
    panels(rows, found, words, |_, effect| Some((100.0 * effect.share?.index.max(0.0), "%".to_owned())))
}

fn swings(rows: &StudyRows, found: &StudyEffects) -> Option<BarPanels> {
    panels(rows, found, ("Swing of each quantity's mean along each parameter", "swing"), |quantity, effect| {
        Some((effect.swing(), unit::signs(&quantity.unit)))
    })
}

fn effects_table((quantity, on): &(&StudyColumn, Vec<(&StudyColumn, Effect)>)) -> Block {
    let mut on: Vec<&(&StudyColumn, Effect)> = on.iter().collect();
    on.sort_by(|a, b| b.1.swing().total_cmp(&a.1.swing()));
    let cells = |share: Option<VarianceShare>| {
        let percent = |share: f64| significant(100.0 * share.clamp(0.0, 1.0), DIGITS);
        share.map_or(["–".to_owned(), "–".to_owned()], |share| {
            let [low, high] = share.interval.map(percent);
            [percent(share.index), format!("{low} to {high}")]
        })
    };
    let paired = on.iter().any(|(_, effect)| effect.total.is_some());
    let rows = on.into_iter().map(|(parameter, effect)| {
        let total = paired.then(|| cells(effect.total)).into_iter().flatten();
        let own = std::iter::once(parameter.name.clone()).chain(cells(effect.share)).chain(total);
        own.chain([shown(effect.swing())]).collect()
    });
    let total = if paired { &["Total share [%]", "95 % interval [%]"][..] } else { &[] };
    let heads = ["Parameter", "Share [%]", "95 % interval [%]"].iter().chain(total).map(|&head| head.to_owned());
    Block::Table(PageTable {
        caption: quantity.name.clone(),
        columns: heads.chain([format!("Swing [{}]", unit::signs(&quantity.unit))]).collect(),
        rows: rows.collect(),
    })
}

/// Means of all quantities along a parameter of numbers; none of words.
fn means_chart(parameter: &StudyColumn, found: &StudyEffects) -> Option<LineChart> {
    let panel = |(quantity, on): &(&StudyColumn, Vec<(&StudyColumn, Effect)>)| {
        let (_, effect) = on.iter().find(|(own, _)| own.name == parameter.name)?;
        let points: Vec<(f64, f64)> =
            effect.parts.iter().map(|part| Some((part.number?, part.mean))).collect::<Option<_>>()?;
        Some(Panel {
            value_name: quantity.name.clone(),
            unit: unit::signs(&quantity.unit),
            series: vec![LineSeries { name: "mean".to_owned(), points }],
            limits: Vec::new(),
            least_division: least_division(&quantity.unit),
        })
    };
    let panels: Vec<Panel> = found.of.iter().filter_map(panel).collect();
    (!panels.is_empty()).then(|| LineChart {
        title: format!("Means along {}", parameter.name),
        x_name: parameter.name.clone(),
        x_unit: unit::signs(&parameter.unit),
        panels,
    })
}

/// A case in words.
fn case_words(plan: &StudyPlan, case: u64) -> String {
    format!("case {case}: {}", plan.settings(case).join("; "))
}

/// An axis of a parameter or a quantity.
fn axis(of: &StudyColumn) -> DotAxis {
    DotAxis { name: of.name.clone(), unit: unit::signs(&of.unit), least_division: least_division(&of.unit) }
}

/// All cases over the parameter that moves a quantity most; none over words.
fn cases_chart(
    plan: &StudyPlan,
    rows: &StudyRows,
    (quantity, on): &(&StudyColumn, Vec<(&StudyColumn, Effect)>),
) -> Option<DotChart> {
    let (parameter, _) = on.iter().max_by(|a, b| a.1.swing().total_cmp(&b.1.swing()))?;
    let across: BTreeMap<usize, f64> = parameter.numbers().into_iter().collect();
    let dot = |(place, value): (usize, f64)| {
        let at = [*across.get(&place)?, value];
        Some(Dot { at, words: case_words(plan, rows.cases[place]), link: None })
    };
    let dots: Vec<Dot> = quantity.numbers().into_iter().filter_map(dot).collect();
    (!dots.is_empty()).then(|| DotChart {
        title: format!("{} over {}", quantity.name, parameter.name),
        axes: [axis(parameter), axis(quantity)],
        name: "cases".to_owned(),
        dots,
        line: None,
    })
}

/// Means over the two parameters with the largest swings; none where they have too many values to be shown.
fn pair_chart((quantity, on): &(&StudyColumn, Vec<(&StudyColumn, Effect)>)) -> Option<HeatChart> {
    let mut on: Vec<&(&StudyColumn, Effect)> = on.iter().collect();
    on.sort_by(|a, b| b.1.swing().total_cmp(&a.1.swing()));
    let [(first, down), (second, across)] = on.get(..2)? else { return None };
    let is_listed = |effect: &Effect, parameter: &StudyColumn| {
        let values: BTreeSet<&String> = parameter.cells.iter().collect();
        effect.parts.len() == values.len() && values.len() <= MOST_OF_A_PAIR
    };
    if !is_listed(down, first) || !is_listed(across, second) {
        return None;
    }
    let mut sums: BTreeMap<[&str; 2], (f64, usize)> = BTreeMap::new();
    for (place, value) in quantity.numbers() {
        let (sum, count) = sums.entry([&first.cells[place], &second.cells[place]]).or_default();
        *sum += value;
        *count += 1;
    }
    let cell = |a: &str, b: &str| {
        let (sum, count) = sums.get(&[a, b])?;
        let mean = sum / *count as f64;
        Some((mean, shown(mean)))
    };
    let labels = [down, across].map(|effect| effect.parts.iter().map(|part| part.at.clone()).collect::<Vec<_>>());
    Some(HeatChart {
        title: format!("Means of {}", quantity.name),
        value_name: [quantity.name.clone(), unit::signs(&quantity.unit)],
        names: [first.name.clone(), second.name.clone()],
        cells: labels[0].iter().map(|row| labels[1].iter().map(|column| cell(row, column)).collect()).collect(),
        labels,
    })
}

/// All cases by time and a quantity, with the best of them as a line and as a table.
fn front_blocks(of: StudyOf, rows: &StudyRows, front: &ParetoFront) -> [Block; 2] {
    let times: BTreeMap<usize, f64> = front.time.numbers().into_iter().collect();
    let listed: BTreeSet<usize> = front.best.iter().take(MOST_BEST).map(|best| best.0).collect();
    let dot = |(place, value): (usize, f64)| {
        let case = rows.cases[place];
        let link = listed.contains(&place).then(|| of.scene_file(case)).flatten();
        Some(Dot { at: [*times.get(&place)?, value], words: case_words(of.plan, case), link })
    };
    let chart = DotChart {
        title: format!("{} against {}", front.time.name, front.quantity.name),
        axes: [axis(front.time), axis(front.quantity)],
        name: "cases".to_owned(),
        dots: front.quantity.numbers().into_iter().filter_map(dot).collect(),
        line: Some(("best".to_owned(), front.best.iter().map(|best| best.1).collect())),
    };
    [Block::Dots(chart), Block::Table(front_table(of.plan, rows, front))]
}

fn front_table(plan: &StudyPlan, rows: &StudyRows, front: &ParetoFront) -> PageTable {
    let row = |(place, [time, value]): &(usize, [f64; 2])| {
        let case = rows.cases[*place];
        vec![case.to_string(), shown(*time), shown(*value), plan.settings(case).join("; ")]
    };
    let named = |column: &StudyColumn| format!("{} [{}]", column.name, unit::signs(&column.unit));
    let all = front.best.len();
    let cut_off =
        if all > MOST_BEST { format!(": {MOST_BEST} of {all}; tables/fronts.csv has all") } else { String::new() };
    PageTable {
        caption: format!("{} and {}{cut_off}", front.time.name, front.quantity.name),
        columns: vec!["Case".to_owned(), named(front.time), named(front.quantity), "Settings".to_owned()],
        rows: front.best.iter().take(MOST_BEST).map(row).collect(),
    }
}

/// Smallest distance of two ticks: what is less is no finding.
fn least_division(unit: &str) -> f64 {
    match unit {
        "um" => 0.01,
        "mm" => 1e-5,
        _ => 1e-9,
    }
}

fn shown(value: f64) -> String {
    significant(value, DIGITS).replace('-', "−")
}
