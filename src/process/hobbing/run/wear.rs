//! The hob's wear in a run ([`crate::steps::tool_wear`]), and its shift between gears: `tables/hob_shift.csv`.

use crate::findings::quantities::tool_wear::NO_RANGE;
use crate::findings::{Section, Table};
use crate::measure::tool_wear::{GearCost, ToolWear};
use crate::output::bar_chart::BarChart;
use crate::process::hobbing::measure::hob_wear::{self, GearShift, PLACE_NAMES, ShiftReturn};
use crate::process::hobbing::quantities::{
    AXIAL, HOB_TOOTH, NO_ROOM, SHIFT, SHIFT_GEARS, SHIFT_GEARS_FROM, SHIFT_GEARS_TO, SHIFT_PLACES, SHIFT_RETURN,
    SHIFT_TO,
};
use crate::process::hobbing::{HobCutter, HobbedBlank, HobbingJob};
use crate::steps::tool_wear::{self, WornTool};
use gearcut_core::passes::sections::swept_sections::edge_place_lengths_mm;
use gearcut_core::tool::CuttingTool as _;
use std::ops::Range;

/// Wear over all operations; none where the scene does not say how the hob wears.
pub fn measure(cutter: &HobCutter, blank: &HobbedBlank) -> Option<ToolWear> {
    let job = cutter.job;
    let own_mm_per_s = job.hob.tip_radius_mm * job.finishing().spec.hob_speed_rad_per_s;
    let lengths_mm = edge_place_lengths_mm(job.hob.edges().edge_of(0));
    let wear = job.wear?;
    let operations: Vec<_> = cutter.operations.iter().zip(&job.operations).zip(&blank.in_slices).collect();
    // Once for all laws.
    let speeds = operations.iter().map(|((passes, operation), in_slices)| {
        hob_wear::tip_speeds_mm_per_s(passes, &operation.linkage, job.hob.tip_radius_mm, in_slices)
    });
    let speeds: Vec<_> = speeds.collect();
    Some(ToolWear::new(wear, own_mm_per_s, |law| {
        let mut cost = GearCost::nothing(job.hob.teeth.len());
        for (((passes, _), in_slices), speeds_mm_per_s) in operations.iter().zip(&speeds) {
            hob_wear::add(&mut cost, law, passes, speeds_mm_per_s, &lengths_mm, in_slices);
        }
        cost
    }))
}

/// The hob and its teeth.
fn worn_tool(job: &HobbingJob) -> WornTool {
    WornTool {
        name: "hob",
        tooth: &HOB_TOOTH,
        numbering: "from the entering end",
        labels: job.hob.labels(),
        places: PLACE_NAMES,
        flanks: ["flank to the entering end", "flank to the leaving end"],
        more: Some((&AXIAL, job.hob.teeth.iter().map(|tooth| tooth.axial_mm).collect())),
    }
}

/// Bars by hob tooth with the stem of their file; none where nothing was cut.
pub fn bars(job: &HobbingJob, wear: &ToolWear) -> Option<(String, BarChart)> {
    tool_wear::bars(&worn_tool(job), &job.scene.name, wear)
}

/// What is found.
pub fn findings(job: &HobbingJob, wear: &ToolWear) -> Section {
    let section = tool_wear::findings(&worn_tool(job), wear);
    if wear.by_constants.cost.first().is_none() {
        return section;
    }
    shifted(job, wear, section)
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
fn shifted(job: &HobbingJob, wear: &ToolWear, section: Section) -> Section {
    let threads = threads(job);
    let spacing_mm = job.hob.tooth_spacing_mm();
    let room = room_in_teeth(job);
    let shifts = hob_wear::shifts(&threads, &wear.by_constants.share_of_life(), room);
    let best = shifts.as_deref().and_then(longest);
    let at_ends: Option<Vec<f64>> = best.and_then(|best| {
        let ends = wear.in_ranges.iter().map(|of| {
            let same = hob_wear::same_shift(&threads, &of.share_of_life(), room, best)?;
            Some(same.gears as f64)
        });
        ends.collect()
    });
    let range = at_ends
        .filter(|ends| !ends.is_empty())
        .map(|ends| [ends.iter().copied().fold(f64::INFINITY, f64::min), ends.iter().copied().fold(0.0, f64::max)]);
    let why = if best.is_some() && wear.in_ranges.is_empty() { NO_RANGE } else { NO_ROOM };
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
