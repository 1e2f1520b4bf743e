//! The contour of a drawing, closed or open: text of a DXF file in, its points in mm out.
//!
//! Polylines with bulges, lines, arcs, circles, ellipses and splines (NURBS) of the model space are joined end to end.
//! Where curves lie on the contour's layer, others are not looked at. What cannot be read for certain is refused:
//! drawings without a unit, gaps, several contours, blocks, planes other than xy.
//!
//! Road not taken: the crate `dxf` brings `chrono`, `uuid` and a minute of compilation for seven kinds of curves.

use super::errors::Problem;
use super::sources::line_place;
use glam::DVec2;
use std::f64::consts::TAU;
use std::ops::Range;

/// Layer of the pitch curve, as the export of sections writes it.
const PITCH_CURVE: &str = "PITCH_CURVE";
/// Ends of pieces that are one point, mm.
const JOINED_MM: f64 = 1e-4;
/// Most pieces that are joined.
const MOST_PIECES: usize = 20_000;
/// A step along arcs and ellipses, rad: points of a circle of 100 mm are then 0.4 mm apart.
const STEP_RAD: f64 = TAU / 1440.0;
/// Points of a span between two knots of a spline.
const SPAN_POINTS: usize = 32;
/// Largest degree of a spline.
const MOST_DEGREE: usize = 25;

/// A contour.
#[derive(Debug)]
pub(crate) struct DrawnContour {
    /// Its points in the order of the drawing, the first one of a closed contour not repeated, mm.
    pub points_mm: Vec<DVec2>,
    /// Whether a piece of it is an arc, an ellipse or a spline; else its points are those of the drawing.
    pub is_curved: bool,
}

/// A piece of a contour: its points, in the drawing's unit.
struct ContourPiece {
    points: Vec<DVec2>,
    is_curved: bool,
    is_closed: bool,
    layer: String,
}

/// A value, its group code, and where it is in the text.
struct DxfGroup<'a> {
    code: i32,
    value: &'a str,
    span: Range<usize>,
}

/// A file while it is read.
struct DxfText<'a> {
    name: &'a str,
    text: &'a str,
    /// Layer of the contour.
    layer: &'static str,
}

/// An entity: its groups, the first of which is its kind.
struct DxfEntity<'a, 'g> {
    drawing: &'a DxfText<'a>,
    groups: &'g [DxfGroup<'a>],
}

type Refused = Box<Problem>;

/// The contour of a drawing that is a pitch curve, closed or of a sector; `name` is the file's, for messages.
pub(super) fn contour(name: &str, text: &str, is_closed: bool) -> Result<DrawnContour, Refused> {
    DxfText { name, text, layer: PITCH_CURVE }.contour(is_closed)
}

/// The open contour of a drawing, on a layer of this name if the drawing has it; `name` is the file's, for messages.
pub(crate) fn open_contour(name: &str, text: &str, layer: &'static str) -> Result<DrawnContour, Refused> {
    DxfText { name, text, layer }.contour(false)
}

impl<'a> DxfText<'a> {
    fn contour(&self, is_closed: bool) -> Result<DrawnContour, Refused> {
        let groups = self.groups()?;
        let unit_mm = self.unit_mm(&groups)?;
        let mut pieces = self.pieces(&groups)?;
        let is_on_layer = |piece: &ContourPiece| piece.layer.eq_ignore_ascii_case(self.layer);
        if pieces.iter().any(is_on_layer) {
            pieces.retain(is_on_layer);
        }
        for point in pieces.iter_mut().flat_map(|piece| &mut piece.points) {
            *point *= unit_mm;
        }
        self.joined(pieces, is_closed)
    }

    fn refuse<T>(&self, span: Range<usize>, message: impl Into<String>, way_out: &str) -> Result<T, Refused> {
        let place = line_place(self.name, self.text, span);
        Err(Box::new(Problem { place, message: message.into(), way_out: way_out.to_owned() }))
    }

