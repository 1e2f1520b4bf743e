//! Numbers as text: as a scene gives them, with the digits that matter, without what is 0.

use gearcut_core::units::UM_PER_MM;

/// Offsets below this are rounding, mm.
const LEAST_OFFSET_MM: f64 = 5e-7;

/// A length, where it is not 0.
pub fn um(name: &str, value_mm: f64) -> Vec<String> {
    size(name, value_mm * UM_PER_MM, "um")
}

/// A size with its unit, where it is not 0.
pub fn size(name: &str, value: f64, unit: &str) -> Vec<String> {
    if value == 0.0 { Vec::new() } else { vec![format!("{name} {} {unit}", number(value))] }
}

/// Four digits, without zeros behind the point: as a scene gives it.
pub fn number(value: f64) -> String {
    let text = significant(value, 4);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A number with this many significant digits and no exponent, such as "0.0942", "14.95", "4200".
pub fn significant(value: f64, digits: u32) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let decimals = (f64::from(digits) - 1.0 - value.abs().log10().floor()).clamp(0.0, 15.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.trim_start_matches(['-', '0', '.']).is_empty() { "0".to_owned() } else { text }
}

/// A number to so many decimals that `width` has two significant digits; three digits where that is no width.
pub fn to_width(value: f64, width: f64) -> String {
    if !(width > 0.0 && width.is_finite()) {
        return significant(value, 3);
    }
    let decimals = (1.0 - width.log10().floor()).clamp(0.0, 15.0) as usize;
    let text = format!("{value:.decimals$}");
    let is_nothing = text.trim_start_matches(['-', '0', '.']).is_empty();
    if is_nothing { text.trim_start_matches('-').to_owned() } else { text }
}

/// The number that is meant by "0,25", "250um" or "2,5 mm"; none where the text is a number, or far from one.
pub fn number_meant(typed: &str) -> Option<String> {
    let typed = typed.trim();
    let number = typed.trim_end_matches(|letter: char| !letter.is_ascii_digit()).replace(',', ".");
    (number != typed && number.parse::<f64>().is_ok()).then_some(number)
}

/// How far a tool stays back from full depth, in words.
pub fn from_full_depth(offset_mm: f64) -> String {
    match offset_mm {
        short if short > LEAST_OFFSET_MM => format!("{} mm short of full depth", plain(offset_mm)),
        beyond if beyond < -LEAST_OFFSET_MM => format!("{} mm beyond full depth", plain(-offset_mm)),
        _ => "at full depth".to_owned(),
    }
}

/// A number as a scene gives it, to six decimals and without trailing zeros, such as "3", "0.5", "61.11".
pub fn plain(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_offset_says_which_way_it_goes() {
        let words = [2.0, 0.0, -0.068_687, 1e-13].map(from_full_depth);
        let expected = ["2 mm short of full depth", "at full depth", "0.068687 mm beyond full depth", "at full depth"];
        assert_eq!(words, expected);
    }

    #[test]
    fn a_comma_or_a_unit_does_not_hide_a_number() {
        let meant = |typed| number_meant(typed).unwrap_or_default();
        assert_eq!(["0,25", "250um", " -2,5 mm"].map(meant), ["0.25", "250", "-2.5"]);
        assert_eq!(["", "um", "1,2,3", "[1, 2]", "three", "1.000,5", "1e-3"].map(number_meant), [const { None }; 7]);
    }

    #[test]
    fn given_numbers_look_as_given() {
        assert_eq!(
            [3.0, 0.5, 61.11, -1e-9, 100.0, 1.0 / 3.0].map(plain),
            ["3", "0.5", "61.11", "0", "100", "0.333333"]
        );
    }

    #[test]
    fn the_width_of_an_interval_says_how_many_decimals_matter() {
        let texts = [(0.003_998_5, 0.001_33), (6.1, 0.37), (-0.000_3, 0.02), (1234.4, 850.0), (2e-4, 9.96e-6)];
        let expected = ["0.0040", "6.10", "0.000", "1234", "0.0002000"];
        assert_eq!(texts.map(|(value, width)| to_width(value, width)), expected);
        assert_eq!([0.0, f64::NAN].map(|width| to_width(0.012_34, width)), ["0.0123", "0.0123"]);
    }

    #[test]
    fn numbers_keep_the_digits_that_matter() {
        let texts = [0.094_23, 14.948, 4200.0, -0.001, 123_456.7, 0.0, 1e-30].map(|value| significant(value, 4));
        assert_eq!(texts, ["0.09423", "14.95", "4200", "-0.001000", "123457", "0", "0"]);
    }
}
