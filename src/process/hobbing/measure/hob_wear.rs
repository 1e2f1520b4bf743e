//! What a gear costs the places of a hob's teeth ([`crate::measure::tool_wear`]), and how many gears a hob lasts that
//! is shifted between them.
//!
//! In: what every pass took of the blank field slice by slice and place by place of the edge, the hob's motion, the law
//! of wear. Out: [`GearCost`]; [`GearShift`]s. A shift lays the same sum of cuts over other teeth (K.-D. Bouzakis and
//! A. Antoniadis, CIRP Annals 44, 1995, 75-78).

use crate::measure::tool_wear::{CutChip, GearCost, OfPlaces, WearLaw, most};
use crate::process::hobbing::linkage::HobbingLinkage;
use gearcut_core::cut::sweep_chips::PassChip;
use gearcut_core::passes::TurningPasses;
use gearcut_core::passes::sections::swept_sections::EDGE_PLACES;
use std::ops::Range;

/// Names of the places along an edge: from the depth of the flank that faces the entering end, over the tip, to the
/// depth of the other; 1 is next to the tip.
pub const PLACE_NAMES: [&str; EDGE_PLACES] =
    ["entering_4", "entering_3", "entering_2", "entering_1", "tip", "leaving_1", "leaving_2", "leaving_3", "leaving_4"];
/// Teeth with less than this share count as idle where the hob is shifted.
const IDLE: f64 = 0.01;

/// Speed of the tip of a hob in every pass of an operation that took anything, mm/s; none in the others.
pub fn tip_speeds_mm_per_s(
    passes: &TurningPasses,
    linkage: &HobbingLinkage,
    tip_radius_mm: f64,
    in_slices: &[PassChip],
) -> Vec<Option<f64>> {
    let mut speeds: Vec<Option<f64>> = vec![None; passes.count() as usize];
    for chip in in_slices {
        let index = chip.pass - passes.first_pass;
        speeds[index as usize].get_or_insert_with(|| {
            let time_s = linkage.time_at_hob_angle(passes.pass(index).tool_angle_rad);
            tip_radius_mm * linkage.axes::<2>(time_s).hob_rad.derivative(1)
        });
    }
    speeds
}

/// Adds an operation of a hob whose tip has these speeds and whose edges' places have these lengths, from what its
/// passes took slice by slice.
pub fn add(
    cost: &mut GearCost,
    law: &WearLaw,
    passes: &TurningPasses,
    speeds_mm_per_s: &[Option<f64>],
    lengths_mm: &[f64; EDGE_PLACES],
    in_slices: &[PassChip],
) {
    for chip in in_slices {
        let Some(speed_mm_per_s) = speeds_mm_per_s[(chip.pass - passes.first_pass) as usize] else { continue };
        let tooth = passes.blade_of(chip.pass).1 as usize;
        for (place, work) in chip.edge.iter().enumerate().filter(|(_, work)| work.swept_mm2 > 0.0) {
            let length_mm = f64::from(work.swept_mm2) / lengths_mm[place];
            let thickness_mm = f64::from(work.thick_mm3) / f64::from(work.swept_mm2);
            cost.add(law, [tooth, place], length_mm, CutChip { thickness_mm, speed_mm_per_s });
        }
    }
}

/// How the hob goes on at the end of its room.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShiftReturn {
    /// Back to where it began.
    Repeating,
    /// The other way.
    Reciprocating,
}

impl ShiftReturn {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Repeating, Self::Reciprocating];

    /// As scenes write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Repeating => "repeating",
            Self::Reciprocating => "reciprocating",
        }
    }
}

/// A shift of the hob after every gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GearShift {
    /// How far, in teeth along the thread: positive where the hob moves to its entering end, so that later teeth take
    /// the place of earlier ones.
    pub teeth: f64,
    /// Places that the hob takes, the first one included.
    pub places: usize,
    /// What follows the last one.
    pub then: ShiftReturn,
    /// Gears before any place of an edge passes the limit.
    pub gears: u64,
}

/// Shifts after every gear that a hob has room for, from its place: a quarter, a half, one and more whole teeth.
/// `None`: a tooth at the hob's end works, and the load would not move along with the shift. `threads` are the teeth of
/// each thread, `share` is what one gear takes of the life of every place, `room` how many teeth the hob may move to
/// its entering and to its leaving end before it no longer carries the contact.
pub fn shifts(threads: &[Range<usize>], share: &OfPlaces, room: [usize; 2]) -> Option<Vec<GearShift>> {
    let mut found = Vec::new();
    for (room, sign) in free_teeth(threads, share, room)?.into_iter().zip([1.0, -1.0]).filter(|&(room, _)| room > 0) {
        for step in [0.25, 0.5].into_iter().chain((1..=room).map(|teeth| teeth as f64)) {
            found.extend(by_step(threads, share, room, sign * step));
        }
    }
    Some(found)
}

