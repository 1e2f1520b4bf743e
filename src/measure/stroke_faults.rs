//! Strokes that are missing or were made twice, told from what every stroke removed.
//!
//! In: volume removed by every pass. Out: strokes that stand alone. With an even feed the volume changes slowly from stroke to stroke, so a stroke that removed far more than the two before
//! and the two after it stands where another one is missing, and one that removed next to nothing was either made twice (the next one cuts as usual) or did not
//! cut (the next one takes its chip as well).
//!
//! The two families of rays are judged apart, and both must agree. A thin chip that lies along the rays of one family is met as a whole by one ray or by none, which lets that family's
//! figure jump, but never both: over three turns of the elliptical gear at 360, 1,440 and 4,200 strokes no stroke stands out by more than 1.14 or less than 0.81 in both.
//! The surface alone would not do: at 4,200 strokes the facet of a missing stroke is narrower than the rays' distance.

/// A stroke that removed more than this times the largest of its neighbours, by both families, follows a gap.
const ALONE_HIGH: f64 = 1.5;
/// One that removed less than this times the smallest of its neighbours did not cut.
const ALONE_LOW: f64 = 0.3;
/// Strokes on either side that a stroke is compared with: two, so that a neighbouring fault alone does not hide another.
const NEIGHBOURS: usize = 2;
/// Where the neighbours remove less than this share of the operation's mean, as at the end of the turn, a stroke leaves no trace either way.
const LEAST_SHARE: f64 = 0.1;

/// What is wrong with a stroke.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum StrokeFaultKind {
    /// The stroke before it is not there.
    MissingBefore,
    /// The stroke is there but did not cut.
    DidNotCut,
    /// The stroke repeats the one before it.
    Doubled,
}

/// A stroke that stands alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrokeFault {
    /// Stroke of the operation, from 0.
    pub stroke: usize,
    /// What is wrong.
    pub kind: StrokeFaultKind,
    /// What it removed relative to its neighbours, by the family that shows less of a fault.
    pub ratio: f64,
}

impl StrokeFaultKind {
    /// For results.
    pub fn name(self) -> &'static str {
        match self {
            Self::MissingBefore => "missing_before",
            Self::DidNotCut => "did_not_cut",
            Self::Doubled => "doubled",
        }
    }
}

/// Faults of an operation with `blades` passes per stroke; the first stroke, which may enter the full stock, is not judged.
pub fn stroke_faults(removed_mm3: &[[f64; 2]], blades: u32) -> Vec<StrokeFault> {
    let strokes: Vec<[f64; 2]> = removed_mm3
        .chunks(blades as usize)
        .map(|passes| passes.iter().fold([0.0; 2], |sum, pass| [sum[0] + pass[0], sum[1] + pass[1]]))
        .collect();
    let mean = [0, 1].map(|f| strokes.iter().map(|s| s[f]).sum::<f64>() / strokes.len().max(1) as f64);
    let neighbours = |at: usize, family: usize| {
        let range = at.saturating_sub(NEIGHBOURS)..(at + NEIGHBOURS + 1).min(strokes.len());
        range.filter(move |&other| other != at).map(|other| strokes[other][family]).collect::<Vec<f64>>()
    };
    // The family that shows less of a fault decides; a family whose neighbours hardly cut says nothing, and then there is no fault.
    let high = |at: usize| {
        let ratio = |f: usize| {
            let largest = neighbours(at, f).into_iter().fold(0.0, f64::max);
            if largest > LEAST_SHARE * mean[f] { strokes[at][f] / largest } else { 0.0 }
        };
        ratio(0).min(ratio(1))
    };
    let low = |at: usize| {
        let ratio = |f: usize| {
            let smallest = neighbours(at, f).into_iter().fold(f64::INFINITY, f64::min);
            if smallest > LEAST_SHARE * mean[f] { strokes[at][f] / smallest } else { f64::INFINITY }
        };
        ratio(0).max(ratio(1))
    };
    let mut faults: Vec<StrokeFault> = Vec::new();
    for stroke in 1..strokes.len() {
        let (up, down) = (high(stroke), low(stroke));
        if down < ALONE_LOW {
            faults.push(StrokeFault { stroke, kind: StrokeFaultKind::Doubled, ratio: down });
        } else if up > ALONE_HIGH {
            match faults.last_mut() {
                // It took the chip of the stroke before it, which was there but did not cut.
                Some(before) if before.stroke + 1 == stroke && before.kind == StrokeFaultKind::Doubled => {
                    before.kind = StrokeFaultKind::DidNotCut;
                }
                _ => faults.push(StrokeFault { stroke, kind: StrokeFaultKind::MissingBefore, ratio: up }),
            }
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_stand_alone_in_both_families() {
        let even = |at: usize| 3.0 + 0.01 * at as f64;
        let mut strokes: Vec<[f64; 2]> = (0..60).map(|i| [even(i), even(i)]).collect();
        strokes[0] = [100.0; 2];
        assert_eq!(stroke_faults(&strokes, 1), []);
        strokes[10] = [6.2; 2];
        strokes[20] = [0.0, 0.1];
        strokes[30] = [0.0; 2];
        strokes[31] = [6.5; 2];
        strokes[40] = [6.5, 3.4];
        strokes[50] = [3.4, 0.0];
        let found: Vec<_> = stroke_faults(&strokes, 1).iter().map(|f| (f.stroke, f.kind)).collect();
        use StrokeFaultKind::{DidNotCut, Doubled, MissingBefore};
        assert_eq!(found, [(10, MissingBefore), (20, Doubled), (30, DidNotCut)]);
    }
}