    /// Of the drawing as a whole.
    fn refuse_all<T>(&self, message: impl Into<String>, way_out: &str) -> Result<T, Refused> {
        let place = line_place(self.name, self.text, 0..0).without_excerpt();
        Err(Box::new(Problem { place, message: message.into(), way_out: way_out.to_owned() }))
    }

    /// Codes and values, which are on lines of their own.
    fn groups(&self) -> Result<Vec<DxfGroup<'a>>, Refused> {
        let way_out = "save the drawing as ASCII DXF; a binary DXF or a DWG is not read";
        let mut groups = Vec::new();
        let mut start = 0;
        let mut lines = self.text.split_inclusive('\n').map(|line| {
            let from = start;
            start += line.len();
            (line.trim(), from..from + line.trim_end().len())
        });
        while let Some((code, span)) = lines.next() {
            if code.is_empty() && groups.last().is_some_and(|last: &DxfGroup<'_>| last.value == "EOF") {
                break;
            }
            let Ok(code) = code.parse() else {
                return self.refuse(span, "this is no group code of a DXF file", way_out);
            };
            let Some((value, span)) = lines.next() else {
                return self.refuse(span, "the file ends in the middle of a group", way_out);
            };
            groups.push(DxfGroup { code, value, span });
        }
        if groups.last().is_none_or(|last| last.value != "EOF") {
            return self.refuse_all("the drawing is cut off: it does not end with EOF", way_out);
        }
        Ok(groups)
    }

    /// Length of the drawing's unit, mm.
    fn unit_mm(&self, groups: &[DxfGroup<'a>]) -> Result<f64, Refused> {
        let way_out = "save it from CAD with units of insertion ($INSUNITS) in mm (4), inches (1), cm (5) or m (6)";
        let Some(at) = groups.iter().position(|group| group.code == 9 && group.value == "$INSUNITS") else {
            return self.refuse_all("the drawing does not say what its unit is: it has no $INSUNITS", way_out);
        };
        let Some(unit) = groups.get(at + 1) else {
            return self.refuse_all("$INSUNITS has no value", way_out);
        };
        match unit.value {
            "1" => Ok(25.4),
            "4" => Ok(1.0),
            "5" => Ok(10.0),
            "6" => Ok(1000.0),
            "0" => self.refuse(unit.span.clone(), "the drawing has no unit: $INSUNITS is 0", way_out),
            other => self.refuse(unit.span.clone(), format!("$INSUNITS {other} is no unit of gears"), way_out),
        }
    }

    /// Curves of the model space.
    fn pieces(&self, groups: &[DxfGroup<'a>]) -> Result<Vec<ContourPiece>, Refused> {
        let is_name =
            |pair: &[DxfGroup<'_>]| pair[0].code == 0 && pair[0].value == "SECTION" && pair[1].value == "ENTITIES";
        let Some(first) = groups.windows(2).position(is_name) else {
            return self.refuse_all("the drawing has no section ENTITIES", "draw the contour in model space");
        };
        let groups = &groups[first + 2..];
        let starts: Vec<usize> = (0..groups.len()).filter(|&i| groups[i].code == 0).collect();
        let mut pieces = Vec::new();
        let mut next = 0;
        while let Some(&start) = starts.get(next) {
            next += 1;
            let kind = groups[start].value;
            if kind == "ENDSEC" {
                break;
            }
            // A polyline's vertices are entities behind it.
            while kind == "POLYLINE" && starts.get(next).is_some_and(|&at| groups[at].value == "VERTEX") {
                next += 1;
            }
            let end = starts.get(next).copied().unwrap_or(groups.len());
            pieces.extend(DxfEntity { drawing: self, groups: &groups[start..end] }.piece()?);
            if pieces.len() > MOST_PIECES {
                let message = format!("more than {MOST_PIECES} curves");
                return self.refuse(groups[start].span.clone(), message, "join them to one polyline or spline");
            }
        }
        Ok(pieces)
    }

    /// The one contour that the pieces are; lengths in mm.
    fn joined(&self, mut pieces: Vec<ContourPiece>, is_closed: bool) -> Result<DrawnContour, Refused> {
        // A line without length closes nothing.
        pieces.retain(|piece| piece.points.iter().any(|point| point.distance(piece.points[0]) > JOINED_MM));
        let alone = format!("put the curve alone into the drawing, or on a layer {}", self.layer);
        if pieces.is_empty() {
            let message = "the drawing has no polyline, line, arc, circle, ellipse or spline in model space";
            return self.refuse_all(message, &alone);
        }
        if !is_closed && pieces.iter().any(|piece| piece.is_closed) && pieces.iter().any(|piece| !piece.is_closed) {
            return self.refuse_all("a closed curve, such as a circle, lies beside the open contour", &alone);
        }
        let mut whole = pieces.swap_remove(0);
        // An open contour grows from both ends of the piece that it begins with.
        let mut ends_left = if is_closed { 1 } else { 2 };
        while !whole.is_closed && ends_left > 0 {
            let end = whole.points[whole.points.len() - 1];
            let gap_mm = |piece: &ContourPiece| {
                let ends = [piece.points[0], piece.points[piece.points.len() - 1]].map(|point| point.distance(end));
                if piece.is_closed { [f64::INFINITY; 2] } else { ends }
            };
            let own_mm = end.distance(whole.points[0]);
            if own_mm <= JOINED_MM {
                whole.points.pop();
                whole.is_closed = true;
                break;
            }
            let of = |i: usize| gap_mm(&pieces[i]);
            let nearest = (0..pieces.len()).min_by(|&a, &b| of(a)[0].min(of(a)[1]).total_cmp(&of(b)[0].min(of(b)[1])));
            let nearest = nearest.map(|i| (i, of(i))).filter(|(_, gap)| gap[0].min(gap[1]) <= JOINED_MM);
            let Some((i, gap)) = nearest else {
                ends_left -= 1;
                let others_mm = (0..pieces.len()).flat_map(of).fold(f64::INFINITY, f64::min);
                if is_closed {
                    return self.gap(end, others_mm.min(own_mm));
                }
                if ends_left == 0 && !pieces.is_empty() {
                    let other = whole.points[0];
                    let other_mm = |piece: &ContourPiece| {
                        piece.points.iter().map(|p| p.distance(other)).fold(f64::INFINITY, f64::min)
                    };
                    let other_mm = pieces.iter().map(other_mm).fold(f64::INFINITY, f64::min);
                    return if other_mm < others_mm { self.gap(other, other_mm) } else { self.gap(end, others_mm) };
                }
                whole.points.reverse();
                continue;
            };
            let mut piece = pieces.swap_remove(i);
            if gap[1] < gap[0] {
                piece.points.reverse();
            }
            whole.points.extend_from_slice(&piece.points[1..]);
            whole.is_curved |= piece.is_curved;
        }
        if !pieces.is_empty() {
            return self.refuse_all("the drawing has more than one contour", &alone);
        }
        if whole.is_closed && !is_closed {
            let way_out = if self.layer == PITCH_CURVE {
                "draw the curve from end to end of the sector, or remove gear.sector_deg"
            } else {
                "draw one tooth from root to root and leave the body out"
            };
            return self.refuse_all("the contour is closed, and one with two ends is needed", way_out);
        }
        let mut points_mm = whole.points;
        points_mm.dedup_by(|a, b| a.distance(*b) <= JOINED_MM);
        while is_closed && points_mm.len() > 1 && points_mm[0].distance(points_mm[points_mm.len() - 1]) <= JOINED_MM {
            points_mm.pop();
        }
        Ok(DrawnContour { points_mm, is_curved: whole.is_curved })
    }

    /// Refuses a contour that goes on only so far away from its end.
    fn gap<T>(&self, end: DVec2, gap_mm: f64) -> Result<T, Refused> {
        self.refuse_all(
            format!("the contour is open at x {:.4}, y {:.4} mm: a gap of {gap_mm:.4} mm", end.x, end.y),
            if self.layer == PITCH_CURVE {
                "join its ends in CAD, ends within 0.0001 mm are one point; an open curve needs gear.sector_deg"
            } else {
                "join its ends in CAD; ends within 0.0001 mm are one point"
            },
        )
    }
}

impl DxfEntity<'_, '_> {
    /// The curve that the entity is; none of texts, dimensions and points.
    fn piece(&self) -> Result<Option<ContourPiece>, Refused> {
        let kind = self.groups[0].value;
        let (points, is_curved) = match kind {
            "LINE" => ([(10, 20), (11, 21)].into_iter().map(|at| self.point(at)).collect::<Result<_, _>>()?, false),
            "LWPOLYLINE" => self.polyline()?,
            "POLYLINE" => match self.old_polyline()? {
                None => return Ok(None),
                Some(found) => found,
            },
            "CIRCLE" | "ARC" => (self.arc(kind == "CIRCLE")?, true),
            "ELLIPSE" => (self.ellipse()?, true),
            "SPLINE" => (self.spline()?, true),
            "INSERT" => {
                return self.refuse("a block is not looked into", "explode the blocks of the drawing in CAD");
            }
            _ => return Ok(None),
        };
        if points.len() < 2 {
            return Ok(None);
        }
        let is_closed = (matches!(kind, "LWPOLYLINE" | "POLYLINE") && self.flags()? & 1 == 1) || kind == "CIRCLE";
        let layer =
            self.groups.iter().find(|group| group.code == 8).map_or(String::new(), |group| group.value.to_owned());
        Ok(Some(ContourPiece { points, is_curved, is_closed, layer }))
    }

    fn refuse<T>(&self, message: impl Into<String>, way_out: &str) -> Result<T, Refused> {
        self.drawing.refuse(self.groups[0].span.clone(), message, way_out)
    }

    fn number_of(&self, group: &DxfGroup<'_>) -> Result<f64, Refused> {
        match group.value.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                let message = format!("`{}` is no number", group.value);
                self.drawing.refuse(group.span.clone(), message, "save the drawing again from CAD")
            }
        }
    }

    fn numbers(&self, code: i32) -> Result<Vec<f64>, Refused> {
        self.groups.iter().filter(|group| group.code == code).map(|group| self.number_of(group)).collect()
    }

    fn number(&self, code: i32, absent: Option<f64>) -> Result<f64, Refused> {
        match self.numbers(code)?.first().copied().or(absent) {
            Some(number) => Ok(number),
            None => {
                let message = format!("{} has no value of group {code}", self.groups[0].value);
                self.refuse(message, "save the drawing again from CAD")
            }
        }
    }

    fn point(&self, (x, y): (i32, i32)) -> Result<DVec2, Refused> {
        Ok(DVec2::new(self.number(x, None)?, self.number(y, None)?))
    }

    fn points(&self, (x, y): (i32, i32)) -> Result<Vec<DVec2>, Refused> {
        let (x, y) = (self.numbers(x)?, self.numbers(y)?);
        if x.len() != y.len() {
            return self.refuse("points without x or without y", "save the drawing again from CAD");
        }
        Ok(x.into_iter().zip(y).map(|(x, y)| DVec2::new(x, y)).collect())
    }

    fn flags(&self) -> Result<i64, Refused> {
        Ok(self.number(70, Some(0.0))? as i64)
    }

    /// 1 of a curve seen from above, -1 of one whose own frame looks from below, with x the other way.
    fn facing(&self) -> Result<f64, Refused> {
        let normal = [self.number(210, Some(0.0))?, self.number(220, Some(0.0))?, self.number(230, Some(1.0))?];
        if normal[0].abs() > 1e-9 || normal[1].abs() > 1e-9 || normal[2] == 0.0 {
            return self.refuse("the curve does not lie in the plane xy", "turn the drawing into the plane xy in CAD");
        }
        Ok(normal[2].signum())
    }

    /// Points of vertices and of the arcs between them; whether there are arcs.
    fn polyline(&self) -> Result<(Vec<DVec2>, bool), Refused> {
        let mut vertices: Vec<[f64; 3]> = Vec::new();
        for group in self.groups {
            match (group.code, vertices.last_mut()) {
                (10, _) => vertices.push([self.number_of(group)?, 0.0, 0.0]),
                (20, Some(last)) => last[1] = self.number_of(group)?,
                (42, Some(last)) => last[2] = self.number_of(group)?,
                _ => {}
            }
        }
        self.through(&vertices)
    }

    /// The same of the kind whose vertices are entities; none of meshes.
    fn old_polyline(&self) -> Result<Option<(Vec<DVec2>, bool)>, Refused> {
        if self.flags()? & (16 | 64) != 0 {
            return Ok(None);
        }
        let starts = (0..self.groups.len()).filter(|&i| i > 0 && self.groups[i].code == 0).collect::<Vec<_>>();
        let mut vertices = Vec::new();
        for (i, &start) in starts.iter().enumerate() {
            let end = starts.get(i + 1).copied().unwrap_or(self.groups.len());
            let vertex = DxfEntity { drawing: self.drawing, groups: &self.groups[start..end] };
            // Corners of the frame that a fitted curve was drawn by are not on it.
            if vertex.flags()? & 16 == 0 {
                let at = vertex.point((10, 20))?;
                vertices.push([at.x, at.y, vertex.number(42, Some(0.0))?]);
            }
        }
        self.through(&vertices).map(Some)
    }

    /// Points through vertices with x, y and the bulge to the next one.
    fn through(&self, vertices: &[[f64; 3]]) -> Result<(Vec<DVec2>, bool), Refused> {
        let facing = self.facing()?;
        let closed = self.flags()? & 1 == 1;
        let mut points = Vec::new();
        let mut is_curved = false;
        for (i, &[x, y, bulge]) in vertices.iter().enumerate() {
            let from = DVec2::new(x, y);
            points.push(from);
            let next = if closed { Some(&vertices[(i + 1) % vertices.len()]) } else { vertices.get(i + 1) };
            let Some(&[x, y, _]) = next.filter(|_| bulge != 0.0) else { continue };
            is_curved = true;
            // The bulge is the tangent of a quarter of the arc's angle.
            let chord = DVec2::new(x, y) - from;
            let sweep_rad = 4.0 * bulge.atan();
            let centre = from + 0.5 * (chord + chord.perp() * (1.0 - bulge * bulge) / (2.0 * bulge));
            let arm = from - centre;
            let count = arc_steps(sweep_rad);
            points.extend(
                (1..count).map(|step| centre + DVec2::from_angle(sweep_rad * step as f64 / count as f64).rotate(arm)),
            );
        }
        for point in &mut points {
            point.x *= facing;
        }
        Ok((points, is_curved))
    }

    fn arc(&self, is_circle: bool) -> Result<Vec<DVec2>, Refused> {
        let (facing, centre, radius) = (self.facing()?, self.point((10, 20))?, self.number(40, None)?);
        let [from, to] = if is_circle {
            [0.0, TAU]
        } else {
            [self.number(50, None)?.to_radians(), self.number(51, None)?.to_radians()]
        };
        let sweep_rad = if is_circle { TAU } else { turn_from(to - from) };
        let count = arc_steps(sweep_rad);
        let last = if is_circle { count - 1 } else { count };
        let at = |step: usize| centre + radius * DVec2::from_angle(from + sweep_rad * step as f64 / count as f64);
        Ok((0..=last).map(at).map(|point| DVec2::new(facing * point.x, point.y)).collect())
    }

    fn ellipse(&self) -> Result<Vec<DVec2>, Refused> {
        let (centre, major) = (self.point((10, 20))?, self.point((11, 21))?);
        let minor = major.perp() * self.number(40, None)? * self.facing()?;
        let (from, to) = (self.number(41, Some(0.0))?, self.number(42, Some(TAU))?);
        let sweep_rad = turn_from(to - from);
        let count = arc_steps(sweep_rad);
        let at = |step: usize| DVec2::from_angle(from + sweep_rad * step as f64 / count as f64);
        Ok((0..=count).map(at).map(|angle| centre + angle.x * major + angle.y * minor).collect())
    }

    /// Points of a spline by the rule of de Boor, on control points times their weights (Piegl & Tiller 1997, 4.2).
    fn spline(&self) -> Result<Vec<DVec2>, Refused> {
        self.facing()?;
        let controls = self.points((10, 20))?;
        if controls.is_empty() {
            let message = "a spline by fit points alone has no shape that is agreed upon";
            return self.refuse(message, "save it with control points");
        }
        let (knots, mut weights) = (self.numbers(40)?, self.numbers(41)?);
        if weights.is_empty() {
            weights.resize(controls.len(), 1.0);
        }
        let degree = self.number(71, None)?;
        let is_known = degree >= 1.0 && degree <= MOST_DEGREE as f64 && degree.fract() == 0.0;
        let degree = if is_known { degree as usize } else { 0 };
        let is_whole = is_known
            && controls.len() > degree
            && knots.len() == controls.len() + degree + 1
            && weights.len() == controls.len()
            && weights.iter().all(|&weight| weight > 0.0)
            && knots.windows(2).all(|pair| pair[0] <= pair[1]);
        if !is_whole {
            let message = format!(
                "degree, {} control points, {} weights and {} knots of the spline do not fit together",
                controls.len(),
                weights.len(),
                knots.len()
            );
            return self.refuse(message, "save the drawing again from CAD, or as a polyline");
        }
        let heavy: Vec<[f64; 3]> =
            controls.iter().zip(&weights).map(|(at, weight)| [at.x * weight, at.y * weight, *weight]).collect();
        let mut points = Vec::new();
        for span in degree..controls.len() {
            let [from, to] = [knots[span], knots[span + 1]];
            if to > from {
                let at = |step: usize| from + (to - from) * step as f64 / SPAN_POINTS as f64;
                points.extend((0..SPAN_POINTS).map(|step| de_boor(&heavy, &knots, degree, span, at(step))));
            }
        }
        let last = (degree..controls.len()).rev().find(|&span| knots[span + 1] > knots[span]);
        points.extend(last.map(|span| de_boor(&heavy, &knots, degree, span, knots[span + 1])));
        Ok(points)
    }
}

/// A point of a spline at `t` in the span from knot `span` on.
fn de_boor(heavy: &[[f64; 3]], knots: &[f64], degree: usize, span: usize, t: f64) -> DVec2 {
    let mut row = heavy[span - degree..=span].to_vec();
    for level in 1..=degree {
        for j in (level..=degree).rev() {
            let from = knots[span - degree + j];
            let share = (t - from) / (knots[span + 1 + j - level] - from);
            row[j] = std::array::from_fn(|axis| (1.0 - share) * row[j - 1][axis] + share * row[j][axis]);
        }
    }
    let [x, y, weight] = row[degree];
    DVec2::new(x, y) / weight
}

/// An angle as a turn counter-clockwise, above 0 and at most 2 pi.
fn turn_from(angle_rad: f64) -> f64 {
    let turn = angle_rad.rem_euclid(TAU);
    if turn < 1e-12 { TAU } else { turn }
}

/// Steps of an arc, so many that no step is longer than [`STEP_RAD`], and eight at least.
fn arc_steps(sweep_rad: f64) -> usize {
    ((sweep_rad.abs() / STEP_RAD).ceil() as usize).max(8)
}
