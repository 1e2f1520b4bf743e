//! The backend as the program sees it.

use crate::adapter::AdapterFacts;
use crate::context::Gpu;
use crate::spatial;
use gearcut_core::cut::sweep_chips::SweepsCut;
use gearcut_core::cut::{Backend, BlankCut, BlankOperation, CutStats, StageTime};
use gearcut_core::cut::{MakeField, MakeSwept, TakeField, TakeSwept};
use gearcut_core::dexel::{BlankField, Field, Layer, SpatialField};
use gearcut_core::error::Error;
use gearcut_core::passes::sections::swept_sections::SweptSections;
use gearcut_core::passes::{CutPlan, SweepPlan};
use std::ops::Range;

impl Backend for Gpu {
    fn name(&self) -> String {
        let AdapterFacts { name, interface, driver, .. } = self.adapter();
        format!("gpu ({name}, {interface}, {driver})")
    }

    fn cut(&self, field: &Field, plan: &CutPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        self.cut_or_redo(
            layer,
            |layer| self.cut_on_device(field, plan, layer),
            |layer| self.native.cut(field, plan, layer),
        )
    }

    fn cut_fields(&self, count: usize, make: &MakeField, take: &TakeField) -> Result<(), Error> {
        self.cut_in_flight(count, make, take)
    }

    fn cut_blank(
        &self,
        field: &mut BlankField,
        operation: &BlankOperation,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<BlankCut>, Error> {
        let cut = self.cut_blank_on_device(field, operation, None, advance);
        self.blank_or_redo(cut, |native| native.cut_blank(field, operation, advance))
    }

    fn cut_blank_sweeps(
        &self,
        field: &mut BlankField,
        sections: &SweptSections,
        passes: Range<u32>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<SweepsCut>, Error> {
        let cut = self.cut_blank_sweeps_on_device(field, sections, passes.clone(), None, advance);
        self.blank_or_redo(cut, |native| native.cut_blank_sweeps(field, sections, passes, advance))
    }

    fn cut_spatial(&self, field: &SpatialField, plan: &SweepPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        self.cut_or_redo(
            layer,
            |layer| spatial::cut_on_device(self, field, plan, layer),
            |layer| self.native.cut_spatial(field, plan, layer),
        )
    }

    fn cut_swept<'p>(&self, count: usize, make: &MakeSwept<'_, 'p>, take: &TakeSwept<'_, 'p>) -> Result<(), Error> {
        self.cut_in_flight(count, make, take)
    }

    fn incidents(&self) -> Vec<String> {
        self.log().incidents.clone()
    }

    fn stage_times(&self) -> Vec<StageTime> {
        if !self.device.facts.timestamps {
            return Vec::new();
        }
        self.log().stages.clone()
    }
}
