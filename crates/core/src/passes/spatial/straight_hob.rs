//! A simple tool for tests: a hob of axial gashes with straight edges.

use crate::frame::Rigid3;
use crate::tool::blade_edges::BladeEdges;
use crate::tool::edge::{Edge, Segment, SegmentName};
use crate::tool::{CuttingTool, SpatialTool};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A hob of axial gashes: module, starts, gashes, pitch radius; straight edges.
pub struct StraightHob {
    edges: BladeEdges,
    places: Vec<Rigid3>,
}

const GASHES: u32 = 12;
impl StraightHob {
    pub fn new(module_mm: f64, starts: u32, pitch_radius_mm: f64) -> Self {
        let flank = |height: f64, sign: f64| {
            let half = (0.25 * PI - height * 20_f64.to_radians().tan()) * module_mm;
            DVec2::new(pitch_radius_mm + height * module_mm, sign * half)
        };
        let corners = [flank(-1.25, -1.0), flank(1.25, -1.0), flank(1.25, 1.0), flank(-1.25, 1.0)];
        let names = [SegmentName::FlankRight, SegmentName::Tip, SegmentName::FlankLeft];
        let segments =
            names.iter().zip(corners.windows(2)).map(|(&name, ends)| Segment::straight(name, ends[0], ends[1]));
        let pitch_mm = PI * module_mm;
        let places = (0..starts * GASHES)
            .flat_map(|gash| (-1..=1).map(move |turn| (gash / GASHES, gash % GASHES, turn)))
            .map(|(start, gash, turn)| {
                let angle = TAU * f64::from(gash) / f64::from(GASHES);
                let threads = f64::from(starts) * (f64::from(turn) + f64::from(gash) / f64::from(GASHES));
                let axial_mm = pitch_mm * (threads + f64::from(start));
                Rigid3 { rotation: DMat3::from_rotation_z(angle), translation_mm: DVec3::new(0.0, 0.0, axial_mm) }
                    .after(&Rigid3 {
                        // x stays, y along the axis.
                        rotation: DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
                        translation_mm: DVec3::ZERO,
                    })
            })
            .collect();
        Self { edges: BladeEdges::shared(Edge::new(segments.collect())), places }
    }
}

impl CuttingTool for StraightHob {
    fn blade_count(&self) -> u32 {
        self.places.len() as u32
    }
    fn edges(&self) -> &BladeEdges {
        &self.edges
    }
}

impl SpatialTool for StraightHob {
    fn tool_from_blade(&self, index: u32) -> Rigid3 {
        self.places[index as usize]
    }
    fn rake_twist_rad_per_mm(&self) -> f64 {
        0.0
    }
    fn half_window_rad(&self) -> f64 {
        PI / 3.0
    }
}
