//! A cylindrical gear as its drawing and its inspector state it: sizes of a round gear, figures against limits.
//!
//! In: sizes of the target, what was measured, what the scene holds it against. Out: sections of the findings, which
//! `check`, the page and the inspection sheet print from, and warnings.

pub mod headline;
pub mod teeth;

use crate::findings::notices::{BeyondLimit, NotJudged};
use crate::findings::{Datum, Entry, Level, Notice, Quantity, Section, Table, TableColumn};
use crate::job::CylindricalGear;
use crate::measure::flank_tolerance::{InspectionFigure, ToleranceSizes};
use crate::measure::inspection::{GearInspection, InspectedFlank};
use crate::measure::round_gear::{RoundGear, is_round};
use crate::measure::verdict::{ClassReached, GearVerdict, JudgedFigure, no_class};
use crate::output::summary;
use crate::output::text::{Sheet, significant};
use crate::scene::model::{DrawnLimits, Measure};
use gearcut_core::error::Result;
use gearcut_core::gear::GearKind;

/// Key of the sizes.
pub const SIZES: &str = "round_gear";
/// Key of the figures.
pub const INSPECTION: &str = "inspection";
/// Class of the limits that are offered to a gear without one: what shaping and hobbing are ordinarily asked for.
const MEAN_CLASS: u32 = 7;
const NOT_MEASURED: &str =
    "it was not measured: a flank was not cut completely, is cut away, or does not cross the pitch curve";

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
            let mut sizes = sizes(round, measure, self.mean_thickness_mm);
            if let Some(why) = other_gear {
                without_generated(&mut sizes, measure, why);
            }
            sizes
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
    Some(notice.notice().about(INSPECTION))
}

