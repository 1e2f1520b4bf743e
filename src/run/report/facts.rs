//! What was cut, with what, on which machine.

use crate::gear::PitchCurve;
use crate::job::{HobbingJob, Job};
use crate::output::report::{Block, Section, Table};
use crate::output::text::plain;
use crate::scene::model::{GashForm, Gear, Hobbing, Tip, Worm};
use crate::units::UM_PER_MM;

/// The gear in a line.
pub fn gear_words(gear: &Gear) -> String {
    let kind = match gear.helix_angle_rad {
        0.0 => "External spur gear".to_owned(),
        beta => format!("External helical gear, {:.4}° {}-hand", beta.to_degrees(), gear.hand.name()),
    };
    format!(
        "{kind}, {} teeth, module {} mm, pressure angle {}°, face width {} mm; pitch curve: {}",
        gear.teeth,
        plain(gear.module_mm),
        plain(gear.pressure_angle_rad.to_degrees()),
        plain(gear.face_width_mm),
        gear.pitch_curve.words(),
    )
}

fn table(caption: &str, rows: Vec<(&str, String)>) -> Block {
    Block::Table(Table {
        caption: caption.to_owned(),
        columns: Vec::new(),
        rows: rows.into_iter().map(|(name, value)| vec![name.to_owned(), value]).collect(),
    })
}

fn mm(value: f64) -> String {
    format!("{} mm", plain(value))
}

fn limit(value: Option<f64>, unit: &str) -> String {
    value.map_or_else(|| "not given".to_owned(), |v| format!("{} {unit}", plain(v)))
}

fn gear_table(gear: &Gear, curve: &PitchCurve) -> Block {
    let facts = curve.facts();
    let shape = if facts.convex { "convex" } else { "concave in places" };
    table(
        "Gear",
        vec![
            ("Pitch curve", gear.pitch_curve.words()),
            ("Pitch radius", format!("{:.3} to {:.3} mm", facts.smallest_radius_mm, facts.largest_radius_mm)),
            ("Smallest radius of curvature", format!("{:.3} mm, {shape}", facts.smallest_curvature_radius_mm)),
            ("Closing error of the curve", format!("{:.4} µm", UM_PER_MM * curve.closure_error_mm()).replace('-', "−")),
            ("Module, teeth", format!("{}, {}", mm(gear.module_mm), gear.teeth)),
            ("Pressure angle", format!("{}°", plain(gear.pressure_angle_rad.to_degrees()))),
            ("Face width", mm(gear.face_width_mm)),
            ("Bore", if gear.bore_diameter_mm > 0.0 { mm(gear.bore_diameter_mm) } else { "none".to_owned() }),
            ("Addendum", format!("{} m", plain(gear.addendum_coefficient))),
            ("Thickness allowance", format!("{} µm", plain(UM_PER_MM * gear.tooth_thickness_allowance_mm))),
        ],
    )
}

/// Tables of gear, hob and machine.
pub fn hobbing_section(job: &HobbingJob) -> Section {
    let hob = &job.hob;
    let Some(Hobbing { tool, limits, .. }) = job.scene.hobbing() else {
        return Section {
            id: "setup",
            title: "What was cut, and how".to_owned(),
            lead: String::new(),
            blocks: Vec::new(),
        };
    };
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
