//! What in a bevel scene contradicts itself, as notices: cones, depth, roll, blades, travel of the axes, the
//! grid of inspection.
//!
//! In: a job. Out: lines for `check`, terminal and page; refusals where nothing can be measured.

use super::job::BevelJob;
use super::notices::{Depth, ExchangedBlades, PitchAngle, RootAngle, ShortRoll, Travel, WideFace};
use super::operation::PreparedBevel;
use crate::findings::Notice;
use crate::measure::cut_grid::within;
use gearcut_core::bevel::blank::Contradiction;
use gearcut_core::bevel::face_mill::BladeKind;
use gearcut_core::error::Refusal;
use gearcut_core::terms::Side;
use glam::DVec3;
use std::f64::consts::PI;

/// Settings off the blank's root angle by more than this are worth a word, rad.
const ROOT_ANGLE_RAD: f64 = 0.01 * PI / 180.0;
/// Depth missed by more than this is worth a word, mm.
const DEPTH_MM: f64 = 0.02;
/// Exchanging the blades has to bring the pressure angles nearer to the gear's by more than this, both sides together,
/// to be worth a word, rad: half a degree a side, above what a tilted root plane does.
const EXCHANGED_RAD: f64 = 1.0 * PI / 180.0;
/// Moments of a slot at which the axes are compared with their travel: they bend little between them.
const TRAVEL_STEPS: u32 = 64;

impl BevelJob {
    /// Refuses a grid of inspection with more points than a flank has dexels to stand on.
    pub(super) fn check_grid(&self) -> Result<(), Refusal> {
        for side in [Side::Left, Side::Right] {
            let (places_mm, ends_mm) = (self.places_mm(side), self.evaluated_mm(side));
            let lines = [0, 1].map(|k| within(&places_mm[k], ends_mm[k]).len());
            for (k, key, spacing) in [
                (0, "inspection.profile_points", "fields.flank.profile_spacing_um"),
                (1, "inspection.tooth_points", "fields.flank.lead_spacing_um"),
            ] {
                let asked = self.spec.grid[k];
                if asked > lines[k] {
                    return Err(Refusal::new(
                        key,
                        format!("{asked} points find {} lines of dexels on {} flanks", lines[k], side.name()),
                        format!("ask for at most {} points, or make {spacing} smaller", lines[k]),
                    ));
                }
            }
        }
        Ok(())
    }

    /// What in the scene contradicts itself.
    pub fn contradictions(&self) -> Vec<Notice> {
        // Pairs with an offset do not roll on cones whose apexes meet.
        let mate = self.spec.cones.mate.filter(|_| self.spec.cones.hypoid_offset_mm == 0.0);
        let deg = |rad: f64| format!("{:.4}", rad.to_degrees());
        let of_blank = |contradiction| match contradiction {
            Contradiction::PitchAngle { mate, right_rad } => PitchAngle {
                own_deg: deg(self.blank.pitch_angle_rad),
                teeth: self.blank.teeth,
                mate_teeth: mate.teeth,
                shaft_deg: deg(mate.shaft_angle_rad),
                right_deg: deg(right_rad),
            }
            .notice(),
            Contradiction::WideFace { share } => WideFace { percent: format!("{:.0}", 100.0 * share) }.notice(),
        };
        let mut found: Vec<Notice> = self.blank.contradictions(mate).into_iter().map(of_blank).collect();
        let settings = &self.finishing().settings;
        let off_rad = settings.root_angle_rad - self.blank.root_angle_rad;
        if off_rad.abs() > ROOT_ANGLE_RAD {
            found.push(RootAngle { off_deg: deg(off_rad) }.notice());
        }
        let short_mm = self.depth_missed_mm();
        if short_mm.abs() > DEPTH_MM {
            let way = if short_mm > 0.0 { "too shallow" } else { "too deep" };
            let add_mm = format!("{short_mm:.4}");
            found.push(Depth { short_mm: format!("{:.4}", short_mm.abs()), way, add_mm }.notice());
        }
        found.extend(self.exchanged_blades());
        for operation in &self.operations {
            found.extend(self.beyond_travel(operation));
            let [from, to] = operation.course.range;
            let is_short = from.min(to) > self.needed_rad[0] || from.max(to) < self.needed_rad[1];
            if is_short && !settings.plunges() {
                let [low, high] = self.needed_rad;
                let [from_deg, to_deg, low_deg, high_deg] =
                    [from, to, low, high].map(|rad| format!("{:.3}", rad.to_degrees()));
                let operation = &operation.spec.name;
                found.push(ShortRoll { operation, from_deg, to_deg, low_deg, high_deg }.notice());
            }
        }
        found
    }

