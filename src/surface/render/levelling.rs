//! A shear that lays a leaning open surface flat in the mean, for the boxes over its triangles.
//!
//! In: triangles. Out: a shear, the boxes of sheared triangles, sheared rays. A flank that is rolled out under a
//! microscope is a plane of long strips, and where it leans their boxes would be full of each other. Sheared boxes
//! stand on the mean plane instead; a ray that is sheared alike enters them at the same distance, and triangles are met
//! as they are. A closed body leans nowhere, and its shear changes no bit.

use glam::DVec3;

/// A surface is open where the sum of its triangles' areas as vectors is longer than this share of their sum: of a
/// closed one it is nothing.
const OPEN_SHARE: f64 = 0.5;
/// Sheared boxes are so much larger, mm: what rounding may take from a flat one.
const SHEARED_MARGIN_MM: f64 = 1e-9;

/// Moves points along an axis by a linear share of the other coordinates.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Levelling {
    axis: DVec3,
    pub lean: DVec3,
}

impl Levelling {
    /// The one that lays an open surface flat in the mean; none for a closed one.
    pub fn of(corners_mm: &[[DVec3; 3]]) -> Self {
        let areas = corners_mm.iter().map(|[a, b, c]| (b - a).cross(c - a));
        let (vector, length) =
            areas.fold((DVec3::ZERO, 0.0), |(vector, length), area| (vector + area, length + area.length()));
        if vector.length() <= OPEN_SHARE * length {
            return Self::default();
        }
        let steepest = (0..3).max_by(|&i, &j| vector[i].abs().total_cmp(&vector[j].abs())).unwrap_or(2);
        let mut lean = vector / vector[steepest];
        lean[steepest] = 0.0;
        Self { axis: DVec3::AXES[steepest], lean }
    }

    /// A point or a direction, sheared.
    pub fn sheared(&self, v: DVec3) -> DVec3 {
        v + self.axis * self.lean.dot(v)
    }

    /// Lower and upper corner of the box of a sheared triangle, mm.
    pub fn box_mm(&self, corners_mm: &[DVec3; 3]) -> [DVec3; 2] {
        let [a, b, c] = corners_mm.map(|corner| self.sheared(corner));
        let margin_mm = DVec3::splat(if self.lean == DVec3::ZERO { 0.0 } else { SHEARED_MARGIN_MM });
        [a.min(b).min(c) - margin_mm, a.max(b).max(c) + margin_mm]
    }
}
