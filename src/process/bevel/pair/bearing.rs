//! The bearing on the gear's flank, as it is seen on a gear that was rolled with marking compound.
//!
//! In: a rolled side. Out: a drawing to scale, the flank in the plane through the gear's axis: along the tooth, toe to
//! the left, and up over the pitch cone. Filled is what comes nearer than the compound is thick while the pair of teeth
//! carries: all its ellipses from place to place of the path, as far as the flank goes.

use super::RolledSide;
use super::findings::words;
use crate::number_text::significant;
use gearcut_core::bevel::contact::Contact;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Rows of the flank's outline.
const OUTLINE_ROWS: usize = 24;
/// Corners of an ellipse.
const CORNERS: usize = 72;
/// Half axes beyond this many faces are drawn as long as this: flanks that touch along a line.
const MOST_FACES: f64 = 4.0;
/// Width of the drawing and the space round the flank, px.
const WIDTH_PX: f64 = 900.0;
const MARGIN_PX: f64 = 70.0;

/// The drawing as an SVG file.
pub fn svg(side: &RolledSide, marking_mm: f64) -> String {
    let outline = outline(side);
    let (low, high) = outline
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), place| (low.min(*place), high.max(*place)));
    let scale = (WIDTH_PX - 2.0 * MARGIN_PX) / (high.x - low.x);
    let height_px = scale * (high.y - low.y) + 2.0 * MARGIN_PX;
    let px = |place: DVec2| {
        DVec2::new(MARGIN_PX + scale * (place.x - low.x), height_px - MARGIN_PX - scale * (place.y - low.y))
    };
    let points = |places: &[DVec2]| {
        let text = |place: &DVec2| format!("{:.1},{:.1}", px(*place).x, px(*place).y);
        places.iter().map(text).collect::<Vec<_>>().join(" ")
    };
    let title =
        format!("Bearing on the gear's {} flank, marking {} µm", words(side), significant(UM_PER_MM * marking_mm, 3));
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH_PX} {height_px:.0}\" width=\"{WIDTH_PX}\" \
         height=\"{height_px:.0}\" font-family=\"DejaVu Sans, Noto Sans, Helvetica, Arial, sans-serif\" \
         font-size=\"14\">\n<title>{title}</title>\n<rect width=\"{WIDTH_PX}\" height=\"{height_px:.0}\" \
         fill=\"#ffffff\"/>\n<text x=\"{MARGIN_PX}\" y=\"26\" font-weight=\"bold\">{title}</text>\n\
         <defs><clipPath id=\"flank\"><polygon points=\"{flank}\"/></clipPath></defs>\n\
         <polygon points=\"{flank}\" fill=\"#eef1f4\"/>\n<g clip-path=\"url(#flank)\" fill=\"#c77f1e\" \
         stroke=\"#c77f1e\" stroke-width=\"0.6\">\n",
        flank = points(&outline)
    );
    let carrying = carrying(side);
    let most_mm = MOST_FACES * side.pair.gear.blank.face_width_mm;
    let ellipses: Vec<Option<Vec<DVec2>>> =
        carrying.iter().map(|met| met.and_then(|contact| ellipse(contact, most_mm))).collect();
    for pair in ellipses.windows(2) {
        let corners: Vec<DVec2> = pair.iter().flatten().flatten().copied().collect();
        if !corners.is_empty() {
            let _ = writeln!(out, "<polygon points=\"{}\"/>", points(&hull(corners)));
        }
    }
    let _ = writeln!(out, "</g>\n<polygon points=\"{}\" fill=\"none\" stroke=\"#333333\"/>", points(&outline));
    for run in carrying.split(Option::is_none).filter(|run| run.len() > 1) {
        let path: Vec<DVec2> = run.iter().flatten().map(|contact| DVec2::from(contact.place_mm)).collect();
        let _ = writeln!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"#1f4e79\" stroke-width=\"1.6\"/>",
            points(&path)
        );
    }
    for (x_px, anchor, words) in
        [(MARGIN_PX, "start", "toe"), (0.5 * WIDTH_PX, "middle", "root below"), (WIDTH_PX - MARGIN_PX, "end", "heel")]
    {
        let y_px = height_px - 0.4 * MARGIN_PX;
        let _ = writeln!(
            out,
            "<text x=\"{x_px}\" y=\"{y_px:.0}\" text-anchor=\"{anchor}\" fill=\"#555555\">{words}</text>"
        );
    }
    let [from_px, to_px] = [WIDTH_PX - MARGIN_PX - 10.0 * scale, WIDTH_PX - MARGIN_PX];
    let _ = writeln!(
        out,
        "<line x1=\"{from_px:.1}\" y1=\"40\" x2=\"{to_px:.1}\" y2=\"40\" stroke=\"#000000\" stroke-width=\"3\"/>\n\
         <text x=\"{to_px:.1}\" y=\"32\" text-anchor=\"end\">10 mm</text>\n</svg>"
    );
    out
}

