//! Roughness of the cutter's edges: heights along a flank, out of the cutter's tooth.
//!
//! In: the smooth edge and what the scene says of its roughness. Out: edges that cut, tooth by tooth. Every stroke
//! copies the part of its edge that touches the flank; where several strokes reach a place the one that goes deepest
//! leaves its mark, so that many strokes show the parts that stand out and not the scratches.
//!
//! Two laws. A **spectrum**: on each flank of each tooth a normal process of the autocovariance Rq^2 exp(-(s / l)^2),
//! made as the moving average of independent numbers with a Gaussian weight (Garcia and Stoll, *Monte Carlo calculation
//! for electromagnetic-wave scattering from random rough surfaces*, 1984): white numbers weighted with exp(-2 (s /
//! l)^2) have that autocovariance. Its slopes have the standard deviation sqrt(2) Rq / l. A **measured profile**: a
//! cubic through its points, the same on all flanks.
//!
//! The roughness fades over the last [`FADE_MM`] of a flank, so that the edge stays closed where tip corner and base
//! begin. Tip and corners are smooth.
//!
//! Road not taken: an edge of straight pieces. Passes are bounded segment by segment; a flank would have a thousand.

use crate::process::shaping::scene::model::EdgeRoughness;
use crate::random::Draws;
use crate::regular_file;
use gearcut_core::error::Refusal;
use gearcut_core::tool::blade_edges::BladeEdges;
use gearcut_core::tool::edge::{Edge, Segment, SegmentName};
use std::path::Path;

/// Length over which roughness fades at the ends of a flank, mm: a choice, a hundredth of a tooth of module 3.
pub const FADE_MM: f64 = 0.05;
/// Steepest edge: a ray that meets a flank within 60 degrees of its normal then enters it once.
const STEEPEST: f64 = 0.5;
/// Cells in a correlation length. The cubic through them leaves the process by some 4e-4 Rq: h^4 / 384 times its fourth
/// derivative, whose standard deviation is sqrt(1680) Rq / l^4.
const CELLS_PER_LENGTH: f64 = 4.0;
/// Most cells of a flank, which take 32 bytes each.
const MOST_CELLS: f64 = 8192.0;
/// White numbers in a correlation length: their sum of weights is even to 1e-8.
const DRAWS_PER_LENGTH: f64 = 4.0;
/// The weight ends this many white numbers away, at three correlation lengths, where it is 1.5e-8.
const REACH: i64 = 12;
/// Number of the source of random numbers: axes have those from 0 on.
const SOURCE: u32 = 1000;
/// Largest table read: a million points.
const MOST_BYTES: u64 = 32 << 20;

/// The edges of all teeth, or the one that they share.
///
/// # Errors
/// A table that cannot be read or is shorter than a flank, an edge that is too steep or too fine.
pub fn rough_edges(of: &EdgeRoughness, smooth: &Edge, teeth: u32) -> Result<BladeEdges, Refusal> {
    let length_mm = flank_length_mm(smooth);
    match of {
        EdgeRoughness::Spectrum { rq_mm, correlation_mm, seed } => {
            let (rq_mm, length) = (*rq_mm, *correlation_mm);
            let key = "correlation_length_um";
            let cell_mm = cell_mm(length / CELLS_PER_LENGTH, length_mm, key)?;
            let draws = Draws::new(*seed, SOURCE);
            let last = (length_mm / length * DRAWS_PER_LENGTH).ceil() as i64 + REACH;
            let edge = |tooth: u32| {
                let white = |side: i64| -> Vec<f64> {
                    (-REACH..=last).map(|place| draws.normal([2 * i64::from(tooth) + side, place])).collect()
                };
                let white = [white(0), white(1)];
                rough_edge(smooth, length_mm, cell_mm, &|side, arc_mm| {
                    let [value, slope] = spectrum(arc_mm / length, &white[side]);
                    [rq_mm * value, rq_mm * slope / length]
                })
            };
            let edges = (0..teeth).map(edge).collect();
            gentle(BladeEdges::in_turn(edges), key)
        }
        EdgeRoughness::Profile(path) => {
            let points = read(path)?;
            let key = "profile";
            let [first, last] = [points[0][0], points[points.len() - 1][0]];
            if first > 0.0 || last < length_mm {
                let problem =
                    format!("the profile goes from {first} to {last} mm, the flank from 0 to {length_mm:.4} mm");
                return Err(refusal(key, problem, "measure the whole flank, from the tip corner to the root"));
            }
            let cell_mm = cell_mm(0.5 * (last - first) / (points.len() - 1) as f64, length_mm, key)?;
            let edge = rough_edge(smooth, length_mm, cell_mm, &|_, arc_mm| measured(&points, arc_mm));
            gentle(BladeEdges::shared(edge), key)
        }
    }
}

fn refusal(key: &str, problem: String, way_out: &str) -> Refusal {
    Refusal::new(&format!("tool.shaper_cutter.edge_roughness.{key}"), problem, way_out)
}

