//! The hob's wear in a run: bars by tooth, and its findings with `tables/hob_wear.csv`, `tables/hob_wear_edge.csv` and
//! `tables/hob_shift.csv`.

use super::load::labels;
use crate::findings::{Place, Section, Table};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::line_chart::Limit;
use crate::process::hobbing::measure::hob_wear::{
    self, EVEN, GearCost, GearShift, HobWear, PLACE_NAMES, ShiftReturn, WORN, WearEstimate, WearLaw, most,
};
use crate::process::hobbing::quantities::{
    AXIAL, EDGE_PLACE, EVEN_BAND, EVEN_TEETH, EXPONENT, EXPONENT_FROM, EXPONENT_TO, FIRST_PLACE, FIRST_TOOTH, GEARS,
    GEARS_FROM, GEARS_IF_EVEN, GEARS_TO, HOB_TOOTH, HOB_WEAR, LIFE, LIFE_FROM, LIFE_SOURCE, LIFE_TO, MEAN_THICKNESS,
    NO_RANGE, NO_ROOM, NOTHING, SHIFT, SHIFT_GEARS, SHIFT_GEARS_FROM, SHIFT_GEARS_TO, SHIFT_PLACES, SHIFT_RETURN,
    SHIFT_TO, SPEED, TAYLOR, THICKNESS, UNKNOWN, WEAR, WEAR_FROM, WEAR_LAW, WEAR_LIMIT, WEAR_PER_GEAR, WEAR_TO,
    WORN_BAND, WORN_TEETH,
};
use crate::process::hobbing::scene::model::{WearLife, WearSpec};
use crate::process::hobbing::{HobCutter, HobbedBlank, HobbingJob};
use gearcut_core::passes::sections::swept_sections::{EDGE_PLACES, FLANK_PLACES, edge_place_lengths_mm};
use gearcut_core::tool::CuttingTool as _;
use gearcut_core::units::UM_PER_MM;
use std::ops::Range;

/// The law in words.
const LAW_OF_WEAR: &str = "VB in proportion to the length of cut, over the length L_1 (h / h_1)^-x (v / v_1)^-(1/n - \
    1) that an edge lasts at the chip thickness h and the speed v (Taylor 1907, with the thickness); shares of life \
    add up";
/// What the numbers cannot know.
const NOT_KNOWN: &str = "steel, coating, coolant and run-in of the edge are in L_1 and x alone; the law holds for the \
    steady stage of wear, not for chipped or broken edges, and only near the chips and speeds for which L_1 and x were \
    found; every gear is taken to load the hob as the one that was cut";
const MM_PER_M: f64 = 1e3;
const S_PER_MIN: f64 = 60.0;

/// Wear over all operations; none where the scene does not say how the hob wears.
pub fn measure(cutter: &HobCutter, blank: &HobbedBlank) -> Option<HobWear> {
    let job = cutter.job;
    let spec = job.wear?;
    let own_mm_per_s = job.hob.tip_radius_mm * job.finishing().spec.hob_speed_rad_per_s;
    let law = WearLaw {
        thickness_exponent: spec.thickness_exponent,
        thickness_mm: spec.thickness_mm,
        speed_mm_per_s: spec.speed_mm_per_s.unwrap_or(own_mm_per_s),
        taylor_exponent: spec.taylor_exponent,
    };
    let lengths_mm = edge_place_lengths_mm(job.hob.edges().edge_of(0));
    let cost = |law: &WearLaw| {
        let mut cost = GearCost::nothing(job.hob.teeth.len());
        for ((passes, operation), in_slices) in cutter.operations.iter().zip(&job.operations).zip(&blank.in_slices) {
            cost.add(law, passes, &operation.linkage, job.hob.tip_radius_mm, &lengths_mm, in_slices);
        }
        cost
    };
    Some(HobWear::new(law, &spec.life, spec.thickness_exponent_ends, cost))
}

/// Wear of the places of a part of the edge of every tooth, the most of them, when the first place reaches the limit.
fn of_part(spec: &WearSpec, wear: &WearEstimate, part: Range<usize>) -> Vec<Option<f64>> {
    let scale = spec.limit_mm / wear.cost.largest_mm();
    let most = |places: &[f64; EDGE_PLACES]| places[part.clone()].iter().copied().fold(0.0, f64::max);
    wear.cost.equivalent_mm.iter().map(|places| Some(scale * most(places))).collect()
}

