//! What was hobbed, with what, on which machine.

use crate::drawn_tooth::drawn_words;
use crate::findings::{Findings, unit};
use crate::number_text::plain;
use crate::output::report::{PageSection, Tone};
use crate::process::hobbing::HobbingJob;
use crate::process::hobbing::linkage::dynamics::{self, AXES};
use crate::process::hobbing::scene::model::{GashForm, Worm};
use crate::steps::report::facts::{gear_table, mm, round_gear_table, speed_limits, table};

/// Tables of gear, hob and machine.
pub fn section(job: &HobbingJob, found: &Findings) -> PageSection {
    let (hob, tool, limits) = (&job.hob, &job.hob_spec, &job.limits);
    let worm = match (tool.worm, hob.drawn()) {
        (Worm::Involute, None) => "involute worm (ZI)",
        (Worm::StraightSided, None) => "straight-sided in the axial section",
        (Worm::Involute, Some(_)) => "drawn, on a thread that generates with it",
        (Worm::StraightSided, Some(_)) => "drawn, itself in the axial section",
    };
    let rack = match hob.drawn() {
        None => vec![
            (
                "Addendum, dedendum",
                format!("{} m, {} m", plain(tool.addendum_coefficient), plain(tool.dedendum_coefficient)),
            ),
            ("Tip round", mm(tool.tip_radius_mm)),
        ],
        Some(tooth) => vec![
            ("Addendum, dedendum", format!("{}, {}", mm(tooth.reach_mm[1]), mm(-tooth.reach_mm[0]))),
            ("Tooth", unit::sentence_with_signs(&drawn_words(tooth))),
        ],
    };
    let gashes = match tool.gash_form {
        GashForm::Axial => "axial",
        GashForm::Helical => "across the thread",
    };
    let names = ["hob", "work", "X", "Y", "slide", "shift"];
    let speeds = speed_limits(names, &AXES, &dynamics::limits(limits));
    let mut blocks = vec![gear_table(&job.scene, &job.curve)];
    blocks.extend(round_gear_table(found));
    blocks.extend([
        table(
            "Hob",
            vec![
                ("Starts, hand", format!("{}, {}", hob.starts, tool.hand.name())),
                ("Gashes", format!("{}, {gashes}", hob.gashes)),
                ("Lead angle", format!("{:.4}°", hob.lead_angle_rad.to_degrees())),
                (
                    "Pitch diameter, tip diameter",
                    format!("{:.3} mm, {:.3} mm", 2.0 * hob.pitch_radius_mm, 2.0 * hob.tip_radius_mm),
                ),
                ("Length", mm(hob.length_mm)),
                ("Teeth", format!("{}, one every {:.4} mm along a thread", hob.teeth.len(), hob.tooth_spacing_mm())),
                ("Basic rack", worm.to_owned()),
            ]
            .into_iter()
            .chain(rack)
            .chain([("Reground by", mm(tool.regrind_mm))])
            .collect(),
        ),
        table("Machine", vec![("Speed limits", speeds)]),
    ]);
    let [from, to] = job.scene.measure.heights_mm();
    if from.is_some() || to.is_some() {
        let from = from.map_or_else(|| "the form point, 5 % left out".to_owned(), mm);
        let to = to.map_or_else(|| "the tip, 5 % left out".to_owned(), mm);
        blocks.push(table("Measured", vec![("Evaluated profile over the pitch curve", format!("{from} to {to}"))]));
    }
    if let Some(force) = job.material {
        let coefficients =
            format!("K_c {} N/mm², K_ce {} N/mm", plain(force.per_area_n_per_mm2), plain(force.per_length_n_per_mm));
        blocks.push(table("Material", vec![("Cutting force", coefficients)]));
    }
    PageSection::new("setup", "What was cut, and how", "", blocks).judged(Tone::Aside, "gear, hob, machine")
}
