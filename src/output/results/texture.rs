//! Texture of windows in `results.json`.

use serde::de::{MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

use super::super::quantity::Quantity;

/// Texture that one operation left in one window.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TextureResults {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Flank: `left` or `right`.
    pub flank: String,
    /// Name of the operation.
    pub operation: String,
    /// Middle of the window along the profile.
    pub center_profile: Quantity,
    /// Middle of the window along the tooth.
    pub center_lead: Quantity,
    /// Length along the profile.
    pub length_profile: Quantity,
    /// Length along the tooth.
    pub length_lead: Quantity,
    /// Distance of points along the profile.
    pub spacing_profile: Quantity,
    /// Distance of points along the tooth.
    pub spacing_lead: Quantity,
    /// Marks along the profile.
    pub marks_along_profile: Quantity,
    /// Marks along the tooth.
    pub marks_along_tooth: Quantity,
    /// What was done before the evaluation, step by step.
    pub chain: Vec<String>,
    /// What a reader must know before trusting the numbers.
    pub warnings: Vec<String>,
    /// ISO 25178-2 parameters by symbol.
    pub parameters: Parameters,
    /// The material ratio curve, for drawing.
    pub abbott: Option<AbbottCurve>,
    /// Files of the window without their endings, relative to the output folder.
    pub files: String,
}

/// The material ratio curve with the construction of the Sk family; heights in um over the mean plane, ratios in per cent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AbbottCurve {
    /// What the numbers are.
    pub definition: String,
    /// Heights at equally spaced ratios from 0 to 100 %, um.
    pub heights_um: Vec<f64>,
    /// Where the 40 % window begins, %.
    pub window_percent: f64,
    /// Equivalent line at 0 %, um.
    pub upper_um: f64,
    /// Equivalent line at 100 %, um.
    pub lower_um: f64,
}

/// Quantities by symbol, in the order of the standard.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Parameters(pub Vec<(String, Quantity)>);

impl Parameters {
    /// Quantity of a symbol.
    pub fn get(&self, symbol: &str) -> Option<&Quantity> {
        self.0.iter().find(|(name, _)| name == symbol).map(|(_, quantity)| quantity)
    }
}

impl Serialize for Parameters {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (symbol, quantity) in &self.0 {
            map.serialize_entry(symbol, quantity)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Parameters {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InOrder;
        impl<'de> Visitor<'de> for InOrder {
            type Value = Parameters;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("quantities by symbol")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Parameters, A::Error> {
                let mut all = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    all.push(entry);
                }
                Ok(Parameters(all))
            }
        }
        deserializer.deserialize_map(InOrder)
    }
}