/// Bars by hob tooth with the name of their file; none where nothing was cut.
pub fn bars(job: &HobbingJob, wear: &HobWear) -> Option<(String, BarChart)> {
    let spec = job.wear?;
    wear.by_constants.cost.first()?;
    let parts = [
        ("flank to the entering end", 0..FLANK_PLACES),
        ("tip", FLANK_PLACES..FLANK_PLACES + 1),
        ("flank to the leaving end", FLANK_PLACES + 1..EDGE_PLACES),
    ];
    let series =
        parts.map(|(name, part)| BarSeries { name: name.to_owned(), values: of_part(&spec, &wear.by_constants, part) });
    let chart = BarChart {
        has_mean: false,
        least_division: 0.0,
        limits: vec![Limit { name: "limit".to_owned(), value: spec.limit_mm }],
        title: format!("{}: wear by hob tooth when the first one is worn to the limit", job.scene.name),
        category_name: "hob tooth, from the entering end".into(),
        categories: labels(job),
        value_name: "flank wear VB, largest of the part".into(),
        unit: "mm".into(),
        series: series.into(),
    };
    Some(("hob_wear".to_owned(), chart))
}

/// Teeth of each thread, by index.
fn threads(job: &HobbingJob) -> Vec<Range<usize>> {
    let mut from = 0;
    let threads = job.hob.teeth.chunk_by(|a, b| a.start == b.start).map(|thread| {
        let range = from..from + thread.len();
        from = range.end;
        range
    });
    threads.collect()
}

/// The shift that lasts longest; of several the smallest.
fn longest(shifts: &[GearShift]) -> Option<&GearShift> {
    let better = |a: &&GearShift, b: &&GearShift| a.gears.cmp(&b.gears).then(b.teeth.abs().total_cmp(&a.teeth.abs()));
    shifts.iter().rev().max_by(better)
}

fn end_name(shift: &GearShift) -> &'static str {
    if shift.teeth > 0.0 { "entering" } else { "leaving" }
}

/// What is found; nothing where the scene does not say how the hob wears.
pub fn findings(job: &HobbingJob, wear: &HobWear) -> Option<Section> {
    let spec = job.wear?;
    let of = &wear.by_constants;
    let section = HOB_WEAR.section([WEAR_LAW.of(LAW_OF_WEAR), UNKNOWN.of(NOT_KNOWN)]);
    let Some(first) = of.cost.first() else {
        return Some(section.entries([GEARS.none(NOTHING)]));
    };
    let labels = labels(job);
    let m = |mm: f64| mm / MM_PER_M;
    let is_fitted = matches!(spec.life, WearLife::Gears(_));
    let gears = wear.range(WearEstimate::gears);
    let life = wear.range(|of| of.life_mm);
    let end = |ends: Option<[f64; 2]>, which: usize| ends.map(|ends| ends[which]);
    let shares = of.cost.shares();
    let band = |least: f64| hob_wear::band(&shares, least);
    let words = |least: f64| {
        band(least).map_or_else(String::new, |([from, to], _)| format!("{} to {}", labels[from], labels[to]))
    };
    let count = |least: f64| band(least).map_or(0, |(_, count)| count);
    let place = Place::default().and("hob_tooth", labels[first[0]].clone()).and("edge_place", PLACE_NAMES[first[1]]);
    let exponents = spec.thickness_exponent_ends;
    let section = section
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
            FIRST_TOOTH.of(labels[first[0]].as_str()),
            FIRST_PLACE.of(PLACE_NAMES[first[1]]),
            MEAN_THICKNESS.of(of.cost.mean_thickness_mm(first) * UM_PER_MM),
            WORN_TEETH.of(count(WORN)),
            WORN_BAND.of(words(WORN)),
            EVEN_TEETH.of(count(EVEN)),
            EVEN_BAND.of(words(EVEN)),
            GEARS_IF_EVEN.of(of.gears_if_even()),
        ])
        .table(by_tooth(job, &spec, wear))
        .table(by_place(job, &spec, of));
    Some(shifted(job, wear, section))
}

/// All teeth.
fn by_tooth(job: &HobbingJob, spec: &WearSpec, wear: &HobWear) -> Table {
    let labels = labels(job);
    let of = &wear.by_constants;
    let worn = |of: &WearEstimate, tooth: usize| spec.limit_mm * UM_PER_MM * of.cost.shares()[tooth];
    let ends: Vec<Option<[f64; 2]>> = (0..labels.len()).map(|tooth| wear.range(|of| worn(of, tooth))).collect();
    let most_at = |tooth: usize| {
        let places = &of.cost.equivalent_mm[tooth];
        let largest = (0..EDGE_PLACES).max_by(|&a, &b| places[a].total_cmp(&places[b]))?;
        (places[largest] > 0.0).then_some(PLACE_NAMES[largest])
    };
    Table::over("all_teeth", "Wear by hob tooth", 0..labels.len())
        .column(&HOB_TOOTH, |&tooth| labels[tooth].as_str())
        .column(&AXIAL, |&tooth| job.hob.teeth[tooth].axial_mm)
        .column(&WEAR, |&tooth| worn(of, tooth))
        .column(&WEAR_FROM, |&tooth| ends[tooth].map(|ends| ends[0]))
        .column(&WEAR_TO, |&tooth| ends[tooth].map(|ends| ends[1]))
        .column(&WEAR_PER_GEAR, |&tooth| spec.limit_mm * UM_PER_MM * most(&of.cost.equivalent_mm[tooth]) / of.life_mm)
        .column(&EDGE_PLACE, |&tooth| most_at(tooth))
        .in_file("hob_wear")
}

