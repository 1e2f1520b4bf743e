//! A quantity under its key: a row of the table of quantities with a value, or with the reason why there is none.

use super::datum::Datum;
use super::place::Place;
use super::quantity::Quantity;
use super::row::{Level, QuantityRow};
use crate::measure::topography::Parameter;
use std::borrow::Cow;

/// A quantity under its key.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Key among its neighbours.
    pub key: String,
    /// What it is called where people read it.
    pub title: String,
    /// How far up it is shown.
    pub level: Level,
    /// The value.
    pub quantity: Quantity,
    /// What follows from the value, where that is said beside it.
    pub advice: Option<Advice>,
}

/// What follows from a value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Advice {
    /// Sentences, the last one without its full stop.
    pub text: String,
    /// Whether something should be changed.
    pub change: bool,
}

impl QuantityRow {
    /// With this value; a number that is not finite is none.
    pub fn of(&self, value: impl Into<Datum>) -> Entry {
        let value = value.into();
        let why = if value == Datum::Undefined { "the computation gave no finite number" } else { "" };
        self.entry(value, why.into())
    }

    /// With this value, or none for this reason.
    pub fn of_or(&self, value: Option<impl Into<Datum>>, why: impl Into<Cow<'static, str>>) -> Entry {
        match value {
            Some(value) => self.of(value),
            None => self.none(why),
        }
    }

    /// Without a value, for one of the row's reasons or one that depends on the scene.
    pub fn none(&self, why: impl Into<Cow<'static, str>>) -> Entry {
        let why = why.into();
        let is_known = matches!(why, Cow::Owned(_)) || self.reasons.contains(&why.as_ref());
        debug_assert!(is_known, "{}: `{why}` is none of its reasons", self.key);
        self.entry(Datum::Undefined, why)
    }

    fn entry(&self, value: Datum, why: Cow<'static, str>) -> Entry {
        let unit = (!self.unit.is_empty()).then_some(Cow::Borrowed(self.unit));
        let quantity = Quantity::new(value, unit, self.definition.into(), why);
        Entry { key: self.key.to_owned(), title: self.title(), level: self.level, quantity, advice: None }
    }
}

impl From<&Parameter> for Entry {
    /// Under its symbol; symbol, unit and definition are those of the list of parameters.
    fn from(of: &Parameter) -> Self {
        let (value, why) = match &of.value {
            Ok(value) => (Datum::from(*value), "the computation gave no finite number".to_owned()),
            Err(why) => (Datum::Undefined, why.to_string()),
        };
        let quantity = Quantity::new(value, Some(of.unit.into()), of.definition.clone().into(), why.into());
        Self { key: of.symbol.clone(), title: of.symbol.clone(), level: Level::Detail, quantity, advice: None }
    }
}

impl Entry {
    /// The same value, found at this place.
    #[must_use]
    pub fn at(self, place: impl Into<Option<Place>>) -> Self {
        match place.into().filter(|_| self.quantity.why().is_none()) {
            Some(place) => Self { quantity: self.quantity.at(place), ..self },
            None => self,
        }
    }

    /// The same, with what should be changed.
    #[must_use]
    pub fn change(self, text: impl Into<String>) -> Self {
        Self { advice: Some(Advice { text: text.into(), change: true }), ..self }
    }

    /// The same, with what to know of it; nothing needs to be changed.
    #[must_use]
    pub fn fine(self, text: impl Into<String>) -> Self {
        Self { advice: Some(Advice { text: text.into(), change: false }), ..self }
    }

    /// The same, under a key that its row cannot know, such as one that begins with the name of an operation.
    #[must_use]
    pub fn keyed(self, key: impl Into<String>) -> Self {
        Self { key: key.into(), ..self }
    }

    /// The same, called so.
    #[must_use]
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self { title: title.into(), ..self }
    }

    /// The same in a unit that its row cannot know, such as that of an axis.
    #[must_use]
    pub fn in_unit(self, unit: impl Into<Cow<'static, str>>) -> Self {
        Self { quantity: self.quantity.in_unit(unit), ..self }
    }

    /// The same with words after its definition that only this run knows.
    #[must_use]
    pub fn remarked(self, remark: &str) -> Self {
        Self { quantity: self.quantity.remarked(remark), ..self }
    }

    /// The same without its value where there is a reason against it.
    #[must_use]
    pub fn unless(self, why: Option<&str>) -> Self {
        match why {
            Some(why) => Self { quantity: self.quantity.without_value(why.to_owned()), advice: None, ..self },
            None => self,
        }
    }

    /// The same, shown on the terminal.
    #[must_use]
    pub fn shown(self) -> Self {
        Self { level: Level::Summary, ..self }
    }

    /// The same as a number of the headline.
    #[must_use]
    pub(super) fn first_of_all(self) -> Self {
        Self { level: Level::Headline, ..self }
    }

    /// The name for a heading: the title with a capital. A symbol, such as f_i", keeps its letter.
    pub fn heading(&self) -> String {
        if self.title.chars().nth(1) == Some('_') {
            return self.title.clone();
        }
        let mut letters = self.title.chars();
        letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    }
}
