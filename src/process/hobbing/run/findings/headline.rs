//! What to look at first on a hobbed gear: the class that it reaches and what decides it, what every gear has, then the
//! closed forms of marks, the work of the hob and where it can be shifted to.

use super::Measured;
use crate::findings::quantities::cutting::{IDLE, LARGEST_FORCE, NO_MATERIAL, STOPPED, THICKEST_CHIP};
use crate::findings::quantities::flanks::UNDERCUT_FLANKS;
use crate::findings::{Entry, Notice, Place};
use crate::process::hobbing::measure::hob_load::OperationLoad;
use crate::process::hobbing::measure::hoffmeister;
use crate::process::hobbing::quantities::{
    DRAWN_TOOTH, FEED_MARK, GENERATING_MARK, HOFFMEISTER, NOTHING, PEAK_TO_MEAN, SHIFT_RANGE, SHIFT_ROOM,
};
use crate::process::hobbing::{HobbedGear, HobbingJob};
use crate::steps::axes;
use crate::steps::inspection::headline::{self, Cutting, Placed, quality};
use crate::steps::whole_blank::mean;
use gearcut_core::units::UM_PER_MM;

/// What to look at first.
pub(super) fn headline(job: &HobbingJob, gear: &HobbedGear, measured: &Measured, known: &[Notice]) -> Vec<Entry> {
    let labels = job.hob.labels();
    let at = |operation: usize, tooth: usize| {
        Place::default()
            .and("operation", job.operations[operation].spec.name.clone())
            .and("hob_tooth", labels[tooth].clone())
    };
    // The operation and the tooth of the hob in which a value is largest.
    let largest = |value: &dyn Fn(&OperationLoad) -> Option<(f64, usize)>| -> Placed {
        let (_, loads, _) = measured.whole.ok_or(STOPPED)?;
        let all = loads.iter().enumerate().filter_map(|(index, load)| Some((index, value(load)?)));
        let (operation, (value, tooth)) = all.max_by(|a, b| a.1.0.total_cmp(&b.1.0)).ok_or(IDLE)?;
        Ok((value, at(operation, tooth)))
    };
    let force_n = || -> Placed {
        let (.., forces) = measured.whole.ok_or(STOPPED)?;
        job.material.ok_or(NO_MATERIAL)?;
        let peaks = forces.iter().enumerate().filter_map(|(index, force)| Some((index, force.peak(|of| of.peak_n)?)));
        let (operation, pass) = peaks.max_by(|a, b| a.1.peak_n.total_cmp(&b.1.peak_n)).ok_or(IDLE)?;
        Ok((pass.peak_n, at(operation, pass.tooth)))
    };
    let cutting = Cutting {
        operations: job.operations.len(),
        cycle_s: job.operations.iter().map(|o| o.linkage.end_s()).sum(),
        margin: axes::margin(measured.motion),
        thickest_um: largest(&|load| {
            load.peak(|of| of.thickness_mm).map(|tooth| (load.teeth[tooth].thickness_mm * UM_PER_MM, tooth))
        }),
        force_n: force_n(),
        removed_mm3: measured.whole.map(|(whole, ..)| mean(whole.report.blank_mm3) - mean(whole.report.left_mm3)),
    };
    let undercut = gear.flanks.iter().filter(|flank| flank.own.undercut).count();
    let sharpest = job.curve.facts().largest_curvature.curvature_per_mm;
    let mut entries = headline::headline(&gear.flanks, Some(&gear.inspection), cutting, &gear.work);
    entries.extend([
        UNDERCUT_FLANKS.of(undercut),
        FEED_MARK.of_or(job.feed_mark_mm(job.finishing()).map(|mm| mm * UM_PER_MM), DRAWN_TOOTH),
        GENERATING_MARK.of_or(job.generating_mark_mm(sharpest).map(|mm| mm * UM_PER_MM), DRAWN_TOOTH),
        match largest(&|load| Some((load.peak_to_mean()?, load.peak(|of| of.volume_mm3)?))) {
            Ok((ratio, place)) => PEAK_TO_MEAN.of(ratio).at(place),
            Err(STOPPED) => PEAK_TO_MEAN.none(STOPPED),
            Err(_) => PEAK_TO_MEAN.none(NOTHING),
        }
        .titled("hardest hob tooth to mean"),
    ]);
    entries.extend(hoffmeister::thickest_chip_mm(job).map(|mm| HOFFMEISTER.of(mm * UM_PER_MM)));
    let plan = &job.finishing().plan;
    let [from, to] = plan.shift_range_mm;
    entries.push(if from == to {
        SHIFT_ROOM.of(job.hob.length_mm - 2.0 * plan.contact_half_length_mm)
    } else {
        SHIFT_RANGE.of((to - from).abs())
    });
    // What is asked of the hob comes before the flanks.
    let first = [&THICKEST_CHIP, &HOFFMEISTER, &LARGEST_FORCE, &PEAK_TO_MEAN, &SHIFT_ROOM, &SHIFT_RANGE];
    entries.sort_by_key(|entry| first.iter().position(|row| row.key == entry.key).unwrap_or(first.len()));
    quality(measured.inspected, known).into_iter().chain(entries).collect()
}
