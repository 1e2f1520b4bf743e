//! The place of the gear's flank that touches first.
//!
//! In: angles of the pinion and, about, of the gear. Out: the extremum over the flank of the gear's angle at which a
//! point touches. A search in eight directions with steps that are halved finds it inside the flank. At an edge such a
//! search stops too early: where an edge of the pinion runs aslant over the gear's flank, each of its directions leads
//! off the pinion or away from contact. From there on places along the tooth are compared by the first contact over
//! their height: in one dimension an edge is an end, and no search stops beside it.

use super::{BevelPair, BevelTouch, TouchStart};
use crate::error::NotConverged;
use glam::DVec2;

/// Places along the tooth and over its height from which the first contact is sought.
const PLACES: [usize; 2] = [13, 7];
/// Steps of the search along the tooth and over its height end below this, mm: a gap of 1 um per mm^2 is then found to
/// a hundred-millionth of a micrometre.
const PLACE_MM: f64 = 1e-4;
/// The same over the height at an edge, mm: there the gap grows by some hundredths of that.
const EDGE_MM: f64 = 1e-5;
/// First steps from a place at an edge, mm.
const EDGE_STEP_MM: f64 = 0.25;
/// Share of the longer part of a bracket at which it is divided.
const GOLDEN: f64 = 0.381_966_011_250_105;

/// The first contact.
pub(super) struct First {
    /// Along the gear's tooth and over its height, mm.
    pub place: DVec2,
    pub touch: BevelTouch,
    /// +1 where a growing angle of the gear closes gaps.
    pub turn: f64,
    /// Whether an edge of a flank ends the search, not the form of both.
    pub at_edge: bool,
}

/// A place and how it touches.
type Touching = (DVec2, BevelTouch);

impl BevelPair {
    /// Heights of the gear's form point and tip at a place along the tooth, mm; none beyond its ends.
    fn heights_mm(&self, along_mm: f64) -> Option<[f64; 2]> {
        if along_mm.abs() > 0.5 * self.gear.blank.face_width_mm {
            return None;
        }
        let row = self.gear.row(along_mm).ok()?;
        Some([row.form_height_mm, row.tip_height_mm])
    }

