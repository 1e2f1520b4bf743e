//! Rays that pass through the tip of a tooth into the next space.
//!
//! In: a flank, its rays, what operations left on them. Out: for each column whether its heights tell of the flank that
//! it stands on. Law: a ray that leaves the tooth through its other flank meets there the strokes that cut the next
//! space, down to twice the depth that it records. What stands beyond the middle of the tooth is not told from them, so
//! such a column says nothing; the columns below it, where the tooth is thicker, do.
//!
//! Road not taken: rays that end in the middle of the tooth. Heights would then be those of the flank on every ray, but
//! which strokes are candidates is decided for tiles of rays of one depth, on the CPU and in shaders.

use crate::process::shaping::ShapingJob;
use crate::process::shaping::target::TargetFlank;
use gearcut_core::dexel::figures::FieldColumns;
use gearcut_core::dexel::{Column, Field};
use gearcut_core::terms::Side;
use glam::DVec2;

/// Chords that stand for the other flank: they lie a micrometre or less off it, and only half the thickness of a tooth
/// is taken from them.
const CHORDS: u32 = 64;

/// Whether the heights of each column are those of its own flank.
pub fn tell(job: &ShapingJob, flank: &TargetFlank, field: &Field, columns: FieldColumns) -> Vec<bool> {
    let other = match flank.side {
        Side::Left => Side::Right,
        Side::Right => Side::Left,
    };
    let other = job.target_flank(flank.tooth, other);
    let at = |i: u32| other.at_arc(other.length_mm() * f64::from(i) / f64::from(CHORDS)).point_mm;
    let points_mm: Vec<DVec2> = (0..=CHORDS).map(at).collect();
    let tells = |(index, column): (usize, &Column)| {
        let Some(depth_mm) = through_mm(column, &points_mm).filter(|depth_mm| *depth_mm < -2.0 * column.low_mm) else {
            return true;
        };
        let middle_mm = (-0.5 * depth_mm) as f32;
        (0..columns.operations()).all(|operation| columns.heights(operation, index).lowest.height_mm > middle_mm)
    };
    field.columns.iter().enumerate().map(tells).collect()
}

/// How deep in the tooth a ray leaves it through a flank, mm; none where it does not.
fn through_mm(column: &Column, flank_mm: &[DVec2]) -> Option<f64> {
    let inwards = -column.normal;
    let aside = |point: &DVec2| (*point - column.origin_mm, inwards.perp_dot(*point - column.origin_mm));
    let mut deepest: Option<f64> = None;
    let mut before = aside(flank_mm.first()?);
    for point in &flank_mm[1..] {
        let ((from, a), (to, b)) = (std::mem::replace(&mut before, aside(point)), aside(point));
        // The chord crosses the ray's line between its ends.
        if a * b <= 0.0 && a != b {
            let depth_mm = inwards.dot(from.lerp(to, a / (a - b)));
            if depth_mm >= 0.0 {
                deepest = Some(deepest.map_or(depth_mm, |known| known.min(depth_mm)));
            }
        }
    }
    deepest
}
