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
//!
//! **The cut-off** is given, or that of the setting class of ISO 21920-3 for the limit on the drawing, or for Ra as
//! estimated with 0.8 mm over the whole line. Where five sections and the run-in do not fit the line, the next shorter
//! one is taken that does, and the words say so. A line too short for any, or for the cut-off that was given, has fewer
//! sections, at least one, which share what the run-in leaves of it.
//!
//! Road not taken: trying cut-offs until Ra falls into the class of its own cut-off. On a surface of long waves alone
//! each shorter cut-off takes more away, and the search ends at 0.08 mm with nothing left.

use serde::Serialize;

use super::line_filter::low_pass;
use super::line_form::LineForm;
use super::profile::Profile;
use super::setting_class::{CLASSES, SettingClass};
use super::trace::{Bridged, ProfileTrace};

/// Sections of ISO 21920-3.
const SECTIONS: usize = 5;
/// Cut-off that Ra is estimated with, um.
const ESTIMATE_UM: f64 = 800.0;
/// Fewest points in a cut-off.
const POINTS: f64 = 10.0;
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
    pub lines: Vec<Result<Profile, String>>,
}

/// How a line is divided.
#[derive(Clone, Copy)]
struct Layout {
    sections: usize,
    /// Steps from point to point in a section; none: sections share what the run-in leaves of the line.
    steps: Option<usize>,
    /// Run-in at both ends, um, and in points.
    run_in_um: f64,
    run_in: usize,
}

/// A chosen cut-off, and why it is that.
struct ChosenCutOff {
    um: f64,
    words: String,
}

