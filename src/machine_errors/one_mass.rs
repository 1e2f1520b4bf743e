//! Vibration of one mass on a spring under the force of the chip that it cuts itself: chatter.
//!
//! In: compliance, natural frequency and damping ratio of one coordinate of the machine; the force of a stroke's chips
//! ([`ChipForce`]). Out: displacements moment by moment, stroke after stroke; the limit of stability.
//!
//! Law (S. A. Tobias, *Machine-Tool Vibration*, 1965; Y. Altintas, *Manufacturing Automation*, 2nd ed. 2012, section
//! 4.2): the chip is as thick as the feed plus the wave that the stroke before has left, less the mass's own
//! displacement,
//!
//! ```text
//! x'' + 2 zeta w x' + w^2 x = C w^2 F(x - y),    y(z) = x of the stroke before at the same place
//! ```
//!
//! Linear in K = -dF/dx, with the receptance Phi(w_c) = C / (1 - r^2 + 2 i zeta r), r = w_c / w: a wave of the
//! frequency w_c keeps its height from stroke to stroke at
//!
//! ```text
//! K = -1 / (2 Re Phi),    w_c T = 2 pi k + 3 pi + 2 atan2(Im Phi, Re Phi)
//! ```
//!
//! T being the time from stroke to stroke if the mass cuts all the time. The least K of all speeds is 2 zeta (1 + zeta)
//! / C. A ram comes back: the mass rings down meanwhile, no wave has to fit between two strokes, and that least K is
//! the limit at every speed. Beyond it a wave grows from stroke to stroke, by |K Phi / (1 + K Phi)| at most.
//!
//! Steps are exact for a force that runs straight between two moments; the force at the end of a step is found with the
//! displacement there, so that edges which begin to cut, stiff as they are, shake nothing.
//!
//! Road not taken: Runge and Kutta's steps. Contact comes and goes within tenths of a micrometre, and they would have
//! to follow that.

use super::chip_force::ChipForce;
use std::f64::consts::TAU;

/// One mass: a coordinate of the machine, in mm or rad, and its forces, in N or N mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneMass {
    /// C: displacement under a force that lasts, mm/N or rad/(N mm).
    pub compliance: f64,
    /// w: undamped, in rad/s.
    pub natural_rad_per_s: f64,
    /// zeta: damping over the critical one.
    pub damping_ratio: f64,
}

impl OneMass {
    /// Displacement and speed after a while without a force: a matrix.
    fn free(&self, time_s: f64) -> [[f64; 2]; 2] {
        let (w, zeta) = (self.natural_rad_per_s, self.damping_ratio);
        let damped = w * (1.0 - zeta * zeta).sqrt();
        let (sin, cos) = (damped * time_s).sin_cos();
        let (decay, sin) = ((-zeta * w * time_s).exp(), sin / damped);
        [[decay * (cos + zeta * w * sin), decay * sin], [-decay * w * w * sin, decay * (cos - zeta * w * sin)]]
    }

    /// K beyond which no speed is stable without exception: 2 zeta (1 + zeta) / C.
    pub fn least_limit(&self) -> f64 {
        2.0 * self.damping_ratio * (1.0 + self.damping_ratio) / self.compliance
    }

    /// A step in which the force runs straight.
    fn step(&self, time_s: f64) -> MassStep {
        let free = self.free(time_s);
        // Under a force F + F' t the mass follows C (F + F' t) - C 2 zeta / w F'.
        let (c, lag) = (self.compliance, 2.0 * self.damping_ratio / self.natural_rad_per_s);
        let of_force = |at_start: f64, at_end: f64| {
            let rate = (at_end - at_start) / time_s;
            let (start, end, speed) = (c * (at_start - lag * rate), c * (at_end - lag * rate), c * rate);
            [end - free[0][0] * start - free[0][1] * speed, speed - free[1][0] * start - free[1][1] * speed]
        };
        MassStep { free, of_start: of_force(1.0, 0.0), of_end: of_force(0.0, 1.0) }
    }
}

