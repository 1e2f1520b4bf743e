//! The feed path of diagonal hobbing: strokes of the shift while the slide feeds.
//!
//! In: the operation and what the path has to cover ([`DiagonalCut`]). Out: the plan's path with its shift, feeds and
//! idle travel. What a shift does to the feed stands with the plan.

use super::{CLEARANCE_MM, FeedPlan};
use crate::process::hobbing::linkage::FeedPhase;
use crate::process::hobbing::scene::model::{FeedOf, HobbingKind, HobbingOperation, ShiftStrategy};
use gearcut_core::error::Refusal;

/// More feed phases than this mean a stroke or feed that nobody wants.
const MOST_PHASES: usize = 10_000;

/// What a diagonal path has to cover.
pub(super) struct DiagonalCut {
    /// +1 if the slide feeds along +z.
    pub direction: f64,
    /// Travel of the slide, mm.
    pub travel_mm: f64,
    /// How far the hob's middle may stand from the pitch point, mm.
    pub room_mm: f64,
    /// Whole depth of cut, mm.
    pub depth_mm: f64,
    /// Tilt of the hob's axis.
    pub tilt: f64,
    /// Time of one cycle, s.
    pub cycle_s: f64,
}

impl FeedPlan {
    /// Puts the path of a diagonal operation into the plan.
    pub(super) fn diagonal(&mut self, operation: &HobbingOperation, cut: &DiagonalCut) -> Result<(), Refusal> {
        let DiagonalCut { direction, travel_mm, room_mm, depth_mm, tilt, cycle_s } = *cut;
        let HobbingKind::Diagonal { shift_mm_per_revolution, direction: first, strategy, stroke_mm, feed_of, .. } =
            operation.kind
        else {
            return Ok(());
        };
        let stroke_mm = stroke_mm.unwrap_or(2.0 * room_mm);
        if stroke_mm > 2.0 * room_mm + 1e-9 {
            return Err(Refusal::new(
                "operation.linkage.hobbing_diagonal.stroke_mm",
                format!("{stroke_mm} mm are more than the {:.3} mm of hob that carry full contact", 2.0 * room_mm),
                "leave stroke_mm out, or use a longer hob",
            ));
        }
        let range = [-0.5 * stroke_mm, 0.5 * stroke_mm];
        let shift_rate = shift_mm_per_revolution / cycle_s;
        // The shift adds to the rolling when the hob moves against d0, as its thread does.
        let mut toward = -first.sign();
        let mut place_mm = operation.shift_start_mm.unwrap_or(-toward * 0.5 * stroke_mm);
        Self::within(place_mm, range)?;
        let resultant = direction * operation.axial_feed_mm_per_revolution / cycle_s;
        let slide_rate = |toward: f64| match feed_of {
            FeedOf::Slide => resultant,
            FeedOf::Resultant => resultant - toward * shift_rate * tilt.sin(),
        };
        let used = if strategy == ShiftStrategy::Reciprocating { vec![toward, -toward] } else { vec![toward] };
        if used.iter().any(|&toward| slide_rate(toward) * direction <= 0.0) {
            return Err(Refusal::new(
                "operation.linkage.hobbing_diagonal.shift_mm_per_revolution",
                format!(
                    "the shift alone moves {:.3} mm along the gear's axis per revolution, more than the resulting feed \
                    of {} mm: the slide would have to go back",
                    shift_mm_per_revolution * tilt.sin().abs(),
                    operation.axial_feed_mm_per_revolution
                ),
                "use less shift, or feed_of = \"slide\"",
            ));
        }
        self.slide_feeds_mm =
            [slide_rate(toward).abs() * cycle_s, slide_rate(*used.last().unwrap_or(&toward)).abs() * cycle_s];
        self.path.start_shift_mm = place_mm;
        self.shift_range_mm = [place_mm; 2];
        let mut left_mm = travel_mm;
        while left_mm > 1e-9 {
            let shift_left_mm = if toward > 0.0 { range[1] - place_mm } else { place_mm - range[0] };
            let slide_mm_per_s = slide_rate(toward);
            let duration_s = (shift_left_mm / shift_rate).min(left_mm / slide_mm_per_s.abs());
            self.path.phases.push(FeedPhase {
                duration_s,
                slide_mm_per_s,
                shift_mm_per_s: toward * shift_rate,
                radial_mm_per_s: 0.0,
            });
            left_mm -= slide_mm_per_s.abs() * duration_s;
            let from_mm = place_mm;
            place_mm += toward * shift_rate * duration_s;
            let [low_mm, high_mm] = self.shift_range_mm;
            self.shift_range_mm = [low_mm.min(from_mm.min(place_mm)), high_mm.max(from_mm.max(place_mm))];
            if left_mm <= 1e-9 {
                break;
            }
            match strategy {
                ShiftStrategy::OneWay => {
                    let needed_mm = travel_mm / (slide_mm_per_s.abs() * cycle_s) * shift_mm_per_revolution;
                    // Where the scene says where the shift begins, part of the stroke lies behind.
                    if let Some(start_mm) = operation.shift_start_mm.filter(|_| needed_mm <= stroke_mm) {
                        let ahead_mm = 0.5 * stroke_mm - toward * start_mm;
                        let problem = format!(
                            "the cut takes {needed_mm:.1} mm of shift, and from {start_mm} mm on the hob has \
                             {ahead_mm:.1} mm with full contact"
                        );
                        let way_out = format!(
                            "leave it out, or write {} {:.1}",
                            if toward > 0.0 { "at most" } else { "at least" },
                            toward * (0.5 * stroke_mm - needed_mm)
                        );
                        return Err(Refusal::new("operation.shift_start_mm", problem, way_out));
                    }
                    return Err(Refusal::new(
                        "operation.linkage.hobbing_diagonal.strategy",
                        format!(
                            "the cut takes {needed_mm:.1} mm of shift, the hob has {stroke_mm:.1} mm with full contact"
                        ),
                        "use strategy = \"reciprocating\" or \"repeating\", less shift_mm_per_revolution, or a longer \
                        hob",
                    ));
                }
                ShiftStrategy::Reciprocating => toward = -toward,
                ShiftStrategy::Repeating { return_mm_per_s } => {
                    let lift_mm = depth_mm + CLEARANCE_MM;
                    let idle = |shift: f64, radial: f64, travel_mm: f64| FeedPhase {
                        duration_s: travel_mm / return_mm_per_s,
                        slide_mm_per_s: 0.0,
                        shift_mm_per_s: shift * return_mm_per_s,
                        radial_mm_per_s: radial * return_mm_per_s,
                    };
                    let phases = [idle(0.0, 1.0, lift_mm), idle(-toward, 0.0, stroke_mm), idle(0.0, -1.0, lift_mm)];
                    self.idle_s += phases.iter().map(|phase| phase.duration_s).sum::<f64>();
                    self.path.phases.extend(phases);
                    place_mm = -toward * 0.5 * stroke_mm;
                }
            }
            self.shift_strokes += 1;
            if self.path.phases.len() > MOST_PHASES {
                return Err(Refusal::new(
                    "operation.linkage.hobbing_diagonal.shift_mm_per_revolution",
                    format!("the shift would turn more than {MOST_PHASES} times"),
                    "use less shift or a longer stroke",
                ));
            }
        }
        Ok(())
    }
}
