//! A cylindrical gear as its drawing and its inspector state it: sizes of a round gear, figures against limits.
//!
//! In: sizes of the target, what was measured, what the scene holds it against. Out: sections of the findings, which
//! `check`, the page and the inspection sheet print from, and warnings.

pub mod headline;
pub mod teeth;

use crate::findings::notices::{BeyondLimit, NotJudged};
use crate::findings::quantities::inspection::{
    BEYOND, CLASS, FIGURE, FIGURE_CLASS, FIGURE_LIMIT, FIGURE_VERDICT, INSPECTION, LEFT, LEFT_TOOTH, LIMIT_SOURCE,
    NAME, NOT_MEASURED, RIGHT, RIGHT_TOOTH, VERDICT,
};
use crate::findings::quantities::sizes::{
    ACTIVE_DIAMETER, ACTIVE_TIP_DIAMETER, BALL_DIAMETER, BASE_DIAMETER, CHORDAL_HEIGHT, CHORDAL_THICKNESS,
    FORM_DIAMETER, GENERATING_SHIFT, GENERATING_SHIFT_AS_CUT, NO_RACK, NO_VERNIER, OVER_BALLS, OVER_BALLS_AS_CUT,
    PROFILE_SHIFT, REFERENCE_DIAMETER, ROOT_DIAMETER, SIZES, SPAN, SPAN_AS_CUT, SPAN_TEETH, THICKNESS,
    THICKNESS_AS_CUT, TIP_CLEARANCE, TIP_DIAMETER, TIP_FORM_DIAMETER,
};
use crate::findings::{Entry, Notice, QuantityRow, Section, Table};
use crate::job::CylindricalGear;
use crate::measure::cut_grid::PLACE_MM;
use crate::measure::flank_tolerance::{InspectionFigure, ToleranceSizes};
use crate::measure::inspection::{GearInspection, InspectedFlank};
use crate::measure::round_gear::{RoundGear, is_round};
use crate::measure::verdict::{ClassReached, GearVerdict, JudgedFigure, no_class};
use crate::number_text::significant;
use crate::output::summary;
use crate::output::text::Sheet;
use crate::scene::model::{DrawnLimits, Measure};
use gearcut_core::error::Result;
use gearcut_core::gear::GearKind;

/// Class of the limits that are offered to a gear without one: what shaping and hobbing are ordinarily asked for.
const MEAN_CLASS: u32 = 7;

/// What an inspector says of a cut gear.
pub struct Inspected {
    /// Sizes of the target, if it is round.
    pub round: Option<RoundGear>,
    /// Mean thickness of the teeth as cut, arc of the pitch curve, mm.
    pub mean_thickness_mm: Option<f64>,
    /// Figures and limits.
    pub verdict: GearVerdict,
}

impl Inspected {
    /// Of a cut gear.
    ///
    /// # Errors
    /// The tool generates no flank.
    pub fn new<Own>(job: &dyn CylindricalGear, flanks: &[InspectedFlank<Own>], gear: &GearInspection) -> Result<Self> {
        let round = job.round_gear()?;
        let verdict = GearVerdict::new(flanks, gear, &job.scene().measure, round.as_ref());
        let arcs_mm: Option<Vec<f64>> = gear.thickness.iter().map(|of| of.map(|of| of.arc_mm)).collect();
        let mean_thickness_mm = arcs_mm.map(|arcs| arcs.iter().sum::<f64>() / arcs.len() as f64);
        Ok(Self { round, mean_thickness_mm, verdict })
    }

    /// Sizes and figures. Where the passes that cut are not those that the target follows from, `other_gear` says so.
    pub fn sections(&self, measure: &Measure, other_gear: Option<&str>) -> impl Iterator<Item = Section> {
        let cut = |round: &RoundGear| {
            let sizes = sizes(round, measure, self.mean_thickness_mm);
            match other_gear {
                Some(why) => without_generated(sizes, measure, why),
                None => sizes,
            }
        };
        self.round.as_ref().map(cut).into_iter().chain([figures(&self.verdict)])
    }

    /// Figures beyond their limits.
    pub fn warnings(&self) -> impl Iterator<Item = Notice> {
        self.verdict.failed().filter_map(beyond)
    }
}

/// A class that is asked for and that the standard does not give.
///
/// # Errors
/// The tool generates no flank.
pub fn not_judged(job: &dyn CylindricalGear) -> Result<Option<Notice>> {
    let Some(class) = job.scene().measure.iso_1328_class else { return Ok(None) };
    let why = no_class(job.round_gear()?.as_ref());
    Ok(why.map(|why| NotJudged { class, why }.notice()))
}

fn beyond(judged: &JudgedFigure) -> Option<Notice> {
    let (worst, (limit_um, source)) = (judged.worst()?, judged.limit?);
    let side = worst.side.map_or_else(String::new, |side| format!(", {} flanks", side.name()));
    let tooth = worst.tooth.map_or_else(String::new, |tooth| format!(", tooth {tooth}"));
    let notice = BeyondLimit {
        figure: judged.figure.name(),
        symbol: judged.figure.symbol(),
        place: side + &tooth,
        value_um: significant(worst.value_um, 3),
        limit_um: significant(limit_um, 3),
        source: source.words(),
    };
    Some(notice.notice().about(INSPECTION.key))
}

