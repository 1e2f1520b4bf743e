//! Everything measured on one flank after all operations.
//!
//! In: the job, the target flank, the cut field. Out: [`FlankReport`]: where the flank begins and ends, stock between
//! each operation and the finished surface, heights, scallops, profile deviations, cuts below it, the witness mark.
//! Heights come from the dexels; begin and end from the closed form.

use super::thin_tips;
use crate::measure::cut_grid::{evaluated_face_mm, evaluated_mm};
use crate::measure::deviation::Trace;
use crate::measure::inspection::{FlankSurface, InspectedFlank, StockRange, TracedLines};
use crate::measure::scallop::{Cusp, cusps, facets, step};
use crate::measure::stock::{Extreme, Stock, extremes, stock};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::target::{FlankEnd, TargetFlank};
use crate::steps::planar::CutField;
use gearcut_core::dexel::figures::{ColumnHeights, LinesAt, RESOLUTION_MM};
use gearcut_core::dexel::{Field, NO_PASS};

/// What may stay of the blank at the tip corner, in modules: rounding decides of the last ray, and errors that shift a
/// gear within its tolerances shift its corner as far. Tips are broken by more.
const TIP_CORNER_MODULES: f64 = 0.02;

/// Where a flank begins or ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankLimit {
    /// What limits it.
    pub end: FlankEnd,
    /// Height over the pitch curve along its normal, mm.
    pub height_mm: f64,
    /// Distance from the gear axis, mm.
    pub radius_mm: f64,
}

/// Cusps of one flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scallops {
    /// Highest cusp on the evaluated profile.
    pub largest: Cusp,
    /// Cusp nearest to the pitch curve.
    pub at_pitch_curve: Option<Cusp>,
}

/// What no pass reached of a flank, but for its tip corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uncut {
    /// Dexels.
    pub dexels: u64,
    /// Their share of the flank's.
    pub share: f64,
    /// Arc of the lowest of them, mm.
    pub from_mm: f64,
}

/// One flank, measured: the line along the tooth runs at the pitch curve, or in the middle of the evaluated profile
/// where the flank does not reach the curve, and is evaluated over the face without 5 % at either end; dexels of the
/// whole flank count as untouched.
pub type FlankReport = InspectedFlank<ShapedFlank>;

/// What is measured on shaped flanks alone.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapedFlank {
    /// Start of the involute.
    pub form: FlankLimit,
    /// Tip.
    pub tip: FlankLimit,
    /// How deep the cutter's tip cuts below the flank under its start, mm; none where it is not undercut.
    pub undercut_mm: Option<f64>,
    /// Stock of every operation but the last over the finished surface, on the active flank: the evaluated profile
    /// above the operation's own fillet. `None` where the operation reached nothing.
    pub stock: Vec<Option<Stock>>,
    /// The same below it, where the operation's fillet stands on the finished flank.
    pub fillet_stock: Vec<Option<Stock>>,
    /// Smallest and largest normal deviation of the finished surface on the evaluated profile.
    pub finished: Option<[Extreme; 2]>,
    /// Arcs between which the surface of each earlier operation is its flank and no fillet, mm; stock is judged there.
    pub active_mm: Vec<[f64; 2]>,
    /// Deepest cut below the target on any ray that does not end in the next space, if deeper than the dexels'
    /// resolution.
    pub below_target: Option<Extreme>,
    /// Scallops in the middle of the face.
    pub scallops: Option<Scallops>,
    /// The step where strokes of the finishing operation meet that are more than half a turn apart, mid-face: how far
    /// the later ones' facet lies over the earlier ones', negative where it is deeper.
    pub witness: Option<Extreme>,
    /// Stroke of the finishing operation that left the flank at the pitch curve, mid-face.
    pub pitch_stroke: Option<usize>,
    /// What is still the blank.
    pub uncut: Option<Uncut>,
    /// Dexels that were cut deeper than their rays record, but for rays that end in the next space.
    pub below_range: u64,
    /// The evaluated profile was cut deeper than its rays record, half a module under the target: heights there are
    /// upper bounds, and nothing that follows from them is stated.
    pub is_lost: bool,
}

impl FlankSurface for ShapedFlank {
    fn deviations(&self) -> Option<[Extreme; 2]> {
        self.finished
    }

    fn stock(&self, operation: usize) -> Option<StockRange> {
        let stock = (*self.stock.get(operation)?)?;
        Some(StockRange { ends: [stock.smallest, stock.largest], mean_mm: stock.mean_mm })
    }

    fn is_below_range(&self) -> bool {
        self.below_range > 0
    }

    fn is_lost(&self) -> bool {
        self.is_lost
    }
}