impl ProfileChain {
    /// Applies the chain to lines of equal spacing. They share one cut-off.
    ///
    /// # Errors
    /// No line at all, lines of which none can be used, a cut-off or sections that do not suit them, or a filter that
    /// does not settle.
    pub fn evaluate(&self, traces: &[ProfileTrace]) -> Result<Profiles, String> {
        let spacing_um = traces.first().ok_or("there is no line to evaluate")?.spacing_um();
        if traces.iter().any(|trace| (trace.spacing_um() / spacing_um - 1.0).abs() > 1e-9) {
            return Err("lines of one evaluation must have equal spacing".to_owned());
        }
        let bridged: Vec<Result<Bridged, String>> =
            traces.iter().map(|trace| trace.bridged(self.bridge_um.unwrap_or(BRIDGE * trace.length_um()))).collect();
        let good: Vec<&Bridged> = bridged.iter().flatten().collect();
        let Some(shortest) = good.iter().map(|line| line.heights_um.len()).min() else {
            return Err(bridged.into_iter().find_map(Result::err).unwrap_or_default());
        };
        let length_um = spacing_um * (shortest - 1) as f64;
        let leveled: Vec<Result<Vec<f64>, String>> = bridged
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
        let lines: Vec<Result<Profile, String>> = lines.collect();
        if lines.iter().all(Result::is_err) {
            return Err(lines.into_iter().find_map(Result::err).unwrap_or_default());
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
    ) -> Result<(Vec<f64>, Option<usize>), String> {
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

    /// Length of five sections, or as many as are wanted, with their run-in, um.
    fn wanted_um(&self, cutoff_um: f64) -> f64 {
        let section_um = self.section_um.unwrap_or(cutoff_um);
        self.sections.unwrap_or(SECTIONS) as f64 * section_um + 2.0 * self.run_in_um.unwrap_or(0.5 * cutoff_um)
    }

    /// Cut-off for lines after their form.
    fn chosen(
        &self,
        leveled: &[Result<Vec<f64>, String>],
        spacing_um: f64,
        length_um: f64,
    ) -> Result<ChosenCutOff, String> {
        let (wanted, of) = match self.cutoff {
            CutOff::Um(um) if um < POINTS * spacing_um => {
                return Err(format!(
                    "a cut-off of {um} um on points {} um apart: {POINTS} points at least make a section",
                    short(spacing_um)
                ));
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
            format!(
                "points {} um apart are too few for a cut-off of {} um ({classed}): {POINTS} at least make a section",
                short(spacing_um),
                class.cutoff_um
            )
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

    /// Nesting index of the S-filter, and words on it.
    fn short(&self, cutoff_um: Option<f64>, spacing_um: f64) -> Result<(Option<f64>, String), String> {
        let gaussian = |um: f64| (Some(um), format!("Gaussian, ISO 16610-21, {um} um"));
        let found = match self.s_filter {
            ShortFilter::None => (None, "none".to_owned()),
            ShortFilter::Um(um) => gaussian(um),
            ShortFilter::OfClass => match SettingClass::s_filter_um(cutoff_um.unwrap_or(ESTIMATE_UM)) {
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
                Err(format!("the profile S-filter ({s} um) must be shorter than the cut-off ({l} um)"))
            }
            _ => Ok(found),
        }
    }

    fn layout(&self, cutoff_um: Option<f64>, spacing_um: f64, length_um: f64) -> Result<Layout, String> {
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
            return Err(format!(
                "the line is {} mm long; a cut-off of {cutoff_um} um needs {} mm for {} of {} um and a run-in of {} um \
                 at both ends: take a shorter cut-off, less of both, or a longer line",
                short(1e-3 * length_um),
                short(1e-3 * (self.sections.unwrap_or(1) as f64 * section_um + 2.0 * run_in_um)),
                if wanted == 1 || self.sections.is_none() {
                    "a section".to_owned()
                } else {
                    format!("{wanted} sections")
                },
                short(section_um),
                short(run_in_um)
            ));
        }
        Ok(Layout { sections: room, steps: None, run_in_um, run_in })
    }
}

impl Layout {
    /// What is evaluated of a line: its middle, as near to either end.
    fn part<'a>(&self, line: &'a [f64]) -> &'a [f64] {
        let start = match self.steps {
            Some(steps) => line.len().saturating_sub(steps * self.sections + 1).div_ceil(2),
            None => self.run_in,
        };
        &line[start..line.len() - start]
    }

    fn words(&self, evaluation_um: f64) -> String {
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

/// Mean Ra over the whole of the lines with the cut-off of the middle class, um.
fn estimated_ra(leveled: &[Result<Vec<f64>, String>], spacing_um: f64) -> Result<f64, String> {
    let mut ra = Vec::new();
    for line in leveled.iter().flatten() {
        let waves = low_pass(line, spacing_um, ESTIMATE_UM, false)?.0;
        ra.push(line.iter().zip(&waves).map(|(z, w)| (z - w).abs()).sum::<f64>() / line.len() as f64);
    }
    match ra.len() {
        0 => Err(leveled.iter().find_map(|line| line.clone().err()).unwrap_or_default()),
        count => Ok(ra.iter().sum::<f64>() / count as f64),
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

/// A length to four decimals, without trailing zeros.
fn short(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A roughness in two digits.
fn digits(value: f64) -> String {
    if value <= 0.0 {
        return "0".to_owned();
    }
    let places = (1 - value.log10().floor() as i32).clamp(0, 12) as usize;
    format!("{value:.places$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn trace(count: usize, spacing_um: f64, at: impl Fn(f64) -> f64) -> ProfileTrace {
        ProfileTrace::new((0..count).map(|i| at(i as f64 * spacing_um)).collect(), spacing_um).expect("a line")
    }

    fn wave(x: f64, length: f64) -> f64 {
        (TAU * x / length).sin()
    }

    fn one(chain: &ProfileChain, trace: &ProfileTrace) -> (Profile, Vec<String>) {
        let found = chain.evaluate(std::slice::from_ref(trace)).expect("a line that suits");
        (found.lines[0].clone().expect("a profile"), found.words)
    }

    fn near(value: f64, closed: f64, share: f64) {
        assert!((value - closed).abs() <= share * closed.abs(), "{value} is not {closed}");
    }

    /// Roughness of 0.1 mm over a wave of 4 mm: 0.8 mm leaves 1 - 2^-0.04 of the wave, 1 - 2^-64 of the roughness.
    #[test]
    fn waves_longer_than_the_cutoff_are_no_roughness() {
        // Even about the middle, so that the wave has no tilt of its own.
        let line = trace(1601, 5.0, |x| wave(x + 1000.0, 4000.0) + 0.1 * wave(x, 100.0));
        let chain = ProfileChain { cutoff: CutOff::Um(800.0), ..ProfileChain::default() };
        let (rough, words) = one(&chain, &line);
        let left = 1.0 - 2_f64.powf(-0.04);
        near(rough.q, (0.5 * (0.01 + left * left)).sqrt(), 1e-3);
        near(rough.a, 0.0647, 5e-3);
        assert!(words.contains(&"profile L-filter: Gaussian, ISO 16610-21, cut-off 800 um".to_owned()), "{words:?}");
        assert!(words.iter().any(|w| w.contains("5 of 800 um in the middle")), "{words:?}");
        // What is called primary is all of it, what is called waviness the rest of the wave.
        let of_kind = |kind| one(&ProfileChain { kind, ..chain }, &line).0;
        near(of_kind(ProfileKind::Primary).q, (0.5 * 1.01_f64).sqrt(), 1e-3);
        near(of_kind(ProfileKind::Waviness).q, 2_f64.powf(-0.04) / 2_f64.sqrt(), 1e-3);
    }

    #[test]
    fn the_class_gives_the_cutoff_and_a_short_line_the_next_that_fits() {
        let rough = |x: f64| 0.5 * wave(x, 50.0);
        let cutoff = |line: &ProfileTrace, cutoff| {
            let chain = ProfileChain { cutoff, ..ProfileChain::default() };
            let found = chain.evaluate(std::slice::from_ref(line)).expect("a line that suits");
            (found.cutoff_um.expect("a cut-off"), found.words[3].clone())
        };
        let long = trace(5001, 1.0, rough);
        let (um, words) = cutoff(&long, CutOff::Estimated);
        assert!(um == 800.0 && words.contains("Sc3 of ISO 21920-3 for Ra 0.32 um, estimated with 800 um"), "{words}");
        assert_eq!(cutoff(&long, CutOff::OfRaLimit(0.1)).0, 250.0);
        assert_eq!(cutoff(&long, CutOff::OfRzLimit(0.1)).0, 80.0);
        let (um, words) = cutoff(&trace(3201, 1.0, rough), CutOff::OfRaLimit(0.8));
        let because = "250 um, because 800 um (Sc3 of ISO 21920-3 for a limit of Ra 0.8 um) with its sections and \
                       run-in needs 4.8 mm, and the line is 3.2 mm long";
        assert!(um == 250.0 && words.contains(because), "{words}");
        // Smooth waves far longer than any cut-off do not make the cut-off shrink to nothing.
        let (um, _) = cutoff(&trace(6001, 1.0, |x| 0.3 * wave(x, 500.0)), CutOff::Estimated);
        assert_eq!(um, 800.0);
        // Too short for any: as many sections as the run-in leaves room for.
        let whole = ProfileChain::default().evaluate(&[trace(400, 0.5, rough)]).expect("a short line");
        assert!(whole.cutoff_um == Some(80.0) && whole.words[4].contains("1 of 119.5 um, which is what"));
    }

    #[test]
    fn a_line_read_backwards_lifted_or_tilted_has_the_same_parameters() {
        let at = |x: f64| 0.4 * wave(x, 61.0) + 0.2 * wave(x, 143.7) + 0.1 * (0.013 * x).sin().powi(5);
        let chain = ProfileChain::default();
        let (plain, _) = one(&chain, &trace(3001, 2.0, at));
        let backwards = trace(3001, 2.0, |x| at(6000.0 - x));
        let lifted = trace(3001, 2.0, |x| at(x) + 1234.5);
        let tilted = trace(3001, 2.0, |x| at(x) + 0.2 * x - 77.0);
        for (name, other) in [("backwards", backwards), ("lifted", lifted), ("tilted", tilted)] {
            let (other, _) = one(&chain, &other);
            let same = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-7, "{name}: {a} is not {b}");
            let numbers = |p: &Profile| {
                [p.a, p.q, p.ku, p.t, p.z, p.zx, p.p, p.v, p.dq, p.core.sk, p.core.spk, p.core.smr1, p.core.smr2]
            };
            for (a, b) in numbers(&other).into_iter().zip(numbers(&plain)) {
                same(a, b);
            }
            same(other.sm.clone().expect("elements"), plain.sm.clone().expect("elements"));
        }
    }

    #[test]
    fn a_missing_point_costs_nothing() {
        let at = |x: f64| 0.5 * wave(x, 25.0);
        let mut heights: Vec<f64> = (0..400).map(|i| at(f64::from(i) * 0.5)).collect();
        heights[137] = f64::NAN;
        let (profile, words) = one(&ProfileChain::default(), &ProfileTrace::new(heights.clone(), 0.5).expect("a line"));
        // 119.5 um hold 4.78 waves, and as many half waves too few.
        near(profile.a, 1.0 / PI, 0.03);
        assert_eq!(words[0], "holes: 1 of 1 points in all, bridged by straight lines, the longest over 1 um");
        heights[140..160].fill(f64::NAN);
        let holed = ProfileTrace::new(heights, 0.5).expect("a line");
        let refused = ProfileChain::default().evaluate(std::slice::from_ref(&holed)).expect_err("a long hole");
        assert!(refused.contains("bridged up to 1.9950 um"), "{refused}");
        // Beside a good line the holed one is the only one without parameters.
        let both = ProfileChain::default().evaluate(&[holed, trace(400, 0.5, at)]).expect("one good line");
        assert!(both.lines[0].is_err() && both.lines[1].is_ok());
    }

    #[test]
    fn what_does_not_suit_the_line_says_why() {
        let line = trace(501, 8.0, |x| wave(x, 100.0));
        let refused = |chain: ProfileChain| chain.evaluate(std::slice::from_ref(&line)).expect_err("unsuited");
        let of = |cutoff| ProfileChain { cutoff, ..ProfileChain::default() };
        assert!(refused(of(CutOff::Um(5000.0))).contains("4 mm long; a cut-off of 5000 um needs 10 mm for a section"));
        assert!(refused(of(CutOff::Um(70.0))).contains("10 points at least"));
        let six = ProfileChain { sections: Some(6), ..of(CutOff::Um(800.0)) };
        assert!(refused(six).contains("needs 5.6 mm for 6 sections of 800 um and a run-in of 400 um"));
        let crossed = ProfileChain { s_filter: ShortFilter::Um(900.0), ..of(CutOff::Um(800.0)) };
        assert!(refused(crossed).contains("must be shorter"));
        let coarse = trace(50, 400.0, |x| wave(x, 4000.0));
        let few = of(CutOff::OfRaLimit(0.8)).evaluate(&[coarse]).expect_err("coarse");
        assert!(few.contains("points 400 um apart are too few for a cut-off of 800 um"), "{few}");
        assert!(ProfileChain::default().evaluate(&[]).is_err());
    }

    #[test]
    fn the_s_filter_is_left_out_where_points_are_too_far_apart() {
        let (fine, words) = one(&ProfileChain::default(), &trace(20_001, 0.5, |x| wave(x, 2.5) + wave(x, 100.0)));
        assert!(words[2].contains("2.5 um"), "{words:?}");
        near(fine.q, 0.625_f64.sqrt(), 5e-3);
        let (_, words) = one(&ProfileChain::default(), &trace(5001, 4.0, |x| wave(x, 100.0)));
        assert_eq!(words[2], "profile S-filter: none; 2.5 um of ISO 21920-3 needs points 0.5 um apart, not 4");
    }
}
