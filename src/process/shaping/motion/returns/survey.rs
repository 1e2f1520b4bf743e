//! The return strokes of one operation over a turn: where they are clear, where not, and which direction clears.
//!
//! In: an operation's generation, those before it, the blank. Out: the room round the returning cutter at
//! [`PHASES_PER_PITCH`] places to a pitch ([`Survey::rooms`]), and the directions that clear ([`Survey::tilts`]). Work
//! and cutter are ideal here: no runout, no eccentricity, the final offset; what the strokes of a scene really meet,
//! the blank field says.
//!
//! Where the pitch curve repeats after a number of teeth, so does everything here, and only the places of one period
//! are looked at: on a circle those of one pitch. A curve that does not quite close shifts the teeth against its
//! period by at most its gap, a fiftieth of the way from place to place.
//!
//! Directions. An edge that has just made surface with the normal n (out of the tool) leaves it when the cutter moves
//! along u with u . n <= 0. Measured from the normal of the pitch curve into the work, let the normals of all surface
//! that still stands lie between the angles low and high; every direction out of the work tilted by
//!
//! ```text
//! high - 90 deg <= tilt <= low + 90 deg
//! ```
//!
//! then clears, for a small back-off. The middle between the largest lower and the smallest upper bound of a turn is
//! one angle for the whole operation, as a machine sets it. Only an edge whose normal looks farther to a side than all
//! that were found before says anything new: the others are passed over.

use super::clearance::{Clearance, ReturnRoom};
use super::swept::POSES_PER_PITCH;
use crate::process::shaping::linkage::CutterPose;
use crate::process::shaping::linkage::retraction::{RetractingCutter, RetractionLaw};
use crate::process::shaping::target::generation::Generation;
use gearcut_core::error::NotConverged;
use gearcut_core::frame::Rigid2;
use gearcut_core::gear::GearKind;
use gearcut_core::gear::blank::Blank;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;
use std::sync::{Arc, OnceLock};

/// Places to a pitch at which return strokes are looked at: the room round the cutter repeats from tooth to tooth.
pub const PHASES_PER_PITCH: usize = 6;
/// A smaller angle between normal and line of centres is rounding: the curve is a circle.
const ROUND_RAD: f64 = 1e-9;
/// Poses from one place to the next.
const STEP: usize = POSES_PER_PITCH / PHASES_PER_PITCH;

/// Return strokes of an operation. What takes time is found when it is first asked for, and kept.
#[derive(Debug)]
pub struct Survey {
    /// The operation, behind those before it in the order in which they are cut.
    operations: Vec<Arc<Generation>>,
    blank: Blank,
    teeth: u32,
    module_mm: f64,
    /// Teeth after which the pitch curve repeats.
    period_teeth: u32,
    room: OnceLock<ReturnRoom>,
    tilts: OnceLock<Option<[f64; 2]>>,
}

/// Room at one place of the turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedRoom {
    /// Place of the survey.
    place: usize,
    /// Gear from cutter on the way back.
    returning: Rigid2,
    /// Polar angle of the pitch point at the stroke, rad.
    pub phi_rad: f64,
    /// Angle from the normal of the pitch curve to the line of centres, rad, positive where the radius grows with phi.
    pub from_normal_rad: f64,
    /// Room round the cutter.
    pub clearance: Clearance,
}

impl Survey {
    /// Of the last of some operations, in the order in which they are cut; `teeth` all round, of a sector with
    /// those of its dwell.
    ///
    /// # Panics
    /// No operation.
    pub fn new(operations: Vec<Arc<Generation>>, blank: Blank, teeth: u32, module_mm: f64) -> Self {
        assert!(!operations.is_empty(), "an operation whose return strokes are looked at");
        let period_teeth = blank.curve().period_teeth(teeth);
        let (room, tilts) = (OnceLock::new(), OnceLock::new());
        Self { operations, blank, teeth, module_mm, period_teeth, room, tilts }
    }

    /// The operation itself.
    fn generation(&self) -> &Generation {
        self.operations.last().expect("an operation")
    }

    fn room(&self) -> &ReturnRoom {
        self.room.get_or_init(|| {
            let generation = self.generation();
            let pose = |phi: f64| self.pose(phi);
            let before = &self.operations[..self.operations.len() - 1];
            let earlier = before.iter().map(|of| |phi: f64| of.linkage.pose(phi, of.offset_mm)).collect::<Vec<_>>();
            let earlier: Vec<&dyn Fn(f64) -> CutterPose> =
                earlier.iter().map(|pose| pose as &dyn Fn(f64) -> CutterPose).collect();
            ReturnRoom::new(&generation.cutter, self.teeth, self.module_mm, &pose, &earlier)
        })
    }

