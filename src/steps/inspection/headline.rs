//! What the headline has of every gear, whatever cut it: stock, deviations, pitch, thickness, axes, chips, times, work.
//!
//! In: measured flanks, the pitch and thickness of teeth where the gear has a pitch curve, and the few numbers that
//! only the process can give ([`Cutting`]): a process that leaves one out does not compile. Out: entries in a fixed
//! order, to which the process adds its own.

use super::teeth::{HELIX, PROFILE, place};
use super::{Inspected, class_words, verdict_words};
use crate::findings::notice::Severity;
use crate::findings::quantities::cutting::{
    AXIS_MARGIN, CANDIDATES, CYCLE_TIME, LARGEST_FORCE, NO_LIMITS, REMOVAL_RATE, REMOVED_VOLUME, STOPPED, THICKEST_CHIP,
};
use crate::findings::quantities::flanks::{
    BELOW_RANGE, DEEPEST_CUT, FEW_DEXELS, HIGHEST_DEVIATION, LARGEST_STOCK, NO_STOCK, NO_TRACE, SINGLE, SMALLEST_STOCK,
    UNREACHED, UNTOUCHED_DEXELS,
};
use crate::findings::quantities::inspection::{CLASS_REACHED, LARGEST_OF_LIMIT};
use crate::findings::quantities::teeth::{
    LARGEST_THICKNESS, MOST_GONE, NO_THICKNESS, NOT_CROSSED, RUNOUT, SINGLE_PITCH, SMALLEST_THICKNESS, TOTAL_PITCH,
};
use crate::findings::{Entry, Notice, Place, QuantityRow};
use crate::measure::deviation::PitchDeviations;
use crate::measure::inspection::{FlankSurface, GearInspection, InspectedFlank};
use crate::measure::stock::Extreme;
use crate::measure::verdict::JudgedFigure;
use crate::steps::Work;
use gearcut_core::units::UM_PER_MM;

/// Beginnings of ids of notices on damaged flanks and tips.
const DAMAGE: [&str; 4] = ["flank.", "ring.", "tip.", "cut.deeper_than_finishing"];

/// A value with its place, or the reason why there is none.
pub type Placed = Result<(f64, Place), &'static str>;

/// What only the process knows of cutting.
#[derive(Debug)]
pub struct Cutting {
    /// Operations, in order.
    pub operations: usize,
    /// Time of all of them, s.
    pub cycle_s: f64,
    /// Share of the tightest axis limit that is left, [`crate::machine::smallest_margin`]; none without limits.
    pub margin: Option<f64>,
    /// Thickest chip, um.
    pub thickest_um: Placed,
    /// Largest cutting force, N.
    pub force_n: Placed,
    /// Volume that all operations removed, mm^3; none where the run was stopped before it was known.
    pub removed_mm3: Option<f64>,
}

/// Entries of the headline that all processes have.
pub fn headline<Own: FlankSurface>(
    flanks: &[InspectedFlank<Own>],
    teeth: Option<&GearInspection>,
    cutting: Cutting,
    work: &Work,
) -> Vec<Entry> {
    let mut entries = stock(flanks, cutting.operations);
    entries.extend(deviations(flanks));
    entries.extend(traces(flanks));
    entries.extend(teeth.map(pitch).into_iter().flatten());
    let lost = flanks.iter().filter(|flank| flank.own.is_lost()).count();
    entries.extend(teeth.map(|teeth| thickness(teeth, lost)).into_iter().flatten());
    let placed = |row: &QuantityRow, found: Placed| match found {
        Ok((value, place)) => row.of(value).at(place),
        Err(why) => row.none(why),
    };
    let rate = cutting.removed_mm3.map(|mm3| mm3 / (cutting.cycle_s / 60.0) / 1e3);
    entries.extend([
        AXIS_MARGIN.of_or(cutting.margin, NO_LIMITS),
        CYCLE_TIME.of(cutting.cycle_s),
        placed(&THICKEST_CHIP, cutting.thickest_um),
        placed(&LARGEST_FORCE, cutting.force_n),
        REMOVED_VOLUME.of_or(cutting.removed_mm3, STOPPED),
        REMOVAL_RATE.of_or(rate, STOPPED),
        UNTOUCHED_DEXELS.of(flanks.iter().map(|flank| flank.untouched).sum::<u64>()),
        candidates(work),
    ]);
    entries
}

/// Class with its verdict, and the figure that comes nearest to its limit or is furthest beyond it; `known` is what the
/// run has found.
pub fn quality(inspected: &Inspected, known: &[Notice]) -> Vec<Entry> {
    let verdict = &inspected.verdict;
    // Traces run in the middle of face and tooth: damage beside them is no deviation of theirs.
    let is_damage = |of: &Notice| of.severity == Severity::Fault && DAMAGE.iter().any(|id| of.id.starts_with(id));
    let beside = if known.iter().any(is_damage) { "; damage beside the traces is a fault of its own" } else { "" };
    let words = format!("{}, {}{beside}", class_words(verdict.class()), verdict_words(verdict.passes()));
    let class = verdict.no_class.is_none().then(|| CLASS_REACHED.of(words));
    let used = |judged: &JudgedFigure| Some(judged.worst()?.value_um.abs() / judged.limit?.0);
    let nearest = verdict.figures.iter().filter_map(|judged| Some((used(judged)?, judged)));
    let nearest = nearest.max_by(|a, b| a.0.total_cmp(&b.0)).and_then(|(share, judged)| {
        let (worst, limit) = (judged.worst()?, judged.limit?);
        let mut place = Place::default()
            .and("figure", judged.figure.symbol())
            .and("value_um", worst.value_um)
            .and("limit_um", limit.0);
        if let (Some(tooth), Some(side)) = (worst.tooth, worst.side) {
            place = place.and("tooth", tooth).and("flank", side.name());
        }
        Some(LARGEST_OF_LIMIT.of(100.0 * share).at(place))
    });
    class.into_iter().chain(nearest).collect()
}

