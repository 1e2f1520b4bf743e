//! Influences on gears of tools that turn, against closed forms: hobbed and bevel ones.
//!
//! To first order a displacement d of the tool against the work at the moment of contact moves the flank by n . d. The
//! work's own displacements (eccentricity, axial offset) need no moment. What the guide leads aside does so where the
//! slide stands at contact: on a spur gear at the place itself, but for half a feed.

use crate::fixtures::closed_form::agree;
use gearcut::cut::cpu::Cpu;
use gearcut::influence::derivative::Influence;
use gearcut::influence::gear_grid::{FlankGrid, GearGrid};
use gearcut::job::GearJob;
use gearcut::process;
use gearcut::scene::LoadedScene;
use gearcut::scene::error_parameters::error_parameters;
use gearcut::terms::Side;
use glam::DVec3;
use std::path::Path;

const PITCH_MM: f64 = 36.0;

/// Some flanks of a shipped scene and its heights there.
pub(super) struct Gear {
    pub(super) loaded: LoadedScene,
    grid: GearGrid,
    before_um: Vec<f64>,
}

/// A place with its normal.
pub(super) struct Place {
    pub(super) point_mm: DVec3,
    pub(super) normal: DVec3,
    pub(super) side: Side,
}

impl Place {
    fn out(&self) -> f64 {
        self.point_mm.truncate().normalize().extend(0.0).dot(self.normal)
    }

    fn around(&self) -> f64 {
        DVec3::Z.cross(self.point_mm.with_z(0.0).normalize()).dot(self.normal)
    }
}

impl Gear {
    /// Flanks of these teeth at rows along the tooth, at an arc of each that `arc_mm` chooses.
    fn new(
        scene: &str,
        settings: &[&str],
        places: (&[u32], &[f64]),
        arc_mm: impl Fn(&dyn GearJob, u32, Side) -> f64,
    ) -> Self {
        Self::at_arcs(scene, settings, places, |gear, tooth, side| vec![arc_mm(gear, tooth, side)])
    }

    /// The same at several arcs.
    pub(super) fn at_arcs(
        scene: &str,
        settings: &[&str],
        (teeth, rows_mm): (&[u32], &[f64]),
        arcs_mm: impl Fn(&dyn GearJob, u32, Side) -> Vec<f64>,
    ) -> Self {
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let loaded = process::load(Path::new(&format!("scenes/{scene}.toml")), &settings).expect("a scene");
        let mut flanks = Vec::new();
        let prepared = process::prepare(&loaded.scene).expect("a gear");
        let done = prepared.with_gear(&mut |gear| {
            for &tooth in teeth {
                for side in [Side::Left, Side::Right] {
                    let arcs_mm = arcs_mm(gear, tooth, side);
                    flanks.push(FlankGrid::new(gear, tooth, side, arcs_mm, rows_mm.to_vec())?);
                }
            }
            Ok(())
        });
        done.expect("flanks");
        let grid = GearGrid { teeth: loaded.scene.gear.teeth, flanks };
        let before_um = grid.heights_um(&loaded.scene, &Cpu::default()).expect("cut");
        Self { loaded, grid, before_um }
    }

    /// Influence of a parameter at all places, for its natural step, mm.
    pub(super) fn influences(&self, id: &str) -> (f64, Vec<(Place, f64)>) {
        self.influences_by(id, 1.0)
    }

    /// The same for a share of its natural step.
    pub(super) fn influences_by(&self, id: &str, share: f64) -> (f64, Vec<(Place, f64)>) {
        let all = error_parameters(&self.loaded, true);
        let parameter = all.into_iter().find(|of| of.id == id).unwrap_or_else(|| panic!("{id} is no parameter"));
        let step = share * parameter.step;
        let parameter = parameter.with_step(step);
        let found = Influence::new(&self.loaded, &self.grid, &self.before_um, &parameter, &Cpu::default())
            .unwrap_or_else(|error| panic!("{id}: {error}"));
        let rays = self.grid.flanks.iter().flat_map(|flank| flank.rays.iter().map(|ray| (flank.side, ray)));
        let places = rays.map(|(side, ray)| Place { point_mm: ray.origin_mm, normal: ray.normal, side });
        let mm = found.um_per_unit.iter().map(|um| 1e-3 * um * parameter.step);
        (parameter.step, places.zip(mm).collect())
    }