    /// Room round the cutter over a turn, drawn back by `back_off_mm` by the law that `law(phi)` gives, which repeats
    /// as the pitch curve does.
    ///
    /// # Errors
    /// A pose that the law does not lead to.
    pub fn rooms(
        &self,
        back_off_mm: f64,
        law: impl Fn(f64) -> RetractionLaw + Sync,
    ) -> Result<Vec<PlacedRoom>, NotConverged> {
        let clearance =
            |place: usize| Ok(self.clearance(place, &self.returning(place, back_off_mm, &law)?, Clearance::ANY));
        let period: Vec<Clearance> = self.places_of_period().map(clearance).collect::<Result<_, _>>()?;
        let all = (0..self.room().swept.places()).step_by(STEP).filter(|&place| self.is_toothed(place));
        let places = all.zip(period.iter().cycle());
        let room = |(place, clearance): (usize, &Clearance)| {
            let phi_rad = self.room().swept.phi_rad(place);
            let (normal, centres) = (self.out_of_work(phi_rad), self.sign() * self.pose(phi_rad).center_mm);
            let angle_rad = normal.perp_dot(centres).atan2(normal.dot(centres));
            let from_normal_rad = if angle_rad.abs() < ROUND_RAD { 0.0 } else { angle_rad };
            let returning = self.returning(place, back_off_mm, &law)?;
            Ok(PlacedRoom { place, returning, phi_rad, from_normal_rad, clearance: *clearance })
        };
        places.map(room).collect()
    }

    /// Whether the cutter, drawn back as for [`Self::rooms`], clears the surfaces that stay by `least_mm`, at the
    /// places of a turn.
    ///
    /// # Errors
    /// A pose that the law does not lead to.
    pub fn clear(
        &self,
        back_off_mm: f64,
        law: impl Fn(f64) -> RetractionLaw + Sync,
        least_mm: f64,
    ) -> Result<Vec<bool>, NotConverged> {
        let below = Clearance { surface_mm: least_mm, material_mm: f64::NEG_INFINITY };
        let clear = |place: usize| {
            if !self.is_toothed(place) {
                return Ok(true);
            }
            let clearance = self.clearance(place, &self.returning(place, back_off_mm, &law)?, below);
            Ok(clearance.surface_mm >= least_mm)
        };
        let period: Vec<bool> = self.all_places_of_period().map(clear).collect::<Result<_, _>>()?;
        Ok(period.repeat(self.room().swept.places() / STEP / period.len()))
    }

    /// Area that the returning cutter has in common with what the operation leaves, mm2.
    pub fn overlap_mm2(&self, at: &PlacedRoom) -> f64 {
        self.room().overlap_mm2(at.place, &at.returning, |p| self.beyond_mm(p, at.phi_rad))
    }

    /// Smallest and largest tilt out of the normal that clears everywhere, rad; the first is the larger one where none
    /// does. `None` where no stroke touches the blank.
    pub fn tilts(&self) -> Option<[f64; 2]> {
        *self.tilts.get_or_init(|| {
            let wider = |normals: Option<[f64; 2]>, place: usize| {
                let phi_rad = self.room().swept.phi_rad(place);
                let into_work = -self.out_of_work(phi_rad);
                self.room().contact_normals_rad(place, into_work, |p| self.beyond_mm(p, phi_rad), normals)
            };
            let union = |a: Option<[f64; 2]>, b: Option<[f64; 2]>| match (a, b) {
                (Some(a), Some(b)) => Some([a[0].min(b[0]), a[1].max(b[1])]),
                (found, None) | (None, found) => found,
            };
            let normals = self.places_of_period().fold(|| None, wider).reduce(|| None, union);
            normals.map(|[low, high]| [high - FRAC_PI_2, low + FRAC_PI_2])
        })
    }

    /// Gear from cutter on the way back from the stroke at a place.
    fn returning(
        &self,
        place: usize,
        back_off_mm: f64,
        law: impl Fn(f64) -> RetractionLaw,
    ) -> Result<Rigid2, NotConverged> {
        let phi_rad = self.room().swept.phi_rad(place);
        let cutter = RetractingCutter::of(&self.generation().linkage);
        let back = cutter.retracted(law(phi_rad), &self.pose(phi_rad), phi_rad, back_off_mm)?.pose;
        Ok(Rigid2::new(back.angle_rad, back.center_mm))
    }

    fn clearance(&self, place: usize, returning: &Rigid2, below: Clearance) -> Clearance {
        let phi_rad = self.room().swept.phi_rad(place);
        self.room().at(place, returning, |p| self.beyond_mm(p, phi_rad), below)
    }

    /// How many of the rooms of a turn there are before the pitch curve repeats.
    pub fn period_places(&self) -> usize {
        self.period_teeth as usize * PHASES_PER_PITCH
    }

    /// Places to look at in the first period of the turn; of a sector those where it has teeth.
    fn places_of_period(&self) -> impl ParallelIterator<Item = usize> {
        self.all_places_of_period().filter(|&place| self.is_toothed(place))
    }

    fn is_toothed(&self, place: usize) -> bool {
        self.blank.curve().carries(self.room().swept.phi_rad(place))
    }

    fn all_places_of_period(&self) -> impl IndexedParallelIterator<Item = usize> {
        (0..self.period_places()).into_par_iter().map(|index| index * STEP)
    }

    fn pose(&self, phi_rad: f64) -> CutterPose {
        self.generation().linkage.pose(phi_rad, self.generation().offset_mm)
    }

    fn sign(&self) -> f64 {
        self.blank.kind().tip_sign()
    }

