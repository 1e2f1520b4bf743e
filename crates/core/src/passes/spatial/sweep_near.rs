//! Passes whose blades come near a region of the work at all: the first look.
//!
//! In: the passes of an operation, balls that hold all that is looked at. Out: the passes that planning begins with.
//!
//! **The law.** A rake face holds a point of a ball at some swept angle s. At that moment the point's distance from the
//! tool's axis and its place along it are those of the blade's edge, and its angle about the axis is s (and what a
//! helical gash adds). Over an interval of swept angles the ball's centre stays within speed x half the interval of
//! where it is in the middle, and every point of the ball within its radius of the centre: where even this reaches none
//! of the three, the interval is clear. An interval that is not is halved, down to where halving shows little more; a
//! pass is near if such an interval is left. The tool angles at which the ball stands in the room that all blades sweep
//! are looked for first, once for all passes.
//!
//! The speed is bounded by the motion table's own polynomials ([`MotionTable::largest_rates`]), so that nothing here
//! rests on module, starts, teeth or the pitch curve's shape: every step is a bound, for candidates and for the brute
//! force that they are compared with. Road not taken: the rate of the pitch line, half of module x starts. It is the
//! speed at the pitch point of a round gear, no bound elsewhere.
//!
//! [`MotionTable::largest_rates`]: super::motion::MotionTable::largest_rates

use super::motion::PointPath;
use super::sweep::LARGEST_T;
use super::turning_passes::{BladePass, TurningPasses};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// What the sweeps of tiles may err against the motion table where they go on beyond their tiles, mm: within them it is
/// picometres. A thousandth would do; this much costs nothing.
const MARGIN_MM: f64 = 0.1;
/// An interval is halved no further once blade and ball move by less than this share of the ball's radius in it. It
/// decides about time alone: what is left is near.
const SHORTEST_SHARE: f64 = 0.6;
/// Balls smaller than this count as this large there, mm.
const SMALLEST_MM: f64 = 1.0;

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

/// Passes whose blade may hold a point of `whole` and of one of its parts (each within `whole`), in time order.
pub fn near_passes(set: &TurningPasses, whole: &Ball, parts: &[Ball]) -> Vec<BladePass> {
    let [speed_mm, turn_rad] = set.motion.largest_rates(whole.center_mm);
    let room = Room::of_blades(set);
    let moving = |ball: &Ball, within: &[[f64; 2]]| {
        let speed_mm = speed_mm + turn_rad * ball.center_mm.distance(whole.center_mm);
        let path = set.motion.path(ball.center_mm);
        let near_rad = near_angles(&path, &room, ball, speed_mm, within);
        MovingBall { ball: *ball, path, speed_mm, near_rad }
    };
    let whole = moving(whole, &[set.motion.range_rad()]);
    let parts: Vec<_> = parts.iter().map(|part| moving(part, &whole.near_rad)).collect();
    (0..set.count())
        .map(|index| set.pass(index))
        .filter(|pass| may_hold(set, pass, &whole) && parts.iter().any(|part| may_hold(set, pass, part)))
        .collect()
}

/// A ball in the work, as the head sees it.
struct MovingBall<'a> {
    ball: Ball,
    /// The way of its centre.
    path: PointPath<'a>,
    /// How far its centre moves at most per radian of the tool, mm.
    speed_mm: f64,
    /// Tool angles at which it is in the room that the blades sweep, rad: intervals in order.
    near_rad: Vec<[f64; 2]>,
}

/// What the blades of a tool sweep in the head: a ring about its axis.
struct Room {
    radii_mm: [f64; 2],
    axial_mm: [f64; 2],
}

impl Room {
    fn of_blades(set: &TurningPasses) -> Self {
        let mut room =
            Self { radii_mm: [f64::INFINITY, f64::NEG_INFINITY], axial_mm: [f64::INFINITY, f64::NEG_INFINITY] };
        // One turn of the tool has every blade in its place.
        for pass in (0..set.count().min(set.places.len() as u32)).map(|index| set.pass(index)) {
            let (place, edge) = (set.place(&pass), set.edge(&pass));
            let radius_mm = place.radial_mm + edge.center_mm.x;
            let axial_mm = place.axial_mm + place.y_sign * edge.center_mm.y;
            for (ends_mm, middle_mm) in [(&mut room.radii_mm, radius_mm), (&mut room.axial_mm, axial_mm)] {
                ends_mm[0] = ends_mm[0].min(middle_mm - edge.reach_mm);
                ends_mm[1] = ends_mm[1].max(middle_mm + edge.reach_mm);
            }
        }
        room
    }
}

