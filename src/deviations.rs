//! Measured points of a gear, laid on its target: which flank each belongs to, and how far it is off along the normal.
//!
//! In: points of a measuring machine or of a drawing ([`probed`]), and a gear. Out: [`fit::LaidPoints`]: tooth, flank,
//! place and normal deviation of each point that lies on a flank, and how the points were moved; its folder of files
//! ([`write()`]), whose `tables/deviations.csv` is what `gearcut diagnose` and `gearcut calibrate` read.
//!
//! **Law.** A point p belongs to the place (u, v) of a flank on whose normal it lies: p = o(u, v) + h n(u, v), and h is
//! its deviation ([`feet`]). The points are moved as a rigid body, as far as the fit is free to, until the squares of h
//! have the least sum ([`fit`]): what a measuring machine does when it aligns a gear to its drawing.
//!
//! Road not taken: distances from a mesh of the target. Chords of triangles are further off than the deviations.

mod feet;
mod findings;
mod fit;
pub(crate) mod notices;
mod page;
pub mod probed;
pub mod quantities;

pub use feet::Foot;
pub use findings::findings;
pub use fit::{FitFreedom, lay};
pub use page::write;
