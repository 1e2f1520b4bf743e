//! Noise of measured values: each on its own, and flanks as a whole.
//!
//! In: both standard deviations, the measured places. Out: values over their noise, as least squares take them.
//!
//! Law: the noise of two values of one flank has the covariance tau^2, tau being the standard deviation by which whole
//! flanks are off at random, and each value has sigma^2 of its own beside it. Values over their noise are Sigma^(-1/2)
//! times the values; of n values of a flank with the mean m that is (x - c m) / sigma, c = 1 - (1 + n tau^2 /
//! sigma^2)^(-1/2). Without tau a flank with many measured places weighs as much as all of them: a drive that wanders
//! from tooth to tooth is then explained by an error that happens to fit these few flanks.
//!
//! Road not taken: tau from the residuals. Sources that are chosen without it fit the flanks with many places as they
//! are, and leave nothing there to see it by.

use crate::influence::measured::MeasuredPoint;
use std::collections::BTreeMap;

/// Noise of the values of a diagnosis.
#[derive(Debug, Clone, Default)]
pub struct Noise {
    /// sigma: standard deviation of each value on its own, um.
    pub value_um: f64,
    /// tau: standard deviation of whole flanks, um.
    pub flank_um: f64,
    /// Places of each flank, by their numbers.
    flanks: Vec<Vec<usize>>,
}

impl Noise {
    /// Of values alone, um.
    pub fn of_values(value_um: f64) -> Self {
        Self { value_um, ..Self::default() }
    }

    /// The same of flanks as a whole as well, um.
    #[must_use]
    pub fn and_flanks(self, flank_um: f64, points: &[MeasuredPoint]) -> Self {
        let mut flanks: BTreeMap<_, Vec<usize>> = BTreeMap::new();
        for (place, point) in points.iter().enumerate() {
            flanks.entry((point.tooth, point.side.name())).or_default().push(place);
        }
        Self { flank_um, flanks: flanks.into_values().collect(), ..self }
    }

    /// Values of all places over their noise; `taken` says which of them there are.
    pub(super) fn over(&self, values_um: &[f64], taken: impl Fn(usize) -> bool) -> Vec<f64> {
        let mut over: Vec<f64> = values_um.iter().map(|um| um / self.value_um).collect();
        if self.flank_um > 0.0 {
            let ratio = (self.flank_um / self.value_um).powi(2);
            for flank in &self.flanks {
                let there: Vec<usize> = flank.iter().copied().filter(|&place| taken(place)).collect();
                let count = there.len() as f64;
                let mean = there.iter().map(|&place| over[place]).sum::<f64>() / count.max(1.0);
                let off = mean * (1.0 - 1.0 / (1.0 + count * ratio).sqrt());
                for place in there {
                    over[place] -= off;
                }
            }
        }
        (0..over.len()).filter(|&place| taken(place)).map(|place| over[place]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearcut_core::terms::Side;

    /// (x / noise)^2 is x Sigma^-1 x, with Sigma^-1 by the formula of Sherman and Morrison.
    #[test]
    fn squares_over_the_noise_are_those_of_its_covariance() {
        let at = |tooth| MeasuredPoint { tooth, side: Side::Left, u_mm: 1.0, v_mm: 0.0, deviation_um: 0.0 };
        let points = [at(1), at(1), at(2), at(1), at(3)];
        let (sigma, tau) = (0.4, 0.9);
        let noise = Noise::of_values(sigma).and_flanks(tau, &points);
        let x = [0.3, -1.2, 0.8, 2.0, 5.0];
        // The last place is left out.
        let found: f64 = noise.over(&x, |place| place < 4).iter().map(|over| over * over).sum();
        let of_flank = |values: &[f64]| {
            let (sum, squares): (f64, f64) = (values.iter().sum(), values.iter().map(|x| x * x).sum());
            let share = tau * tau / (sigma * sigma + values.len() as f64 * tau * tau);
            (squares - share * sum * sum) / (sigma * sigma)
        };
        let wanted = of_flank(&[0.3, -1.2, 2.0]) + of_flank(&[0.8]);
        assert!((found / wanted - 1.0).abs() < 1e-12, "{found} not {wanted}");
        let alone = Noise::of_values(sigma).over(&x, |_| true);
        assert_eq!(alone, x.map(|x| x / sigma));
    }
}