/// Sizes of a round gear's target; with a mean thickness as cut, also the measures of the cut gear.
pub fn sizes(round: &RoundGear, measure: &Measure, cut_thickness_mm: Option<f64>) -> Section {
    let height = |height_mm: f64| round.reference_diameter_mm() + 2.0 * round.kind.tip_sign() * height_mm;
    let [form_mm, tip_mm] = [round.form_diameter_mm, round.tip_form_diameter_mm];
    let reached = |mm: &f64| (form_mm.min(tip_mm) - PLACE_MM..=form_mm.max(tip_mm) + PLACE_MM).contains(mm);
    let [start_mm, end_mm] = measure.heights_mm().map(|of| of.map(height).filter(reached));
    let active_mm = start_mm.or_else(|| round.active_diameter_with_rack_mm());
    let active_tip_mm = end_mm.unwrap_or(tip_mm);
    let chordal_mm = round.chordal_mm();
    let ball_mm = measure.ball_diameter_mm.unwrap_or_else(|| round.usual_ball_mm());
    let over = |gear: &RoundGear, row: &QuantityRow| match gear.over_balls(ball_mm) {
        Ok(over) => row.of(over.dimension_mm),
        Err(why) => row.none(why),
    };
    // In a ring balls and span lie in spaces: other words, the same keys.
    let in_ring =
        |entry: Entry, title: &str| if round.kind == GearKind::Internal { entry.titled(title) } else { entry };
    let span = match round.span() {
        Ok(span) => vec![in_ring(SPAN_TEETH.of(span.teeth), "span spaces"), SPAN.of(span.length_mm)],
        Err(why) => vec![SPAN.none(why)],
    };
    let section = SIZES
        .section([
            REFERENCE_DIAMETER.of(round.reference_diameter_mm()),
            BASE_DIAMETER.of(round.base_diameter_mm()),
            TIP_DIAMETER.of(round.tip_diameter_mm),
            ROOT_DIAMETER.of(round.root_diameter_mm),
            FORM_DIAMETER.of(round.form_diameter_mm),
            TIP_FORM_DIAMETER.of(round.tip_form_diameter_mm),
            ACTIVE_DIAMETER.of_or(active_mm, NO_RACK),
            ACTIVE_TIP_DIAMETER.of(active_tip_mm),
            PROFILE_SHIFT.of(round.profile_shift_coefficient),
            GENERATING_SHIFT.of(round.generating_shift()),
            TIP_CLEARANCE.of(round.tip_clearance_mm()),
            THICKNESS.of(round.thickness_mm),
            CHORDAL_THICKNESS.of_or(chordal_mm.map(|of| of[0]), NO_VERNIER),
            CHORDAL_HEIGHT.of_or(chordal_mm.map(|of| of[1]), NO_VERNIER),
            BALL_DIAMETER.of(ball_mm),
        ])
        .entries(span)
        .entries([in_ring(over(round, &OVER_BALLS), "between balls")]);
    let Some(cut_mm) = cut_thickness_mm else { return section };
    let cut = round.with_thickness(cut_mm);
    let span = round.span().ok().map(|span| SPAN_AS_CUT.of(cut.span_over(span.teeth).length_mm));
    section
        .entries([THICKNESS_AS_CUT.of(cut_mm), GENERATING_SHIFT_AS_CUT.of(cut.generating_shift())])
        .entries(span)
        .entries([in_ring(over(&cut, &OVER_BALLS_AS_CUT), "between balls as cut")])
}

/// Takes away what the tool generates when it cuts as the target has it. Sizes of the drawing, of the blank and of the
/// target's thickness stay: the cut gear is held against them.
fn without_generated(mut sizes: Section, measure: &Measure, why: &str) -> Section {
    let mut rows = vec![&ROOT_DIAMETER, &FORM_DIAMETER, &TIP_FORM_DIAMETER, &TIP_CLEARANCE];
    rows.extend(measure.profile_start_height_mm.is_none().then_some(&ACTIVE_DIAMETER));
    rows.extend(measure.profile_end_height_mm.is_none().then_some(&ACTIVE_TIP_DIAMETER));
    let is_generated = |entry: &Entry| rows.iter().any(|row| row.key == entry.key);
    let entries = sizes.entries.into_iter();
    sizes.entries = entries.map(|entry| if is_generated(&entry) { entry.unless(Some(why)) } else { entry }).collect();
    sizes
}

/// What the value of a size begins with that is not known; its reason follows.
pub const NO_SIZE: &str = "none: ";

