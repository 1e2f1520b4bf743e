//! Layers of errors that only shaping has: when each is there, what it is in words, how it is switched off.
//!
//! In: a scene's model. Out: the table [`OWN`], from which `gearcut scatter` switches and the findings tell. What all
//! machines have is in [`crate::machine_errors`].

use super::model::{BuiltUpEdge, EdgeRoughness, EdgeRounding, Grinding, MachineVibration, Shaping};
use crate::machine_errors::{Compliance, ErrorLayer};
use crate::number_text::{plain, size, um};
use gearcut_core::units::UM_PER_MM;

/// A layer of shaping's own.
pub struct OwnLayer {
    /// Which.
    pub layer: ErrorLayer,
    /// What it is, with the sizes of its keys and the sine of the pressure angle; empty where it is not there.
    words: fn(&Shaping, f64) -> String,
    /// Switches it off.
    pub off: fn(&mut Shaping),
}

impl OwnLayer {
    /// Whether a scene has it.
    pub fn is_on(&self, model: &Shaping) -> bool {
        !self.words(model, 1.0).is_empty()
    }

    /// What it is; empty where it is not there.
    pub fn words(&self, model: &Shaping, pressure_angle_sine: f64) -> String {
        (self.words)(model, pressure_angle_sine)
    }
}

/// All of them.
pub static OWN: [OwnLayer; 6] = [
    OwnLayer {
        layer: ErrorLayer::Tool,
        words: |model, _| {
            let mut words = um("runout", model.tool.runout_mm);
            if model.tool.pitch_errors_mm.iter().any(|&error| error != 0.0) {
                words.push("pitch errors given for each tooth".to_owned());
            }
            words.extend(model.tool.grinding.map(|grinding| grinding_words(&grinding, model.tool.rake_angle_rad)));
            words.join(", ")
        },
        off: |model| {
            model.tool.grinding = None;
            model.tool.runout_mm = 0.0;
            model.tool.pitch_errors_mm.clear();
        },
    },
    OwnLayer {
        layer: ErrorLayer::Stock,
        words: |model, sine| {
            let stock = model.operations.iter().filter_map(|operation| {
                let scatter = operation.stock_scatter.as_ref()?;
                let over =
                    scatter.length_mm.map_or("from stroke to stroke".to_owned(), |mm| format!("over {} mm", plain(mm)));
                let name = format!("{}:", operation.name);
                let size = size(&name, scatter.deviation_mm * sine * UM_PER_MM, "um on flanks");
                Some(format!("{} {over}", size.concat()))
            });
            stock.collect::<Vec<_>>().join("; ")
        },
        off: |model| model.operations.iter_mut().for_each(|operation| operation.stock_scatter = None),
    },
    OwnLayer {
        layer: ErrorLayer::Edge,
        words: |model, _| model.tool.edge_roughness.as_ref().map_or_else(String::new, edge_words),
        off: |model| model.tool.edge_roughness = None,
    },
    OwnLayer {
        layer: ErrorLayer::Ploughing,
        words: |model, _| model.tool.edge_rounding.as_ref().map_or_else(String::new, rounding_words),
        off: |model| model.tool.edge_rounding = None,
    },
    OwnLayer {
        layer: ErrorLayer::Tearing,
        words: |model, _| model.tool.built_up_edge.as_ref().map_or_else(String::new, built_up_words),
        off: |model| model.tool.built_up_edge = None,
    },
    OwnLayer {
        layer: ErrorLayer::Deflection,
        words: |model, _| {
            let compliance = compliance_words(&model.machine.compliance);
            let vibration = model.machine.vibration.map(|of| vibration_words(&of));
            [Some(compliance), vibration].into_iter().flatten().collect::<Vec<_>>().join(", ")
        },
        off: |model| {
            model.machine.compliance = Compliance::default();
            model.machine.vibration = None;
        },
    },
];

/// How flanks are ground.
fn grinding_words(grinding: &Grinding, rake_rad: f64) -> String {
    let [rake, relief] = [rake_rad, grinding.tip_relief_rad].map(|rad| plain(round_deg(rad)));
    let angle = grinding.pressure_angle_rad.map_or_else(
        || "a corrected pressure angle".to_owned(),
        |rad| format!("a pressure angle of {} deg", plain(round_deg(rad))),
    );
    format!("ground with {angle}, rake {rake} deg, tip relief {relief} deg")
}

/// An angle as a scene wrote it.
fn round_deg(rad: f64) -> f64 {
    (1e9 * rad.to_degrees()).round() / 1e9
}

/// A rough edge.
pub fn edge_words(edge: &EdgeRoughness) -> String {
    match edge {
        EdgeRoughness::Spectrum { rq_mm, correlation_mm, seed } => {
            let [rq_um, correlation_um] = [rq_mm, correlation_mm].map(|mm| plain(UM_PER_MM * mm));
            format!("Rq {rq_um} um, correlation length {correlation_um} um, seed {seed}")
        }
        EdgeRoughness::Profile(path) => format!("profile {}", path.display()),
    }
}

/// A rounded edge.
pub fn rounding_words(rounding: &EdgeRounding) -> String {
    let [radius_um, chip_um] = [rounding.radius_mm, rounding.minimum_chip_mm()].map(|mm| plain(UM_PER_MM * mm));
    let recovery = plain(rounding.recovery_share);
    format!("radius {radius_um} um, thinnest chip {chip_um} um, share that springs back {recovery}")
}

/// mm/s as m/min.
const M_PER_MIN: f64 = 0.06;

/// A built-up edge.
pub fn built_up_words(edge: &BuiltUpEdge) -> String {
    let [depth_um, width_um, length_um] =
        [edge.depth_mm, edge.width_mm, edge.scratch_length_mm].map(|mm| plain(UM_PER_MM * mm));
    let [from, _, _, to] = edge.speeds_mm_per_s.map(|speed| plain(M_PER_MIN * speed));
    format!(
        "up to {} marks to a mm^2 between {from} and {to} m/min, {depth_um} um deep in the mean, {width_um} um wide, \
         {} % of them scratches of {length_um} um",
        plain(edge.density_per_mm2),
        plain(100.0 * edge.scratch_share)
    )
}

/// mm/N as um/kN, rad/(N mm) as urad/(N m).
const UM_PER_KN: f64 = 1e6;
const URAD_PER_NM: f64 = 1e9;

fn vibration_words(vibration: &MachineVibration) -> String {
    let MachineVibration { axis, natural_frequency_hz, damping_ratio } = vibration;
    let name = MachineVibration::AXES[*axis].replace('_', ", ");
    format!("vibration ({name}) of {} Hz, damping ratio {}", plain(*natural_frequency_hz), plain(*damping_ratio))
}

fn compliance_words(compliance: &Compliance) -> String {
    let sides = [("cutter", compliance.tool), ("work", compliance.work)].map(|(name, side)| {
        [
            size(&format!("{name} radially"), side.radial_mm_per_n * UM_PER_KN, "um/kN"),
            size(&format!("{name} tangentially"), side.tangential_mm_per_n * UM_PER_KN, "um/kN"),
            size(&format!("{name} spindle"), side.torsional_rad_per_nmm * URAD_PER_NM, "urad/(N m)"),
        ]
        .concat()
    });
    sides.concat().join(", ")
}
