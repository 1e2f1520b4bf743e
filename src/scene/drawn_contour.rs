//! The contour of a drawing, closed or open: text of a DXF file in, its points in mm out.
//!
//! Polylines with bulges, lines, arcs, circles, ellipses and splines (NURBS) of the model space are joined end to end.
//! Where curves lie on the contour's layer, others are not looked at. What cannot be read for certain is refused:
//! drawings without a unit, gaps, several contours, blocks, planes other than xy.
//!
//! Road not taken: the crate `dxf` brings `chrono`, `uuid` and a minute of compilation for seven kinds of curves.

mod curves;

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

/// Points of all curves of a drawing, mm, on the layer of this name or on its only one; `name` is the file's, for
/// messages. Vertices of lines are points, and so are places on arcs and splines.
pub(crate) fn points_of_curves(name: &str, text: &str, layer: Option<&str>) -> Result<Vec<DVec2>, Refused> {
    let drawing = DxfText { name, text, layer: "" };
    let mut pieces = drawing.pieces_mm()?;
    let mut layers: Vec<String> = pieces.iter().map(|piece| piece.layer.clone()).collect();
    layers.sort();
    layers.dedup();
    let names = layers.join(", ");
    match layer {
        None if layers.len() > 1 => {
            let way_out = "name the layer of the measured points with --layer";
            return drawing.refuse_all(format!("the drawing has curves on several layers: {names}"), way_out);
        }
        Some(layer) => pieces.retain(|piece| piece.layer.eq_ignore_ascii_case(layer)),
        None => {}
    }
    if pieces.is_empty() {
        let message = layer.map_or("the drawing has no curve in model space".to_owned(), |layer| {
            format!("the drawing has no curve on the layer {layer}; it has {names}")
        });
        return drawing.refuse_all(message, "save the measured section as polylines, lines, arcs or splines");
    }
    let mut points: Vec<DVec2> = pieces.into_iter().flat_map(|piece| piece.points).collect();
    points.dedup_by(|a, b| a.distance(*b) <= JOINED_MM);
    Ok(points)
}

impl<'a> DxfText<'a> {
    fn contour(&self, is_closed: bool) -> Result<DrawnContour, Refused> {
        let mut pieces = self.pieces_mm()?;
        let is_on_layer = |piece: &ContourPiece| piece.layer.eq_ignore_ascii_case(self.layer);
        if pieces.iter().any(is_on_layer) {
            pieces.retain(is_on_layer);
        }
        self.joined(pieces, is_closed)
    }

    /// Curves of the model space, lengths in mm.
    fn pieces_mm(&self) -> Result<Vec<ContourPiece>, Refused> {
        let groups = self.groups()?;
        let unit_mm = self.unit_mm(&groups)?;
        let mut pieces = self.pieces(&groups)?;
        for point in pieces.iter_mut().flat_map(|piece| &mut piece.points) {
            *point *= unit_mm;
        }
        Ok(pieces)
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