/// What a step makes of displacement and speed, and what the forces at its start and its end add.
#[derive(Debug, Clone, Copy)]
struct MassStep {
    free: [[f64; 2]; 2],
    of_start: [f64; 2],
    of_end: [f64; 2],
}

/// A mass that cuts stroke after stroke, and the surface that it has left.
#[derive(Debug, Clone)]
pub struct Chatter {
    mass: OneMass,
    step: MassStep,
    /// Displacement and speed.
    state: [f64; 2],
    /// Surfaces that the last stroke has left on both sides, over those of a mass at rest, moment by moment.
    surfaces: Vec<[f64; 2]>,
}

impl Chatter {
    /// A mass at rest over a smooth surface; a stroke takes so many steps of `step_s`.
    pub fn new(mass: OneMass, step_s: f64, steps: usize) -> Self {
        Self { mass, step: mass.step(step_s), state: [0.0; 2], surfaces: vec![[0.0; 2]; steps + 1] }
    }

    /// A stroke whose chips hold the mass at `rest` in the mean of time: displacements from there, moment by moment.
    /// Without chips the stroke cuts nothing.
    pub fn stroke(&mut self, sides: &[ChipForce; 2], rest: f64) -> Vec<f64> {
        let cuts = sides.iter().any(ChipForce::is_in_cut);
        // The balance has what holds the mass at rest, and differences of the chips add.
        let held = rest / self.mass.compliance - total(sides, 0.0, [0.0; 2])[0];
        let MassStep { free, of_start, of_end } = self.step;
        let mut push = if cuts { held + total(sides, self.state[0] - rest, self.surfaces[0])[0] } else { 0.0 };
        let mut found = Vec::with_capacity(self.surfaces.len());
        for (moment, surfaces) in self.surfaces.iter_mut().enumerate() {
            if moment > 0 {
                let [x, v] = self.state;
                let without = [0, 1].map(|row| free[row][0] * x + free[row][1] * v + of_start[row] * push);
                push = if cuts {
                    let off = meeting(sides, *surfaces, without[0] + of_end[0] * held - rest, of_end[0]);
                    held + total(sides, off, *surfaces)[0]
                } else {
                    0.0
                };
                self.state = [0, 1].map(|row| without[row] + of_end[row] * push);
            }
            let off = self.state[0] - rest;
            let left = |side: usize| surfaces[side] + sides[side].surface(off - surfaces[side]);
            *surfaces = [0, 1].map(|side| if sides[side].is_in_cut() { left(side) } else { 0.0 });
            found.push(off);
        }
        found
    }

    /// The way back: the mass rings down.
    pub fn ring_down(&mut self, time_s: f64) {
        let [x, v] = self.state;
        self.state = self.mass.free(time_s).map(|row| row[0] * x + row[1] * v);
    }

    /// How a mass is followed: steps of a natural period. A force in straight pieces is then 0.2 % too small.
    pub fn steps_in(mass: &OneMass, time_s: f64) -> usize {
        (STEPS_OF_A_PERIOD * time_s * mass.natural_rad_per_s / TAU).ceil().max(1.0) as usize
    }
}

/// Force and slope of both sides on a mass `off` its rest, over surfaces.
fn total(sides: &[ChipForce; 2], off: f64, surfaces: [f64; 2]) -> [f64; 2] {
    let [a, b] = [sides[0].at(off - surfaces[0]), sides[1].at(off - surfaces[1])];
    [a[0] + b[0], a[1] + b[1]]
}

/// The place off = `from` + `per_force` F(off), `per_force` being positive: Newton's steps, which end on a broken line.
fn meeting(sides: &[ChipForce; 2], surfaces: [f64; 2], from: f64, per_force: f64) -> f64 {
    let (mut off, mut between) = (from, [f64::NEG_INFINITY, f64::INFINITY]);
    for _ in 0..MOST_STEPS {
        let [force, slope] = total(sides, off, surfaces);
        let missing = from + per_force * force - off;
        if missing.abs() <= MET * (1.0 + off.abs()) {
            break;
        }
        between[usize::from(missing < 0.0)] = off;
        let next = off + missing / (1.0 - per_force * slope);
        off = if next > between[0] && next < between[1] { next } else { 0.5 * (between[0] + between[1]) };
    }
    off
}

