//! A program under test against the scene's own strokes: how far it lies off them, which strokes it leaves out or makes
//! twice, and how fast the ram runs.
//!
//! In: the program and the schedule of its operation. Out: [`Judgement`]. Law: a stroke of the program is the stroke of
//! the schedule that it lies nearest to, if it lies nearer to it than a quarter of the way to its neighbours or than
//! the contour error that is asked for; a stroke of the schedule that no stroke of the program is, is missing. Strokes
//! are thus counted one by one, however many of them follow each other, until the ram stops. Between two strokes the
//! axes go straight ([`super::between`]).
//!
//! Road not taken: what each stroke removes from the blank. It needs no schedule, but five missing strokes in a row
//! leave one large chip, and few strokes on few teeth leave chips that differ as if one were missing between them.

use super::program::{AxisProgram, Knot};
use super::retracting::DrawnBack;
use crate::process::shaping::linkage::StrokeSchedule;
use crate::process::shaping::motion::returns::RetractionPlan;
use crate::process::shaping::motion::returns::motion::RamTimes;

/// A stroke is one of the schedule's within this share of the way to its neighbours.
const NEAR_SHARE: f64 = 0.25;
/// Speeds of the ram that differ by less than this share are the same: programs are written with nine digits.
const SAME_SPEED: f64 = 1e-6;

/// Programs are written with six decimals of a millimetre: what lies this little off is not told apart, mm.
const LAST_DIGIT_MM: f64 = 1e-6;

/// A program against the scene's own strokes.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// Largest distance of the cutter's edge in the work, mm.
    pub distance_mm: f64,
    /// Stroke coordinate that has it.
    pub distance_at: f64,
    /// The largest between two strokes, from the straight way from the one to the other ([`super::between`]), mm.
    pub between_mm: f64,
    /// Stroke coordinate that has it.
    pub between_at: f64,
    /// How far the cutter is drawn back while the ram returns, where the axes do that.
    pub back: Option<DrawnBack>,
    /// Strokes of the schedule that the program does not make.
    pub missing: Vec<usize>,
    /// Strokes of the program that repeat one that it has made.
    pub doubled: Vec<usize>,
    /// Strokes of the program that are none of the schedule's.
    pub off: Vec<usize>,
    /// Double strokes per minute of the program and of the scene.
    pub strokes_per_minute: [f64; 2],
}

impl Judgement {
    /// Whether it lies further off than what a program may: the gear is then another one than the scene's strokes make.
    pub fn is_off(&self, asked_mm: f64) -> bool {
        self.distance_mm > asked_mm + LAST_DIGIT_MM
    }

    /// The drawing back, where it falls short of what the scene asks by more than a program may be off.
    pub fn falls_short(&self, asked_mm: f64) -> Option<DrawnBack> {
        self.back.filter(|back| back.short_mm > asked_mm + LAST_DIGIT_MM)
    }

    /// Whether the ram runs at another speed than the scene says.
    pub fn is_at_another_speed(&self) -> bool {
        let [program, scene] = self.strokes_per_minute;
        differ(program, scene)
    }
}

fn differ(one_per_minute: f64, other_per_minute: f64) -> bool {
    (one_per_minute / other_per_minute - 1.0).abs() > SAME_SPEED
}

impl AxisProgram {
    /// Whether its ram runs at another speed than the scene says.
    pub fn is_at_another_speed(&self, asked_per_minute: f64) -> bool {
        differ(self.double_strokes_per_minute, asked_per_minute)
    }

    /// The program against a schedule; `back` where its axes draw the cutter back: it is then compared over the whole
    /// way of the ram, there and back.
    /// `contour_error_mm` is what a program may be off, `asked_per_minute` the scene's double strokes.
    pub fn judged(
        &self,
        schedule: &StrokeSchedule,
        tip_radius_mm: f64,
        back: Option<(&RamTimes, &RetractionPlan)>,
        contour_error_mm: f64,
        asked_per_minute: f64,
        continuous: bool,
    ) -> Judgement {
        let (distance_mm, distance_at) = match back {
            Some((ram, _)) => self.cut_error_mm(schedule, tip_radius_mm, ram, continuous),
            None => self.contour_error_mm(schedule, tip_radius_mm, continuous),
        };
        let (between_mm, between_at) = self.between_mm(schedule, tip_radius_mm, back.map(|(_, plan)| plan));
        let drawn_back = |(ram, plan)| self.drawn_back(schedule, tip_radius_mm, ram, plan, continuous);
        let gear = schedule.linkage().gear();
        let strokes: Vec<Knot> = (0..schedule.count()).map(|stroke| Knot::of(schedule, stroke as f64)).collect();
        let apart_mm = |a: &Knot, b: &Knot| a.displacement_mm(b, gear, tip_radius_mm);
        // How near a stroke has to be taken for it.
        let near_mm = |stroke: usize| {
            let beside = [stroke.checked_sub(1), Some(stroke + 1)].into_iter().flatten();
            let ways = beside.filter_map(|other| strokes.get(other)).map(|other| apart_mm(&strokes[stroke], other));
            (NEAR_SHARE * ways.fold(f64::INFINITY, f64::min)).max(contour_error_mm)
        };
        let mut made = vec![false; strokes.len()];
        let (mut doubled, mut off) = (Vec::new(), Vec::new());
        let mut next = 0;
        for stroke in 0..self.count() {
            let knot = self.at(stroke as f64);
            // The work turns one way: its angle says where to look, the strokes of a plunge are told by their order.
            let by_angle = strokes.partition_point(|other| other.psi_c_rad < knot.psi_c_rad);
            let around = by_angle.saturating_sub(1)..(by_angle + 2);
            let candidates = around.chain([next, stroke]).filter(|&other| other < strokes.len());
            let nearest = candidates.map(|other| (other, apart_mm(&knot, &strokes[other])));
            match nearest.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|&(other, mm)| mm <= near_mm(other)) {
                Some((other, _)) if made[other] => doubled.push(stroke),
                Some((other, _)) => {
                    made[other] = true;
                    next = other + 1;
                }
                None => off.push(stroke),
            }
        }
        let missing = (0..made.len()).filter(|&stroke| !made[stroke]).collect();
        let strokes_per_minute = [self.double_strokes_per_minute, asked_per_minute];
        Judgement {
            distance_mm,
            distance_at,
            between_mm,
            between_at,
            back: back.map(drawn_back),
            missing,
            doubled,
            off,
            strokes_per_minute,
        }
    }
}