/// Arcs between which profiles and textures are evaluated, mm from the form point: as the scene says, else without 5 %
/// of the flank at either end.
pub fn evaluated_profile_mm(job: &ShapingJob, flank: &TargetFlank) -> [f64; 2] {
    let arc_at = |height_mm: f64| flank.at_height(&job.blank, height_mm).map(|(arc, _)| arc);
    evaluated_mm(flank.length_mm(), job.scene.measure.ends_mm(arc_at))
}

/// Arc of a flank at the height where an operation's own involute begins, mm; 0 where it begins below the flank.
fn begins_mm(job: &ShapingJob, operation: usize, flank: &TargetFlank) -> f64 {
    let begin_mm = |of: &TargetFlank| {
        let contact = of.form_contact();
        job.blank.height(contact.point_mm, contact.phi_rad).0
    };
    let Some(own_mm) = job.envelope_flank(operation, flank.tooth, flank.side).map(begin_mm) else { return 0.0 };
    match flank.at_height(&job.blank, own_mm) {
        Some((arc_mm, _)) => arc_mm,
        None if own_mm > begin_mm(flank) => flank.length_mm(),
        None => 0.0,
    }
}

/// Lines on which a flank is measured dexel by dexel: its profile in the middle of the face, and the line along the
/// tooth at the pitch curve, or in the middle of the evaluated profile where the flank does not reach the curve.
pub fn lines(job: &ShapingJob, flank: &TargetFlank, field: &Field) -> LinesAt {
    let pitch_arc_mm = flank.at_height(&job.blank, 0.0).map(|(arc, _)| arc);
    let lead_arc_mm = pitch_arc_mm.unwrap_or_else(|| {
        let [from_mm, to_mm] = evaluated_profile_mm(job, flank);
        0.5 * (from_mm + to_mm)
    });
    let distance = |column: usize| (field.columns[column].arc_mm - lead_arc_mm).abs();
    let column = (0..field.columns.len()).min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
    LinesAt { row: field.rows() / 2, column }
}

