//! The pitch curve: size, closure, curvature.

use crate::findings::Notice;
use crate::findings::notices::{CurveClosure, CurveScaled};
use crate::number_text::{plain, significant};
use crate::output::text::Sheet;
use crate::scene::Scene;
use crate::scene::model::Gear;
use gearcut_core::gear::{FormulaMeaning, GearKind, PitchCurve, PitchCurveShape, TableScaling};
use gearcut_core::units::{TURN_RAD, UM_PER_MM};

/// A closure error above this (in modules) is worth a warning: single pitch deviations of good gears are of this size.
const NOTABLE_CLOSURE_MODULES: f64 = 1e-3;

/// Radii scaled by more than this share are worth a warning: no rounding of points explains it.
const NOTABLE_SCALING: f64 = 1e-3;

/// Places of a turn over which a ratio is summed; of a smooth function that closes the sum is exact to rounding.
const MATE_PLACES: u32 = 4096;
/// How near to a whole number the teeth of a mate are to be one.
const WHOLE_TEETH: f64 = 1e-6;

/// `rolling_radius_mm`: pitch radius of a cutter that has to roll in hollows.
pub fn print(sheet: &mut Sheet, curve: &PitchCurve, gear: &Gear, rolling_radius_mm: Option<f64>) {
    let facts = curve.facts();
    sheet.heading("Pitch curve");
    sheet.line("shape", gear.pitch_curve.words());
    let (name, given) = size_words(&gear.pitch_curve);
    let solved = if curve.sector_rad().is_none() { "the curve closes" } else { "the teeth fill the sector" };
    let origin = if given { "given".to_owned() } else { format!("solved so that {solved}") };
    sheet.details(|sheet| sheet.line(name, format!("{:.6} mm, {origin}", curve.size_mm())));
    if let Some(teeth) = mate_teeth(curve, gear) {
        let whole = (teeth - teeth.round()).abs() < WHOLE_TEETH;
        let moved = ": no mate closes there, and `gearcut mate` moves the axes, which changes the ratio";
        let words = if whole { format!("{teeth:.0} teeth") } else { format!("{teeth:.3} teeth{moved}") };
        let mate = if gear.kind == GearKind::External { "external mate" } else { "gear inside" };
        sheet.line(&format!("{mate} of that ratio"), words);
    }
    if let Some(factor) = curve.scaling() {
        sheet.line("scaling", format!("radii of the points times {factor:.6}"));
    }
    let [from, to] = [facts.smallest_radius_mm, facts.largest_radius_mm].map(|mm| format!("{mm:.3}"));
    let radius = if from == to { format!("{to} mm everywhere") } else { format!("{from} to {to} mm") };
    sheet.line("radius", radius);
    if let Some([from, to]) = curve.sector_rad() {
        let [arc_mm, width_deg] = [curve.arc_mm(to), (to - from).to_degrees()];
        sheet.line("sector", format!("{} teeth on {arc_mm:.6} mm of arc, {width_deg:.3} deg", gear.teeth));
        if let Some(radius_mm) = gear.dwell_radius_mm(curve) {
            sheet.line("dwell", format!("{radius_mm:.3} mm in radius, without teeth"));
        }
    }
    let wanted_mm = std::f64::consts::PI * gear.transverse_module_mm() * f64::from(gear.teeth);
    let error_um = UM_PER_MM * curve.closure_error_mm();
    let closes = if error_um.abs() < 1e-5 {
        "closes".to_owned()
    } else {
        let word = if error_um > 0.0 { "too long" } else { "too short" };
        format!("{} um {word}", significant(error_um.abs(), 3))
    };
    if curve.sector_rad().is_none() {
        let length = format!("{:.6} mm for pi m z = {wanted_mm:.6} mm: {closes}", curve.perimeter_mm());
        sheet.line("perimeter", length);
    }
    if facts.curvature_extrema.is_empty() {
        sheet.line("radius of curvature", format!("{:.3} mm everywhere; convex", facts.smallest_curvature_radius_mm));
        return;
    }
    // Lobes are equal but for rounding: the first one is named.
    let sharpest: Vec<f64> = facts
        .curvature_extrema
        .iter()
        .filter(|e| 1.0 / e.curvature_per_mm.abs() <= facts.smallest_curvature_radius_mm * (1.0 + 1e-9))
        .map(|e| e.phi_rad.to_degrees())
        .collect();
    sheet.line(
        "smallest radius of curvature",
        format!(
            "{:.3} mm at polar angle {}",
            facts.smallest_curvature_radius_mm,
            match sharpest.as_slice() {
                [] => "0.00 deg".to_owned(),
                [one] => format!("{one:.2} deg"),
                [first, others @ ..] => format!("{first:.2} deg and {} more", others.len()),
            }
        ),
    );
    if facts.convex {
        sheet.line("concave zones", "none: the curve is convex");
        return;
    }
    let zones: Vec<String> = facts
        .concave_zones_rad
        .iter()
        .map(|[from, to]| format!("{:.2} to {:.2}", from.to_degrees(), to.to_degrees()))
        .collect();
    sheet.line("concave zones", format!("{} deg", zones.join(", ")));
    let hollow_mm = -1.0 / facts.smallest_curvature.curvature_per_mm;
    sheet.line(
        "tightest hollow",
        format!(
            "radius {hollow_mm:.3} mm at polar angle {:.2} deg{}",
            facts.smallest_curvature.phi_rad.to_degrees(),
            rolling_radius_mm.map_or(String::new(), |radius_mm| format!("; the cutter rolls on {radius_mm:.3} mm"))
        ),
    );
}