/// The same shift of a hob that another load wears; `None` where that load leaves no room for it.
pub fn same_shift(threads: &[Range<usize>], share: &OfPlaces, room: [usize; 2], of: &GearShift) -> Option<GearShift> {
    let room = free_teeth(threads, share, room)?[usize::from(of.teeth < 0.0)];
    let has_room = room > 0 && of.teeth.abs() <= room as f64;
    let both = has_room.then(|| by_step(threads, share, room, of.teeth))?;
    both.into_iter().find(|shift| shift.then == of.then)
}

/// How many teeth a hob may move to its entering and to its leaving end with its load.
fn free_teeth(threads: &[Range<usize>], share: &OfPlaces, room: [usize; 2]) -> Option<[usize; 2]> {
    let largest = share.iter().map(most).fold(0.0, f64::max);
    let works = |tooth: usize| most(&share[tooth]) > IDLE * largest;
    let (mut before, mut behind) = (usize::MAX, usize::MAX);
    for thread in threads {
        let Some(first) = thread.clone().find(|&tooth| works(tooth)) else { continue };
        let last = thread.clone().rfind(|&tooth| works(tooth)).unwrap_or(first);
        before = before.min(first - thread.start);
        behind = behind.min(thread.end - 1 - last);
    }
    (largest > 0.0 && before > 0 && behind > 0).then(|| [behind.min(room[0]), before.min(room[1])])
}

/// A shift by so many teeth, with either return at the end of the room.
fn by_step(threads: &[Range<usize>], share: &OfPlaces, room: usize, teeth: f64) -> [GearShift; 2] {
    let places = (room as f64 / teeth.abs()) as usize + 1;
    let loads: Vec<OfPlaces> = (0..places).map(|i| moved(threads, share, teeth * i as f64)).collect();
    ShiftReturn::ALL.map(|then| {
        let order: Vec<usize> = match then {
            ShiftReturn::Repeating => (0..places).collect(),
            ShiftReturn::Reciprocating => (0..places).chain((1..places - 1).rev()).collect(),
        };
        let gears = gears(&order.iter().map(|&i| &loads[i]).collect::<Vec<_>>());
        GearShift { teeth, places, then, gears }
    })
}

/// What a gear costs a hob that has moved by so many teeth; between whole teeth in proportion.
fn moved(threads: &[Range<usize>], share: &OfPlaces, teeth: f64) -> OfPlaces {
    let whole = teeth.floor();
    let part = teeth - whole;
    let mut found = vec![[0.0; EDGE_PLACES]; share.len()];
    for thread in threads {
        for tooth in thread.clone() {
            for (steps, weight) in [(whole, 1.0 - part), (whole + 1.0, part)] {
                let from = tooth as f64 - steps;
                if weight > 0.0 && from >= thread.start as f64 && from < thread.end as f64 {
                    let of = &share[from as usize];
                    found[tooth].iter_mut().zip(of).for_each(|(sum, share)| *sum += weight * share);
                }
            }
        }
    }
    found
}

/// Gears before the first place has used up its life, when gears in turn cost this.
fn gears(in_turn: &[&OfPlaces]) -> u64 {
    let mut used = vec![[0.0; EDGE_PLACES]; in_turn[0].len()];
    let add = |used: &mut OfPlaces, cost: &OfPlaces, times: f64| {
        for (used, cost) in used.iter_mut().flatten().zip(cost.iter().flatten()) {
            *used += times * cost;
        }
    };
    for cost in in_turn {
        add(&mut used, cost, 1.0);
    }
    let turn = used.iter().map(most).fold(0.0, f64::max);
    // Whole turns at once, the last one gear by gear; a share that rounding lifts over 1 counts as 1.
    let turns = ((1.0 + ROUNDING) / turn).floor();
    if turns > MOST_TURNS {
        return (turns as u64).saturating_mul(in_turn.len() as u64);
    }
    used.iter_mut().flatten().for_each(|used| *used *= turns);
    let mut count = turns as u64 * in_turn.len() as u64;
    for cost in in_turn.iter().cycle() {
        add(&mut used, cost, 1.0);
        if used.iter().map(most).fold(0.0, f64::max) > 1.0 + ROUNDING {
            return count;
        }
        count += 1;
    }
    count
}

/// What rounding may add to a sum of shares.
const ROUNDING: f64 = 1e-9;
/// Turns past which single gears no longer count.
const MOST_TURNS: f64 = 1e6;

#[cfg(test)]
mod tests;
