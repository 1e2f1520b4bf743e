//! The edge of a hob tooth whose basic rack is drawn or measured.
//!
//! In: the contour of the rack in the normal section ([`DrawnTooth`]: h over the pitch line along x, w across along y),
//! pitch cylinder and lead of the thread. Out: the segments of one tooth in the rake face, right root to left root.
//!
//! **Straight-sided thread.** Its axial section is the contour itself, w stretched by 1 / cos(lambda).
//!
//! **Thread that generates with the rack.** In the thread's transverse plane the rack is the contour with w stretched
//! by 1 / sin(lambda), and rolls on the pitch circle R. A place with the normal (n_h, n_w) touches the thread when its
//! normal meets the pitch line, d = h sin(lambda) n_w / n_h beside it: contact normals pass through the pitch point.
//! The thread has that point at the radius rho = sqrt((R + h)^2 + d^2) and the angle (w / sin(lambda) - d) / R +
//! asin(d / rho); in the axial section the angle becomes the place p times the angle. A straight contour gives so the
//! involute worm (ZI). Where the contour has a corner outwards, both its parts reach beyond it on the thread and are
//! cut off where they cross; a corner inwards leaves its own path, like a corner of a rack in the root of a gear.
//!
//! **Segments.** Images of parts that turn outwards alone are tables of the curve, hollow ones tangents within the
//! contour's tolerance ([`crate::drawn_tooth`] says why), what has no bend is a line.

use super::LEAST_SLOPE;
use crate::drawn_tooth::scattered::turn_rad;
use crate::drawn_tooth::{DrawnTooth, KINK_RAD, PartLaw, lines};
use gearcut_core::error::Refusal;
use gearcut_core::tool::edge::{Edge, Segment, SegmentName};
use gearcut_core::tool::edge_profile::BladeCurve;
use glam::{DMat2, DVec2};

/// Places of a part at which the turn of its image is looked at.
const PLACES: u32 = 16;
/// Directions that differ by less are one: rounding of rates.
const BEND_RAD: f64 = 1e-11;
/// A part of a part that turns both ways, as a share of it, is a line.
const SHORTEST_SHARE: f64 = 1.0 / 128.0;
/// Most tangents of a hollow.
const MOST_TANGENTS: u32 = 128;
/// Newton steps to a crossing, and what may be missing then, mm.
const CROSSING_STEPS: u32 = 40;
const CROSSED_MM: f64 = 1e-10;
/// Ends nearer than this are one, mm.
const SAME_MM: f64 = 1e-9;

/// How a contour lies in the rake face.
#[derive(Debug, Clone, Copy)]
pub(super) struct DrawnThread {
    /// Whether the thread generates with the rack; else its axial section is the contour.
    pub generates: bool,
    /// Pitch cylinder of the new hob, mm.
    pub pitch_radius_mm: f64,
    /// p, mm.
    pub parameter_mm_per_rad: f64,
    /// lambda.
    pub lead_angle_rad: f64,
    /// Axial lengths in the rake face over those in the axial section.
    pub scale: f64,
    /// By how much everything has sunk, mm.
    pub regrind_mm: f64,
}

/// A part of the contour, as it lies in the rake face between two shares.
#[derive(Debug, Clone, Copy)]
struct RakePart<'a> {
    thread: &'a DrawnThread,
    name: SegmentName,
    law: PartLaw,
    shares: [f64; 2],
    /// Whether a corner outwards lies before it.
    is_behind_corner: bool,
}

impl BladeCurve for RakePart<'_> {
    fn point_and_rate(&self, share: f64) -> [DVec2; 2] {
        let of = self.thread;
        let place = self.law.at(share);
        let (p, n) = (place.point_mm, place.normal);
        let [p_rate, n_rate] = self.law.rates(share);
        let (sin, cos) = of.lead_angle_rad.sin_cos();
        let [point, rate] = if of.generates {
            let lean = n.y / n.x;
            let lean_rate = (n_rate.y * n.x - n.y * n_rate.x) / (n.x * n.x);
            let (beside, beside_rate) = (p.x * sin * lean, sin * (p_rate.x * lean + p.x * lean_rate));
            let up = of.pitch_radius_mm + p.x;
            let radius = up.hypot(beside);
            let angle = (p.y / sin - beside) / of.pitch_radius_mm + beside.atan2(up);
            let angle_rate = (p_rate.y / sin - beside_rate) / of.pitch_radius_mm
                + (up * beside_rate - beside * p_rate.x) / (radius * radius);
            let radius_rate = (up * p_rate.x + beside * beside_rate) / radius;
            let along = of.parameter_mm_per_rad;
            [DVec2::new(radius, along * angle), DVec2::new(radius_rate, along * angle_rate)]
        } else {
            [DVec2::new(of.pitch_radius_mm + p.x, p.y / cos), DVec2::new(p_rate.x, p_rate.y / cos)]
        };
        let across = DVec2::new(1.0, of.scale);
        [across * point - DVec2::new(of.regrind_mm, 0.0), across * rate]
    }
}

