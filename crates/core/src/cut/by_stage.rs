//! Flanks on one backend, the whole blank on another: which of two is faster depends on what is cut.

use super::blank::{BlankCut, BlankOperation};
use super::sweep_chips::SweepsCut;
use super::{Backend, CutStats, MakeField, MakeSwept, StageTime, TakeField, TakeSwept};
use crate::dexel::{BlankField, Field, Layer, SpatialField};
use crate::error::Error;
use crate::passes::sections::swept_sections::SweptSections;
use crate::passes::{CutPlan, SweepPlan};
use std::ops::Range;

/// Two backends, each for what it cuts.
#[derive(Clone, Copy)]
pub struct ByStage<'a> {
    /// Cuts fields of flanks, roots, tips and windows.
    pub flanks: &'a dyn Backend,
    /// Takes passes from the whole blank.
    pub blank: &'a dyn Backend,
}

impl ByStage<'_> {
    /// Both backends, or the one that has everything.
    fn named(self, name: impl Fn(&dyn Backend) -> String) -> String {
        let [flanks, blank] = [self.flanks, self.blank].map(name);
        if flanks == blank { flanks } else { format!("{flanks}; the whole blank: {blank}") }
    }

    fn of_both<T>(self, of: impl Fn(&dyn Backend) -> Vec<T>) -> Vec<T> {
        let mut all = of(self.flanks);
        if !std::ptr::addr_eq(self.flanks, self.blank) {
            all.extend(of(self.blank));
        }
        all
    }
}

impl Backend for ByStage<'_> {
    fn name(&self) -> String {
        self.named(|backend| backend.name())
    }

    fn name_in_files(&self) -> String {
        self.named(|backend| backend.name_in_files())
    }

    fn cut(&self, field: &Field, plan: &CutPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        self.flanks.cut(field, plan, layer)
    }

    fn cut_fields(&self, count: usize, make: &MakeField, take: &TakeField) -> Result<(), Error> {
        self.flanks.cut_fields(count, make, take)
    }

    fn cut_blank(
        &self,
        field: &mut BlankField,
        operation: &BlankOperation,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<BlankCut>, Error> {
        self.blank.cut_blank(field, operation, advance)
    }

    fn cut_blank_sweeps(
        &self,
        field: &mut BlankField,
        sections: &SweptSections,
        passes: Range<u32>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<SweepsCut>, Error> {
        self.blank.cut_blank_sweeps(field, sections, passes, advance)
    }

    fn cut_spatial(&self, field: &SpatialField, plan: &SweepPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        self.flanks.cut_spatial(field, plan, layer)
    }

    fn cut_swept<'p>(&self, count: usize, make: &MakeSwept<'_, 'p>, take: &TakeSwept<'_, 'p>) -> Result<(), Error> {
        self.flanks.cut_swept(count, make, take)
    }

    fn incidents(&self) -> Vec<String> {
        self.of_both(|backend| backend.incidents())
    }

    fn stage_times(&self) -> Vec<StageTime> {
        self.of_both(|backend| backend.stage_times())
    }
}