/// Contacts of one pair of teeth in order, where it carries.
fn carrying(side: &RolledSide) -> Vec<Option<&Contact>> {
    let carries = |contact: &Contact| side.running.carrying.iter().any(|(_, carrying, _)| carrying == contact);
    let of = side.running.teeth.iter().map(|(_, met)| met.as_ref().map(|(contact, _)| contact));
    of.map(|contact| contact.filter(|contact| carries(contact))).collect()
}

/// The flank's edge: form line, heel, tip, toe; along the tooth and over the pitch cone, mm.
fn outline(side: &RolledSide) -> Vec<DVec2> {
    let gear = &side.pair.gear;
    let half_mm = 0.5 * gear.blank.face_width_mm;
    let along_mm = |i: usize| half_mm * (2.0 * i as f64 / (OUTLINE_ROWS - 1) as f64 - 1.0);
    let ends = |i: usize| {
        let row = gear.row(along_mm(i)).ok()?;
        Some([row.form_height_mm, row.tip_height_mm].map(|height_mm| DVec2::new(along_mm(i), height_mm)))
    };
    let rows: Vec<[DVec2; 2]> = (0..OUTLINE_ROWS).filter_map(ends).collect();
    rows.iter().map(|row| row[0]).chain(rows.iter().rev().map(|row| row[1])).collect()
}

/// Corners of the ellipse of a contact; none where it stands at an edge.
fn ellipse(contact: &Contact, most_mm: f64) -> Option<Vec<DVec2>> {
    let ellipse = contact.ellipse?;
    let [long_mm, short_mm] = ellipse.half_axes_mm.map(|half_mm| half_mm.min(most_mm));
    let [long, short] = ellipse.directions;
    let corner = |i: usize| {
        let (sin, cos) = (TAU * i as f64 / CORNERS as f64).sin_cos();
        let at = |k: usize| contact.place_mm[k] + long_mm * cos * long[k] + short_mm * sin * short[k];
        DVec2::new(at(0), at(1))
    };
    Some((0..CORNERS).map(corner).collect())
}

/// Convex hull, counter-clockwise (monotone chain).
fn hull(mut places: Vec<DVec2>) -> Vec<DVec2> {
    places.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let chain = |places: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for place in places {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(place - a) <= 0.0
            {
                chain.pop();
            }
            chain.push(place);
        }
        chain.pop();
        chain
    };
    let mut around = chain(&mut places.iter().copied());
    around.extend(chain(&mut places.iter().rev().copied()));
    around
}

#[cfg(test)]
mod tests {
    use super::hull;
    use glam::DVec2;

    #[test]
    fn a_hull_keeps_corners_alone() {
        let places = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.5], [2.0, 2.0], [0.0, 2.0], [1.0, 0.0]].map(DVec2::from);
        assert_eq!(hull(places.to_vec()), [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(DVec2::from));
    }
}