impl DrawnThread {
    /// The edge of a tooth.
    ///
    /// # Errors
    /// A contour with which no thread generates; more segments than a blade may have.
    pub(super) fn edge(&self, tooth: &DrawnTooth) -> Result<Edge, Refusal> {
        let mut parts = self.parts(tooth)?;
        for i in 1..parts.len() {
            if parts[i].is_behind_corner
                && let Some([a, b]) = crossing(&parts[i - 1], &parts[i])
            {
                parts[i - 1].shares[1] = a;
                parts[i].shares[0] = b;
            }
        }
        let mut segments: Vec<Segment> = Vec::new();
        let mut before: Option<DVec2> = None;
        for part in &parts {
            let [start, end] = part.shares.map(|share| part.point_and_rate(share)[0]);
            if let Some(last) = before.filter(|last| last.distance(start) > SAME_MM) {
                segments.push(Segment::straight(part.name, last, start));
            }
            part.add_segments(0.5 * tooth.tolerance_mm, &mut segments, tooth)?;
            before = Some(end);
        }
        tooth.edge_of(segments)
    }

    /// The contour's parts in their order, with what corners inwards leave, without those outwards.
    fn parts(&self, tooth: &DrawnTooth) -> Result<Vec<RakePart<'_>>, Refusal> {
        let mut parts: Vec<RakePart<'_>> = Vec::new();
        let mut is_behind_corner = false;
        for drawn in &tooth.parts {
            if matches!(drawn.law, PartLaw::Turn { radius_mm: 0.0, .. }) {
                is_behind_corner = true;
                continue;
            }
            let whole =
                RakePart { thread: self, name: drawn.name, law: drawn.law, shares: [0.0, 1.0], is_behind_corner };
            is_behind_corner = false;
            if let Some(before) = parts.last().filter(|_| self.generates) {
                let [end, start] = [before.law.at(1.0), drawn.law.at(0.0)];
                let turn = turn_rad(end.normal, start.normal);
                if turn < -KINK_RAD {
                    let from = end.normal.to_angle();
                    let law =
                        PartLaw::Turn { center_mm: start.point_mm, radius_mm: 0.0, normals_rad: [from, from + turn] };
                    let path = RakePart { law, is_behind_corner: false, ..whole };
                    parts.extend(path.touching());
                }
            }
            let touching = if self.generates { whole.touching() } else { vec![whole] };
            if touching.is_empty() && matches!(drawn.law, PartLaw::Line { .. }) {
                return Err(self.no_thread(tooth, &drawn.law, 0.5, "runs square to the pitch line"));
            }
            for part in &touching {
                part.refuse_backwards(tooth)?;
            }
            parts.extend(touching);
        }
        Ok(parts)
    }

    fn no_thread(&self, tooth: &DrawnTooth, law: &PartLaw, share: f64, what: &str) -> Refusal {
        let at = law.at(share).point_mm;
        Refusal::new(
            &tooth.place.file_key(),
            format!(
                "no thread with a lead of {:.3} deg generates with the contour at x {:.4}, y {:.4} mm, where it {what}",
                self.lead_angle_rad.to_degrees(),
                -at.y,
                at.x
            ),
            "have it drawn less steep, use a larger diameter, or write worm = \"straight_sided\" under [tool.hob]: the \
            contour itself in the axial section",
        )
    }
}

