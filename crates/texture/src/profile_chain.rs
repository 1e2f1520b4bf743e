//! The chain of profiles (ISO 21920): from traced lines to P-, W- and R-parameters.
//!
//! In: one or more [`ProfileTrace`]s of equal spacing, as they were measured or cut, and a [`ProfileChain`]. Out:
//! [`Profiles`], a [`Profile`] for each line, and in words what was done to them. A line never comes from a surface
//! that was filtered: an areal L-filter keeps the long waves of a trace wherever short ones cross it (feed marks that
//! lean), and is no cut-off.
//!
//! 1. Holes are bridged up to a length and counted.
//! 2. Form: a straight line, unless another one is chosen.
//! 3. Profile S-filter (lambda_s), if the points are close enough together. What is left is the primary profile P.
//! 4. Profile L-filter (lambda_c, the cut-off): what passes is the waviness W, the rest the roughness R.
//! 5. Sections: five of one cut-off each in the middle of the line, with half a cut-off of run-in at both ends.

mod cut_off;
mod sections;

use crate::error::TextureError;
use crate::text::short;
use serde::Serialize;

use super::line_filter::low_pass;
use super::line_form::LineForm;
use super::profile::Profile;
use super::setting_class::SettingClass;
use super::trace::{Bridged, ProfileTrace};
use cut_off::ChosenCutOff;

/// Points that a wave of the S-filter's nesting index has in ISO 21920-3.
const S_POINTS: f64 = 5.0;
/// Longest hole that is bridged, as a share of the line.
const BRIDGE: f64 = 0.01;

/// Which profile the parameters belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ProfileKind {
    /// Primary profile: no L-filter.
    Primary,
    /// What the L-filter takes off.
    Waviness,
    /// What it leaves.
    Roughness,
}

impl ProfileKind {
    /// First letter of its parameters.
    pub fn letter(self) -> char {
        match self {
            Self::Primary => 'P',
            Self::Waviness => 'W',
            Self::Roughness => 'R',
        }
    }
}

/// Where the cut-off comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub enum CutOff {
    /// Setting class of the estimated Ra.
    Estimated,
    /// Setting class of a drawing's upper limit of Ra, um.
    OfRaLimit(f64),
    /// Setting class of a drawing's upper limit of Rz, um.
    OfRzLimit(f64),
    /// This one, um.
    Um(f64),
}

/// Profile S-filter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub enum ShortFilter {
    /// That of the setting class, where a wave of its length has five points; otherwise none.
    OfClass,
    /// None.
    None,
    /// This nesting index, um.
    Um(f64),
}

/// What is done to lines; [`ProfileChain::default`] leaves all of it to ISO 21920-3.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ProfileChain {
    /// Profile whose parameters are wanted.
    pub kind: ProfileKind,
    /// F-operator.
    pub form: LineForm,
    /// S-filter (lambda_s).
    pub s_filter: ShortFilter,
    /// L-filter (lambda_c).
    pub cutoff: CutOff,
    /// The L-filter is the robust one (ISO 16610-31).
    pub robust: bool,
    /// Length of a section, um; none: the cut-off.
    pub section_um: Option<f64>,
    /// Number of sections; none: five, or as many as a short line holds.
    pub sections: Option<usize>,
    /// Run-in at both ends, um; none: half a cut-off.
    pub run_in_um: Option<f64>,
    /// Longest hole that is bridged, um; none: a hundredth of the line.
    pub bridge_um: Option<f64>,
}

impl Default for ProfileChain {
    fn default() -> Self {
        Self {
            kind: ProfileKind::Roughness,
            form: LineForm::Line,
            s_filter: ShortFilter::OfClass,
            cutoff: CutOff::Estimated,
            robust: false,
            section_um: None,
            sections: None,
            run_in_um: None,
            bridge_um: None,
        }
    }
}

/// Lines after their chain.
#[derive(Debug, Clone, PartialEq)]
pub struct Profiles {
    /// Which profile.
    pub kind: ProfileKind,
    /// What was done, step by step.
    pub words: Vec<String>,
    /// The cut-off, um; none of a primary profile.
    pub cutoff_um: Option<f64>,
    /// Evaluation length of the first line, um.
    pub evaluation_um: f64,
    /// Parameters of each line, or why it has none.
    pub lines: Vec<Result<Profile, TextureError>>,
}

