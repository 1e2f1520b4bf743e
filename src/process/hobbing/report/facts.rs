//! What was hobbed, with what, on which machine.

use crate::output::report::Section;
use crate::output::text::plain;
use crate::process::hobbing::HobbingJob;
use crate::process::hobbing::scene::model::{GashForm, Worm};
use crate::steps::report::facts::{gear_table, limit, mm, table};

/// Tables of gear, hob and machine.
pub fn section(job: &HobbingJob) -> Section {
    let (hob, tool, limits) = (&job.hob, &job.hob_spec, &job.limits);
    let worm = match tool.worm {
        Worm::Involute => "involute worm (ZI)",
        Worm::StraightSided => "straight-sided in the axial section",
    };
    let gashes = match tool.gash_form {
        GashForm::Axial => "axial",
        GashForm::Helical => "across the thread",
    };
    let axes = ["hob", "work", "X", "Y", "slide", "shift"];
    let speeds = axes.iter().zip(limits.speeds).enumerate().map(|(i, (axis, value))| {
        let (value, unit) = if i < 2 { (value.map(f64::to_degrees), "°/s") } else { (value, "mm/s") };
        format!("{axis} {}", limit(value, unit))
    });
    let blocks = vec![
        gear_table(&job.scene.gear, &job.curve),
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
                (
                    "Addendum, dedendum",
                    format!("{} m, {} m", plain(tool.addendum_coefficient), plain(tool.dedendum_coefficient)),
                ),
                ("Tip round", mm(tool.tip_radius_mm)),
                ("Reground by", mm(tool.regrind_mm)),
            ],
        ),
        table("Machine", vec![("Speed limits", speeds.collect::<Vec<_>>().join(", "))]),
    ];
    Section { id: "setup", title: "What was cut, and how".to_owned(), lead: String::new(), blocks }
}