impl RakePart<'_> {
    /// What of it touches a thread: not where normals run along the pitch line.
    fn touching(self) -> Vec<Self> {
        let share_at = |share: f64| self.law.at(share).normal.x.abs() >= LEAST_SLOPE;
        let PartLaw::Turn { normals_rad: [from, to], .. } = self.law else {
            return if share_at(0.5) { vec![self] } else { Vec::new() };
        };
        let steep = LEAST_SLOPE.acos();
        let share_of = |angle: f64| (angle - from) / (to - from);
        let mut ends: Vec<f64> = [-1.0, 1.0]
            .into_iter()
            .flat_map(|side| [side * steep, side * (std::f64::consts::PI - steep)])
            .map(share_of)
            .filter(|share| (1e-9..=1.0 - 1e-9).contains(share))
            .chain([0.0, 1.0])
            .collect();
        ends.sort_by(f64::total_cmp);
        let pairs = ends.windows(2).filter(|pair| share_at(0.5 * (pair[0] + pair[1])));
        pairs.map(|pair| Self { shares: [pair[0], pair[1]], ..self }).collect()
    }

    /// Share of the whole part at one of what is left of it.
    fn share(&self, of: f64) -> f64 {
        self.shares[0] + of * (self.shares[1] - self.shares[0])
    }

    /// Refuses an image that runs backwards: the thread would be undercut.
    fn refuse_backwards(&self, tooth: &DrawnTooth) -> Result<(), Refusal> {
        let shares = (0..=PLACES).map(|i| self.share(f64::from(i) / f64::from(PLACES)));
        let is_back = |&share: &f64| self.point_and_rate(share)[1].dot(self.law.rates(share)[0]) <= 0.0;
        match shares.into_iter().find(is_back) {
            None => Ok(()),
            Some(share) => Err(self.thread.no_thread(tooth, &self.law, share, "undercuts its thread")),
        }
    }

    /// Its convex segments.
    fn add_segments(&self, tolerance_mm: f64, segments: &mut Vec<Segment>, tooth: &DrawnTooth) -> Result<(), Refusal> {
        let [start, end] = self.shares.map(|share| self.point_and_rate(share)[0]);
        if start.distance(end) <= SAME_MM {
            return Ok(());
        }
        let rates: Vec<DVec2> =
            (0..=PLACES).map(|i| self.point_and_rate(self.share(f64::from(i) / f64::from(PLACES)))[1]).collect();
        let turns = || rates.windows(2).map(|pair| turn_rad(pair[0], pair[1]));
        let (is_out, is_in) = (turns().all(|turn| turn > -BEND_RAD), turns().all(|turn| turn < BEND_RAD));
        match (is_out, is_in) {
            (true, true) => segments.push(Segment::straight(self.name, start, end)),
            (true, false) => segments.push(Segment::curve(self.name, self, self.shares).map_err(|error| {
                Refusal::new(&tooth.place.file_key(), error.to_string(), "smooth the contour, or allow more tolerance")
            })?),
            (false, true) => segments.extend(self.tangents(tolerance_mm)),
            (false, false) if self.shares[1] - self.shares[0] < SHORTEST_SHARE => {
                segments.push(Segment::straight(self.name, start, end));
            }
            (false, false) => {
                let middle = self.share(0.5);
                for shares in [[self.shares[0], middle], [middle, self.shares[1]]] {
                    Self { shares, ..*self }.add_segments(tolerance_mm, segments, tooth)?;
                }
            }
        }
        Ok(())
    }

    /// Tangents of a hollow that cross within a tolerance of it.
    fn tangents(&self, tolerance_mm: f64) -> Vec<Segment> {
        let [start, end] = self.shares.map(|share| self.point_and_rate(share)[0]);
        let mut vertices = Vec::new();
        for count in 1..=MOST_TANGENTS {
            let at = |i: f64| self.point_and_rate(self.share(i / f64::from(count)));
            vertices.clear();
            let mut off_mm = 0.0_f64;
            for i in 0..count {
                let [[p, along], [q, other]] = [0.0, 1.0].map(|more| at(f64::from(i) + more));
                let share = (q - p).perp_dot(other) / along.perp_dot(other);
                let vertex = if share.is_finite() { p + share * along } else { 0.5 * (p + q) };
                off_mm = off_mm.max(vertex.distance(at(f64::from(i) + 0.5)[0]));
                vertices.push(vertex);
            }
            if off_mm <= tolerance_mm {
                break;
            }
        }
        lines(self.name, [start].into_iter().chain(vertices).chain([end]))
    }
}

/// Shares at which the end of a part crosses the beginning of the next one.
fn crossing(before: &RakePart<'_>, after: &RakePart<'_>) -> Option<[f64; 2]> {
    let (mut a, mut b) = (before.shares[1], after.shares[0]);
    for _ in 0..CROSSING_STEPS {
        let ([p, p_rate], [q, q_rate]) = (before.point_and_rate(a), after.point_and_rate(b));
        if p.distance(q) <= CROSSED_MM {
            let is_inside =
                a > before.shares[0] && a <= before.shares[1] && b >= after.shares[0] && b < after.shares[1];
            return is_inside.then_some([a, b]);
        }
        let step = DMat2::from_cols(p_rate, -q_rate).inverse() * (q - p);
        (a, b) = (a + step.x, b + step.y);
    }
    None
}
