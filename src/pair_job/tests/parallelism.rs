//! Axes out of parallel: gaps over the face of round spur pairs against ISO/TR 10064-3.
//!
//! A deviation f over the face, in the plane of the axes, opens the flanks from end to end by f sin(alpha), and one
//! across that plane by f cos(alpha), along the line of action. Apart means less mesh outside and more of it in a ring,
//! on both sides alike; across, one side closes where the other opens.

use super::*;
use crate::pair::pattern::smallest_gaps;
use crate::pair_job::fit::Fit;
use crate::pair_job::flanks::PairFlanks;
use crate::pair_job::options::PairOptions;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::terms::Side;
use std::f64::consts::TAU;

const SECTIONS: usize = 5;

#[test]
fn gaps_grow_evenly_over_the_face() {
    for (kind, teeth) in [("", 27), ("kind = \"internal\"\nrim_mm = 10.0\n", 54)] {
        let (a, b) = (round("a", 18, "", ""), round("b", teeth, kind, ""));
        let fit = Fit::new(&a.scene, &b.scene, 0).expect("they belong together");
        let scenes = [&a.scene, &b.scene];
        let flanks = unwatched(|watch| PairFlanks::new(&fit, scenes, None, SECTIONS, &Cpu::default(), watch));
        let flanks = flanks.expect("flanks");
        let (sin, cos) = 20_f64.to_radians().sin_cos();
        let mut largest = 0.0_f64;
        for [in_plane_um, across_um] in [[15.0, 0.0], [0.0, 15.0], [0.0, -15.0], [9.0, 12.0]] {
            let options = PairOptions { parallelism_um: [in_plane_um, across_um], ..PairOptions::default() };
            let mounting = options.mounting(&fit, [&a.scene.gear, &b.scene.gear]).expect("a centre distance");
            let meshing = flanks.meshing(&fit, &a.scene.gear, &mounting);
            // All flanks of the driver pass the pitch point, at its middle and at the ends of its path of contact.
            let moments: Vec<_> =
                (0..90).map(|i| meshing.at(TAU * f64::from(i) / 90.0).expect("flanks that touch")).collect();
            let gaps = smallest_gaps(&meshing, &moments, 30.0, || Ok(())).expect("nobody stops it");
            for side in [Side::Right, Side::Left] {
                // What opens from one end of the face to the other, positive towards +z.
                let apart_um = fit.pitch.sign() * in_plane_um * sin;
                let opening_um =
                    if side == Side::Right { apart_um - across_um * cos } else { apart_um + across_um * cos };
                for (section, gaps) in gaps.iter().enumerate() {
                    let share = section as f64 / (SECTIONS - 1) as f64;
                    let expected_um = if opening_um > 0.0 { opening_um * share } else { -opening_um * (1.0 - share) };
                    for tooth in 1..=18 {
                        let of_flank = gaps.driver_um.get(side, tooth).iter().copied().fold(f32::INFINITY, f32::min);
                        largest = largest.max((f64::from(of_flank) - expected_um).abs());
                    }
                }
            }
        }
        println!("out of parallel, {teeth} teeth: {largest:.4} um");
        assert!(largest < 0.1, "{teeth} teeth: {largest} um");
    }
}