/// Teeth of the gear that runs with a curve given by its ratio, at the distance that the scene gives or solves: in a
/// turn the mate turns by the integral of r / (C - r) over phi.
fn mate_teeth(curve: &PitchCurve, gear: &Gear) -> Option<f64> {
    let is_ratio = matches!(
        gear.pitch_curve,
        PitchCurveShape::SinusoidalRatio { .. } | PitchCurveShape::Formula { meaning: FormulaMeaning::Ratio(_), .. }
    );
    let speed = |i: u32| {
        let radius_mm = curve.frame(TURN_RAD * f64::from(i) / f64::from(MATE_PLACES)).point_mm.length();
        radius_mm / (curve.size_mm() - radius_mm).abs()
    };
    let turns = || (0..MATE_PLACES).map(speed).sum::<f64>() / f64::from(MATE_PLACES);
    is_ratio.then(|| f64::from(gear.teeth) / turns())
}

/// What must be known of the curve before cutting.
pub fn warnings(curve: &PitchCurve, gear: &Gear) -> Vec<Notice> {
    let error_mm = curve.closure_error_mm();
    let (notable, teeth) = (error_mm.abs() > NOTABLE_CLOSURE_MODULES * gear.module_mm, gear.teeth);
    let closure = || {
        let word = if error_mm > 0.0 { "too long" } else { "too short" };
        CurveClosure { error_um: significant(UM_PER_MM * error_mm.abs(), 3), word, teeth }.notice()
    };
    let asked = matches!(gear.pitch_curve.law(), PitchCurveShape::Table { scaling: TableScaling::Any, .. });
    let scaled = curve.scaling().filter(|factor| !asked && (factor - 1.0).abs() > NOTABLE_SCALING);
    let scaled = scaled.map(|factor| CurveScaled { factor: format!("{factor:.6}"), teeth }.notice());
    notable.then(closure).into_iter().chain(scaled).collect()
}

/// What the size of a shape is called, and whether the scene gives it.
fn size_words(shape: &PitchCurveShape) -> (&'static str, bool) {
    match shape.law() {
        PitchCurveShape::Circle => ("pitch radius", false),
        PitchCurveShape::Ellipse { semi_major_axis_mm, .. } => ("semi-major axis", semi_major_axis_mm.is_some()),
        PitchCurveShape::SinusoidalRatio { center_distance_mm, .. } => {
            ("centre distance of the pair", center_distance_mm.is_some())
        }
        PitchCurveShape::Pascal { mean_radius_mm, .. } | PitchCurveShape::Fourier { mean_radius_mm, .. } => {
            ("mean radius", mean_radius_mm.is_some())
        }
        PitchCurveShape::Formula { meaning: FormulaMeaning::Radius, size_mm, .. } => {
            ("scale of the formula", size_mm.is_some())
        }
        PitchCurveShape::Formula { size_mm, .. } => ("centre distance of the pair", size_mm.is_some()),
        PitchCurveShape::Table { scaling, .. } => ("mean radius", *scaling == TableScaling::AsGiven),
        PitchCurveShape::Mate { .. } | PitchCurveShape::Sector { .. } => ("centre distance of the pair", false),
    }
}

/// The gear in a line.
pub fn gear_words(scene: &Scene) -> String {
    let gear = &scene.gear;
    let teeth = match scene.process.other_teeth_key() {
        Some(_) => "drawn teeth".to_owned(),
        None => format!("pressure angle {} deg", plain(gear.pressure_angle_rad.to_degrees())),
    };
    let helix = match gear.helix_angle_rad {
        0.0 => String::new(),
        angle => format!(", helix angle {} deg {}-hand", plain(angle.to_degrees()), gear.hand.name()),
    };
    let internal = if gear.kind == GearKind::Internal { "internal gear, " } else { "" };
    format!(
        "{internal}{} teeth, module {} mm, {teeth}{helix}, face width {} mm",
        gear.teeth,
        plain(gear.module_mm),
        plain(gear.face_width_mm)
    )
}
