//! From an operation to its feed path: where slide, shift and infeed begin, how they run, how long it takes.
//!
//! In: the operation, hob, gear. Out: [`FeedPlan`]. The slide begins where the hob clears the blank and ends where the
//! last contact has left the other face; both follow from the hob's tip cylinder and the length of contact unless the
//! scene gives them. The hob must carry full contact at every moment: it touches the rack's flanks up to h /
//! tan(alpha_t) beside the pitch point, h the larger of both addenda, so its teeth must reach that far along its axis
//! on both sides of the pitch point.
//!
//! A **shift** moves the hob along its own axis and therefore moves no point of that axis against the gear: what spaces
//! the feed marks is the slide alone. Liu et al. 2015 keep v*_z = v_z + v_u sin(g) constant, slide and the shift's
//! component together; a scene may ask for that.

use super::{FeedPath, FeedPhase, HobbingGeometry};
use crate::error::Refusal;
use crate::gear::PitchCurve;
use crate::process::hobbing::Hob;
use crate::process::hobbing::scene::model::{
    Approach, FeedDirection, FeedOf, HobbingKind, HobbingOperation, ShiftStrategy,
};
use crate::scene::model::Gear;

/// Room left between hob and blank before the cut, mm.
const CLEARANCE_MM: f64 = 1.0;
/// More feed phases than this mean a stroke or feed that nobody wants.
const MOST_PHASES: usize = 10_000;

/// A feed path with what it was made from.
#[derive(Debug, Clone, PartialEq)]
pub struct FeedPlan {
    /// The path.
    pub path: FeedPath,
    /// Travel of the slide before the face, mm.
    pub approach_mm: f64,
    /// Travel of the slide beyond the face, mm.
    pub overrun_mm: f64,
    /// Distance from the pitch point, along the hob, that contact needs on both sides, mm.
    pub contact_half_length_mm: f64,
    /// First and last place of the hob's middle along its axis, mm.
    pub shift_range_mm: [f64; 2],
    /// Feed of the slide in the time of one cycle, mm, always positive; first and, where it differs after a reversal of
    /// the shift, second.
    pub slide_feeds_mm: [f64; 2],
    /// Time in which the hob does not cut: idle travel of a repeating shift, s.
    pub idle_s: f64,
    /// Number of shift strokes begun; 1 without a shift.
    pub shift_strokes: u32,
    /// Height of the feed marks, largest, mm: f^2 sin(alpha_n) / (8 R) with f = feed / cos(g) and R the smallest
    /// contact radius of the hob.
    pub feed_mark_mm: f64,
}

/// What a diagonal path has to cover.
struct DiagonalCut {
    /// +1 if the slide feeds along +z.
    direction: f64,
    /// Travel of the slide, mm.
    travel_mm: f64,
    /// How far the hob's middle may stand from the pitch point, mm.
    room_mm: f64,
    /// Whole depth of cut, mm.
    depth_mm: f64,
    /// Tilt of the hob's axis.
    tilt: f64,
    /// Time of one cycle, s.
    cycle_s: f64,
}

/// Feed mark of a cylinder of radius R: f^2 sin(alpha_n) / (8 R), normal to the flank, mm.
pub fn feed_mark_mm(feed_mm: f64, head_angle_rad: f64, pressure_angle_rad: f64, contact_radius_mm: f64) -> f64 {
    (feed_mm / head_angle_rad.cos()).powi(2) * pressure_angle_rad.sin() / (8.0 * contact_radius_mm)
}

