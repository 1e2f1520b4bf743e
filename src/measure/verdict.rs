//! What an inspector says of a gear: every figure of both flanks, its limit, pass or fail.
//!
//! In: inspected flanks and gear, what the scene holds them against, the sizes of a round gear. Out: [`GearVerdict`].
//!
//! The value of a figure is that of the worst tooth. Deviations of profile and helix are taken along the flank's normal
//! in space, those of the standard in the transverse section, so limits of a round helical gear are multiplied by
//! cos(beta_b), and its classes asked for with values divided by it: one number stands for a deviation everywhere. A
//! limit of the drawing goes before that of the class.

use super::deviation::{PitchDeviations, Runout, TraceDeviation};
use super::flank_tolerance::{InspectionFigure, ToleranceSizes};
use super::inspection::{GearInspection, InspectedFlank};
use super::round_gear::RoundGear;
use crate::scene::model::{DrawnLimits, Measure};
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// A figure of a flank side, or of the whole gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SideFigure {
    /// None for runout, which both sides make.
    pub side: Option<Side>,
    /// Of the worst tooth, um, with its sign.
    pub value_um: f64,
    /// That tooth, from 1; none where the figure is one of all teeth.
    pub tooth: Option<u32>,
}

/// Where a limit comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LimitSource {
    /// The drawing.
    Drawing,
    /// A class of ISO 1328-1:2013.
    Class(u32),
}

impl LimitSource {
    /// In words.
    pub fn words(self) -> String {
        match self {
            Self::Drawing => "drawing".to_owned(),
            Self::Class(class) => format!("ISO 1328-1:2013 class {class}"),
        }
    }
}

/// A figure against its limit.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedFigure {
    /// Which.
    pub figure: InspectionFigure,
    /// Left and right, or one for both; empty where it was not measured.
    pub sides: Vec<SideFigure>,
    /// Limit of its magnitude, um, and whence.
    pub limit: Option<(f64, LimitSource)>,
    /// Whether it was measured on all flanks: else the worst one is not known.
    pub is_complete: bool,
    /// Finest class that allows the worst value: none beyond class 11. Outer none: no class is defined, or flanks were
    /// not measured.
    pub class: Option<ClassReached>,
}

/// The finest class that allows a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ClassReached {
    /// A class.
    Class(u32),
    /// No class does.
    Beyond,
}

impl JudgedFigure {
    /// The side with the largest magnitude.
    pub fn worst(&self) -> Option<&SideFigure> {
        self.sides.iter().reduce(|best, next| if next.value_um.abs() > best.value_um.abs() { next } else { best })
    }

    /// Whether the limit is kept; none where there is no limit, and where a flank that was not measured may pass it.
    pub fn passes(&self) -> Option<bool> {
        let is_kept = self.worst()?.value_um.abs() <= self.limit?.0;
        (self.is_complete || !is_kept).then_some(is_kept)
    }
}

fn sizes(round: &RoundGear) -> ToleranceSizes {
    ToleranceSizes {
        teeth: round.teeth,
        reference_diameter_mm: round.reference_diameter_mm(),
        normal_module_mm: round.normal_module_mm,
        face_width_mm: round.face_width_mm,
        helix_angle_rad: round.helix_angle_rad,
    }
}

/// Why ISO 1328-1 gives no classes to a gear with these sizes, none where it is not round; none where it does.
pub fn no_class(round: Option<&RoundGear>) -> Option<String> {
    match round.map(sizes) {
        None => Some(
            "the classes of ISO 1328-1 are for round gears of involutes whose flanks reach the pitch circle".to_owned(),
        ),
        Some(sizes) => sizes.beyond(),
    }
}

/// All figures of a gear.
#[derive(Debug, Clone, PartialEq)]
pub struct GearVerdict {
    /// In the order of [`InspectionFigure::ALL`].
    pub figures: Vec<JudgedFigure>,
    /// Why there are no classes; none where there are.
    pub no_class: Option<String>,
}

