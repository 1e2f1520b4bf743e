//! A wish for a motion as points of a pitch curve.
//!
//! In: angles psi of the mate at angles phi of this gear over one turn, both ends included. Out: polar points of the
//! curve that gives this motion at a fixed distance C of the axes, with psi' = d psi / d phi:
//!
//! ```text
//! r = C psi' / (psi' + 1) of an external gear, r = C psi' / (psi' - 1) of a ring
//! ```
//!
//! What psi has beside its mean slope is periodic: a cubic spline goes through it, whose slope at the rows is psi'. C
//! follows from the perimeter.

use gearcut_core::gear::GearKind;
use gearcut_core::math::periodic_spline::PeriodicSpline;
use gearcut_core::units::TURN_RAD;

/// A turn may be missed by this, deg: digits of a table.
const TURN_DEG: f64 = 1e-6;
/// Samples of the perimeter, and least rows.
const SAMPLES: u32 = 4096;
const LEAST_ROWS: usize = 9;

/// The gear that is to move so.
#[derive(Debug, Clone, Copy)]
pub(super) struct MovedGear {
    /// External or a ring.
    pub kind: GearKind,
    /// Pitches of all its teeth, mm.
    pub perimeter_mm: f64,
    /// Whether it has teeth all round.
    pub is_closed: bool,
}

/// Polar points (deg, mm) of the curve for rows (phi, psi) in deg, phi rising; what is wrong, with a way out.
pub(super) fn points(rows_deg: &[[f64; 2]], gear: MovedGear) -> Result<Vec<[f64; 2]>, (String, &'static str)> {
    let whole = "give the motion over one turn of this gear, both ends included, a row every 5 deg or less";
    if !gear.is_closed {
        let problem = "a motion holds over the whole turn, and gear.sector_deg has teeth over a part of it";
        return Err((problem.to_owned(), "give radii over the sector, or a ratio_formula"));
    }
    if rows_deg.len() < LEAST_ROWS {
        return Err((format!("{} rows are too few for a motion", rows_deg.len()), whole));
    }
    let ([first, last], count) = ([rows_deg[0], rows_deg[rows_deg.len() - 1]], rows_deg.len() - 1);
    if (last[0] - first[0] - 360.0).abs() > TURN_DEG {
        return Err((format!("the rows reach from {} to {} deg, not over one turn", first[0], last[0]), whole));
    }
    let turned = "the mate turns on all the time, by positive angles, its own sense of turning left aside";
    if let Some(pair) = rows_deg.windows(2).find(|pair| pair[1][1] <= pair[0][1]) {
        return Err((format!("the mate stops or turns back between {} and {} deg", pair[0][0], pair[1][0]), turned));
    }
    let mean_slope = (last[1] - first[1]) / 360.0;
    let beside_deg = |row: &[f64; 2]| row[1] - first[1] - mean_slope * (row[0] - first[0]);
    let lowest_deg = rows_deg.iter().map(beside_deg).fold(0.0, f64::min);
    // Splines are of positive numbers: what is beside the slope, over its lowest place by a turn.
    let periodic: Vec<[f64; 2]> = rows_deg[..count]
        .iter()
        .map(|row| [row[0].to_radians(), (beside_deg(row) - lowest_deg).to_radians() + TURN_RAD])
        .collect();
    let (spline, scale) = PeriodicSpline::new(&periodic, None).map_err(|refusal| (refusal.problem, whole))?;
    let radius = |[phi_rad, _]: [f64; 2]| {
        let slope = mean_slope + scale * spline.at(phi_rad).derivative(1);
        let below = match gear.kind {
            GearKind::External => slope + 1.0,
            GearKind::Internal => slope - 1.0,
        };
        if slope > 0.0 && below > 0.0 {
            return Ok([phi_rad, slope / below]);
        }
        let at_deg = phi_rad.to_degrees();
        Err(match gear.kind {
            GearKind::External => (format!("the mate stops or turns back near {at_deg:.3} deg"), turned),
            GearKind::Internal => (
                format!("the gear in the ring makes {slope:.4} turns to one of the ring at {at_deg:.3} deg"),
                "a gear in a ring turns faster than it: let its angle grow by more than the ring's everywhere",
            ),
        })
    };
    let radii: Vec<[f64; 2]> = periodic.iter().copied().map(radius).collect::<Result<_, _>>()?;
    let (curve, mean) = PeriodicSpline::new(&radii, None).map_err(|refusal| (refusal.problem, whole))?;
    let length = |i: u32| {
        let r = curve.at(TURN_RAD * f64::from(i) / f64::from(SAMPLES));
        r.value().hypot(r.derivative(1))
    };
    let perimeter = mean * TURN_RAD / f64::from(SAMPLES) * (0..SAMPLES).map(length).sum::<f64>();
    let centre_mm = gear.perimeter_mm / perimeter;
    Ok(rows_deg.iter().zip(radii).map(|(row, [_, r])| [row[0], centre_mm * r]).collect())
}
