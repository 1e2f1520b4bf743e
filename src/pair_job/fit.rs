//! Whether two gears belong together, and which of their teeth meet.
//!
//! In: the scenes of both gears, and the centre distance where one is named. Out: [`Fit`]: the pitch curves in mesh,
//! how the driven gear is turned on its axis so that its pitch curve follows the driver's, and which of its flanks
//! meets which.
//!
//! Round gears roll at any distance of their axes: their pitch curves in the pair are the circles of that distance
//! ([`super::working`]). Pitch curves that are not round close at one distance, and another one is an error of
//! mounting. So it is for drawn teeth, which are no involutes: they are made for one distance.
//!
//! Law: equal transverse modules and pressure angles; helices of one angle, of opposite hands outside and of one hand
//! in a ring; r2 = a - s r1 all round, at the distance a at which a mate with this number of teeth closes. A scene has
//! a space centred on its polar angle 0, so a tooth of the driver meets a space of the driven gear, and it can be
//! turned on by whole teeth: the turn is taken that brings both pitch curves nearest. On a round gear all are alike.
//!
//! Seen against z an external mate turns the other way: with its arc counted as in its own scene, sigma = sigma_0 - S;
//! a ring's is sigma = sigma_0 + S. So the right flanks of the driver meet right flanks outside and left ones in a
//! ring.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::DVec2;

use super::working::RollingCircles;
use crate::measure::round_gear::is_round;
use crate::pair::pitch_pair::{Member, PairTeeth, PitchPair};
use crate::pair::rolling::turns_of_period;
use crate::scene::Scene;
use crate::scene::model::Gear;
use gearcut_core::error::Refusal;
use gearcut_core::gear::{GearKind, PitchCurve, PitchCurveShape};
use gearcut_core::terms::Side;

/// Driver and driven gear.
pub const MEMBERS: [Member; 2] = [Member::Driver, Member::Driven];
/// Both sides, the driving flanks first.
pub const SIDES: [Side; 2] = [Side::Right, Side::Left];

/// Modules and angles that differ by less than this share are equal: written as decimals, they are rounded.
const EQUAL_SHARE: f64 = 1e-6;
/// How far the pitch curves may stand apart, modules: with more, flanks jam or lose each other. A tenth of a module is
/// forty times what a rounded size in a scene makes.
const LARGEST_MISFIT_MODULES: f64 = 0.1;
/// Places in a turn of the driver at which the pitch curves are compared for each turn of the driven gear.
const COARSE_PLACES: usize = 64;
/// And for the turn that was taken.
const FINE_PLACES: usize = 720;
/// Steps in a pitch in which curves that do not roll on each other with teeth in spaces are turned on.
const PARTS_OF_PITCH: u32 = 4;
/// Turns whose misfits differ by less are equal, mm.
const SAME_MISFIT_MM: f64 = 1e-7;

/// No quantity along the normal of involutes.
pub const DRAWN_TEETH: &str = "drawn teeth have no pressure angle and no path of contact in closed form";

/// Two gears that belong together.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The pitch curves.
    pub pitch: PitchPair,
    /// Largest distance of the pitch curves from each other, mm, and the driver's angle there.
    pub misfit_mm: f64,
    /// The driver's angle there, rad.
    pub misfit_at_rad: f64,
    /// From the driven gear's scene to its own frame in the pair: turned by this, rad.
    pub turn_rad: f64,
    /// Heights of both gears' tips over the pitch curves of the pair, mm.
    pub addendum_mm: [f64; 2],
    /// How much thicker than half a pitch the teeth of both gears are there, mm.
    pub extra_thickness_mm: [f64; 2],
    /// Transverse module and pressure angle on the gears' own pitch curves, with numbers of teeth and kind.
    pub own: PairTeeth,
    /// A named centre distance less the one at which the pitch curves close, mm; 0 on round gears, whose pitch curves
    /// follow it.
    pub named_off_mm: f64,
    /// Whether both gears are round with involute teeth: their ratio is even at any distance.
    pub round_involutes: bool,
    /// The gears whose teeth are drawn: they have no pressure angle, and gaps count along the pitch curves.
    pub drawn: [bool; 2],
    /// Sum (external) or difference (ring) of the numbers of a space and the tooth that stands in it.
    phase: i64,
}

impl Fit {
    /// Puts the gears of two scenes together at the distance of their shifts, or at the one that their scenes name; the
    /// driven one is turned on by `phase_teeth`.
    ///
    /// # Errors
    /// Gears that do not belong together, with what differs and by how much.
    pub fn new(driver: &Scene, driven: &Scene, phase_teeth: i64) -> Result<Self, Refusal> {
        Self::at_distance(driver, driven, phase_teeth, None)
    }

