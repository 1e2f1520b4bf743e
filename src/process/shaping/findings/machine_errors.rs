//! What shaping knows of errors beyond those of every machine, in words: cutter, stock, edges, compliance.

use crate::findings::Section;
use crate::machine_errors::{Compliance, ErrorLayer};
use crate::output::text::plain;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::linkage::dynamics::AXES;
use crate::process::shaping::scene::model::{EdgeRoughness, EdgeRounding, Shaping};
use crate::steps::machine_errors::{section, size, um};
use gearcut_core::units::UM_PER_MM;

/// The layers that are on; none of an ideal machine.
pub fn errors(job: &ShapingJob) -> Option<Section> {
    let model = Shaping::of(&job.scene)?;
    let mut tool = um("runout", model.tool.runout_mm);
    if model.tool.pitch_errors_mm.iter().any(|&error| error != 0.0) {
        tool.push("pitch errors given for each tooth".to_owned());
    }
    let sine = job.scene.gear.pressure_angle_rad.sin();
    let stock = model.operations.iter().filter_map(|operation| {
        let scatter = operation.stock_scatter.as_ref()?;
        let where_to =
            scatter.length_mm.map_or("from stroke to stroke".to_owned(), |mm| format!("over {} mm", plain(mm)));
        let size = size(&format!("{}:", operation.name), scatter.deviation_mm * sine * UM_PER_MM, "um on flanks");
        Some(format!("{} {where_to}", size.concat()))
    });
    let own = [
        (ErrorLayer::Tool, tool.join(", ")),
        (ErrorLayer::Stock, stock.collect::<Vec<_>>().join("; ")),
        (ErrorLayer::Edge, model.tool.edge_roughness.as_ref().map_or_else(String::new, edge_words)),
        (ErrorLayer::Ploughing, model.tool.edge_rounding.as_ref().map_or_else(String::new, rounding_words)),
        (ErrorLayer::Deflection, compliance_words(&model.machine.compliance)),
    ];
    section(&model.machine.errors, &AXES, &own)
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

/// mm/N as um/kN, rad/(N mm) as urad/(N m).
const UM_PER_KN: f64 = 1e6;
const URAD_PER_NM: f64 = 1e9;

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::load;
    use std::path::Path;

    /// Layers of a scene and their words.
    fn layers(scene: &str) -> Vec<(String, String)> {
        let loaded = load(Path::new(&format!("scenes/shaping/{scene}.toml")), &[]).expect("a scene");
        let job = ShapingJob::new(loaded.scene).expect("a job");
        let known = job.scene.process.error_layers();
        let found = errors(&job).map_or_else(Vec::new, |section| section.entries);
        let names: Vec<&str> = found.iter().map(|entry| entry.key.as_str()).collect();
        assert_eq!(names, known.iter().map(|layer| layer.name()).collect::<Vec<_>>(), "{scene}");
        found.iter().map(|entry| (entry.key.clone(), entry.quantity.words().unwrap_or_default().to_owned())).collect()
    }

    #[test]
    fn layers_that_are_on_are_told_with_the_sizes_of_their_keys() {
        assert!(layers("circular_m3_z24").is_empty(), "an ideal machine has none");
        let pair = |key: &str, words: &str| (key.to_owned(), words.to_owned());
        let noise = layers("noise");
        let radial = "0.5 um in every stroke";
        assert!(noise[0].0 == "noise" && noise[0].1.contains(radial) && noise[0].1.contains("1 arcsec up to 0.05 Hz"));
        assert_eq!(noise[1], pair("stock", "rough: 15 um on flanks over 20 mm"));
        assert_eq!(noise[2], pair("edge", "Rq 0.3 um, correlation length 25 um, seed 1"));
        let compliance = "cutter radially 8 um/kN, cutter tangentially 8 um/kN, cutter spindle 1 urad/(N m), work \
            radially 4 um/kN, work tangentially 4 um/kN, work spindle 0.5 urad/(N m)";
        assert_eq!(layers("deflection"), [pair("deflection", compliance)]);
        let rounded = layers("ploughing");
        assert!(rounded.last().is_some_and(|(key, words)| key == "ploughing" && words.contains("thinnest chip")));
        let lags = "work spindle: wave of 6 arcsec, wave of 2 arcsec, K_v 30 /s, 0 % fed forward; cutter spindle: K_v \
            33 /s, 0 % fed forward; centre distance: backlash 4 um, K_v 30 /s, 0 % fed forward, drift 30 um/h at first";
        let errors = [
            pair("axes", lags),
            pair("guide", "sideways 25 um in 100 mm; bow radially 2 um"),
            pair("mounting", "eccentricity 5 um; wobble 10 um in 100 mm"),
            pair("tool", "runout 3 um"),
        ];
        assert_eq!(layers("machine_errors"), errors);
    }
}
