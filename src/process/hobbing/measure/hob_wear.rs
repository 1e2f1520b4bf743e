//! Flank wear of every hob tooth, place by place along its edge, and how many gears the hob lasts.
//!
//! In: what every pass took of the blank field slice by slice and place by place of the edge, the hob's motion, a law
//! with two constants. Out: [`HobWear`].
//!
//! **Law.** Over a length of cut l an edge wears by VB = VB_lim l / L(h, v): in proportion to the length, as in the
//! steady stage of Archard's law (J. F. Archard, J. Appl. Phys. 24, 1953, 981-988: worn volume in proportion to the
//! sliding distance). L, the length of cut after which VB_lim is reached, is Taylor's tool life times the speed
//! (F. W. Taylor, On the Art of Cutting Metals, Trans. ASME 28, 1907: v T^n = C, n = 1/8 for high-speed steel), with a
//! power of the chip thickness beside it, as the feed in his equation:
//!
//! `L(h, v) = L_1 (h / h_1)^-x (v / v_1)^-(1/n - 1)`.
//!
//! Shares of life add up in any order. L_1 and x are the two constants; h_1, v_1 and n are given. That wear of
//! a hob tooth is the sum over its cuts, and that a shift lays the same sum over other teeth, is the way of K.-D.
//! Bouzakis and A. Antoniadis (CIRP Annals 44, 1995, 75-78); their own equation has more constants, which take
//! fly-hobbing tests.
//!
//! **Equivalent length.** What a gear costs a place of a tooth is A = sum of l (h / h_1)^x (v / v_1)^(1/n - 1), the
//! length of cut by chips h_1 thick at the speed v_1 that wears as much. l is the area that the place swept in material
//! in one slice over the place's length, h the mean thickness there. VB = VB_lim N A / L_1 after N gears; the hob is
//! done when the place with the largest A is. A does not know L_1, so the gears that one hob was seen to cut give L_1.
//!
//! Roads not taken. Wear by temperature and stress (E. Usui, T. Shirakashi, T. Kitagawa, Wear 100, 1984): neither is
//! computed here. VB as a power of the length: a third constant, which the gears to the limit alone cannot tell from
//! L_1. The largest chip thickness of a tooth as h: one plunging cut in a thousand would decide.

use crate::process::hobbing::linkage::HobbingLinkage;
use crate::process::hobbing::scene::model::WearLife;
use gearcut_core::cut::sweep_chips::PassChip;
use gearcut_core::passes::TurningPasses;
use gearcut_core::passes::sections::swept_sections::EDGE_PLACES;
use std::ops::Range;

/// Names of the places along an edge: from the depth of the flank that faces the entering end, over the tip, to the
/// depth of the other; 1 is next to the tip.
pub const PLACE_NAMES: [&str; EDGE_PLACES] =
    ["entering_4", "entering_3", "entering_2", "entering_1", "tip", "leaving_1", "leaving_2", "leaving_3", "leaving_4"];
/// Teeth with at least this share of the largest wear are called worn: 0.02 mm at a limit of 0.2 mm, about what a
/// measuring microscope tells from a new edge.
pub const WORN: f64 = 0.1;
/// Teeth with at least this share are called evenly worn.
pub const EVEN: f64 = 0.9;
/// Teeth with less than this share count as idle where the hob is shifted.
const IDLE: f64 = 0.01;

/// How life depends on chip and speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WearLaw {
    /// x.
    pub thickness_exponent: f64,
    /// h_1, mm.
    pub thickness_mm: f64,
    /// v_1, mm/s.
    pub speed_mm_per_s: f64,
    /// n.
    pub taylor_exponent: f64,
}

impl WearLaw {
    /// What a length of cut counts for: L_1 / L(h, v).
    pub fn weight(&self, thickness_mm: f64, speed_mm_per_s: f64) -> f64 {
        (thickness_mm / self.thickness_mm).powf(self.thickness_exponent)
            * (speed_mm_per_s / self.speed_mm_per_s).powf(self.taylor_exponent.recip() - 1.0)
    }
}

/// A number for every place of every tooth.
pub type OfPlaces = Vec<[f64; EDGE_PLACES]>;

/// What one gear costs the places of a hob's edges.
#[derive(Debug, Clone, PartialEq)]
pub struct GearCost {
    /// Equivalent length A by tooth and place, mm.
    pub equivalent_mm: OfPlaces,
    /// Length of cut, mm.
    pub length_mm: OfPlaces,
    /// The same times the chip thickness, mm^2.
    pub thick_mm2: OfPlaces,
}

