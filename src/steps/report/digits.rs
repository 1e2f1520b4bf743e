//! Numbers as the page shows them.

use crate::number_text::significant;

/// A number with so many digits; as a power of ten where a plain number would be mostly zeros.
pub(super) fn digits(value: f64, count: u32) -> String {
    let text = if value != 0.0 && value.abs() < 1e-4 {
        let text = format!("{value:.*e}", count as usize - 1);
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let raised = exponent.chars().map(|c| match c {
            '-' => '⁻',
            digit => "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(digit.to_digit(10).unwrap_or(0) as usize).unwrap_or('⁰'),
        });
        format!("{mantissa} × 10{}", raised.collect::<String>())
    } else {
        significant(value, count)
    };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_are_powers_of_ten() {
        let texts = [0.256_63, -0.001, 3.14e-7, -2e-12, 0.0].map(|value| digits(value, 3));
        assert_eq!(texts, ["0.257", "−0.00100", "3.14 × 10⁻⁷", "−2.00 × 10⁻¹²", "0"]);
    }
}