/// All places of all edges, its rows in the file alone.
fn by_place(job: &HobbingJob, spec: &WearSpec, of: &WearEstimate) -> Table {
    let labels = labels(job);
    let scale = spec.limit_mm * UM_PER_MM / of.cost.largest_mm();
    let all = (0..labels.len()).flat_map(|tooth| (0..EDGE_PLACES).map(move |place| [tooth, place]));
    Table::over("edges", "Wear along the edges", all)
        .column(&HOB_TOOTH, |&[tooth, _]| labels[tooth].as_str())
        .column(&EDGE_PLACE, |&[_, place]| PLACE_NAMES[place])
        .column(&WEAR, |&[tooth, place]| scale * of.cost.equivalent_mm[tooth][place])
        .column(&MEAN_THICKNESS, |&[tooth, place]| {
            (of.cost.length_mm[tooth][place] > 0.0).then(|| of.cost.mean_thickness_mm([tooth, place]) * UM_PER_MM)
        })
        .rows_in_file("hob_wear_edge")
}

/// How many whole teeth the hob may move to its entering and to its leaving end before an operation lacks contact.
fn room_in_teeth(job: &HobbingJob) -> [usize; 2] {
    let mut room_mm = [f64::INFINITY; 2];
    for plan in job.operations.iter().map(|of| &of.plan) {
        let half_mm = 0.5 * job.hob.length_mm - plan.contact_half_length_mm;
        let mut at_mm = plan.path.start_shift_mm;
        let mut take = |at_mm: f64| room_mm = [room_mm[0].min(half_mm - at_mm), room_mm[1].min(half_mm + at_mm)];
        take(at_mm);
        for phase in &plan.path.phases {
            at_mm += phase.shift_mm_per_s * phase.duration_s;
            take(at_mm);
        }
    }
    room_mm.map(|mm| (mm / job.hob.tooth_spacing_mm()) as usize)
}

/// The hob moved after every gear.
fn shifted(job: &HobbingJob, wear: &HobWear, section: Section) -> Section {
    let threads = threads(job);
    let spacing_mm = job.hob.tooth_spacing_mm();
    let room = room_in_teeth(job);
    let shifts = hob_wear::shifts(&threads, &wear.by_constants.share_of_life(), room);
    let best = shifts.as_deref().and_then(longest);
    let at_ends: Option<Vec<f64>> = best.and_then(|best| {
        let ends = wear.by_ends.iter().map(|of| {
            let shifts = hob_wear::shifts(&threads, &of.share_of_life(), room)?;
            let same = shifts.into_iter().find(|shift| shift.teeth == best.teeth && shift.then == best.then)?;
            Some(same.gears as f64)
        });
        ends.collect()
    });
    let range = at_ends
        .filter(|ends| !ends.is_empty())
        .map(|ends| [ends.iter().copied().fold(f64::INFINITY, f64::min), ends.iter().copied().fold(0.0, f64::max)]);
    let why = if best.is_some() && wear.by_ends.is_empty() { NO_RANGE } else { NO_ROOM };
    let section = section.entries([
        SHIFT.of_or(best.map(|best| best.teeth.abs() * spacing_mm), NO_ROOM),
        SHIFT_TO.of_or(best.map(end_name), NO_ROOM),
        SHIFT_RETURN.of_or(best.map(|best| best.then.name()), NO_ROOM),
        SHIFT_GEARS.of_or(best.map(|best| best.gears), NO_ROOM),
        SHIFT_GEARS_FROM.of_or(range.map(|ends| ends[0]), why),
        SHIFT_GEARS_TO.of_or(range.map(|ends| ends[1]), why),
    ]);
    let shifts = shifts.unwrap_or_default();
    let mut best: Vec<GearShift> = Vec::new();
    for sign in [1.0, -1.0] {
        for then in ShiftReturn::ALL {
            let of: Vec<GearShift> =
                shifts.iter().copied().filter(|shift| shift.teeth * sign > 0.0 && shift.then == then).collect();
            best.extend(longest(&of));
        }
    }
    let table = |key: &str, title: &str, of: Vec<GearShift>| {
        Table::over(key, title, of)
            .column(&SHIFT, |shift| shift.teeth.abs() * spacing_mm)
            .column(&SHIFT_TO, end_name)
            .column(&SHIFT_RETURN, |shift| shift.then.name())
            .column(&SHIFT_PLACES, |shift| shift.places)
            .column(&SHIFT_GEARS, |shift| shift.gears)
    };
    section
        .table(table("longest_lasting", "The shift after every gear that lasts longest, by end and return", best))
        .table(table("shifts", "The hob shifted after every gear", shifts).rows_in_file("hob_shift"))
}
