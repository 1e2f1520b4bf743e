//! Blank fields of two backends beside each other: every end of every span.
//!
//! An end is **stable** where the native one moves by less than twice the bound when all rays are shifted sideways by the bound, to either side, and the ray's list keeps its length: it is met at 27 degrees or
//! steeper, and no cusp and no tip corner is grazed. All stable ends are held to the bound, without exceptions; the others are counted. Slivers shorter than twice the bound are no material to f32 and are left out on both sides.

use gearcut::dexel::BlankField;
use gearcut::dexel::intervals::Span;
use std::fmt;

/// How far two backends are apart over many ends.
#[derive(Debug)]
#[must_use = "a comparison that nobody looks at proves nothing"]
pub struct BlankParity {
    /// Largest distance of a stable end.
    bound_mm: f64,
    /// Distances of stable ends, nm.
    off_nm: Vec<f64>,
    /// Ends that are not stable, or whose list is not.
    pub unstable: usize,
    /// Stable lists of another length, with the place of the first.
    pub other_lists: Vec<String>,
    /// Ends that are no numbers.
    pub poisoned: usize,
    /// Stable ends left by another pass.
    pub other_pass: usize,
}

impl BlankParity {
    /// Four ulps of f32 at the largest coordinate, mm.
    pub fn bound_mm(field: &BlankField) -> f64 {
        let row = |f: usize| field.grid.rows[f].first_mm.abs();
        let reach_mm = row(0).max(row(1)) as f32;
        4.0 * f64::from(reach_mm.next_up() - reach_mm)
    }

    /// Compares; `shifted`: native fields whose rays stand [`Self::bound_mm`] to both sides.
    pub fn of(native: &BlankField, shifted: [&BlankField; 2], gpu: &BlankField) -> Self {
        let bound_mm = Self::bound_mm(native);
        let (off_nm, other_lists) = (Vec::new(), Vec::new());
        let mut parity = Self { bound_mm, off_nm, unstable: 0, other_lists, poisoned: 0, other_pass: 0 };
        for slice in 0..native.slices.len() {
            for f in 0..2 {
                for ray in 0..native.grid.rows[f].count {
                    let list = |field: &BlankField| -> Vec<Span> {
                        let spans = field.slices[slice].rays[f][ray].iter();
                        spans
                            .copied()
                            .filter(|span| span.length_mm().is_nan() || span.length_mm() > 2.0 * bound_mm)
                            .collect()
                    };
                    let place = format!("slice {slice}, family {f}, ray {ray}");
                    parity.add(&place, &list(native), shifted.map(list), &list(gpu));
                }
            }
        }
        parity
    }

    fn add(&mut self, place: &str, native: &[Span], shifted: [Vec<Span>; 2], gpu: &[Span]) {
        let ends = |spans: &[Span]| spans.iter().flat_map(|span| [span.low, span.high]).collect::<Vec<_>>();
        let (ours, theirs) = (ends(native), ends(gpu));
        self.poisoned += theirs.iter().filter(|end| !end.at_mm.is_finite()).count();
        let stable_list = shifted.iter().all(|list| list.len() == native.len());
        if !stable_list || ours.len() != theirs.len() {
            if stable_list {
                self.other_lists.push(format!("{place}: {} spans, {} on the GPU", native.len(), gpu.len()));
            }
            self.unstable += ours.len();
            return;
        }
        let shifted = shifted.map(|list| ends(&list));
        for (index, (a, b)) in ours.iter().zip(&theirs).enumerate() {
            if shifted.iter().any(|list| (list[index].at_mm - a.at_mm).abs() > 2.0 * self.bound_mm) {
                self.unstable += 1;
                continue;
            }
            self.off_nm.push(1e6 * (a.at_mm - b.at_mm).abs());
            self.other_pass += usize::from(a.pass != b.pass);
        }
    }

    /// Stable ends.
    pub fn stable(&self) -> usize {
        self.off_nm.len()
    }

    /// What is wrong, if anything.
    pub fn verdict(&self) -> Result<(), String> {
        let largest_nm = self.off_nm.iter().copied().fold(0.0, f64::max);
        let wrong = [
            (self.poisoned > 0, "ends that are no numbers".to_owned()),
            (self.off_nm.len() < 1000, "hardly any end is stable".to_owned()),
            (!self.other_lists.is_empty(), format!("other lists: {:?}", self.other_lists.first())),
            (largest_nm > 1e6 * self.bound_mm, format!("{largest_nm:.1} nm apart")),
            (self.unstable > self.off_nm.len(), format!("{} ends are not stable", self.unstable)),
        ];
        match wrong.into_iter().find(|(is_wrong, _)| *is_wrong) {
            None => Ok(()),
            Some((_, what)) => Err(format!("{what}: {self}")),
        }
    }
}

impl fmt::Display for BlankParity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut sorted = self.off_nm.clone();
        sorted.sort_by(f64::total_cmp);
        let at =
            |share: f64| sorted.get((share * sorted.len().saturating_sub(1) as f64) as usize).copied().unwrap_or(0.0);
        write!(
            f,
            "{} stable ends: median {:.2} nm, q99 {:.2} nm, max {:.2} nm of {:.0}; {} by another pass, {} not stable, {} other lists",
            sorted.len(),
            at(0.5),
            at(0.99),
            at(1.0),
            1e6 * self.bound_mm,
            self.other_pass,
            self.unstable,
            self.other_lists.len()
        )
    }
}
