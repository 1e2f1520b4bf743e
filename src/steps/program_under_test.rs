//! A program over time that is cut in place of the scene's own motion: what is said of it.
//!
//! In: how a process holds the program against its motion ([`ProgramUnderTest`]). Out: a section of the operation, and
//! the sentences of the list of warnings, graded as those on a shaper's programs are: what is further off than a
//! program may be is warned of, what is as deep as a gouge is a fault, and so is motion that is missing.

use crate::findings::notices::{ProgramLimit, ProgramOff, ProgramShare, ProgramTime};
use crate::findings::quantities::program::{
    LARGEST_DISTANCE, MISSING_SHARE, PROGRAM, PROGRAM_TIME, SCENE_TIME, SHARE_BEYOND,
};
use crate::findings::{Notice, Place, Section};
use crate::measure::damage::gouge_mm;
use crate::number_text::significant;
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
        let [program_s, scene_s] = self.time_s;
        PROGRAM.section([
            LARGEST_DISTANCE.of(UM_PER_MM * self.distance_mm).at(Place::default().and("time_s", self.at_s)),
            MISSING_SHARE.of(100.0 * self.missing),
            SHARE_BEYOND.of(100.0 * self.beyond),
            PROGRAM_TIME.of(program_s),
            SCENE_TIME.of(scene_s),
        ])
    }

    /// What a reader must know of it; `name` is the operation's.
    pub fn warnings(&self, name: &str, asked_mm: f64, module_mm: f64) -> Vec<Notice> {
        let mut warnings = Vec::new();
        if self.distance_mm > asked_mm + LAST_DIGIT_MM {
            let off = ProgramOff {
                operation: name,
                distance_um: significant(UM_PER_MM * self.distance_mm, 4),
                of: "motion",
                place: format!("{:.3} s", self.at_s),
                asked_um: significant(UM_PER_MM * asked_mm, 3),
            };
            warnings.push(off.notice().fault_where(self.distance_mm > gouge_mm(module_mm)));
        }
        for (share, verb) in [
            (self.missing, "leaves out, of the scene's own motion,"),
            (self.beyond, "goes beyond the scene's own motion by"),
        ] {
            if share > SAME_SHARE {
                let percent = significant(100.0 * share, 3);
                warnings.push(ProgramShare { operation: name, verb, percent }.notice());
            }
        }
        let [program, scene] = self.time_s;
        if (program / scene - 1.0).abs() > SAME_SHARE {
            let [program_s, scene_s] = self.time_s.map(|time_s| significant(time_s, 6));
            warnings.push(ProgramTime { operation: name, program_s, scene_s }.notice());
        }
        warnings.extend(self.exceeded.iter().map(|exceeded| ProgramLimit { operation: name, exceeded }.notice()));
        warnings
    }
}
