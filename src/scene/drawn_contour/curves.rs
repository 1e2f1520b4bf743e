//! Curves of a drawing as points: each entity that is one, and its kind's own formula.

use super::{ContourPiece, DxfEntity, DxfGroup, Refused, STEP_RAD};
use glam::DVec2;
use std::f64::consts::TAU;

/// Points of a span between two knots of a spline.
const SPAN_POINTS: usize = 32;
/// Largest degree of a spline.
const MOST_DEGREE: usize = 25;

impl DxfEntity<'_, '_> {
    /// The curve that the entity is; none of texts, dimensions and points.
    pub(super) fn piece(&self) -> Result<Option<ContourPiece>, Refused> {
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
