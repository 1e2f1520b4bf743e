//! Programs of wire erosion: the centre of the wire round the section, for LinuxCNC.
//!
//! In: the profile as a closed chain, wire and spark gap. Out: [`WireProgram`]: the path from a start hole to the
//! middle of the first tooth's tip land, all round, and back, as arcs and lines in `G90 G17`; and the path as the
//! program's own reader has it, judged against the profile.
//!
//! **Law.** The wire cuts a circle of radius d = half its diameter and the gap. Its centre runs d beside the profile in
//! the air ([`super::wire_centre`]), so that it leaves material where the profile is hollow with a radius below d, or
//! narrower than 2 d. Up to the tolerance that is as good as the profile: so low marks of a cut one are passed over.
//! More is refused with its place. Of a sector's dwell alone any is left, in the corners at the feet of its walls,
//! which nothing meets; the program and the command say how much.

use super::arcs::{ArcPath, ArcVertex, PathPieces, distinct};
use super::drawing::zero_words;
use super::section::FIT_SHARE;
use super::unit::{FileUnit, fixed};
use super::wire_centre::centre_path;
use crate::gcode::{Grammar, Move, ProgramArc, ascii, statements};
use crate::job::CylindricalGear;
use crate::machine::AxisKind;
use crate::measure::target_outline::TargetOutline;
use crate::number_text::{plain, significant};
use gearcut_core::error::Refusal;
use gearcut_core::gear::Back;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

/// Share of the tolerance by which chords of the chain may come nearer than d.
const CHORD_SHARE: f64 = 0.1;
/// Points nearer to the one before than this share of the tolerance are left out.
const NEAREST_SHARE: f64 = 0.1;
/// Places at which a program is judged are so far apart, mm.
const JUDGED_MM: f64 = 0.01;
/// What is left is looked for so many distances of the wire off the path.
const MOST_OFFSETS: f64 = 20.0;
/// Both radii of an arc agree to this, mm; LinuxCNC allows a thousand times as much.
const RADII_MM: f64 = 1e-5;

/// The wire and how it runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WireWish {
    /// Diameter of the wire, mm.
    pub wire_mm: f64,
    /// Spark gap beside it, mm.
    pub gap_mm: f64,
    /// From the start hole to the path, mm.
    pub lead_mm: f64,
    /// Largest feed, mm/min.
    pub feed_mm_per_min: f64,
    /// Largest distance of the path from that of the law, mm.
    pub tolerance_mm: f64,
}

impl WireWish {
    /// Distance of the wire's centre from the profile, mm.
    pub fn offset_mm(&self) -> f64 {
        0.5 * self.wire_mm + self.gap_mm
    }
}

/// A program and what it cuts.
#[derive(Debug, Clone, PartialEq)]
pub struct WireProgram {
    /// The text of the file.
    pub text: String,
    /// Arcs and lines.
    pub path: ArcPath,
    /// How far what the read program cuts is off the profile, mm, negative where it cuts into the gear: least and most.
    pub off_mm: [f64; 2],
    /// The most that the wire leaves in the corners of a sector's dwell, mm.
    pub dwell_mm: Option<f64>,
}

