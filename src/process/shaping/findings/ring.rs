//! What the cutter can do in a ring, as findings: how large it may be, how far its involute reaches, how deep its base
//! relieves the tips, whether it undercuts, whether its tip corners come clear, how large the module may be; each with
//! its place and with what to change.
//!
//! In: [`RingFacts`], known before cutting. Out: a section, with a row for every tooth of a period in
//! `tables/ring.csv`.

use super::answers::answered;
use crate::findings::{Datum, Notice, Place, Quantity, Section, Table, TableColumn};
use crate::measure::damage::LEAST_DEPTH_MM;
use crate::output::text::significant;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::notices::{TipCorners, Trimmed};
use crate::process::shaping::ring::{CornerPath, RingFacts, RingTooth, ToothPlace, rolling_module_mm, rolling_teeth};
use gearcut_core::gear::GearKind;
use gearcut_core::units::UM_PER_MM;

/// Key of the section.
pub const KEY: &str = "ring";
/// Why there is no radius, and no largest cutter.
const NOT_CURVED: &str = "the pitch curve is not curved towards the axis there";
/// Why there is no condition of undercut.
const STRAIGHT: &str = "the pitch curve is straight there";
/// Why there is no depth of the tips.
const NO_RELIEF: &str = "the cutter's base does not shape the tip, or leaves it out of its reach";
/// Why nothing is known of the corners.
const NO_OUTLINE: &str = "the target's outline is not known";

/// What the largest cutters are.
const ROLLING: &str = "most cutter teeth whose pitch circle rolls everywhere";
const CLEARING: &str = "most cutter teeth whose tip corners come clear of the tips beside their space";
const RADIAL: &str = "most cutter teeth that go in along the line of centres without trimming the tips";
/// Why there is none.
const NO_CUTTER: &str = "tips or rolling leave no such cutter, or tips lie inside the base circle";

/// The section; none of an external gear. Where a program cuts another ring, `other` says why nothing of it holds.
pub fn of_job(job: &ShapingJob, other: Option<&str>) -> Option<Section> {
    (job.blank.kind() == GearKind::Internal).then(|| {
        let section = section(job, &RingFacts::new(job));
        match other {
            Some(why) => section.without_values(why, &[]),
            None => section,
        }
    })
}

fn section(job: &ShapingJob, facts: &RingFacts) -> Section {
    let (z0, module_mm) = (job.cutter.teeth, job.scene.gear.module_mm);
    let (radius_mm, sharpest_rad) = facts.sharpest;
    // On a circle no place is sharper than others.
    let sharpest = |quantity: Quantity| {
        let place = Place::default().and("polar_angle_deg", sharpest_rad.to_degrees());
        if facts.teeth.len() > 1 { quantity.at(place) } else { quantity }
    };
    let section = Section::new(KEY, "What the cutter can do in the ring");
    let section = answered(
        section,
        "rolling_teeth",
        "largest cutter that rolls",
        sharpest(Quantity::count(facts.rolling_teeth.into(), "teeth", ROLLING)),
        format!("this one has {z0}; for more, take a curve with a larger smallest radius of curvature"),
    );
    let count = |teeth: Option<u32>, definition: &'static str| match teeth {
        Some(teeth) => Quantity::count(teeth.into(), "teeth", definition),
        None => Quantity::undefined("teeth", definition, NO_CUTTER),
    };
    let section = answered(
        section,
        "clearing_teeth",
        "largest cutter that clears",
        sharpest(count(facts.clearing_teeth, CLEARING)),
        "of a round ring of that radius, for sharp corners; a lower addendum of cutter or ring allows more",
    );
    let section = answered(
        section,
        "radial_teeth",
        "largest for radial infeed",
        sharpest(count(facts.radial_teeth, RADIAL)),
        "the same ring and corners, at depth on every radius; larger cutters trim the tips while they are fed in",
    );
    let section = answered(
        section,
        "smallest_radius_of_curvature",
        "smallest radius of curvature",
        sharpest(Quantity::number(radius_mm, "mm", "smallest radius of curvature of the pitch curve")),
        "a rounder curve, or more teeth of the same module, make it larger",
    );
    let section = undercut(section, facts);
    let section = tips(section, job, facts);
    let section = corners(section, facts);
    let section = trimming(section, job, facts);
    let modules = [rolling_module_mm(radius_mm, z0), facts.printed.module_limit_mm(radius_mm)];
    let definition =
        "module at which the pitch circle of a cutter of so many teeth no longer rolls on this pitch curve";
    answered(
        section,
        "module_limit",
        "limit of the module",
        sharpest(Quantity::number(modules[0], "mm", definition)),
        format!(
            "this one is {} mm; fewer cutter teeth allow more on this curve (the printed condition of undercut: {} mm)",
            significant(module_mm, 3),
            significant(modules[1], 4)
        ),
    )
    .with(
        "printed_module_limit",
        sharpest(Quantity::number(modules[1], "mm", "module up to which the printed condition of undercut holds")),
    )
    .table(table(facts, z0, module_mm))
}

