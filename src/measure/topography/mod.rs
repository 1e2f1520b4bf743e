//! Surface texture: areal parameters of ISO 25178-2 and profile parameters of ISO 21920-2.
//!
//! In: a [`Surface`], measured or cut, and a [`Chain`] of form removal, filters and crop. Out: [`Evaluation`], the full set with units, definitions and, where a value does not exist, the reason.
//!
//! | what | where |
//! | --- | --- |
//! | heights on a grid with holes | [`surface`] |
//! | F-operator, S- and L-filter, crop | [`chain`]: [`form`], [`gaussian`] |
//! | Sa Sq Ssk Sku Sp Sv Sz | [`height`] |
//! | Sdq Sdr | [`hybrid`] |
//! | Sal Str Std Ssw | [`spatial`], from the `spectrum` |
//! | Smr Smc Sdc Sxp Vm Vv Vmp Vmc Vvc Vvv | [`ratio`] |
//! | Sk Spk Svk Smr1 Smr2 Spkx Svkx Sak1 Sak2 | [`core`] |
//! | Spd Spc S10z S5p S5v | [`features`], from the `watershed` |
//! | Ra Rq Rz Rt RSm Rsk Rku Rk Rpk Rvk Mr1 Mr2 | [`profile`] |
//!
//! Holes are left out of sums and curves, count as the edge of the map for hills, and keep Std and Ssw from being defined; the autocorrelation divides by the pairs that were measured.

pub mod chain;
pub mod core;
pub mod features;
pub mod form;
pub mod gaussian;
pub mod height;
pub mod hybrid;
pub mod parameters;
pub mod profile;
pub mod ratio;
pub mod spatial;
mod spectrum;
pub mod surface;
mod watershed;

pub use chain::Chain;
pub use form::Form;
pub use parameters::{Arguments, Evaluation, Parameter};
pub use profile::Profile;
pub use surface::Surface;