impl GearCost {
    /// Of a gear that costs nothing.
    pub fn nothing(teeth: usize) -> Self {
        let none = || vec![[0.0; EDGE_PLACES]; teeth];
        Self { equivalent_mm: none(), length_mm: none(), thick_mm2: none() }
    }

    /// Adds an operation of a hob with this tip radius, whose edges' places have these lengths, from what its passes
    /// took slice by slice.
    pub fn add(
        &mut self,
        law: &WearLaw,
        passes: &TurningPasses,
        linkage: &HobbingLinkage,
        tip_radius_mm: f64,
        lengths_mm: &[f64; EDGE_PLACES],
        in_slices: &[PassChip],
    ) {
        let mut speeds: Vec<Option<f64>> = vec![None; passes.count() as usize];
        for chip in in_slices {
            let index = chip.pass - passes.first_pass;
            let speed_mm_per_s = *speeds[index as usize].get_or_insert_with(|| {
                let time_s = linkage.time_at_hob_angle(passes.pass(index).tool_angle_rad);
                tip_radius_mm * linkage.axes::<2>(time_s).hob_rad.derivative(1)
            });
            let tooth = passes.blade_of(chip.pass).1 as usize;
            for (place, work) in chip.edge.iter().enumerate().filter(|(_, work)| work.swept_mm2 > 0.0) {
                let length_mm = f64::from(work.swept_mm2) / lengths_mm[place];
                let thickness_mm = f64::from(work.thick_mm3) / f64::from(work.swept_mm2);
                self.equivalent_mm[tooth][place] += length_mm * law.weight(thickness_mm, speed_mm_per_s);
                self.length_mm[tooth][place] += length_mm;
                self.thick_mm2[tooth][place] += length_mm * thickness_mm;
            }
        }
    }

    /// Tooth and place with the largest equivalent length; `None` where nothing was cut.
    pub fn first(&self) -> Option<[usize; 2]> {
        let all = self.equivalent_mm.iter().enumerate();
        let all =
            all.flat_map(|(tooth, places)| places.iter().enumerate().map(move |(place, &mm)| ([tooth, place], mm)));
        all.filter(|&(_, mm)| mm > 0.0).max_by(|a, b| a.1.total_cmp(&b.1)).map(|(at, _)| at)
    }

    /// The largest equivalent length, mm.
    pub fn largest_mm(&self) -> f64 {
        self.first().map_or(0.0, |[tooth, place]| self.equivalent_mm[tooth][place])
    }

    /// Mean chip thickness at a place, mm.
    pub fn mean_thickness_mm(&self, [tooth, place]: [usize; 2]) -> f64 {
        self.thick_mm2[tooth][place] / self.length_mm[tooth][place]
    }

    /// Wear of every tooth where it has the most, over that of the place that wears first.
    pub fn shares(&self) -> Vec<f64> {
        let largest_mm = self.largest_mm();
        self.equivalent_mm.iter().map(|places| most(places) / largest_mm).collect()
    }

    /// The largest equivalent length if all teeth took the same, mm: no shift lasts longer.
    pub fn even_mm(&self) -> f64 {
        let sums = self.equivalent_mm.iter().fold([0.0; EDGE_PLACES], |mut sums, places| {
            sums.iter_mut().zip(places).for_each(|(sum, mm)| *sum += mm);
            sums
        });
        most(&sums) / self.equivalent_mm.len() as f64
    }
}

/// The largest of the places.
pub fn most(places: &[f64; EDGE_PLACES]) -> f64 {
    places.iter().copied().fold(0.0, f64::max)
}

