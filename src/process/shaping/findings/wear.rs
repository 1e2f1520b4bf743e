//! The cutter's wear in a run: [`crate::steps::tool_wear`].

use crate::findings::Section;
use crate::findings::quantities::tool_wear::CUTTER_TOOTH;
use crate::measure::tool_wear::ToolWear;
use crate::output::bar_chart::BarChart;
use crate::process::shaping::ShapingJob;
use crate::steps::tool_wear::{self, WornTool};

/// The cutter and its teeth.
fn worn_tool(job: &ShapingJob) -> WornTool {
    WornTool {
        name: "cutter",
        tooth: &CUTTER_TOOTH,
        numbering: "from 0",
        labels: (0..job.cutter_spec.teeth).map(|tooth| tooth.to_string()).collect(),
        places: ["right_4", "right_3", "right_2", "right_1", "tip", "left_1", "left_2", "left_3", "left_4"],
        flanks: ["right flank", "left flank"],
        more: None,
    }
}

/// Bars by cutter tooth; none where nothing was cut.
pub fn bars(job: &ShapingJob, wear: &ToolWear) -> Option<(String, BarChart)> {
    tool_wear::bars(&worn_tool(job), &job.scene.name, wear)
}

/// What is found.
pub fn findings(job: &ShapingJob, wear: &ToolWear) -> Section {
    tool_wear::findings(&worn_tool(job), wear)
}