impl FeedPlan {
    /// Plan of an operation whose cycle along the pitch curve takes `cycle_s`; `offset_mm` is how far the hob stays
    /// back from full depth, allowances included.
    ///
    /// # Errors
    /// A hob too short for its contact, a shift longer than the hob, a shift that outruns the feed.
    pub fn new(
        operation: &HobbingOperation,
        offset_mm: f64,
        hob: &Hob,
        geometry: &HobbingGeometry,
        gear: &Gear,
        curve: &PitchCurve,
        cycle_s: f64,
    ) -> Result<Self, Refusal> {
        let tilt = geometry.head_angle_rad;
        let gear_addendum_mm = gear.addendum_coefficient * gear.module_mm;
        let depth_mm = hob.tip_radius_mm - hob.pitch_radius_mm + gear_addendum_mm - offset_mm;
        let hob_addendum_mm = hob.tip_radius_mm - hob.pitch_radius_mm;
        let contact_x_mm = hob_addendum_mm.max(gear_addendum_mm) / gear.transverse_pressure_angle_rad().tan();
        let contact_half_length_mm = contact_x_mm / tilt.cos();
        let room_mm = 0.5 * hob.length_mm - contact_half_length_mm;
        if room_mm < 0.0 {
            return Err(Refusal::new(
                "tool.hob.length_mm",
                format!(
                    "a hob {} mm long does not carry the whole contact, which takes {:.3} mm",
                    hob.length_mm,
                    2.0 * contact_half_length_mm
                ),
                "use a longer hob",
            ));
        }
        let (approach_mm, overrun_mm) =
            Self::approach_and_overrun_mm(operation, hob, curve, gear, [depth_mm, gear_addendum_mm], tilt);
        // A left-hand hob's teeth go up through the work (+z of the machine), so that climb feeds down.
        let climb = geometry.hob_hand;
        let direction = match operation.feed_direction {
            FeedDirection::Climb => climb,
            FeedDirection::Conventional => -climb,
        };
        let from_face_mm = 0.5 * gear.face_width_mm;
        let feed_mm = operation.axial_feed_mm_per_revolution;
        let (start_ahead_mm, start_radial_mm, infeed) = match operation.approach {
            Approach::Axial => (approach_mm, offset_mm, None),
            Approach::Radial { feed_mm_per_revolution } => {
                let start_mm = offset_mm + depth_mm + CLEARANCE_MM;
                let rate = feed_mm_per_revolution / cycle_s;
                let phase = FeedPhase {
                    duration_s: (depth_mm + CLEARANCE_MM) / rate,
                    slide_mm_per_s: 0.0,
                    shift_mm_per_s: 0.0,
                    radial_mm_per_s: -rate,
                };
                (overrun_mm, start_mm, Some(phase))
            }
        };
        let start_slide_mm = -direction * (from_face_mm + start_ahead_mm);
        let travel_mm = start_ahead_mm + gear.face_width_mm + overrun_mm;
        let mut plan = Self {
            path: FeedPath {
                start_slide_mm,
                start_shift_mm: 0.0,
                start_radial_mm,
                phases: infeed.into_iter().collect(),
            },
            approach_mm: start_ahead_mm,
            overrun_mm,
            contact_half_length_mm,
            shift_range_mm: [0.0, 0.0],
            slide_feeds_mm: [feed_mm, feed_mm],
            idle_s: 0.0,
            shift_strokes: 1,
            feed_mark_mm: 0.0,
        };
        match operation.kind {
            HobbingKind::Plain { .. } => {
                let place_mm = operation.shift_start_mm.unwrap_or(0.0);
                Self::within(place_mm, [-room_mm, room_mm])?;
                plan.path.start_shift_mm = place_mm;
                plan.shift_range_mm = [place_mm, place_mm];
                let slide_mm_per_s = direction * feed_mm / cycle_s;
                plan.path.phases.push(FeedPhase {
                    duration_s: travel_mm / slide_mm_per_s.abs(),
                    slide_mm_per_s,
                    shift_mm_per_s: 0.0,
                    radial_mm_per_s: 0.0,
                });
            }
            HobbingKind::Diagonal { .. } => {
                let cut = DiagonalCut { direction, travel_mm, room_mm, depth_mm, tilt, cycle_s };
                plan.diagonal(operation, &cut)?;
            }
        }
        let largest_mm = plan.slide_feeds_mm[0].max(plan.slide_feeds_mm[1]);
        let contact_radius_mm = hob.pitch_radius_mm - gear_addendum_mm;
        plan.feed_mark_mm = feed_mark_mm(largest_mm, tilt, gear.pressure_angle_rad, contact_radius_mm);
        Ok(plan)
    }

