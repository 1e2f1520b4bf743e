//! What to look at first on a hobbed gear: the class that it reaches and what decides it, the thickest chip, the force
//! and the work of the hob, where the hob can be shifted to, then marks, deviations and times.

use super::{Measured, NOT_CROSSED};
use crate::findings::{Entry, Place, Quantity};
use crate::measure::deviation::PitchDeviations;
use crate::measure::verdict::JudgedFigure;
use crate::process::hobbing::measure::flank_report::HobbedReport;
use crate::process::hobbing::measure::hob_load::OperationLoad;
use crate::process::hobbing::measure::hoffmeister;
use crate::process::hobbing::run::load::labels;
use crate::process::hobbing::{HobbedGear, HobbingJob};
use crate::steps::axes;
use crate::steps::inspection::{Inspected, class_words, verdict_words};
use gearcut_core::units::UM_PER_MM;

/// Class with its verdict, and the figure that comes nearest to its limit or is furthest beyond it.
fn quality(inspected: &Inspected) -> Vec<Entry> {
    let verdict = &inspected.verdict;
    let mut entries = Vec::new();
    if verdict.no_class.is_none() {
        let words = format!("{}, {}", class_words(verdict.class()), verdict_words(verdict.passes()));
        let definition = "finest flank tolerance class of ISO 1328-1:2013 that all figures keep, and whether all \
                          limits are kept; the section inspection has both";
        entries.push(Entry::headline("class_reached", "class reached", Quantity::text(words, definition)));
    }
    let used = |judged: &JudgedFigure| Some(judged.worst()?.value_um.abs() / judged.limit?.0);
    let nearest = verdict.figures.iter().filter_map(|judged| Some((used(judged)?, judged)));
    let nearest = nearest.max_by(|a, b| a.0.total_cmp(&b.0));
    entries.extend(nearest.and_then(|(share, judged)| {
        let (worst, limit) = (judged.worst()?, judged.limit?);
        let mut place = Place::default()
            .and("figure", judged.figure.symbol())
            .and("value_um", worst.value_um)
            .and("limit_um", limit.0);
        if let (Some(tooth), Some(side)) = (worst.tooth, worst.side) {
            place = place.and("tooth", tooth).and("flank", side.name());
        }
        let definition = "largest share of its limit that a figure takes; the section inspection has all of them";
        let quantity = Quantity::number(100.0 * share, "%", definition).at(place);
        Some(Entry::headline("largest_of_limit", "largest share of a limit", quantity))
    }));
    entries
}

/// Chips, force and work of the hob's teeth; nothing where the run was stopped before the whole blank was cut.
fn tool(job: &HobbingJob, measured: &Measured) -> Vec<Entry> {
    let Some((_, loads, forces)) = measured.whole else { return Vec::new() };
    let labels = labels(job);
    let at = |operation: usize, tooth: usize| {
        Place::default()
            .and("operation", job.operations[operation].spec.name.clone())
            .and("hob_tooth", labels[tooth].clone())
    };
    let largest = |value: &dyn Fn(&OperationLoad) -> Option<(f64, usize)>| {
        let all = loads.iter().enumerate().filter_map(|(index, load)| Some((index, value(load)?)));
        all.max_by(|a, b| a.1.0.total_cmp(&b.1.0))
    };
    let mut entries = Vec::new();
    let thickest =
        largest(&|load| load.peak(|of| of.thickness_mm).map(|tooth| (load.teeth[tooth].thickness_mm, tooth)));
    if let Some((operation, (thickness_mm, tooth))) = thickest {
        let definition = "largest uncut chip thickness of any hob tooth, across the swept surface of its edge";
        let quantity = Quantity::number(thickness_mm, "mm", definition).at(at(operation, tooth));
        entries.push(Entry::headline("thickest_chip", "thickest chip", quantity));
    }
    if let Some(thickness_mm) = hoffmeister::thickest_chip_mm(job) {
        let definition = "thickest chip of the first operation by the formula of Hoffmeister (1970), fitted to \
                          standard racks on round gears";
        let quantity = Quantity::number(thickness_mm, "mm", definition);
        entries.push(Entry::headline("thickest_chip_by_hoffmeister", "by Hoffmeister's formula", quantity));
    }
    let peaks = forces.iter().enumerate().filter_map(|(index, force)| Some((index, force.peak(|of| of.peak_n)?)));
    if let Some((operation, pass)) = peaks.max_by(|a, b| a.1.peak_n.total_cmp(&b.1.peak_n)) {
        let definition = "largest cutting force of a hob tooth, referred to its tip";
        let quantity = Quantity::number(pass.peak_n, "N", definition).at(at(operation, pass.tooth));
        entries.push(Entry::headline("largest_force", "largest cutting force", quantity));
    }
    let hardest = largest(&|load| Some((load.peak_to_mean()?, load.peak(|of| of.volume_mm3)?)));
    if let Some((operation, (ratio, tooth))) = hardest {
        let definition = "volume of the hob tooth that takes most over the mean of all; 1 where all work alike";
        let quantity = Quantity::number(ratio, "times", definition).at(at(operation, tooth));
        entries.push(Entry::headline("hob_load_peak_to_mean", "hardest hob tooth to mean", quantity));
    }
    let plan = &job.finishing().plan;
    let [from, to] = plan.shift_range_mm;
    if from == to {
        let room_mm = job.hob.length_mm - 2.0 * plan.contact_half_length_mm;
        let definition = "length of the hob beyond what full contact takes: by so much it can be shifted";
        entries.push(Entry::headline("shift_room", "left to shift by", Quantity::number(room_mm, "mm", definition)));
    } else {
        let definition = "range of the hob's middle along its axis while it cuts, last operation";
        let quantity = Quantity::number((to - from).abs(), "mm", definition);
        entries.push(Entry::headline("shift_range", "range of the shift", quantity));
    }
    entries
}

