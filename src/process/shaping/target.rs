//! Target flanks: the curves that dexels stand on.
//!
//! The target is the envelope of the finishing operation ([`Generation`]) as a curve in the transverse plane with arc
//! length, normal and polar angle. A flank runs from its **form point** (where the cutter's involute ends at its tip
//! corner, or, undercut, where the path of that corner crosses it: [`undercut`]) to its **tip** (the blank's outline,
//! the end of the cutter's involute near its base, or the point where both flanks meet). Roots are the [`fillet`]'s.
//! Flanks of drawn teeth are curves through points ([`drawn`]).

pub mod drawn;
pub mod fillet;
pub mod generation;
pub mod tip_relief;
pub mod tooth_target;
pub mod undercut;

use crate::drawn_tooth::envelope::SpaceProfile;
use crate::drawn_tooth::flank::DrawnFlank;
use crate::measure::crossing::Crossing;
use crate::process::shaping::target::fillet::boundary;
use crate::process::shaping::target::generation::{FlankContact, Generation};
use gearcut_core::error::Refusal;
use gearcut_core::gear::blank::Blank;
use gearcut_core::math::newton::{LastStep, newton_within};
use gearcut_core::math::roots::regula_falsi;
use gearcut_core::terms::Side;
use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

/// A length of profile is met if no more than this is missing, mm; Newton steps to it before its panel is halved.
const ARC_MM: f64 = 1e-13;
const ARC_STEPS: u32 = 8;
/// A height is met if no more than this is missing, mm.
const HEIGHT_MM: f64 = 1e-12;
/// Panels of the arc length of one flank; five Gauss points each leave the error far below a picometre.
const PANELS: usize = 48;
/// Nodes and weights of the five-point Gauss-Legendre rule on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// Why a flank ends where it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlankEnd {
    /// At the tip corner of the cutter: the ordinary start of the involute.
    CutterCorner,
    /// The cutter's tip corner has cut into it: undercut. At a tip: the envelope turns back.
    Undercut,
    /// At the blank's outline: the ordinary tip.
    BlankOutline,
    /// At the lower end of the cutter's involute: the rest of the tip is cut by the cutter's base.
    CutterBase,
    /// Where both flanks of the tooth meet: a pointed tooth.
    PointedTip,
}

/// What the path of the cutter's tip corner takes away of a generated flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Undercut {
    /// Place on the fillet, counted in pieces from the left flank of the space, at which it crosses the flank.
    pub fillet_at: f64,
    /// How far the fillet lies under the flank that is cut away, along its normal, at most, mm.
    pub depth_mm: f64,
}

/// Flank of one gear tooth as finishing leaves it in the limit of many strokes.
#[derive(Debug, Clone)]
pub struct TargetFlank {
    /// Gear tooth, counted from 1 at the first tooth of positive polar angle.
    pub tooth: u32,
    /// Which of its flanks.
    pub side: Side,
    /// Why it starts at its form point.
    pub form_end: FlankEnd,
    /// Why it ends at its tip.
    pub tip_end: FlankEnd,
    /// What the tip corner has cut away of it, if it has.
    pub undercut: Option<Undercut>,
    generation: Arc<Generation>,
    space: f64,
    /// Polar angle of the form point.
    phi_form: f64,
    /// Polar angle of the tip.
    phi_tip: f64,
    /// Arc lengths between them, once somebody has asked.
    arcs: OnceLock<FlankArcs>,
    /// The curve itself where a drawn tooth generates it.
    drawn: Option<Arc<DrawnFlank>>,
}

/// Arc lengths of a flank.
#[derive(Debug, Clone, PartialEq)]
struct FlankArcs {
    /// At the panel ends, from the form point.
    ends_mm: Vec<f64>,
    /// Speed of the contact (mm per rad of phi) in every panel.
    speeds: Vec<PanelSpeed>,
}

/// Speed in one panel as the quartic through its five Gauss points, in Legendre polynomials of x = -1 to 1: its
/// integral is the Gauss rule's at x = 1 and as accurate in between, so places on the flank are found from arcs without
/// going back to the meshing condition.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PanelSpeed([f64; 5]);

impl PanelSpeed {
    /// From the speed at x.
    fn new(speed: impl Fn(f64) -> f64) -> Self {
        let mut coefficients = [0.0; 5];
        for (node, weight) in GAUSS {
            let value = weight * speed(node);
            for (k, (c, p)) in coefficients.iter_mut().zip(legendre(node)).enumerate() {
                *c += (k as f64 + 0.5) * value * p;
            }
        }
        Self(coefficients)
    }

