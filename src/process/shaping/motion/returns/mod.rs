//! Return strokes: which way the cutter is drawn back from the work, how it clears there, and what that costs.
//!
//! In: the operations of a job (linkage, cutter, blank) and what the scene says of the retraction. Out: the law of
//! every stroke ([`plan`]), the room between the returning cutter and the work ([`clearance`], over a turn [`survey`]),
//! travel and time of the axes ([`motion`]). The laws themselves are in
//! [`crate::process::shaping::linkage::retraction`].

pub mod clearance;
pub mod edge_distance;
pub mod facts;
pub mod motion;
mod overlap;
mod path;
pub mod plan;
pub mod survey;
pub mod swept;
pub mod tooth_distance;

pub use plan::RetractionPlan;