fn on_tooth(place: ToothPlace) -> Place {
    Place::default().and("tooth", place.tooth).and("flank", place.side.name())
}

/// Flanks that begin too late, and the condition as it is printed.
fn undercut(section: Section, facts: &RingFacts) -> Section {
    let start = facts.highest_start;
    let [left_mm2, right_mm2] = facts.printed.sides_mm2(facts.sharpest.0);
    let told = if facts.undercut_flanks > 0 {
        "use a smaller tool.shaper_cutter.addendum_coefficient, or a curve that is less hollow towards the ring"
            .to_owned()
    } else {
        format!("nothing: flanks begin where the cutter's tip corner ends, at most at {:.3} mm", start.mm)
    };
    let sign = if left_mm2 <= right_mm2 { "<=" } else { ">" };
    let advice =
        format!("{told}; the printed condition, of an external gear, reads {left_mm2:.0} {sign} {right_mm2:.0} mm^2");
    let section = answered(
        section,
        "undercut_flanks",
        "undercut",
        Quantity::count(facts.undercut_flanks.into(), "flanks", "flanks whose beginning the cutter's tip cuts away")
            .at(on_tooth(start)),
        advice,
    );
    let start_of = "height over the pitch curve of the highest start of a generated flank, negative towards the root";
    let side =
        "side of the printed condition of undercut, that of an external gear of the smallest radius of curvature";
    section
        .with("highest_start", Quantity::number(start.mm, "mm", start_of).at(on_tooth(start)))
        .with("printed_undercut_left", Quantity::number(left_mm2, "mm^2", format!("left {side}")))
        .with("printed_undercut_right", Quantity::number(right_mm2, "mm^2", format!("right {side}")))
}

/// What the involute does not reach.
fn tips(section: Section, job: &ShapingJob, facts: &RingFacts) -> Section {
    let gear = &job.scene.gear;
    let placed = |mm: Option<ToothPlace>, scale: f64, unit: &'static str, definition: &'static str, why| {
        let quantity = Quantity::number_or(mm.map(|place| scale * place.mm), unit, definition, why);
        match mm {
            Some(place) => quantity.at(on_tooth(place)),
            None => quantity,
        }
    };
    let more_teeth = facts.generating_teeth.map_or("no cutter that rolls generates whole tips".to_owned(), |teeth| {
        format!("about {teeth} cutter teeth generate whole tips at the sharpest place")
    });
    let advice = match facts.shortest_involute {
        None => "nothing: the involute reaches the tips".to_owned(),
        Some(short) => {
            let lower = (100.0 * short.mm / gear.module_mm).floor() / 100.0;
            format!("{more_teeth}; gear.addendum_coefficient = {lower} ends the teeth below")
        }
    };
    let reach = "lowest end of a flank that the cutter's involute generates, height over the pitch curve";
    let relief = "largest depth of a tip behind the conjugate flank, which the cutter's base has shaped";
    let section = answered(
        section,
        "involute_height",
        "involute of the cutter",
        placed(facts.shortest_involute, 1.0, "mm", reach, "the involute reaches the tip on all flanks"),
        format!("the addendum is {} mm; {advice}", significant(job.blank.addendum_mm, 3)),
    );
    let told = match facts.relief {
        Some(_) => format!("{more_teeth}; keep the mating tips off that part, or take it as tip relief"),
        None => "nothing".to_owned(),
    };
    answered(section, "tip_relief", "tips set back", placed(facts.relief, UM_PER_MM, "um", relief, NO_RELIEF), told)
}

