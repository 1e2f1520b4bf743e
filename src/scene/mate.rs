//! The scene of the gear that runs with a scene's own.
//!
//! In: the driver's loaded scene, the mate's number of teeth, and whether its teeth stand outside or inside. Out: a
//! scene as TOML. Its pitch curve is the mate of the driver's (`[gear.pitch_curve.mate]`, whose reader solves the
//! distance of the axes); module, pressure angle, tool, machine and operations are the driver's, so that both gears are
//! cut alike.
//!
//! Files that the driver's scene names are those of the mate: their paths lead there from the folder that the text is
//! meant for. What the driver's file writes otherwise is copied as written; what holds there by default holds here by
//! default. Counts per turn of the work grow with the number of teeth, so that the feed per tooth stays. A helix
//! changes its hand on an external mate and keeps it on a ring; a profile shift changes its sign. Left out is what
//! belongs to the driver alone: its bore on a ring, places on its teeth (`[[texture]]`, `[[picture]]`, windows),
//! how it is clamped (`[mounting]`), programs and the name of its folder.

use std::fmt::Write as _;
use std::path::Path;

use super::files::WayToFiles;
use super::keys::{Kind, Role, join};
use super::table::{KeyTable, TableSection};
use super::values::Checked;
use super::write::{value_text, walk_sections};
use super::{LoadedScene, SceneProcess};
use gearcut_core::error::Refusal;
use gearcut_core::gear::{Driver, GearKind, PitchCurve, PitchCurveShape};
use gearcut_core::terms::Hand;

/// Keys of `[gear]` that do not pass from the driver to its mate as they are.
const OWN_OF_GEAR: [&str; 5] = ["kind", "teeth", "hand", "rim_mm", "profile_shift_coefficient"];
/// Beginning of the paths of operations among the values.
const OPERATIONS: &str = "operation.";
/// Outermost tables of the driver alone: places on its teeth, and how it is clamped.
const OWN: [&str; 3] = ["texture[]", "picture[]", "mounting"];

/// The gear that is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mate {
    /// Its number of teeth.
    pub teeth: u32,
    /// External, or a ring.
    pub kind: GearKind,
}

/// Scene of a mate.
#[derive(Debug, Clone, PartialEq)]
pub struct MateScene {
    /// The scene as TOML.
    pub text: String,
    /// Distance of the axes of the two gears, mm.
    pub center_distance_mm: f64,
}

impl LoadedScene {
    /// The scene of the gear that runs with this scene's gear, as text for a file in `folder`.
    ///
    /// # Errors
    /// This gear is a ring or a mate itself; no gear with so many teeth runs with it and closes; a file that no path
    /// in the text can name.
    pub fn mate(&self, mate: Mate, folder: &Path) -> Result<MateScene, Refusal> {
        let gear = &self.scene.gear;
        if !KeyTable::new(&[self.scene.process.process()]).knows("gear.pitch_curve") {
            return Err(Refusal::new(
                "gear",
                "this gear rolls on no pitch curve, and a mate's curve follows from its driver's",
                "write the scene of the mate with its own cones and settings",
            ));
        }
        if gear.kind == GearKind::Internal {
            return Err(Refusal::new(
                "gear.kind",
                "the driver of a pair is an external gear, and this scene's is internal",
                "give the scene of the external gear, and make the mate with --internal",
            ));
        }
        if matches!(gear.pitch_curve, PitchCurveShape::Sector { .. }) {
            return Err(Refusal::new(
                "gear.sector_deg",
                "a mate's law follows from its driver's whole turn, and this gear has teeth on a part of it alone",
                "write the mate's scene with a sector_deg and its own law: r2 = a - r1 after equal arcs",
            ));
        }
        if matches!(gear.pitch_curve, PitchCurveShape::Mate { .. }) {
            return Err(Refusal::new(
                "gear.pitch_curve.mate",
                "this gear is a mate itself: its curve follows from its driver",
                "give the driver's scene",
            ));
        }
        let driver = Driver { curve: gear.pitch_curve.clone(), teeth: gear.teeth, start_rad: None };
        let shape = PitchCurveShape::Mate { driver: Box::new(driver), kind: mate.kind };
        let curve = PitchCurve::new(&shape, gear.transverse_module_mm(), mate.teeth)?;
        let files = WayToFiles::new(folder, self.base_dir());
        let text = Writer { driver: self, mate, files }.text()?;
        Ok(MateScene { text, center_distance_mm: curve.size_mm() })
    }
}

struct Writer<'a> {
    driver: &'a LoadedScene,
    mate: Mate,
    files: WayToFiles<'a>,
}

