//! The strokes of a sector: one swing past its teeth, from beside the stock to beside the stock.
//!
//! In: stock, cutter and linkage of an operation. Out: the work angles at which the swing begins and ends. The cutter
//! is clear where its tip circle keeps [`CLEAR_SHARE`] of a pitch from every place of the toothed outline. From either
//! end of the sector the first such place on the bridge is taken.

use super::ShaperCutter;
use super::linkage::ShapingLinkage;
use gearcut_core::error::Refusal;
use gearcut_core::gear::blank::Blank;
use glam::DVec2;

/// Places along a sector and along its dwell at which cutter and stock are looked at.
const SWING_PLACES: u32 = 1024;
/// Room between cutter and stock where a swing begins and ends, in pitches.
const CLEAR_SHARE: f64 = 0.02;

/// Work angles between which the cutter passes a sector: from where it is clear of the stock before the first tooth to
/// where it is clear of it behind the last one; `None` where teeth go all round.
///
/// # Errors
/// A dwell too narrow for the cutter, or one that its tips reach.
pub(super) fn swing_rad(
    blank: &Blank,
    cutter: &ShaperCutter,
    linkage: &ShapingLinkage,
    offset_mm: f64,
) -> Result<Option<[f64; 2]>, Refusal> {
    let (curve, Some(dwell)) = (blank.curve(), blank.dwell()) else { return Ok(None) };
    let [from, to] = curve.toothed_rad();
    let outline = |i: u32| blank.outline_mm(from + (to - from) * f64::from(i) / f64::from(SWING_PLACES));
    let stock_mm: Vec<DVec2> = (0..=SWING_PLACES).map(outline).collect();
    // Between two of these places the outline comes nearer than they do by its arrow height: less than this by far.
    let room_mm = cutter.tip_radius_mm + CLEAR_SHARE * curve.perimeter_mm() / f64::from(curve.pitches());
    let center_mm = |phi: f64| linkage.pose(phi, offset_mm).center_mm;
    let is_clear = |phi: f64| {
        let center_mm = center_mm(phi);
        stock_mm.iter().all(|place_mm| place_mm.distance(center_mm) > room_mm)
    };
    let (toothed_mm, dwell_mm) = (curve.arc_mm(to), curve.perimeter_mm() - curve.arc_mm(to));
    let clear = |end_mm: f64, outwards: f64| {
        let phi = |i: u32| curve.phi_at_arc(end_mm + outwards * dwell_mm * f64::from(i) / f64::from(SWING_PLACES));
        (0..SWING_PLACES).map(phi).find(|&phi| is_clear(phi))
    };
    let (Some(first), Some(last)) = (clear(0.0, -1.0), clear(toothed_mm, 1.0)) else {
        return Err(Refusal::new(
            "gear.sector_deg",
            format!(
                "the cutter, {:.3} mm in radius at its tips, is nowhere clear of the teeth between the end of the \
                sector and its beginning",
                cutter.tip_radius_mm
            ),
            "leave a wider dwell, or take a cutter with fewer teeth",
        ));
    };
    let over = |i: u32| first + (last - first) * f64::from(i) / f64::from(SWING_PLACES);
    let reach = |phi: f64| center_mm(phi).length() - cutter.tip_radius_mm;
    let reach_mm = (0..=SWING_PLACES).map(|i| reach(over(i))).fold(f64::INFINITY, f64::min);
    if dwell.radius_mm >= reach_mm {
        return Err(Refusal::new(
            "gear.dwell_radius_mm",
            format!(
                "the cutter comes within {reach_mm:.3} mm of the gear's axis, and the dwell has the radius {:.3} mm",
                dwell.radius_mm
            ),
            format!("make the dwell smaller than {reach_mm:.3} mm"),
        ));
    }
    Ok(Some([first, last].map(|phi| linkage.axes(phi, offset_mm).psi_c_rad.value())))
}