    /// The same at a centre distance that is named, whatever the scenes say.
    ///
    /// # Errors
    /// As of [`Self::new`]; a distance at which teeth do not reach each other.
    pub fn at_distance(
        driver: &Scene,
        driven: &Scene,
        phase_teeth: i64,
        center_distance_mm: Option<f64>,
    ) -> Result<Self, Refusal> {
        let (a, b) = (&driver.gear, &driven.gear);
        kinds(a, b)?;
        let is_sector = |(_, gear): &(&str, &Gear)| matches!(gear.pitch_curve, PitchCurveShape::Sector { .. });
        if let Some((name, _)) = [("a", a), ("b", b)].into_iter().find(is_sector) {
            let problem = format!("gear {name} is a sector, and pairs are followed over whole turns");
            return Err(Refusal::new(
                "gear.sector_deg",
                problem,
                "roll the whole gears whose parts they are, where the law closes (docs/pair.md, what is not rolled)",
            ));
        }
        teeth_alike(a, b)?;
        let named_mm = match center_distance_mm {
            Some(named_mm) => Some(named_mm),
            None => named(a, b)?,
        };
        let curves = [a, b]
            .map(|gear| PitchCurve::new(&gear.pitch_curve, gear.transverse_module_mm(), gear.teeth).map(Arc::new));
        let [curve, own] = curves;
        let (curve, own) = (curve?, own?);
        let teeth = PairTeeth {
            module_mm: a.transverse_module_mm(),
            pressure_angle_rad: a.transverse_pressure_angle_rad(),
            base_helix_cosine: a.base_helix_cosine(),
            count: [a.teeth, b.teeth],
            driven: b.kind,
        };
        let drawn = [driver, driven].map(|scene| scene.process.other_teeth_key().is_some());
        let is_drawn = drawn.contains(&true);
        let in_mesh =
            if is_drawn { PairTeeth { pressure_angle_rad: 0.0, base_helix_cosine: 1.0, ..teeth } } else { teeth };
        let closing = PitchPair::closing(curve.clone(), in_mesh)?;
        let round = is_round(&curve) && is_round(&own);
        let mut fit = Self {
            named_off_mm: named_mm.map_or(0.0, |named_mm| named_mm - closing.center_distance_mm()),
            pitch: closing,
            misfit_mm: 0.0,
            misfit_at_rad: 0.0,
            turn_rad: 0.0,
            addendum_mm: [a, b].map(Gear::addendum_mm),
            extra_thickness_mm: [a, b].map(Gear::extra_thickness_mm),
            own: teeth,
            round_involutes: round && !is_drawn,
            drawn,
            phase: 0,
        };
        if fit.round_involutes
            && let Some(circles) = RollingCircles::of(&teeth, [a, b], named_mm)?
        {
            fit.pitch = circles.pair()?;
            fit.addendum_mm = circles.addendum_mm([a, b]);
            fit.extra_thickness_mm = circles.extra_thickness_mm([a, b]);
            fit.named_off_mm = 0.0;
        }
        fit.turn_to(if b.kind == GearKind::External { 1 } else { -1 });
        let turned_on = phase_teeth.rem_euclid(i64::from(b.teeth));
        if round {
            fit.turn_to(fit.phase + turned_on);
            return Ok(fit);
        }
        let first = fit.phase;
        let once = f64::from(b.teeth) / f64::from(a.teeth);
        let mut best = (f64::INFINITY, first);
        for phase in (0..i64::from(b.teeth)).map(|turned| first + turned) {
            fit.turn_to(phase);
            let misfit_mm = fit.misfit(&own, once, COARSE_PLACES).0;
            if misfit_mm < best.0 - SAME_MISFIT_MM {
                best = (misfit_mm, phase);
            }
        }
        fit.turn_to(best.1 + turned_on);
        let turns = f64::from(turns_of_period(teeth.count));
        (fit.misfit_mm, fit.misfit_at_rad) = fit.misfit(&own, turns, FINE_PLACES);
        let most_mm = LARGEST_MISFIT_MODULES * teeth.module_mm;
        if fit.misfit_mm > most_mm {
            return Err(match fit.off_pitches(b, &own, most_mm) {
                Some(pitches) if phase_teeth == 0 => fit.refused_off_pitch(pitches, most_mm),
                _ => fit.refused(b, &own, most_mm, phase_teeth),
            });
        }
        Ok(fit)
    }

    /// How many times longer the pair's pitch curves are than the gears' own: 1 but on shifted round gears.
    pub fn stretch(&self) -> f64 {
        self.pitch.teeth().module_mm / self.own.module_mm
    }