/// Largest value over all flanks with its flank.
fn largest(gear: &HobbedGear, value: impl Fn(&HobbedReport) -> Option<f64>) -> Option<(f64, &HobbedReport)> {
    gear.flanks.iter().filter_map(|flank| value(flank).map(|v| (v, flank))).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// What to look at first.
pub(super) fn headline(job: &HobbingJob, gear: &HobbedGear, measured: &Measured) -> Vec<Entry> {
    type At<'a> = &'a dyn Fn(&HobbedReport) -> Option<[f64; 2]>;
    let extreme_at = |value: &dyn Fn(&HobbedReport) -> Option<f64>, at: At, definition: &'static str| {
        let found = largest(gear, value);
        let quantity = Quantity::number_or(
            found.map(|(v, _)| v * UM_PER_MM),
            "um",
            definition,
            "a dexel of every evaluated part was reached by no pass",
        );
        match found {
            None => quantity,
            Some((_, flank)) => {
                let [u_mm, v_mm] = at(flank).unwrap_or([0.5 * flank.length_mm, 0.0]);
                quantity.at(Place::on_flank(flank.tooth, flank.side.name(), u_mm, v_mm))
            }
        }
    };
    // Traces stand in the middle of the flank.
    let extreme = |value: &dyn Fn(&HobbedReport) -> Option<f64>, definition: &'static str| {
        extreme_at(value, &|_| None, definition)
    };
    let of_pitch = |pick: fn(&PitchDeviations) -> f64, definition: &'static str| {
        let largest = gear.inspection.pitch.iter().flatten().map(pick).reduce(f64::max);
        Quantity::number_or(largest.map(|mm| mm * UM_PER_MM), "um", definition, NOT_CROSSED)
    };
    let sharpest = job.curve.facts().largest_curvature.curvature_per_mm;
    let mut entries = quality(measured.inspected);
    entries.extend(tool(job, measured));
    entries.extend([
        Entry::headline(
            "highest_deviation",
            "highest deviation",
            extreme_at(
                &|f| f.own.finished.map(|h| h.highest_mm),
                &|f| f.own.finished.map(|h| h.extremes_at_mm[1]),
                "largest normal deviation of the finished surface on the evaluated part of any flank: feed and \
                generating marks together",
            ),
        ),
        Entry::headline(
            "deepest_cut",
            "deepest cut",
            extreme_at(
                &|f| f.own.finished.map(|h| -h.lowest_mm),
                &|f| f.own.finished.map(|h| h.extremes_at_mm[0]),
                "deepest place of the finished surface below the target, positive inwards; an exact linkage leaves \
                none",
            ),
        ),
        Entry::headline(
            "feed_mark_closed_form",
            "feed mark, closed form",
            Quantity::number(
                job.feed_mark_mm(job.finishing()) * UM_PER_MM,
                "um",
                "highest ridge between two feeds of the last operation, f^2 / (8 cos^2 beta) (Q_TT - Q_Tc^2 / Q_cc), Q \
                the gap that one gash leaves, T the tooth trace, c the row of gashes",
            ),
        ),
        Entry::headline(
            "generating_mark_closed_form",
            "generating mark, closed form",
            Quantity::number(
                job.generating_mark_mm(sharpest) * UM_PER_MM,
                "um",
                "arc per gash squared times sin(alpha_t) cos(beta_b) / (8 rho) where the pitch curve bends most",
            ),
        ),
        Entry::headline(
            "profile_deviation",
            "profile deviation",
            extreme(&|f| f.profile.map(|d| d.total_mm), "largest F_alpha in the middle of the face"),
        ),
        Entry::headline(
            "helix_deviation",
            "helix deviation",
            extreme(&|f| f.lead.map(|d| d.total_mm), "largest F_beta in the middle of the profile"),
        ),
        Entry::headline(
            "single_pitch_deviation",
            "single pitch deviation",
            of_pitch(PitchDeviations::largest_single_mm, "largest f_p of either flank, arc of the pitch curve"),
        ),
        Entry::headline(
            "total_pitch_deviation",
            "total pitch deviation",
            of_pitch(PitchDeviations::total_mm, "F_p, range of the cumulative pitch deviations, larger of both flanks"),
        ),
        Entry::headline(
            "runout",
            "runout",
            Quantity::number_or(
                gear.inspection.runout.as_ref().map(|r| r.total_mm() * UM_PER_MM),
                "um",
                "F_r, range of a probe's place along the pitch curve's normal over all spaces",
                NOT_CROSSED,
            ),
        ),
        Entry::headline(
            "undercut_flanks",
            "undercut flanks",
            Quantity::count(
                gear.flanks.iter().filter(|f| f.own.undercut).count() as u64,
                "flanks",
                "flanks whose involute the hob's tip corner has cut away in some section",
            ),
        ),
        axes::margin_entry(measured.motion),
        Entry::headline(
            "cycle_time",
            "cycle time",
            Quantity::number(
                job.operations.iter().map(|o| o.linkage.end_s()).sum(),
                "s",
                "time of all operations, approach, overrun and idle travel included",
            ),
        ),
    ]);
    entries
}
