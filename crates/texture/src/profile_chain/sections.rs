//! Sections of a line: how many, how long, with what run-in, and which part of the line they take.
//!
//! In: the wishes of a [`ProfileChain`], the cut-off and the length of the line. Out: [`Layout`]. Five sections of one
//! cut-off in the middle, half a cut-off of run-in at both ends; a line without room for them has fewer, which share
//! what the run-in leaves of it.

use super::ProfileChain;
use crate::error::TextureError;
use crate::text::short;

/// Sections of ISO 21920-3.
const SECTIONS: usize = 5;
/// How a line is divided.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    pub(super) sections: usize,
    /// Steps from point to point in a section; none: sections share what the run-in leaves of the line.
    pub(super) steps: Option<usize>,
    /// Run-in at both ends, um, and in points.
    run_in_um: f64,
    pub(super) run_in: usize,
}

impl ProfileChain {
    /// Length of five sections, or as many as are wanted, with their run-in, um.
    pub(super) fn wanted_um(&self, cutoff_um: f64) -> f64 {
        let section_um = self.section_um.unwrap_or(cutoff_um);
        self.sections.unwrap_or(SECTIONS) as f64 * section_um + 2.0 * self.run_in_um.unwrap_or(0.5 * cutoff_um)
    }

    pub(super) fn layout(
        &self,
        cutoff_um: Option<f64>,
        spacing_um: f64,
        length_um: f64,
    ) -> Result<Layout, TextureError> {
        let Some(cutoff_um) = cutoff_um else {
            return Ok(Layout { sections: 1, steps: None, run_in_um: 0.0, run_in: 0 });
        };
        let section_um = self.section_um.unwrap_or(cutoff_um);
        let run_in_um = self.run_in_um.unwrap_or(0.5 * cutoff_um);
        let run_in = (run_in_um / spacing_um).round() as usize;
        let room = ((length_um - 2.0 * run_in_um) / section_um * (1.0 + 1e-9)).max(0.0) as usize;
        let wanted = self.sections.unwrap_or(SECTIONS);
        if room >= wanted {
            let steps = Some((section_um / spacing_um).round() as usize);
            return Ok(Layout { sections: wanted, steps, run_in_um, run_in });
        }
        if room == 0 || self.sections.is_some() {
            let sections = self.sections.unwrap_or(1);
            return Err(TextureError::NoRoom {
                length_mm: 1e-3 * length_um,
                cutoff_um,
                needed_mm: 1e-3 * (sections as f64 * section_um + 2.0 * run_in_um),
                sections,
                section_um,
                run_in_um,
            });
        }
        Ok(Layout { sections: room, steps: None, run_in_um, run_in })
    }
}

impl Layout {
    /// What is evaluated of a line: its middle, as near to either end.
    pub(super) fn part<'a>(&self, line: &'a [f64]) -> &'a [f64] {
        let start = match self.steps {
            Some(steps) => line.len().saturating_sub(steps * self.sections + 1).div_ceil(2),
            None => self.run_in,
        };
        &line[start..line.len() - start]
    }

    pub(super) fn words(&self, evaluation_um: f64) -> String {
        let section_um = short(evaluation_um / self.sections as f64);
        match self.steps {
            None if self.sections == 1 && self.run_in == 0 => format!("the whole line of {section_um} um"),
            Some(_) => format!(
                "{} of {section_um} um in the middle of the line, run-in at least {} um",
                self.sections,
                short(self.run_in_um)
            ),
            None => format!(
                "{} of {section_um} um, which is what a run-in of {} um leaves of the line",
                self.sections,
                short(self.run_in_um)
            ),
        }
    }
}
