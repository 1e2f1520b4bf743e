//! What was shaped, with what, on which machine.

use crate::findings::Findings;
use crate::output::report::PageSection;
use crate::output::text::plain;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::linkage::dynamics::{self, AXES};
use crate::process::shaping::scene::model::{EdgeRoughness, Retraction, Tip};
use crate::steps::report::facts::{gear_table, mm, round_gear_table, speed_limits, table};
use crate::steps::report::machine_errors::errors_table;
use gearcut_core::units::UM_PER_MM;

/// Tables of gear, cutter and machine.
pub fn section(job: &ShapingJob, found: &Findings) -> PageSection {
    let (tool, machine) = (&job.cutter_spec, &job.machine);
    let tip = match tool.tip {
        Tip::Sharp => "sharp corners".to_owned(),
        Tip::Round { radius_mm } => format!("rounds of {}", mm(radius_mm)),
        Tip::Chamfer { height_mm, angle_rad } => {
            format!("chamfers {} high at {}°", mm(height_mm), plain(angle_rad.to_degrees()))
        }
    };
    let edges = match &tool.edge_roughness {
        None => "smooth".to_owned(),
        Some(EdgeRoughness::Spectrum { rq_mm, correlation_mm, seed }) => {
            let [rq_um, correlation_um] = [rq_mm, correlation_mm].map(|mm| plain(UM_PER_MM * mm));
            format!("rough: Rq {rq_um} µm, correlation length {correlation_um} µm, seed {seed}")
        }
        Some(EdgeRoughness::Profile(path)) => format!("rough: profile {}", path.display()),
    };
    let edges = match &tool.edge_rounding {
        None => edges,
        Some(rounding) => {
            let [radius_um, chip_um] = [rounding.radius_mm, rounding.minimum_chip_mm()].map(|mm| plain(UM_PER_MM * mm));
            let recovery = plain(rounding.recovery_share);
            format!("{edges}; radius {radius_um} µm, thinnest chip {chip_um} µm, share that springs back {recovery}")
        }
    };
    let back_off = match machine.retraction {
        Retraction::CenterLine => mm(machine.back_off_mm),
        other => format!("{} {}", mm(machine.back_off_mm), other.words()),
    };
    let mut blocks = vec![gear_table(&job.scene.gear, &job.curve)];
    blocks.extend(round_gear_table(found));
    blocks.extend([
        table(
            "Shaper cutter",
            vec![
                ("Teeth, pitch radius", format!("{}, {}", tool.teeth, mm(job.cutter.pitch_radius_mm))),
                (
                    "Addendum, dedendum",
                    format!("{} m, {} m", plain(tool.addendum_coefficient), plain(tool.dedendum_coefficient)),
                ),
                ("Profile shift", format!("{} m", plain(tool.profile_shift_coefficient))),
                ("Thinning", format!("{} µm", plain(UM_PER_MM * tool.thinning_mm))),
                ("Tip", tip),
                ("Cutting edges", edges),
                ("Top rake", format!("{}°", plain(tool.rake_angle_rad.to_degrees()))),
                ("Runout", format!("{} µm", plain(UM_PER_MM * tool.runout_mm))),
                (
                    "Pitch errors",
                    if tool.pitch_errors_mm.is_empty() { "none".to_owned() } else { "given for each tooth".to_owned() },
                ),
            ],
        ),
        table(
            "Machine",
            vec![
                ("Double strokes", format!("{} per minute", plain(machine.double_strokes_per_minute))),
                ("Approach, overrun", format!("{}, {}", mm(machine.approach_mm), mm(machine.overrun_mm))),
                ("Back-off on the return stroke", back_off),
                (
                    "Speed limits",
                    speed_limits(["work", "cutter", "centre distance"], &AXES, &dynamics::limits(&machine.limits)),
                ),
            ],
        ),
    ]);
    blocks.extend(errors_table(&machine.errors, &AXES, None));
    PageSection { id: "setup", title: "What was cut, and how".to_owned(), lead: String::new(), blocks }
}