impl GearVerdict {
    /// Of a gear; `round` are its sizes if it is round.
    pub fn new<Own>(
        flanks: &[InspectedFlank<Own>],
        gear: &GearInspection,
        measure: &Measure,
        round: Option<&RoundGear>,
    ) -> Self {
        let sizes = round.map(sizes);
        let judged = |figure: InspectionFigure| {
            // Normal over transverse deviations.
            let normal = match round {
                Some(round) if figure.is_along_normal() => round.base_helix_cosine(),
                _ => 1.0,
            };
            let of_class = measure
                .iso_1328_class
                .and_then(|class| Some((sizes?.tolerance_um(figure, class).ok()?, LimitSource::Class(class))));
            let drawn = drawn_um(&measure.limits, figure).map(|um| (um, LimitSource::Drawing));
            let limit = drawn.or(of_class).map(|(um, source)| (um * normal, source));
            let (sides, is_complete) = (sides(flanks, gear, figure), is_complete(flanks, figure));
            let mut judged = JudgedFigure { figure, sides, limit, is_complete, class: None };
            judged.class = judged.worst().filter(|_| is_complete).and_then(|worst| {
                let class = sizes?.class_of(figure, worst.value_um / normal).ok()?;
                Some(class.map_or(ClassReached::Beyond, ClassReached::Class))
            });
            judged
        };
        Self { figures: InspectionFigure::ALL.into_iter().map(judged).collect(), no_class: no_class(round) }
    }

    /// One of them.
    pub fn of(&self, figure: InspectionFigure) -> &JudgedFigure {
        self.figures.iter().find(|judged| judged.figure == figure).expect("all figures are judged")
    }

    /// The coarsest class that any figure needs: the class of the gear, as long as all figures were measured.
    pub fn class(&self) -> Option<ClassReached> {
        self.figures.iter().map(|judged| judged.class).collect::<Option<Vec<_>>>()?.into_iter().max()
    }

    /// Figures beyond their limit.
    pub fn failed(&self) -> impl Iterator<Item = &JudgedFigure> {
        self.figures.iter().filter(|judged| judged.passes() == Some(false))
    }

    /// Whether all limits are kept; none where none was given, or where a limited figure was not measured.
    pub fn passes(&self) -> Option<bool> {
        if self.failed().next().is_some() {
            return Some(false);
        }
        let mut limited = self.figures.iter().filter(|judged| judged.limit.is_some()).peekable();
        limited.peek()?;
        limited.all(|judged| judged.passes().is_some()).then_some(true)
    }
}

fn drawn_um(limits: &DrawnLimits, figure: InspectionFigure) -> Option<f64> {
    match figure {
        InspectionFigure::SinglePitch => limits.single_pitch_um,
        InspectionFigure::TotalPitch => limits.total_pitch_um,
        InspectionFigure::ProfileTotal => limits.profile_total_um,
        InspectionFigure::ProfileForm => limits.profile_form_um,
        InspectionFigure::ProfileSlope => limits.profile_slope_um,
        InspectionFigure::HelixTotal => limits.helix_total_um,
        InspectionFigure::HelixForm => limits.helix_form_um,
        InspectionFigure::HelixSlope => limits.helix_slope_um,
        InspectionFigure::Runout => limits.runout_um,
    }
}

/// Whether every flank has a figure of its trace; pitch and runout are measured on all teeth or not at all.
fn is_complete<Own>(flanks: &[InspectedFlank<Own>], figure: InspectionFigure) -> bool {
    use InspectionFigure as Of;
    flanks.iter().all(|flank| match figure {
        Of::ProfileTotal | Of::ProfileForm | Of::ProfileSlope => flank.profile.is_some(),
        Of::HelixTotal | Of::HelixForm | Of::HelixSlope => flank.lead.is_some(),
        Of::SinglePitch | Of::TotalPitch | Of::Runout => true,
    })
}

