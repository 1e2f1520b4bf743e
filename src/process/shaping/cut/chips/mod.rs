//! The chip ledger: what every stroke takes away, how thick, and with what force.
//!
//! In: a [`crate::process::shaping::ShapingJob`]. Out: [`ChipLedger`] with one [`StrokeChips`] per stroke and maps of
//! uncut chip thickness over stroke and edge, and over tooth space and edge.
//!
//! Every tooth space is a [`section::SpaceSection`] of its own, in the transverse plane in the middle of the face, and
//! sees **all** passes that come where its own teeth come in strict order of time: nothing is left out because it does
//! not shape the final surface. Each cutter tooth in each stroke belongs to the space that its tip stands in; so every
//! chip is counted once. Where the axes rest during the stroke all sections are equal and the ledger is exact for the
//! whole face; where the feed goes on, the middle section stands for the face, the others being the same a fraction of
//! a stroke earlier or later.
//!
//! Rays on a flank see only the chips that shape it, and those exactly: [`flank`] says with how thick a chip each place
//! of a flank was cut last. Where edges are rounded, what is left depends on the order of passes, and is found here as
//! well.

mod along_rows;
mod column_group;
mod deciding;
pub mod deflection;
mod entry;
pub mod flank;
pub mod ledger;
mod near;
pub mod oblique;
mod own_region;
mod phase_heights;
mod ploughing;
mod rays;
pub mod section;
mod segments;
mod shared_segment;
mod space;
pub mod stroke;
mod stroke_looks;
mod vibration;

#[cfg(feature = "testing")]
pub use deflection::deflections;
pub use entry::entries;
#[cfg(feature = "testing")]
pub use flank::last_chips;
pub(in crate::process::shaping) use flank::{last_chips_at, last_chips_on_map};
pub use ledger::{ChipLedger, OperationChips, ThicknessMap};
pub(in crate::process::shaping) use ploughing::layers as ploughed_layers;
pub use stroke::StrokeChips;
pub use vibration::as_cut;
