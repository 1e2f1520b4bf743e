//! Backlash, and the centre distance without it.

use super::{ARCSEC_PER_RAD, at_moment, largest_at, tables};
use crate::findings::{Place, Quantity, Section};
use crate::pair::backlash::Backlash;
use crate::pair_job::double_flank::{DoubleFlank, MASTER_TEETH};
use crate::pair_job::rolled::RolledPair;
use gearcut_core::units::UM_PER_MM;

/// What F_i" is.
const RANGE: &str = "largest less smallest tight centre distance, less the one asked for";

pub(super) fn backlash(rolled: &RolledPair) -> Section {
    let play = &rolled.backlash;
    let extreme = |of: &dyn Fn(&Backlash) -> f64, sign: f64, definition: &'static str| {
        let at = largest_at(play.iter().map(|play| sign * of(play)));
        Quantity::number(UM_PER_MM * of(&play[at]), "um", definition).at(at_moment(rolled, at))
    };
    let circumferential = |play: &Backlash| play.circumferential_mm;
    let mean_mm = play.iter().map(circumferential).sum::<f64>() / play.len() as f64;
    let least_rad = play.iter().map(|play| play.angle_rad).fold(f64::INFINITY, f64::min);
    Section::new("backlash", "Backlash")
        .with(
            "smallest",
            extreme(
                &circumferential,
                -1.0,
                "smallest play of B, across the line of centres at the pitch point; below 0 it jams",
            ),
        )
        .shown(
            "largest",
            "largest",
            extreme(&circumferential, 1.0, "largest play of B, across the line of centres at the pitch point"),
        )
        .shown("mean", "mean", Quantity::number(UM_PER_MM * mean_mm, "um", "mean of the circumferential play"))
        .with(
            "smallest_along_pitch_curves",
            extreme(&|play| play.tangential_mm, -1.0, "smallest play along the pitch curves, j_t"),
        )
        .shown(
            "smallest_normal",
            "smallest normal to flanks",
            extreme(
                &|play| play.normal_left_mm.min(play.normal_right_mm),
                -1.0,
                "smallest gap of one side's flanks, along their normal, while the other side touches, j_n",
            ),
        )
        .with(
            "smallest_angle",
            Quantity::number(ARCSEC_PER_RAD * least_rad, "arcsec", "smallest angle that B can turn while A is held"),
        )
}

pub(super) fn double_flank(rolled: &RolledPair) -> Section {
    let found = [
        ("mate", "A with B".to_owned(), &rolled.tight),
        ("master_A", format!("A with a master of {MASTER_TEETH} teeth"), &rolled.masters[0]),
        ("master_B", format!("B with a master of {MASTER_TEETH} teeth"), &rolled.masters[1]),
    ];
    let parts = found.into_iter().map(|(key, title, found)| match found {
        Ok(found) => part(key, &title, found).table(tables::double_flank(key, found)),
        Err(why) => Section::new(key, title).shown("total", "F_i\"", Quantity::undefined("um", RANGE, why.clone())),
    });
    Section::new("double_flank", "Double-flank rolling").parts(parts)
}

fn part(key: &str, title: &str, found: &DoubleFlank) -> Section {
    let um = |value: f64, definition: &'static str| Quantity::number(value, "um", definition);
    let at = largest_at(found.variation_rad_um.iter().map(|[_, um]| *um));
    let place = Place::default().and("angle_deg", found.variation_rad_um[at][0].to_degrees());
    Section::new(key, title)
        .shown("total", "F_i\"", um(found.total_um(), RANGE))
        .shown("in_a_pitch", "f_i\"", um(found.in_a_pitch_um(), "largest variation of it within one pitch"))
        .with("mean", um(found.mean_um(), "mean of the tight less the nominal centre distance"))
        .with("largest", um(found.variation_rad_um[at][1], "largest tight less nominal centre distance").at(place))
}