impl WireProgram {
    /// Program round the closed profile of a gear.
    ///
    /// # Errors
    /// A helical gear; a profile that the wire cannot follow, with the place.
    pub fn new(gear: &dyn CylindricalGear, chain_mm: &[DVec2], wish: &WireWish) -> Result<Self, Refusal> {
        if gear.scene().gear.helix_angle_rad != 0.0 {
            let problem = "a wire along the gear's axis erodes no helical gear";
            return Err(Refusal::new("--wire", problem, "draw its section with --dxf, or write helix_angle_deg = 0"));
        }
        let blank = gear.blank();
        // Flanks end where fillets begin, but for some hundredths of a micrometre, which have any direction.
        let mut chain = distinct(chain_mm, true, NEAREST_SHARE * wish.tolerance_mm);
        let outline = TargetOutline::new(chain.clone(), blank.back);
        let first = nearest(&chain, tip_middle_mm(gear));
        chain.rotate_left(first);
        let nearest_mm = wish.offset_mm() - CHORD_SHARE * wish.tolerance_mm;
        let centre = centre_path(&chain, &outline, wish.offset_mm(), nearest_mm);
        let centre = centre.ok_or_else(|| left(wish, chain[0], None))?;
        let (dwell, profile): (Vec<DVec2>, Vec<DVec2>) =
            chain.iter().partition(|p| blank.dwell().is_some_and(|dwell| dwell.has(**p)));
        let left_mm = |places: &[DVec2]| most_left(&centre, places, wish);
        let dwell_mm = left_mm(&dwell).map(|(left_mm, _)| left_mm);
        if let Some((left_mm, place_mm)) = left_mm(&profile).filter(|(left_mm, _)| *left_mm > wish.tolerance_mm) {
            return Err(left(wish, place_mm, Some(left_mm)));
        }
        let path = ArcPath::fit(&centre, false, FIT_SHARE * wish.tolerance_mm, PathPieces::Arcs);
        let outwards = (centre[0] - chain[0]).normalize_or_zero();
        let hole_mm = centre[0] + wish.lead_mm * outwards;
        let room = wish.offset_mm() + wish.lead_mm;
        if let Some(near_mm) = outline.distance_mm(hole_mm, room).filter(|near_mm| *near_mm < wish.offset_mm()) {
            let problem =
                format!("{} mm from the path the start hole is {near_mm:.3} mm from the profile", wish.lead_mm);
            return Err(Refusal::new("--lead-mm", problem, "give a shorter lead"));
        }
        let text = text(gear, &path, hole_mm, dwell_mm, wish);
        let read = read(&text).map_err(|why| {
            Refusal::new("--wire", format!("the program cannot be read back: {why}"), "please report this")
        })?;
        let off_mm = judged(&read, &profile, &outline, wish);
        if off_mm[0] < -(1.0 + CHORD_SHARE) * wish.tolerance_mm {
            let problem = format!("the program would cut {:.3} um into the gear", -off_mm[0] * UM_PER_MM);
            return Err(Refusal::new("--wire", problem, "allow another --tolerance-um, and please report this"));
        }
        Ok(Self { text, path, off_mm, dwell_mm })
    }
}

/// Middle of the first tooth's tip land.
fn tip_middle_mm(gear: &dyn CylindricalGear) -> DVec2 {
    let pitch_mm = PI * gear.scene().gear.transverse_module_mm();
    gear.blank().outline_mm(gear.curve().phi_at_arc(0.5 * pitch_mm))
}

