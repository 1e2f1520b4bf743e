//! Median and interval of a number over gears.

/// Shares of the values below the ends of an interval.
pub const INTERVAL: [f64; 2] = [0.05, 0.95];

/// Median, 5 % and 95 % of some values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// How many values.
    pub count: usize,
    /// Twentieth part from below.
    pub low: f64,
    /// Middle.
    pub median: f64,
    /// Twentieth part from above.
    pub high: f64,
}

impl Spread {
    /// Of values in any order; none of none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let at = |share: f64| quantile(&values, share);
        Some(Self { count: values.len(), low: at(INTERVAL[0])?, median: at(0.5)?, high: at(INTERVAL[1])? })
    }
}

/// Value below which a share of sorted values lies: straight between the two next to (n - 1) share (Hyndman and Fan,
/// *Sample quantiles in statistical packages*, 1996, definition 7).
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let place = share * last as f64;
    let (index, part) = (place.floor() as usize, place.fract());
    Some(sorted[index] + part * (sorted[(index + 1).min(last)] - sorted[index]))
}
