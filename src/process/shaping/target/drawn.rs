//! What a drawn tooth leaves when the linkage runs on continuously.
//!
//! In: a generation whose cutter has a [`DrawnTooth`], the blank, a space. Out: [`SpaceProfile`], points with normals
//! from the tip of one tooth through the space to the tip of the next ([`super::envelope`]), and [`DrawnFlank`], the
//! part of one flank.
//!
//! **Contact.** A place p of the edge with the normal n touches its envelope where n has no part of the velocity
//! O' + chi' i (p - O) of the cutter. Its normal then meets the pitch curve where the pitch circle of the cutter rolls
//! on it: the crossing of that normal with the pitch circle gives the parameter nearly, and Newton's method the
//! parameter for any linkage and offset. Of two crossings the one counts that follows from the tip along the edge:
//! behind the edge outside the pitch circle, before it inside. Arcs, lines and corners go this way alike, and an arc
//! about the pitch point, which touches all at once, is no exception: the edge is followed, not the parameter.
//!
//! **What is left.** Where the envelope crosses itself the loop between is cut away: by the path of a corner (undercut,
//! protuberance) or behind a cusp. What does not touch anywhere leaves a gap, which its neighbours close.
//!
//! Places are some [`SPACING_MODULES`] apart; between them a flank is the cubic through points and tangents, which is
//! off by less than a nanometre, and a crossing is that of chords, off by their arrow heights.
//!
//! Road not taken: the flank as a function of the linkage's parameter, as for involutes. It may rest on arcs
//! (rollers of a sprocket) and run backwards on others.

use crate::process::shaping::target::envelope::{EnvelopePoint, SAME_MM, SpaceProfile};
use crate::process::shaping::target::generation::{FlankContact, Generation};
use crate::process::shaping::tool::drawn::contour::{FILE, meet};
use crate::process::shaping::tool::drawn::scattered::turn_rad;
use crate::process::shaping::tool::drawn::{DrawnPart, DrawnTooth, EdgePlace};
use gearcut_core::error::Refusal;
use gearcut_core::gear::blank::Blank;
use gearcut_core::math::newton::{LastStep, newton};
use gearcut_core::math::roots::bisect;
use gearcut_core::tool::edge::SegmentName;
use glam::DVec2;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Distance of neighbouring points at most, in modules: arrow heights are a fortieth of a micrometre at module 3 and a
/// radius of 2 mm.
const SPACING_MODULES: f64 = 1.0 / 150.0;
/// Places of every part that are looked at, and how often the way between two is halved.
const FIRST_PLACES: u32 = 4;
const MOST_HALVINGS: u32 = 12;
/// Newton steps to a contact, and the last of them, rad.
const CONTACT_STEPS: u32 = 30;
const LAST_STEP_RAD: f64 = 1e-13;
const SETTLED_RAD: f64 = 1e-7;
/// A flank that turns by more than this at a point runs back, rad: envelopes turn by half a turn in a cusp.
const BACK_RAD: f64 = 2.8;

impl Generation {
    /// The envelope of a space (any integer, counted along the arc) by a drawn tooth; `None` for involute teeth.
    ///
    /// # Errors
    /// A tooth that ends within the blank, or that has no flank.
    pub fn space_profile(&self, space: i64) -> Option<Result<Arc<SpaceProfile>, Refusal>> {
        let (tooth, spaces) = (self.cutter.drawn()?, self.drawn.as_ref()?);
        Some(spaces.known_or(space, || SpaceProfile::new(self, tooth, &spaces.blank, space)))
    }

