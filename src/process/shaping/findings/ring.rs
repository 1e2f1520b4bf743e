//! What the cutter can do in a ring, as findings: how large it may be, how far its involute reaches, how deep its base
//! relieves the tips, whether it undercuts, whether its tip corners come clear, how large the module may be; each with
//! its place and advice.
//!
//! In: [`RingFacts`], known before cutting. Out: a section, with a row for every tooth of a period in
//! `tables/ring.csv`.

use crate::findings::quantities::teeth::TOOTH;
use crate::findings::{Entry, Notice, Place, QuantityRow, Section, Table};
use crate::measure::damage::LEAST_DEPTH_MM;
use crate::number_text::significant;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::findings::program;
use crate::process::shaping::gear::ring::{
    CornerPath, RingFacts, RingTooth, TightestCorner, ToothPlace, Trimming, corners_of_any_edge, rolling_module_mm,
    rolling_teeth,
};
use crate::process::shaping::notices::{TipCorners, Trimmed};
use crate::process::shaping::quantities::ring::{
    CLEARING_TEETH, CORNER_CLEARANCE, CORNERS_IN, CORNERS_OUT, HIGHEST_START, INVOLUTE_HEIGHT, INVOLUTE_LEFT,
    INVOLUTE_RIGHT, MODULE_LIMIT, NO_CUTTER, NO_OUTLINE, NO_RELIEF, PHI, PRINTED_LEFT, PRINTED_MODULE,
    PRINTED_MODULE_LIMIT, PRINTED_RIGHT, PRINTED_UNDERCUT, RADIAL_TEETH, RADIUS, REACHED, RING, RING_TEETH,
    ROLLING_MODULE, ROLLING_SHARE, ROLLING_TEETH, ROLLING_TEETH_AT, SMALLEST_RADIUS, START_LEFT, START_RIGHT,
    TIP_RELIEF, TIP_RELIEF_LEFT, TIP_RELIEF_RIGHT, TRIMMING, UNDERCUT,
};
use gearcut_core::gear::GearKind;
use gearcut_core::units::UM_PER_MM;

/// Advice where nothing is known of the target's outline.
const SEE_BLANK: &str = "See the whole blank of a run";
/// Advice on the teeth of a cutter.
const ROUNDER: &str = "A larger smallest radius of curvature allows more";

/// The section; none of an external gear. Of a drawn tooth it says what holds of any edge: the rest are laws of
/// involutes. Where a program cuts another ring nothing of it holds, and it says why.
pub fn of_job(job: &ShapingJob, motion: &[OperationAxes]) -> Option<Section> {
    (job.blank.kind() == GearKind::Internal).then(|| {
        let section = if job.cutter.involute().is_some() { section(job, &RingFacts::new(job)) } else { of_drawn(job) };
        match program::not_of_the_gear(job, motion) {
            Some(why) => section.without_values(&why, &[]),
            None => section,
        }
    })
}

/// Whether the cutter rolls, and its tip corners.
fn of_drawn(job: &ShapingJob) -> Section {
    let radius_mm = 1.0 / job.curve.facts().largest_curvature.curvature_per_mm;
    let (tightest, deepest) = corners_of_any_edge(job);
    RING.section([
        ROLLING_TEETH
            .of(rolling_teeth(radius_mm, job.transverse.module_mm))
            .fine(format!("This cutter has {}. {ROUNDER}", job.cutter.teeth)),
        SMALLEST_RADIUS.of(radius_mm),
        corners(tightest),
        trimming(job, deepest, None),
    ])
}

fn section(job: &ShapingJob, facts: &RingFacts) -> Section {
    let (z0, module_mm) = (job.cutter.teeth, job.transverse.module_mm);
    let (radius_mm, sharpest_rad) = facts.sharpest;
    // On a circle no place is sharper than others.
    let sharpest = |entry: Entry| {
        let place = Place::default().and("polar_angle_deg", sharpest_rad.to_degrees());
        entry.at(Some(place).filter(|_| facts.teeth.len() > 1))
    };
    let modules = [rolling_module_mm(radius_mm, z0), facts.printed.module_limit_mm(radius_mm)];
    let cutters = [
        sharpest(ROLLING_TEETH.of(facts.rolling_teeth)).fine(format!("This cutter has {z0}. {ROUNDER}")),
        sharpest(CLEARING_TEETH.of_or(facts.clearing_teeth, NO_CUTTER))
            .fine("For a round ring of that radius and sharp corners. A lower addendum of cutter or ring allows more"),
        sharpest(RADIAL_TEETH.of_or(facts.radial_teeth, NO_CUTTER)).fine(
            "For the same ring and corners, at depth on every radius. Larger cutters trim the tips while they are fed \
             in",
        ),
        sharpest(SMALLEST_RADIUS.of(radius_mm))
            .fine("A rounder curve, or more teeth of the same module, make it larger"),
    ];
    let limit = sharpest(MODULE_LIMIT.of(modules[0])).fine(format!(
        "This module is {} mm. Fewer cutter teeth allow more on this curve. The printed condition of undercut allows \
         {} mm",
        significant(module_mm, 3),
        significant(modules[1], 4)
    ));
    RING.section(cutters)
        .entries(undercut(facts))
        .entries(tips(job, facts))
        .entries([corners(facts.tightest_corner), trimming(job, facts.trimming, facts.radial_teeth)])
        .entries([limit, sharpest(PRINTED_MODULE_LIMIT.of(modules[1]))])
        .table(table(facts, z0, module_mm))
}

