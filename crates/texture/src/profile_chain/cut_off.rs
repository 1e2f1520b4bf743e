//! The cut-off of lines.
//!
//! **The cut-off** is given, or that of the setting class of ISO 21920-3 for the limit on the drawing, or for Ra as
//! estimated with 0.8 mm over the whole line. Where five sections and the run-in do not fit the line, the next shorter
//! one is taken that does, and the words say so. A line too short for any, or for the cut-off that was given, has fewer
//! sections, at least one, which share what the run-in leaves of it.
//!
//! Road not taken: trying cut-offs until Ra falls into the class of its own cut-off. On a surface of long waves alone
//! each shorter cut-off takes more away, and the search ends at 0.08 mm with nothing left.

use super::{CutOff, ProfileChain};
use crate::error::TextureError;
use crate::line_filter::low_pass;
use crate::setting_class::{CLASSES, SettingClass};
use crate::text::short;

/// Cut-off that Ra is estimated with, um.
pub(super) const ESTIMATE_UM: f64 = 800.0;
/// Fewest points in a cut-off.
const POINTS: f64 = 10.0;
/// A chosen cut-off, and why it is that.
pub(super) struct ChosenCutOff {
    pub(super) um: f64,
    pub(super) words: String,
}

impl ProfileChain {
    /// Cut-off for lines after their form.
    pub(super) fn chosen(
        &self,
        leveled: &[Result<Vec<f64>, TextureError>],
        spacing_um: f64,
        length_um: f64,
    ) -> Result<ChosenCutOff, TextureError> {
        let (wanted, of) = match self.cutoff {
            CutOff::Um(um) if um < POINTS * spacing_um => {
                let cut_off = format!("a cut-off of {um} um on points {} um apart:", short(spacing_um));
                return Err(TextureError::ShortCutOff { cut_off, fewest: POINTS, of_class: false });
            }
            CutOff::Um(um) => return Ok(ChosenCutOff { um, words: format!("cut-off {um} um") }),
            CutOff::OfRaLimit(ra) => (SettingClass::of_ra(ra), format!("for a limit of Ra {ra} um")),
            CutOff::OfRzLimit(rz) => (SettingClass::of_rz(rz), format!("for a limit of Rz {rz} um")),
            CutOff::Estimated => {
                let ra = estimated_ra(leveled, spacing_um)?;
                (SettingClass::of_ra(ra), format!("for Ra {} um, estimated with {ESTIMATE_UM} um", digits(ra)))
            }
        };
        let class = &CLASSES[wanted];
        let classed = format!("{} of ISO 21920-3 {of}", class.name);
        let few = || {
            let (spacing_um, cutoff_um) = (short(spacing_um), class.cutoff_um);
            let cut_off =
                format!("points {spacing_um} um apart are too few for a cut-off of {cutoff_um} um ({classed}):");
            TextureError::ShortCutOff { cut_off, fewest: POINTS, of_class: true }
        };
        // Enough points first; then the longest that the line has room for, or the shortest.
        let possible: Vec<&SettingClass> =
            CLASSES[..=wanted].iter().filter(|class| class.cutoff_um >= POINTS * spacing_um).collect();
        let fits = |class: &&&SettingClass| self.wanted_um(class.cutoff_um) <= length_um * (1.0 + 1e-9);
        let taken = possible.iter().rev().find(fits).or(possible.first()).ok_or_else(few)?;
        let words = if taken.name == class.name {
            format!("cut-off {} um ({classed})", class.cutoff_um)
        } else {
            format!(
                "cut-off {} um, because {} um ({classed}) with its sections and run-in needs {} mm, and the line is {} \
                 mm long",
                taken.cutoff_um,
                class.cutoff_um,
                short(1e-3 * self.wanted_um(class.cutoff_um)),
                short(1e-3 * length_um)
            )
        };
        Ok(ChosenCutOff { um: taken.cutoff_um, words })
    }
}

/// Mean Ra over the whole of the lines with the cut-off of the middle class, um.
fn estimated_ra(leveled: &[Result<Vec<f64>, TextureError>], spacing_um: f64) -> Result<f64, TextureError> {
    let mut ra = Vec::new();
    for line in leveled.iter().flatten() {
        let waves = low_pass(line, spacing_um, ESTIMATE_UM, false)?.0;
        ra.push(line.iter().zip(&waves).map(|(z, w)| (z - w).abs()).sum::<f64>() / line.len() as f64);
    }
    match ra.len() {
        0 => Err(leveled.iter().find_map(|line| line.clone().err()).unwrap_or(TextureError::NoLine)),
        count => Ok(ra.iter().sum::<f64>() / count as f64),
    }
}

/// A roughness in two digits.
fn digits(value: f64) -> String {
    if value <= 0.0 {
        return "0".to_owned();
    }
    let places = (1 - value.log10().floor() as i32).clamp(0, 12) as usize;
    format!("{value:.places$}")
}
