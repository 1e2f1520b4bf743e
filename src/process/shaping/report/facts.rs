//! What was shaped, with what, on which machine.

use crate::output::report::Section;
use crate::output::text::plain;
use crate::process::shaping::Job;
use crate::process::shaping::scene::model::Tip;
use crate::steps::report::facts::{gear_table, limit, mm, table};
use crate::units::UM_PER_MM;

/// Tables of gear, cutter and machine.
pub fn section(job: &Job) -> Section {
    let (tool, machine) = (&job.cutter_spec, &job.machine);
    let tip = match tool.tip {
        Tip::Sharp => "sharp corners".to_owned(),
        Tip::Round { radius_mm } => format!("rounds of {}", mm(radius_mm)),
        Tip::Chamfer { height_mm, angle_rad } => {
            format!("chamfers {} high at {}°", mm(height_mm), plain(angle_rad.to_degrees()))
        }
    };
    let blocks = vec![
        gear_table(&job.scene.gear, &job.curve),
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
                ("Back-off on the return stroke", mm(machine.back_off_mm)),
                ("Work eccentricity", format!("{} µm", plain(UM_PER_MM * machine.work_eccentricity_mm))),
                (
                    "Speed limits",
                    format!(
                        "work {}, cutter {}, centre distance {}",
                        limit(machine.limits.work_speed_rad_per_s.map(f64::to_degrees), "°/s"),
                        limit(machine.limits.cutter_speed_rad_per_s.map(f64::to_degrees), "°/s"),
                        limit(machine.limits.center_distance_speed_mm_per_s, "mm/s"),
                    ),
                ),
            ],
        ),
    ];
    Section { id: "setup", title: "What was cut, and how".to_owned(), lead: String::new(), blocks }
}