    /// Travel of the slide before and beyond the faces.
    fn approach_and_overrun_mm(
        operation: &HobbingOperation,
        hob: &Hob,
        curve: &PitchCurve,
        gear: &Gear,
        [depth_mm, gear_addendum_mm]: [f64; 2],
        tilt: f64,
    ) -> (f64, f64) {
        // Half the chord that the tip line cuts from the blank, no longer than the hob or the blank; a flat curve has
        // no chord of its own.
        let facts = curve.facts();
        let flattest = facts.smallest_curvature.curvature_per_mm;
        let outline_mm = if flattest > 0.0 { 1.0 / flattest + gear_addendum_mm } else { f64::INFINITY };
        let chord_mm = (outline_mm.powi(2) - (outline_mm - depth_mm).powi(2)).sqrt();
        let longest_mm = (0.5 * hob.length_mm * tilt.cos()).min(facts.largest_radius_mm + gear_addendum_mm);
        let reach_mm = if chord_mm.is_finite() { chord_mm.min(longest_mm) } else { longest_mm };
        let sink_mm = (hob.tip_radius_mm.powi(2) - (hob.tip_radius_mm - depth_mm).powi(2)).max(0.0).sqrt();
        let approach = sink_mm / tilt.cos() + reach_mm * tilt.tan().abs() + CLEARANCE_MM;
        // Hob and flank touch on the normal through the pitch point, which leans along the gear's axis: h sin(beta) /
        // tan(alpha_n) at the height h. Each tooth's last pass comes up to one feed before the end, and cuts half a
        // feed to either side.
        let highest_mm = gear_addendum_mm.max(hob.tip_radius_mm - hob.pitch_radius_mm);
        let lean_mm = highest_mm * gear.helix_angle_rad.sin() / gear.pressure_angle_rad.tan();
        let overrun = lean_mm + 0.5 * operation.axial_feed_mm_per_revolution + CLEARANCE_MM;
        (operation.approach_mm.unwrap_or(approach), operation.overrun_mm.unwrap_or(overrun))
    }

    fn within(place_mm: f64, [low_mm, high_mm]: [f64; 2]) -> Result<(), Refusal> {
        if (low_mm..=high_mm).contains(&place_mm) {
            return Ok(());
        }
        Err(Refusal::new(
            "operation.shift_start_mm",
            format!("with its middle at {place_mm} mm the hob does not carry the whole contact"),
            format!("set it between {low_mm:.3} and {high_mm:.3} mm, or use a longer hob"),
        ))
    }

