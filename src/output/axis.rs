//! Round numbers along an axis.
//!
//! In: a range and how many labels fit. Out: tick values at 1, 2 or 5 times a power of ten, with labels that share
//! their number of decimals, and a common power of ten where the numbers would get long.

/// Ticks of an axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ticks {
    /// Places of the ticks, in the axis' unit, rising.
    pub values: Vec<f64>,
    /// Their labels.
    pub labels: Vec<String>,
    /// Power of ten that all labels are to be multiplied by; 0 mostly.
    pub exponent: i32,
}

impl Ticks {
    /// At most `most` ticks (but two at least) on round numbers within `low..=high`.
    pub(super) fn over(low: f64, high: f64, most: usize) -> Self {
        let step = round_step((high - low) / most.max(2) as f64);
        // Ticks are whole multiples of the step, counted by integers: adding steps up would drift.
        let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
        let count = (last - first) as usize + 1;
        let values: Vec<f64> = (0..count).map(|k| (first + k as f64) * step).collect();
        let largest = low.abs().max(high.abs());
        let exponent = if largest >= 1e5 || step < 1e-4 { largest.log10().floor() as i32 } else { 0 };
        let unit = 10_f64.powi(exponent);
        let decimals = (-(step / unit).log10().floor()).max(0.0) as usize;
        let labels = values.iter().map(|value| number_text(value / unit, decimals)).collect();
        Self { values, labels, exponent }
    }

    /// The axis' unit with the common power of ten, such as "10⁶ mm/s³".
    pub(super) fn unit_text(&self, unit: &str) -> String {
        if self.exponent == 0 {
            return unit.to_owned();
        }
        let exponent = self.exponent.to_string();
        let digits = exponent.chars().map(|digit| match digit {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => char::from_u32('⁰' as u32 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
        });
        format!("10{} {unit}", digits.collect::<String>())
    }
}

/// Range from round number to round number around `low..=high`; a range without extent gets one.
pub(super) fn round_range(low: f64, high: f64) -> (f64, f64) {
    let (low, high) = if high > low { (low, high) } else { (low - 0.5 * wide(low), low + 0.5 * wide(low)) };
    let step = round_step((high - low) / 8.0);
    ((low / step + 1e-9).floor() * step, (high / step - 1e-9).ceil() * step)
}

/// A range made so wide that ticks on it are `division` apart at least: about its middle, from tick to tick. No
/// division, no change.
pub(super) fn widened((low, high): (f64, f64), division: f64) -> (f64, f64) {
    /// Divisions that an axis shows at least.
    const FEWEST: f64 = 6.0;
    let lacking = FEWEST * division - (high - low);
    if lacking <= 0.0 {
        return (low, high);
    }
    let (low, high) = (low - 0.5 * lacking, high + 0.5 * lacking);
    ((low / division + 1e-9).floor() * division, (high / division - 1e-9).ceil() * division)
}

fn wide(value: f64) -> f64 {
    if value == 0.0 { 1.0 } else { value.abs() }
}

/// Smallest of 1, 2, 5 times a power of ten that is not below `step`.
pub(super) fn round_step(step: f64) -> f64 {
    if !(step.is_finite() && step > 0.0) {
        return 1.0;
    }
    let power = 10_f64.powf(step.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= step * (1.0 - 1e-9)).unwrap_or(10.0);
    factor * power
}

/// A number with a real minus sign, and no minus before zero.
pub(super) fn number_text(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// A measured value with three significant digits, such as "0.0123", "12.3", "1230".
pub(super) fn value_text(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 || !magnitude.is_finite() {
        return number_text(value, 0);
    }
    if !(1e-4..1e6).contains(&magnitude) {
        return format!("{value:.2e}").replace('-', "−");
    }
    number_text(value, (2.0 - magnitude.log10().floor()).max(0.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, most: usize) -> String {
        let ticks = Ticks::over(low, high, most);
        format!("{} [{}]", ticks.labels.join(" "), ticks.unit_text("mm"))
    }

    #[test]
    fn ticks_are_round_and_labels_short() {
        assert_eq!(labels(0.0, 30.0, 8), "0 5 10 15 20 25 30 [mm]");
        assert_eq!(labels(-0.31, 0.12, 5), "−0.3 −0.2 −0.1 0.0 0.1 [mm]");
        assert_eq!(labels(0.0, 7.0, 4), "0 2 4 6 [mm]");
        assert_eq!(labels(-2.5e6, 2.5e6, 5), "−2 −1 0 1 2 [10⁶ mm]");
        assert_eq!(labels(0.0, 5e-6, 5), "0 1 2 3 4 5 [10⁻⁶ mm]");
    }

    #[test]
    fn ranges_end_on_round_numbers_and_have_extent() {
        assert_eq!(round_range(0.03, 7.9), (0.0, 8.0));
        for value in [0.0, 3.0, -1e-9] {
            let (low, high) = round_range(value, value);
            assert!(low < value && value < high, "{low} to {high} around {value}");
        }
    }

    #[test]
    fn an_axis_keeps_its_least_division() {
        assert_eq!(widened((-0.02, 0.03), 1.0), (-3.0, 4.0));
        assert_eq!(widened((-9.0, 3.0), 1.0), (-9.0, 3.0));
        assert_eq!(widened((0.0, 1e-6), 0.0), (0.0, 1e-6));
        for most in 4..=9 {
            let (low, high) = widened((-0.02, 0.03), 1.0);
            let ticks = Ticks::over(low, high, most).values;
            assert!(ticks.windows(2).all(|pair| pair[1] - pair[0] > 0.99), "{most}: {ticks:?}");
        }
    }

    #[test]
    fn values_keep_three_digits() {
        let texts = [0.012345, 12.345, -1234.5, 0.0, 1.5e-7, -0.00001].map(value_text);
        assert_eq!(texts, ["0.0123", "12.3", "−1234", "0", "1.50e−7", "−1.00e−5"]);
    }
}
