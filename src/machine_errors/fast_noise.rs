//! Noise of machines whose passes keep the motion as polynomials over eighths of a turn of the tool.
//!
//! In: noise of axes, the speed of a tool that is in the work all the time. Out: the knots between which the noise is
//! smooth, so that those polynomials ([`gearcut_core::passes::MotionTable`]) and those of every tile follow it; a
//! refusal where the noise is too fast for the knots.
//!
//! Road not taken: polynomials through the rough process itself. Neighbouring ones meet at steps of up to half its
//! standard deviation, each tile of dexels sees other steps, and a pass that one tile culls may be lowest in the next.

use super::axis::AxisErrors;
use gearcut_core::error::Refusal;

/// Largest bandwidth, per turn of the tool: what forgets over 0.8 of a turn has six knots in that time.
const MOST_PER_TURN: f64 = 0.2;
/// Knots of smooth noise in a turn of the tool. The spline's fourth rate is then about nine standard deviations per
/// rad^4 at the largest bandwidth: a cubic over a tile's 0.1 rad follows noise of 10 um to a nanometre.
const KNOTS_PER_TURN: f64 = 8.0;

/// Time between knots of smooth noise, s.
pub fn noise_knots_s(tool_turns_per_s: f64) -> f64 {
    1.0 / (KNOTS_PER_TURN * tool_turns_per_s)
}

/// Refuses noise that polynomials over eighths of a turn of the tool do not follow; `names` are those of the axes'
/// sections.
///
/// # Errors
/// A bandwidth above what they follow.
pub fn refuse_fast_noise<'a>(
    axes: impl IntoIterator<Item = (&'a AxisErrors, &'a str)>,
    tool_turns_per_s: f64,
) -> Result<(), Refusal> {
    let most_hz = MOST_PER_TURN * tool_turns_per_s;
    for (errors, name) in axes {
        let mut bandwidths = errors.noise.iter().filter_map(|noise| noise.law.bandwidth_hz());
        if let Some(bandwidth_hz) = bandwidths.find(|&bandwidth_hz| bandwidth_hz > most_hz) {
            return Err(Refusal::new(
                &format!("machine.errors.{name}.noise_bandwidth_hz"),
                format!(
                    "noise up to {bandwidth_hz} Hz is faster than passes follow: {MOST_PER_TURN} in a turn of the \
                    tool, {most_hz:.3} Hz"
                ),
                "take a smaller bandwidth, and the part of the noise that is below it",
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::noise::{AxisNoise, NoiseLaw};
    use super::*;
    use crate::random::Draws;
    use gearcut_core::frame::Rigid3;
    use gearcut_core::passes::MotionTable;
    use glam::{DMat3, DVec3};
    use std::f64::consts::TAU;

    fn noise(bandwidth_hz: f64) -> AxisNoise {
        AxisNoise { deviation: 3.0, law: NoiseLaw::InTime { bandwidth_hz }, draws: Draws::new(8, 0) }
    }

    #[test]
    fn fast_noise_is_refused_where_passes_do_not_follow_it() {
        let axis = |bandwidth_hz: f64| AxisErrors { noise: vec![noise(bandwidth_hz)], ..AxisErrors::default() };
        assert!(refuse_fast_noise([(&axis(1.0), "work")], 5.0).is_ok());
        let refusal = refuse_fast_noise([(&axis(1.1), "work")], 5.0).expect_err("too fast");
        assert!(refusal.to_string().contains("machine.errors.work.noise_bandwidth_hz"), "{refusal}");
    }

    /// The fastest noise that is allowed, through the table that passes keep of a motion.
    #[test]
    fn polynomials_keep_the_noise_that_they_are_given() {
        let noise = noise(MOST_PER_TURN);
        let turns = 300.0;
        let exact = |angle: f64| noise.smoothed_at(angle / TAU, 0, noise_knots_s(1.0));
        let table = MotionTable::new([0.0, turns * TAU], &[], |angle| Rigid3 {
            rotation: DMat3::IDENTITY,
            translation_mm: DVec3::new(exact(angle), 0.0, 0.0),
        });
        let (mut kept, mut given, mut apart) = (0.0, 0.0, 0.0);
        for place in 0..4_000 {
            let angle = f64::from(place) / 4_000.0 * turns * TAU;
            let (found, wanted) = (table.head_from_work(angle).translation_mm.x, exact(angle));
            kept += found * found;
            given += wanted * wanted;
            apart += (found - wanted).powi(2);
        }
        let off: f64 = apart / given;
        println!("variance {:.4} of what is given, {:.4} of its standard deviation apart", kept / given, off.sqrt());
        assert!((kept / given - 1.0).abs() < 1e-4, "variance {}", kept / given);
        assert!(off.sqrt() < 1e-4 && off > 0.0, "{} apart", off.sqrt());
    }
}
