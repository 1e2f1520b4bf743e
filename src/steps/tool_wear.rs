//! A tool's wear in a run: bars by tooth, findings with `tables/tool_wear.csv` and `tables/tool_wear_edge.csv`, and the
//! section of the page.
//!
//! In: [`ToolWear`] and what a process calls its teeth and the places of their edges. Out: what people see of it.

use crate::findings::quantities::tool_wear::{
    EDGE_PLACE, EVEN_BAND, EVEN_TEETH, EXPONENT, EXPONENT_FROM, EXPONENT_TO, FIRST_PLACE, FIRST_TOOTH, GEARS,
    GEARS_FROM, GEARS_IF_EVEN, GEARS_TO, LIFE, LIFE_FROM, LIFE_SOURCE, LIFE_TO, MEAN_THICKNESS, NO_CHIPS, NO_RANGE,
    SPEED, TAYLOR, THICKNESS, TOOL_WEAR, UNKNOWN, WEAR, WEAR_FROM, WEAR_LAW, WEAR_LIMIT, WEAR_PER_GEAR, WEAR_TO,
    WORN_BAND, WORN_TEETH,
};
use crate::findings::{Columns, Entry, Findings, Place, QuantityRow, Section, Table};
use crate::measure::tool_wear::{EVEN, ToolWear, WORN, WearEstimate, band, most};
use crate::number_text::{plain, significant};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::line_chart::Limit;
use crate::output::report::{Block, PageSection, PageTable, Tone};
use crate::scene::tool_wear::WearLife;
use gearcut_core::passes::sections::swept_sections::{EDGE_PLACES, FLANK_PLACES};
use gearcut_core::units::UM_PER_MM;
use std::ops::Range;

/// The law in words.
const LAW_OF_WEAR: &str = "VB in proportion to the length of cut, over the length L_1 (h / h_1)^-x (v / v_1)^-(1/n - \
    1) that an edge lasts at the chip thickness h and the speed v (Taylor 1907, with the thickness); shares of life \
    add up";
/// What the numbers cannot know.
const NOT_KNOWN: &str = "steel, coating, coolant and run-in of the edge are in L_1 and x alone; the law holds for the \
    steady stage of wear, not for chipped or broken edges, and only near the chips and speeds for which L_1 and x were \
    found; every gear is taken to load the tool as the one that was cut; a first stroke of a shaper cutter that comes \
    at full depth is left out";
const MM_PER_M: f64 = 1e3;
const S_PER_MIN: f64 = 60.0;

