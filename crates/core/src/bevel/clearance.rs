//! Whether a head on its way through one slot stays clear of a place in the work, wherever its blades stand.
//!
//! In: settings, moments of the slot, head, and a straight piece in the work. Out: clear, or perhaps not.
//!
//! **Law.** All blades stay in a ring: from the plane of the tips to the blades' height, inside the cone of the outside
//! blades and outside that of the inside ones, both wider by the largest runout. A ball is clear of the ring where its
//! centre stands beyond one of the four by more than its radius. While the cradle turns from q - h to q + h the centre
//! moves in the head's frame by v h at most, v the sum of two circles: the cradle's arm, and the work's radius times
//! the rate of roll; while the head plunges it moves by the way itself. A piece and a range of moments that are not
//! clear by this are halved, the larger one first, down to `FINEST_MM`. Every step is a bound: what is said to be clear
//! is clear. What stands nearer than that to the ring is said to be in it.

use super::cradle::CradleSettings;
use super::face_mill::{BladeKind, FaceMill};
use glam::{DVec3, Vec3Swizzles};

/// Pieces and ways below this are halved no further, mm: an answer that costs more than it saves.
const FINEST_MM: f64 = 0.02;

/// A head on its way through a slot.
#[derive(Debug, Clone, PartialEq)]
pub struct HeadInSlot {
    settings: CradleSettings,
    /// First and last moment of the slot.
    range: [f64; 2],
    /// Radius in the plane of the tips, mm, sine and cosine of the angle of the outer and of the inner cone.
    cones: [[f64; 3]; 2],
    blade_height_mm: f64,
    /// Fastest work angle per cradle angle over the roll.
    rate: f64,
}

impl HeadInSlot {
    /// Of a head and the ends of its way through a slot ([`CradleSettings::at`]).
    pub fn new(settings: &CradleSettings, [from, to]: [f64; 2], head: &FaceMill) -> Self {
        let runout_mm = head.runouts_mm.iter().fold(0.0_f64, |most, runout| most.max(runout.abs()));
        let [outside, inside] = head.blade_angles_rad;
        // Backs lean half as much as the other side of their blade.
        let cone = |kind: BladeKind, own: f64, others: f64| {
            let (sin, cos) = own.max(0.5 * others).sin_cos();
            [head.surface(kind).point_radius_mm + kind.sign() * runout_mm, sin, cos]
        };
        let roll = settings.roll;
        let farthest = [from, to].map(|q| (q - settings.cradle_angle_rad).abs()).into_iter().fold(0.0, f64::max);
        let bend = 2.0 * roll.second_order_per_rad.abs() + 3.0 * roll.third_order_per_rad2.abs() * farthest;
        Self {
            settings: *settings,
            range: [from.min(to), from.max(to)],
            cones: [cone(BladeKind::Outside, outside, inside), cone(BladeKind::Inside, inside, outside)],
            blade_height_mm: head.blade_height_mm,
            rate: roll.ratio.abs() * (1.0 + bend * farthest),
        }
    }

    /// Whether a straight piece in the work (work frame, mm) stays clear of all blades during the whole slot.
    pub fn clears(&self, ends_mm: [DVec3; 2]) -> bool {
        self.clears_during(ends_mm, self.range)
    }

    fn clears_during(&self, [from_mm, to_mm]: [DVec3; 2], [from, to]: [f64; 2]) -> bool {
        let (middle_mm, middle) = (0.5 * (from_mm + to_mm), 0.5 * (from + to));
        let radius_mm = 0.5 * from_mm.distance(to_mm);
        let moved_mm = 0.5 * (to - from) * self.fastest_mm(middle_mm);
        if self.beyond_mm(middle_mm, middle) > radius_mm + moved_mm {
            return true;
        }
        if radius_mm.max(moved_mm) < FINEST_MM {
            return false;
        }
        let halves = if radius_mm > moved_mm {
            [([from_mm, middle_mm], [from, to]), ([middle_mm, to_mm], [from, to])]
        } else {
            [([from_mm, to_mm], [from, middle]), ([from_mm, to_mm], [middle, to])]
        };
        halves.into_iter().all(|(ends_mm, range)| self.clears_during(ends_mm, range))
    }

