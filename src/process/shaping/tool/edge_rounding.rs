//! What a rounded cutting edge does to a surface that it meets: cut, or plough.
//!
//! In: the surface along a ray, the place at which the ray enters the edge, and the cosine between ray and edge normal.
//! Out: the surface that is left. An edge of radius r_beta takes no chip thinner than h_min = k r_beta (Brammertz,
//! *Die Entstehung der Oberflächenrauheit beim Feindrehen*, Industrie-Anzeiger 83, 1961): what is thinner goes under
//! the edge. The share e of it springs back behind the edge, the rest stays pressed down.
//!
//! With d, the distance from the edge to the surface before times the cosine: d >= h_min leaves the edge's place, a
//! smaller d leaves the surface d (1 - e) lower, measured across it. Nothing else is kept between strokes: what was
//! ploughed is not harder than before, and pressed-down material goes nowhere.
//!
//! Road not taken: spring-back behind a chip. It lifts the whole surface alike, which a shop feeds away.

use crate::process::shaping::scene::model::EdgeRounding;

/// What an edge does to a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Meeting {
    /// Takes a chip so thick, mm: the surface is the edge's place.
    Cuts(f64),
    /// Takes none: the surface stands so high afterwards, mm.
    Ploughs(f64),
}

impl EdgeRounding {
    /// h_min: thickness of the thinnest chip, mm.
    pub fn minimum_chip_mm(&self) -> f64 {
        self.minimum_chip_share * self.radius_mm
    }

    /// An edge that enters at `edge_mm` a ray on which the surface stands at `surface_mm`, not lower.
    pub fn meet(&self, surface_mm: f64, edge_mm: f64, cosine: f64) -> Meeting {
        let depth_mm = surface_mm - edge_mm;
        if depth_mm * cosine >= self.minimum_chip_mm() {
            Meeting::Cuts(depth_mm * cosine)
        } else {
            Meeting::Ploughs(surface_mm - (1.0 - self.recovery_share) * depth_mm)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nose radius and feed of turning, mm.
    const NOSE_MM: f64 = 0.8;
    const FEED_MM: f64 = 0.04;

    fn rounding(chip_mm: f64, recovery_share: f64) -> EdgeRounding {
        EdgeRounding { radius_mm: 2.0 * chip_mm, minimum_chip_share: 0.5, recovery_share }
    }

    /// Height of a surface turned with a round nose, from the lowest to the highest point within a feed: passes one
    /// after the other at each of many places.
    fn turned_mm(rounding: &EdgeRounding) -> f64 {
        let places = 20_000;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for place in 0..places {
            let x_mm = FEED_MM * f64::from(place) / f64::from(places);
            let mut surface_mm = 0.5 * NOSE_MM;
            for pass in -15..=15 {
                let from_center_mm = x_mm - FEED_MM * f64::from(pass);
                let cosine = (1.0 - (from_center_mm / NOSE_MM).powi(2)).max(0.0).sqrt();
                let edge_mm = NOSE_MM * (1.0 - cosine);
                if edge_mm < surface_mm && cosine > 0.0 {
                    surface_mm = match rounding.meet(surface_mm, edge_mm, cosine) {
                        Meeting::Cuts(_) => edge_mm,
                        Meeting::Ploughs(left_mm) => left_mm,
                    };
                }
            }
            (low, high) = (low.min(surface_mm), high.max(surface_mm));
        }
        high - low
    }

    /// Brammertz 1961: Rth = f^2 / (8 r) + h_min / 2 (1 + r h_min / f^2), for parabolas instead of circles.
    fn brammertz_mm(chip_mm: f64) -> f64 {
        FEED_MM * FEED_MM / (8.0 * NOSE_MM) + 0.5 * chip_mm * (1.0 + NOSE_MM * chip_mm / (FEED_MM * FEED_MM))
    }

    /// Each pass begins to cut where the surface of the one before stands h_min over it, and leaves the wedge before
    /// that place: the formula, exactly, for parabolas. A circle of radius r rises by (x / r)^2 / 4 more at x, and its
    /// normal leans: with x up to a feed, 0.25 % of the height at most.
    #[test]
    fn a_round_nose_leaves_the_height_of_brammertz() {
        let thickest_mm = FEED_MM * FEED_MM / (2.0 * NOSE_MM);
        for share in [1e-6, 0.1, 0.3, 0.6, 0.9, 1.0] {
            let chip_mm = share * thickest_mm;
            let (found, expected) = (turned_mm(&rounding(chip_mm, 1.0)), brammertz_mm(chip_mm));
            println!("h_min {share} of f^2 / 2 r: {:.5} um, Brammertz {:.5} um", 1e3 * found, 1e3 * expected);
            assert!((found / expected - 1.0).abs() < 2.5e-3, "{share}: {found} for {expected}");
        }
    }

    /// Thicker than the chip at the lowest point of the nose, f^2 / (2 r): the wedges meet, nothing is cut down to the
    /// lowest point any more, and the height is h_min itself. The formula goes on to rise with h_min^2.
    #[test]
    fn beyond_its_range_the_height_stays_near_the_thinnest_chip() {
        let thickest_mm = FEED_MM * FEED_MM / (2.0 * NOSE_MM);
        for share in [1.2, 1.5, 1.9] {
            let chip_mm = share * thickest_mm;
            let found = turned_mm(&rounding(chip_mm, 1.0));
            assert!((found / chip_mm - 1.0).abs() < 2.5e-3, "{share}: {found} for {chip_mm}");
            assert!(brammertz_mm(chip_mm) > 1.005 * chip_mm, "{share}");
        }
        for share in [3.0, 10.0, 30.0] {
            let chip_mm = share * thickest_mm;
            let found = turned_mm(&rounding(chip_mm, 1.0));
            println!("h_min {share} of f^2 / 2 r: {:.3} h_min", found / chip_mm);
            // No surface stands h_min over the lowest of all passes, whose crests are f^2 / (8 r) high.
            assert!(found < chip_mm + brammertz_mm(0.0), "{share}: {found}");
            assert!(brammertz_mm(chip_mm) > 1.3 * chip_mm, "{share}");
        }
    }

    /// Nothing springs back: every stroke leaves its edge, as without rounding.
    #[test]
    fn without_recovery_the_edge_is_copied() {
        let sharp_mm = turned_mm(&rounding(1e-12, 1.0));
        assert!((turned_mm(&rounding(0.002, 0.0)) - sharp_mm).abs() < 1e-12);
        assert!((sharp_mm / brammertz_mm(0.0) - 1.0).abs() < 1e-3, "{sharp_mm}");
        let between = turned_mm(&rounding(0.0008, 0.5));
        assert!(sharp_mm < between && between < turned_mm(&rounding(0.0008, 1.0)));
    }
}
