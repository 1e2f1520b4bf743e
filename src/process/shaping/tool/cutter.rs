//! The shaper cutter: a pinion whose teeth are the blades, an involute one or one with drawn teeth.
//!
//! Comes from the scene, goes to target flanks and passes. Where the scene names no contour ([`crate::drawn_tooth`])
//! its teeth are those of [`super::involute_tooth`].

use crate::drawn_tooth::{ContourPlace, DrawnTooth, TeethOn};
use crate::process::shaping::scene::{PROFILE, model};
use crate::process::shaping::tool::edge_roughness;
use crate::process::shaping::tool::involute_tooth::{InvoluteTooth, ground_edge, involute_tooth};
use crate::scene::drawn_profile::ToolProfile;
use crate::scene::model::Gear;
use gearcut_core::error::Refusal;
use gearcut_core::frame::Rigid2;
use gearcut_core::tool::blade_edges::BladeEdges;
use gearcut_core::tool::edge::Edge;
use gearcut_core::tool::{CuttingTool, PlanarTool};
use glam::DVec2;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A shaper cutter ready to cut.
#[derive(Debug, Clone)]
pub struct ShaperCutter {
    /// z0.
    pub teeth: u32,
    /// r_c = m z0 / 2.
    pub pitch_radius_mm: f64,
    /// Radius of the tip circle.
    pub tip_radius_mm: f64,
    /// Radius of the root circle.
    pub root_radius_mm: f64,
    /// What its teeth are.
    pub tooth: CutterTooth,
    /// The edge of an ideal tooth.
    edge: Edge,
    /// Edges that cut: as they are ground, and each rough in its own way, where the scene says so.
    edges: BladeEdges,
    runout_mm: DVec2,
    tooth_angles_rad: Vec<f64>,
}

/// What the teeth of a cutter are.
#[derive(Debug, Clone, PartialEq)]
pub enum CutterTooth {
    /// Involute flanks.
    Involute(InvoluteTooth),
    /// A contour.
    Drawn(Arc<DrawnTooth>),
}

impl ShaperCutter {
    /// Cutter of a scene for a gear with this module and pressure angle.
    ///
    /// # Errors
    /// Pointed teeth, a tip round that does not fit, a pitch error list of the wrong length, an edge that is too rough.
    pub fn new(spec: &model::CutterSpec, gear: &Gear) -> Result<Self, Refusal> {
        let m = gear.module_mm;
        let pitch_radius_mm = 0.5 * m * f64::from(spec.teeth);
        let (tooth, edge, [tip_radius_mm, root_radius_mm]) = match &spec.profile {
            None => {
                let (tooth, edge, radii_mm) = involute_tooth(spec, gear)?;
                (CutterTooth::Involute(tooth), edge, radii_mm)
            }
            Some(profile) => Self::drawn_tooth(spec, profile, m)?,
        };
        let ground = match &spec.grinding {
            None => edge.clone(),
            Some(grinding) => ground_edge(spec, grinding, gear)?,
        };
        let errors = &spec.pitch_errors_mm;
        if !errors.is_empty() && errors.len() != spec.teeth as usize {
            return Err(Refusal::new(
                "tool.shaper_cutter.pitch_errors_um",
                format!("{} pitch errors for {} teeth", errors.len(), spec.teeth),
                "give one value per cutter tooth, or leave the key out",
            ));
        }
        let tooth_angles_rad = (0..spec.teeth)
            .map(|j| {
                let error_mm = errors.get(j as usize).copied().unwrap_or(0.0);
                TAU * f64::from(j) / f64::from(spec.teeth) + error_mm / pitch_radius_mm
            })
            .collect();
        Ok(Self {
            teeth: spec.teeth,
            pitch_radius_mm,
            tip_radius_mm,
            root_radius_mm,
            tooth,
            edges: match &spec.edge_roughness {
                None => BladeEdges::shared(ground),
                Some(roughness) => edge_roughness::rough_edges(roughness, &ground, spec.teeth)?,
            },
            edge,
            runout_mm: spec.runout_mm * DVec2::from_angle(spec.runout_angle_rad),
            tooth_angles_rad,
        })
    }