/// Width of cells, if a flank does not take too many.
fn cell_mm(cell_mm: f64, length_mm: f64, key: &str) -> Result<f64, Refusal> {
    if length_mm / cell_mm <= MOST_CELLS {
        return Ok(cell_mm);
    }
    let problem = format!(
        "a flank of {length_mm:.3} mm would take {:.0} cells, more than {MOST_CELLS}",
        (length_mm / cell_mm).ceil()
    );
    Err(refusal(key, problem, "make the roughness coarser"))
}

/// Refuses edges that a ray may enter twice.
fn gentle(edges: BladeEdges, key: &str) -> Result<BladeEdges, Refusal> {
    let rough = edges.segments().iter().filter_map(|segment| segment.smooth.as_ref());
    let steepest = rough.map(|smooth| smooth.steepness).fold(0.0, f64::max);
    if steepest <= STEEPEST {
        return Ok(edges);
    }
    let problem = format!("the edge climbs with a slope of {steepest:.2}, which is no smoother than a thread");
    Err(refusal(key, problem, "take a smaller height or a longer correlation length: slopes up to 0.5 are cut"))
}

/// Length of one flank, mm: both are alike.
fn flank_length_mm(edge: &Edge) -> f64 {
    let left = edge.segments.iter().filter(|segment| segment.name == SegmentName::FlankLeft);
    left.map(Segment::length_mm).sum()
}

/// One tooth's edge; `height` gives that of its roughness on a flank (0 the left one, 1 the right one) at an arc from
/// the tip corner, mm, and its derivative.
fn rough_edge(smooth: &Edge, length_mm: f64, cell_mm: f64, height: &impl Fn(usize, f64) -> [f64; 2]) -> Edge {
    // Left flanks follow the chain from the tip to the root, right ones from the root to the tip.
    let (mut left_mm, mut right_mm) = (0.0, length_mm);
    let segments = smooth.segments.iter().map(|segment| {
        let faded = |side: usize, arc_mm: f64| {
            let ([value, slope], [share, rate]) = (height(side, arc_mm), fade(arc_mm, length_mm));
            [value * share, slope * share + value * rate]
        };
        match segment.name {
            SegmentName::FlankLeft => {
                let start_mm = left_mm;
                left_mm += segment.length_mm();
                segment.roughened(cell_mm, |arc_mm| faded(0, start_mm + arc_mm))
            }
            SegmentName::FlankRight => {
                let start_mm = right_mm;
                right_mm -= segment.length_mm();
                segment.roughened(cell_mm, |arc_mm| {
                    let [value, slope] = faded(1, start_mm - arc_mm);
                    [value, -slope]
                })
            }
            _ => segment.clone(),
        }
    });
    Edge::new(segments.collect())
}

/// Share of the roughness that is left beside the ends of a flank, and its derivative per mm: 3 t^2 - 2 t^3.
fn fade(arc_mm: f64, length_mm: f64) -> [f64; 2] {
    let (from_end, sign) = if arc_mm < 0.5 * length_mm { (arc_mm, 1.0) } else { (length_mm - arc_mm, -1.0) };
    let t = (from_end / FADE_MM).clamp(0.0, 1.0);
    [t * t * (3.0 - 2.0 * t), sign * 6.0 * t * (1.0 - t) / FADE_MM]
}

/// The process of variance 1 at a place in correlation lengths, from 0 on, and its derivative; `white` are its numbers,
/// of which the one with the index [`REACH`] stands at place 0.
fn spectrum(place: f64, white: &[f64]) -> [f64; 2] {
    // Beside the ends of a flank, where the roughness has faded, a place may lie a rounding outside.
    let nearest = (place * DRAWS_PER_LENGTH).round().max(0.0) as usize;
    let (mut value, mut slope, mut squares) = (0.0, 0.0, 0.0);
    for (index, &number) in white.iter().enumerate().skip(nearest).take(2 * REACH as usize + 1) {
        let apart = place - (index as i64 - REACH) as f64 / DRAWS_PER_LENGTH;
        let weight = (-2.0 * apart * apart).exp();
        value += weight * number;
        slope -= 4.0 * apart * weight * number;
        squares += weight * weight;
    }
    [value, slope].map(|sum| sum / squares.sqrt())
}

/// The cubic through a table's points, with the tangents of their neighbours' chords (Catmull and Rom 1974).
fn measured(points: &[[f64; 2]], arc_mm: f64) -> [f64; 2] {
    let last = points.len() - 1;
    let index = points.partition_point(|point| point[0] <= arc_mm).clamp(1, last) - 1;
    let tangent = |at: usize| {
        let (before, after) = (points[at.saturating_sub(1)], points[(at + 1).min(last)]);
        (after[1] - before[1]) / (after[0] - before[0])
    };
    let ([from, a], [to, b]) = (points[index], points[index + 1]);
    let width = to - from;
    let (t, p, q) = ((arc_mm - from) / width, tangent(index) * width, tangent(index + 1) * width);
    let (square, cube) = (3.0 * (b - a) - 2.0 * p - q, p + q - 2.0 * (b - a));
    [a + t * (p + t * (square + t * cube)), (p + t * (2.0 * square + t * 3.0 * cube)) / width]
}

