//! Flank wear of every tooth of a tool, place by place along its edge, and how many gears the tool lasts.
//!
//! In: lengths of cut with the chip's thickness and the speed, by tooth and place; a law with two constants. Out:
//! [`ToolWear`].
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
//! a tooth is the sum over its cuts is the way of K.-D. Bouzakis and A. Antoniadis (CIRP Annals 44, 1995, 75-78) for
//! hobs; their own equation has more constants, which take fly-hobbing tests.
//!
//! **Equivalent length.** What a gear costs a place of a tooth is A = sum of l (h / h_1)^x (v / v_1)^(1/n - 1), the
//! length of cut by chips h_1 thick at the speed v_1 that wears as much. l is the area that the place swept in material
//! over the place's length, h the mean thickness there. VB = VB_lim N A / L_1 after N gears; the tool is done when the
//! place with the largest A is. A does not know L_1, so the gears that one tool was seen to cut give L_1.
//!
//! Roads not taken. Wear by temperature and stress (E. Usui, T. Shirakashi, T. Kitagawa, Wear 100, 1984): neither is
//! computed here. VB as a power of the length: a third constant, which the gears to the limit alone cannot tell from
//! L_1. The largest chip thickness of a tooth as h: one plunging cut in a thousand would decide.

use crate::scene::tool_wear::{WearLife, WearSpec};
use gearcut_core::passes::sections::swept_sections::EDGE_PLACES;

/// Teeth with at least this share of the largest wear are called worn: 0.02 mm at a limit of 0.2 mm, about what a
/// measuring microscope tells from a new edge.
pub const WORN: f64 = 0.1;
/// Teeth with at least this share are called evenly worn.
pub const EVEN: f64 = 0.9;
/// Steps through the range of x. The equivalent lengths are convex in x, so that gears have one maximum: an end of an
/// interval between two steps is missed by little.
const EXPONENT_STEPS: u32 = 16;

/// A chip as a place of an edge cuts it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutChip {
    /// Mean uncut thickness along the place, mm.
    pub thickness_mm: f64,
    /// Speed of the cut, mm/s.
    pub speed_mm_per_s: f64,
}

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

/// What one gear costs the places of a tool's edges.
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

    /// Adds a length of cut of a place through chips of this mean thickness, at this speed.
    pub fn add(&mut self, law: &WearLaw, [tooth, place]: [usize; 2], length_mm: f64, chip: CutChip) {
        self.equivalent_mm[tooth][place] += length_mm * law.weight(chip.thickness_mm, chip.speed_mm_per_s);
        self.length_mm[tooth][place] += length_mm;
        self.thick_mm2[tooth][place] += length_mm * chip.thickness_mm;
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

    /// Gears if all teeth of the tool wore alike.
    pub fn gears_if_even(&self) -> f64 {
        self.life_mm / self.cost.even_mm()
    }

    /// Share of its life that one gear takes of every place.
    pub fn share_of_life(&self) -> OfPlaces {
        let of = |places: &[f64; EDGE_PLACES]| places.map(|mm| mm / self.life_mm);
        self.cost.equivalent_mm.iter().map(of).collect()
    }
}

/// Wear of a tool over all operations of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct ToolWear {
    /// What the scene says.
    pub spec: WearSpec,
    /// The law, with v_1 that holds.
    pub law: WearLaw,
    /// By the constants.
    pub by_constants: WearEstimate,
    /// By values through their ranges, each with each; none where neither has one.
    pub in_ranges: Vec<WearEstimate>,
}