    /// Why there is none of what the law of involutes gives, where a gear's teeth are drawn.
    pub fn no_involutes(&self) -> Option<&'static str> {
        self.drawn.contains(&true).then_some(DRAWN_TEETH)
    }

    fn turn_to(&mut self, phase: i64) {
        self.turn_by(phase as f64);
        self.phase = phase;
    }

    /// Turns the driven gear on by so many of its pitches; a tooth meets a space where they are whole.
    fn turn_by(&mut self, pitches: f64) {
        let half = if self.pitch.sign() > 0.0 { pitches - 0.5 } else { -(pitches + 0.5) };
        let curve = self.pitch.curve();
        let start_rad = self.pitch.at(curve.phi_at_arc(half * self.pitch.pitch_mm())).phi_2_rad;
        self.turn_rad = if self.pitch.sign() > 0.0 { PI - start_rad } else { start_rad };
    }

    /// Polar angle of the driven gear's scene at the pitch point.
    fn own_angle(&self, phi_2_rad: f64) -> f64 {
        let in_pair = if self.pitch.sign() > 0.0 { PI - phi_2_rad } else { phi_2_rad };
        in_pair - self.turn_rad
    }

    /// Largest distance of the driven gear's own pitch curve from the mate's over some turns of the driver, mm, and the
    /// driver's angle there.
    fn misfit(&self, own: &PitchCurve, turns: f64, places_per_turn: usize) -> (f64, f64) {
        let places = (turns * places_per_turn as f64).ceil() as usize;
        let at = |i: usize| {
            let point = self.pitch.at(TAU * turns * i as f64 / places as f64);
            let apart_mm = own.radius(self.own_angle(point.phi_2_rad)).value() - point.radius_mm[1];
            (apart_mm.abs(), point.phi_1_rad)
        };
        (0..places).map(at).fold((0.0, 0.0), |most, here| if here.0 > most.0 { here } else { most })
    }

    /// The part of a pitch by which the driven gear would have to be turned on for the pitch curves to roll on each
    /// other; none where they do not at any.
    fn off_pitches(&self, b: &Gear, own: &PitchCurve, most_mm: f64) -> Option<f64> {
        let mut turned = self.clone();
        let turns = f64::from(b.teeth) / f64::from(self.pitch.teeth().count[0]);
        let mut misfit_mm = |step: u32| {
            turned.turn_by(f64::from(step) / f64::from(PARTS_OF_PITCH));
            turned.misfit(own, turns, COARSE_PLACES).0
        };
        let found = (0..b.teeth * PARTS_OF_PITCH).map(|step| (misfit_mm(step), step % PARTS_OF_PITCH));
        let (least_mm, step) = found.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (least_mm <= most_mm && step > 0).then(|| f64::from(step) / f64::from(PARTS_OF_PITCH))
    }

    fn refused_off_pitch(&self, pitches: f64, most_mm: f64) -> Refusal {
        let problem = format!(
            "the pitch curves close together, but their teeth do not: turned on by {pitches} pitches gear B's curve \
             rolls on that of gear A, and its teeth would be that far from the spaces; with teeth in spaces the curves \
             are up to {:.3} mm away from each other, and {most_mm:.3} mm are allowed",
            self.misfit_mm,
        );
        let way_out = "let `gearcut mate` write the scene of gear B, or give --mate TEETH in its place";
        Refusal::new("gear.pitch_curve", problem, way_out)
    }

    fn refused(&self, b: &Gear, own: &PitchCurve, most_mm: f64, phase_teeth: i64) -> Refusal {
        let facts = self.pitch.curve().facts();
        let s = self.pitch.sign();
        let a_mm = self.pitch.center_distance_mm();
        let ends = [a_mm - s * facts.smallest_radius_mm, a_mm - s * facts.largest_radius_mm];
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let turned = if phase_teeth == 0 { String::new() } else { format!(", turned on by {phase_teeth} teeth") };
        let problem = format!(
            "the pitch curves do not close together: the {} mate of {} teeth has radii from {low:.3} to {high:.3} mm \
             at a centre distance of {a_mm:.3} mm; gear B{turned} has {:.3} to {:.3} mm, up to {:.3} mm away (at \
             {:.1} deg of gear A), and {most_mm:.3} mm are allowed",
            b.kind.name(),
            b.teeth,
            own.facts().smallest_radius_mm,
            own.facts().largest_radius_mm,
            self.misfit_mm,
            self.misfit_at_rad.to_degrees().rem_euclid(360.0),
        );
        let way_out = if phase_teeth == 0 {
            "let `gearcut mate` write the scene of gear B, or give --mate TEETH in its place"
        } else {
            "leave --phase-teeth out, or give a whole number of the pitch curve's repeats"
        };
        Refusal::new("gear.pitch_curve", problem, way_out)
    }

    /// Flank of the driven gear that a flank of the driver meets, by the driver's tooth: its side, and its tooth from
    /// 1.
    pub fn mate_flank(&self, side: Side, tooth: i64) -> (Side, i64) {
        let (side, own) = match (self.pitch.sign() > 0.0, side) {
            (true, Side::Right) => (Side::Right, self.phase - tooth + 1),
            (true, Side::Left) => (Side::Left, self.phase - tooth),
            (false, Side::Right) => (Side::Left, tooth + self.phase),
            (false, Side::Left) => (Side::Right, tooth + self.phase + 1),
        };
        let count = i64::from(self.pitch.teeth().count[1]);
        (side, (own - 1).rem_euclid(count) + 1)
    }

    /// Under which side and label the pair knows a flank of the driven gear: [`Self::mate_flank`] the other way round.
    pub fn label_of(&self, side: Side, tooth: i64) -> (Side, i64) {
        match (self.pitch.sign() > 0.0, side) {
            (true, Side::Right) => (Side::Right, self.phase - tooth + 1),
            (true, Side::Left) => (Side::Left, self.phase - tooth),
            (false, Side::Left) => (Side::Right, tooth - self.phase),
            (false, Side::Right) => (Side::Left, tooth - self.phase - 1),
        }
    }

    /// A vector of the driven gear's scene in its own frame in the pair.
    pub fn in_pair(&self, own: DVec2) -> DVec2 {
        DVec2::from_angle(self.turn_rad).rotate(own)
    }
}

