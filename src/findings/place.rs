//! Where a value was found: named coordinates in a fixed order.
//!
//! In: names that carry their unit (`u_mm`, `work_angle_deg`, `stroke`) with a number, count or word each. Out: an
//! object in `results.json`, words on the terminal.
//!
//! Places tell where, not how much: comparisons leave them alone.

use super::unit;
use std::borrow::Cow;

use serde::de::{Error as _, MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A place by its coordinates.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Place(Vec<(Cow<'static, str>, Coordinate)>);

/// One coordinate of a place.
#[derive(Debug, Clone, PartialEq)]
pub enum Coordinate {
    /// A length, angle or time; its name tells the unit.
    Number(f64),
    /// A number of something counted, such as a tooth or a stroke.
    Count(u64),
    /// A word, such as the side of a tooth.
    Word(Cow<'static, str>),
}

/// A place on a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankPlace<'a> {
    /// Tooth, from 1.
    pub tooth: u64,
    /// Flank: `left` or `right`.
    pub flank: &'a str,
    /// Arc length along the profile from the form point, mm.
    pub u_mm: f64,
    /// Distance along the tooth from the middle of the face, mm.
    pub v_mm: f64,
}

impl From<f64> for Coordinate {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<u64> for Coordinate {
    fn from(count: u64) -> Self {
        Self::Count(count)
    }
}

impl From<u32> for Coordinate {
    fn from(count: u32) -> Self {
        Self::Count(count.into())
    }
}

impl From<&'static str> for Coordinate {
    fn from(word: &'static str) -> Self {
        Self::Word(word.into())
    }
}

impl From<String> for Coordinate {
    fn from(word: String) -> Self {
        Self::Word(word.into())
    }
}

impl Place {
    /// On a flank: tooth from 1, `left` or `right`, arc along the profile and distance along the tooth, mm.
    pub fn on_flank(tooth: u32, flank: &'static str, u_mm: f64, v_mm: f64) -> Self {
        Self::default().and("tooth", tooth).and("flank", flank).and("u_mm", u_mm).and("v_mm", v_mm)
    }

    /// With one more coordinate; a number that is not finite is no coordinate and is left out.
    #[must_use]
    pub fn and(mut self, name: &'static str, coordinate: impl Into<Coordinate>) -> Self {
        let coordinate = coordinate.into();
        if !matches!(coordinate, Coordinate::Number(value) if !value.is_finite()) {
            self.0.push((name.into(), coordinate));
        }
        self
    }

    /// The coordinate of this name.
    pub fn get(&self, name: &str) -> Option<&Coordinate> {
        self.0.iter().find(|(other, _)| other == name).map(|(_, coordinate)| coordinate)
    }

    /// The place as one on a flank, if it is one.
    pub fn flank(&self) -> Option<FlankPlace<'_>> {
        let mm = |name| match self.get(name) {
            Some(Coordinate::Number(value)) => Some(*value),
            _ => None,
        };
        let (Coordinate::Count(tooth), Coordinate::Word(flank)) = (self.get("tooth")?, self.get("flank")?) else {
            return None;
        };
        Some(FlankPlace { tooth: *tooth, flank, u_mm: mm("u_mm")?, v_mm: mm("v_mm")? })
    }

    /// In words: "tooth 7 left, u 1.50 mm, v -12.00 mm".
    pub fn words(&self) -> String {
        self.words_by(|number, unit| format!("{number} {unit}").trim_end().to_owned())
    }

    /// The same, its units in the signs of a page.
    pub fn words_with_signs(&self) -> String {
        self.words_by(unit::with_signs)
    }

    fn words_by(&self, with_unit: impl Fn(&str, &str) -> String) -> String {
        let mut words = String::new();
        for (name, coordinate) in &self.0 {
            // A side follows its tooth as an adjective.
            let side = name == "flank" && words.starts_with("tooth");
            let separator = if words.is_empty() {
                ""
            } else if side {
                " "
            } else {
                ", "
            };
            words.push_str(separator);
            let (label, unit) = unit::of_name(name);
            let label = if side || name == "zone" { String::new() } else { format!("{} ", label.replace('_', " ")) };
            words.push_str(&label);
            words.push_str(&match coordinate {
                Coordinate::Number(value) => with_unit(&format!("{value:.2}"), unit),
                Coordinate::Count(count) => count.to_string(),
                Coordinate::Word(word) => word.to_string(),
            });
        }
        words
    }
}

impl Serialize for Place {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, coordinate) in &self.0 {
            match coordinate {
                Coordinate::Number(value) => map.serialize_entry(name, value)?,
                Coordinate::Count(count) => map.serialize_entry(name, count)?,
                Coordinate::Word(word) => map.serialize_entry(name, word)?,
            }
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Place {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InOrder;
        impl<'de> Visitor<'de> for InOrder {
            type Value = Place;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("coordinates by name")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Place, A::Error> {
                let mut all = Vec::new();
                while let Some((name, value)) = map.next_entry::<String, serde_json::Value>()? {
                    let coordinate = match &value {
                        serde_json::Value::Number(number) => match (number.as_u64(), number.as_f64()) {
                            (Some(count), _) => Coordinate::Count(count),
                            (None, Some(value)) => Coordinate::Number(value),
                            (None, None) => return Err(A::Error::custom(format!("{name}: {number} is out of range"))),
                        },
                        serde_json::Value::String(word) => Coordinate::Word(word.clone().into()),
                        other => {
                            return Err(A::Error::custom(format!("{name} is a number or a word, not {other}")));
                        }
                    };
                    all.push((name.into(), coordinate));
                }
                Ok(Place(all))
            }
        }
        deserializer.deserialize_map(InOrder)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_read_as_words_and_come_back_from_json() {
        let place = Place::on_flank(7, "left", 1.5, -12.0).and("stroke", 31_u32).and("work_angle_deg", 0.25);
        assert_eq!(place.words(), "tooth 7 left, u 1.50 mm, v -12.00 mm, stroke 31, work angle 0.25 deg");
        assert_eq!(place.words_with_signs(), "tooth 7 left, u 1.50 mm, v -12.00 mm, stroke 31, work angle 0.25°");
        let text = serde_json::to_string(&place).expect("a place is always JSON");
        assert_eq!(text, r#"{"tooth":7,"flank":"left","u_mm":1.5,"v_mm":-12.0,"stroke":31,"work_angle_deg":0.25}"#);
        assert_eq!(serde_json::from_str::<Place>(&text).expect("its own JSON"), place);
        assert!(serde_json::from_str::<Place>(r#"{"tooth": null}"#).is_err());
    }

    #[test]
    fn only_a_full_place_on_a_flank_is_one() {
        let on_flank = Place::on_flank(7, "right", 1.0, 2.0);
        assert_eq!(on_flank.flank(), Some(FlankPlace { tooth: 7, flank: "right", u_mm: 1.0, v_mm: 2.0 }));
        assert_eq!(Place::default().and("tooth", 7_u32).and("flank", "left").flank(), None);
        assert_eq!(Place::default().and("time_s", f64::NAN), Place::default());
    }
}
