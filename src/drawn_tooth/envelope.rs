//! The space that a drawn tooth generates when its tool runs on continuously.
//!
//! In: a [`DrawnTooth`], the blank, and the tool's law of contact: where a place of the contour touches what it
//! generates. Out: [`SpaceProfile`], points with normals from the tip of one tooth through the space to the tip of the
//! next, kept space by space in [`DrawnSpaces`]. What is left is found the same way for every tool.
//!
//! **What is left.** Where the envelope crosses itself the loop between is cut away: by the path of a corner (undercut,
//! protuberance) or behind a cusp. What does not touch anywhere leaves a gap, which its neighbours close.
//!
//! Places are some [`SPACING_MODULES`] apart; between them a flank is the cubic through points and tangents
//! ([`super::flank`]), which is off by less than a nanometre, and a crossing is that of chords, off by their arrow
//! heights.
//!
//! Road not taken: the flank as a function of the linkage's parameter, as for involutes. It may rest on arcs (rollers
//! of a sprocket) and run backwards on others.

use super::contour::meet;
use super::scattered::turn_rad;
use super::{DrawnPart, DrawnTooth, EdgePlace};
use gearcut_core::error::Refusal;
use gearcut_core::gear::blank::Blank;
use gearcut_core::tool::edge::SegmentName;
use glam::DVec2;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Points nearer than this are one, mm.
pub const SAME_MM: f64 = 1e-9;
/// Distance of neighbouring points at most, in modules: arrow heights are a fortieth of a micrometre at module 3 and a
/// radius of 2 mm.
const SPACING_MODULES: f64 = 1.0 / 150.0;
/// Places of every part that are looked at, and how often the way between two is halved.
const FIRST_PLACES: u32 = 4;
const MOST_HALVINGS: u32 = 12;
/// A flank that turns by more than this at a point runs back, rad: envelopes turn by half a turn in a cusp.
const BACK_RAD: f64 = 2.8;

/// A flank that has lost less is not undercut, mm: rounding where parts meet.
const LEAST_UNDERCUT_MM: f64 = 1e-6;

/// A point of the envelope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnvelopePoint {
    /// Parameter of the linkage, rad.
    pub phi_rad: f64,
    /// Point, gear frame, mm.
    pub point_mm: DVec2,
    /// Unit normal out of the gear.
    pub normal: DVec2,
    /// Part of the drawn tooth that touches there.
    pub part: usize,
}

impl EnvelopePoint {
    /// Whether it is one with another point. A corner is two points, one with either normal.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        self.point_mm.distance(other.point_mm) < SAME_MM && self.normal.distance(other.normal) < SAME_MM
    }
}

/// The envelope of one space, without what is cut away.
#[derive(Debug, Clone)]
pub struct SpaceProfile {
    /// From the cutter's right root to its left root, as far as the blank reaches, and one point beyond at either end.
    points: Vec<EnvelopePoint>,
    /// What was cut away: loops by the crossing that replaces them.
    loops: Vec<Vec<EnvelopePoint>>,
    /// Index of the last point of the right flank and of the first one of the left flank.
    flanks: [usize; 2],
}

/// Spaces of one generation, each found once.
#[derive(Debug)]
pub struct DrawnSpaces {
    /// Of which the gear is cut.
    pub blank: Blank,
    found: Mutex<BTreeMap<i64, Result<Arc<SpaceProfile>, Refusal>>>,
}

impl DrawnSpaces {
    /// None so far; of a gear from this blank.
    pub fn new(blank: Blank) -> Self {
        Self { blank, found: Mutex::default() }
    }

    /// A space that is known already, or as it is found.
    ///
    /// # Errors
    /// Why it is not found.
    pub fn known_or(
        &self,
        space: i64,
        find: impl FnOnce() -> Result<SpaceProfile, Refusal>,
    ) -> Result<Arc<SpaceProfile>, Refusal> {
        let known = self.found.lock().unwrap_or_else(PoisonError::into_inner).get(&space).cloned();
        known.unwrap_or_else(|| {
            let found = find().map(Arc::new);
            self.found.lock().unwrap_or_else(PoisonError::into_inner).insert(space, found.clone());
            found
        })
    }
}