    /// Speed at x, and its integral from -1 to x.
    fn at(&self, x: f64) -> [f64; 2] {
        let p = legendre(x);
        let value = self.0.iter().zip(p).map(|(c, p)| c * p).sum();
        let higher = (1..5).map(|k| self.0[k] * (p[k + 1] - p[k - 1]) / (2 * k + 1) as f64);
        [value, self.0[0] * (x + 1.0) + higher.sum::<f64>()]
    }
}

/// Legendre polynomials of degree 0 to 5.
fn legendre(x: f64) -> [f64; 6] {
    let mut p = [1.0, x, 0.0, 0.0, 0.0, 0.0];
    for k in 1..5 {
        let n = k as f64;
        p[k + 1] = ((2.0 * n + 1.0) * x * p[k] - n * p[k - 1]) / (n + 1.0);
    }
    p
}

/// Tooth space that a flank belongs to: tooth j lies between spaces j - 1 and j.
fn space_of(tooth: u32, side: Side) -> i64 {
    i64::from(tooth) - i64::from(side == Side::Right)
}

impl TargetFlank {
    /// Flank of a tooth as the cutter's flank alone generates it: an undercut one from where the envelope turns back.
    /// Teeth stand `shift` pitches further along the curve. `tip_height_mm` may lower the tip (pointed teeth).
    ///
    /// # Errors
    /// No involute is generated below the tip.
    pub(super) fn as_generated(
        generation: &Arc<Generation>,
        blank: &Blank,
        tooth: u32,
        side: Side,
        shift: f64,
        tip_height_mm: Option<f64>,
    ) -> Result<Self, Refusal> {
        if let Some(profile) = generation.space_profile(space_of(tooth, side)) {
            return Self::as_drawn(generation, &*profile?, blank, (tooth, side), tip_height_mm);
        }
        let space = space_of(tooth, side) as f64 + shift;
        let contact = |phi: f64| generation.flank_contact(phi, space, side);
        let [roll_start, roll_end] = generation.cutter.involute().map_or([f64::NAN; 2], |own| own.roll_range);
        let curve = generation.linkage.curve();
        let module_mm = curve.perimeter_mm() / (PI * f64::from(curve_teeth(generation)));
        let pitch_arc_mm = PI * module_mm;
        let phi_space = curve.phi_at_arc(space * pitch_arc_mm);
        let nothing = |what: &str| no_flank(tooth, side, what);
        let top_mm = tip_height_mm.unwrap_or(blank.addendum_mm).min(blank.addendum_mm);
        let height = |c: &FlankContact| blank.height(c.point_mm, c.phi_rad).0;
        // A place on the generated flank to start from: the pitch crossing lies a quarter pitch beside the space's
        // middle, contact is near it. Where the middle of the roll lies beyond the blank, as with cutters of deep root,
        // the flank is what of it lies below the blank's outline.
        let step = pitch_arc_mm / curve.frame(phi_space).arc_rate_mm_per_rad / 64.0;
        let roll_pitch = 0.5 * (roll_start + roll_end);
        let start = (-128..=128)
            .filter_map(|i| contact(phi_space + step * f64::from(i)))
            .filter(|c| c.roll > roll_start && c.roll < roll_end && c.is_sound() && height(c) < top_mm)
            .min_by(|a, b| (a.roll - roll_pitch).abs().total_cmp(&(b.roll - roll_pitch).abs()))
            .ok_or_else(|| nothing("the cutter's involute touches nothing there"))?;
        let towards_form = start.roll_rate.signum();

        let (phi_form, form_end) = {
            let inside = |phi: f64| contact(phi).is_some_and(|c| c.roll < roll_end && c.is_sound());
            let phi =
                boundary(start.phi_rad, towards_form * step, inside).ok_or_else(|| nothing("it has no root end"))?;
            let undercut = contact(phi).is_none_or(|c| c.roll < roll_end - 1e-9);
            (phi, if undercut { FlankEnd::Undercut } else { FlankEnd::CutterCorner })
        };
        let (phi_tip, tip_end) = {
            let inside =
                |phi: f64| contact(phi).is_some_and(|c| c.roll > roll_start && c.is_sound() && height(&c) < top_mm);
            let phi = boundary(start.phi_rad, -towards_form * step, inside).ok_or_else(|| nothing("it has no tip"))?;
            let end = contact(phi);
            let end = match end {
                Some(c) if height(&c) >= top_mm - 1e-6 => {
                    if tip_height_mm.is_some() {
                        FlankEnd::PointedTip
                    } else {
                        FlankEnd::BlankOutline
                    }
                }
                Some(c) if c.roll <= roll_start + 1e-9 => FlankEnd::CutterBase,
                _ => FlankEnd::Undercut,
            };
            (phi, end)
        };
        Ok(Self {
            tooth,
            side,
            form_end,
            tip_end,
            undercut: None,
            generation: generation.clone(),
            space,
            phi_form,
            phi_tip,
            arcs: OnceLock::new(),
            drawn: None,
        })
    }