/// Sizes of a round gear's target; with a mean thickness as cut, also the measures of the cut gear.
pub fn sizes(round: &RoundGear, measure: &Measure, cut_thickness_mm: Option<f64>) -> Section {
    let mm = |value: f64, definition: &'static str| Quantity::number(value, "mm", definition);
    let ring = round.kind == GearKind::Internal;
    let height = |height_mm: f64| round.reference_diameter_mm() + 2.0 * round.kind.tip_sign() * height_mm;
    let named_mm = measure.profile_start_height_mm.map(height);
    let active = Quantity::number_or(
        named_mm.or_else(|| round.active_diameter_with_rack_mm()),
        "mm",
        if named_mm.is_some() {
            "d_Nf: start of the active profile, as measure.profile_start_height_mm names it"
        } else {
            "d_Nf: start of the active profile with a rack as mate; no external mate of this rack begins lower"
        },
        "no rack runs in a ring: name measure.profile_start_height_mm",
    );
    let active_tip_mm = measure.profile_end_height_mm.map_or(round.tip_form_diameter_mm, height);
    let mut section = Section::new(SIZES, "Sizes of the round gear")
        .with("reference_diameter", mm(round.reference_diameter_mm(), "d: z times the transverse module"))
        .with("base_diameter", mm(round.base_diameter_mm(), "d_b: of the circle that the involute unrolls from"))
        .with("tip_diameter", mm(round.tip_diameter_mm, "d_a: of the blank"))
        .with("root_diameter", mm(round.root_diameter_mm, "d_f: what the finishing tool's tip leaves"))
        .with("form_diameter", mm(round.form_diameter_mm, "d_Ff: where the involute begins, middle of the face"))
        .with("tip_form_diameter", mm(round.tip_form_diameter_mm, "d_Fa: where the involute ends, middle of the face"))
        .with("active_diameter", active)
        .with(
            "active_tip_diameter",
            mm(active_tip_mm, "d_Na: end of the active profile: profile_end_height_mm, else the involute's end"),
        )
        .with(
            "profile_shift",
            Quantity::number(round.profile_shift_coefficient, "1", "x: profile shift over the normal module"),
        )
        .with(
            "generating_profile_shift",
            Quantity::number(
                round.generating_shift(),
                "1",
                "x_E: profile shift that the target's thickness on the reference circle stands for, allowance and \
                 offset of the last operation included",
            ),
        )
        .with(
            "tip_clearance",
            mm(
                round.tip_clearance_mm(),
                "c: from this gear's root to the tip of a mate of the same rack and opposite shift, without backlash",
            ),
        )
        .with(
            "thickness",
            mm(round.thickness_mm, "s_t: thickness of the target, transverse arc of the reference circle"),
        );
    for (index, key, definition) in [
        (0, "chordal_thickness", "chord of a tooth of the target at the reference circle, normal section"),
        (1, "chordal_height", "height of the tip circle over the middle of that chord, normal section"),
    ] {
        let value_mm = round.chordal_mm().map(|of| of[index]);
        section = section.with(key, Quantity::number_or(value_mm, "mm", definition, "no vernier stands in a ring"));
    }
    let ball_mm = measure.ball_diameter_mm.unwrap_or_else(|| round.usual_ball_mm());
    section = section.with("ball_diameter", mm(ball_mm, "D_M: balls or pins of the dimension over two of them"));
    let of_span = if ring { "W_k: span across k spaces of the target" } else { "W_k: span over k teeth of the target" };
    let of_balls = if ring {
        "M_d: dimension between two balls in opposite spaces of the target, or those nearest to it"
    } else {
        "M_d: dimension over two balls in opposite spaces of the target, or those nearest to it"
    };
    section = match round.span() {
        Ok(span) => section
            .with("span_teeth", Quantity::count(span.teeth.into(), "1", "k: teeth, or spaces of a ring, of the span"))
            .with("span", mm(span.length_mm, of_span)),
        Err(why) => section.with("span", Quantity::undefined("mm", of_span, why)),
    };
    let over = |gear: &RoundGear, definition: &'static str| {
        let found = gear.over_balls(ball_mm);
        let dimension_mm = found.as_ref().ok().map(|over| over.dimension_mm);
        Quantity::number_or(dimension_mm, "mm", definition, found.err().unwrap_or_default())
    };
    section = section.with("over_balls", over(round, of_balls));
    let Some(cut_mm) = cut_thickness_mm else { return section };
    let cut = round.with_thickness(cut_mm);
    section =
        section.with("thickness_as_cut", mm(cut_mm, "mean thickness of all teeth as cut, middle of the face")).with(
            "generating_profile_shift_as_cut",
            Quantity::number(cut.generating_shift(), "1", "x_E of the mean thickness as cut"),
        );
    if let Ok(span) = round.span() {
        let definition = "W_k that the mean thickness as cut makes; feed marks where it touches are not in it";
        section = section.with("span_as_cut", mm(cut.span_over(span.teeth).length_mm, definition));
    }
    section.with("over_balls_as_cut", over(&cut, "M_d that the mean thickness as cut makes; feed marks are not in it"))
}

/// Takes away what the tool leaves when it cuts as the target has it. Sizes of the drawing, of the blank and of the
/// target's thickness stay: they are what the cut gear is held against.
fn without_generated(sizes: &mut Section, measure: &Measure, why: &str) {
    let mut keys = vec!["root_diameter", "form_diameter", "tip_form_diameter", "tip_clearance"];
    keys.extend(measure.profile_start_height_mm.is_none().then_some("active_diameter"));
    keys.extend(measure.profile_end_height_mm.is_none().then_some("active_tip_diameter"));
    for entry in sizes.entries.iter_mut().filter(|entry| keys.contains(&entry.key.as_str())) {
        entry.quantity = entry.quantity.clone().without_value(why.to_owned());
    }
}

/// Signs of the sizes, as drawings have them.
const SIGNS: [(&str, &str); 22] = [
    ("reference_diameter", "d"),
    ("base_diameter", "d_b"),
    ("tip_diameter", "d_a"),
    ("root_diameter", "d_f"),
    ("form_diameter", "d_Ff"),
    ("tip_form_diameter", "d_Fa"),
    ("active_diameter", "d_Nf"),
    ("active_tip_diameter", "d_Na"),
    ("profile_shift", "x"),
    ("generating_profile_shift", "x_E"),
    ("tip_clearance", "c"),
    ("thickness", "s_t"),
    ("chordal_thickness", "s_c"),
    ("chordal_height", "h_c"),
    ("ball_diameter", "D_M"),
    ("span_teeth", "k"),
    ("span", "W_k"),
    ("over_balls", "M_d"),
    ("thickness_as_cut", "s_t"),
    ("generating_profile_shift_as_cut", "x_E"),
    ("span_as_cut", "W_k"),
    ("over_balls_as_cut", "M_d"),
];