/// Points of a measured profile, mm, in the order of their positions.
fn read(path: &Path) -> Result<Vec<[f64; 2]>, Refusal> {
    let wrong = |why: String| {
        let way_out = "write a table with the header position_um,height_um and two numbers in each line";
        refusal("profile", format!("cannot read {}: {why}", path.display()), way_out)
    };
    let bytes = regular_file::read(path, MOST_BYTES).map_err(&wrong)?;
    let mut table = csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(&bytes[..]);
    let header = table.headers().map_err(|error| wrong(error.to_string()))?.clone();
    let unit = |column: usize, name: &str| {
        let unit = header.get(column).and_then(|text| text.strip_prefix(name));
        match unit {
            Some("_mm") => Ok(1.0),
            Some("_um") => Ok(1e-3),
            Some("_nm") => Ok(1e-6),
            _ => Err(wrong(format!("column {} is not {name}_um, {name}_mm or {name}_nm", column + 1))),
        }
    };
    let units_mm = [unit(0, "position")?, unit(1, "height")?];
    let mut points: Vec<[f64; 2]> = Vec::new();
    for record in table.records() {
        let record = record.map_err(|error| wrong(error.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |column: usize| {
            let number =
                record.get(column).and_then(|text| text.parse::<f64>().ok()).filter(|number| number.is_finite());
            number.ok_or_else(|| wrong(format!("column {} of line {line} is no number", column + 1)))
        };
        let point = [number(0)? * units_mm[0], number(1)? * units_mm[1]];
        if points.last().is_some_and(|last| point[0] <= last[0]) {
            return Err(wrong(format!("the position in line {line} is not beyond the one before")));
        }
        points.push(point);
    }
    if points.len() < 2 {
        return Err(wrong("it has fewer than two points".to_owned()));
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Variance 1, autocovariance exp(-d^2), slopes of the standard deviation sqrt(2): 40,000 places that share no
    /// number; four times the scatter of products is 2.9 %.
    #[test]
    fn a_spectrum_has_its_autocovariance_and_slopes() {
        let draws = Draws::new(3, SOURCE);
        let count = 40_000;
        let white: Vec<f64> = (0..i64::from(count) * 40 + 100).map(|index| draws.normal([0, index])).collect();
        for (apart, offset) in [(0.0, 0.0), (0.0, 0.11), (0.3, 0.05), (1.0, 0.2), (2.0, 0.0)] {
            let (mut product, mut square) = (0.0, 0.0);
            for index in 0..count {
                let place = f64::from(index) * 10.0 + offset;
                let at = |place: f64| spectrum(place, &white);
                let ([here, slope], [there, _]) = (at(place), at(place + apart));
                product += here * there / f64::from(count);
                square += slope * slope / f64::from(count);
                if index < 50 {
                    let rise = (at(place + 1e-5)[0] - at(place - 1e-5)[0]) / 2e-5;
                    assert!((rise - slope).abs() < 1e-7 + 1e-4 * slope.abs(), "derivative at {place}");
                }
            }
            let expected = f64::exp(-apart * apart);
            assert!((product - expected).abs() < 0.029, "{apart} lengths apart: {product} for {expected}");
            assert!((square - 2.0).abs() < 2.0 * 0.029, "slopes: {square}");
        }
    }

    #[test]
    fn a_measured_profile_passes_through_its_points_and_keeps_a_parabola() {
        let points: Vec<[f64; 2]> = (0..20).map(|i| f64::from(i) * 0.01).map(|s| [s, s * s - 0.1 * s]).collect();
        for i in 2..18 {
            assert_eq!(measured(&points, points[i][0])[0], points[i][1]);
            let s = points[i][0] + 0.003;
            let [value, slope] = measured(&points, s);
            assert!((value - (s * s - 0.1 * s)).abs() < 1e-15 && (slope - (2.0 * s - 0.1)).abs() < 1e-13);
        }
    }

    #[test]
    fn roughness_fades_at_the_ends_of_a_flank() {
        assert_eq!(fade(0.0, 6.0)[0], 0.0);
        assert_eq!(fade(6.0, 6.0)[0], 0.0);
        assert_eq!(fade(3.0, 6.0), [1.0, 0.0]);
        for arc_mm in [0.01, 0.03, 5.97, 5.99] {
            let rise = (fade(arc_mm + 1e-7, 6.0)[0] - fade(arc_mm - 1e-7, 6.0)[0]) / 2e-7;
            assert!((rise - fade(arc_mm, 6.0)[1]).abs() < 1e-5);
        }
    }
}