/// Down to which half interval it is worth to look; a speed that is not a number ends the halving.
fn is_fine(half_rad: f64, ball: &Ball, speed_mm: f64) -> bool {
    let is_coarse = half_rad * speed_mm > SHORTEST_SHARE * ball.radius_mm.max(SMALLEST_MM);
    !is_coarse
}

/// Tool angles of some intervals in order at which a ball may be in the room of all blades, wherever they stand: most
/// passes work on other teeth, and are told from these angles alone.
fn near_angles(path: &PointPath, room: &Room, ball: &Ball, speed_mm: f64, within: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut near: Vec<[f64; 2]> = Vec::new();
    let mut open: Vec<[f64; 2]> = within.iter().rev().copied().collect();
    while let Some([from, to]) = open.pop() {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let at = path.at(middle);
        let around_mm = ball.radius_mm + speed_mm * half + MARGIN_MM;
        let distance_mm = at.truncate().length();
        if distance_mm - around_mm > room.radii_mm[1]
            || distance_mm + around_mm < room.radii_mm[0]
            || at.z - around_mm > room.axial_mm[1]
            || at.z + around_mm < room.axial_mm[0]
        {
            continue;
        }
        if is_fine(half, ball, speed_mm) {
            match near.last_mut() {
                Some(last) if last[1] == from => last[1] = to,
                _ => near.push([from, to]),
            }
        } else {
            open.extend([[middle, to], [from, middle]]);
        }
    }
    near
}

/// Whether a pass's blade may hold a point of a ball.
fn may_hold(set: &TurningPasses, pass: &BladePass, moving: &MovingBall) -> bool {
    let MovingBall { ball, path, speed_mm, near_rad } = moving;
    let (place, edge) = (set.place(pass), set.edge(pass));
    let middle_mm = place.radial_mm + edge.center_mm.x;
    let [innermost_mm, tip_mm] = [middle_mm - edge.reach_mm, middle_mm + edge.reach_mm];
    // A tile's middle is held within half a sweep, what a tile holds at most a quarter turn from there.
    let most_rad = set.half_window_rad + 2.0 * LARGEST_T.atan();
    // The window is symmetric to the tool's direction.
    let window = [pass.tool_angle_rad - most_rad, pass.tool_angle_rad + most_rad];
    let first = near_rad.partition_point(|near| near[1] < window[0]);
    let in_window = near_rad[first..].iter().take_while(|near| near[0] <= window[1]);
    let mut open: Vec<[f64; 2]> = in_window
        .map(|near| {
            let ends = [near[0].max(window[0]), near[1].min(window[1])];
            let swept = ends.map(|angle| set.turn * (angle - pass.tool_angle_rad));
            [swept[0].min(swept[1]), swept[0].max(swept[1])]
        })
        .collect();
    while let Some([from, to]) = open.pop() {
        let (swept, half) = (0.5 * (from + to), 0.5 * (to - from));
        let at = path.at(pass.tool_angle_rad + set.turn * swept);
        let around_mm = ball.radius_mm + speed_mm * half + MARGIN_MM;
        let distance_mm = at.truncate().length();
        let y_mm = place.y_sign * (at.z - place.axial_mm);
        if distance_mm - around_mm > tip_mm
            || distance_mm + around_mm < innermost_mm
            || (y_mm - edge.center_mm.y).abs() - around_mm > edge.reach_mm
        {
            continue;
        }
        let seen_rad = if around_mm < distance_mm { (around_mm / distance_mm).asin() } else { PI };
        let twist = set.rake_twist_rad_per_mm;
        let ahead = (at.y.atan2(at.x) - twist * y_mm - swept + PI).rem_euclid(TAU) - PI;
        if ahead.abs() > seen_rad + twist.abs() * around_mm + half {
            continue;
        }
        if is_fine(half, ball, speed_mm + tip_mm) {
            return true;
        }
        open.extend([[swept, to], [from, swept]]);
    }
    false
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
