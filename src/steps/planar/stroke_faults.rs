//! Strokes that are missing or were made twice, told from what every stroke removed.
//!
//! In: volume removed by every pass. Out: strokes that stand alone. With an even feed the volume changes slowly from
//! stroke to stroke, so a stroke that removed far more than the two before and the two after it stands where another
//! one is missing, and one that removed next to nothing was either made twice (the next one cuts as usual) or did not
//! cut (the next one takes its chip as well).
//!
//! **For each cutter tooth the family of rays that scatters less is taken.** A thin chip along the rays of one family
//! is met as a whole by one ray or by none, so the volume that this family gives for the tooth jumps from stroke to
//! stroke. The rays of the other family cross the chip. So each tooth in the work has the volumes of the family that
//! scatters less over the stroke and its neighbours. A fault must show in the tooth that takes most, and in all teeth
//! together; so neither a tooth that comes into the work looks like one, nor the end of a plunge.
//!
//! Chips have to be as large as some cells of the grid to be told apart. The surface alone would not do at all: at
//! 4,200 strokes the facet of a missing stroke is narrower than the rays' distance.

/// A stroke that removed more than this times its neighbours follows a gap. On the elliptical gear 30 missing strokes
/// measure 1.64 to 2.11, and no other stroke of the judged operations of the shipped scenes more than 1.3.
const ALONE_HIGH: f64 = 1.5;
/// One that removed less than this times its neighbours did not cut. The same strokes measure 0 when made twice, the
/// others 0.6 and more.
const ALONE_LOW: f64 = 0.3;
/// Strokes on either side that a stroke is compared with. The largest (or smallest) of the four is passed over, so that
/// one jump among them hides nothing.
const NEIGHBOURS: usize = 2;
/// Where the neighbours remove less than this share of the mean stroke, as at the end of the turn, a stroke is not
/// judged: it leaves hardly a trace, and few rays meet its chips.
const LEAST_SHARE: f64 = 0.3;
/// Operations whose mean stroke removes less than this many cells of the grid from a section are not judged: chance
/// decides how many rays meet their chips.
pub const LEAST_CELLS: f64 = 10.0;

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
    /// What it removed relative to its neighbours.
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

/// Faults of an operation with `blades` passes per stroke; the first stroke, which may enter the full stock, is not
/// judged.
pub fn stroke_faults(removed_mm3: &[[f64; 2]], blades: u32) -> Vec<StrokeFault> {
    let blades = blades as usize;
    let count = removed_mm3.len() / blades.max(1);
    let mean = [0, 1].map(|f| removed_mm3.iter().map(|pass| pass[f]).sum::<f64>() / count.max(1) as f64);
    // Removed relative to the neighbours, as the tooth that takes most and as all teeth say: against no fault being
    // high, and being low.
    let ratios = |at: usize| -> [f64; 2] {
        let near = at.saturating_sub(NEIGHBOURS)..(at + NEIGHBOURS + 1).min(count);
        let (mut own, mut expected, mut usual) = (0.0, 0.0, 0.0);
        let mut busiest = (0.0, [1.0; 2]);
        for blade in 0..blades {
            let volumes = |f: usize| near.clone().map(|s| removed_mm3[s * blades + blade][f]).collect::<Vec<f64>>();
            let families = [volumes(0), volumes(1)];
            let f = usize::from(scatter(&families[1]) < scatter(&families[0]));
            let mut others = families[f].clone();
            let this = others.remove(at - near.start);
            others.sort_by(f64::total_cmp);
            let n = others.len();
            if n < 2 {
                return [1.0; 2];
            }
            let median = 0.5 * (others[(n - 1) / 2] + others[n / 2]);
            own += this;
            expected += median;
            usual = f64::max(usual, mean[f]);
            if median > busiest.0 {
                busiest = (median, [n - 2, 1].map(|beside| this / others[beside].max(f64::MIN_POSITIVE)));
            }
        }
        if expected <= LEAST_SHARE * usual {
            return [1.0; 2];
        }
        let all = own / expected;
        [all.min(busiest.1[0]), all.max(busiest.1[1])]
    };
    let mut faults: Vec<StrokeFault> = Vec::new();
    for stroke in 1..count {
        let [up, down] = ratios(stroke);
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

/// Mean square deviation relative to the mean; infinite where there is nothing.
fn scatter(volumes: &[f64]) -> f64 {
    let mean = volumes.iter().sum::<f64>() / volumes.len() as f64;
    let squares: f64 = volumes.iter().map(|v| (v - mean) * (v - mean)).sum();
    if mean > 0.0 { squares / (mean * mean) } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use StrokeFaultKind::{DidNotCut, Doubled, MissingBefore};

    #[test]
    fn a_tooth_that_comes_into_the_work_is_no_fault_and_hides_none() {
        // One tooth fades, the next one comes in; a stroke is missing where they meet.
        let passes = |missing: bool| -> Vec<[f64; 2]> {
            let mut passes = Vec::new();
            for i in 0..40_i32 {
                let extra = if missing && i == 20 { 2.0 } else { 1.0 };
                for v in [f64::from(40 - i) * 0.2, f64::from((i - 19).max(0)) * 1.5] {
                    passes.push([extra * v; 2]);
                }
            }
            passes
        };
        assert_eq!(stroke_faults(&passes(false), 2), []);
        let found = stroke_faults(&passes(true), 2);
        assert_eq!(found.iter().map(|f| f.stroke).collect::<Vec<_>>(), [20]);
    }

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
        assert_eq!(found, [(10, MissingBefore), (20, Doubled), (30, DidNotCut)]);
    }
}
