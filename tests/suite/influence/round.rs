//! A round gear whose errors have closed forms over whole flanks.
//!
//! A spur flank is touched when its normal passes the pitch point, where the line of centres meets the pitch circle. To
//! first order a shift of the cutter at that moment, a outwards and t counter-clockwise, makes h = n . (a out + t
//! around).

use crate::fixtures::shaped_gear::shaped_gear;
use gearcut::cut::cpu::Cpu;
use gearcut::influence::gear_grid::{FlankGrid, GearGrid};
use gearcut::process;
use gearcut::scene::LoadedScene;
use gearcut::terms::Side;
use glam::{DVec2, DVec3};
use std::path::Path;

pub const PITCH_MM: f64 = 36.0;
pub const CUTTER_MM: f64 = 30.0;
pub const SCENE: &str = shaped_gear!("teeth = 24", 2400, "[operation.infeed.none]");

pub fn loaded(settings: &[String]) -> LoadedScene {
    process::parse(SCENE, "round.toml", Path::new(""), settings).expect("a scene")
}

/// Both flanks of tooth 3 and 14 as a whole, of all others the middle.
pub fn grid(loaded: &LoadedScene) -> GearGrid {
    let whole = [3, 14].map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]).concat();
    let mut grid = None;
    process::prepare(&loaded.scene)
        .expect("a gear")
        .with_gear(&mut |gear| {
            grid = Some(GearGrid::inspected(gear, &whole, true)?);
            Ok(())
        })
        .expect("flanks");
    grid.expect("a gear")
}

pub fn backend() -> Cpu {
    Cpu::default()
}

/// A place at the moment of its contact.
pub struct Contact {
    /// Along the line of centres, and counter-clockwise across it.
    pub out: DVec2,
    pub around: DVec2,
    pub normal: DVec2,
    /// Polar angle of the line of centres, 0 to a turn: the work's angle then.
    pub work_rad: f64,
    /// Place along the tooth, mm.
    pub z_mm: f64,
    /// The place itself, mm.
    pub point_mm: DVec2,
}

/// Contacts of all places of a grid in their order.
pub fn contacts(grid: &GearGrid) -> Vec<Contact> {
    let of_flank =
        |flank: &FlankGrid| flank.rays.iter().map(|ray| contact(ray.origin_mm, ray.normal)).collect::<Vec<_>>();
    grid.flanks.iter().flat_map(of_flank).collect()
}

pub(super) fn contact(place_mm: DVec3, normal: DVec3) -> Contact {
    let (point_mm, normal) = (place_mm.truncate(), normal.truncate());
    // |p + l n| = r; the pitch point is the nearer of both solutions.
    let (b, c) = (point_mm.dot(normal), point_mm.length_squared() - PITCH_MM * PITCH_MM);
    let root = (b * b - c).sqrt();
    let l = if (root - b).abs() < (root + b).abs() { root - b } else { -root - b };
    let out = (point_mm + l * normal).normalize();
    let work_rad = out.to_angle().rem_euclid(std::f64::consts::TAU);
    Contact { out, around: out.perp(), normal, work_rad, z_mm: place_mm.z, point_mm }
}
