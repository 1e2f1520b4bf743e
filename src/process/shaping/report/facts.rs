//! What was shaped, with what, on which machine.

use crate::drawn_tooth::drawn_words;
use crate::findings::{Findings, unit};
use crate::number_text::plain;
use crate::output::report::{PageSection, Tone};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::linkage::dynamics::{self, AXES};
use crate::process::shaping::scene::layers::{built_up_words, edge_words, rounding_words};
use crate::process::shaping::scene::model::{Retraction, Tip};
use crate::steps::report::facts::{gear_table, mm, round_gear_table, speed_limits, table};
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
    let rough = |edge| format!("rough: {}", unit::sentence_with_signs(&edge_words(edge)));
    let edges = tool.edge_roughness.as_ref().map_or_else(|| "smooth".to_owned(), rough);
    let others = [tool.edge_rounding.as_ref().map(rounding_words), tool.built_up_edge.as_ref().map(built_up_words)];
    let others = others.iter().flatten().map(|words| unit::sentence_with_signs(words));
    let edges = std::iter::once(edges).chain(others).collect::<Vec<_>>().join("; ");
    let back_off = match machine.retraction {
        Retraction::CenterLine => mm(machine.back_off_mm),
        other => format!("{} {}", mm(machine.back_off_mm), other.words()),
    };
    // A contour has the digits of its file.
    let round = |radius_mm: f64| (1e5 * radius_mm).round() / 1e5;
    let own = match job.cutter.drawn() {
        None => vec![
            (
                "Addendum, dedendum",
                format!("{} m, {} m", plain(tool.addendum_coefficient), plain(tool.dedendum_coefficient)),
            ),
            ("Profile shift", format!("{} m", plain(tool.profile_shift_coefficient))),
            ("Thinning", format!("{} µm", plain(UM_PER_MM * tool.thinning_mm))),
            ("Tip", tip),
        ],
        Some(tooth) => vec![
            ("Tip radius, root radius", format!("{}, {}", mm(round(tooth.reach_mm[1])), mm(round(tooth.reach_mm[0])))),
            ("Tooth", unit::sentence_with_signs(&drawn_words(tooth))),
        ],
    };
    let own =
        [vec![("Teeth, pitch radius", format!("{}, {}", tool.teeth, mm(job.cutter.pitch_radius_mm)))], own].concat();
    let of_all = vec![
        ("Cutting edges", edges),
        ("Top rake", format!("{}°", plain(tool.rake_angle_rad.to_degrees()))),
        ("Runout", format!("{} µm", plain(UM_PER_MM * tool.runout_mm))),
        (
            "Pitch errors",
            if tool.pitch_errors_mm.is_empty() { "none".to_owned() } else { "given for each tooth".to_owned() },
        ),
    ];
    let mut blocks = vec![gear_table(&job.scene, &job.curve)];
    blocks.extend(round_gear_table(found));
    blocks.extend([
        table("Shaper cutter", [own, of_all].concat()),
        table(
            "Machine",
            [
                ("Double strokes", format!("{} per minute", plain(machine.double_strokes_per_minute))),
                ("Approach, overrun", format!("{}, {}", mm(machine.approach_mm), mm(machine.overrun_mm))),
                ("Back-off on the return stroke", back_off),
            ]
            .into_iter()
            .chain(
                job.helix
                    .map(|helix| ("Helical guide", format!("lead {}, {}-hand", mm(helix.lead_mm), helix.hand.name()))),
            )
            .chain([(
                "Speed limits",
                speed_limits(["work", "cutter", "centre distance"], &AXES, &dynamics::limits(&machine.limits)),
            )])
            .collect(),
        ),
    ]);
    PageSection::new("setup", "What was cut, and how", "", blocks).judged(Tone::Aside, "gear, cutter, machine")
}
