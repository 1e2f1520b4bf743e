//! Where a cutter that vibrates is in the strokes of an operation, along the tooth.
//!
//! In: displacements moment by moment while the ram passes the face, stroke by stroke. Out: the displacement of a
//! stroke at a place of the face, and what is said of the stroke. The ram's law is the crank's
//! ([`gearcut_core::passes::planar::strokes`]); between two moments displacements run straight.

use crate::machine_errors::Deflection;
use gearcut_core::passes::planar::strokes::StrokeLaw;
use glam::DVec4;

/// When the ram passes places of the face, as shares of a double stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceTimes {
    crank: StrokeLaw,
    /// The cut enters and ends.
    ends: [f64; 2],
}

impl FaceTimes {
    /// Of a crank and a face.
    pub fn new(crank: StrokeLaw, face_width_mm: f64) -> Self {
        let ends = [0.5, -0.5].map(|end| crank.stroke_share(crank.tau(end * face_width_mm)));
        Self { crank, ends }
    }

    /// Share of a double stroke in which the face is cut.
    pub fn cut_share(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }

    /// Share of the cut up to a place, 0 to 1.
    fn of_cut(&self, z_mm: f64) -> f64 {
        let share = self.crank.stroke_share(self.crank.tau(z_mm));
        ((share - self.ends[0]) / self.cut_share()).clamp(0.0, 1.0)
    }
}

/// What is said of a stroke.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StrokeVibration {
    /// Stiffness of its chips over the limit of stability.
    pub share_of_limit: f64,
    /// Displacement over the face, root mean square: mm or rad.
    pub rms: f64,
}

/// Vibration in an operation.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibration {
    /// Which coordinate of a [`Deflection`].
    pub axis: usize,
    /// When places are passed.
    pub times: FaceTimes,
    /// Displacements of all strokes, each from the entry to the end of the cut, mm or rad. In f32: a nanometre of a
    /// millimetre.
    pub off: Vec<f32>,
    /// Stroke by stroke.
    pub strokes: Vec<StrokeVibration>,
}

impl Vibration {
    /// Displacement in a stroke at a place of the face.
    pub fn at(&self, stroke: usize, z_mm: f64) -> Deflection {
        let moments = self.off.len() / self.strokes.len();
        let place = self.times.of_cut(z_mm) * (moments - 1) as f64;
        let before = (place as usize).min(moments.saturating_sub(2));
        let of = |moment: usize| f64::from(self.off[stroke * moments + moment.min(moments - 1)]);
        let off = of(before) + (place - before as f64) * (of(before + 1) - of(before));
        Deflection::of_coordinates(off * self.unit())
    }

    /// One mm or rad of the coordinate.
    pub fn unit(&self) -> DVec4 {
        DVec4::AXES[self.axis]
    }
}
