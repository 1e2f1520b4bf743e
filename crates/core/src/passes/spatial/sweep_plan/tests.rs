use super::*;
use crate::cut::Backend as _;
use crate::cut::cpu::Cpu;
use crate::dexel::Layer;
use crate::frame::Rigid3;
use crate::passes::spatial::motion::MotionTable;
use crate::passes::spatial::straight_hob::StraightHob;
use glam::DMat3;
use std::f64::consts::{PI, TAU};

const MODULE_MM: f64 = 2.0;
const TEETH: f64 = 40.0;
const PITCH_RADIUS_MM: f64 = 30.0;

/// Passes of a hob on a spur gear; at every tool angle the work is off its place by this, head, mm.
fn hob_passes(off_mm: impl Fn(f64) -> DVec3 + Sync) -> TurningPasses {
    let hob = StraightHob::new(MODULE_MM, 1, PITCH_RADIUS_MM);
    let half_range_rad = 1.5 * TEETH * TAU;
    let motion = MotionTable::new([-half_range_rad, half_range_rad], &[], |angle| Rigid3 {
        rotation: DMat3::from_rotation_y(-angle / TEETH) * DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
        translation_mm: DVec3::new(PITCH_RADIUS_MM + 0.5 * MODULE_MM * TEETH, angle / (TAU * TEETH), 0.0)
            + off_mm(angle),
    });
    TurningPasses::new(0, &hob, 1.0, motion).expect("a hob")
}

/// A flank of the space that is cut about tool angle 0, as a plane through the pitch point, in columns so far apart and
/// each deeper in the tooth than the one before by `deeper_mm`.
fn plane(columns: usize, apart_mm: f64, deeper_mm: f64) -> SpatialField {
    let (sin, cos) = 20_f64.to_radians().sin_cos();
    let out = DVec3::new(-1.0, 0.0, 0.0);
    let around = DVec3::Z.cross(out);
    let pitch_mm = 0.5 * MODULE_MM * TEETH * out + 0.25 * PI * MODULE_MM * around;
    let (normal, along) = (sin * out - cos * around, cos * out + sin * around);
    SpatialField::new(columns, 40, -0.5, |column, row| {
        let place = [column as f64 - 0.5 * columns as f64, row as f64 - 20.0];
        let depth_mm = deeper_mm * column as f64;
        let origin_mm = pitch_mm + place[0] * apart_mm * along + place[1] * 0.05 * DVec3::Z - depth_mm * normal;
        (Ray { origin_mm, normal }, 3.0 + depth_mm)
    })
}

fn cut(field: &SpatialField, plan: &SweepPlan) -> Layer {
    let mut layer = field.blank_layer();
    Cpu::default().cut_spatial(field, plan, &mut layer).expect("cuts");
    layer
}

/// A machine that trembles by steps, which no polynomials follow: every frame sees another surface, and what one of
/// them culls may be lowest in another.
#[test]
fn a_motion_with_steps_loses_no_pass() {
    for seed in 0..2 {
        let of = |angle: f64, axis: f64| (1e3 * (1.7 * angle).floor() + 7.0 * axis + f64::from(seed)).sin();
        let set = hob_passes(|angle| 3e-3 * DVec3::new(of(angle, 0.0), of(angle, 1.0), of(angle, 2.0)));
        for (columns, apart_mm) in [(40, 0.05), (33, 0.08)] {
            let field = plane(columns, apart_mm, 0.0);
            let [plan, all] = [SweepPlan::new, SweepPlan::brute_force].map(|make| make(&field, &set));
            let (few, every) = (cut(&field, &plan), cut(&field, &all));
            let lost = (0..field.len()).filter(|&i| few.heights_mm[i] != every.heights_mm[i]);
            let lost: Vec<usize> = lost.collect();
            assert!(lost.is_empty(), "seed {seed}, {columns} columns: {} dexels, {:?}", lost.len(), lost[0]);
            assert!(few.passes == every.passes && 8 * plan.records.len() < all.records.len());
        }
    }
}

/// Ceilings that lie below the surface, across it, above it and nowhere: the same bytes as from all passes. The surface
/// rises from column to column, so that a ceiling across it leaves a part of the tiles to the second search. A first
/// search that is believed where it shows nothing is noticed: the blank that ends at the ceiling seems to bound the
/// surface by it.
#[test]
fn a_guessed_ceiling_changes_nothing_wherever_it_lies() {
    let set = hob_passes(|_| DVec3::ZERO);
    let field = plane(192, 0.02, 0.005);
    let all = cut(&field, &SweepPlan::brute_force(&field, &set));
    let lowest_mm = all.heights_mm.iter().copied().fold(f32::INFINITY, f32::min);
    let highest_mm = all.heights_mm.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let [lowest_mm, highest_mm] = [lowest_mm, highest_mm].map(f64::from);
    assert!(lowest_mm > field.low_mm && highest_mm > lowest_mm + 0.5, "{lowest_mm} to {highest_mm}");
    for passes in [Considered::Candidates, Considered::CandidatesInPatches] {
        let plan =
            |field: &SpatialField, ceilings_mm: [f64; 2]| SweepPlanner { field, set: &set, passes, ceilings_mm }.plan();
        let without = plan(&field, [f64::INFINITY; 2]);
        let across_mm = 0.15 * lowest_mm + 0.85 * highest_mm;
        let mut found = Vec::new();
        for ceiling_mm in [lowest_mm - 0.1, across_mm, highest_mm + 1.0, f64::INFINITY] {
            found.push(plan(&field, [ceiling_mm; 2]).tiles.len());
            let guessed = plan(&field, [ceiling_mm, f64::INFINITY]);
            let same_tiles = |a: &SweepTile, b: &SweepTile| a.columns == b.columns && a.rows == b.rows;
            assert!(guessed.tiles.iter().zip(&without.tiles).all(|(a, b)| same_tiles(a, b)));
            assert!(guessed.tiles.len() == without.tiles.len());
            let left = cut(&field, &guessed);
            assert!(passes == Considered::CandidatesInPatches || left == all, "{ceiling_mm} mm");
            assert!(left == cut(&field, &without), "{ceiling_mm} mm");
        }
        println!("tiles found below each ceiling: {found:?} of {}", without.tiles.len());
        let tiles = without.tiles.len();
        assert!(found[0] == 0 && 0 < found[1] && found[1] < tiles && found[2..] == [tiles; 2], "{found:?}");

        let low_blank = SpatialField::new(field.columns(), field.rows(), field.low_mm, |column, row| {
            (field.ray(column, row), across_mm)
        });
        let believed = cut(&field, &plan(&low_blank, [across_mm; 2]));
        let higher = believed.heights_mm.iter().zip(&all.heights_mm).filter(|(a, b)| **a > **b + 1e-3).count();
        assert!(higher > field.len() / 8, "{higher} of {} dexels", field.len());
    }
}
