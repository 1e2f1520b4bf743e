//! The pitch curve: size, closure, curvature.

use gearcut::job::Job;
use gearcut::output::text::{Sheet, significant};
use gearcut::scene::model::PitchCurveShape;
use gearcut::units::UM_PER_MM;

/// A closure error above this (in modules) is worth a warning: single pitch deviations of good gears are of this size.
const NOTABLE_CLOSURE_MODULES: f64 = 1e-3;

pub fn print(sheet: &mut Sheet, job: &Job) {
    let (curve, gear) = (&job.curve, &job.scene.gear);
    let facts = curve.facts();
    sheet.heading("Pitch curve");
    sheet.line("shape", gear.pitch_curve.words());
    let (name, given) = size_words(&gear.pitch_curve);
    let origin = if given { "given" } else { "solved so that the curve closes" };
    sheet.line(name, format!("{:.6} mm, {origin}", curve.size_mm()));
    sheet.line("radius", format!("{:.3} to {:.3} mm", facts.smallest_radius_mm, facts.largest_radius_mm));
    let wanted_mm = std::f64::consts::PI * gear.module_mm * f64::from(gear.teeth);
    let error_um = UM_PER_MM * curve.closure_error_mm();
    let closes = if error_um.abs() < 1e-5 {
        "closes".to_owned()
    } else {
        let word = if error_um > 0.0 { "too long" } else { "too short" };
        format!("{} um {word}", significant(error_um.abs(), 3))
    };
    sheet.line("perimeter", format!("{:.6} mm for pi m z = {wanted_mm:.6} mm: {closes}", curve.perimeter_mm()));
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
            "radius {hollow_mm:.3} mm at polar angle {:.2} deg; the cutter rolls on {:.3} mm",
            facts.smallest_curvature.phi_rad.to_degrees(),
            job.cutter.pitch_radius_mm
        ),
    );
}

pub fn warnings(job: &Job) -> Vec<String> {
    let error_mm = job.curve.closure_error_mm();
    let notable = error_mm.abs() > NOTABLE_CLOSURE_MODULES * job.scene.gear.module_mm;
    let text = || {
        format!(
            "the pitch curve is {} um {} for {} teeth: the last tooth pays for it; leave the size out and it is solved",
            significant(UM_PER_MM * error_mm.abs(), 3),
            if error_mm > 0.0 { "too long" } else { "too short" },
            job.scene.gear.teeth
        )
    };
    notable.then(text).into_iter().collect()
}

/// What the size of a shape is called, and whether the scene gives it.
fn size_words(shape: &PitchCurveShape) -> (&'static str, bool) {
    match shape {
        PitchCurveShape::Circle => ("pitch radius", false),
        PitchCurveShape::Ellipse { semi_major_axis_mm, .. } => ("semi-major axis", semi_major_axis_mm.is_some()),
        PitchCurveShape::SinusoidalRatio { center_distance_mm, .. } => {
            ("centre distance of the pair", center_distance_mm.is_some())
        }
        PitchCurveShape::Pascal { mean_radius_mm, .. } | PitchCurveShape::Fourier { mean_radius_mm, .. } => {
            ("mean radius", mean_radius_mm.is_some())
        }
        PitchCurveShape::Table { scale_to_close, .. } => ("mean radius of the points", !scale_to_close),
    }
}