    /// Flank that a drawn tooth generates; `tip_height_mm` may lower its tip.
    fn as_drawn(
        generation: &Arc<Generation>,
        profile: &SpaceProfile,
        blank: &Blank,
        (tooth, side): (u32, Side),
        tip_height_mm: Option<f64>,
    ) -> Result<Self, Refusal> {
        let is_left = side.sign() * generation.gear().tip_sign() > 0.0;
        let top_mm = tip_height_mm.unwrap_or(blank.addendum_mm).min(blank.addendum_mm);
        let flank = DrawnFlank::through(profile.flank(is_left)).up_to(blank, top_mm);
        let flank = flank.ok_or_else(|| no_flank(tooth, side, "the contour does not shape it up to the tip"))?;
        let depth_mm = generation.cutter.drawn().and_then(|drawn| profile.undercut_mm(is_left, drawn));
        // From the left flank of the space to the right one a fillet has one piece.
        let fillet_at = if side == Side::Left { 0.0 } else { 1.0 };
        let [phi_form, phi_tip] = [0.0, flank.length_mm()].map(|arc_mm| flank.at_arc(arc_mm).phi_rad);
        Ok(Self {
            tooth,
            side,
            form_end: if depth_mm.is_some() { FlankEnd::Undercut } else { FlankEnd::CutterCorner },
            tip_end: if tip_height_mm.is_some() { FlankEnd::PointedTip } else { FlankEnd::BlankOutline },
            undercut: depth_mm.map(|depth_mm| Undercut { fillet_at, depth_mm }),
            generation: generation.clone(),
            space: space_of(tooth, side) as f64,
            phi_form,
            phi_tip,
            arcs: OnceLock::new(),
            drawn: Some(Arc::new(flank)),
        })
    }

    /// The same flank from another polar angle on: what lies below is cut away.
    pub(super) fn undercut_up_to(self, phi_form: f64, undercut: Undercut) -> Self {
        Self { phi_form, undercut: Some(undercut), arcs: OnceLock::new(), ..self }
    }

    fn arcs(&self) -> &FlankArcs {
        self.arcs.get_or_init(|| {
            let (mut ends_mm, mut speeds) = (vec![0.0], Vec::with_capacity(PANELS));
            for panel in 0..PANELS {
                let speed = PanelSpeed::new(|x| self.contact(self.phi_in_panel(panel, x)).speed_mm_per_rad.abs());
                ends_mm.push(ends_mm[panel] + self.half_panel_rad().abs() * speed.at(1.0)[1]);
                speeds.push(speed);
            }
            FlankArcs { ends_mm, speeds }
        })
    }

    /// What generates it.
    pub fn generation(&self) -> &Generation {
        &self.generation
    }

    /// Space that it belongs to, counted along the arc without wrapping; between whole numbers in a section of a
    /// helical gear.
    pub fn space(&self) -> f64 {
        self.space
    }

    /// Length from form point to tip, mm.
    pub fn length_mm(&self) -> f64 {
        if let Some(drawn) = &self.drawn {
            return drawn.length_mm();
        }
        self.arcs().ends_mm[PANELS]
    }

    /// Contact at the form point: what [`Self::at_arc`] gives at 0, without any arc.
    pub fn form_contact(&self) -> FlankContact {
        self.drawn.as_ref().map_or_else(|| self.contact(self.phi_form), |drawn| FlankContact::drawn(drawn.at_arc(0.0)))
    }

    /// Contact at a polar angle between form point and tip.
    fn contact(&self, phi_rad: f64) -> FlankContact {
        self.generation
            .flank_contact(phi_rad, self.space, self.side)
            .expect("contact exists between form point and tip")
    }

