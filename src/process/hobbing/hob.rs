//! The hob: a worm cut into teeth by gashes; its rake faces hold the cutting edges.
//!
//! In: the scene's hob, normal module m_n and pressure angle alpha_n of the gear. Out: the edge of one tooth in the
//! rake face, and the place of every tooth, numbered along the thread.
//!
//! **Tool frame.** z along the hob's axis in the direction d0 of the rack's pitch line (the one in which the thread
//! does *not* run when the hob cuts), origin in the middle of the hob, x from the axis towards the gear when the hob's
//! angle is 0. The hob turns by +angle about +z if it is right-handed, by -angle if left-handed, so that its thread,
//! seen as a rack, runs to -z.
//!
//! **Sizes.** sin(lambda) = K m_n / (2 R_p); axial pitch p_x = pi m_n / cos(lambda); lead = K p_x; p = lead / 2 pi. On
//! the pitch cylinder a tooth is pi m_n / 2 thick in the normal section.
//!
//! **Edge.** In the axial section the flank of an involute worm (ZI) lies at the half thickness w(rho) = w_p - p
//! (inv(rho) - inv(R_p)), inv(rho) = u - atan u, u^2 = (rho / r_b)^2 - 1, with cos(lambda_b) = cos(lambda) cos(alpha_n)
//! and r_b = p / tan(lambda_b); the straight-sided one at w_p - (rho - R_p) tan(alpha_n) / cos(lambda) (Litvin and
//! Fuentes, Gear Geometry and Applied Theory, 2004, chapter 19). Axial gashes with zero rake hold just this section.
//! Gashes at right angles to the thread wind about the axis with the lead 2 pi R_p / tan(lambda), hand opposite to the
//! thread; in the coordinates (distance from the axis, place along it) of such a rake face all axial lengths are
//! cos^2(lambda) of those above.
//!
//! **Drawn teeth.** A contour of the basic rack in the normal section takes the place of its straight flanks, and its
//! edge in the rake face is found from that ([`drawn`]).
//!
//! **Blade frame.** Origin on the hob's axis, x radially through the tooth's middle, y along -z of the tool: the left
//! flank has y > 0 and cuts left flanks of the gear.
//!
//! **Numbers.** Teeth follow each other along the thread; tooth 1 is the first at the entering end (+z, where uncut
//! work arrives), tooth n + 1 stands lead / gashes further on. A hob with several starts counts each thread by itself:
//! A1, A2, ..., B1, ... The blade index runs through all of A, then B.
//!
//! **Regrinding** moves the rake faces back along the relief. With radial relief the whole edge sinks by one amount
//! while lead and axial lengths stay: the pitch cylinder on which the thread is right shrinks with it, and a ZI hob is
//! then no longer quite ZI. The head angle stays that of the new hob.

mod drawn;
mod edge;

