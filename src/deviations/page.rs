//! The page of measured points: `report.html`; and all that is written.

use super::Foot;
use super::findings::by_flank;
use super::fit::{FitFreedom, LaidPoints};
use super::quantities::DEVIATIONS;
use crate::findings::{Findings, RESULTS_FILE};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::dot_chart::{Dot, DotAxis, DotChart};
use crate::output::folder::OutputFolder;
use crate::output::report::{Block, Page, PageSection, REPORT_FILE};
use crate::output::table::write_tables;
use crate::scene::LoadedScene;
use crate::steps::report::facts::gear_words;
use crate::steps::report::quantities;
use crate::steps::report::{SCENE, ending, page_of};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// Smallest division of axes of deviations, um, and of places, mm.
const LEAST_DIVISIONS: [f64; 2] = [0.1, 0.1];

/// Writes everything but the run record.
///
/// # Errors
/// Files that cannot be written.
pub fn write(
    loaded: &LoadedScene,
    freedom: FitFreedom,
    laid: &LaidPoints,
    tree: &Findings,
    folder: &OutputFolder,
) -> Result<()> {
    write_tables(tree, folder)?;
    let end = ending(folder, ["Free to move", freedom.words()], &[(SCENE, &loaded.resolved_toml())])?;
    let whole = tree.group(&DEVIATIONS).map(|section| Block::Table(quantities::table(section)));
    let along = |name: &str, of: fn(&Foot) -> f64| {
        [Side::Left, Side::Right].map(|side| Block::Dots(dots(laid, side, name, of))).into_iter()
    };
    let page = Page {
        what: "deviations",
        subtitle: format!("{} measured points", laid.feet.len()),
        operations: vec![gear_words(&loaded.scene)],
        done: "all points laid on the target",
        sections: [
            PageSection::new(
                "flanks",
                "Flanks",
                "Mean normal deviation of every flank that was measured: pitch and thickness of its teeth. Positive \
                 where material is left.",
                vec![Block::Bars(bars(laid))],
            ),
            PageSection::new(
                "places",
                "Profile and helix",
                "Deviations of all points from the mean of their flank, over the profile and along the tooth.",
                along("arc from the form point", |foot| foot.u_mm)
                    .chain(along("place along the tooth", |foot| foot.v_mm))
                    .collect(),
            ),
            PageSection::new(
                "alignment",
                "Alignment",
                "How the points were moved onto the target: by the least squares of their normal deviations.",
                whole.into_iter().collect(),
            ),
        ]
        .into_iter()
        .chain(end)
        .collect(),
        ..page_of(tree)
    };
    page.write(&folder.path(REPORT_FILE)?)?;
    folder.write_json(RESULTS_FILE, &tree.to_json())
}

fn dots(laid: &LaidPoints, side: Side, name: &str, of: fn(&Foot) -> f64) -> DotChart {
    let flanks = by_flank(laid);
    let dot = |foot: &Foot| {
        let um = UM_PER_MM * foot.height_mm;
        let from_mean_um = um - flanks.get(&(foot.tooth, foot.side)).map_or(0.0, |flank| flank.mean_um);
        let words = format!("tooth {}, u {:.3} mm, v {:.3} mm: {um:.2} um", foot.tooth, foot.u_mm, foot.v_mm);
        Dot { at: [of(foot), from_mean_um], words, link: None }
    };
    let axis = |name: &str, unit: &str, least_division: f64| DotAxis {
        name: name.to_owned(),
        unit: unit.to_owned(),
        least_division,
    };
    DotChart {
        title: format!(
            "{} flanks: deviation from their mean over the {name}",
            match side {
                Side::Left => "Left",
                Side::Right => "Right",
            }
        ),
        axes: [axis(name, "mm", LEAST_DIVISIONS[1]), axis("from the flank's mean", "µm", LEAST_DIVISIONS[0])],
        name: "points".to_owned(),
        dots: laid.feet.iter().flatten().filter(|foot| foot.side == side).map(dot).collect(),
        line: None,
    }
}

fn bars(laid: &LaidPoints) -> BarChart {
    let flanks = by_flank(laid);
    let mut teeth: Vec<u32> = flanks.keys().map(|(tooth, _)| *tooth).collect();
    teeth.dedup();
    let series = |side: Side| BarSeries {
        name: format!("{} flanks", side.name()),
        values: teeth.iter().map(|&tooth| flanks.get(&(tooth, side)).map(|spread| spread.mean_um)).collect(),
    };
    BarChart {
        has_mean: true,
        title: "Mean normal deviation by tooth".to_owned(),
        category_name: "tooth".to_owned(),
        categories: teeth.iter().map(u32::to_string).collect(),
        value_name: "mean normal deviation".to_owned(),
        unit: "µm".to_owned(),
        least_division: LEAST_DIVISIONS[0],
        series: vec![series(Side::Left), series(Side::Right)],
        limits: Vec::new(),
    }
}