    /// Direction of the pitch curve's normal away from the work's material.
    fn out_of_work(&self, phi_rad: f64) -> DVec2 {
        self.blank.towards_tip(&self.blank.curve().frame(phi_rad))
    }

    /// How far a point lies outside the uncut blank on its toothed side, mm; negative inside.
    fn beyond_mm(&self, p: DVec2, phi_rad: f64) -> f64 {
        let (facts, radius_mm) = (self.blank.curve().facts(), p.length());
        let beyond_mm = match self.blank.kind() {
            GearKind::External => radius_mm - facts.largest_radius_mm - self.blank.addendum_mm,
            GearKind::Internal => facts.smallest_radius_mm - self.blank.addendum_mm - radius_mm,
        };
        if beyond_mm > 0.0 {
            return beyond_mm;
        }
        let near_rad = phi_rad + DVec2::from_angle(phi_rad).angle_to(p);
        self.blank.height(p, near_rad).0 - self.blank.addendum_mm
    }
}

/// The place with the least room to surfaces that stay, or to all material, by the key.
pub fn tightest(rooms: &[PlacedRoom], of: impl Fn(&PlacedRoom) -> f64) -> Option<&PlacedRoom> {
    rooms.iter().filter(|room| of(room).is_finite()).min_by(|a, b| of(a).total_cmp(&of(b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process;
    use crate::process::shaping::ShapingJob;
    use std::path::Path;

    fn shipped(name: &str) -> ShapingJob {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/shaping/{name}.toml"));
        ShapingJob::new(process::load(&path, &[]).expect("a shipped scene").scene).expect("it can be cut")
    }

    /// Room at a place with every corner of every cutter tooth looked at.
    fn room_of_all_corners(survey: &Survey, at: &PlacedRoom) -> Clearance {
        let mut found = Clearance::ANY;
        for blade in survey.room().swept.tools_from_blades() {
            for &corner_mm in &survey.room().edge_mm {
                let p = at.returning.after(&blade).point(corner_mm);
                if survey.beyond_mm(p, at.phi_rad) <= 0.0 {
                    let [surface_mm, material_mm] =
                        survey.room().swept.covered_mm(at.place, &blade, p, [f64::INFINITY; 2]);
                    found.surface_mm = found.surface_mm.min(surface_mm);
                    found.material_mm = found.material_mm.min(material_mm);
                }
            }
        }
        found
    }

    #[test]
    fn one_period_and_parts_of_the_edge_say_what_the_whole_turn_says() {
        for (name, period_teeth) in [("internal_interfering", 34), ("elliptical_normal", 14), ("circular_m3_z24", 1)] {
            let job = shipped(name);
            let survey = &job.operations[1].survey;
            assert_eq!(survey.period_teeth, period_teeth, "{name}");
            let rooms = survey.rooms(0.8, |_| RetractionLaw::CenterLine).expect("poses");
            assert_eq!(rooms.len(), PHASES_PER_PITCH * job.scene.gear.teeth as usize);
            // Places of every phase and period.
            for room in rooms.iter().step_by(19) {
                let expected = room_of_all_corners(survey, room);
                let off_mm = [
                    room.clearance.surface_mm - expected.surface_mm,
                    room.clearance.material_mm - expected.material_mm,
                ];
                // The elliptical gear's size is the printed one, and does not close to the last 60 nm.
                let within_mm = 1e-8 + survey.blank.curve().closure_error_mm().abs();
                assert!(off_mm.iter().all(|off| off.abs() < within_mm), "{name}: {room:?}, not {expected:?}");
            }
            let clear = survey.clear(0.8, |_| RetractionLaw::CenterLine, 0.1).expect("poses");
            assert!(
                clear.iter().eq(rooms.iter().map(|room| room.clearance.surface_mm >= 0.1).collect::<Vec<_>>().iter())
            );
            // A tooth short of the period is none.
            if period_teeth > 1 {
                let short = PHASES_PER_PITCH * (period_teeth as usize - 1);
                let off_mm =
                    |index: usize| rooms[index + short].clearance.surface_mm - rooms[index].clearance.surface_mm;
                assert!((0..short).any(|index| off_mm(index).abs() > 0.001), "{name}");
            }
        }
    }

    /// The way back is no longer than the back-off, and no place of a tooth stands deeper than it has gone: also where
    /// the gear's tips reach the cutter's root circle, which roughing 5 mm too deep does.
    #[test]
    fn no_place_stands_deeper_than_the_way_back() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/shaping/elliptical_normal.toml");
        let scene = process::load(&path, &["operation.rough.offset_mm=-5".to_owned()]).expect("a scene").scene;
        let job = ShapingJob::new(scene).expect("it can be cut");
        let rooms = job.operations[0].survey.rooms(0.5, |_| RetractionLaw::CenterLine).expect("poses");
        let deepest_mm = rooms.iter().map(|room| -room.clearance.surface_mm).fold(0.0, f64::max);
        println!("deepest {deepest_mm} mm");
        assert!(deepest_mm > 0.1 && deepest_mm < 0.5, "{deepest_mm} mm");
    }
}
