//! The feed path: how slide, shift and infeed move over time, as pieces with constant rates.

/// One piece with constant feeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeedPhase {
    /// How long it lasts, s.
    pub duration_s: f64,
    /// Slide, along the work's rotation vector, mm/s.
    pub slide_mm_per_s: f64,
    /// Shift along d0, mm/s.
    pub shift_mm_per_s: f64,
    /// Away from the work, mm/s; negative feeds in.
    pub radial_mm_per_s: f64,
}

/// Start and pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct FeedPath {
    /// Slide at the beginning, mm.
    pub start_slide_mm: f64,
    /// Shift at the beginning, mm.
    pub start_shift_mm: f64,
    /// Distance from full depth at the beginning, mm.
    pub start_radial_mm: f64,
    /// Pieces in order; at least one.
    pub phases: Vec<FeedPhase>,
}

impl FeedPath {
    /// Constant feeds from slide 0 and shift 0 at full depth.
    #[cfg(feature = "testing")]
    pub fn steady(duration_s: f64, slide_mm_per_s: f64, shift_mm_per_s: f64) -> Self {
        Self {
            start_slide_mm: 0.0,
            start_shift_mm: 0.0,
            start_radial_mm: 0.0,
            phases: vec![FeedPhase { duration_s, slide_mm_per_s, shift_mm_per_s, radial_mm_per_s: 0.0 }],
        }
    }
}