fn on_tooth(place: ToothPlace) -> Place {
    Place::default().and("tooth", place.tooth).and("flank", place.side.name())
}

/// Flanks that begin too late, and the condition as it is printed.
fn undercut(facts: &RingFacts) -> [Entry; 4] {
    let start = facts.highest_start;
    let [left_mm2, right_mm2] = facts.printed.sides_mm2(facts.sharpest.0);
    let sign = if left_mm2 <= right_mm2 { "<=" } else { ">" };
    let printed = format!("The printed condition, of an external gear, reads {left_mm2:.0} {sign} {right_mm2:.0} mm^2");
    let undercut = UNDERCUT.of(facts.undercut_flanks);
    let undercut = if facts.undercut_flanks > 0 {
        undercut.at(on_tooth(start)).change(format!(
            "Use a smaller tool.shaper_cutter.addendum_coefficient, or a curve that is less hollow towards the ring. \
             {printed}"
        ))
    } else {
        let mm = start.mm;
        undercut.fine(format!("Flanks begin where the cutter's tip corner ends, at most at {mm:.3} mm. {printed}"))
    };
    [undercut, HIGHEST_START.of(start.mm).at(on_tooth(start)), PRINTED_LEFT.of(left_mm2), PRINTED_RIGHT.of(right_mm2)]
}

/// What the involute does not reach.
fn tips(job: &ShapingJob, facts: &RingFacts) -> [Entry; 2] {
    let gear = &job.scene.gear;
    let placed = |row: &QuantityRow, found: Option<ToothPlace>, scale: f64, why: &'static str| {
        row.of_or(found.map(|place| scale * place.mm), why).at(found.map(on_tooth))
    };
    let more_teeth = facts.generating_teeth.map_or("No cutter that rolls generates whole tips".to_owned(), |teeth| {
        format!("About {teeth} cutter teeth generate whole tips at the sharpest place")
    });
    let addendum = format!("The addendum is {} mm", significant(job.blank.addendum_mm, 3));
    let involute = placed(&INVOLUTE_HEIGHT, facts.shortest_involute, 1.0, REACHED);
    let involute = match facts.shortest_involute {
        None => involute.fine(addendum),
        Some(short) => {
            let lower = (100.0 * short.mm / gear.module_mm).floor() / 100.0;
            involute
                .change(format!("{addendum}. {more_teeth}. gear.addendum_coefficient = {lower} ends the teeth below"))
        }
    };
    let relief = placed(&TIP_RELIEF, facts.relief, UM_PER_MM, NO_RELIEF);
    let relief = match facts.relief {
        Some(_) => relief.change(format!("{more_teeth}. Keep the mating tips off that part, or take it as tip relief")),
        None => relief.fine("Nothing to change"),
    };
    [involute, relief]
}

/// Tip corners on their way in and out.
fn corners(tightest: Option<TightestCorner>) -> Entry {
    let Some(tightest) = tightest else {
        return CORNER_CLEARANCE.none(NO_OUTLINE).fine(SEE_BLANK);
    };
    let CornerPath { clearance_mm, phi_rad } = tightest.path;
    let place = Place::default()
        .and("polar_angle_deg", phi_rad.to_degrees())
        .and("space_after_tooth", tightest.tooth)
        .and("path", if tightest.entering { "in" } else { "out" });
    let clearance = CORNER_CLEARANCE.of(clearance_mm).at(place);
    if clearance_mm < 0.0 {
        clearance.change(
            "Use a cutter with fewer teeth, or a smaller tool.shaper_cutter.addendum_coefficient or \
             gear.addendum_coefficient",
        )
    } else {
        clearance.fine("They come clear of the teeth beside their space. More cutter teeth bring them nearer")
    }
}