/// A tool whose teeth wear, in words.
pub struct WornTool {
    /// What it is called.
    pub name: &'static str,
    /// The column that names its teeth.
    pub tooth: &'static QuantityRow,
    /// How its teeth are numbered, for charts.
    pub numbering: &'static str,
    /// Its teeth.
    pub labels: Vec<String>,
    /// Places along an edge, in their order.
    pub places: [&'static str; EDGE_PLACES],
    /// Its flanks: the one where places begin, the one where they end.
    pub flanks: [&'static str; 2],
    /// What is true of its teeth beside wear, under this row.
    pub more: Option<(&'static QuantityRow, Vec<f64>)>,
}

/// Wear of the places of a part of the edge of every tooth, the most of them, when the first place reaches the limit.
fn of_part(wear: &ToolWear, part: Range<usize>) -> Vec<Option<f64>> {
    let cost = &wear.by_constants.cost;
    let scale = wear.spec.limit_mm / cost.largest_mm();
    let most = |places: &[f64; EDGE_PLACES]| places[part.clone()].iter().copied().fold(0.0, f64::max);
    cost.equivalent_mm.iter().map(|places| Some(scale * most(places))).collect()
}

/// Bars by tooth with the stem of their file; none where nothing was cut.
pub fn bars(tool: &WornTool, scene: &str, wear: &ToolWear) -> Option<(String, BarChart)> {
    wear.by_constants.cost.first()?;
    let [from, to] = tool.flanks;
    let parts = [(from, 0..FLANK_PLACES), ("tip", FLANK_PLACES..FLANK_PLACES + 1), (to, FLANK_PLACES + 1..EDGE_PLACES)];
    let series = parts.map(|(name, part)| BarSeries { name: name.to_owned(), values: of_part(wear, part) });
    let chart = BarChart {
        has_mean: false,
        least_division: 0.0,
        limits: vec![Limit { name: "limit".to_owned(), value: wear.spec.limit_mm }],
        title: format!("{scene}: wear by {} tooth when the first one is worn to the limit", tool.name),
        category_name: format!("{} tooth, {}", tool.name, tool.numbering),
        categories: tool.labels.clone(),
        value_name: "flank wear VB, largest of the part".into(),
        unit: "mm".into(),
        series: series.into(),
    };
    Some(("tool_wear".to_owned(), chart))
}

/// What is found.
pub fn findings(tool: &WornTool, wear: &ToolWear) -> Section {
    let (spec, of) = (&wear.spec, &wear.by_constants);
    let section = TOOL_WEAR.section([WEAR_LAW.of(LAW_OF_WEAR), UNKNOWN.of(NOT_KNOWN)]);
    let Some(first) = of.cost.first() else {
        return section.entries([GEARS.none(NO_CHIPS)]);
    };
    let labels = &tool.labels;
    let m = |mm: f64| mm / MM_PER_M;
    let is_fitted = matches!(spec.life, WearLife::Gears(_));
    let gears = wear.range(WearEstimate::gears);
    let life = wear.range(|of| of.life_mm);
    let end = |ends: Option<[f64; 2]>, which: usize| ends.map(|ends| ends[which]);
    let shares = of.cost.shares();
    let words = |least: f64| {
        band(&shares, least).map_or_else(String::new, |([from, to], count)| {
            let some = if count <= to - from { "some of " } else { "" };
            format!("{some}{} to {}", labels[from], labels[to])
        })
    };
    let count = |least: f64| band(&shares, least).map_or(0, |(_, count)| count);
    let (first_tooth, first_place) = (labels[first[0]].clone(), tool.places[first[1]]);
    let place = Place::default().and(tool.tooth.key, first_tooth.clone()).and(EDGE_PLACE.key, first_place);
    let exponents = spec.thickness_exponent_ends;
    section
        .entries([
            WEAR_LIMIT.of(spec.limit_mm),
            LIFE.of(m(of.life_mm)).shown(),
            LIFE_SOURCE.of(if is_fitted { "fitted to gears_to_limit" } else { "given by life_m" }),
            LIFE_FROM.of_or(end(life, 0).map(m), NO_RANGE),
            LIFE_TO.of_or(end(life, 1).map(m), NO_RANGE),
            EXPONENT.of(spec.thickness_exponent),
            EXPONENT_FROM.of_or(end(exponents, 0), NO_RANGE),
            EXPONENT_TO.of_or(end(exponents, 1), NO_RANGE),
            THICKNESS.of(spec.thickness_mm * UM_PER_MM),
            SPEED.of(m(wear.law.speed_mm_per_s) * S_PER_MIN),
            TAYLOR.of(spec.taylor_exponent),
            GEARS.of(of.gears()).at(place).titled(if is_fitted {
                "gears to the limit of wear (fitted)"
            } else {
                "gears to the limit of wear (predicted)"
            }),
            GEARS_FROM.of_or(end(gears, 0), NO_RANGE),
            GEARS_TO.of_or(end(gears, 1), NO_RANGE),
            FIRST_TOOTH.of(first_tooth),
            FIRST_PLACE.of(first_place),
            MEAN_THICKNESS.of(of.cost.mean_thickness_mm(first) * UM_PER_MM),
            WORN_TEETH.of(count(WORN)),
            WORN_BAND.of(words(WORN)),
            EVEN_TEETH.of(count(EVEN)),
            EVEN_BAND.of(words(EVEN)),
            GEARS_IF_EVEN.of(of.gears_if_even()),
        ])
        .table(by_tooth(tool, wear))
        .table(by_place(tool, wear))
}

/// All teeth.
fn by_tooth(tool: &WornTool, wear: &ToolWear) -> Table {
    let (spec, of) = (&wear.spec, &wear.by_constants);
    let worn = |of: &WearEstimate, tooth: usize| spec.limit_mm * UM_PER_MM * of.cost.shares()[tooth];
    let ends: Vec<Option<[f64; 2]>> = (0..tool.labels.len()).map(|tooth| wear.range(|of| worn(of, tooth))).collect();
    let most_at = |tooth: usize| {
        let places = &of.cost.equivalent_mm[tooth];
        let largest = (0..EDGE_PLACES).max_by(|&a, &b| places[a].total_cmp(&places[b]))?;
        (places[largest] > 0.0).then_some(tool.places[largest])
    };
    let mut table: Columns<usize> = Table::over("all_teeth", "Wear by tooth", 0..tool.labels.len())
        .column(tool.tooth, |&tooth| tool.labels[tooth].as_str());
    if let Some((row, values)) = tool.more.as_ref().map(|(row, values)| (*row, values)) {
        table = table.column(row, |&tooth| values[tooth]);
    }
    table
        .column(&WEAR, |&tooth| worn(of, tooth))
        .column(&WEAR_FROM, |&tooth| ends[tooth].map(|ends| ends[0]))
        .column(&WEAR_TO, |&tooth| ends[tooth].map(|ends| ends[1]))
        .column(&WEAR_PER_GEAR, |&tooth| spec.limit_mm * UM_PER_MM * most(&of.cost.equivalent_mm[tooth]) / of.life_mm)
        .column(&EDGE_PLACE, |&tooth| most_at(tooth))
        .in_file("tool_wear")
}

/// All places of all edges, its rows in the file alone.
fn by_place(tool: &WornTool, wear: &ToolWear) -> Table {
    let of = &wear.by_constants;
    let scale = wear.spec.limit_mm * UM_PER_MM / of.cost.largest_mm();
    let all = (0..tool.labels.len()).flat_map(|tooth| (0..EDGE_PLACES).map(move |place| [tooth, place]));
    Table::over("edges", "Wear along the edges", all)
        .column(tool.tooth, |&[tooth, _]| tool.labels[tooth].as_str())
        .column(&EDGE_PLACE, |&[_, place]| tool.places[place])
        .column(&WEAR, |&[tooth, place]| scale * of.cost.equivalent_mm[tooth][place])
        .column(&MEAN_THICKNESS, |&[tooth, place]| {
            (of.cost.length_mm[tooth][place] > 0.0).then(|| of.cost.mean_thickness_mm([tooth, place]) * UM_PER_MM)
        })
        .rows_in_file("tool_wear_edge")
}

/// A number on the page.
pub fn number(wear: &Section, row: &QuantityRow) -> String {
    let text = |value: f64| if value.fract() == 0.0 { plain(value) } else { significant(value, 4) };
    wear.value(row).map_or_else(|| "–".to_owned(), text)
}

/// A number on the page with the ends of its interval.
pub fn with_ends(wear: &Section, row: &QuantityRow, ends: [&QuantityRow; 2]) -> String {
    match ends.map(|end| wear.value(end)) {
        [Some(_), Some(_)] => {
            let [from, to] = ends.map(|end| number(wear, end));
            format!("{} ({from} to {to})", number(wear, row))
        }
        _ => number(wear, row),
    }
}

/// The section of the page with rows of the process, how its teeth come to wear alike, and its other files. Nothing
/// where the scene does not say how the tool wears.
pub fn page(
    found: &Findings,
    tool: &str,
    chart: Option<BarChart>,
    (more, even, files): (Vec<(String, String)>, &str, &str),
) -> Option<PageSection> {
    let wear = found.group(&TOOL_WEAR)?;
    let number = |row: &QuantityRow| number(wear, row);
    let ends = |row: &QuantityRow, ends: [&QuantityRow; 2]| with_ends(wear, row, ends);
    let teeth = |count: &QuantityRow, band: &QuantityRow| match wear.text(band) {
        "" => number(count),
        band => format!("{}: {band}", number(count)),
    };
    let title = |row| wear.entry_of(row).map_or_else(String::new, Entry::heading);
    let mut rows = vec![
        (title(&GEARS), ends(&GEARS, [&GEARS_FROM, &GEARS_TO])),
        (
            format!("first {tool} tooth, place of its edge"),
            format!("{}, {}", wear.text(&FIRST_TOOTH), wear.text(&FIRST_PLACE)),
        ),
        ("teeth with a tenth of the limit or more then".to_owned(), teeth(&WORN_TEETH, &WORN_BAND)),
        ("teeth with nine tenths of it or more".to_owned(), teeth(&EVEN_TEETH, &EVEN_BAND)),
        (format!("L₁ [m], {}", wear.text(&LIFE_SOURCE)), ends(&LIFE, [&LIFE_FROM, &LIFE_TO])),
        ("h₁ [µm] and v₁ [m/min] for which L₁ holds".to_owned(), format!("{}, {}", number(&THICKNESS), number(&SPEED))),
        ("x, power of the chip thickness, given".to_owned(), ends(&EXPONENT, [&EXPONENT_FROM, &EXPONENT_TO])),
        ("mean chip thickness at the first place [µm]".to_owned(), number(&MEAN_THICKNESS)),
    ];
    rows.extend(more);
    rows.push((format!("gears if all teeth wore alike{even}"), number(&GEARS_IF_EVEN)));
    let mut blocks: Vec<Block> = chart.into_iter().map(Block::Bars).collect();
    blocks.push(Block::Table(PageTable {
        caption: format!("Life of the {tool} until VB = {} mm", number(&WEAR_LIMIT)),
        columns: Vec::new(),
        rows: rows.into_iter().map(|(name, value)| vec![name, value]).collect(),
    }));
    blocks.push(Block::Note(format!("{}. Not known: {}.", wear.text(&WEAR_LAW), wear.text(&UNKNOWN))));
    let intro = format!(
        "How far every tooth is worn when the first place of an edge has reached the limit. Places are the tip and \
         quarters of each flank's depth, 1 next to the tip; all of them are in tables/tool_wear_edge.csv{files}."
    );
    Some(
        PageSection::new("wear", format!("Wear of the {tool}'s teeth"), intro, blocks).judged(
            Tone::Aside,
            format!("{} {}", number(&GEARS), wear.entry_of(&GEARS).map_or("", |entry| &entry.title)),
        ),
    )
}
