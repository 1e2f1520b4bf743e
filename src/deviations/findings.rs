//! Measured points as findings.

use super::Foot;
use super::fit::{COUNTED, FitFreedom, LaidPoints};
use super::notices::{ContradictedFlanks, PointsOffFlanks};
use super::probed::ProbedPoint;
use super::quantities::{
    ALIGNED_TURN, DEEPEST, DEEPEST_OF, DEVIATION, DEVIATIONS, FITTED_POINTS, FLANK_DEVIATIONS, HIGHEST, HIGHEST_OF,
    MEAN, MEAN_OF, ON_FLANKS, POINT_DEVIATIONS, POINTS, POINTS_OF, RMS, RMS_OF, SHIFT_X, SHIFT_Y, SHIFT_Z, TILT_X,
    TILT_Y, X, Y, Z,
};
use crate::findings::quantities::teeth::{FLANK, TOOTH};
use crate::findings::{Findings, Notice, Table};
use crate::influence::quantities::budget::{U, V};
use crate::number_text::significant;
use crate::scene::Scene;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use std::collections::BTreeMap;

/// Arc seconds of a degree.
const ARCSEC: f64 = 3600.0;

/// Deviations of some points, um.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FlankSpread {
    pub count: usize,
    pub mean_um: f64,
    pub rms_um: f64,
    pub rms_from_mean_um: f64,
    pub ends_um: [f64; 2],
}

impl FlankSpread {
    fn of<'a>(feet: impl Iterator<Item = &'a Foot>) -> Self {
        let um: Vec<f64> = feet.map(|foot| UM_PER_MM * foot.height_mm).collect();
        let count = um.len();
        let mean = |of: &dyn Fn(f64) -> f64| um.iter().map(|&um| of(um)).sum::<f64>() / count.max(1) as f64;
        let mean_um = mean(&|um| um);
        Self {
            count,
            mean_um,
            rms_um: mean(&|um| um * um).sqrt(),
            rms_from_mean_um: mean(&|um| (um - mean_um).powi(2)).sqrt(),
            ends_um: um.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], &um| [l.min(um), h.max(um)]),
        }
    }
}

/// Spreads by flank.
pub(super) fn by_flank(laid: &LaidPoints) -> BTreeMap<(u32, Side), FlankSpread> {
    let mut flanks: BTreeMap<(u32, Side), Vec<&Foot>> = BTreeMap::new();
    for foot in laid.feet.iter().flatten() {
        flanks.entry((foot.tooth, foot.side)).or_default().push(foot);
    }
    flanks.into_iter().map(|(flank, feet)| (flank, FlankSpread::of(feet.into_iter()))).collect()
}

/// The tree.
pub fn findings(scene: &Scene, points: &[ProbedPoint], freedom: FitFreedom, laid: &LaidPoints) -> Findings {
    let all = FlankSpread::of(laid.feet.iter().flatten());
    let headline =
        [ON_FLANKS.of(all.count), RMS.of(all.rms_um), DEEPEST.of(all.ends_um[0]), HIGHEST.of(all.ends_um[1])];
    let mut entries = vec![POINTS.of(points.len()), FITTED_POINTS.of(laid.fitted), MEAN.of(all.mean_um)];
    let free = |least: FitFreedom| freedom.count() >= least.count();
    if free(FitFreedom::Turn) {
        entries.push(ALIGNED_TURN.of(laid.moved.angle_rad().to_degrees()));
    }
    let shift_um = (UM_PER_MM * laid.moved.shift_mm).to_array();
    if free(FitFreedom::Centre) {
        entries.extend([SHIFT_X.of(shift_um[0]), SHIFT_Y.of(shift_um[1])]);
    }
    if free(FitFreedom::Axis) {
        let [x, y] = laid.moved.tilt_rad().map(|rad| ARCSEC * rad.to_degrees());
        entries.extend([TILT_X.of(x), TILT_Y.of(y)]);
    }
    if free(FitFreedom::Body) {
        entries.push(SHIFT_Z.of(shift_um[2]));
    }
    let section = DEVIATIONS.section(entries).table(flanks(laid)).table(places(points, laid));
    let (off, measured) = (points.len() - all.count, points.len());
    let contradicted = laid.unnamed.map(|unnamed| {
        ContradictedFlanks {
            named: all.count,
            points: measured,
            rms_um: significant(all.rms_um, 3),
            unnamed,
            way_out: COUNTED,
        }
        .notice()
    });
    let off = (off > 0 && contradicted.is_none()).then(|| PointsOffFlanks { off, points: measured }.notice());
    let warnings: Vec<Notice> = contradicted.into_iter().chain(off).collect();
    Findings::new(scene.process_name(), &scene.name, true, headline, warnings, vec![section])
}

fn flanks(laid: &LaidPoints) -> Table {
    FLANK_DEVIATIONS
        .table(by_flank(laid))
        .column(&TOOTH, |((tooth, _), _)| *tooth)
        .column(&FLANK, |((_, side), _)| side.name())
        .column(&POINTS_OF, |(_, spread)| spread.count)
        .column(&MEAN_OF, |(_, spread)| spread.mean_um)
        .column(&RMS_OF, |(_, spread)| spread.rms_from_mean_um)
        .column(&DEEPEST_OF, |(_, spread)| spread.ends_um[0])
        .column(&HIGHEST_OF, |(_, spread)| spread.ends_um[1])
        .in_file("flanks")
}

/// A row for each point on a flank; of points that share a place to the last digit, such as the ends of lines in a
/// drawing, the first one.
fn places(points: &[ProbedPoint], laid: &LaidPoints) -> Table {
    let mut seen = std::collections::BTreeSet::new();
    let key = |foot: &Foot| (foot.tooth, foot.side, [foot.u_mm, foot.v_mm].map(|mm| (mm * 1e6).round() as i64));
    let moved = |point: &ProbedPoint| laid.moved.place_mm(point);
    let feet = laid.feet.iter().zip(points).filter_map(|(foot, point)| Some((foot.as_ref()?, moved(point))));
    POINT_DEVIATIONS
        .table(feet.filter(|(foot, _)| seen.insert(key(foot))))
        .column(&TOOTH, |(foot, _)| foot.tooth)
        .column(&FLANK, |(foot, _)| foot.side.name())
        .column(&U, |(foot, _)| foot.u_mm)
        .column(&V, |(foot, _)| foot.v_mm)
        .column(&DEVIATION, |(foot, _)| UM_PER_MM * foot.height_mm)
        .column(&X, |(_, place)| place.x)
        .column(&Y, |(_, place)| place.y)
        .column(&Z, |(_, place)| place.z)
        .rows_in_file("deviations")
}