/// What the strokes of the infeed take off the tips.
fn trimming(job: &ShapingJob, deepest: Option<Trimming>, radial_teeth: Option<u32>) -> Entry {
    let Some(deepest) = deepest else {
        return TRIMMING.none(NO_OUTLINE).fine(SEE_BLANK);
    };
    let depth = TRIMMING.of(UM_PER_MM * deepest.depth_mm);
    if deepest.depth_mm < LEAST_DEPTH_MM {
        return depth.fine("The corners come clear");
    }
    let fewer = radial_teeth.map_or("fewer cutter teeth".to_owned(), |teeth| format!("{teeth} cutter teeth or less"));
    let place = Place::default()
        .and("operation", job.operations[deepest.operation].spec.name.clone())
        .and("stroke", deepest.stroke as u64)
        .and("tooth", deepest.tooth);
    depth.at(place).change(format!(
        "Use {fewer}, a lower addendum of cutter or ring, or a spiral over a larger operation.infeed.spiral.angle_deg"
    ))
}

/// What must be known before cutting: a fault where it is deeper than a gouge.
pub fn warnings(section: &Section, gouge_mm: f64) -> Vec<Notice> {
    let place_and_way_out = |row: &QuantityRow| {
        let entry = section.entry_of(row)?;
        Some((entry.quantity.place().map(Place::words)?, entry.advice.as_ref()?.text.as_str()))
    };
    let corner = section.value(&CORNER_CLEARANCE).filter(|&mm| mm < 0.0).and_then(|clearance_mm| {
        let (place, way_out) = place_and_way_out(&CORNER_CLEARANCE)?;
        let corners = TipCorners { depth_mm: format!("{:.3}", -clearance_mm), place, way_out };
        Some(corners.notice().fault_where(-clearance_mm > gouge_mm))
    });
    let trimmed = section.value(&TRIMMING).map(|um| um / UM_PER_MM).filter(|&mm| mm >= LEAST_DEPTH_MM);
    let trimmed = trimmed.and_then(|depth_mm| {
        let (place, way_out) = place_and_way_out(&TRIMMING)?;
        let trimmed = Trimmed { depth_um: significant(UM_PER_MM * depth_mm, 3), place, way_out };
        Some(trimmed.notice().fault_where(depth_mm > gouge_mm))
    });
    corner.into_iter().chain(trimmed).collect()
}

fn table(facts: &RingFacts, cutter_teeth: u32, module_mm: f64) -> Table {
    let limit_mm = |of: &RingTooth| of.radius_mm().map(|radius_mm| rolling_module_mm(radius_mm, cutter_teeth));
    // Where the curve is hollow towards the ring, the condition is that of the gear it is printed for.
    let any_radius_mm = |of: &RingTooth| (of.curvature_per_mm != 0.0).then(|| 1.0 / of.curvature_per_mm.abs());
    let printed = |of: &RingTooth| {
        let [left_mm2, right_mm2] = facts.printed.sides_mm2(any_radius_mm(of)?);
        Some(100.0 * left_mm2 / right_mm2)
    };
    let relief_um = |of: &RingTooth, side: usize| of.relief_mm[side].map(|mm| UM_PER_MM * mm);
    let corner_mm = |of: &RingTooth, path: usize| of.corners.map(|paths| paths[path].clearance_mm);
    RING_TEETH
        .table(&facts.teeth)
        .column(&TOOTH, |of| of.tooth)
        .column(&PHI, |of| of.phi_rad.to_degrees())
        .column(&RADIUS, |of| of.radius_mm())
        .column(&ROLLING_TEETH_AT, |of| of.radius_mm().map(|radius_mm| rolling_teeth(radius_mm, module_mm)))
        .column(&ROLLING_SHARE, |of| limit_mm(of).map(|limit_mm| 100.0 * module_mm / limit_mm))
        .column(&START_LEFT, |of| of.start_mm[0])
        .column(&START_RIGHT, |of| of.start_mm[1])
        .column(&PRINTED_UNDERCUT, |of| printed(of))
        .column(&INVOLUTE_LEFT, |of| of.involute_mm[0])
        .column(&INVOLUTE_RIGHT, |of| of.involute_mm[1])
        .column(&TIP_RELIEF_LEFT, |of| relief_um(of, 0))
        .column(&TIP_RELIEF_RIGHT, |of| relief_um(of, 1))
        .column(&CORNERS_IN, |of| corner_mm(of, 0))
        .column(&CORNERS_OUT, |of| corner_mm(of, 1))
        .column(&ROLLING_MODULE, |of| limit_mm(of))
        .column(&PRINTED_MODULE, |of| any_radius_mm(of).map(|radius_mm| facts.printed.module_limit_mm(radius_mm)))
        .in_file("ring")
}