/// A figure of both sides.
fn sides<Own>(flanks: &[InspectedFlank<Own>], gear: &GearInspection, figure: InspectionFigure) -> Vec<SideFigure> {
    type Pick = fn(&TraceDeviation) -> f64;
    let traced = |is_profile: bool, pick: Pick| -> Vec<SideFigure> {
        let of = |side: Side| {
            let flanks = flanks.iter().filter(|flank| flank.side == side);
            let values = flanks.filter_map(|flank| {
                let deviation = if is_profile { flank.profile } else { flank.lead };
                Some((pick(&deviation?), flank.tooth))
            });
            let worst = values.reduce(|best, next| if next.0.abs() > best.0.abs() { next } else { best });
            worst.map(|(mm, tooth)| SideFigure { side: Some(side), value_um: UM_PER_MM * mm, tooth: Some(tooth) })
        };
        [Side::Left, Side::Right].into_iter().filter_map(of).collect()
    };
    let pitch = |value: fn(&PitchDeviations) -> (f64, Option<u32>)| -> Vec<SideFigure> {
        let of = |(side, pitch): (Side, &Option<PitchDeviations>)| {
            let (mm, tooth) = value(pitch.as_ref()?);
            Some(SideFigure { side: Some(side), value_um: UM_PER_MM * mm, tooth })
        };
        [Side::Left, Side::Right].into_iter().zip(&gear.pitch).filter_map(of).collect()
    };
    match figure {
        InspectionFigure::SinglePitch => pitch(|pitch| {
            let numbered = (1_u32..).zip(&pitch.single_mm);
            let worst = numbered.reduce(|best, next| if next.1.abs() > best.1.abs() { next } else { best });
            worst.map_or((0.0, None), |(tooth, mm)| (*mm, Some(tooth)))
        }),
        InspectionFigure::TotalPitch => pitch(|pitch| (pitch.total_mm(), None)),
        InspectionFigure::ProfileTotal => traced(true, |d| d.total_mm),
        InspectionFigure::ProfileForm => traced(true, |d| d.form_mm),
        InspectionFigure::ProfileSlope => traced(true, |d| d.slope_mm),
        InspectionFigure::HelixTotal => traced(false, |d| d.total_mm),
        InspectionFigure::HelixForm => traced(false, |d| d.form_mm),
        InspectionFigure::HelixSlope => traced(false, |d| d.slope_mm),
        InspectionFigure::Runout => {
            let runout = gear.runout.as_ref().map(Runout::total_mm);
            let figure = |mm: f64| SideFigure { side: None, value_um: UM_PER_MM * mm, tooth: None };
            runout.map(figure).into_iter().collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::deviation::Trace;
    use crate::measure::inspection::TracedLines;
    use gearcut_core::gear::GearKind;

    /// A flank whose profile rises by `slope_um` over its length and whose helix is straight.
    fn flank(tooth: u32, side: Side, slope_um: f64) -> InspectedFlank<()> {
        let places_mm: Vec<f64> = (0..=10).map(f64::from).collect();
        let heights = |slope_mm: f64| places_mm.iter().map(|place| slope_mm * place / 10.0).collect();
        let profile_trace = Trace { places_mm: places_mm.clone(), heights_mm: heights(1e-3 * slope_um) };
        let lead_trace = Trace { places_mm: places_mm.clone(), heights_mm: heights(0.0) };
        InspectedFlank {
            tooth,
            side,
            length_mm: 10.0,
            evaluated_mm: [0.0, 10.0],
            profile: profile_trace.deviation([0.0, 10.0]),
            lead: lead_trace.deviation([0.0, 10.0]),
            lines: TracedLines { arcs_mm: places_mm, profile_v_mm: 0.0, lead_arc_mm: 5.0 },
            profile_trace,
            lead_trace,
            untouched: 0,
            own: (),
        }
    }

    fn round(helix_angle_rad: f64) -> RoundGear {
        RoundGear {
            kind: GearKind::External,
            teeth: 24,
            normal_module_mm: 3.0,
            normal_pressure_angle_rad: 20_f64.to_radians(),
            helix_angle_rad,
            face_width_mm: 20.0,
            addendum_coefficient: 1.0,
            profile_shift_coefficient: 0.0,
            tip_diameter_mm: 78.0,
            root_diameter_mm: 64.5,
            form_diameter_mm: 68.0,
            tip_form_diameter_mm: 78.0,
            thickness_mm: 4.712,
        }
    }

    /// The gear of the tolerances' own test: class 5 allows f_H_alpha 5.5, F_alpha 8.5, f_p 6.5 um.
    #[test]
    fn a_gear_is_held_against_its_class_and_its_drawing() {
        let flanks = [flank(1, Side::Left, 5.0), flank(2, Side::Left, -5.2), flank(1, Side::Right, 1.0)];
        let pitch = |single_mm: Vec<f64>| {
            let mut sum = 0.0;
            let cumulative_mm = single_mm.iter().map(|f| (sum += f, sum).1).collect();
            Some(PitchDeviations { single_mm, cumulative_mm })
        };
        let gear = GearInspection {
            pitch: [pitch(vec![0.001, -0.007, 0.006]), pitch(vec![0.0; 3])],
            runout: Some(Runout { radial_mm: vec![-0.004, 0.005] }),
            thickness: Vec::new(),
        };
        let mut measure = Measure { iso_1328_class: Some(5), ..Measure::default() };
        let verdict = GearVerdict::new(&flanks, &gear, &measure, Some(&round(0.0)));
        let slope = verdict.of(InspectionFigure::ProfileSlope);
        let worst = slope.worst().expect("measured");
        assert!((worst.value_um + 5.2).abs() < 1e-9 && worst.tooth == Some(2), "{worst:?}");
        assert_eq!((slope.limit, slope.passes()), (Some((5.5, LimitSource::Class(5))), Some(true)));
        let failed: Vec<InspectionFigure> = verdict.failed().map(|judged| judged.figure).collect();
        assert_eq!(failed, [InspectionFigure::SinglePitch], "7 um for 6.5");
        assert_eq!((verdict.passes(), verdict.class()), (Some(false), Some(ClassReached::Class(6))));
        measure.limits.single_pitch_um = Some(8.0);
        let verdict = GearVerdict::new(&flanks, &gear, &measure, Some(&round(0.0)));
        assert_eq!(verdict.of(InspectionFigure::SinglePitch).limit, Some((8.0, LimitSource::Drawing)));
        assert_eq!(verdict.passes(), Some(true), "the drawing allows 8 um");
        // A gear that is not round has no class, and its drawing's limits alone.
        let other = GearVerdict::new(&flanks, &gear, &measure, None);
        assert!(other.no_class.is_some() && other.class().is_none());
        assert_eq!((other.of(InspectionFigure::ProfileSlope).limit, other.passes()), (None, Some(true)));
        // A flank that was cut away may be worse than those that are left.
        let mut lost = [flank(1, Side::Left, 5.0), flank(2, Side::Left, 0.0)];
        lost[1].profile = None;
        let judge = |limit_um: f64| {
            let limits = DrawnLimits { profile_slope_um: Some(limit_um), ..DrawnLimits::default() };
            let measure = Measure { limits, ..Measure::default() };
            let verdict = GearVerdict::new(&lost, &gear, &measure, Some(&round(0.0)));
            let slope = verdict.of(InspectionFigure::ProfileSlope);
            (slope.passes(), slope.class)
        };
        assert_eq!(judge(6.0), (None, None), "5 um of 6 on one of two flanks");
        assert_eq!(judge(4.0), (Some(false), None));
        // Nothing measured, nothing passed.
        let nothing = GearInspection { pitch: [None, None], runout: None, thickness: Vec::new() };
        assert_eq!(GearVerdict::new(&flanks, &nothing, &measure, None).passes(), None);
    }

    /// cos(beta_b) of 30 deg and 20 deg is 0.8828: sin(beta_b) = sin(beta) cos(alpha_n).
    #[test]
    fn limits_of_helical_gears_are_turned_into_the_normal() {
        let beta = 30_f64.to_radians();
        let flanks = [flank(1, Side::Left, 5.0)];
        let nothing = GearInspection { pitch: [None, None], runout: None, thickness: Vec::new() };
        let measure = Measure { iso_1328_class: Some(5), ..Measure::default() };
        let verdict = GearVerdict::new(&flanks, &nothing, &measure, Some(&round(beta)));
        let limit = verdict.of(InspectionFigure::ProfileSlope).limit.expect("a class was asked for").0;
        assert!((limit - 5.5 * 0.882_758).abs() < 1e-4, "{limit}");
        // 5.0 um along the normal are 5.66 um in the transverse section: class 6.
        assert_eq!(verdict.of(InspectionFigure::ProfileSlope).class, Some(ClassReached::Class(6)));
    }
}
