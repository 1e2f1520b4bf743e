//! Passes whose blades come near a region of the work at all: the first look.
//!
//! In: the passes of an operation, balls that hold all that is looked at. Out: the passes that planning begins with.
//!
//! **The law.** A rake face holds a point of a ball at some swept angle s. At that moment the point's distance from the
//! tool's axis and its place along it are those of the blade's edge, and its angle about the axis is s (and what a
//! helical gash adds). Over an interval of swept angles the ball's centre stays within speed x half the interval of
//! where it is in the middle, and every point of the ball within its radius of the centre: where even this reaches none
//! of the three, the interval is clear. The tool angles at which the ball may be in the room that all blades sweep are
//! halved down to where halving shows little more. In each interval that is left the ball's angle about the axis names
//! the passes whose rake faces may be there, a run of neighbours in time; those are near whose own blade reaches the
//! ball. Road not taken: halving the sweep of every pass, which takes twice as long, since neighbours ask nearly the
//! same.
//!
//! The speed is bounded by the motion table's own polynomials ([`MotionTable::largest_rates`]), so that nothing here
//! rests on module, starts, teeth or the pitch curve's shape: every step is a bound, for candidates and for the brute
//! force that they are compared with. Road not taken: the rate of the pitch line, half of module x starts. It is the
//! speed at the pitch point of a round gear, no bound elsewhere.
//!
//! [`MotionTable::largest_rates`]: super::motion::MotionTable::largest_rates

use super::sweep::LARGEST_T;
use super::turning_passes::{BladePass, BladePlace, TurningPasses};
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// What the sweeps of tiles may err against the motion table where they go on beyond their tiles, mm: within them it is
/// picometres. A thousandth would do; this much costs nothing.
const MARGIN_MM: f64 = 0.1;
/// An interval is halved no further once blade and ball move by less than this share of the ball's radius in it. It
/// decides about time alone: what is left is near.
const SHORTEST_SHARE: f64 = 0.6;
/// Balls smaller than this count as this large there, mm.
const SMALLEST_MM: f64 = 1.0;
/// Added to tool angles between which passes are looked up, rad: blades of one gash may differ by rounding.
const ROUNDING_RAD: f64 = 1e-6;

/// A ball in the work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Centre, gear frame, mm.
    pub center_mm: DVec3,
    /// Radius, mm.
    pub radius_mm: f64,
}

impl Ball {
    /// A ball that holds some balls: about the middle of their centres' box.
    pub fn of_balls(balls: &[Self]) -> Self {
        let (low, high) = balls
            .iter()
            .map(|ball| ball.center_mm)
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
        let center_mm = 0.5 * (low + high);
        let reach_mm = |ball: &Self| ball.center_mm.distance(center_mm) + ball.radius_mm;
        Self { center_mm, radius_mm: balls.iter().map(reach_mm).fold(0.0, f64::max) }
    }
}

/// Passes whose blade may hold a point of one of some balls, all within `whole`, in time order.
pub fn near_passes(set: &TurningPasses, whole: &Ball, parts: &[Ball]) -> Vec<BladePass> {
    let [speed_mm, turn_rad] = set.motion.largest_rates(whole.center_mm);
    let blades: Vec<Room> = set.places.iter().map(|place| Room::of_blade(set, place)).collect();
    let room = blades.iter().fold(Room::NONE, Room::with);
    let mut within: Vec<[f64; 2]> = Vec::new();
    halve_angles(set, &room, whole, speed_mm, &[set.motion.range_rad()], |moment| match within.last_mut() {
        Some(last) if last[1] == moment.angles_rad[0] => last[1] = moment.angles_rad[1],
        _ => within.push(moment.angles_rad),
    });
    let mut near = vec![false; set.count() as usize];
    for part in parts {
        let speed_mm = speed_mm + turn_rad * part.center_mm.distance(whole.center_mm);
        halve_angles(set, &room, part, speed_mm, &within, |moment| {
            for index in moment.held_by(set).into_iter().flatten() {
                near[index as usize] |= blades[set.pass(index).rank as usize].reaches(moment);
            }
        });
    }
    (0..set.count()).filter(|&index| near[index as usize]).map(|index| set.pass(index)).collect()
}

/// A ring about the tool's axis in the head: what blades sweep.
#[derive(Clone, Copy)]
struct Room {
    radii_mm: [f64; 2],
    axial_mm: [f64; 2],
}

impl Room {
    const NONE: Self =
        Self { radii_mm: [f64::INFINITY, f64::NEG_INFINITY], axial_mm: [f64::INFINITY, f64::NEG_INFINITY] };