/// The centre distance that scenes name; both the same, or one of them.
fn named(a: &Gear, b: &Gear) -> Result<Option<f64>, Refusal> {
    let both = [a.center_distance_mm, b.center_distance_mm];
    if let [Some(of_a), Some(of_b)] = both
        && (of_a - of_b).abs() > EQUAL_SHARE * of_a
    {
        let problem = format!("gear A is to run at a centre distance of {of_a} mm and gear B at {of_b} mm");
        return Err(Refusal::new(
            "gear.center_distance_mm",
            problem,
            "name one distance, or give --center-distance-mm",
        ));
    }
    Ok(both.into_iter().flatten().next())
}

fn kinds(a: &Gear, b: &Gear) -> Result<(), Refusal> {
    match (a.kind, b.kind) {
        (GearKind::External, _) => Ok(()),
        (GearKind::Internal, GearKind::External) => Err(Refusal::new(
            "gear.kind",
            format!(
                "gear A is a ring of {} internal teeth and gear B external with {}: the driver of a pair is the \
                external one",
                a.teeth, b.teeth
            ),
            "give the external gear first",
        )),
        (GearKind::Internal, GearKind::Internal) => Err(Refusal::new(
            "gear.kind",
            format!("both gears are rings with internal teeth ({} and {}): they cannot mesh", a.teeth, b.teeth),
            "give an external gear as gear A",
        )),
    }
}

pub(super) fn teeth_alike(a: &Gear, b: &Gear) -> Result<(), Refusal> {
    let differ = |x: f64, y: f64| (x - y).abs() > EQUAL_SHARE * x.abs().max(y.abs());
    let [module, angle] =
        [[a.module_mm, b.module_mm], [a.pressure_angle_rad.to_degrees(), b.pressure_angle_rad.to_degrees()]];
    if differ(module[0], module[1]) {
        return Err(Refusal::new(
            "gear.module_mm",
            format!(
                "gear A has a module of {} mm and gear B of {} mm: their pitches {:.4} and {:.4} mm differ by {:.4} mm",
                module[0],
                module[1],
                PI * module[0],
                PI * module[1],
                PI * (module[1] - module[0]).abs()
            ),
            "give gears of one module",
        ));
    }
    if differ(angle[0], angle[1]) {
        return Err(Refusal::new(
            "gear.pressure_angle_deg",
            format!("gear A has a pressure angle of {:.4} deg and gear B of {:.4} deg", angle[0], angle[1]),
            "give gears of one pressure angle",
        ));
    }
    let helix = [a.helix_angle_rad.to_degrees(), b.helix_angle_rad.to_degrees()];
    if differ(helix[0], helix[1]) {
        return Err(Refusal::new(
            "gear.helix_angle_deg",
            format!(
                "gear A has a helix angle of {:.4} deg and gear B of {:.4} deg: their axes would cross",
                helix[0], helix[1]
            ),
            "give gears of one helix angle; axes are parallel here",
        ));
    }
    let same_hand = a.hand == b.hand;
    if helix[0] != 0.0 && same_hand == (b.kind == GearKind::External) {
        let problem = if same_hand {
            "both gears have helices of one hand, and an external pair on parallel axes needs opposite ones"
        } else {
            "the helices have opposite hands, and a ring needs the hand of its pinion"
        };
        return Err(Refusal::new("gear.hand", problem, "change the hand of one gear; `gearcut mate` does"));
    }
    Ok(())
}
