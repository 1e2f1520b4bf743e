//! Defaults of shaping that follow from other keys: a cut that a shop could run, unless the scene asks for another.
//!
//! In: the values that are written, with the fixed defaults. Out: the derived ones.
//!
//! A scene without operations roughs and finishes. An operation that says nothing of its infeed goes to depth on a
//! spiral, from the blank or from where the operation before it stood, and cuts on over the angle of the spiral, where
//! it was still shallow. Every stroke then meets chips like those of the rolling cut. At depth from the first stroke
//! on, the cutter would take whole tooth spaces at once: 357 kN on a gear of module 3 and 24 teeth, where the spiral
//! takes 8 kN.
//!
//! Road not taken: a spiral where the scene gives a window. A window shows a piece of a cut that is under way.

use super::stock::{offset_for_mm, offset_mm, teeth_per_turn};
use crate::scene::build::sector_deg;
use crate::scene::values::{Checked, Values};
use gearcut_core::units::UM_PER_MM;

/// Work angle over which the whole depth of the teeth is fed, deg; less depth takes less of it. Found by trial on gears
/// of module 1 to 8 and 20 to 60 teeth: roughing asks at most 1.25 times the force on the spiral that it asks on the
/// rest of the turn, where 20 deg give up to 1.7 times and 120 deg are no better on many teeth.
const WHOLE_DEPTH_ANGLE_DEG: f64 = 90.0;
/// Stock that roughing leaves on each flank in a scene without operations, in modules: 0.2 mm at module 3. Chosen, not
/// derived: some hundred times the scallops of roughing, and shallow enough for 100 strokes per tooth.
const STOCK_MODULES: f64 = 1.0 / 15.0;
/// Strokes per tooth of the roughing in a scene without operations.
const ROUGHING_STROKES_PER_TOOTH: u32 = 20;
/// Strokes per tooth of every other operation.
const STROKES_PER_TOOTH: u32 = 100;
/// One slice of the blank stands for sections that lie this near to it, in distances of its rays: places between rays
/// are known no better. Gouges of the ends of the face are found by the flanks, whose rows reach there.
const SLICE_REACH: f64 = 0.1;
/// What random errors hardly ever exceed, in standard deviations.
const LARGEST_NOISE: f64 = 4.0;

/// Puts the defaults in.
pub(super) fn derive(values: &mut Values) {
    let gear = values.view("gear");
    let (module_mm, teeth) = (gear.number("module_mm"), teeth_per_turn(values));
    if let Some(module_mm) = module_mm {
        values.put_default("fields.chips", "spacing_mm", Checked::Number((module_mm / 60.0).max(0.002)));
    }
    let _: Option<()> = blank_slices(values);
    let _: Option<()> = standard_roughing(values);
    for index in 0..values.count("operation") {
        let path = format!("operation.{index}");
        if let Some(teeth) = teeth
            && !values.is_written(&path, "circular_feed_mm_per_stroke")
        {
            let strokes = Checked::Whole(STROKES_PER_TOOTH * teeth);
            values.put_if_missing(&path, "strokes_per_revolution", strokes);
        }
        let _: Option<()> = infeed(values, index);
        values.put_if_missing(&path, "overlap_deg", Checked::Number(0.0));
    }
}

/// How deep the cutter reaches into the blank at offset 0, mm.
pub(super) fn reach_mm(values: &Values) -> Option<f64> {
    let (gear, cutter) = (values.view("gear"), values.view("tool.shaper_cutter"));
    let reach = gear.number("addendum_coefficient")? + cutter.number("addendum_coefficient")?;
    Some(reach * gear.number("module_mm")?)
}

/// Distance of the blank's slices where the axes rest during all strokes and guide or clamping shift the cutter along
/// the face: twice the face, which is one slice in its middle, where no section lies further away than
/// [`SLICE_REACH`]. Else sections shift evenly, so that both ends of the face say all of them, or on a parabola, which
/// needs the middle as well. Where noise goes on in time, sections differ at random, all of them alike in the mean:
/// three stand for them.
fn blank_slices(values: &mut Values) -> Option<()> {
    let feeds = |index: usize| values.view(&format!("operation.{index}")).boolean("feed_during_stroke") == Some(true);
    let of = |section: &str, key: &str| values.view(section).number(key).unwrap_or(0.0).abs();
    let both = |[radial, tangential]: [&str; 2]| {
        let guide = "machine.errors.guide";
        of(guide, radial).hypot(of(guide, tangential))
    };
    let face_mm = values.view("gear").number("face_width_mm")?;
    let leaning_um = both(["radial_um_per_100mm", "tangential_um_per_100mm"]) + of("mounting", "wobble_um_per_100mm");
    let leaning_um = leaning_um * 0.5 * face_mm / 100.0;
    let bent_um = both(["radial_bow_um", "tangential_bow_um"]);
    let wandering_um = wandering_um(values)?;
    if leaning_um + bent_um + wandering_um == 0.0 || (0..values.count("operation")).any(feeds) {
        return None;
    }
    let rays_um = values.view("fields.blank").number("spacing_mm")? * UM_PER_MM;
    let slices_mm = if leaning_um + bent_um + wandering_um <= SLICE_REACH * rays_um {
        2.0 * face_mm
    } else if bent_um + wandering_um > 0.0 {
        0.5 * face_mm
    } else {
        face_mm
    };
    let usual_mm = values.view("fields.blank").number("slice_spacing_mm")?;
    values.put_default("fields.blank", "slice_spacing_mm", Checked::Number(slices_mm.max(usual_mm)));
    Some(())
}