    /// Where a place of the edge touches its envelope in a space.
    fn touch(&self, EdgePlace { point_mm: p, normal: n }: EdgePlace, space: i64, part: usize) -> Option<EnvelopePoint> {
        let r_c = self.cutter.pitch_radius_mm;
        let along = p.dot(n);
        let inside = r_c * r_c - p.length_squared();
        // Normals of a cycloid touch the pitch circle where it begins, but for rounding.
        let root = Some(along * along + inside).filter(|&square| square > -SAME_MM)?.max(0.0).sqrt();
        let way_mm = if inside > 0.0 || along > 0.0 { root - along } else { -along - root };
        let crossing_rad = (p + way_mm * n).to_angle();
        let curve = self.linkage.curve();
        let pitch_mm = TAU * r_c / f64::from(self.cutter.teeth);
        let start = curve.phi_at_arc(space as f64 * pitch_mm - self.gear().tip_sign() * r_c * crossing_rad);
        let in_work = |phi: f64| {
            let m = self.motion(phi);
            let turn = DVec2::from_angle(self.tooth_angle(m.angle, space));
            (turn.rotate(p), turn.rotate(n), m)
        };
        let last = LastStep::absolute(LAST_STEP_RAD);
        let found = newton("the contact of a drawn edge", start, last, CONTACT_STEPS, |phi| {
            let (p, n, m) = in_work(phi);
            let velocity = m.center_rate + m.angle_rate * p.perp();
            let bend = m.center_rate_2 + m.angle_rate_2 * p.perp() - m.angle_rate * m.angle_rate * p;
            let rate = m.angle_rate * n.perp().dot(velocity) + n.dot(bend);
            [-n.dot(velocity), -n.dot(velocity) / rate]
        });
        // Where it only just touches, steps end at the square root of rounding.
        let phi_rad = found.or_else(|error| error.settled(SETTLED_RAD)).ok()?;
        let near_rad = pitch_mm / curve.frame(start).arc_rate_mm_per_rad;
        let (p, n, m) = in_work(phi_rad);
        ((phi_rad - start).abs() < near_rad).then(|| EnvelopePoint {
            phi_rad,
            point_mm: m.center + p,
            normal: -n,
            part,
        })
    }
}

impl SpaceProfile {
    fn new(generation: &Generation, tooth: &DrawnTooth, blank: &Blank, space: i64) -> Result<Self, Refusal> {
        let module_mm = 2.0 * generation.cutter.pitch_radius_mm / f64::from(generation.cutter.teeth);
        let all = envelope(generation, tooth, space, SPACING_MODULES * module_mm);
        let points = within(&all, blank)?;
        let (points, loops) = without_loops(points);
        let named = |name: SegmentName| move |part: &DrawnPart| part.name == name;
        let parts = &tooth.parts;
        let flanks = parts
            .iter()
            .rposition(named(SegmentName::FlankRight))
            .zip(parts.iter().position(named(SegmentName::FlankLeft)));
        let ends = flanks.and_then(|(right, left)| {
            let last = points.iter().rposition(|point| point.part <= right)?;
            let first = points.iter().position(|point| point.part >= left)?;
            (last > 0 && first + 1 < points.len()).then_some([last, first])
        });
        let flanks = ends.ok_or_else(|| {
            let problem = format!("it generates no flank in space {space}");
            Refusal::new(FILE, problem, "draw flanks steeper than 45 deg, or look at the module and the teeth")
        })?;
        if let Some(at_mm) = runs_back(&points[..=flanks[0]]).or_else(|| runs_back(&points[flanks[1]..])) {
            let problem = format!(
                "the flank that it generates in space {space} runs back on itself {:.3} mm off the axis of the gear: \
                 the edge is too hollow or too rough where it cuts there",
                at_mm.length()
            );
            return Err(Refusal::new(FILE, problem, "smooth what was measured, or allow more tolerance"));
        }
        Ok(Self { points, loops, flanks })
    }
}