    /// The first contact near an angle of the gear. `None`: no places touch.
    pub(super) fn first(&self, pinion_rad: f64, start_rad: f64) -> Result<Option<First>, NotConverged> {
        let half_mm = 0.5 * self.gear.blank.face_width_mm;
        let far = TouchStart { gear_rad: start_rad, coordinates: None };
        let mut best: Option<Touching> = None;
        let mut turn = 0.0;
        for i in 0..PLACES[0] {
            let along_mm = half_mm * (2.0 * i as f64 / (PLACES[0] - 1) as f64 - 1.0);
            let Some([low_mm, high_mm]) = self.heights_mm(along_mm) else { continue };
            for j in 0..PLACES[1] {
                let height_mm = low_mm + (high_mm - low_mm) * j as f64 / (PLACES[1] - 1) as f64;
                let place = DVec2::new(along_mm, height_mm);
                let Some(found) = self.touch(place, pinion_rad, far)? else { continue };
                if turn == 0.0 {
                    turn = found.closing_mm.signum();
                }
                if best.as_ref().is_none_or(|(_, known)| turn * (found.gear_rad - known.gear_rad) < 0.0) {
                    best = Some((place, found));
                }
            }
        }
        let Some((mut place, mut touch)) = best else { return Ok(None) };
        let mut step = DVec2::new(2.0 * half_mm / (PLACES[0] - 1) as f64, 1.0);
        // Whether the flank ends at a place is found last: few places touch earlier.
        let on_flank = |place: DVec2| {
            self.heights_mm(place.x).is_some_and(|[low_mm, high_mm]| place.y >= low_mm && place.y <= high_mm)
        };
        let mut at_edge = false;
        while step.max_element() > PLACE_MM {
            let around = place;
            at_edge = false;
            for (x, y) in
                [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)]
            {
                let beside = around + step * DVec2::new(x, y);
                // Off the pinion, or where the roll generates nothing of the gear.
                let Some(found) = self.touch(beside, pinion_rad, touch.near())? else {
                    at_edge = true;
                    continue;
                };
                if turn * (found.gear_rad - touch.gear_rad) < 0.0 {
                    if on_flank(beside) {
                        (place, touch) = (beside, found);
                    } else {
                        at_edge = true;
                    }
                }
            }
            if place == around {
                step *= 0.5;
            }
        }
        if at_edge {
            (place, touch) = self.first_at_edge(pinion_rad, turn, (place, touch))?;
        }
        Ok(Some(First { place, touch, turn, at_edge }))
    }

    /// The first contact where an edge ends the search in all directions at a place.
    fn first_at_edge(&self, pinion_rad: f64, turn: f64, from: Touching) -> Result<Touching, NotConverged> {
        let earlier = |found: &Touching, known: &Touching| turn * (found.1.gear_rad - known.1.gear_rad) < 0.0;
        let start = from.1.near();
        // The first contact over the height at a place along the tooth.
        let in_row = |along_mm: f64, near_mm: f64| -> Result<Option<Touching>, NotConverged> {
            let Some([low_mm, high_mm]) = self.heights_mm(along_mm) else { return Ok(None) };
            let at = |height_mm: f64| -> Result<Option<Touching>, NotConverged> {
                if height_mm < low_mm || height_mm > high_mm {
                    return Ok(None);
                }
                let place = DVec2::new(along_mm, height_mm);
                Ok(self.touch(place, pinion_rad, start)?.map(|found| (place, found)))
            };
            let mut known = at(near_mm.clamp(low_mm, high_mm))?;
            if known.is_none() {
                // The pinion's edge lies aslant.
                for j in 0..PLACES[1] {
                    let found = at(low_mm + (high_mm - low_mm) * j as f64 / (PLACES[1] - 1) as f64)?;
                    if let Some(found) = found
                        && known.as_ref().is_none_or(|known| earlier(&found, known))
                    {
                        known = Some(found);
                    }
                }
            }
            let Some(known) = known else { return Ok(None) };
            lowest((known.0.y, known), EDGE_MM, at, earlier).map(Some)
        };
        let (along_mm, height_mm) = (from.0.x, from.0.y);
        let known = in_row(along_mm, height_mm)?.unwrap_or(from);
        let near_mm = known.0.y;
        lowest((along_mm, known), PLACE_MM, |along_mm| in_row(along_mm, near_mm), earlier)
    }
}

/// The lowest value of a function with one valley, from a place with its value; `None` is beyond an end. The place is
/// found to `last`.
fn lowest<T>(
    (mut at, mut best): (f64, T),
    last: f64,
    mut value: impl FnMut(f64) -> Result<Option<T>, NotConverged>,
    lower: impl Fn(&T, &T) -> bool,
) -> Result<T, NotConverged> {
    let mut ends = [at - EDGE_STEP_MM, at + EDGE_STEP_MM];
    // Downhill with growing steps to one side or the other, until the valley is enclosed.
    for (side, sign) in [(0, -1.0), (1, 1.0)] {
        let (from, mut step) = (at, EDGE_STEP_MM);
        loop {
            ends[side] = at + sign * step;
            match value(ends[side])?.filter(|found| lower(found, &best)) {
                Some(found) => (ends[1 - side], at, best) = (at, ends[side], found),
                None => break,
            }
            step *= 2.0;
        }
        if at != from {
            break;
        }
    }
    while ends[1] - ends[0] > last {
        let side = usize::from(ends[1] - at > at - ends[0]);
        let beside = at + GOLDEN * (ends[side] - at);
        match value(beside)?.filter(|found| lower(found, &best)) {
            Some(found) => (ends[1 - side], at, best) = (at, beside, found),
            None => ends[side] = beside,
        }
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::lowest;

    /// Valleys inside, at either end, and with a start far off; each by its own closed form.
    #[test]
    fn the_lowest_place_is_found_inside_and_at_ends() {
        for (valley, [low, high]) in [(0.3, [-5.0, 5.0]), (-7.0, [-5.0, 5.0]), (9.0, [-2.0, 4.0]), (4.7, [-1.0, 30.0])]
        {
            let value = |at: f64| Ok((at >= low && at <= high).then(|| (at, (at - valley).abs())));
            let found = lowest((0.0, (0.0, f64::abs(valley))), 1e-6, value, |a, b| a.1 < b.1);
            let (at, _) = found.expect("no search fails");
            assert!((at - f64::clamp(valley, low, high)).abs() < 1e-6, "{at} for {valley} in {low} to {high}");
        }
    }
}
