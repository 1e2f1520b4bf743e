//! Play between a drive and its axis.
//!
//! In: where the drive stands, and its turning points in time. Out: where the axis stands. Law (the play operator of
//! hysteresis; Krasnosel'skii and Pokrovskii, *Systems with Hysteresis*, 1989): the drive moves freely over the width b
//! and pushes the axis at either end, w = max(m - b/2, min(m + b/2, w before)). Between two turning points the drive
//! moves one way, and w before may be that of the turning point: no history is needed.

/// Axis positions at the turning points of the drive.
#[derive(Debug, Clone)]
pub(super) struct Play {
    half_width: f64,
    /// Times and positions of the axis, the first from the beginning.
    turns: Vec<(f64, f64)>,
}

impl Play {
    /// Play of a width; `drive` stands at the beginning, moving the way of `sign`, and at its turning points after it.
    pub fn new(width: f64, sign: f64, drive: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let half_width = 0.5 * width;
        let mut turns: Vec<(f64, f64)> = Vec::new();
        for (time_s, at) in drive {
            let before = turns.last().map_or(at - sign * half_width, |&(_, axis)| axis);
            turns.push((time_s, before.clamp(at - half_width, at + half_width)));
        }
        Self { half_width, turns }
    }

    /// Where the axis stands while the drive stands at `drive`.
    pub fn axis(&self, time_s: f64, drive: f64) -> f64 {
        let index = self.turns.partition_point(|&(turn_s, _)| turn_s <= time_s).max(1) - 1;
        self.turns[index].1.clamp(drive - self.half_width, drive + self.half_width)
    }
}