/// Touches of all parts in the order of the edge.
fn envelope(generation: &Generation, tooth: &DrawnTooth, space: i64, spacing_mm: f64) -> Vec<EnvelopePoint> {
    let mut points: Vec<EnvelopePoint> = Vec::new();
    for (part, drawn) in tooth.parts.iter().enumerate() {
        let touch = |share: f64| generation.touch(drawn.law.at(share), space, part);
        let places: Vec<(f64, Option<EnvelopePoint>)> = (0..=FIRST_PLACES)
            .map(|i| f64::from(i) / f64::from(FIRST_PLACES))
            .map(|share| (share, touch(share)))
            .collect();
        points.extend(places[0].1);
        for pair in places.windows(2) {
            between(&touch, [pair[0], pair[1]], spacing_mm, MOST_HALVINGS, &mut points);
        }
    }
    points.dedup_by(|later, kept| later.is_same(kept));
    points
}

/// Touches between two places, the last one with them.
fn between(
    touch: &impl Fn(f64) -> Option<EnvelopePoint>,
    [from, to]: [(f64, Option<EnvelopePoint>); 2],
    spacing_mm: f64,
    halvings: u32,
    points: &mut Vec<EnvelopePoint>,
) {
    let is_near = match (from.1, to.1) {
        (Some(a), Some(b)) => a.point_mm.distance(b.point_mm) <= spacing_mm,
        (None, None) => true,
        _ => false,
    };
    if is_near || halvings == 0 {
        points.extend(to.1);
        return;
    }
    let share = 0.5 * (from.0 + to.0);
    let middle = (share, touch(share));
    between(touch, [from, middle], spacing_mm, halvings - 1, points);
    between(touch, [middle, to], spacing_mm, halvings - 1, points);
}

/// The points inside the blank and one beyond at either end.
fn within<'a>(all: &'a [EnvelopePoint], blank: &Blank) -> Result<&'a [EnvelopePoint], Refusal> {
    let is_inside = |at: &EnvelopePoint| blank.height(at.point_mm, at.phi_rad).0 < blank.addendum_mm;
    let ends = all.iter().position(is_inside).zip(all.iter().rposition(is_inside));
    let Some((first, last)) = ends else {
        let problem = "the drawn tooth reaches nothing of the blank".to_owned();
        return Err(Refusal::new(FILE, problem, "look at the unit of the file, the module and the teeth"));
    };
    if first == 0 || last + 1 == all.len() {
        let end = if first == 0 { &all[0] } else { &all[last] };
        let below_mm = blank.addendum_mm - blank.height(end.point_mm, end.phi_rad).0;
        return Err(Refusal::new(
            FILE,
            format!("the contour ends {below_mm:.4} mm below the tips of the gear, which it does not shape"),
            "lead it further towards the cutter's axis, or take a smaller gear.addendum_coefficient",
        ));
    }
    Ok(&all[first - 1..=last + 1])
}

/// The first point at which a chain runs back.
fn runs_back(points: &[EnvelopePoint]) -> Option<DVec2> {
    let chords =
        |three: &[EnvelopePoint]| [three[1].point_mm - three[0].point_mm, three[2].point_mm - three[1].point_mm];
    let is_back = |three: &&[EnvelopePoint]| {
        let [a, b] = chords(three);
        a.length().min(b.length()) > SAME_MM && turn_rad(a, b).abs() > BACK_RAD
    };
    points.windows(3).find(is_back).map(|three| three[1].point_mm)
}

/// A chain without the loops behind its crossings, each of which is two points, one with either normal; and the loops.
fn without_loops(points: &[EnvelopePoint]) -> (Vec<EnvelopePoint>, Vec<Vec<EnvelopePoint>>) {
    let (mut kept, mut loops) = (Vec::with_capacity(points.len()), Vec::new());
    let chord = |i: usize| [points[i].point_mm, points[i + 1].point_mm];
    let mut i = 0;
    while i + 1 < points.len() {
        kept.push(points[i]);
        let crossed = (i + 2..points.len() - 1).rev().find_map(|j| {
            let share = meet(&chord(i), &chord(j))?;
            // Neighbours that touch in a cusp are no crossing of their own.
            Some((j, share, meet(&chord(j), &chord(i))?))
        });
        let Some((j, share, other)) = crossed else {
            i += 1;
            continue;
        };
        let at = |k: usize, share: f64| EnvelopePoint {
            phi_rad: points[k].phi_rad + share * (points[k + 1].phi_rad - points[k].phi_rad),
            point_mm: points[k].point_mm.lerp(points[k + 1].point_mm, share),
            normal: points[k].normal.lerp(points[k + 1].normal, share).normalize_or(points[k].normal),
            part: points[k].part,
        };
        let (end, start) = (at(i, share), EnvelopePoint { point_mm: at(i, share).point_mm, ..at(j, other) });
        kept.extend([end, start]);
        loops.push([start].iter().chain(&points[i + 1..=j]).copied().collect());
        i = j + 1;
    }
    kept.extend(points.last());
    (kept, loops)
}