/// Passes that the backend looked at for a dexel.
pub fn candidates(work: &Work) -> Entry {
    CANDIDATES.of(work.passes_per_dexel())
}

/// The flank on which `size` of a value is largest, the first of several, with its value there.
fn worst<Own>(
    flanks: &[InspectedFlank<Own>],
    size: fn(f64) -> f64,
    of: impl Fn(&InspectedFlank<Own>) -> Option<Extreme>,
) -> Option<(Extreme, Place)> {
    let found = flanks.iter().filter_map(|flank| Some((of(flank)?, flank)));
    let worst = found.reduce(|best, next| if size(next.0.value_mm) > size(best.0.value_mm) { next } else { best });
    worst.map(|(of, flank)| (of, place(flank, &of)))
}

/// The entry of a value that was found, `per_mm` of its unit in a mm.
fn entry(row: &QuantityRow, per_mm: f64, found: Option<(Extreme, Place)>, why: &'static str) -> Entry {
    match found {
        Some((of, place)) => row.of(of.value_mm * per_mm).at(place),
        None => row.none(why),
    }
}

/// Stock that the last operation finds.
fn stock<Own: FlankSurface>(flanks: &[InspectedFlank<Own>], operations: usize) -> Vec<Entry> {
    let why = if operations < 2 { SINGLE } else { NO_STOCK };
    let of =
        |end: usize| move |flank: &InspectedFlank<Own>| Some(flank.own.stock(operations.checked_sub(2)?)?.ends[end]);
    vec![
        entry(&SMALLEST_STOCK, 1.0, worst(flanks, |mm| -mm, of(0)), why),
        entry(&LARGEST_STOCK, 1.0, worst(flanks, |mm| mm, of(1)), why),
    ]
}

/// Heights of the finished surface.
fn deviations<Own: FlankSurface>(flanks: &[InspectedFlank<Own>]) -> [Entry; 2] {
    let of = |end: usize| move |flank: &InspectedFlank<Own>| Some(flank.own.deviations()?[end]);
    let below = flanks.iter().any(|flank| flank.own.is_below_range());
    [
        entry(&HIGHEST_DEVIATION, UM_PER_MM, worst(flanks, |mm| mm, of(1)), UNREACHED),
        if below {
            DEEPEST_CUT.none(BELOW_RANGE)
        } else {
            entry(&DEEPEST_CUT, -UM_PER_MM, worst(flanks, |mm| -mm, of(0)), UNREACHED)
        },
    ]
}

/// Figures of profiles and helices: the worst of each, slopes with their sign.
fn traces<Own: FlankSurface>(flanks: &[InspectedFlank<Own>]) -> Vec<Entry> {
    let is_whole = |flank: &InspectedFlank<Own>| flank.untouched == 0 && !flank.own.is_lost();
    let why = if !flanks.is_empty() && flanks.iter().all(is_whole) { FEW_DEXELS } else { NO_TRACE };
    let along_profile = PROFILE.map(|(row, value)| {
        let found = worst(flanks, f64::abs, |flank| {
            let arc_mm = 0.5 * (flank.evaluated_mm[0] + flank.evaluated_mm[1]);
            Some(Extreme { value_mm: value(flank.profile.as_ref()?), arc_mm, z_mm: flank.lines.profile_v_mm })
        });
        entry(row, UM_PER_MM, found, why)
    });
    let along_tooth = HELIX.map(|(row, value)| {
        let found = worst(flanks, f64::abs, |flank| {
            Some(Extreme { value_mm: value(flank.lead.as_ref()?), arc_mm: flank.lines.lead_arc_mm, z_mm: 0.0 })
        });
        entry(row, UM_PER_MM, found, why)
    });
    along_profile.into_iter().chain(along_tooth).collect()
}

fn pitch(teeth: &GearInspection) -> [Entry; 3] {
    let of = |row: &QuantityRow, pick: fn(&PitchDeviations) -> f64| {
        let largest = teeth.pitch.iter().flatten().map(pick).reduce(f64::max);
        row.of_or(largest.map(|mm| mm * UM_PER_MM), NOT_CROSSED)
    };
    [
        of(&SINGLE_PITCH, PitchDeviations::largest_single_mm),
        of(&TOTAL_PITCH, PitchDeviations::total_mm),
        RUNOUT.of_or(teeth.runout.as_ref().map(|of| of.total_mm() * UM_PER_MM), NOT_CROSSED),
    ]
}

/// Thinnest and thickest tooth. Of a gear that is cut away the teeth that are left say nothing where most are gone.
fn thickness(teeth: &GearInspection, lost: usize) -> [Entry; 2] {
    let all = teeth.thickness.len();
    let left_mm: Vec<f64> = teeth.thickness.iter().flatten().map(|of| of.arc_mm).collect();
    let are_most_gone = lost > 0 && 2 * left_mm.len() < all;
    let remark = format!(", of {} of {all} teeth; the others are cut away", left_mm.len());
    let of = |row: &QuantityRow, pick: fn(f64, f64) -> f64| {
        let value_mm = left_mm.iter().copied().reduce(pick).filter(|_| !are_most_gone);
        let entry = row.of_or(value_mm, if are_most_gone { MOST_GONE } else { NO_THICKNESS });
        if lost > 0 { entry.remarked(&remark) } else { entry }
    };
    [of(&SMALLEST_THICKNESS, f64::min), of(&LARGEST_THICKNESS, f64::max)]
}
