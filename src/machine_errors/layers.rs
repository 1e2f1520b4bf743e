//! Errors in layers: what can be switched off together, so that each can be cut alone, and all but one.
//!
//! A layer is a kind of cause that a shop would work on by itself. What a process has of its own (tool, stock, cutting
//! edge) it switches itself.

use super::{AxisErrors, Guide, MachineErrors, WorkMounting};

/// A layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorLayer {
    /// What axes do wrong the same way in every gear.
    Axes,
    /// The guide along the gear.
    Guide,
    /// The work on its spindle.
    Mounting,
    /// Runout, wobble and pitch of the tool.
    Tool,
    /// What axes do at random.
    Noise,
    /// Scatter of the stock that operations leave.
    Stock,
    /// Roughness of the cutting edges.
    Edge,
    /// What rounded cutting edges do not cut.
    Ploughing,
    /// Pits and scratches of a built-up edge.
    Tearing,
    /// Displacement of tool and work by the forces of the cut.
    Deflection,
}

impl ErrorLayer {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Axes,
        Self::Guide,
        Self::Mounting,
        Self::Tool,
        Self::Noise,
        Self::Stock,
        Self::Edge,
        Self::Ploughing,
        Self::Tearing,
        Self::Deflection,
    ];

    /// What it is, in a sentence without its end.
    pub fn definition(self) -> &'static str {
        match self {
            Self::Axes => "what axes do wrong the same way in every gear",
            Self::Guide => "the guide along the gear",
            Self::Mounting => "the work on its spindle",
            Self::Tool => "runout, wobble and pitch of the tool",
            Self::Noise => "what axes do at random",
            Self::Stock => "scatter of the stock that operations leave",
            Self::Edge => "roughness of the cutting edges",
            Self::Ploughing => "strokes that meet less than a thinnest chip and push it aside",
            Self::Tearing => "pits and scratches that a built-up edge tears into flanks",
            Self::Deflection => "displacement of tool and work by the forces of the cut",
        }
    }

    /// Whether it is another one in every gear.
    pub fn is_random(self) -> bool {
        matches!(self, Self::Noise | Self::Stock | Self::Tearing)
    }

    /// In a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Axes => "axes",
            Self::Guide => "guide",
            Self::Mounting => "mounting",
            Self::Tool => "tool",
            Self::Noise => "noise",
            Self::Stock => "stock",
            Self::Edge => "edge",
            Self::Ploughing => "ploughing",
            Self::Tearing => "tearing",
            Self::Deflection => "deflection",
        }
    }
}

impl<const N: usize> MachineErrors<N> {
    /// Layers that there are, those of the process's `own` among them, in the order of [`ErrorLayer::ALL`].
    pub fn layers(&self, own: &[(ErrorLayer, bool)]) -> Vec<ErrorLayer> {
        let same_in_every_gear = |axis: &AxisErrors| !AxisErrors { noise: Vec::new(), ..axis.clone() }.is_none();
        let of_all_machines = [
            (ErrorLayer::Axes, self.axes.iter().any(same_in_every_gear)),
            (ErrorLayer::Guide, !self.guide.is_none()),
            (ErrorLayer::Mounting, !self.mounting.is_none()),
            (ErrorLayer::Noise, self.axes.iter().any(|axis| !axis.noise.is_empty())),
        ];
        let there = |layer: &ErrorLayer| of_all_machines.iter().chain(own).any(|of| *of == (*layer, true));
        ErrorLayer::ALL.into_iter().filter(there).collect()
    }

    /// Switches all layers off but these.
    pub fn keep(&mut self, kept: &[ErrorLayer]) {
        let off = |layer: ErrorLayer| !kept.contains(&layer);
        for axis in &mut self.axes {
            if off(ErrorLayer::Noise) {
                axis.noise.clear();
            }
            if off(ErrorLayer::Axes) {
                *axis = AxisErrors { noise: std::mem::take(&mut axis.noise), ..AxisErrors::default() };
            }
        }
        if off(ErrorLayer::Guide) {
            self.guide = Guide::default();
        }
        if off(ErrorLayer::Mounting) {
            self.mounting = WorkMounting::default();
        }
    }
}
