//! What was cut: the gear in words and as a table.

use crate::findings::Findings;
use crate::findings::quantities::sizes::SIZES;
use crate::machine::{Axis, Limits, Order};
use crate::number_text::plain;
use crate::output::report::{Block, PageTable};
use crate::scene::Scene;
use crate::steps::inspection;
use gearcut_core::gear::{GearKind, PitchCurve};
use gearcut_core::units::UM_PER_MM;

/// The gear in a line.
pub fn gear_words(scene: &Scene) -> String {
    let gear = &scene.gear;
    let kind = match gear.kind {
        GearKind::External => "External",
        GearKind::Internal => "Internal",
    };
    let kind = match gear.helix_angle_rad {
        0.0 => format!("{kind} spur gear"),
        beta => format!("{kind} helical gear, {:.4}° {}-hand", beta.to_degrees(), gear.hand.name()),
    };
    format!(
        "{kind}, {} teeth, module {} mm, {}, face width {} mm; pitch curve: {}",
        gear.teeth,
        plain(gear.module_mm),
        if is_drawn(scene) { "drawn teeth".to_owned() } else { format!("pressure angle {}", pressure_angle(scene)) },
        plain(gear.face_width_mm),
        gear.pitch_curve.words(),
    )
}

/// Whether the teeth follow a drawing: no pressure angle is theirs.
fn is_drawn(scene: &Scene) -> bool {
    scene.process.other_teeth_key().is_some()
}

fn pressure_angle(scene: &Scene) -> String {
    format!("{}°", plain(scene.gear.pressure_angle_rad.to_degrees()))
}

/// A table of names and values.
pub fn table(caption: &str, rows: Vec<(&str, String)>) -> Block {
    Block::Table(PageTable {
        caption: caption.to_owned(),
        columns: Vec::new(),
        rows: rows.into_iter().map(|(name, value)| vec![name.to_owned(), value]).collect(),
    })
}

/// Sizes of a round gear as a table; none of other gears.
pub fn round_gear_table(found: &Findings) -> Option<Block> {
    let sizes = found.group(&SIZES)?;
    Some(Block::Table(PageTable {
        caption: "Sizes of the round gear".to_owned(),
        columns: ["Size", "Sign", "Value"].map(str::to_owned).into(),
        rows: inspection::size_rows(sizes).into_iter().map(Into::into).collect(),
    }))
}

/// A length with its unit.
pub fn mm(value: f64) -> String {
    format!("{} mm", plain(value))
}

/// A limit, or that there is none.
fn limit(value: Option<f64>, unit: &str) -> String {
    value.map_or_else(|| "not given".to_owned(), |v| format!("{} {unit}", plain(v)))
}

/// Largest speeds of a machine's axes, each after the axis's name.
pub fn speed_limits<const N: usize>(names: [&str; N], axes: &[Axis; N], limits: &[Limits; N]) -> String {
    let one = |((name, axis), limits): ((&str, &Axis), &Limits)| {
        let speed = limits.of(Order::Speed).map(|speed| axis.kind.shown(speed));
        format!("{name} {}", limit(speed, axis.kind.sign(Order::Speed)))
    };
    names.into_iter().zip(axes).zip(limits).map(one).collect::<Vec<_>>().join(", ")
}

/// The gear as a table.
pub fn gear_table(scene: &Scene, curve: &PitchCurve) -> Block {
    let gear = &scene.gear;
    let facts = curve.facts();
    let shape = if facts.convex { "convex" } else { "concave in places" };
    let closing = match curve.sector_rad() {
        None => {
            let error_um = format!("{:.4} µm", UM_PER_MM * curve.closure_error_mm());
            ("Closing error of the curve", error_um.replace('-', "−"))
        }
        Some(_) => ("Dwell without teeth, radius", gear.dwell_radius_mm(curve).map_or_else(String::new, mm)),
    };
    table(
        "Gear",
        vec![
            ("Pitch curve", gear.pitch_curve.words()),
            ("Pitch radius", format!("{:.3} to {:.3} mm", facts.smallest_radius_mm, facts.largest_radius_mm)),
            ("Smallest radius of curvature", format!("{:.3} mm, {shape}", facts.smallest_curvature_radius_mm)),
            closing,
            ("Module, teeth", format!("{}, {}", mm(gear.module_mm), gear.teeth)),
            ("Pressure angle", if is_drawn(scene) { "none: drawn teeth".to_owned() } else { pressure_angle(scene) }),
            ("Face width", mm(gear.face_width_mm)),
            match gear.kind {
                GearKind::Internal => ("Rim outside the pitch curve", mm(gear.rim_mm)),
                GearKind::External if gear.bore_diameter_mm > 0.0 => ("Bore", mm(gear.bore_diameter_mm)),
                GearKind::External => ("Bore", "none".to_owned()),
            },
            ("Addendum", format!("{} m", plain(gear.addendum_coefficient))),
            ("Profile shift", format!("{} m", plain(gear.profile_shift_coefficient)).replace('-', "−")),
            ("Thickness allowance", format!("{} µm", plain(UM_PER_MM * gear.tooth_thickness_allowance_mm))),
        ],
    )
}