impl SpaceProfile {
    /// Envelope of a tooth in a space (any integer, named in messages): `touch` says where a place of a part touches.
    ///
    /// # Errors
    /// A tooth that ends within the blank, or that has no flank.
    pub fn new(
        tooth: &DrawnTooth,
        blank: &Blank,
        space: i64,
        module_mm: f64,
        touch: impl Fn(EdgePlace, usize) -> Option<EnvelopePoint>,
    ) -> Result<Self, Refusal> {
        let file = &tooth.place.file_key();
        let all = envelope(tooth, SPACING_MODULES * module_mm, touch);
        let points = within(&all, blank, file)?;
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
            Refusal::new(file, problem, "draw flanks steeper than 45 deg, or look at the module and the teeth")
        })?;
        if let Some(at_mm) = runs_back(&points[..=flanks[0]]).or_else(|| runs_back(&points[flanks[1]..])) {
            let problem = format!(
                "the flank that it generates in space {space} runs back on itself {:.3} mm off the axis of the gear: \
                 the edge is too hollow or too rough where it cuts there",
                at_mm.length()
            );
            return Err(Refusal::new(file, problem, "smooth what was measured, or allow more tolerance"));
        }
        Ok(Self { points, loops, flanks })
    }

    /// All points, from the tool's right root to its left one.
    pub fn points(&self) -> &[EnvelopePoint] {
        &self.points
    }

    /// Points of the root, from the cutter's right flank to its left one.
    pub fn root(&self) -> &[EnvelopePoint] {
        let [right, left] = self.flanks;
        &self.points[right.min(left)..=left.max(right)]
    }

    /// Points of one flank from where it begins towards the tip: that of the cutter's left flank or right one.
    pub fn flank(&self, is_left: bool) -> Vec<EnvelopePoint> {
        let [right, left] = self.flanks;
        if is_left { self.points[left..].to_vec() } else { self.points[..=right].iter().rev().copied().collect() }
    }

    /// How deep the root lies under what was cut away of a flank, mm, if something was.
    pub fn undercut_mm(&self, is_left: bool, tooth: &DrawnTooth) -> Option<f64> {
        let name = if is_left { SegmentName::FlankLeft } else { SegmentName::FlankRight };
        let root = self.root();
        let over_mm =
            |of: &EnvelopePoint| root.iter().map(|at| at.point_mm.distance(of.point_mm)).fold(f64::INFINITY, f64::min);
        let [right, left] = self.flanks;
        let begins = self.points[if is_left { left } else { right }].point_mm;
        let is_there = |lost: &&Vec<EnvelopePoint>| lost[0].point_mm.distance(begins) < SAME_MM;
        let depth_mm = |lost: &Vec<EnvelopePoint>| {
            // From where the flank is crossed down to the cusp, behind which the envelope turns back into the air.
            let flank = lost[1..].iter().filter(|at| tooth.parts[at.part].name == name);
            let mut flank: Vec<&EnvelopePoint> = flank.collect();
            if is_left {
                flank.reverse();
            }
            let way = |pair: &[&EnvelopePoint]| (pair[1].point_mm - pair[0].point_mm).dot(pair[0].normal.perp());
            let first = flank.windows(2).next().map_or(0.0, way);
            let down = flank.windows(2).take_while(|pair| way(pair) * first > 0.0);
            down.map(|pair| over_mm(pair[0])).fold(0.0, f64::max)
        };
        self.loops.iter().filter(is_there).map(depth_mm).reduce(f64::max).filter(|mm| *mm > LEAST_UNDERCUT_MM)
    }
}

/// Touches of all parts in the order of the edge.
fn envelope(
    tooth: &DrawnTooth,
    spacing_mm: f64,
    touch: impl Fn(EdgePlace, usize) -> Option<EnvelopePoint>,
) -> Vec<EnvelopePoint> {
    let mut points: Vec<EnvelopePoint> = Vec::new();
    for (part, drawn) in tooth.parts.iter().enumerate() {
        let touch = |share: f64| touch(drawn.law.at(share), part);
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
fn within<'a>(all: &'a [EnvelopePoint], blank: &Blank, file: &str) -> Result<&'a [EnvelopePoint], Refusal> {
    let is_inside = |at: &EnvelopePoint| blank.height(at.point_mm, at.phi_rad).0 < blank.addendum_mm;
    let ends = all.iter().position(is_inside).zip(all.iter().rposition(is_inside));
    let Some((first, last)) = ends else {
        let problem = "the drawn tooth reaches nothing of the blank".to_owned();
        return Err(Refusal::new(file, problem, "look at the unit of the file, the module and the teeth"));
    };
    if first == 0 || last + 1 == all.len() {
        let end = if first == 0 { &all[0] } else { &all[last] };
        let below_mm = blank.addendum_mm - blank.height(end.point_mm, end.phi_rad).0;
        return Err(Refusal::new(
            file,
            format!("the contour ends {below_mm:.4} mm below the tips of the gear, which it does not shape"),
            "lead it further towards the tool's axis, or take a smaller gear.addendum_coefficient",
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