use crate::drawn_tooth::{ContourPlace, DrawnTooth, TeethOn};
use crate::process::hobbing::scene::model::{GashForm, HobSize, Worm};
use crate::process::hobbing::scene::{PROFILE, model};
use drawn::DrawnThread;
use edge::{RakeFlank, tooth_edge};
use gearcut_core::error::Refusal;
use gearcut_core::frame::Rigid3;
use gearcut_core::tool::blade_edges::BladeEdges;
use gearcut_core::tool::edge::Edge;
use gearcut_core::tool::{CuttingTool, SpatialTool};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Largest lead angle taken: beyond it a hob is a worm gear's pinion, and tables and formulas of hobs do not hold.
const LARGEST_LEAD_ANGLE_RAD: f64 = 0.35;
/// A tooth is in the work only within this angle to either side of the direction towards it: at 60 degrees its tip
/// stands at half its radius, far behind the work.
const HALF_WINDOW_RAD: f64 = PI / 3.0;
/// Smallest root radius over that of the base cylinder. At the base cylinder the flank's slope in the axial section is
/// 0, and its curvature without bound: u / rho with u^2 = (rho / r_b)^2 - 1. At a twentieth above it u is 0.32, and the
/// edge's tables hold.
const LEAST_ROOT_OVER_BASE: f64 = 1.05;
/// Share of the root radius by which relief lowers a tooth at most: with relief angles of some 10 deg and gashes 30 deg
/// apart it is a tenth.
const DEEPEST_RELIEF: f64 = 0.25;
/// Smallest root radius of a drawn tooth as a share of the pitch radius.
const LEAST_DRAWN_ROOT: f64 = 0.25;
/// Normals of a drawn rack whose part towards the tip is smaller touch at no finite place: half a degree and a bit.
/// Near the pitch line, where cycloids run square to it, the gap that is left has a length of a fiftieth of the
/// contour's radius of curvature, and closes within 0.3 um at 5 mm.
pub(super) const LEAST_SLOPE: f64 = 0.01;
/// Chords by which the thickness of a drawn tooth is measured, mm.
const OUTLINE_CHORD_MM: f64 = 1e-3;
/// A hob ready to cut.
#[derive(Debug, Clone)]
pub struct Hob {
    /// Number of starts K.
    pub starts: u32,
    /// Number of gashes.
    pub gashes: u32,
    /// +1 for a right-hand thread, -1 for a left-hand one.
    pub hand: f64,
    /// Normal module m_n, mm.
    pub module_mm: f64,
    /// Lead angle lambda on the pitch cylinder of the new hob.
    pub lead_angle_rad: f64,
    /// Radius of the pitch cylinder: the distance of the hob's axis from the rack's pitch plane (smaller after
    /// regrinding), mm.
    pub pitch_radius_mm: f64,
    /// Radius of the tip, mm.
    pub tip_radius_mm: f64,
    /// Axial pitch p_x, mm.
    pub axial_pitch_mm: f64,
    /// Lead of one thread, mm per turn.
    pub lead_mm: f64,
    /// Length with full teeth, mm.
    pub length_mm: f64,
    /// Radius at which the flank ends and the tip's corner or the protuberance begins, mm.
    #[cfg_attr(not(feature = "testing"), expect(dead_code, reason = "tests read it"))]
    pub flank_end_radius_mm: f64,
    /// Teeth in blade order.
    pub teeth: Vec<HobTooth>,
    edges: BladeEdges,
    flank: HobFlank,
    rake_twist_rad_per_mm: f64,
}

/// What gives a tooth its thickness.
#[derive(Debug, Clone)]
enum HobFlank {
    /// The flank of a worm.
    Worm(RakeFlank),
    /// A contour.
    Drawn {
        tooth: Arc<DrawnTooth>,
        /// Left half of the edge by chords, from the tip on.
        left_mm: Vec<DVec2>,
    },
}

/// Place of one tooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HobTooth {
    /// Thread it stands on, from 0.
    pub start: u32,
    /// Number along the thread, from 1 at the entering end.
    pub number: u32,
    /// Count of gash passages, any integer: with axial gashes its rake face looks at the gear at the hob angle 2 pi
    /// `passage` / gashes.
    pub passage: i64,
    /// z of its place on the thread in the tool frame, mm.
    pub axial_mm: f64,
    /// How far its middle stands off that place along z, mm.
    pub off_mm: f64,
    /// Angle of its middle about z in the tool frame, from x.
    pub angle_rad: f64,
}

/// End of a hob.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HobEnd {
    /// +z of the tool, where uncut work arrives.
    Entering,
    /// -z of the tool.
    Leaving,
}

impl HobEnd {
    /// `entering` or `leaving`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Entering => "entering",
            Self::Leaving => "leaving",
        }
    }
}

impl HobTooth {
    /// `7`, or `B7` on a hob with several starts.
    pub fn label(&self, starts: u32) -> String {
        if starts == 1 {
            return self.number.to_string();
        }
        let letter = char::from(b'A' + (self.start % 26) as u8);
        format!("{letter}{}", self.number)
    }
}