/// First and last tooth with at least this share, by index, and how many there are; `None` where there is none.
pub fn band(shares: &[f64], least: f64) -> Option<([usize; 2], usize)> {
    let is_in = |&share: &f64| share >= least;
    let [first, last] = [shares.iter().position(is_in)?, shares.iter().rposition(is_in)?];
    Some(([first, last], shares.iter().filter(|share| is_in(share)).count()))
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
    let largest = share.iter().map(most).fold(0.0, f64::max);
    let works = |tooth: usize| most(&share[tooth]) > IDLE * largest;
    let (mut before, mut behind) = (usize::MAX, usize::MAX);
    for thread in threads {
        let Some(first) = thread.clone().find(|&tooth| works(tooth)) else { continue };
        let last = thread.clone().rfind(|&tooth| works(tooth)).unwrap_or(first);
        before = before.min(first - thread.start);
        behind = behind.min(thread.end - 1 - last);
    }
    if largest == 0.0 || before == 0 || behind == 0 {
        return None;
    }
    let mut found = Vec::new();
    for (room, sign) in [(behind.min(room[0]), 1.0), (before.min(room[1]), -1.0)] {
        if room == 0 {
            continue;
        }
        for step in [0.25, 0.5].into_iter().chain((1..=room).map(|teeth| teeth as f64)) {
            let places = (room as f64 / step) as usize + 1;
            let loads: Vec<OfPlaces> = (0..places).map(|i| moved(threads, share, sign * step * i as f64)).collect();
            for then in ShiftReturn::ALL {
                let order: Vec<usize> = match then {
                    ShiftReturn::Repeating => (0..places).collect(),
                    ShiftReturn::Reciprocating => (0..places).chain((1..places - 1).rev()).collect(),
                };
                let gears = gears(&order.iter().map(|&i| &loads[i]).collect::<Vec<_>>());
                found.push(GearShift { teeth: sign * step, places, then, gears });
            }
        }
    }
    Some(found)
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

/// One reading of the law: what a gear costs by it, and L_1.
#[derive(Debug, Clone, PartialEq)]
pub struct WearEstimate {
    /// What a gear costs.
    pub cost: GearCost,
    /// L_1, mm.
    pub life_mm: f64,
}

impl WearEstimate {
    /// Gears until the first place of an edge reaches the limit; infinite where nothing is cut.
    pub fn gears(&self) -> f64 {
        self.life_mm / self.cost.largest_mm()
    }

    /// Gears if all teeth of the hob wore alike.
    pub fn gears_if_even(&self) -> f64 {
        self.life_mm / self.cost.even_mm()
    }

    /// Share of its life that one gear takes of every place.
    pub fn share_of_life(&self) -> OfPlaces {
        let of = |places: &[f64; EDGE_PLACES]| places.map(|mm| mm / self.life_mm);
        self.cost.equivalent_mm.iter().map(of).collect()
    }
}

/// Wear of a hob over all operations of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct HobWear {
    /// The law, with v_1 that holds.
    pub law: WearLaw,
    /// By the constants.
    pub by_constants: WearEstimate,
    /// By the ends of their ranges, each with each; none where neither has one.
    pub by_ends: Vec<WearEstimate>,
}

impl HobWear {
    /// By a law; `exponents` are the ends of the range of x, if it has one, and `cost` is what a gear costs by a law.
    pub fn new(
        law: WearLaw,
        life: &WearLife,
        exponents: Option<[f64; 2]>,
        cost: impl Fn(&WearLaw) -> GearCost,
    ) -> Self {
        let of = |thickness_exponent: f64| cost(&WearLaw { thickness_exponent, ..law });
        let by_constants = of(law.thickness_exponent);
        let ends = exponents.map_or_else(|| vec![by_constants.clone()], |ends| ends.map(of).into());
        let by_ends = match life.ends(exponents.is_some()) {
            Some(lives) => ends
                .into_iter()
                .flat_map(|cost| lives.map(|life| WearEstimate { life_mm: life.length_mm(&cost), cost: cost.clone() }))
                .collect(),
            None => Vec::new(),
        };
        let life_mm = life.length_mm(&by_constants);
        Self { law, by_constants: WearEstimate { cost: by_constants, life_mm }, by_ends }
    }

    /// Smallest and largest value by the ends of the constants' ranges; `None` where neither has one.
    pub fn range(&self, value: impl Fn(&WearEstimate) -> f64) -> Option<[f64; 2]> {
        let values = self.by_ends.iter().map(value);
        let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], value| [a.min(value), b.max(value)]);
        (!self.by_ends.is_empty()).then_some(ends)
    }
}

impl WearLife {
    /// L_1 for a hob whose gear costs this, mm.
    fn length_mm(self, cost: &GearCost) -> f64 {
        match self {
            Self::Length { mm, .. } => mm,
            Self::Gears(gears) => gears * cost.largest_mm(),
        }
    }

    /// Ends of its range. Gears are whole, so that the limit was passed while the last one was cut. `None`: it has
    /// none, and there is no other range.
    fn ends(self, is_range_named: bool) -> Option<[Self; 2]> {
        match self {
            Self::Length { ends_mm: Some(ends_mm), .. } => Some(ends_mm.map(|mm| Self::Length { mm, ends_mm: None })),
            Self::Length { ends_mm: None, .. } => is_range_named.then_some([self; 2]),
            Self::Gears(gears) => Some([Self::Gears(gears - 1.0), self]),
        }
    }
}

#[cfg(test)]
mod tests;