/// How far noise that goes on in time moves the flanks at most, um.
fn wandering_um(values: &Values) -> Option<f64> {
    let gear = values.view("gear");
    let module_mm = gear.number("module_mm")?;
    let teeth = [gear.whole("teeth")?, values.view("tool.shaper_cutter").whole("teeth")?];
    let of = |axis: &str, noise: &str| {
        let axis = format!("machine.errors.{axis}");
        let goes_on = values.view(&axis).number("noise_bandwidth_hz").is_some();
        if goes_on { values.view(&axis).number(noise).unwrap_or(0.0).abs() } else { 0.0 }
    };
    let turning_um = ["work", "cutter"].into_iter().zip(teeth).map(|(axis, teeth)| {
        let radius_mm = 0.5 * module_mm * f64::from(teeth);
        (of(axis, "noise_arcsec") / 3600.0).to_radians() * radius_mm * UM_PER_MM
    });
    Some(LARGEST_NOISE * (turning_um.sum::<f64>() + of("center_distance", "noise_um")))
}

/// Stock and feed of the roughing that stands in for operations that are not written.
fn standard_roughing(values: &mut Values) -> Option<()> {
    if values.has_section("operation.0") || values.count("operation") < 2 {
        return None;
    }
    let gear = values.view("gear");
    let (module_mm, teeth) = (gear.number("module_mm")?, teeth_per_turn(values)?);
    let offset_mm = offset_for_mm(values, 0, STOCK_MODULES * module_mm)?;
    let path = "operation.0";
    if !values.is_written(path, "stock_per_flank_mm") {
        values.put_default(path, "offset_mm", Checked::Number(offset_mm));
    }
    if !values.is_written(path, "circular_feed_mm_per_stroke") {
        values.put_default(path, "strokes_per_revolution", Checked::Whole(ROUGHING_STROKES_PER_TOOTH * teeth));
    }
    Some(())
}

/// Infeed and overlap of an operation, as far as they are not written.
fn infeed(values: &mut Values, index: usize) -> Option<()> {
    let reach_mm = reach_mm(values)?;
    let path = format!("operation.{index}");
    let own_mm = offset_mm(values, index)?;
    let window = |index: usize| values.is_written(&format!("operation.{index}"), "window_deg");
    let earlier = (0..index).filter(|earlier| !window(*earlier)).filter_map(|earlier| offset_mm(values, earlier));
    let left_mm = earlier.fold(reach_mm, f64::min) - own_mm;
    // A sector is cut in one swing, from beside the stock.
    let windowed = window(index) || sector_deg(values).is_some();
    let choice = format!("{path}.infeed");
    if windowed || left_mm <= 0.0 {
        values.put_default_variant(&choice, "none");
    }
    if values.view(&path).variant("infeed")? != "spiral" {
        return None;
    }
    let spiral = format!("{choice}.spiral");
    let depth_mm = if left_mm > 0.0 { left_mm } else { reach_mm - own_mm };
    if depth_mm > 0.0 {
        values.put_default(&spiral, "depth_mm", Checked::Number(depth_mm));
    }
    if values.is_written(&spiral, "angle_deg") {
        return None;
    }
    let depth_mm = values.view(&spiral).number("depth_mm")?;
    let angle_deg = WHOLE_DEPTH_ANGLE_DEG * (depth_mm / reach_mm).min(1.0);
    values.put_default(&spiral, "angle_deg", Checked::Number(angle_deg));
    let once = values.view(&path).whole("revolutions") == Some(1) && !windowed;
    if once {
        values.put_default(&path, "overlap_deg", Checked::Number(angle_deg));
    }
    Some(())
}