    fn of_blade(set: &TurningPasses, place: &BladePlace) -> Self {
        let edge = set.edges.edge_of(place.blade);
        let around = |middle_mm: f64| [middle_mm - edge.reach_mm, middle_mm + edge.reach_mm];
        Self {
            radii_mm: around(place.radial_mm + edge.center_mm.x),
            axial_mm: around(place.axial_mm + place.y_sign * edge.center_mm.y),
        }
    }

    fn with(self, other: &Self) -> Self {
        let both = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        Self { radii_mm: both(self.radii_mm, other.radii_mm), axial_mm: both(self.axial_mm, other.axial_mm) }
    }

    /// Whether a point of the ball may be in it.
    fn reaches(&self, moment: &MovingBall) -> bool {
        let misses = |at: f64, range: [f64; 2]| at - moment.around_mm > range[1] || at + moment.around_mm < range[0];
        !misses(moment.distance_mm, self.radii_mm) && !misses(moment.at_mm.z, self.axial_mm)
    }
}

/// A ball in the work over an interval of tool angles, as the head sees it.
struct MovingBall {
    angles_rad: [f64; 2],
    /// Its centre in the middle of the interval, and that one's distance from the tool's axis.
    at_mm: DVec3,
    distance_mm: f64,
    /// No point of the ball is ever further from there.
    around_mm: f64,
}

impl MovingBall {
    /// Passes whose rake faces may hold a point of the ball meanwhile, wherever their edges are in them.
    fn held_by(&self, set: &TurningPasses) -> [Range<u32>; 3] {
        let [from, to] = self.angles_rad;
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let seen_rad = if self.around_mm < self.distance_mm { (self.around_mm / self.distance_mm).asin() } else { PI };
        // Gashes wind about the axis: what they add where any edge may hold a point of the ball.
        let edges = set.edges.edges().iter();
        let wound_mm = edges.map(|edge| edge.center_mm.y.abs() + edge.reach_mm).fold(0.0, f64::max) + self.around_mm;
        let free_rad = seen_rad + set.rake_twist_rad_per_mm.abs() * wound_mm + half;
        let ahead_rad = self.at_mm.y.atan2(self.at_mm.x);
        // A tile's middle is held within half a sweep, what a tile holds at most a quarter turn from there.
        let most_rad = set.half_window_rad + 2.0 * LARGEST_T.atan() + half;
        [-TAU, 0.0, TAU].map(|turn| {
            // All of the window where the ball is not a number.
            let swept = [(ahead_rad + turn - free_rad).max(-most_rad), (ahead_rad + turn + free_rad).min(most_rad)];
            if swept[0] >= swept[1] {
                return 0..0;
            }
            let [a, b] = swept.map(|angle| middle - set.turn * angle);
            set.between(a.min(b) - ROUNDING_RAD, a.max(b) + ROUNDING_RAD)
        })
    }
}