impl ProfileChain {
    /// Applies the chain to lines of equal spacing. They share one cut-off.
    ///
    /// # Errors
    /// No line at all, lines of which none can be used, a cut-off or sections that do not suit them, or a filter that
    /// does not settle.
    pub fn evaluate(&self, traces: &[ProfileTrace]) -> Result<Profiles, TextureError> {
        let spacing_um = traces.first().ok_or(TextureError::NoLine)?.spacing_um();
        if traces.iter().any(|trace| (trace.spacing_um() / spacing_um - 1.0).abs() > 1e-9) {
            return Err(TextureError::UnequalSpacing);
        }
        let bridged: Vec<Result<Bridged, TextureError>> =
            traces.iter().map(|trace| trace.bridged(self.bridge_um.unwrap_or(BRIDGE * trace.length_um()))).collect();
        let good: Vec<&Bridged> = bridged.iter().flatten().collect();
        let Some(shortest) = good.iter().map(|line| line.heights_um.len()).min() else {
            return Err(bridged.into_iter().find_map(Result::err).unwrap_or(TextureError::NoLine));
        };
        let length_um = spacing_um * (shortest - 1) as f64;
        let leveled: Vec<Result<Vec<f64>, TextureError>> = bridged
            .iter()
            .map(|line| self.form.removed(&line.as_ref().map_err(Clone::clone)?.heights_um, spacing_um))
            .collect();
        let chosen = match self.kind {
            ProfileKind::Primary => None,
            ProfileKind::Waviness | ProfileKind::Roughness => Some(self.chosen(&leveled, spacing_um, length_um)?),
        };
        let cutoff_um = chosen.as_ref().map(|chosen| chosen.um);
        let (s_um, s_words) = self.short(cutoff_um, spacing_um)?;
        let layout = self.layout(cutoff_um, spacing_um, length_um)?;
        let mut rounds = 0;
        let lines = leveled.into_iter().map(|line| {
            let line = line?;
            let (filtered, used) = self.filtered(line, s_um, cutoff_um, spacing_um)?;
            rounds = rounds.max(used.unwrap_or(0));
            let part = layout.part(&filtered);
            Ok(Profile::of(part, spacing_um, layout.sections))
        });
        let lines: Vec<Result<Profile, TextureError>> = lines.collect();
        if lines.iter().all(Result::is_err) {
            return Err(lines.into_iter().find_map(Result::err).unwrap_or(TextureError::NoLine));
        }
        let steps = layout.steps.map_or(shortest - 1 - 2 * layout.run_in, |steps| steps * layout.sections);
        let evaluation_um = steps as f64 * spacing_um;
        let l_words = match chosen {
            None => "none: primary profile".to_owned(),
            Some(ChosenCutOff { words, .. }) if self.robust => {
                format!("robust Gaussian, ISO 16610-31, {words}, {rounds} rounds")
            }
            Some(ChosenCutOff { words, .. }) => format!("Gaussian, ISO 16610-21, {words}"),
        };
        let words = vec![
            format!("holes: {}", holes(&good)),
            format!("profile form: {}", self.form.name()),
            format!("profile S-filter: {s_words}"),
            format!("profile L-filter: {l_words}"),
            format!("sections: {}", layout.words(evaluation_um)),
        ];
        Ok(Profiles { kind: self.kind, words, cutoff_um, evaluation_um, lines })
    }

    /// The profile of a line, and the rounds of a robust filter.
    fn filtered(
        &self,
        mut line: Vec<f64>,
        s_um: Option<f64>,
        cutoff_um: Option<f64>,
        spacing_um: f64,
    ) -> Result<(Vec<f64>, Option<usize>), TextureError> {
        if let Some(s_um) = s_um {
            line = low_pass(&line, spacing_um, s_um, false)?.0;
        }
        let Some(cutoff_um) = cutoff_um else { return Ok((line, None)) };
        let (waves, rounds) = low_pass(&line, spacing_um, cutoff_um, self.robust)?;
        if self.kind == ProfileKind::Waviness {
            return Ok((waves, rounds));
        }
        Ok((line.iter().zip(&waves).map(|(z, w)| z - w).collect(), rounds))
    }

    /// Nesting index of the S-filter, and words on it.
    fn short(&self, cutoff_um: Option<f64>, spacing_um: f64) -> Result<(Option<f64>, String), TextureError> {
        let gaussian = |um: f64| (Some(um), format!("Gaussian, ISO 16610-21, {um} um"));
        let found = match self.s_filter {
            ShortFilter::None => (None, "none".to_owned()),
            ShortFilter::Um(um) => gaussian(um),
            ShortFilter::OfClass => match SettingClass::s_filter_um(cutoff_um.unwrap_or(cut_off::ESTIMATE_UM)) {
                um if um >= S_POINTS * spacing_um * (1.0 - 1e-9) => gaussian(um),
                um => {
                    let spacing = short(spacing_um);
                    (
                        None,
                        format!("none; {um} um of ISO 21920-3 needs points {} um apart, not {spacing}", um / S_POINTS),
                    )
                }
            },
        };
        match (found.0, cutoff_um) {
            (Some(s), Some(l)) if s >= l => {
                Err(TextureError::FiltersCross { short: "profile S-filter", short_um: s, long: "cut-off", long_um: l })
            }
            _ => Ok(found),
        }
    }
}

/// Words on the holes of all lines.
fn holes(lines: &[&Bridged]) -> String {
    let sum = |of: fn(&Bridged) -> usize| lines.iter().map(|line| of(line)).sum::<usize>();
    let (holes, points, cut_off) = (sum(|line| line.holes), sum(|line| line.points), sum(|line| line.cut_off));
    let longest_um = lines.iter().map(|line| line.longest_um).fold(0.0, f64::max);
    let bridged = format!(
        "{holes} of {points} points in all, bridged by straight lines, the longest over {} um",
        short(longest_um)
    );
    let ends = format!("{cut_off} points without height cut off at the ends");
    match (holes, cut_off) {
        (0, 0) => "none".to_owned(),
        (0, _) => ends,
        (_, 0) => bridged,
        _ => format!("{bridged}; {ends}"),
    }
}

#[cfg(test)]
mod tests;
