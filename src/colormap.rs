//! Colours for values: two scales for maps.
//!
//! In: a value and a range. Out: an sRGB colour.
//!
//! - Sequential: viridis by S. van der Walt and N. Smith (2015, CC0), at 33 anchors, within 2 of 255 of the original's
//!   256 entries. Lightness rises evenly, so it reads in grey and for every kind of colour vision.
//! - Diverging about zero: computed for gearcut in Oklab (B. Ottosson, 2020). Lightness falls evenly from 0.97 at zero
//!   to 0.30 at both ends; hue runs 235 to 262 degrees (blue) below and 55 to 25 degrees (orange to red) above; chroma
//!   is 0.125 (blue) or 0.135 (red) times sin(0.8 pi s^0.85) at distance s from zero, which stays inside sRGB. Blue
//!   against orange-red is the pair that red-green blindness keeps apart.
//!
//! Between anchors sRGB components are interpolated linearly.
//!
//! Road not taken: rainbow scales. They draw borders where the surface has none, and hide some that it has.

/// Cells without a value: a grey that neither scale contains.
pub(super) const NO_VALUE: [u8; 3] = [150, 150, 150];

/// How values become colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ColourScale {
    /// From dark (low) to light (high), in the unit of the map.
    Sequential {
        /// Value at the dark end.
        low: f32,
        /// Value at the light end.
        high: f32,
    },
    /// Blue below zero, white at zero, red above, in the unit of the map.
    Diverging {
        /// Magnitude at both ends.
        limit: f32,
    },
}

impl ColourScale {
    /// Sequential scale over all finite values; give it all maps that shall be compared.
    pub fn sequential_over<'a>(maps: impl IntoIterator<Item = &'a [f32]>) -> Self {
        let (low, high) = finite_range(maps);
        Self::Sequential { low, high }
    }

    /// Diverging scale over all finite values; give it all maps that shall be compared.
    pub fn diverging_over<'a>(maps: impl IntoIterator<Item = &'a [f32]>) -> Self {
        let (low, high) = finite_range(maps);
        Self::Diverging { limit: low.abs().max(high.abs()) }
    }

    /// Scale for heights over a target: sequential where all lie above it, diverging about zero where some lie below it
    /// by more than a hundredth of the largest magnitude.
    pub fn heights_over<'a>(maps: impl IntoIterator<Item = &'a [f32]>) -> Self {
        let (low, high) = finite_range(maps);
        let limit = low.abs().max(high.abs());
        if low < -0.01 * limit { Self::Diverging { limit } } else { Self::Sequential { low, high } }
    }

    /// Sequential scale over the finite values between two quantiles, such as 0.01 and 0.98.
    pub fn between_quantiles<'a>(maps: impl IntoIterator<Item = &'a [f32]>, [low, high]: [f64; 2]) -> Self {
        let mut sorted: Vec<f32> = maps.into_iter().flatten().copied().filter(|v| v.is_finite()).collect();
        sorted.sort_unstable_by(f32::total_cmp);
        let at = |share: f64| {
            let index = (share * sorted.len() as f64) as usize;
            sorted.get(index.min(sorted.len().saturating_sub(1))).copied().unwrap_or(0.0)
        };
        Self::Sequential { low: at(low), high: at(high) }
    }

    /// Values at the two ends.
    pub fn ends(self) -> (f32, f32) {
        match self {
            Self::Sequential { low, high } => (low, high),
            Self::Diverging { limit } => (-limit, limit),
        }
    }

    /// sRGB colour of a value; beyond the ends the end's colour, grey for NaN.
    ///
    /// A scale whose ends coincide gives its middle colour.
    pub fn colour(self, value: f32) -> [u8; 3] {
        let (low, high) = self.ends();
        if value.is_nan() {
            return NO_VALUE;
        }
        let place = f64::from(value - low) / f64::from(high - low);
        let place = if place.is_nan() { 0.5 } else { place.clamp(0.0, 1.0) };
        match self {
            Self::Sequential { .. } => between(&VIRIDIS, place),
            Self::Diverging { .. } => between(&BLUE_WHITE_RED, place),
        }
    }
}

/// Colours of the sequential and of the diverging scale at 256 even places, for programs that colour values themselves.
pub fn tables() -> [[[u8; 3]; 256]; 2] {
    [&VIRIDIS[..], &BLUE_WHITE_RED].map(|anchors| std::array::from_fn(|i| between(anchors, i as f64 / 255.0)))
}