/// What the value of a size begins with that is not known; its reason follows.
pub const NO_SIZE: &str = "none: ";

/// Title, sign and value with unit of each size, for people.
pub fn size_rows(sizes: &Section) -> Vec<[String; 3]> {
    let row = |entry: &Entry| {
        let sign = SIGNS.iter().find(|(key, _)| *key == entry.key).map_or("", |(_, sign)| sign);
        let quantity = &entry.quantity;
        let value = match (quantity.value(), quantity.why()) {
            (Some(value), _) if quantity.is_count() => format!("{value}"),
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
    let brief = ["d_b", "d_a", "d_f", "x", "W_k"];
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
        reference_diameter_mm: gear.transverse_module_mm() * f64::from(gear.teeth),
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
    let definition = "finest flank tolerance class of ISO 1328-1:2013 that all figures keep; the target is the ideal \
                      flank of the last operation, so it is what this process leaves by itself";
    let class = match (verdict.class(), &verdict.no_class) {
        (Some(ClassReached::Class(class)), _) => Quantity::count(class.into(), "1", definition),
        (Some(ClassReached::Beyond), _) => Quantity::undefined("1", definition, "a figure is beyond class 11"),
        (None, why) => Quantity::undefined("1", definition, why.clone().unwrap_or_else(|| NOT_MEASURED.to_owned())),
    };
    let passes = "whether all figures keep their limits: pass or fail; not judged without limits";
    let none = "it was not measured, or the figure is one of both sides";
    let columns = vec![
        TableColumn::words("figure", "figure: symbol of ISO 1328-1"),
        TableColumn::words("name", "figure in words"),
        TableColumn::new("left", "um", "value of the worst left flank; of both sides together for runout").or(none),
        TableColumn::new("left_tooth", "1", "its tooth").or("the figure is one of all teeth, or was not measured"),
        TableColumn::new("right", "um", "value of the worst right flank").or(none),
        TableColumn::new("right_tooth", "1", "its tooth").or("the figure is one of all teeth, or was not measured"),
        TableColumn::new(
            "limit",
            "um",
            "limit of the magnitude; on a helical round gear times cos(beta_b), as deviations \
            are taken along the normal",
        )
        .or("no limit was given"),
        TableColumn::words("source", "where the limit comes from: drawing, or class; none"),
        TableColumn::words(
            "class",
            "finest class that allows the worst value; beyond 11; none where there is no class",
        ),
        TableColumn::words("verdict", "pass, fail, not judged"),
    ];
    let rows = verdict.figures.iter().map(|judged| {
        let side = |index: usize| {
            let figure = judged.sides.get(index);
            [
                Datum::from(figure.map(|figure| figure.value_um)),
                figure.and_then(|figure| figure.tooth).map_or(Datum::Undefined, Datum::from),
            ]
        };
        let mut row = vec![judged.figure.symbol().into(), judged.figure.name().into()];
        row.extend(side(0));
        row.extend(side(1));
        row.extend([
            Datum::from(judged.limit.map(|limit| limit.0)),
            Datum::Word(judged.limit.map_or_else(|| "none".to_owned(), |limit| limit.1.words())),
            Datum::Word(class_words(judged.class)),
            verdict_words(judged.passes()).into(),
        ]);
        row
    });
    let mut section = Section::new(INSPECTION, "Inspection against limits");
    section.entries.push(Entry {
        title: "flank tolerance class reached".to_owned(),
        level: Level::Summary,
        ..Entry::new("class", class)
    });
    let told = Quantity::text(verdict_words(verdict.passes()), passes);
    let level = if verdict.passes().is_some() { Level::Summary } else { Level::Detail };
    section.entries.push(Entry { title: "limits".to_owned(), level, ..Entry::new("verdict", told) });
    section.table(Table::new("figures", "Figures and limits", columns).with_rows(rows).in_file("inspection"))
}