    fn half_panel_rad(&self) -> f64 {
        0.5 * (self.phi_tip - self.phi_form) / PANELS as f64
    }

    /// Polar angle at x = -1 to 1 in a panel.
    fn phi_in_panel(&self, panel: usize, x: f64) -> f64 {
        self.phi_form + self.half_panel_rad() * (2.0 * panel as f64 + 1.0 + x)
    }

    /// Contact at an arc length from the form point (clamped to the flank).
    pub fn at_arc(&self, arc_mm: f64) -> FlankContact {
        if let Some(drawn) = &self.drawn {
            return FlankContact::drawn(drawn.at_arc(arc_mm));
        }
        let FlankArcs { ends_mm, speeds } = self.arcs();
        let arc_mm = arc_mm.clamp(0.0, ends_mm[PANELS]);
        let panel = ends_mm.partition_point(|&a| a <= arc_mm).clamp(1, PANELS) - 1;
        let [start_mm, end_mm] = [ends_mm[panel], ends_mm[panel + 1]];
        let half = self.half_panel_rad().abs();
        let start = 2.0 * (arc_mm - start_mm) / (end_mm - start_mm) - 1.0;
        let x = newton_within(start, [start.min(-1.0), start.max(1.0)], LastStep::default(), ARC_STEPS, |x| {
            let [speed, integral] = speeds[panel].at(x);
            let missing_mm = arc_mm - start_mm - half * integral;
            [missing_mm, if missing_mm.abs() < ARC_MM { 0.0 } else { missing_mm / (half * speed) }]
        });
        self.contact(self.phi_in_panel(panel, x))
    }

    /// Rolls ([`crate::job::GearJob::rolls_mm`]) at arc lengths from the form point (clamped to the flank), all mm: how
    /// far contacts lie from the curves' common point along their normal, less that of the contact on the pitch curve,
    /// if the flank reaches it: a shifted gear rolls at another pressure angle.
    pub fn rolls_mm(&self, blank: &Blank, arcs_mm: &[f64]) -> Vec<f64> {
        let curve = self.generation.linkage.curve();
        let along_mm = |of: FlankContact| (of.point_mm - curve.frame(of.phi_rad).point_mm).dot(of.normal);
        let on_curve_mm = self.at_height(blank, 0.0).map_or(0.0, |(_, contact)| along_mm(contact));
        arcs_mm.iter().map(|&arc_mm| along_mm(self.at_arc(arc_mm)) - on_curve_mm).collect()
    }

    /// Contact where the flank crosses a height over the pitch curve, if it does: arc length from the form point and
    /// contact.
    pub fn at_height(&self, blank: &Blank, height_mm: f64) -> Option<(f64, FlankContact)> {
        let height_at = |arc: f64| {
            let c = self.at_arc(arc);
            blank.height(c.point_mm, c.phi_rad).0 - height_mm
        };
        // Heights climb steadily along a flank.
        let arc = regula_falsi(height_at, 0.0, self.length_mm(), HEIGHT_MM)?;
        Some((arc, self.at_arc(arc)))
    }

    /// Where the flank crosses the pitch curve; `None` where it does not reach it.
    pub fn pitch_crossing(&self, blank: &Blank) -> Option<Crossing> {
        let (_, contact) = self.at_height(blank, 0.0)?;
        let phi_rad = blank.height(contact.point_mm, contact.phi_rad).1;
        Some(Crossing { point_mm: contact.point_mm, phi_rad, arc_mm: blank.curve().arc_mm(phi_rad) })
    }
}

/// Why a tooth has no flank.
pub(super) fn no_flank(tooth: u32, side: Side, what: &str) -> Refusal {
    Refusal::new(
        "tool.shaper_cutter",
        format!("no flank is generated on tooth {tooth} {}: {what}", side.name()),
        "use a cutter with fewer teeth or a smaller addendum_coefficient, or a pitch curve with a larger smallest \
        radius",
    )
}

/// Teeth of the gear: the perimeter in pitches of the cutter.
fn curve_teeth(generation: &Generation) -> u32 {
    let pitch_mm = 2.0 * PI * generation.cutter.pitch_radius_mm / f64::from(generation.cutter.teeth);
    (generation.linkage.curve().perimeter_mm() / pitch_mm).round() as u32
}