/// Title, sign and value with unit of each size, for people.
pub fn size_rows(sizes: &Section) -> Vec<[String; 3]> {
    let row = |entry: &Entry| {
        let sign = SIZES.rows.iter().find(|row| row.key == entry.key).map_or("", |row| row.symbol);
        let quantity = &entry.quantity;
        let value = match (quantity.value(), quantity.why()) {
            (Some(value), _) if quantity.whole().is_some() => format!("{value}"),
            (Some(value), _) if quantity.unit() == Some("mm") => format!("{value:.4} mm"),
            // A rounded zero has no sign.
            (Some(value), _) => format!("{:.4}", (1e4 * value).round() / 1e4 + 0.0),
            (None, why) => format!("{NO_SIZE}{}", why.unwrap_or_default()),
        };
        [entry.heading(), sign.to_owned(), value]
    };
    sizes.entries.iter().map(row).collect()
}

/// What `check` says of a round gear.
///
/// # Errors
/// The tool generates no flank.
pub fn print(sheet: &mut Sheet, job: &dyn CylindricalGear) -> Result<()> {
    let Some(round) = job.round_gear()? else {
        limits_of_mean_gear(sheet, job);
        return Ok(());
    };
    sheet.heading("Round gear");
    let brief = ["d_b", "d_a", "d_f", "x", "k", "W_k"];
    for [title, sign, value] in size_rows(&sizes(&round, &job.scene().measure, None)) {
        if !sheet.is_brief() || brief.contains(&sign.as_str()) {
            summary::line(sheet, &format!("{} {sign}", title.to_lowercase()), &value);
        }
    }
    Ok(())
}

/// Limits for a gear that has no class, where its scene has none yet: those of the round gear of the same mean
/// diameter, ready to paste.
fn limits_of_mean_gear(sheet: &mut Sheet, job: &dyn CylindricalGear) {
    let gear = &job.scene().gear;
    let sizes = ToleranceSizes {
        teeth: gear.teeth,
        reference_diameter_mm: gear.transverse_module_mm() * f64::from(job.curve().pitches()),
        normal_module_mm: gear.module_mm,
        face_width_mm: gear.face_width_mm,
        helix_angle_rad: gear.helix_angle_rad,
    };
    let has_limits = job.scene().measure.limits != DrawnLimits::default();
    if is_round(job.curve()) || has_limits || sizes.beyond().is_some() {
        return;
    }
    sheet.heading("Limits of the round gear of the same mean diameter");
    sheet.words("[measure.limits]");
    sheet.words(&format!("# class {MEAN_CLASS} of ISO 1328-1 at d = {:.3} mm,", sizes.reference_diameter_mm));
    sheet.words("# not of this gear, which has no class; a class is a factor of 1.41");
    for figure in InspectionFigure::ALL {
        if let Ok(limit_um) = sizes.tolerance_um(figure, MEAN_CLASS) {
            sheet.words(&format!("{}_um = {limit_um}", figure.key()));
        }
    }
}

/// A class in words.
pub fn class_words(class: Option<ClassReached>) -> String {
    match class {
        Some(ClassReached::Class(class)) => class.to_string(),
        Some(ClassReached::Beyond) => "beyond 11".to_owned(),
        None => "none".to_owned(),
    }
}

/// A verdict in words.
pub fn verdict_words(passes: Option<bool>) -> &'static str {
    match passes {
        Some(true) => "pass",
        Some(false) => "fail",
        None => "not judged",
    }
}

fn figures(verdict: &GearVerdict) -> Section {
    let class = match (verdict.class(), &verdict.no_class) {
        (Some(ClassReached::Class(class)), _) => CLASS.of(class),
        (Some(ClassReached::Beyond), _) => CLASS.none(BEYOND),
        (None, Some(why)) => CLASS.none(why.clone()),
        (None, None) => CLASS.none(NOT_MEASURED),
    };
    let passes = VERDICT.of(verdict_words(verdict.passes()));
    let passes = if verdict.passes().is_some() { passes.shown() } else { passes };
    let side = |judged: &JudgedFigure, index: usize| judged.sides.get(index).map(|figure| figure.value_um);
    let tooth = |judged: &JudgedFigure, index: usize| judged.sides.get(index).and_then(|figure| figure.tooth);
    let figures = Table::over("figures", "Figures and limits", &verdict.figures)
        .column(&FIGURE, |of| of.figure.symbol())
        .column(&NAME, |of| of.figure.name())
        .column(&LEFT, |of| side(of, 0))
        .column(&LEFT_TOOTH, |of| tooth(of, 0))
        .column(&RIGHT, |of| side(of, 1))
        .column(&RIGHT_TOOTH, |of| tooth(of, 1))
        .column(&FIGURE_LIMIT, |of| of.limit.map(|limit| limit.0))
        .column(&LIMIT_SOURCE, |of| of.limit.map_or_else(|| "none".to_owned(), |limit| limit.1.words()))
        .column(&FIGURE_CLASS, |of| class_words(of.class))
        .column(&FIGURE_VERDICT, |of| verdict_words(of.passes()));
    INSPECTION.section([class, passes]).table(figures.in_file("inspection"))
}