    /// Blade angles that would fit the pressure angle far better the other way round.
    fn exchanged_blades(&self) -> Option<Notice> {
        let wanted_rad = self.scene.gear.pressure_angle_rad;
        let [outside, inside] = self.head.blade_angles_rad;
        // On the pitch cone the normal leans by the pressure angle against the cone.
        let actual = |kind: BladeKind| -> Option<f64> {
            let row = self.target[kind.index()].row(0.0).ok()?;
            let point = row.point(row.pitch_share()).ok()?;
            let (sin, cos) = self.blank.pitch_angle_rad.sin_cos();
            let out = cos * point.point_mm.with_x(0.0).normalize() - sin * DVec3::X;
            Some(point.normal.dot(out).abs().asin())
        };
        let off_rad = [actual(BladeKind::Outside)? - wanted_rad, actual(BladeKind::Inside)? - wanted_rad];
        let step_rad = inside - outside;
        let misfit = |[a, b]: [f64; 2]| a.abs() + b.abs();
        let other_way = [off_rad[0] + step_rad, off_rad[1] - step_rad];
        (misfit(other_way) + EXCHANGED_RAD < misfit(off_rad)).then(|| {
            let deg = |rad: f64| format!("{:.2}", rad.to_degrees());
            let comes_out = |off_rad: f64| deg(wanted_rad + off_rad);
            let exchanged = ExchangedBlades {
                concave_deg: comes_out(off_rad[0]),
                convex_deg: comes_out(off_rad[1]),
                inside_deg: deg(inside),
                outside_deg: deg(outside),
                other_concave_deg: comes_out(other_way[0]),
                other_convex_deg: comes_out(other_way[1]),
                wanted_deg: deg(wanted_rad),
            };
            exchanged.notice()
        })
    }

    /// Axes that leave the machine's travel while a slot is rolled.
    fn beyond_travel(&self, operation: &PreparedBevel) -> Vec<Notice> {
        let [from, to] = operation.course.range;
        let positions: Vec<[f64; 4]> = (0..=TRAVEL_STEPS)
            .map(|i| from + (to - from) * f64::from(i) / f64::from(TRAVEL_STEPS))
            .map(|moment| {
                let axes = self.machine.axes_of_cradle(&operation.settings, moment);
                let [x, y, z] = axes.slides_mm.to_array();
                [x, y, z, axes.swing_rad]
            })
            .collect();
        let mut found = Vec::new();
        for (k, axis) in ["X", "Y", "Z", "B"].into_iter().enumerate() {
            let (scale, unit) = if k == 3 { (180.0 / PI, "deg") } else { (1.0, "mm") };
            let reached = positions.iter().map(|position| position[k]);
            let (low, high) =
                (reached.clone().fold(f64::INFINITY, f64::min), reached.fold(f64::NEG_INFINITY, f64::max));
            let [lowest, highest] = self.spec.travel[k];
            if lowest.is_some_and(|end| low < end) || highest.is_some_and(|end| high > end) {
                let end = |end: Option<f64>| end.map_or("no end".to_owned(), |end| format!("{:.3}", scale * end));
                let [low, high] = [low, high].map(|end| format!("{:.3}", scale * end));
                let (operation, from, to) = (&operation.spec.name, end(lowest), end(highest));
                found.push(Travel { operation, axis, low, high, unit, from, to }.notice());
            }
        }
        found
    }

    /// How far the plane of the tips stands short of the blank's roots at the middle of the face, square to the root
    /// cone, mm; positive where the slot is too shallow. The plane cuts deepest along the generatrix in the plane of
    /// the axes.
    pub fn depth_missed_mm(&self) -> f64 {
        self.finishing().settings.short_of_mm(self.blank.mean_root_mm())
    }
}