/// Halves intervals of tool angles, given in order, down to those in which a ball may be in a room, and gives each of
/// these.
fn halve_angles(
    set: &TurningPasses,
    room: &Room,
    ball: &Ball,
    speed_mm: f64,
    within: &[[f64; 2]],
    mut near: impl FnMut(&MovingBall),
) {
    // Blade and ball move towards each other; a speed that is not a number ends the halving.
    let finest_mm = SHORTEST_SHARE * ball.radius_mm.max(SMALLEST_MM);
    let mut open: Vec<[f64; 2]> = within.iter().rev().copied().collect();
    while let Some([from, to]) = open.pop() {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let at_mm = set.motion.head_from_work(middle).point(ball.center_mm);
        let around_mm = ball.radius_mm + speed_mm * half + MARGIN_MM;
        let moment = MovingBall { angles_rad: [from, to], at_mm, distance_mm: at_mm.truncate().length(), around_mm };
        if !room.reaches(&moment) {
            continue;
        }
        if half * (speed_mm + room.radii_mm[1]) > finest_mm {
            open.extend([[middle, to], [from, middle]]);
        } else {
            near(&moment);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Rigid3;
    use crate::passes::spatial::motion::MotionTable;
    use crate::passes::spatial::straight_hob::StraightHob;
    use glam::{DMat3, DVec2};

    const TURNS: f64 = 8.0;

    /// Swept angle at which a pass holds a point within its edge's circle: the sweep gone through in small steps.
    fn held_at(set: &TurningPasses, pass: &BladePass, point_mm: DVec3) -> Option<f64> {
        let (place, edge) = (set.place(pass), set.edge(pass));
        let steps = 100;
        let at = |i: i32| {
            let swept = set.half_window_rad * f64::from(i) / f64::from(steps);
            let at = set.motion.head_from_work(pass.tool_angle_rad + set.turn * swept).point(point_mm);
            (swept, at.y.atan2(at.x) - swept, DVec2::new(at.x.hypot(at.y), place.y_sign * (at.z - place.axial_mm)))
        };
        (-steps..steps).map(|i| (at(i), at(i + 1))).find_map(|(before, after)| {
            let passes = before.1 * after.1 <= 0.0 && (before.1 - after.1).abs() < 1.0;
            (passes && before.2.distance(edge.center_mm) < edge.reach_mm).then_some(before.0)
        })
    }

    /// Gears beyond what a fixed allowance of 20 mm of rolling and a fifth of the reach in turning could hold: large
    /// modules with many starts, and few teeth per start. Every pass that holds a point of the region at some moment,
    /// found by going through all of every sweep, is near; and what is near is few.
    #[test]
    fn passes_that_hold_a_point_are_near_whatever_module_starts_and_teeth() {
        let mut beyond = 0;
        for (module_mm, starts, teeth, pitch_radius_mm) in
            [(50.0, 8, 32, 600.0), (50.0, 1, 4, 300.0), (10.0, 4, 11, 90.0), (2.0, 1, 40, 30.0)]
        {
            let hob = StraightHob::new(module_mm, starts, pitch_radius_mm);
            let radius_mm = 0.5 * module_mm * f64::from(teeth);
            let ratio = f64::from(starts) / f64::from(teeth);
            // The work's axis lies along y of the head, its pitch cylinder touches the hob's.
            let motion = MotionTable::new([-PI, TAU * TURNS], &[], |angle| Rigid3 {
                rotation: DMat3::from_rotation_y(ratio * angle) * DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
                translation_mm: DVec3::new(pitch_radius_mm + radius_mm, 0.3 * angle, 0.0),
            });
            let set = TurningPasses::new(0, &hob, 1.0, motion).expect("a hob");
            let mut held = 0;
            for place in 0..3 {
                let about = 2.0 + 1.7 * f64::from(place);
                let beside_mm = 0.3 * pitch_radius_mm * f64::from(place - 1);
                let ball = Ball {
                    center_mm: DVec3::new(radius_mm * about.cos(), radius_mm * about.sin(), beside_mm),
                    radius_mm: 0.8 * module_mm,
                };
                let near = near_passes(&set, &ball, &[ball]);
                assert!((near.len() as u32) < set.count() / 4 * 3, "{} of {}", near.len(), set.count());
                for pass in (0..set.count()).map(|index| set.pass(index)) {
                    let inside = |i: i32| {
                        let turned = 2.4 * f64::from(i);
                        let share = (f64::from(i) / 12.0).sqrt();
                        let across = DVec3::new(turned.cos(), turned.sin(), (5.0 * turned).sin()).normalize();
                        ball.center_mm + share * ball.radius_mm * across
                    };
                    let Some(swept) = (0..=12).find_map(|i| held_at(&set, &pass, inside(i))) else {
                        continue;
                    };
                    held += 1;
                    assert!(near.contains(&pass), "module {module_mm}, {starts} starts, {teeth} teeth: {pass:?}");
                    let at = |swept: f64| set.motion.head_from_work(pass.tool_angle_rad + swept).point(ball.center_mm);
                    beyond += u32::from((at(swept) - at(0.0)).length() > 20.0);
                }
            }
            println!(
                "module {module_mm}, {starts} starts, {teeth} teeth: {held} of {} passes hold a point",
                set.count()
            );
            assert!(held > 0);
        }
        assert!(beyond > 20, "{beyond} passes move their ball by more than the fixed allowance");
    }

    /// The rates are bounds of what differences of the motion show, and no more than a fifth above them.
    #[test]
    fn rates_are_those_of_the_motion() {
        let pose = |angle: f64| Rigid3 {
            rotation: DMat3::from_rotation_z(0.25 * angle),
            translation_mm: DVec3::new(140.0, 0.0, 2.0 * angle),
        };
        let motion = MotionTable::new([-3.0, 40.0], &[17.3], pose);
        let point = DVec3::new(80.0, 10.0, 5.0);
        let [speed_mm, turn_rad] = motion.largest_rates(point);
        let wanted_mm = (0.25 * point.truncate().length()).hypot(2.0);
        assert!(speed_mm >= wanted_mm && speed_mm < 1.2 * wanted_mm, "{speed_mm} {wanted_mm}");
        // Largest and least stretch of a rotation's rate: its entries' squares count twice.
        let wanted_rad = 0.25 * 2_f64.sqrt();
        assert!(turn_rad >= wanted_rad - 1e-12 && turn_rad < 1.2 * wanted_rad, "{turn_rad} {wanted_rad}");
    }
}