/// Tip corners on their way in and out.
fn corners(section: Section, facts: &RingFacts) -> Section {
    let definition = "smallest distance of a tip corner of the cutter from the teeth beside its space, on its way in \
                      or out; minus the depth where it cuts into them";
    let Some(tightest) = facts.tightest_corner else {
        let unknown = Quantity::undefined("mm", definition, NO_OUTLINE);
        return answered(section, "tip_corner_clearance", "tip corners", unknown, "see the whole blank of a run");
    };
    let CornerPath { clearance_mm, phi_rad } = tightest.path;
    let place = Place::default()
        .and("polar_angle_deg", phi_rad.to_degrees())
        .and("space_after_tooth", tightest.tooth)
        .and("path", if tightest.entering { "in" } else { "out" });
    let advice = if clearance_mm < 0.0 {
        "use a cutter with fewer teeth, a smaller tool.shaper_cutter.addendum_coefficient or gear.addendum_coefficient"
    } else {
        "nothing: they come clear of the teeth beside their space; more cutter teeth bring them nearer"
    };
    let clearance = Quantity::number(clearance_mm, "mm", definition).at(place);
    answered(section, "tip_corner_clearance", "tip corners", clearance, advice)
}

/// What the strokes of the infeed take off the tips.
fn trimming(section: Section, job: &ShapingJob, facts: &RingFacts) -> Section {
    let definition = "largest depth of a tip corner of the cutter in the ring's teeth during the strokes of an infeed";
    let Some(deepest) = facts.trimming else {
        let unknown = Quantity::undefined("um", definition, NO_OUTLINE);
        return answered(section, "trimming", "trimmed on the way in", unknown, "see the whole blank of a run");
    };
    let depth = Quantity::number(UM_PER_MM * deepest.depth_mm, "um", definition);
    if deepest.depth_mm < LEAST_DEPTH_MM {
        return answered(section, "trimming", "trimmed on the way in", depth, "nothing: the corners come clear");
    }
    let fewer =
        facts.radial_teeth.map_or("fewer cutter teeth".to_owned(), |teeth| format!("{teeth} cutter teeth or less"));
    let place = Place::default()
        .and("operation", job.operations[deepest.operation].spec.name.clone())
        .and("stroke", deepest.stroke as u64)
        .and("tooth", deepest.tooth);
    let advice = format!(
        "use {fewer}, a lower addendum of cutter or ring, or a spiral over a larger operation.infeed.spiral.angle_deg"
    );
    answered(section, "trimming", "trimmed on the way in", depth.at(place), advice)
}

/// What must be known before cutting: a fault where it is deeper than a gouge.
pub fn warnings(section: &Section, gouge_mm: f64) -> Vec<Notice> {
    let place_and_way_out = |key: &str| {
        let place = section.quantity(key)?.place().map(Place::words)?;
        Some((place, section.words(&format!("{key}_advice"))))
    };
    let corner = section.number("tip_corner_clearance").filter(|&mm| mm < 0.0).and_then(|clearance_mm| {
        let (place, way_out) = place_and_way_out("tip_corner_clearance")?;
        let corners = TipCorners { depth_mm: format!("{:.3}", -clearance_mm), place, way_out };
        Some(corners.notice().fault_where(-clearance_mm > gouge_mm))
    });
    let trimmed = section.number("trimming").map(|um| um / UM_PER_MM).filter(|&mm| mm >= LEAST_DEPTH_MM);
    let trimmed = trimmed.and_then(|depth_mm| {
        let (place, way_out) = place_and_way_out("trimming")?;
        let trimmed = Trimmed { depth_um: significant(UM_PER_MM * depth_mm, 3), place, way_out };
        Some(trimmed.notice().fault_where(depth_mm > gouge_mm))
    });
    corner.into_iter().chain(trimmed).collect()
}