impl Hob {
    /// Numbers of the teeth, in blade order.
    pub fn labels(&self) -> Vec<String> {
        self.teeth.iter().map(|tooth| tooth.label(self.starts)).collect()
    }

    /// The end at which a tooth is the last of its thread, with the tooth beside it on that thread; indices in blade
    /// order.
    pub fn end_at(&self, tooth: usize) -> Option<(HobEnd, usize)> {
        let start = self.teeth[tooth].start;
        let is_on_thread = |of: &usize| self.teeth.get(*of).is_some_and(|of| of.start == start);
        let before = tooth.checked_sub(1).filter(is_on_thread);
        let after = Some(tooth + 1).filter(is_on_thread);
        match [before, after] {
            [None, Some(after)] => Some((HobEnd::Entering, after)),
            [Some(before), None] => Some((HobEnd::Leaving, before)),
            _ => None,
        }
    }

    /// Hob of a scene for a gear with this normal module and pressure angle.
    ///
    /// # Errors
    /// An impossible lead, pointed teeth, a tip round or protuberance that does not fit, a hob too short for one tooth.
    pub fn new(spec: &model::HobSpec, module_mm: f64, pressure_angle_rad: f64) -> Result<Self, Refusal> {
        let (m, alpha) = (module_mm, pressure_angle_rad);
        let starts = f64::from(spec.starts);
        let (new_pitch_radius_mm, lead_angle_rad, size_key) = match spec.size {
            HobSize::LeadAngle(angle) => (starts * m / (2.0 * angle.sin()), angle, "tool.hob.lead_angle_deg"),
            // A thread as steep as the axis is as far as it goes.
            HobSize::ReferenceDiameter(d) => {
                (0.5 * d, (starts * m / d).min(1.0).asin(), "tool.hob.reference_diameter_mm")
            }
        };
        if lead_angle_rad <= 0.0 || lead_angle_rad > LARGEST_LEAD_ANGLE_RAD {
            return Err(Refusal::new(
                size_key,
                format!(
                    "{starts} starts of module {m} mm on a pitch cylinder of {:.3} mm diameter need the lead angle \
                    {:.2} deg; up to {:.0} deg is a hob",
                    2.0 * new_pitch_radius_mm,
                    lead_angle_rad.to_degrees(),
                    LARGEST_LEAD_ANGLE_RAD.to_degrees()
                ),
                "use fewer starts or a larger reference diameter (about 10 to 20 modules)",
            ));
        }
        let (tan_lead, cos_lead) = (lead_angle_rad.tan(), lead_angle_rad.cos());
        let axial_pitch_mm = PI * m / cos_lead;
        let lead_mm = starts * axial_pitch_mm;
        let parameter = lead_mm / TAU;
        let base_radius_mm = parameter / (cos_lead * alpha.cos()).acos().tan();
        let drawn = drawn_tooth(spec, m)?;
        let [dedendum_mm, addendum_mm] =
            drawn.as_ref().map_or([spec.dedendum_coefficient * m, spec.addendum_coefficient * m], |drawn| {
                [-drawn.reach_mm[0], drawn.reach_mm[1]]
            });
        let new_tip_radius_mm = new_pitch_radius_mm + addendum_mm;
        let root_radius_mm = new_pitch_radius_mm - dedendum_mm;
        if drawn.is_some() && root_radius_mm < LEAST_DRAWN_ROOT * new_pitch_radius_mm {
            return Err(Refusal::new(
                size_key,
                format!("the drawn tooth leaves a root radius of {root_radius_mm:.3} mm"),
                "use a larger reference diameter",
            ));
        }
        if drawn.is_none() && root_radius_mm <= LEAST_ROOT_OVER_BASE * base_radius_mm {
            return Err(Refusal::new(
                size_key,
                format!(
                    "the hob's root radius {root_radius_mm:.3} mm does not clear the base cylinder of its thread, \
                    {base_radius_mm:.3} mm"
                ),
                "use fewer starts, a larger reference diameter or a smaller dedendum_coefficient",
            ));
        }
        let most_mm = DEEPEST_RELIEF * root_radius_mm;
        if spec.regrind_mm > most_mm {
            return Err(Refusal::new(
                "tool.hob.regrind_mm",
                format!(
                    "no hob tooth falls by {} mm from its rake face to its back: at most {most_mm:.3} mm are taken, a \
                    quarter of the root radius",
                    spec.regrind_mm
                ),
                "use a smaller regrind_mm",
            ));
        }
        // Gashes across the thread wind against it; axial lengths in such a rake face shrink by cos^2(lambda).
        let (scale, rake_twist_rad_per_mm) = match spec.gash_form {
            GashForm::Axial => (1.0, 0.0),
            GashForm::Helical => (cos_lead * cos_lead, spec.hand.sign() * tan_lead / new_pitch_radius_mm),
        };
        let worm = RakeFlank {
            worm: spec.worm,
            reference_radius_mm: new_pitch_radius_mm,
            half_mm: 0.5 * (0.5 * PI * m - spec.thinning_mm) / cos_lead,
            scale,
            parameter_mm_per_rad: parameter,
            base_radius_mm,
            axial_tan: alpha.tan() / cos_lead,
            regrind_mm: spec.regrind_mm,
            relief: None,
        };
        let tip_radius_mm = new_tip_radius_mm - spec.regrind_mm;
        let (edge, flank, flank_end_radius_mm) = if let Some(tooth) = drawn {
            let thread = DrawnThread {
                generates: spec.worm == Worm::Involute,
                pitch_radius_mm: new_pitch_radius_mm,
                parameter_mm_per_rad: parameter,
                lead_angle_rad,
                scale,
                regrind_mm: spec.regrind_mm,
            };
            let edge = thread.edge(&tooth)?;
            let mut left_mm = edge.points_mm(OUTLINE_CHORD_MM);
            left_mm.retain(|at| at.y >= 0.0);
            (edge, HobFlank::Drawn { tooth: Arc::new(tooth), left_mm }, tip_radius_mm)
        } else {
            let ends_mm = [root_radius_mm, new_tip_radius_mm];
            let (segments, flank_end_radius_mm) =
                tooth_edge(spec, &worm, ends_mm, scale * axial_pitch_mm, m, cos_lead)?;
            (Edge::new(segments), HobFlank::Worm(worm), flank_end_radius_mm)
        };

        let step_mm = scale * lead_mm / f64::from(spec.gashes);
        let hand = spec.hand.sign();
        let mut teeth = Vec::new();
        for start in 0..spec.starts {
            let offset_mm = scale * axial_pitch_mm * f64::from(start);
            let first = ((offset_mm - 0.5 * spec.length_mm) / step_mm).ceil() as i64;
            let last = ((offset_mm + 0.5 * spec.length_mm) / step_mm).floor() as i64;
            teeth.extend((first..=last).zip(1..).map(|(passage, number)| {
                let axial_mm = offset_mm - step_mm * passage as f64;
                let angle_rad =
                    -hand * TAU * passage as f64 / f64::from(spec.gashes) - rake_twist_rad_per_mm * axial_mm;
                HobTooth { start, number, passage, axial_mm, off_mm: spec.pitch_error_mm(start, passage), angle_rad }
            }));
        }
        if teeth.is_empty() {
            return Err(Refusal::new(
                "tool.hob.length_mm",
                format!("no tooth fits on a hob {} mm long", spec.length_mm),
                format!("one axial pitch is {axial_pitch_mm:.3} mm; a usual hob is five or more pitches long"),
            ));
        }
        Ok(Self {
            starts: spec.starts,
            gashes: spec.gashes,
            hand,
            module_mm: m,
            lead_angle_rad,
            pitch_radius_mm: new_pitch_radius_mm - spec.regrind_mm,
            tip_radius_mm,
            axial_pitch_mm,
            lead_mm,
            length_mm: spec.length_mm,
            flank_end_radius_mm,
            teeth,
            edges: BladeEdges::shared(edge),
            flank,
            rake_twist_rad_per_mm,
        })
    }