impl Writer<'_> {
    fn text(&self) -> Result<String, Refusal> {
        let process = self.driver.scene.process.process();
        let own = KeyTable::new(&[process]);
        let mut out = format!(
            "# The gear that runs with {}, written by gearcut {}: the distance of the axes is solved so that it \
             closes.\n\
             # Tool, machine and operations are the driver's; what belongs to the driver's teeth alone is left out.\n",
            self.driver.scene.name,
            env!("CARGO_PKG_VERSION"),
        );
        let sections = own.sections().iter().filter(|section| !OWN.iter().any(|list| section.path.starts_with(list)));
        let mut written = Ok(());
        walk_sections(sections, &self.driver.values, |section, path| {
            if written.is_ok() {
                written = self.section(&mut out, process, section, path);
            }
        });
        written.map(|()| out)
    }

    /// What the driver's file writes of a section that stands at `path` there.
    fn section(
        &self,
        out: &mut String,
        process: &SceneProcess,
        section: &TableSection,
        path: &str,
    ) -> Result<(), Refusal> {
        let implied = self.is_implied(path);
        if implied && !self.driver.values.is_any_set(OPERATIONS) {
            return Ok(());
        }
        let mut lines = self.lines(process, section, path)?;
        let header = match section.path.strip_prefix("gear.pitch_curve") {
            Some("") => {
                let teeth = self.driver.scene.gear.teeth;
                let _ = write!(out, "\n[gear.pitch_curve.mate]\ndriver_teeth = {teeth}\n");
                return Ok(());
            }
            Some(curve) => format!("[gear.pitch_curve.mate.driver{curve}]"),
            None => section.header(),
        };
        if path == "gear" {
            let kind = if self.mate.kind == GearKind::Internal { "kind = \"internal\"\n" } else { "" };
            lines = format!("{kind}teeth = {}\n{lines}{}{}", self.mate.teeth, self.hand(), self.shift());
        }
        // An element of a list stands there even where it is one by default: its variants need it.
        let stands = matches!(section.role, Role::Variant | Role::List { .. });
        if self.holds(section, path) && (!lines.is_empty() || stands) {
            let _ = write!(out, "\n{header}\n{lines}");
        }
        Ok(())
    }

    /// Whether a path lies in an operation that the process put in, because the driver's file lists none. Without a
    /// setting the mate's process puts in the same; with one, all of it is written.
    fn is_implied(&self, path: &str) -> bool {
        let Some(rest) = path.strip_prefix(OPERATIONS) else { return false };
        let number = rest.split('.').next().unwrap_or_default();
        !self.driver.values.has_section(&format!("{OPERATIONS}{number}"))
    }

    /// Whether the section is the variant that holds, or no variant.
    fn holds(&self, section: &TableSection, path: &str) -> bool {
        let choice = path.rsplit_once('.').map_or("", |(choice, _)| choice);
        section.role != Role::Variant || self.driver.values.variants.get(choice) == Some(&section.name())
    }

    /// The lines of the section's keys that are written and pass to the mate.
    fn lines(&self, process: &SceneProcess, section: &TableSection, path: &str) -> Result<String, Refusal> {
        let values = &self.driver.values;
        let bore = |name: &str| name == "bore_diameter_mm" && self.mate.kind == GearKind::Internal;
        let stays = |name: &str| match section.path {
            "gear" => OWN_OF_GEAR.contains(&name) || bore(name),
            "output" => name == "folder",
            "report" => name != "paper",
            // Balls fit the driver's spaces.
            "measure" => name == "ball_diameter_mm",
            "operation[]" if name == "program" => true,
            _ => process.of_one_gear.contains(&name),
        };
        // Points that were read from a file stand for the file, which may lie in another folder.
        let points_read = |name: &str| name == "file" && values.held.contains_key(&join(path, "points_deg_mm"));
        let implied = self.is_implied(path);
        let mut lines = String::new();
        for key in section.keys.iter().filter(|key| !stays(key.name) && !points_read(key.name)) {
            let Some(held) = values.held.get(&join(path, key.name)) else { continue };
            if !(held.is_written() || implied && !held.value.holds_by_itself(key.default)) {
                continue;
            }
            let value = match held.value {
                // All other paths than that of the results are of files beside the scene.
                Checked::Text(ref name) if matches!(key.kind, Kind::Path) => {
                    Checked::Text(self.files.path_of(name, &join(path, key.name))?)
                }
                Checked::Whole(count) if process.per_revolution.contains(&key.name) => {
                    Checked::Whole(self.scaled(count))
                }
                ref value => value.clone(),
            };
            let _ = writeln!(lines, "{} = {}", key.name, value_text(&value));
        }
        Ok(lines)
    }

    /// A count per turn of the driver for the mate.
    fn scaled(&self, count: u32) -> u32 {
        let per_tooth = f64::from(count) / f64::from(self.driver.scene.gear.teeth);
        (per_tooth * f64::from(self.mate.teeth)).round() as u32
    }

    /// The opposite profile shift: both gears then roll on their pitch curves without backlash.
    fn shift(&self) -> String {
        match self.driver.scene.gear.profile_shift_coefficient {
            0.0 => String::new(),
            shift => format!("profile_shift_coefficient = {:?}\n", -shift),
        }
    }

    /// The hand of a helix, opposite to the driver's outside and equal inside.
    fn hand(&self) -> String {
        let gear = &self.driver.scene.gear;
        if gear.helix_angle_rad == 0.0 {
            return String::new();
        }
        let opposite = self.mate.kind == GearKind::External;
        let left = (gear.hand == Hand::Left) != opposite;
        format!("hand = \"{}\"\n", if left { "left" } else { "right" })
    }
}
