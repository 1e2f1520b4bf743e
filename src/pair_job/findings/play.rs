//! Backlash, and the centre distance without it.

use super::{ARCSEC_PER_RAD, at_moment, largest_at, tables};
use crate::findings::{Entry, Place, QuantityRow, Section};
use crate::pair::backlash::Backlash;
use crate::pair_job::double_flank::DoubleFlank;
use crate::pair_job::quantities::{
    BACKLASH, DOUBLE_FLANK, LARGEST_BACKLASH, MASTERS, MATE, MEAN_BACKLASH, SMALLEST_ANGLE, SMALLEST_BACKLASH,
    SMALLEST_NORMAL, SMALLEST_TANGENTIAL, TIGHT_LARGEST, TIGHT_MEAN, TIGHT_RANGE, TIGHT_STEP,
};
use crate::pair_job::rolled::RolledPair;
use gearcut_core::units::UM_PER_MM;

pub(super) fn backlash(rolled: &RolledPair) -> Section {
    let play = &rolled.backlash;
    let extreme = |row: &QuantityRow, of: &dyn Fn(&Backlash) -> f64, sign: f64| {
        let at = largest_at(play.iter().map(|play| sign * of(play)));
        row.of(UM_PER_MM * of(&play[at])).at(at_moment(rolled, at))
    };
    let circumferential = |play: &Backlash| play.circumferential_mm;
    let mean_mm = play.iter().map(circumferential).sum::<f64>() / play.len() as f64;
    let least_rad = play.iter().map(|play| play.angle_rad).fold(f64::INFINITY, f64::min);
    BACKLASH.section([
        extreme(&SMALLEST_BACKLASH, &circumferential, -1.0),
        extreme(&LARGEST_BACKLASH, &circumferential, 1.0),
        MEAN_BACKLASH.of(UM_PER_MM * mean_mm),
        extreme(&SMALLEST_TANGENTIAL, &|play| play.tangential_mm, -1.0),
        match rolled.fit.no_involutes() {
            Some(why) => SMALLEST_NORMAL.none(why.to_owned()),
            None => extreme(&SMALLEST_NORMAL, &|play| play.normal_left_mm.min(play.normal_right_mm), -1.0),
        },
        SMALLEST_ANGLE.of(ARCSEC_PER_RAD * least_rad),
    ])
}

pub(super) fn double_flank(rolled: &RolledPair) -> Section {
    let masters = MASTERS.iter().zip(&rolled.masters);
    let parts = [(&MATE, &rolled.tight)].into_iter().chain(masters).map(|(group, found)| match found {
        Ok(found) => group.section(entries(found)).table(tables::double_flank(group.key, found)),
        Err(why) => group.section([TIGHT_RANGE.none(why.clone())]),
    });
    DOUBLE_FLANK.section([]).parts(parts)
}

fn entries(found: &DoubleFlank) -> [Entry; 4] {
    let at = largest_at(found.variation_rad_um.iter().map(|[_, um]| *um));
    let place = Place::default().and("angle_deg", found.variation_rad_um[at][0].to_degrees());
    [
        TIGHT_RANGE.of(found.total_um()),
        TIGHT_STEP.of(found.in_a_pitch_um()),
        TIGHT_MEAN.of(found.mean_um()),
        TIGHT_LARGEST.of(found.variation_rad_um[at][1]).at(place),
    ]
}