    /// The tooth of a contour, its edge, and the radii of its tip and its root.
    fn drawn_tooth(
        spec: &model::CutterSpec,
        profile: &ToolProfile,
        module_mm: f64,
    ) -> Result<(CutterTooth, Edge, [f64; 2]), Refusal> {
        let pitch_radius_mm = 0.5 * module_mm * f64::from(spec.teeth);
        let pitch = TeethOn::Circle { teeth: spec.teeth, radius_mm: pitch_radius_mm };
        let place = ContourPlace { section: PROFILE, pitch };
        let tooth = DrawnTooth::read(&profile.file, place, profile.tolerance_mm)?;
        let [root_mm, tip_mm] = tooth.reach_mm;
        let of = ("tool.shaper_cutter", profile.file.as_path());
        let shift = spec.profile_shift_coefficient;
        tooth.refuse_other_addendum(of, tip_mm - pitch_radius_mm, shift, spec.addendum_coefficient, module_mm)?;
        let (edge, radii_mm) = (tooth.edge()?, [tip_mm, root_mm]);
        Ok((CutterTooth::Drawn(Arc::new(tooth)), edge, radii_mm))
    }

    /// The edge that all teeth share, without their roughness.
    pub fn edge(&self) -> &Edge {
        &self.edge
    }

    /// Whether another one generates the same gear: all but its errors, and the edges that cut.
    pub fn generates_as(&self, other: &Self) -> bool {
        let numbers = |of: &Self| (of.teeth, of.pitch_radius_mm, of.tip_radius_mm);
        numbers(self) == numbers(other) && self.tooth == other.tooth
    }

    /// Its tooth, where it has involute flanks.
    pub fn involute(&self) -> Option<&InvoluteTooth> {
        match &self.tooth {
            CutterTooth::Involute(tooth) => Some(tooth),
            CutterTooth::Drawn(_) => None,
        }
    }

    /// Its tooth, where it is drawn.
    pub fn drawn(&self) -> Option<&Arc<DrawnTooth>> {
        match &self.tooth {
            CutterTooth::Involute(_) => None,
            CutterTooth::Drawn(tooth) => Some(tooth),
        }
    }
}

impl CuttingTool for ShaperCutter {
    fn blade_count(&self) -> u32 {
        self.teeth
    }

    fn edges(&self) -> &BladeEdges {
        &self.edges
    }
}

