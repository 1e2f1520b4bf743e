//! The chain before evaluation: F-operator, S-filter, L-filter, crop; and what of it was applied, in words.
//!
//! Order: form off, then waves shorter than the S-filter's nesting index off, then waves longer than the L-filter's,
//! then a margin of every side. ISO 25178-3 wants a filter's edges away from the evaluated area; the local planes of
//! the filters here make that margin a choice.

use crate::error::TextureError;
use serde::Serialize;

use super::form::{self, Form};
use super::gaussian::{low_pass, robust_low_pass};
use super::surface::Surface;

/// What is to be applied.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Chain {
    /// F-operator.
    pub form: Form,
    /// Nesting index of the S-filter, um; none: no filter.
    pub s_filter_um: Option<f64>,
    /// Nesting index of the L-filter, um; none: no filter.
    pub l_filter_um: Option<f64>,
    /// The L-filter is the robust one (ISO 16610-71).
    pub robust: bool,
    /// Margin cut off every side, um.
    pub crop_um: f64,
}

impl Chain {
    /// Nothing but the form.
    pub fn of_form(form: Form) -> Self {
        Self { form, s_filter_um: None, l_filter_um: None, robust: false, crop_um: 0.0 }
    }

    /// Applies the chain; the words say step by step what was done.
    ///
    /// # Errors
    /// A step that the surface does not allow.
    pub fn apply(&self, surface: &Surface) -> Result<(Surface, Vec<String>), TextureError> {
        if let (Some(s), Some(l)) = (self.s_filter_um, self.l_filter_um)
            && s >= l
        {
            return Err(TextureError::FiltersCross { short: "S-filter", short_um: s, long: "L-filter", long_um: l });
        }
        let longest_um = 1e3 * surface.size_mm()[0].max(surface.size_mm()[1]);
        if let Some(l) = self.l_filter_um.filter(|l| *l > longest_um * (1.0 + 1e-9)) {
            return Err(TextureError::LongFilter { index_um: l, longest_um });
        }
        let (mut surface, note) = form::remove(surface, self.form)?;
        let mut words = vec![match note {
            Some(note) => format!("F-operator: {} ({note})", self.form.name()),
            None => format!("F-operator: {}", self.form.name()),
        }];
        match self.s_filter_um {
            Some(index_um) => {
                surface = low_pass(&surface, index_um)?;
                words.push(format!("S-filter: Gaussian, ISO 16610-61, {index_um} um"));
            }
            None => words.push("S-filter: none".to_owned()),
        }
        match self.l_filter_um {
            Some(index_um) => {
                let (mean, what) = if self.robust {
                    let (mean, rounds) = robust_low_pass(&surface, index_um)?;
                    (mean, format!("robust Gaussian, ISO 16610-71, {index_um} um, {rounds} rounds"))
                } else {
                    (low_pass(&surface, index_um)?, format!("Gaussian, ISO 16610-61, {index_um} um"))
                };
                let rest = surface.heights_um().iter().zip(mean.heights_um()).map(|(z, m)| z - m).collect();
                surface = surface.with_heights(rest);
                let [x_um, y_um] = surface.size_mm().map(|mm| 1e3 * mm);
                let short = if index_um > x_um.min(y_um) * (1.0 + 1e-9) {
                    format!(
                        "; the surface is only {:.1} um long along {}",
                        x_um.min(y_um),
                        if x_um < y_um { "x" } else { "y" }
                    )
                } else {
                    String::new()
                };
                words.push(format!("L-filter: {what}{short}"));
            }
            None => words.push("L-filter: none".to_owned()),
        }
        if self.crop_um > 0.0 {
            surface = surface.cropped(self.crop_um)?;
            words.push(format!("crop: {} um on every side", self.crop_um));
        } else {
            words.push("crop: none".to_owned());
        }
        Ok((surface, words))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_l_filter_longer_than_the_surface_is_refused_and_one_longer_than_a_side_is_said() {
        let heights = (0..101 * 21).map(|i| f64::from(i % 7)).collect();
        let surface = Surface::new(101, 21, 4.0, 4.0, heights).expect("a grid");
        let of = |l: f64| Chain { l_filter_um: Some(l), ..Chain::of_form(Form::Plane) }.apply(&surface);
        let refused = of(50_000.0).expect_err("too long");
        assert!(refused.to_string().contains("50000 um) is longer than the surface (400.0 um)"), "{refused}");
        let (_, words) = of(200.0).expect("a filter");
        assert!(words[2].contains("only 80.0 um long along y"), "{words:?}");
        let (_, words) = of(80.0).expect("a filter");
        assert!(!words[2].contains("only"), "{words:?}");
    }
}
