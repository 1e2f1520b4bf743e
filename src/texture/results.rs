//! Texture in the words of `results.json`.

use super::files::stems;
use super::{WindowTexture, chart};
use crate::job::GearJob;
use crate::measure::topography::Parameter;
use crate::output::quantity::Quantity;
use crate::output::results::{AbbottCurve, Parameters, TextureResults};
use crate::units::UM_PER_MM;

/// Intervals of the curve in the results.
const CURVE_INTERVALS: u32 = 200;

/// Parameters as quantities.
pub fn quantities(parameters: &[Parameter]) -> Parameters {
    let quantity = |p: &Parameter| match &p.value {
        Ok(value) => Quantity::number(*value, p.unit, p.definition.clone()),
        Err(why) => Quantity::undefined(p.unit, p.definition.clone(), why.clone()),
    };
    Parameters(parameters.iter().map(|p| (p.symbol.clone(), quantity(p))).collect())
}

/// All textures for `results.json`.
pub fn results(job: &dyn GearJob, textures: &[WindowTexture]) -> Vec<TextureResults> {
    textures.iter().zip(stems(job, textures)).map(|(texture, stem)| one(job, texture, stem)).collect()
}

fn one(job: &dyn GearJob, texture: &WindowTexture, files: String) -> TextureResults {
    let window = &texture.window;
    let (center, length, spacing) = (window.center_mm(), window.length_mm(), window.spacing_mm());
    let mm = |value: f64, definition: &'static str| Quantity::number(value, "mm", definition);
    let um = |value: f64, definition: &'static str| Quantity::number(value * UM_PER_MM, "um", definition);
    let marks = |count: usize, definition: &'static str| Quantity::count(count as u64, "marks", definition);
    let mut warnings = texture.warnings();
    let (chain, parameters, abbott) = match &texture.evaluated {
        Ok(evaluated) => {
            let evaluation = &evaluated.evaluation;
            let curve = AbbottCurve {
                definition: "heights over the mean plane at equally spaced areal material ratios from 0 to 100 %; the equivalent line fits the curve by least squares in the 40 % window".to_owned(),
                heights_um: chart::points(&evaluation.curve, CURVE_INTERVALS).into_iter().map(|(_, z)| z).collect(),
                window_percent: evaluation.core.window_percent,
                upper_um: evaluation.core.upper_um,
                lower_um: evaluation.core.lower_um,
            };
            (evaluated.chain.clone(), quantities(&evaluation.parameters), Some(curve))
        }
        Err(reason) => {
            warnings.push(format!("the window could not be evaluated: {reason}"));
            (Vec::new(), Parameters::default(), None)
        }
    };
    TextureResults {
        tooth: window.tooth,
        flank: window.side.name().to_owned(),
        operation: job.operations()[texture.operation].0.to_owned(),
        center_profile: mm(center[1], "middle of the window as arc along the profile from the start of the involute"),
        center_lead: mm(center[0], "middle of the window along the tooth from the middle of the face"),
        length_profile: mm(length[1], "length of the window along the profile"),
        length_lead: mm(length[0], "length of the window along the tooth"),
        spacing_profile: um(spacing[1], "distance of points along the profile, uniform in arc length"),
        spacing_lead: um(spacing[0], "distance of points along the tooth"),
        marks_along_profile: marks(
            texture.marks[1],
            "facets that follow each other along the profile in the middle of the window",
        ),
        marks_along_tooth: marks(
            texture.marks[0],
            "facets that follow each other along the tooth in the middle of the window; 0: the axes rest during strokes, marks run along the tooth without end",
        ),
        chain,
        warnings,
        parameters,
        abbott,
        files,
    }
}
