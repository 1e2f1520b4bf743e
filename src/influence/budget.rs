//! Which micrometre on the machine costs what on the gear: influences of all error parameters, ranked.
//!
//! In: a scene and what is asked for. Out: [`Budget`], which makes findings and a page. Parameters are ranked by the
//! largest deviation that a natural step of each leaves, for a micrometre, an arc second and a micrometre per hour
//! cannot be compared.
//!
//! What Ctrl-C interrupts keeps the parameters that are finished, and all cuts ([`super::known_cuts`]).

mod findings;
mod maps;
mod page;
mod reported;

use super::derivative::{Influence, refusal};
use super::figures::Figures;
use super::gear_grid::GearGrid;
use super::known_cuts::{KnownCuts, digest};
use super::numbers::numbers;
use crate::backend::Choice;
use crate::interrupt::Interrupt;
use crate::process;
use crate::progress::Progress;
use crate::scene::error_parameters::{ErrorParameter, error_parameters};
use crate::scene::suggest::did_you_mean;
use crate::scene::{LoadedScene, Scene};
use gearcut_core::error::{Error, Refusal, Result};
use gearcut_core::terms::Side;

pub use findings::{findings, printed};
pub use page::write;
pub use reported::ReportedInfluence;

/// Teeth whose flanks are looked at as a whole, evenly over the turn, if nobody names any.
const WHOLE_TEETH: u32 = 4;

/// What is asked for.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BudgetOptions {
    /// Parameters by their keys, their sections or their whole names; empty: all.
    pub parameters: Vec<String>,
    /// Flanks that are looked at, these alone; empty: both flanks of four teeth, and of all where pitch is
    /// taken.
    pub flanks: Vec<(u32, Side)>,
    /// Whether whole cuts are made for the influences on all numbers that they report.
    pub numbers: bool,
}

/// Influences of the parameters of a scene.
#[derive(Debug, Clone)]
pub struct Budget {
    /// Where heights were compared.
    pub grid: GearGrid,
    /// What was found, dearest first.
    pub lines: Vec<BudgetLine>,
    /// Parameters that could not be shifted, and why.
    pub refused: Vec<(ErrorParameter, String)>,
    /// Influences on reported numbers, parameter by parameter, if they were asked for.
    pub reported: Vec<ReportedInfluence>,
    /// Whether all parameters were tried.
    pub complete: bool,
}

/// A parameter with its influence.
#[derive(Debug, Clone)]
pub struct BudgetLine {
    /// Its influence.
    pub influence: Influence,
    /// Figures of it, um per unit.
    pub per_unit: Figures,
}

impl BudgetLine {
    /// Largest deviation that a natural step leaves, um.
    pub fn largest_per_step_um(&self) -> f64 {
        self.per_unit.largest * self.influence.parameter.step
    }
}

/// Finds the influence of every parameter that is asked for; cuts that are known are not made again.
///
/// # Errors
/// Parameters and flanks that are not there; geometry that cannot be cut; the backend's; Ctrl-C before anything is
/// finished.
pub fn budget(
    loaded: &LoadedScene,
    options: &BudgetOptions,
    choice: &Choice,
    progress: &Progress,
    interrupt: &Interrupt,
    known: &KnownCuts,
) -> Result<Budget> {
    let backend = choice.backend.as_ref();
    let parameters = chosen(loaded, &options.parameters)?;
    let whole = whole_flanks(&loaded.scene, &options.flanks)?;
    let mut grid = None;
    let ready = process::prepare(&loaded.scene)?;
    ready.with_gear(&mut |gear| {
        grid = Some(GearGrid::inspected(gear, &whole, options.flanks.is_empty())?);
        Ok(())
    })?;
    let grid = grid.expect("a job shows its gear");
    let asked = digest(&("heights", &grid, choice.backend.name()));
    let cut = |scene: &Scene| grid.heights_of_um(ready.with_errors_of(scene)?.as_ref(), backend);
    let heights_um = |scene: &Scene| known.all_of(scene, &asked, || cut(scene));
    let before_um = heights_um(&loaded.scene)?;
    let numbers = if options.numbers { Some(numbers(loaded, choice, interrupt)?) } else { None };
    let step = progress.step("influence", parameters.len() as u64, "parameters");
    let (mut lines, mut refused, mut reported, mut complete) = (Vec::new(), Vec::new(), Vec::new(), true);
    for parameter in parameters {
        if interrupt.is_raised() {
            complete = false;
            break;
        }
        let found = Influence::by(loaded, &before_um, &parameter, &heights_um)
            .and_then(|influence| influence.checked(loaded, &before_um, &heights_um))
            .and_then(|influence| {
                let changed =
                    numbers.as_ref().map(|of| reported::reported(loaded, &parameter, of, (choice, known), interrupt));
                Ok((influence, changed.transpose()?.unwrap_or_default()))
            });
        match found {
            Ok((influence, changed)) => {
                let per_unit = Figures::new(&grid, &influence.um_per_unit);
                lines.push(BudgetLine { influence, per_unit });
                reported.extend(changed);
            }
            Err(Error::Interrupted) => {
                complete = false;
                break;
            }
            Err(error) => refused.push((parameter, refusal(error)?)),
        }
        step.advance(1);
    }
    step.finish();
    if lines.is_empty() && !complete {
        return Err(Error::Interrupted);
    }
    lines.sort_by(|a, b| b.largest_per_step_um().total_cmp(&a.largest_per_step_um()));
    Ok(Budget { grid, lines, refused, reported, complete })
}

/// Parameters by names; all where there are none. A name is a key, a section of keys, or a parameter's whole name; one
/// that means part of a list is given all its entries.
///
/// # Errors
/// A name that means nothing.
pub fn chosen(loaded: &LoadedScene, names: &[String]) -> Result<Vec<ErrorParameter>, Refusal> {
    let all = error_parameters(loaded, !names.is_empty());
    if names.is_empty() {
        return Ok(all.into_iter().filter(ErrorParameter::is_usual).collect());
    }
    if let Some(unknown) = names.iter().find(|name| !all.iter().any(|parameter| parameter.is_meant_by(name))) {
        let mut sources: Vec<&str> = all.iter().map(|parameter| parameter.source.as_str()).collect();
        sources.dedup();
        // A name may be a section as well.
        let sections = sources.iter().flat_map(|source| source.match_indices('.').map(|(end, _)| &source[..end]));
        let nearest = did_you_mean(sources.iter().copied().chain(sections), unknown);
        let problem = format!("`{unknown}` is no error of this process{nearest}");
        return Err(Refusal::new("--parameters", problem, format!("choose among {}", sources.join(", "))));
    }
    Ok(all.into_iter().filter(|parameter| names.iter().any(|name| parameter.is_meant_by(name))).collect())
}

fn whole_flanks(scene: &Scene, asked: &[(u32, Side)]) -> Result<Vec<(u32, Side)>, Refusal> {
    let teeth = scene.gear.teeth;
    if let Some((tooth, _)) = asked.iter().find(|(tooth, _)| !(1..=teeth).contains(tooth)) {
        let problem = format!("there is no tooth {tooth}, the gear has {teeth}");
        return Err(Refusal::new("--flanks", problem, "name teeth from 1 to the number of teeth"));
    }
    if !asked.is_empty() {
        return Ok(asked.to_vec());
    }
    let count = WHOLE_TEETH.min(teeth);
    Ok((0..count)
        .map(|i| 1 + i * teeth / count)
        .flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)])
        .collect())
}