    /// Half the thickness of a tooth in its rake face at a distance from the axis: y of the left flank, analytic, mm.
    /// That of a drawn tooth is the largest at that distance, by chords of its edge; 0 where it has none.
    pub fn half_thickness_mm(&self, radius_mm: f64) -> f64 {
        match &self.flank {
            HobFlank::Worm(flank) => flank.half_and_slope(radius_mm + flank.regrind_mm)[0],
            HobFlank::Drawn { left_mm, .. } => {
                let at = |pair: &[DVec2]| {
                    let share = (radius_mm - pair[0].x) / (pair[1].x - pair[0].x);
                    (0.0..=1.0).contains(&share).then(|| pair[0].y + share * (pair[1].y - pair[0].y))
                };
                left_mm.windows(2).filter_map(at).fold(0.0, f64::max)
            }
        }
    }

    /// First and second derivative of that half thickness over the distance from the axis, 1 and 1/mm; none of a drawn
    /// tooth.
    pub fn flank_slope_and_bend(&self, radius_mm: f64) -> Option<[f64; 2]> {
        let HobFlank::Worm(flank) = &self.flank else { return None };
        let new_mm = radius_mm + flank.regrind_mm;
        Some([flank.half_and_slope(new_mm)[1], flank.bend_per_mm(new_mm)])
    }