/// A flank of a drawn tooth's envelope as a curve over its arc.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnFlank {
    points: Vec<EnvelopePoint>,
    arcs_mm: Vec<f64>,
}

impl DrawnFlank {
    /// Through points of an envelope.
    pub fn through(mut points: Vec<EnvelopePoint>) -> Self {
        points.dedup_by(|later, kept| later.is_same(kept));
        let mut arc_mm = 0.0;
        let mut arcs_mm = vec![0.0; points.len().min(1)];
        for pair in points.windows(2) {
            arc_mm += pair[0].point_mm.distance(pair[1].point_mm);
            arcs_mm.push(arc_mm);
        }
        Self { points, arcs_mm }
    }

    /// Its length, mm.
    pub fn length_mm(&self) -> f64 {
        self.arcs_mm.last().copied().unwrap_or(0.0)
    }

    /// Contact at an arc from its beginning (clamped to the flank): the cubic through two points with their tangents.
    pub fn at_arc(&self, arc_mm: f64) -> FlankContact {
        let last = self.points.len() - 1;
        let arc_mm = arc_mm.clamp(0.0, self.length_mm());
        let index = self.arcs_mm.partition_point(|&arc| arc <= arc_mm).clamp(1, last.max(1)) - 1;
        let (a, b) = (&self.points[index], &self.points[(index + 1).min(last)]);
        let chord = b.point_mm - a.point_mm;
        let length_mm = chord.length().max(SAME_MM);
        let t = (arc_mm - self.arcs_mm[index]) / length_mm;
        let side = if a.normal.perp().dot(chord) < 0.0 { -1.0 } else { 1.0 };
        let [p, q] = [a, b].map(|at| side * length_mm * at.normal.perp());
        let (square, cube) = (3.0 * chord - 2.0 * p - q, p + q - 2.0 * chord);
        let along = p + t * (2.0 * square + t * 3.0 * cube);
        FlankContact {
            phi_rad: a.phi_rad + t * (b.phi_rad - a.phi_rad),
            point_mm: a.point_mm + t * (p + t * (square + t * cube)),
            normal: -side * along.perp().normalize_or(side * -a.normal),
            roll: f64::NAN,
            roll_rate: f64::NAN,
            speed_mm_per_rad: f64::NAN,
        }
    }

    /// The same up to a height over the pitch curve; `None` where it ends below, or begins above.
    pub fn up_to(self, blank: &Blank, top_mm: f64) -> Option<Self> {
        let height_mm = |at: &FlankContact| blank.height(at.point_mm, at.phi_rad).0;
        let is_above = |at: &EnvelopePoint| blank.height(at.point_mm, at.phi_rad).0 >= top_mm;
        let above = self.points.iter().position(is_above).filter(|&index| index > 0)?;
        let arc_mm =
            bisect(|arc_mm| height_mm(&self.at_arc(arc_mm)) < top_mm, self.arcs_mm[above - 1], self.arcs_mm[above]);
        let tip = self.at_arc(arc_mm);
        let part = self.points[above].part;
        let tip = EnvelopePoint { phi_rad: tip.phi_rad, point_mm: tip.point_mm, normal: tip.normal, part };
        Some(Self::through(self.points[..above].iter().copied().chain([tip]).collect()))
    }
}