impl ToolWear {
    /// As a scene says, of a tool that finishes with this speed; `cost` is what a gear costs by a law.
    pub fn new(spec: WearSpec, own_mm_per_s: f64, cost: impl Fn(&WearLaw) -> GearCost) -> Self {
        let law = WearLaw {
            thickness_exponent: spec.thickness_exponent,
            thickness_mm: spec.thickness_mm,
            speed_mm_per_s: spec.speed_mm_per_s.unwrap_or(own_mm_per_s),
            taylor_exponent: spec.taylor_exponent,
        };
        let of = |thickness_exponent: f64| cost(&WearLaw { thickness_exponent, ..law });
        let by_constants = of(law.thickness_exponent);
        let exponents = spec.thickness_exponent_ends;
        let mut costs = vec![by_constants.clone()];
        // The place that wears first changes with x: a tool may last longest by one between the ends.
        let steps = exponents.map_or(0..=0, |_| 0..=EXPONENT_STEPS);
        costs.extend(exponents.into_iter().flat_map(|[from, to]| {
            let of = &of;
            steps.clone().map(move |step| of(from + (to - from) * f64::from(step) / f64::from(EXPONENT_STEPS)))
        }));
        let in_ranges = match spec.life.ends(exponents.is_some()) {
            Some(lives) => costs
                .into_iter()
                .flat_map(|cost| lives.map(|life| WearEstimate { life_mm: life.length_mm(&cost), cost: cost.clone() }))
                .collect(),
            None => Vec::new(),
        };
        let life_mm = spec.life.length_mm(&by_constants);
        Self { spec, law, by_constants: WearEstimate { cost: by_constants, life_mm }, in_ranges }
    }

    /// Smallest and largest value through the constants' ranges; `None` where neither has one.
    pub fn range(&self, value: impl Fn(&WearEstimate) -> f64) -> Option<[f64; 2]> {
        let values = self.in_ranges.iter().map(value);
        let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], value| [a.min(value), b.max(value)]);
        (!self.in_ranges.is_empty()).then_some(ends)
    }
}

impl WearLife {
    /// L_1 for a tool whose gear costs this, mm.
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
mod tests {
    use super::*;

    const LAW: WearLaw =
        WearLaw { thickness_exponent: 2.0, thickness_mm: 0.1, speed_mm_per_s: 1000.0, taylor_exponent: 0.125 };

    /// By hand: L = 30 m at 0.1 mm and 1 m/s. Chips half as thick let x = 2 make it 120 m; a fifth more speed divides
    /// that by 1.2^7 = 3.5832.
    #[test]
    fn life_of_one_chip_is_that_by_hand() {
        let life_m = 30.0 / LAW.weight(0.05, 1200.0);
        assert!((life_m - 120.0 / 3.583_180_8).abs() < 1e-9, "{life_m}");
    }

    /// Taylor: v T^n = C at any speed, under one chip.
    #[test]
    fn tool_life_under_one_chip_is_taylors() {
        let constant = |speed_mm_per_s: f64| {
            let life_s = 30e3 / LAW.weight(0.1, speed_mm_per_s) / speed_mm_per_s;
            speed_mm_per_s * life_s.powf(LAW.taylor_exponent)
        };
        let at = constant(1000.0);
        for speed in [300.0, 700.0, 2500.0] {
            assert!((constant(speed) / at - 1.0).abs() < 1e-12, "{speed}");
        }
    }

    /// Two places, 10 mm of thin chips and 3 mm of thick ones: 10 / 2^x and 3 2^x are the same at 4^x = 10 / 3, and
    /// there the tool lasts longest. Between the ends of the range of x it lasts longer than at both.
    #[test]
    fn intervals_know_of_lives_between_the_ends() {
        let spec = WearSpec {
            limit_mm: 0.2,
            life: WearLife::Length { mm: 1000.0, ends_mm: None },
            thickness_exponent: 0.9,
            thickness_exponent_ends: Some([0.5, 1.5]),
            thickness_mm: 0.1,
            speed_mm_per_s: None,
            taylor_exponent: 0.125,
        };
        let worn = ToolWear::new(spec, 1000.0, |law| {
            let mut cost = GearCost::nothing(1);
            for (place, length_mm, thickness_mm) in [(0, 10.0, 0.05), (1, 3.0, 0.2)] {
                cost.add(law, [0, place], length_mm, CutChip { thickness_mm, speed_mm_per_s: 1000.0 });
            }
            cost
        });
        let [from, to] = worn.range(WearEstimate::gears).expect("a range");
        let most = 1000.0 / 30_f64.sqrt();
        assert!((from - 1000.0 / (3.0 * 2_f64.powf(1.5))).abs() < 1e-9, "{from}");
        assert!(to <= most * (1.0 + 1e-12) && to > 0.98 * most, "{to} against {most}");
        let own = worn.by_constants.gears();
        assert!(from <= own && own <= to, "{own}");
    }
}