    /// The tooth, where it is drawn: the basic rack in the normal section.
    pub fn drawn(&self) -> Option<&Arc<DrawnTooth>> {
        match &self.flank {
            HobFlank::Worm(_) => None,
            HobFlank::Drawn { tooth, .. } => Some(tooth),
        }
    }

    /// Distance between teeth that follow each other along a thread, along the axis, mm.
    pub fn tooth_spacing_mm(&self) -> f64 {
        self.teeth
            .windows(2)
            .find(|w| w[0].start == w[1].start)
            .map_or(self.lead_mm / f64::from(self.gashes), |w| w[0].axial_mm - w[1].axial_mm)
    }
}

/// The tooth of a hob whose contour the scene names.
fn drawn_tooth(spec: &model::HobSpec, module_mm: f64) -> Result<Option<DrawnTooth>, Refusal> {
    let Some(profile) = &spec.profile else { return Ok(None) };
    let place = ContourPlace { section: PROFILE, pitch: TeethOn::Line { pitch_mm: PI * module_mm } };
    let tooth = DrawnTooth::read(&profile.file, place, profile.tolerance_mm)?;
    let of = ("tool.hob", profile.file.as_path());
    tooth.refuse_other_addendum(of, tooth.reach_mm[1], 0.0, spec.addendum_coefficient, module_mm)?;
    Ok(Some(tooth))
}

impl CuttingTool for Hob {
    fn blade_count(&self) -> u32 {
        self.teeth.len() as u32
    }

    fn edges(&self) -> &BladeEdges {
        &self.edges
    }
}

impl SpatialTool for Hob {
    fn tool_from_blade(&self, index: u32) -> Rigid3 {
        let tooth = self.teeth[index as usize];
        let (sin, cos) = tooth.angle_rad.sin_cos();
        let out = DVec3::new(cos, sin, 0.0);
        let along = DVec3::NEG_Z;
        Rigid3 {
            rotation: DMat3::from_cols(out, along, out.cross(along)),
            translation_mm: DVec3::new(0.0, 0.0, tooth.axial_mm + tooth.off_mm),
        }
    }

    fn rake_twist_rad_per_mm(&self) -> f64 {
        self.rake_twist_rad_per_mm
    }

    fn half_window_rad(&self) -> f64 {
        HALF_WINDOW_RAD
    }
}

#[cfg(test)]
mod tests;