    /// How fast a point of the work moves in the head's frame at most, mm per unit of the moment.
    fn fastest_mm(&self, at_mm: DVec3) -> f64 {
        if self.settings.plunges() {
            return 1.0;
        }
        let CradleSettings { blank_offset_mm, cross_shift_mm, center_to_back_mm, .. } = self.settings;
        let arm_mm = at_mm.length() + blank_offset_mm.abs() + cross_shift_mm.abs() + center_to_back_mm.abs();
        arm_mm + self.rate * at_mm.yz().length()
    }

    /// How far a point of the work stands outside the ring of the blades at a moment, mm; 0 or less inside.
    fn beyond_mm(&self, at_mm: DVec3, moment: f64) -> f64 {
        let at = self.settings.work_from_tool(moment).inverse().point(at_mm);
        let out_mm = at.xy().length();
        let [[outer_mm, outer_sin, outer_cos], [inner_mm, inner_sin, inner_cos]] = self.cones;
        let outside = (out_mm - outer_mm) * outer_cos + at.z * outer_sin;
        let inside = (inner_mm - out_mm) * inner_cos + at.z * inner_sin;
        at.z.max(-self.blade_height_mm - at.z).max(outside).max(inside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bevel::cradle::{Roll, Tilt};

    fn head() -> FaceMill {
        FaceMill {
            radius_mm: 75.0,
            point_width_mm: 2.0,
            blade_angles_rad: [0.35, 0.3],
            corner_radii_mm: [0.3; 2],
            tip_width_mm: 1.4,
            blade_height_mm: 9.0,
            runouts_mm: vec![0.0, 0.02, 0.0, 0.0],
            half_window_rad: 0.5,
        }
    }

    fn settings() -> CradleSettings {
        CradleSettings {
            radial_setting_mm: 70.6,
            cradle_angle_rad: 1.05,
            blank_offset_mm: 3.0,
            cross_shift_mm: 0.4,
            sliding_base_mm: 5.0,
            center_to_back_mm: -1.0,
            root_angle_rad: 1.13,
            tilt: Tilt { tilt_rad: 0.03, swivel_rad: 0.5 },
            roll: Roll { ratio: 1.1, second_order_per_rad: 0.05, third_order_per_rad2: -0.2, ..Roll::default() },
        }
    }

    /// What small steps of the roll and of the piece find inside the ring is never said to be clear; what they find
    /// farther outside than their steps and the finest piece is.
    #[test]
    fn pieces_that_the_ring_comes_to_are_never_clear() {
        let roll_rad = [0.7, 1.4];
        let rolling = HeadInSlot::new(&settings(), roll_rad, &head());
        let (mut clear, mut swept) = (0, 0);
        for i in 0..600 {
            let share = |step: f64| (f64::from(i) * step + 0.5).fract();
            // About the slot: a point of the ring at some moment, and away from it by up to 10 mm in each direction.
            let moment = roll_rad[0] + 0.7 * share(0.754_877_7);
            let angle = -1.2 + 0.6 * (share(0.569_840_3) - 0.5);
            let in_tool = DVec3::new(75.0 * angle.cos(), 75.0 * angle.sin(), -4.0)
                + 20.0 * DVec3::new(share(0.819_172_5) - 0.5, share(0.671_043_6) - 0.5, share(0.549_700_5));
            let at = settings().work_from_tool(moment).point(in_tool);
            let along = DVec3::new(share(0.1234), share(0.4321), share(0.2718)) - 0.5;
            let ends = [at, at + 3.0 * along];
            let nearest_mm = (0..=700)
                .flat_map(|k| (0..=20).map(move |l| (0.7 + 0.001 * f64::from(k), 0.05 * f64::from(l))))
                .map(|(q, share)| rolling.beyond_mm(ends[0].lerp(ends[1], share), q))
                .fold(f64::INFINITY, f64::min);
            let is_clear = rolling.clears(ends);
            assert!(!is_clear || nearest_mm > 0.0, "{nearest_mm} mm");
            // A step of 0.001 is 0.2 mm at most, one of the piece 0.15 mm.
            assert!(is_clear || nearest_mm < 0.5, "{nearest_mm} mm");
            clear += u32::from(is_clear);
            swept += u32::from(nearest_mm < 0.0);
        }
        assert!(clear > 50 && swept > 50, "{clear} clear, {swept} swept");
    }
}
