//! A drawing: layers of paths in mm, each with what is on it.
//!
//! In: a section or a tool's edge. Out: [`Drawing`], which writers put into files.

use super::arcs::{ArcPath, PathPieces};
use super::section::{FIT_SHARE, GearSection, ProfileSource, SectionCurve, SectionWish};
use crate::job::{CylindricalGear, ToolSection};
use crate::number_text::plain;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;

/// Chords of a tool's edge over the tolerance: what the fit leaves room for, where the edge bends five times as much as
/// on average.
const TOOL_CHORD_SHARE: f64 = 0.01;

/// Paths by layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// What is said in the head of the file, line by line.
    pub notes: Vec<String>,
    /// Layers.
    pub layers: Vec<DrawingLayer>,
}

/// A layer with its curve.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawingLayer {
    /// Its name.
    pub name: &'static str,
    /// What is on it.
    pub words: String,
    /// Whether it is drawn as a thin dash-dotted line, as pitch curves are; all others are drawn in full.
    pub is_centre_line: bool,
    /// Its curve.
    pub curve: SectionCurve,
}

impl Drawing {
    /// The section of a gear.
    pub fn of_gear(gear: &dyn CylindricalGear, section: &GearSection, wish: &SectionWish) -> Self {
        let scene = gear.scene();
        let (name, what) = match wish.source {
            ProfileSource::Target => ("TARGET", "target: the envelope of the finishing operation"),
            ProfileSource::Cut => ("AS_CUT", "as cut, every mark above the tolerance"),
        };
        let teeth = match wish.teeth {
            None => "closed".to_owned(),
            Some([first, last]) => format!("teeth {first} to {last}, open"),
        };
        let layer = |name, words: &str, is_centre_line, curve| DrawingLayer {
            name,
            words: words.to_owned(),
            is_centre_line,
            curve,
        };
        let mut layers = vec![
            layer(name, &format!("profile, {what}; {teeth}"), false, SectionCurve::Path(section.profile.clone())),
            layer("PITCH_CURVE", "pitch curve", true, section.pitch_curve.clone()),
            layer("BLANK", "outline of the stock, on which the tips lie", true, section.tips.clone()),
        ];
        if section.back.radius_mm > 0.0 {
            let (name, words) = match section.back.name() {
                "bore" => ("BORE", "bore"),
                _ => ("RIM", "outside of the ring"),
            };
            layers.push(layer(name, words, false, SectionCurve::Circle(section.back.radius_mm)));
        }
        let place = format!("transverse section {} mm from the middle of the face", plain(wish.z_mm));
        let notes = vec![
            format!("{}: {}", scene.name, place),
            format!("gear frame: axis at the origin, {}", zero_words(gear)),
            within(wish.tolerance_mm),
        ];
        Self { notes, layers }
    }

    /// The edge of a tool.
    pub fn of_tool(gear: &dyn CylindricalGear, tolerance_mm: f64) -> Self {
        let ToolSection { points_mm, is_closed, words } = gear.tool_section(TOOL_CHORD_SHARE * tolerance_mm);
        let path = ArcPath::fit(&points_mm, is_closed, FIT_SHARE * tolerance_mm, PathPieces::Arcs);
        let notes = vec![format!("tool of {}", gear.scene().name), within(tolerance_mm)];
        let curve = SectionCurve::Path(path);
        Self { notes, layers: vec![DrawingLayer { name: "TOOL", words, is_centre_line: false, curve }] }
    }

    /// Lowest and highest corner of a box round everything, mm.
    pub fn bounds_mm(&self) -> [DVec2; 2] {
        let corners = self.layers.iter().flat_map(|layer| match &layer.curve {
            SectionCurve::Circle(radius_mm) => vec![DVec2::splat(-radius_mm), DVec2::splat(*radius_mm)],
            // The middle of an arc: the box may miss a corner of it by a hundredth.
            SectionCurve::Path(path) => path.vertices.iter().map(|vertex| vertex.point_mm).collect(),
        });
        let points: Vec<DVec2> = corners.collect();
        let low = points.iter().copied().reduce(DVec2::min).unwrap_or_default();
        [low, points.into_iter().reduce(DVec2::max).unwrap_or_default()]
    }
}

/// What lies on the x axis of the gear's frame.
pub fn zero_words(gear: &dyn CylindricalGear) -> &'static str {
    if gear.curve().sector_rad().is_some() {
        "phi = 0 of the pitch curve on the x axis"
    } else {
        "a tooth space on the x axis, tooth 1 counter-clockwise of it"
    }
}

fn within(tolerance_mm: f64) -> String {
    format!("every path is within {} um of its curve", plain(tolerance_mm * UM_PER_MM))
}