fn table(facts: &RingFacts, cutter_teeth: u32, module_mm: f64) -> Table {
    let new = |key, unit, definition| TableColumn::new(key, unit, definition);
    let mm = |key, definition| new(key, "mm", definition);
    let um = |key, definition| new(key, "um", definition).or(NO_RELIEF);
    let columns = vec![
        new("tooth", "1", "number of the tooth, from 1"),
        new("phi", "deg", "polar angle of its middle on the pitch curve"),
        mm("radius_of_curvature", "radius of curvature of the pitch curve").or(NOT_CURVED),
        new("rolling_teeth", "1", "most cutter teeth whose pitch circle rolls there").or(NOT_CURVED),
        new("rolling_share", "%", "pitch radius of the cutter over the radius of curvature, and module over its limit")
            .or(NOT_CURVED),
        mm("start_left", "height over the pitch curve at which the generated left flank begins"),
        mm("start_right", "height over the pitch curve at which the generated right flank begins"),
        new(
            "printed_undercut",
            "%",
            "left side of the printed condition of undercut over its right side: it holds to 100",
        )
        .or(STRAIGHT),
        mm("involute_left", "height over the pitch curve at which the generated left flank ends"),
        mm("involute_right", "height over the pitch curve at which the generated right flank ends"),
        um("tip_relief_left", "depth of the left tip behind the conjugate flank"),
        um("tip_relief_right", "depth of the right tip behind the conjugate flank"),
        mm(
            "corners_in",
            "smallest distance of the tip corners from the teeth on their way into the space after the tooth",
        )
        .or(NO_OUTLINE),
        mm("corners_out", "the same on their way out of it").or(NO_OUTLINE),
        mm("rolling_module", "module at which the cutter no longer rolls there").or(NOT_CURVED),
        mm("printed_module", "module up to which the printed condition of undercut holds there").or(STRAIGHT),
    ];
    let row = |of: &RingTooth| {
        let radius_mm = of.radius_mm();
        // Where the curve is hollow towards the ring, the condition is that of the gear it is printed for.
        let any_radius_mm = (of.curvature_per_mm != 0.0).then(|| 1.0 / of.curvature_per_mm.abs());
        let module_limit_mm = radius_mm.map(|radius_mm| rolling_module_mm(radius_mm, cutter_teeth));
        let share = module_limit_mm.map(|limit_mm| 100.0 * module_mm / limit_mm);
        let printed = any_radius_mm.map(|radius_mm| {
            let [left_mm2, right_mm2] = facts.printed.sides_mm2(radius_mm);
            100.0 * left_mm2 / right_mm2
        });
        let mut row = vec![Datum::from(of.tooth), of.phi_rad.to_degrees().into(), radius_mm.into()];
        row.push(radius_mm.map_or(Datum::Undefined, |radius_mm| rolling_teeth(radius_mm, module_mm).into()));
        row.push(share.into());
        row.extend(of.start_mm.map(Datum::from));
        row.push(printed.into());
        row.extend(of.involute_mm.map(Datum::from));
        row.extend(of.relief_mm.map(|mm| Datum::from(mm.map(|mm| UM_PER_MM * mm))));
        row.extend([0, 1].map(|path| Datum::from(of.corners.map(|paths| paths[path].clearance_mm))));
        row.push(module_limit_mm.into());
        row.push(any_radius_mm.map(|radius_mm| facts.printed.module_limit_mm(radius_mm)).into());
        row
    };
    Table::new("teeth", "What the cutter can do, tooth by tooth over one period of the pitch curve", columns)
        .with_rows(facts.teeth.iter().map(row))
        .in_file("ring")
}