    fn diagonal(&mut self, operation: &HobbingOperation, cut: &DiagonalCut) -> Result<(), Refusal> {
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
        self.shift_range_mm = range;
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
            place_mm += toward * shift_rate * duration_s;
            if left_mm <= 1e-9 {
                break;
            }
            match strategy {
                ShiftStrategy::OneWay => {
                    let needed_mm = travel_mm / (slide_mm_per_s.abs() * cycle_s) * shift_mm_per_revolution;
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

#[cfg(test)]
mod tests {
    use crate::process;
    use crate::process::hobbing::HobbingJob;
    use std::path::Path;

    fn job(file: &str, settings: &[&str]) -> crate::Result<HobbingJob> {
        let settings: Vec<String> = settings.iter().map(|&s| format!("operation.finish.{s}")).collect();
        HobbingJob::new(&process::load(Path::new(&format!("scenes/hobbing/{file}.toml")), &settings)?.scene)
    }

    fn diagonal(settings: &[&str]) -> crate::Result<HobbingJob> {
        job("third_order_diagonal", settings)
    }

    /// Key and problem of a refusal.
    fn refused(result: crate::Result<HobbingJob>) -> (String, String) {
        match result {
            Err(crate::Error::Refused(refusal)) => (refusal.key, refusal.problem),
            other => panic!("not refused: {other:?}"),
        }
    }

    #[test]
    fn the_slide_crosses_the_face_and_the_shift_stays_on_the_hob() {
        for strategy in ["reciprocating", "repeating"] {
            let strategy = format!("linkage.hobbing_diagonal.strategy={strategy}");
            let job = diagonal(&[&strategy]).unwrap();
            let operation = job.finishing();
            let (plan, linkage) = (&operation.plan, &operation.linkage);
            let [low, high] = plan.shift_range_mm;
            assert!((high + plan.contact_half_length_mm - 0.5 * job.hob.length_mm).abs() < 1e-9);
            let (start, end) = (linkage.axes::<1>(0.0), linkage.axes::<1>(linkage.end_s()));
            // A left-hand hob climbs downwards, from above the face to below it.
            assert!((start.slide_mm.value() - 25.0 - plan.approach_mm).abs() < 1e-9);
            assert!((end.slide_mm.value() + 25.0 + plan.overrun_mm).abs() < 1e-6, "{}", end.slide_mm.value());
            let (mut least, mut most, mut idle_s) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
            let steps = 20_000;
            for i in 0..=steps {
                let axes = linkage.axes::<2>(linkage.end_s() * f64::from(i) / f64::from(steps));
                (least, most) = (axes.shift_mm.value().min(least), axes.shift_mm.value().max(most));
                if axes.slide_mm.derivative(1) == 0.0 {
                    idle_s += linkage.end_s() / f64::from(steps);
                }
            }
            assert!(least > low - 1e-6 && most < high + 1e-6 && most - least > 0.99 * (high - low));
            assert!((idle_s - plan.idle_s).abs() < 0.3, "{idle_s} {}", plan.idle_s);
            assert_eq!(plan.idle_s > 0.0, strategy.ends_with("repeating"));
        }
    }

    #[test]
    fn the_papers_feeds_follow_from_their_resultant() {
        // Liu et al. 2015, Table 1, with the shift that belongs to it: v_z for v*_z = -50 / 300 mm/s.
        for (direction, hand, expected) in [
            ("adds", "left", 0.22976615123458155),
            ("adds", "right", 0.046693835497048974),
            ("subtracts", "left", 0.10356718209875178),
            ("subtracts", "right", 0.28663949783628434),
        ] {
            let settings = [
                format!("operation.finish.linkage.hobbing_diagonal.shift_direction={direction}"),
                "operation.finish.linkage.hobbing_diagonal.feed_of=resultant".to_owned(),
                format!("gear.hand={hand}"),
            ];
            let scene = process::load(Path::new("scenes/hobbing/third_order_diagonal.toml"), &settings).unwrap().scene;
            let job = HobbingJob::new(&scene).unwrap();
            // The scene's feeds are per revolution of nearly 15 s.
            let found = job.finishing().plan.slide_feeds_mm[0] / 15.0;
            assert!((found - expected).abs() < 1e-9, "{direction} {hand}: {found}");
        }
    }

    #[test]
    fn shifts_and_hobs_that_do_not_fit_are_refused() {
        let (key, problem) = refused(diagonal(&[
            "linkage.hobbing_diagonal.strategy=one_way",
            "linkage.hobbing_diagonal.shift_mm_per_revolution=75",
        ]));
        assert!(key.ends_with("strategy") && problem.contains("mm of shift"), "{problem}");
        let (key, _) = refused(diagonal(&["linkage.hobbing_diagonal.stroke_mm=90"]));
        assert!(key.ends_with("stroke_mm"));
        let (key, _) = refused(diagonal(&["shift_start_mm=60"]));
        assert!(key.ends_with("shift_start_mm"));
        let (key, _) = refused(diagonal(&[
            "linkage.hobbing_diagonal.feed_of=resultant",
            "linkage.hobbing_diagonal.shift_mm_per_revolution=75",
        ]));
        assert!(key.ends_with("shift_mm_per_revolution"));
        let short =
            process::load(Path::new("scenes/hobbing/third_order_plain.toml"), &["tool.hob.length_mm=40".to_owned()]);
        let (key, problem) = refused(HobbingJob::new(&short.unwrap().scene));
        assert!(key == "tool.hob.length_mm" && problem.contains("whole contact"), "{problem}");
    }

    #[test]
    fn hollow_curves_are_refused_and_say_why() {
        let settings = ["gear.pitch_curve.ellipse.eccentricity=0.2".to_owned()];
        let scene = process::load(Path::new("scenes/hobbing/third_order_plain.toml"), &settings).unwrap().scene;
        let (key, problem) = refused(HobbingJob::new(&scene));
        assert!(key == "gear.pitch_curve" && problem.contains("straight line"), "{problem}");
        // The limit of convexity, 1 / (n^2 - 1), is not refused.
        let settings = ["gear.pitch_curve.ellipse.eccentricity=0.125".to_owned()];
        let scene = process::load(Path::new("scenes/hobbing/third_order_plain.toml"), &settings).unwrap().scene;
        HobbingJob::new(&scene).unwrap();
    }

    #[test]
    fn two_cuts_keep_the_phase_and_conventional_turns_the_feed() {
        let job = job("circular_helical", &[]).unwrap();
        let [rough, finish] = job.operations.as_slice() else { panic!("two operations") };
        assert!((rough.offset_mm * 20_f64.to_radians().sin() - 0.15).abs() < 1e-12);
        let slide = |o: &process::hobbing::job::PreparedHobbing| o.linkage.axes::<2>(o.linkage.end_s()).slide_mm;
        // Right-hand hob: climb feeds up, conventional down.
        assert!(slide(rough).derivative(1) > 0.0 && slide(finish).derivative(1) < 0.0);
        let start = rough.linkage.axes::<1>(0.0).radial_mm.value();
        assert!(
            start > 6.0
                && (rough.linkage.axes::<1>(rough.linkage.end_s()).radial_mm.value() - rough.offset_mm).abs() < 1e-9
        );
    }
}
