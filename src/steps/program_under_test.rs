//! A program over time that is cut in place of the scene's own motion: what is said of it.
//!
//! In: how a process holds the program against its motion ([`ProgramUnderTest`]). Out: a section of the operation, and
//! the sentences of the list of warnings, graded as those on a shaper's programs are: what is further off than a
//! program may be is warned of, what is as deep as a gouge is a fault, and so is motion that is missing.

use crate::findings::{Place, Quantity, Section, Warning};
use crate::measure::damage::gouge_mm;
use crate::output::text::significant;
use gearcut_core::units::UM_PER_MM;

/// What the digits of a program leave of a displacement, mm.
const LAST_DIGIT_MM: f64 = 1e-6;
/// Shares of the motion that differ by less are the same: programs are written with nine digits of F.
const SAME_SHARE: f64 = 1e-6;

/// A program against the scene's own motion.
#[derive(Debug, Clone, PartialEq)]
pub struct ProgramUnderTest {
    /// Largest displacement of the tool in the work from the scene's own motion, mm.
    pub distance_mm: f64,
    /// When, s.
    pub at_s: f64,
    /// Share of the scene's motion that the program leaves out.
    pub missing: f64,
    /// Share of the scene's motion that it goes on beyond its ends.
    pub beyond: f64,
    /// Time of what both make, of the program and of the scene, s.
    pub time_s: [f64; 2],
    /// What it asks beyond the limits of the axes, a sentence each.
    pub exceeded: Vec<String>,
}

impl ProgramUnderTest {
    /// The section of its operation.
    pub fn section(&self) -> Section {
        let [program, scene] = self.time_s;
        let distance = "largest displacement of the tool in the work from the scene's own motion";
        Section::new("program", "Program under test")
            .shown(
                "largest_distance",
                "off the scene's motion",
                Quantity::number(UM_PER_MM * self.distance_mm, "um", distance)
                    .at(Place::default().and("time_s", self.at_s)),
            )
            .shown(
                "missing_share",
                "missing",
                Quantity::number(100.0 * self.missing, "%", "share of the scene's motion that the program leaves out"),
            )
            .with(
                "share_beyond",
                Quantity::number(100.0 * self.beyond, "%", "motion beyond the ends of the scene's, as a share of it"),
            )
            .with("time", Quantity::number(program, "s", "time of the program for what both make"))
            .with("scene_time", Quantity::number(scene, "s", "time of the scene for the same"))
    }

    /// What a reader must know of it; `name` is the operation's.
    pub fn warnings(&self, name: &str, asked_mm: f64, module_mm: f64) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if self.distance_mm > asked_mm + LAST_DIGIT_MM {
            let text = format!(
                "operation {name}: the program lies up to {} um off the scene's own motion, at {:.3} s; {} um are \
                 asked (output.gcode_contour_error_um)",
                significant(UM_PER_MM * self.distance_mm, 4),
                self.at_s,
                significant(UM_PER_MM * asked_mm, 3)
            );
            let is_gouge = self.distance_mm > gouge_mm(module_mm);
            warnings.push(if is_gouge { Warning::fault(text) } else { Warning::warn(text) });
        }
        let mut fault = |text: String| warnings.push(Warning::fault(format!("operation {name}: {text}")));
        for (share, verb) in [
            (self.missing, "leaves out, of the scene's own motion,"),
            (self.beyond, "goes beyond the scene's own motion by"),
        ] {
            if share > SAME_SHARE {
                fault(format!("the program {verb} {} %", significant(100.0 * share, 3)));
            }
        }
        let [program, scene] = self.time_s;
        if (program / scene - 1.0).abs() > SAME_SHARE {
            fault(format!(
                "the program takes {} s for what the scene does in {} s: speeds, drifts and lags are those of the \
                 program",
                significant(program, 6),
                significant(scene, 6)
            ));
        }
        for sentence in &self.exceeded {
            fault(format!("{sentence}, under the program"));
        }
        warnings
    }
}