fn nearest(chain_mm: &[DVec2], place_mm: DVec2) -> usize {
    let distance = |i: &usize| chain_mm[*i].distance_squared(place_mm);
    (0..chain_mm.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or_default()
}

/// The most that the wire leaves of the profile's places, and where.
fn most_left(centre: &[DVec2], places_mm: &[DVec2], wish: &WireWish) -> Option<(f64, DVec2)> {
    let wire = TargetOutline::new(centre.to_vec(), Back::bore(0.0));
    let offset_mm = wish.offset_mm();
    let left =
        |&p: &DVec2| (wire.distance_mm(p, MOST_OFFSETS * offset_mm).map_or(f64::INFINITY, f64::abs) - offset_mm, p);
    places_mm.par_iter().map(left).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// A profile that the wire cannot follow: how much of it would be left at a place, as far as that is looked for.
fn left(wish: &WireWish, place_mm: DVec2, left_mm: Option<f64>) -> Refusal {
    let left = left_mm.filter(|left_mm| left_mm.is_finite());
    let left = left.map_or_else(|| "more than it is wide".to_owned(), |mm| format!("{} mm", significant(mm, 2)));
    let problem = format!(
        "a wire of {} mm with a gap of {} mm would leave {left} in a hollow at the polar angle {:.3} deg, {:.3} mm \
         from the axis: the profile has a radius below {} mm there, or its sides are too near",
        plain(wish.wire_mm),
        plain(wish.gap_mm),
        place_mm.to_angle().to_degrees(),
        place_mm.length(),
        shown_offset(wish)
    );
    let way_out = "use a thinner wire (--wire-diameter-um), allow more (--tolerance-um), take a tool with a larger tip \
                   radius, or leave --as-cut out, with which every mark is followed";
    Refusal::new("--wire-diameter-um", problem, way_out)
}

/// The wire's distance as it is said, mm.
fn shown_offset(wish: &WireWish) -> String {
    plain((wish.offset_mm() * 1e9).round() / 1e9)
}

fn text(gear: &dyn CylindricalGear, path: &ArcPath, hole_mm: DVec2, dwell_mm: Option<f64>, wish: &WireWish) -> String {
    let unit = FileUnit::Millimetre;
    let place = |p: DVec2| format!("X{} Y{}", unit.shown(p.x), unit.shown(p.y));
    let mut text = String::from("%\n");
    for words in [
        format!("gearcut {}: wire round the section of {}", env!("CARGO_PKG_VERSION"), ascii(&gear.scene().name)),
        format!(
            "wire {} mm, gap {} mm: its centre {} mm beside the profile, within {} um",
            plain(wish.wire_mm),
            plain(wish.gap_mm),
            shown_offset(wish),
            plain(wish.tolerance_mm * UM_PER_MM)
        ),
        format!("gear frame: axis at the origin, {}", zero_words(gear)),
        "F is the largest feed: the generator holds the gap".to_owned(),
    ] {
        let _ = writeln!(text, "({words})");
    }
    if let Some(dwell_mm) = dwell_mm {
        let _ = writeln!(text, "(in the corners of the dwell it leaves {} mm)", significant(dwell_mm, 2));
    }
    let _ = writeln!(text, "G17 G21 G90 G94\n(start hole)\nG0 {}\n(thread the wire)\nM0", place(hole_mm));
    let _ = writeln!(text, "G1 {} F{}", place(path.vertices[0].point_mm), plain(wish.feed_mm_per_min));
    for pair in path.vertices.windows(2) {
        let (from, to, bulge) = (pair[0].point_mm, pair[1].point_mm, pair[0].bulge);
        if bulge == 0.0 {
            let _ = writeln!(text, "G1 {}", place(to));
            continue;
        }
        let chord = to - from;
        let centre = 0.5 * chord + (1.0 - bulge * bulge) / (4.0 * bulge) * chord.perp();
        let code = if bulge > 0.0 { 3 } else { 2 };
        let _ = writeln!(text, "G{code} {} I{} J{}", place(to), fixed(centre.x, 8), fixed(centre.y, 8));
    }
    let _ = writeln!(text, "G1 {}\nM2\n%", place(hole_mm));
    text
}

/// The path of a program of wire erosion from its first block at the feed on, as a control reads it.
///
/// # Errors
/// Line and word of what is malformed, unknown or missing; an arc whose ends are not equally far from its centre.
pub fn read(text: &str) -> Result<ArcPath, String> {
    let axes = [('X', AxisKind::Linear), ('Y', AxisKind::Linear)];
    let grammar = Grammar { axes, names: "X and Y", ram: false, arcs: true };
    let mut at: Option<DVec2> = None;
    let mut vertices: Vec<ArcVertex> = Vec::new();
    let (_, ended) = statements(text, &grammar, |statement| {
        let Some((how, [x, y])) = statement.travel else { return Ok(()) };
        let to = match at {
            Some(from) => DVec2::new(x.unwrap_or(from.x), y.unwrap_or(from.y)),
            None => DVec2::new(x.ok_or("X has no position yet")?, y.ok_or("Y has no position yet")?),
        };
        let from = at.replace(to);
        let (Move::Straight, Some(from)) = (how, from) else { return Ok(()) };
        if statement.feed.is_none() {
            return Err("word `F` is missing".to_owned());
        }
        let bulge = statement.arc.map_or(Ok(0.0), |arc| bulge(&arc, from, to))?;
        vertices.push(ArcVertex { point_mm: from, bulge });
        Ok(())
    })?;
    ended?;
    let end = at.ok_or("no block moves the wire")?;
    vertices.push(ArcVertex { point_mm: end, bulge: 0.0 });
    Ok(ArcPath { vertices, is_closed: false })
}

fn bulge(arc: &ProgramArc, from: DVec2, to: DVec2) -> Result<f64, String> {
    let centre = from + DVec2::from(arc.centre_mm);
    let (start, end) = (from - centre, to - centre);
    if (start.length() - end.length()).abs() > RADII_MM {
        return Err(format!(
            "an arc begins {} mm from its centre and ends {} mm from it",
            start.length(),
            end.length()
        ));
    }
    let sweep_rad = arc.turn * (arc.turn * start.angle_to(end)).rem_euclid(TAU);
    Ok((0.25 * sweep_rad).tan())
}

/// How far what a read path cuts is off the profile: least and most over the path, its leads left out, and over the
/// profile but for a dwell, so that nothing is left out.
fn judged(read: &ArcPath, profile_mm: &[DVec2], outline: &TargetOutline, wish: &WireWish) -> [f64; 2] {
    // The first piece leads in, the last one out.
    let round = &read.vertices[1..read.vertices.len() - 1];
    let places = ArcPath { vertices: round.to_vec(), is_closed: false }.places_mm(JUDGED_MM);
    let offset_mm = wish.offset_mm();
    let most_mm = 4.0 * offset_mm;
    let own = places.iter().map(|&p| outline.distance_mm(p, most_mm).unwrap_or(most_mm) - offset_mm);
    let wire = TargetOutline::new(places.clone(), Back::bore(0.0));
    let reached = profile_mm.iter().map(|&p| wire.distance_mm(p, most_mm).map_or(most_mm, f64::abs) - offset_mm);
    // A profile place at a corner is as near to the wire as at its flanks: only what is not reached counts there.
    own.chain(reached.filter(|off| *off > 0.0))
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], off| [least.min(off), most.max(off)])
}