/// Newton's steps at most; two are usual.
const MOST_STEPS: usize = 60;
/// How near they come, mm or rad.
const MET: f64 = 1e-14;
/// See [`Chatter::steps_in`].
const STEPS_OF_A_PERIOD: f64 = 40.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine_errors::EdgeElement;
    use glam::DVec4;
    use std::f64::consts::PI;

    const MASS: OneMass = OneMass { compliance: 1e-5, natural_rad_per_s: 900.0, damping_ratio: 0.03 };

    /// A tool square to the work with a chip thick enough for every wave here.
    fn fixed_tool(stiffness: f64) -> [ChipForce; 2] {
        let element = EdgeElement { thickness_mm: 10.0, moves: -DVec4::X, chip_n_per_mm: stiffness, edge_n: 0.0 };
        ChipForce::of_sides(&[element], 0, 0.0)
    }

    /// The free mass against its equation, and a held force against statics.
    #[test]
    fn a_mass_alone_swings_and_rests_as_its_equation_says() {
        let (w, zeta, t, small) = (MASS.natural_rad_per_s, MASS.damping_ratio, 3.1e-3, 1e-6);
        let at = |t: f64| MASS.free(t).map(|row| 0.2 * row[0] + 70.0 * row[1]);
        let [before, now, after] = [at(t - small), at(t), at(t + small)];
        let rate = |i: usize| (after[i] - before[i]) / (2.0 * small);
        assert!((rate(0) - now[1]).abs() < 1e-5 * now[1].abs());
        let wanted = -2.0 * zeta * w * now[1] - w * w * now[0];
        assert!((rate(1) - wanted).abs() < 1e-5 * wanted.abs());
        let step = MASS.step(1e-3);
        let held = 500.0;
        let mut state = [0.0; 2];
        for _ in 0..2000 {
            state = [0, 1].map(|i| {
                step.free[i][0] * state[0] + step.free[i][1] * state[1] + held * (step.of_start[i] + step.of_end[i])
            });
        }
        assert!((state[0] / (held * MASS.compliance) - 1.0).abs() < 1e-12 && state[1].abs() < 1e-9);
    }

    /// Growth of the waves of a fixed tool that cuts all the time, over so many delays; `wave` says whether it meets
    /// the surface that it has left.
    fn growth(stiffness: f64, delay_s: f64, wave: bool) -> f64 {
        let steps = 2 * Chatter::steps_in(&MASS, delay_s);
        let (force, step_s) = (fixed_tool(stiffness), delay_s / steps as f64);
        let rest = MASS.compliance * force[0].at(0.0)[0];
        let mut chatter = Chatter::new(MASS, step_s, steps);
        chatter.surfaces[..20].fill([1e-3; 2]);
        chatter.state[0] = rest;
        let delays = (1.2 / delay_s).ceil() as usize;
        let height = |found: &[f64]| found.iter().fold(0.0_f64, |most, off| most.max(off.abs()));
        let mut heights = Vec::new();
        for _ in 0..delays {
            heights.push(height(&chatter.stroke(&force, rest)));
            if !wave {
                chatter.surfaces.fill([0.0; 2]);
            }
        }
        let quarter = heights.len() / 4;
        height(&heights[heights.len() - quarter..]) / height(&heights[quarter..2 * quarter])
    }

    /// The closed form's limit and delay at chatter frequencies over the natural one: a foot of the lobes, its right
    /// side, and towards a peak, with whole periods between strokes.
    fn speeds() -> Vec<(f64, f64)> {
        let foot = (1.0 + 2.0 * MASS.damping_ratio).sqrt();
        let at = |r: f64, periods: f64| {
            let (waves, damping) = (r * MASS.natural_rad_per_s, 2.0 * MASS.damping_ratio * r);
            let scale = MASS.compliance / ((1.0 - r * r).powi(2) + damping * damping);
            let (real, imaginary) = (scale * (1.0 - r * r), -scale * damping);
            (-0.5 / real, (3.0 * PI + 2.0 * imaginary.atan2(real) + TAU * periods) / waves)
        };
        vec![at(foot, 0.0), at(foot, 3.0), at(1.12, 0.0), at(1.12, 1.0), at(1.3, 0.0), at(1.02, 2.0)]
    }

    /// Two per cent below the closed form's limit a fixed tool's waves die out, as much above they grow: at a foot of
    /// the lobes, at their sides, towards a peak.
    #[test]
    fn a_fixed_tool_is_stable_up_to_the_closed_form_of_one_mass() {
        let least = MASS.least_limit();
        for (limit, delay_s) in speeds() {
            let [below, above] = [0.98, 1.02].map(|share| growth(share * limit, delay_s, true));
            println!("{:.3} of the least limit at {:.2} ms: {below:.3}, {above:.3}", limit / least, 1e3 * delay_s);
            assert!(limit > 0.999_999 * least && below < 0.99 && above > 1.01, "{below} {above}");
        }
    }

    /// The comparison can fail: a tool that meets no waves is stable everywhere; at another delay the limit is another.
    #[test]
    fn without_regeneration_or_at_another_delay_the_limit_is_another() {
        let (least, _) = speeds()[0];
        for (limit, delay_s) in speeds() {
            assert!(growth(3.0 * limit, delay_s, false) < 1.0);
            let foot = limit < 1.01 * least;
            if foot {
                // Half a wave more or less between strokes: towards the peak, where as much is stable.
                let off_s = PI / (MASS.natural_rad_per_s * (1.0 + MASS.damping_ratio));
                assert!(growth(1.04 * limit, delay_s + 0.6 * off_s, true) < 0.97, "{delay_s}");
            }
        }
    }

    /// Strokes after which the mass comes to rest: waves grow beyond the least limit at any speed, and die below; in
    /// the middle of a long stroke by |K Phi / (1 + K Phi)|, most at the worst frequency.
    #[test]
    fn strokes_with_a_way_back_are_stable_up_to_the_least_limit() {
        let growth_of = |share: f64, r: f64| {
            let stiffness = share * MASS.least_limit();
            let (stiff, damping) = (1.0 - r * r, 2.0 * MASS.damping_ratio * r);
            // K Phi over 1 + K Phi with Phi = C / (stiff + i damping).
            let k = stiffness * MASS.compliance;
            let exact = k / (stiff + k).hypot(damping);
            let waves = r * MASS.natural_rad_per_s;
            let step_s = TAU / MASS.natural_rad_per_s / 160.0;
            let steps = 160 * 60;
            let mut chatter = Chatter::new(MASS, step_s, steps);
            for (i, surfaces) in chatter.surfaces.iter_mut().enumerate() {
                *surfaces = [1e-3 * (waves * step_s * i as f64).cos(); 2];
            }
            let force = fixed_tool(stiffness);
            let rest = MASS.compliance * force[0].at(0.0)[0];
            chatter.state[0] = rest;
            let found = chatter.stroke(&force, rest);
            let last = &found[found.len() - 160 * 20..];
            (last.iter().fold(0.0_f64, |most, off| most.max(off.abs())) / 1e-3, exact)
        };
        let worst = (1.0 + 2.0 * MASS.damping_ratio).sqrt();
        for (share, r) in [(0.9, worst), (1.0, worst), (1.5, worst), (1.5, 0.9), (0.5, 1.1)] {
            let (found, exact) = growth_of(share, r);
            println!("{share} of the limit, r = {r:.3}: {found:.4} a stroke for {exact:.4}");
            assert!((found / exact - 1.0).abs() < 5e-3, "{found} for {exact}");
        }
        assert!((growth_of(1.0, worst).1 - 1.0).abs() < 1e-9, "the limit is where waves keep their height");
    }
}
