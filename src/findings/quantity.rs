//! Values that explain themselves: what findings are made of.
//!
//! In: a number, count or text with its unit and definition. Out: `{"value", "unit", "definition"}`, for an undefined
//! value `{"value": null, "unit", "definition", "why"}`, and a `"place"` where a value belongs to one.
//!
//! The rule: no bare number leaves gearcut, and NaN or infinity never reaches a file: JSON has no word for them, and
//! readers differ in what they make of it.
//!
//! Road not taken: leaving undefined values out. A missing key reads like an older program; `null` with a reason does
//! not.

use std::borrow::Cow;

use serde::de::Error as _;
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::datum::Datum;
use super::place::Place;

/// One value of the results with its unit and definition.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    value: Datum,
    unit: Option<Cow<'static, str>>,
    definition: Cow<'static, str>,
    /// Why there is no value; empty where there is one.
    why: Cow<'static, str>,
    place: Option<Place>,
}

impl Quantity {
    /// Of its parts; `why` says why a value is undefined.
    pub(super) fn new(
        value: Datum,
        unit: Option<Cow<'static, str>>,
        definition: Cow<'static, str>,
        why: Cow<'static, str>,
    ) -> Self {
        Self { value, unit, definition, why, place: None }
    }

    /// The same quantity where its value does not exist, with the reason.
    #[must_use]
    pub fn without_value(self, why: impl Into<Cow<'static, str>>) -> Self {
        Self { value: Datum::Undefined, why: why.into(), place: None, ..self }
    }

    /// The same value, found at `place`.
    #[must_use]
    pub fn at(mut self, place: Place) -> Self {
        self.place = Some(place);
        self
    }

    /// The same value in this unit.
    #[must_use]
    pub(super) fn in_unit(self, unit: impl Into<Cow<'static, str>>) -> Self {
        Self { unit: Some(unit.into()), ..self }
    }

    /// The same value, with words after its definition.
    #[must_use]
    pub(super) fn remarked(self, remark: &str) -> Self {
        Self { definition: format!("{}{remark}", self.definition).into(), ..self }
    }

    /// The number or count as f64, in the quantity's unit; none for text and for what is undefined.
    pub fn value(&self) -> Option<f64> {
        self.value.number()
    }

    /// The count of whole things, if it is one.
    pub fn whole(&self) -> Option<u64> {
        match self.value {
            Datum::Count(count) => Some(count),
            _ => None,
        }
    }

    /// The word or sentence, if it is one.
    pub fn words(&self) -> Option<&str> {
        match &self.value {
            Datum::Word(text) => Some(text),
            _ => None,
        }
    }

    /// The unit; none for text.
    pub fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    /// What the value is.
    pub fn definition(&self) -> &str {
        &self.definition
    }

    /// Why there is no value, if there is none.
    pub fn why(&self) -> Option<&str> {
        (self.value == Datum::Undefined).then_some(&self.why)
    }

    /// Where the value was found, if it belongs to a place.
    pub fn place(&self) -> Option<&Place> {
        self.place.as_ref()
    }
}

/// A quantity as it stands in a file.
#[derive(Deserialize)]
struct Written {
    value: serde_json::Value,
    unit: Option<String>,
    definition: String,
    why: Option<String>,
    place: Option<Place>,
}

impl<'de> Deserialize<'de> for Quantity {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Written { value, unit, definition, why, place } = Written::deserialize(deserializer)?;
        if value.is_null() && why.is_none() {
            return Err(D::Error::custom("a value is null without a \"why\""));
        }
        let value = Datum::from_json(&value).map_err(D::Error::custom)?;
        let why = if value == Datum::Undefined { why.unwrap_or_default() } else { String::new() };
        Ok(Self { place, ..Self::new(value, unit.map(Cow::Owned), definition.into(), why.into()) })
    }
}

impl Serialize for Quantity {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("value", &self.value.to_json())?;
        map.serialize_entry("unit", &self.unit)?;
        map.serialize_entry("definition", &self.definition)?;
        if let Some(why) = self.why() {
            map.serialize_entry("why", why)?;
        }
        if let Some(place) = &self.place {
            map.serialize_entry("place", place)?;
        }
        map.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::QuantityRow;

    static STOCK: QuantityRow = QuantityRow::new("stock", "mm", "smallest normal stock").or(&[POINTED]);
    static STROKES: QuantityRow = QuantityRow::new("strokes", "strokes", "strokes per revolution");
    static BACKEND: QuantityRow = QuantityRow::new("backend", "", "backend");
    const POINTED: &str = "the tooth is pointed";

    fn json(quantity: &Quantity) -> String {
        serde_json::to_string(quantity).expect("a quantity is always JSON")
    }

    #[test]
    fn a_number_carries_unit_definition_and_place() {
        let stock = STOCK.of(0.1).at(Place::on_flank(7, "left", 1.5, 12.0)).quantity;
        assert_eq!(
            json(&stock),
            concat!(
                r#"{"value":0.1,"unit":"mm","definition":"smallest normal stock","#,
                r#""place":{"tooth":7,"flank":"left","u_mm":1.5,"v_mm":12.0}}"#
            )
        );
        assert_eq!(stock.value(), Some(0.1));
    }

    #[test]
    fn what_is_not_finite_is_null_with_a_reason() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let text = json(&STOCK.of(value).quantity);
            let null = r#"{"value":null,"unit":"mm","definition":"smallest normal stock","why":"the computation"#;
            assert!(text.starts_with(null), "{text}");
        }
        let text = json(&STOCK.of_or(None::<f64>, POINTED).quantity);
        assert!(text.ends_with(r#""why":"the tooth is pointed"}"#), "{text}");
    }

    #[test]
    fn counts_stay_whole_and_texts_have_no_unit() {
        assert_eq!(json(&STROKES.of(4200_u32).quantity).find("4200,"), Some(9));
        assert_eq!(json(&BACKEND.of("cpu").quantity), r#"{"value":"cpu","unit":null,"definition":"backend"}"#);
    }

    #[test]
    fn quantities_read_back_as_they_were() {
        let place = Place::on_flank(7, "left", 1.5, 12.0);
        let entries = [STOCK.of(0.1 + 0.2).at(place), STROKES.of(84_u32), BACKEND.of("cpu"), STOCK.none(POINTED)];
        for quantity in entries.map(|entry| entry.quantity) {
            let back: Quantity = serde_json::from_str(&json(&quantity)).expect("its own JSON");
            assert_eq!(back, quantity);
        }
        let unexplained = r#"{"value": null, "unit": "mm", "definition": "tip land"}"#;
        assert!(serde_json::from_str::<Quantity>(unexplained).is_err());
    }

    #[test]
    fn numbers_read_back_bit_for_bit() {
        for value in [0.1 + 0.2, 1e-300, -6.02214076e23, f64::MIN_POSITIVE, f64::MAX] {
            let back: serde_json::Value = serde_json::from_str(&json(&STOCK.of(value).quantity)).expect("valid JSON");
            assert_eq!(back["value"].as_f64().map(f64::to_bits), Some(value.to_bits()));
        }
    }
}