impl PlanarTool for ShaperCutter {
    fn tool_from_blade(&self, index: u32) -> Rigid2 {
        Rigid2::new(self.tooth_angles_rad[index as usize], self.runout_mm)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::process::shaping::tool::involute_tooth::PROFILE_SHIFT;
    use gearcut_core::tool::edge::{RayHit, SegmentName, SegmentShape};
    use gearcut_core::tool::involute::Involute;

    fn process_gear() -> Gear {
        Gear {
            kind: gearcut_core::gear::GearKind::External,
            module_mm: 3.0,
            teeth: 42,
            pressure_angle_rad: 20_f64.to_radians(),
            helix_angle_rad: 0.0,
            hand: gearcut_core::terms::Hand::Right,
            face_width_mm: 30.0,
            addendum_coefficient: 1.0,
            profile_shift_coefficient: 0.0,
            bore_diameter_mm: 20.0,
            rim_mm: 0.0,
            tooth_thickness_allowance_mm: 0.0,
            center_distance_mm: None,
            dwell_radius_mm: None,
            pitch_curve: gearcut_core::gear::PitchCurveShape::Circle,
        }
    }

    fn sharp_spec() -> model::CutterSpec {
        model::CutterSpec {
            teeth: 20,
            addendum_coefficient: 1.25,
            dedendum_coefficient: 1.25,
            profile_shift_coefficient: 0.0,
            thinning_mm: 0.0,
            tip: model::Tip::Sharp,
            rake_angle_rad: 0.0,
            runout_mm: 0.0,
            runout_angle_rad: 0.0,
            pitch_errors_mm: Vec::new(),
            grinding: None,
            edge_roughness: None,
            edge_rounding: None,
            built_up_edge: None,
            profile: None,
        }
    }

    /// The paper's cutter: 20 teeth of module 3.
    pub(crate) fn paper_cutter(tip: model::Tip) -> ShaperCutter {
        let spec = model::CutterSpec { tip, ..sharp_spec() };
        ShaperCutter::new(&spec, &process_gear()).expect("an ordinary cutter")
    }

    /// Distance to an involute flank in closed form: r_b (sigma theta + u - atan u - psi_b), exact along the flank's
    /// normals.
    fn involute_distance_mm(flank: &Involute, p: DVec2) -> f64 {
        let u = flank.roll_at_radius(p.length());
        flank.base_radius_mm * (flank.side * p.to_angle() + u - u.atan() - flank.half_angle_rad)
    }

    #[test]
    fn flank_rays_hit_the_exact_involute() {
        let cutter = paper_cutter(model::Tip::Sharp);
        let tooth = cutter.involute().expect("involute flanks");
        let mut worst_mm = 0.0_f64;
        let mut count = 0;
        for segment in &cutter.edge().segments {
            let side = match segment.name {
                SegmentName::FlankLeft => 1.0,
                SegmentName::FlankRight => -1.0,
                _ => continue,
            };
            let flank = tooth.flank(side);
            let segment_from_blade = segment.blade_from_segment.inverse();
            for i in 0..=200 {
                let u0 = tooth.roll_range[0];
                let u = u0 + (tooth.roll_range[1] - u0) * f64::from(i) / 200.0;
                let aim = flank.point(u);
                // Rays from 0.7 mm outside, tilted by up to 0.3 rad against the normal.
                let tilt = DVec2::from_angle(0.3 * (f64::from(i) * 0.77).sin());
                let direction = -tilt.rotate(flank.normal(u));
                let origin = aim - 0.7 * direction;
                let hit = segment.enter(segment_from_blade.point(origin), segment_from_blade.direction(direction));
                let Some(RayHit { height_mm, y_mm, .. }) = hit else { continue };
                if y_mm < segment.y_range_mm[0] || y_mm > segment.y_range_mm[1] {
                    continue;
                }
                worst_mm = worst_mm.max(involute_distance_mm(&flank, origin + height_mm * direction).abs());
                count += 1;
            }
        }
        assert!(count > 350, "{count} rays met a flank");
        assert!(worst_mm < 6e-8, "{worst_mm:.2e} mm off the involute");
    }

    /// Addenda and shifts that leave the tip circle inside the base circle, or teeth without thickness: refused at the
    /// key that a user can change, not by an edge's table.
    #[test]
    fn cutters_without_an_involute_are_refused_at_their_key() {
        let gear = process_gear();
        for (teeth, addendum, shift, thinning_mm, key) in [
            (20, 1.25, -2.0, 0.0, PROFILE_SHIFT),
            (20, 1.25, -1.86, 0.0, PROFILE_SHIFT),
            (10, 0.1, -0.5, 0.0, PROFILE_SHIFT),
            (60, 1.0, -2.0, 0.5, PROFILE_SHIFT),
            (20, 1.25, 0.0, 5.0, "tool.shaper_cutter.thinning_mm"),
        ] {
            let spec = model::CutterSpec {
                teeth,
                addendum_coefficient: addendum,
                profile_shift_coefficient: shift,
                thinning_mm,
                ..sharp_spec()
            };
            let refusal = ShaperCutter::new(&spec, &gear).expect_err("nothing is left of the teeth");
            assert_eq!(refusal.key, key, "{refusal:?}");
        }
        let spec = model::CutterSpec { profile_shift_coefficient: -1.84, ..sharp_spec() };
        assert!(ShaperCutter::new(&spec, &gear).is_ok());
    }

    #[test]
    fn the_chain_is_closed_and_its_tables_are_small() {
        let tips = [
            model::Tip::Sharp,
            model::Tip::Round { radius_mm: 0.6 },
            model::Tip::Chamfer { height_mm: 0.5, angle_rad: 45_f64.to_radians() },
        ];
        for tip in tips {
            let cutter = paper_cutter(tip);
            let ends: Vec<[DVec2; 2]> = cutter
                .edge()
                .segments
                .iter()
                .map(|s| {
                    s.y_range_mm.map(|y| {
                        let x = match &s.shape {
                            SegmentShape::Table(table) => {
                                assert!(table.cells.len() <= 2048, "{:?}: {} cells", s.name, table.cells.len());
                                table.x_and_slope(y)[0]
                            }
                            SegmentShape::Arc { radius_mm } => (radius_mm * radius_mm - y * y).sqrt() - radius_mm,
                        };
                        s.blade_from_segment.point(DVec2::new(x, y))
                    })
                })
                .collect();
            for pair in ends.windows(2) {
                assert!(pair[0][1].distance(pair[1][0]) < 1e-9, "{tip:?}: gap at {:?}", pair[0][1]);
            }
            let mirror = |v: DVec2| DVec2::new(v.x, -v.y);
            assert!(ends[0][0].distance(mirror(ends[ends.len() - 1][1])) < 1e-12);
        }
    }
}
