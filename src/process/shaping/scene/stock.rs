//! Offset of the cutter for the stock that an operation is to leave.
//!
//! In: the values of a scene. Out: the offset of an operation, and the stock beyond which there is none.
//!
//! Two involutes of one base circle are as far apart everywhere as the arcs of the base circle between them. On round
//! gears the stock is therefore the same all over a flank, and exact: each flank of a tooth that is s thicker on the
//! reference circle has s cos(alpha) / 2 more along its transverse normal, times cos(beta_b) along its own. Road not
//! taken: stock / sin(alpha), the law of a rack, which leaves 0.66 mm for 0.5 on 12 teeth of module 3 with x = 0.3 that
//! a cutter of 12 teeth cuts. On other gears, and with drawn teeth, the stock varies along the gear; that law holds
//! there, at the working pressure angle of the round gear with as many teeth.

use super::keys::PROFILE;
use crate::process::shaping::round_mesh::RoundMesh;
use crate::scene::build::sector_deg;
use crate::scene::model::{base_helix_cosine, transverse_pressure_angle_rad};
use crate::scene::values::Values;
use gearcut_core::gear::GearKind;

/// The stock beyond which no depth of the cutter gives it, normal to the flank, mm.
pub(super) enum StockLimit {
    /// Less is left by some depth.
    Most(f64),
    /// More is left by some depth.
    Least(f64),
}

/// Where an operation starts from: the finished flanks.
struct Finished {
    mesh: RoundMesh,
    /// alpha_n and alpha_t, rad.
    pressure_angles_rad: [f64; 2],
    /// Thickness on the reference circle of a stock of 1 on both flanks.
    thickness_of_stock: f64,
    /// Offset of the operation that finishes them.
    depth_mm: f64,
    /// Working pressure angle there; `None` where the base circles do not roll.
    working_rad: Option<f64>,
    /// Whether gear and cutter are involute ones with round pitch curves.
    is_round: bool,
}

/// How far the cutter stays back in an operation, mm: given, or from the stock on each flank.
pub(super) fn offset_mm(values: &Values, index: usize) -> Option<f64> {
    let path = format!("operation.{index}");
    let operation = values.view(&path);
    let Some(stock_mm) = operation.number("stock_per_flank_mm") else { return operation.number("offset_mm") };
    offset_for_mm(values, index, stock_mm)
}

/// How far the cutter stays back in an operation that leaves this stock on each flank, mm.
pub(super) fn offset_for_mm(values: &Values, index: usize, stock_mm: f64) -> Option<f64> {
    Some(Finished::of(values, index)?.offset_mm(stock_mm))
}

/// The end of what an operation can leave; `None` where there is none.
pub(super) fn limit(values: &Values, index: usize) -> Option<StockLimit> {
    let finished = Finished::of(values, index)?;
    let mesh = &finished.mesh;
    let room_mm = mesh.room_mm(finished.working_rad.filter(|_| finished.is_round)?) / finished.thickness_of_stock;
    Some(if mesh.thickens_to_limit() { StockLimit::Most(room_mm) } else { StockLimit::Least(-room_mm) })
}

impl Finished {
    fn of(values: &Values, index: usize) -> Option<Self> {
        let last = values.count("operation").checked_sub(1)?;
        let depth_mm = if index == last { 0.0 } else { offset_mm(values, last)? };
        let gear = values.view("gear");
        let (module_mm, normal_rad) = (gear.number("module_mm")?, gear.rad("pressure_angle_deg")?);
        let helix_rad = gear.rad("helix_angle_deg")?;
        let transverse_rad = transverse_pressure_angle_rad(normal_rad, helix_rad);
        let kind = if gear.text("kind")? == "internal" { GearKind::Internal } else { GearKind::External };
        let teeth = [teeth_per_turn(values)?, values.view("tool.shaper_cutter").whole("teeth")?];
        let mesh = RoundMesh::new(kind, module_mm / helix_rad.cos(), transverse_rad, teeth);
        let shift = |section: &str| values.view(section).number("profile_shift_coefficient");
        let shifts = shift("gear")? + shift("tool.shaper_cutter")?;
        let thicker_mm =
            2.0 * shifts * module_mm * transverse_rad.tan() + gear.number("tooth_thickness_allowance_mm")?;
        // Rounding moves nothing where the pitch curves touch.
        let drawn_rad =
            if thicker_mm == 0.0 { Some(transverse_rad) } else { mesh.thicker_rad(transverse_rad, thicker_mm) };
        let working_rad = match drawn_rad {
            Some(drawn_rad) if depth_mm != 0.0 => mesh.working_rad(mesh.offset_mm(drawn_rad) + depth_mm),
            drawn_rad => drawn_rad,
        };
        let is_circle = gear.variant("pitch_curve") == Some("circle") && sector_deg(values).is_none();
        Some(Self {
            mesh,
            pressure_angles_rad: [normal_rad, transverse_rad],
            thickness_of_stock: 2.0 / (transverse_rad.cos() * base_helix_cosine(normal_rad, helix_rad)),
            depth_mm,
            working_rad,
            is_round: is_circle && values.view(PROFILE).text("file").is_none(),
        })
    }

    fn offset_mm(&self, stock_mm: f64) -> f64 {
        let roughed = |working_rad: f64| {
            let roughed_rad = self.mesh.thicker_rad(working_rad, self.thickness_of_stock * stock_mm)?;
            Some(self.mesh.offset_mm(roughed_rad) - self.mesh.offset_mm(working_rad))
        };
        let exact = self.working_rad.filter(|_| self.is_round && stock_mm != 0.0).and_then(roughed);
        let [normal_rad, transverse_rad] = self.pressure_angles_rad;
        let steeper = self.working_rad.unwrap_or(transverse_rad).sin() / transverse_rad.sin();
        self.depth_mm + exact.unwrap_or_else(|| stock_mm / (normal_rad.sin() * steeper))
    }
}

/// Teeth that a whole turn has room for: strokes are counted over a turn.
pub(super) fn teeth_per_turn(values: &Values) -> Option<u32> {
    let teeth = values.view("gear").whole("teeth")?;
    let Some([from_deg, to_deg]) = sector_deg(values) else { return Some(teeth) };
    let turns = (to_deg - from_deg) / 360.0;
    Some(if turns > 0.0 { (f64::from(teeth) / turns).ceil().min(1e6) as u32 } else { teeth })
}
