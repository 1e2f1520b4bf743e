//! An axis by its name and kind: units and names of columns follow from the kind alone.
//!
//! Inside gearcut angles are rad and lengths mm; people, files and controls read deg and mm. What an axis does is
//! turned from the one into the other by its [`AxisKind`] alone. Road not taken: a unit as text beside each number, or
//! a rule by the axis's place in a list; both let a new axis pass in the wrong unit.

/// How an axis moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxisKind {
    /// It turns: rad inside, deg where it is read.
    Rotary,
    /// It slides: mm everywhere.
    Linear,
}

/// What of an axis's motion is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// Where it stands.
    Position,
    /// Its rate.
    Speed,
    /// The rate of its rate.
    Acceleration,
}

/// An axis of a machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Axis {
    /// What tables and charts call it, such as `work spindle`.
    pub name: &'static str,
    /// What sentences about programs call it.
    pub noun: &'static str,
    /// Stem of its columns of speed and acceleration, such as `work`.
    pub stem: &'static str,
    /// Stem of its column of positions: the symbol of the literature, such as `psi_c`, or the same stem.
    pub position_stem: &'static str,
    /// Its word in programs.
    pub letter: char,
    /// How it moves.
    pub kind: AxisKind,
    /// It moves at constant feeds with corners between them: there is no acceleration to state.
    pub constant_feed: bool,
}

impl AxisKind {
    /// A value of any order, from rad or mm to the unit in which it is read.
    pub fn shown(self, value: f64) -> f64 {
        match self {
            Self::Rotary => value.to_degrees(),
            Self::Linear => value,
        }
    }

    /// A value of any order, from the unit in which it is read to rad or mm.
    pub fn read(self, shown: f64) -> f64 {
        match self {
            Self::Rotary => shown.to_radians(),
            Self::Linear => shown,
        }
    }

    /// Unit in which a value is read, as files and the terminal write it.
    pub fn unit(self, order: Order) -> &'static str {
        match (self, order) {
            (Self::Rotary, Order::Position) => "deg",
            (Self::Rotary, Order::Speed) => "deg/s",
            (Self::Rotary, Order::Acceleration) => "deg/s^2",
            (Self::Linear, Order::Position) => "mm",
            (Self::Linear, Order::Speed) => "mm/s",
            (Self::Linear, Order::Acceleration) => "mm/s^2",
        }
    }

    /// The same unit as charts and pages write it.
    pub fn sign(self, order: Order) -> &'static str {
        match (self, order) {
            (Self::Rotary, Order::Position) => "°",
            (Self::Rotary, Order::Speed) => "°/s",
            (Self::Rotary, Order::Acceleration) => "°/s²",
            (Self::Linear, Order::Position) => "mm",
            (Self::Linear, Order::Speed) => "mm/s",
            (Self::Linear, Order::Acceleration) => "mm/s²",
        }
    }

    /// The same unit at the end of a column's name.
    fn suffix(self, order: Order) -> &'static str {
        match (self, order) {
            (Self::Rotary, Order::Position) => "deg",
            (Self::Rotary, Order::Speed) => "deg_per_s",
            (Self::Rotary, Order::Acceleration) => "deg_per_s2",
            (Self::Linear, Order::Position) => "mm",
            (Self::Linear, Order::Speed) => "mm_per_s",
            (Self::Linear, Order::Acceleration) => "mm_per_s2",
        }
    }
}

impl Order {
    /// `position`, `speed`, `acceleration`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Speed => "speed",
            Self::Acceleration => "acceleration",
        }
    }
}

impl Axis {
    /// An axis whose sentences and columns of positions use its name and stem.
    pub const fn new(name: &'static str, stem: &'static str, letter: char, kind: AxisKind) -> Self {
        Self { name, noun: name, stem, position_stem: stem, letter, kind, constant_feed: false }
    }

    /// The same axis with another word for it in sentences about programs.
    #[must_use]
    pub const fn called(self, noun: &'static str) -> Self {
        Self { noun, ..self }
    }

    /// The same axis with the symbol of its position.
    #[must_use]
    pub const fn at(self, position_stem: &'static str) -> Self {
        Self { position_stem, ..self }
    }

    /// The same axis at constant feeds.
    #[must_use]
    pub const fn at_constant_feed(self) -> Self {
        Self { constant_feed: true, ..self }
    }

    /// Name of its column in tables, unit included: `psi_c_deg`, `work_speed_deg_per_s`.
    pub fn column(&self, order: Order) -> String {
        format!("{}_{}", self.key(order), self.kind.suffix(order))
    }

    /// The same without the unit.
    pub fn key(&self, order: Order) -> String {
        match order {
            Order::Position => self.position_stem.to_owned(),
            Order::Speed | Order::Acceleration => format!("{}_{}", self.stem, order.word()),
        }
    }

    /// Whether it has something to say of this order.
    pub fn has(&self, order: Order) -> bool {
        !(self.constant_feed && order == Order::Acceleration)
    }
}
