//! The contact pattern: how near the mate comes to every point of a flank while the gears roll.
//!
//! In: gears in mesh and the moments of a period. Out: for every point of every flank the smallest gap to the mate
//! while the flanks of its side touch, along their normal. Where it is below the thickness of the marking compound, the
//! compound is rubbed off: the pattern that a roll test shows (ISO/TR 10064-4 speaks of 6 to 12 um for red lead).
//!
//! Law: a point asks for a rotation of the driven gear; what it falls short of the acting pair's, times the lever of
//! the line of action, is its gap.

use rayon::prelude::*;

use super::assembly::{Meshing, Moment};
use super::contact::probes;
use super::flank_chain::GearFlanks;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// Smallest gaps in one section, um, by the points of the chains; infinite where nothing came within reach.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionGaps {
    /// On the driver.
    pub driver_um: GearFlanks<Vec<f32>>,
    /// On the driven gear, under the labels of the pair.
    pub driven_um: GearFlanks<Vec<f32>>,
}

/// Smallest gaps, section by section. Pairs of flanks that are farther apart than `reach_um` are not looked at;
/// `passed` is called after every moment and may end the work.
///
/// # Errors
/// Those of `passed`.
pub fn smallest_gaps(
    meshing: &Meshing,
    moments: &[Moment],
    reach_um: f64,
    passed: impl Fn() -> Result<()> + Sync,
) -> Result<Vec<SectionGaps>> {
    let never = |count: usize| vec![f32::INFINITY; count];
    let nothing = || -> Vec<SectionGaps> {
        let gaps = meshing.sections.iter().map(|section| SectionGaps {
            driver_um: section.driver.each(|chain| never(chain.points_mm.len())),
            driven_um: section.driven.each(|flank| never(flank.points)),
        });
        gaps.collect()
    };
    moments
        .par_iter()
        .try_fold(nothing, |mut gaps, moment| {
            for side in [Side::Right, Side::Left] {
                note(meshing, moment, side, reach_um, &mut gaps);
            }
            passed()?;
            Ok(gaps)
        })
        .try_reduce(nothing, |mut a, b| {
            for (a, b) in a.iter_mut().zip(&b) {
                a.driver_um.combine(&b.driver_um, |a, b| least(a, b));
                a.driven_um.combine(&b.driven_um, |a, b| least(a, b));
            }
            Ok(a)
        })
}

fn least(a: &mut [f32], b: &[f32]) {
    for (a, b) in a.iter_mut().zip(b) {
        *a = a.min(*b);
    }
}

/// Notes the gaps of one moment at the touch of one side.
fn note(meshing: &Meshing, moment: &Moment, side: Side, reach_um: f64, gaps: &mut [SectionGaps]) {
    let touch = moment.side(side);
    let um_per_rad = UM_PER_MM * meshing.pitch.arm_mm(&moment.pitch, side);
    let first_rad = -side.sign() * touch.error_rad;
    for pair in &touch.pairs {
        let gap_um = |push_rad: f64| (first_rad - push_rad) * um_per_rad;
        if gap_um(-side.sign() * pair.touch.error_rad) > reach_um {
            continue;
        }
        let section = &meshing.sections[pair.section];
        let stand = meshing.stand(&moment.pitch, section, 0.0);
        let SectionGaps { driver_um, driven_um } = &mut gaps[pair.section];
        let (on_driver, on_driven) = (driver_um.get_mut(side, pair.tooth), driven_um.get_mut(side, pair.tooth));
        probes(section.driver.get(side, pair.tooth), section.driven.get(side, pair.tooth), &stand, side, |probe| {
            let cell = match probe.driven_point {
                Some(index) => &mut on_driven[index],
                None => &mut on_driver[probe.place as usize],
            };
            *cell = cell.min(gap_um(probe.push_rad) as f32);
        });
    }
}