/// Smallest and largest finite value; zeros if there is none.
fn finite_range<'a>(maps: impl IntoIterator<Item = &'a [f32]>) -> (f32, f32) {
    let finite = maps.into_iter().flatten().copied().filter(|value| value.is_finite());
    let (low, high) = finite.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low <= high { (low, high) } else { (0.0, 0.0) }
}

/// Colour at `place` (0 to 1) of a table of evenly spaced anchors.
fn between(anchors: &[[u8; 3]], place: f64) -> [u8; 3] {
    let along = place * (anchors.len() - 1) as f64;
    let index = (along as usize).min(anchors.len() - 2);
    let part = along - index as f64;
    let (from, to) = (anchors[index], anchors[index + 1]);
    std::array::from_fn(|k| (f64::from(from[k]) + part * (f64::from(to[k]) - f64::from(from[k]))).round() as u8)
}

/// Viridis at 33 even places.
#[rustfmt::skip]
const VIRIDIS: [[u8; 3]; 33] = [
    [68, 1, 84], [71, 13, 96], [72, 24, 106], [72, 35, 116], [71, 45, 123], [69, 54, 129],
    [66, 64, 134], [63, 73, 137], [59, 82, 139], [55, 90, 141], [51, 99, 141], [47, 106, 142],
    [44, 114, 142], [41, 122, 142], [38, 129, 142], [35, 137, 142], [33, 144, 140], [31, 152, 139],
    [31, 159, 136], [33, 166, 133], [40, 174, 128], [49, 181, 123], [62, 188, 116], [76, 194, 108],
    [93, 201, 99], [110, 206, 88], [130, 211, 76], [150, 216, 63], [171, 220, 50], [192, 223, 36],
    [213, 226, 26], [234, 229, 26], [253, 231, 37],
];

/// The diverging scale at 17 even places, zero in the middle.
#[rustfmt::skip]
const BLUE_WHITE_RED: [[u8; 3]; 17] = [
    [25, 44, 82], [32, 66, 119], [40, 90, 153], [52, 116, 184], [72, 144, 209], [101, 171, 229],
    [139, 198, 242], [187, 223, 249], [245, 245, 245], [249, 208, 184], [241, 172, 138], [226, 138, 100],
    [205, 107, 73], [178, 80, 53], [147, 58, 41], [113, 40, 32], [78, 26, 24],
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance (WCAG 2), 0 black to 1 white.
    fn luminance(rgb: [u8; 3]) -> f64 {
        let linear = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(rgb[0]) + 0.7152 * linear(rgb[1]) + 0.0722 * linear(rgb[2])
    }

    #[test]
    fn lightness_rises_over_viridis_and_falls_from_the_middle_of_the_other() {
        let viridis = ColourScale::Sequential { low: 0.0, high: 100.0 };
        let diverging = ColourScale::Diverging { limit: 100.0 };
        for i in 0..100_u8 {
            let (a, b) = (f32::from(i), f32::from(i + 1));
            assert!(luminance(viridis.colour(a)) <= luminance(viridis.colour(b)), "viridis at {i}");
            for sign in [1.0, -1.0] {
                let (near, far) = (diverging.colour(sign * a), diverging.colour(sign * b));
                assert!(luminance(near) >= luminance(far), "diverging at {}", sign * a);
            }
        }
    }

    #[test]
    fn ends_middle_and_missing_values_have_their_colours() {
        let scale = ColourScale::Diverging { limit: 2.0 };
        assert_eq!(scale.colour(0.0), [245, 245, 245]);
        assert_eq!(scale.colour(-9.0), BLUE_WHITE_RED[0]);
        assert_eq!(scale.colour(f32::INFINITY), BLUE_WHITE_RED[16]);
        assert_eq!(scale.colour(f32::NAN), NO_VALUE);
        assert_eq!(ColourScale::Diverging { limit: 0.0 }.colour(0.0), [245, 245, 245]);
    }

    #[test]
    fn a_scale_spans_the_finite_values_of_all_maps() {
        let maps: [&[f32]; 3] = [&[f32::NAN, 1.0], &[-3.0, f32::INFINITY], &[]];
        assert_eq!(ColourScale::sequential_over(maps).ends(), (-3.0, 1.0));
        assert_eq!(ColourScale::diverging_over(maps).ends(), (-3.0, 3.0));
        assert_eq!(ColourScale::sequential_over([]).ends(), (0.0, 0.0));
    }
}