/// Measures a flank with these rows, of which those that differ were cut: what is measured on one that stands for many
/// is the same on all of them.
pub fn measure(job: &ShapingJob, flank: &TargetFlank, cut: &CutField, rows_z_mm: &[f64]) -> FlankReport {
    let field = &cut.field;
    let lines = lines(job, flank, field);
    let columns = cut.columns(lines);
    let last = columns.operations() - 1;
    let copies = cut.copies(rows_z_mm) as u64;
    let limit = |arc_mm: f64, end| {
        let contact = flank.at_arc(arc_mm);
        let (height_mm, _) = job.blank.height(contact.point_mm, contact.phi_rad);
        FlankLimit { end, height_mm, radius_mm: contact.point_mm.length() }
    };
    let length_mm = flank.length_mm();
    let evaluated_mm = evaluated_profile_mm(job, flank);
    let inside = |arc: f64| arc >= evaluated_mm[0] && arc <= evaluated_mm[1];
    let tells = thin_tips::tell(job, flank, field, columns);
    let is_evaluated = |column: usize| inside(field.columns[column].arc_mm);
    let counts = |column: usize| tells[column] && is_evaluated(column);
    let all = || 0..field.columns.len();
    let heights: Vec<ColumnHeights> = all().map(|column| columns.heights(last, column)).collect();
    let evaluated =
        extremes(field, all().filter(|&column| counts(column)).map(|column| (column, heights[column].reached)));
    let told = all().filter(|&column| tells[column]);
    let deepest = extremes(field, told.clone().map(|column| (column, [heights[column].lowest; 2]))).map(|[low, _]| low);

    let profile_field = Field { columns: field.columns.clone(), rows_z_mm: vec![field.rows_z_mm[lines.row]] };
    let profile = columns.profile();
    let facets = facets(&profile_field, &profile, 0);
    let operation = job.finishing();
    let stroke = |pass: u32| {
        let is_finishing = pass >= operation.strokes.first_pass && pass != NO_PASS;
        is_finishing.then(|| operation.strokes.stroke_and_blade(pass).0)
    };
    // Between strokes of different turns there is a step and no ridge.
    let of_one_turn = |cusp: &Cusp| {
        let [Some(left), Some(right)] = cusp.passes.map(stroke) else { return false };
        left.abs_diff(right) <= operation.half_turn()
    };
    let cusps: Vec<Cusp> = cusps(&facets).into_iter().filter(|cusp| inside(cusp.arc_mm) && of_one_turn(cusp)).collect();
    let pitch_arc_mm = flank.at_height(&job.blank, 0.0).map(|(arc, _)| arc);
    let largest = cusps.iter().copied().max_by(|a, b| a.height_mm.total_cmp(&b.height_mm));
    let scallops = largest.map(|largest| Scallops {
        largest,
        at_pitch_curve: pitch_arc_mm.and_then(|pitch| {
            cusps.iter().copied().min_by(|a, b| (a.arc_mm - pitch).abs().total_cmp(&(b.arc_mm - pitch).abs()))
        }),
    });

    // The witness mark: where the end of the operation meets its beginning, or an earlier turn.
    let witness = step(&facets, operation.half_turn(), stroke).filter(|step| inside(step.arc_mm));
    let arcs_mm: Vec<f64> = field.columns.iter().map(|column| column.arc_mm).collect();
    let profile_trace = Trace::along_profile(flank.rolls_mm(&job.blank, &arcs_mm), &profile_field, &profile, 0);
    let evaluated_rolls_mm = flank.rolls_mm(&job.blank, &evaluated_mm);
    let pitch_stroke = pitch_arc_mm.and_then(|_| stroke(profile.passes[lines.column]));
    let lead_field = Field { columns: vec![field.columns[lines.column]], rows_z_mm: field.rows_z_mm.clone() };
    let lead_trace = Trace::along_tooth(&lead_field, &columns.along(), 0).over_rows(rows_z_mm);
    let below_range = told.map(|column| copies * u64::from(heights[column].at_bottom)).sum();
    let is_lost = all().any(|column| counts(column) && heights[column].at_bottom > 0);
    let is_told = all().all(|column| tells[column] || !is_evaluated(column));
    let corner_mm = length_mm - TIP_CORNER_MODULES * job.scene.gear.module_mm;
    let below_corner = all().filter(|&column| field.columns[column].arc_mm <= corner_mm.max(evaluated_mm[1]));
    let uncut: Vec<(usize, u64)> =
        below_corner.map(|column| (column, u64::from(heights[column].untouched))).filter(|of| of.1 > 0).collect();
    let uncut = uncut.first().map(|&(lowest, _)| {
        let dexels: u64 = uncut.iter().map(|of| of.1).sum();
        let from_mm = field.columns[lowest].arc_mm;
        Uncut { dexels: copies * dexels, share: dexels as f64 / field.len() as f64, from_mm }
    });
    // Where the involute of every earlier operation begins on this flank; its fillet stands below.
    let from_mm = |operation: usize| begins_mm(job, operation, flank).max(evaluated_mm[0]);
    let active_mm: Vec<[f64; 2]> = (0..last).map(|operation| [from_mm(operation), evaluated_mm[1]]).collect();
    let arc_mm = |column: usize| field.columns[column].arc_mm;
    let active = |operation: usize| {
        let [from_mm, to_mm] = active_mm[operation];
        move |column: usize| (from_mm..=to_mm).contains(&arc_mm(column))
    };
    let fillet = |operation: usize| {
        let [from_mm, _] = active_mm[operation];
        move |column: usize| arc_mm(column) < from_mm
    };
    let stock_in = |operation: usize, counts: &dyn Fn(usize) -> bool| {
        stock(field, columns, operation, |column| tells[column] && counts(column))
            .filter(|_| !is_lost)
            .map(|stock| stock.of_rows(copies))
    };
    let own = ShapedFlank {
        form: limit(0.0, flank.form_end),
        tip: limit(length_mm, flank.tip_end),
        undercut_mm: flank.undercut.map(|undercut| undercut.depth_mm),
        stock: (0..last).map(|operation| stock_in(operation, &active(operation))).collect(),
        fillet_stock: (0..last).map(|operation| stock_in(operation, &fillet(operation))).collect(),
        finished: evaluated.filter(|_| !is_lost),
        active_mm,
        below_target: deepest.filter(|low| low.value_mm < -RESOLUTION_MM),
        scallops: scallops.filter(|_| !is_lost),
        witness: witness.filter(|_| !is_lost),
        pitch_stroke,
        uncut,
        below_range,
        is_lost,
    };
    InspectedFlank {
        tooth: flank.tooth,
        side: flank.side,
        length_mm,
        evaluated_mm,
        profile: profile_trace
            .deviation([evaluated_rolls_mm[0], evaluated_rolls_mm[1]])
            .filter(|_| is_told && !own.is_lost),
        lead: lead_trace.deviation(evaluated_face_mm(job.scene.gear.face_width_mm)).filter(|_| !own.is_lost),
        lines: TracedLines {
            arcs_mm,
            profile_v_mm: rows_z_mm[rows_z_mm.len() / 2],
            lead_arc_mm: field.columns[lines.column].arc_mm,
        },
        profile_trace,
        lead_trace,
        untouched: copies * heights.iter().map(|of| u64::from(of.untouched)).sum::<u64>(),
        own,
    }
}