    /// Whether an influence is its closed form, um per unit, to 1 % or 0.03 um of the natural step.
    fn holds(&self, id: &str, expected_um: impl Fn(&Place) -> f64) {
        let (step, found) = self.influences(id);
        agree(id, &found, [0.2, 0.03], |place| 1e-3 * step * expected_um(place));
    }
}

/// Where a flank crosses a circle about the axis.
fn at_radius(gear: &dyn GearJob, tooth: u32, side: Side, radius_mm: f64) -> f64 {
    let arcs_mm = gear.even_arcs_mm(tooth, side, 0.01).expect("a flank");
    let rows = gear.target_points(tooth, side, &arcs_mm, &[0.0]).expect("a flank");
    let above = rows[0].partition_point(|ray| ray.origin_mm.truncate().length() < radius_mm);
    arcs_mm[above]
}

#[test]
fn influences_on_a_hobbed_gear_are_their_closed_forms() {
    let fine = ["gear.teeth=24", "gear.face_width_mm=26", "operation.finish.axial_feed_mm_per_revolution=0.6"];
    let on_pitch_circle = |gear: &dyn GearJob, tooth, side| at_radius(gear, tooth, side, PITCH_MM);
    let rows_mm = [-12.0, 12.0];
    let gear = Gear::new("hobbing/circular_spur", &fine, (&[2], &rows_mm), on_pitch_circle);
    gear.holds("mounting.eccentricity_um@0", |of| -of.normal.x);
    gear.holds("mounting.eccentricity_um@90", |of| -of.normal.y);
    // The lead: half a feed of 0.6 mm is 0.06 um of a step of 20 um/100 mm.
    let half_feed_um = 0.3 / 100.0 * 20.0;
    for (id, along) in [("radial", Place::out as fn(&Place) -> f64), ("tangential", Place::around)] {
        let (step, found) = gear.influences(&format!("machine.errors.guide.{id}_um_per_100mm"));
        agree(id, &found, [0.3, half_feed_um], |of| 1e-3 * step * of.point_mm.z / 100.0 * along(of));
        // Planted: a lead of the other sign is seen.
        let off = found.iter().map(|(of, mm)| (mm + 1e-3 * step * of.point_mm.z / 100.0 * along(of)).abs());
        assert!(1e3 * off.fold(0.0, f64::max) > 5.0 * half_feed_um);
    }
}

/// What moves along the axis moves the flanks of a helical gear.
#[test]
fn an_axial_offset_shows_on_a_helical_gear() {
    let helical = [
        "gear.teeth=24",
        "gear.face_width_mm=8",
        "gear.helix_angle_deg=20",
        "tool.hob.gashes=24",
        "operation.finish.axial_feed_mm_per_revolution=0.6",
    ];
    let middle = |gear: &dyn GearJob, tooth, side| 0.5 * gear.profile_length_mm(tooth, side).expect("a flank");
    let gear = Gear::new("hobbing/circular_spur", &helical, (&[5], &[-2.0, 1.0]), middle);
    gear.holds("mounting.axial_offset_um", |of| -of.normal.z);
    gear.holds("mounting.eccentricity_um@90", |of| -of.normal.y);
}

#[test]
fn influences_on_a_bevel_gear_are_their_closed_forms() {
    let middle = |gear: &dyn GearJob, tooth, side| 0.55 * gear.profile_length_mm(tooth, side).expect("a flank");
    let gear = Gear::new("bevel/five_linkage_printed", &[], (&[1, 17], &[-6.0, 8.0]), middle);
    // Settings, um per mm: the blade angle stands between the cradle's axis and every flank, and the work stands back.
    gear.holds("machine.cradle_errors.sliding_base_mm", |_| -1e3 * 20_f64.to_radians().sin());
    gear.holds("machine.cradle_errors.center_to_back_mm", |of| 1e3 * of.normal.z);
    gear.holds("mounting.eccentricity_um@0", |of| -of.normal.x);
    gear.holds("mounting.eccentricity_um@90", |of| -of.normal.y);
    gear.holds("mounting.axial_offset_um", |of| -of.normal.z);
}
