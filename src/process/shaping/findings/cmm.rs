//! Allowances as a coordinate measuring machine finds them.

use crate::findings::quantities::teeth::TOOTH;
use crate::findings::{Section, Table};
use crate::process::shaping::gear::measure::cmm::CmmReport;
use crate::process::shaping::gear::measure::unevenness::{ToothAllowance, summarise};
use crate::process::shaping::quantities::{
    CMM_AB, CMM_CD, CMM_DEVIATION, CMM_MAX, CMM_MAX_HIGH, CMM_MAX_LOW, CMM_MAX_MEDIAN, CMM_MEAN, CMM_MEAN_HIGH,
    CMM_MEAN_LOW, CMM_MEAN_MEDIAN, MEASURED_ALLOWANCE, NO_ALLOWANCE,
};
use gearcut_core::units::UM_PER_MM;

/// The section of an operation.
pub fn section(report: &CmmReport, operation: &str) -> Section {
    let exact = summarise(report.teeth.iter().map(ToothAllowance::unevenness_mean_percent));
    let drawn = |which: usize, end: usize| report.percent(which).map(|of| of[end]);
    let table: Table = Table::over("teeth", "Allowance of each tooth by probe and points", &report.teeth)
        .column(&TOOTH, |tooth| tooth.tooth)
        .column(&CMM_AB, |tooth| tooth.ab_mm())
        .column(&CMM_CD, |tooth| tooth.cd_mm())
        .in_file(&format!("measured_allowance_{operation}"));
    MEASURED_ALLOWANCE
        .section([
            CMM_MAX.of_or(exact.map(|of| of.max_percent), NO_ALLOWANCE),
            CMM_MEAN.of_or(exact.map(|of| of.mean_percent), NO_ALLOWANCE),
            CMM_MAX_MEDIAN.of_or(drawn(0, 0), NO_ALLOWANCE),
            CMM_MAX_LOW.of_or(drawn(0, 1), NO_ALLOWANCE),
            CMM_MAX_HIGH.of_or(drawn(0, 2), NO_ALLOWANCE),
            CMM_MEAN_MEDIAN.of_or(drawn(1, 0), NO_ALLOWANCE),
            CMM_MEAN_LOW.of_or(drawn(1, 1), NO_ALLOWANCE),
            CMM_MEAN_HIGH.of_or(drawn(1, 2), NO_ALLOWANCE),
            CMM_DEVIATION.of_or(report.deviation_mm.map(|mm| UM_PER_MM * mm), NO_ALLOWANCE),
        ])
        .table(table)
}
