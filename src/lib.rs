//! gearcut moves a machine's axes by its linkage model, sweeps every real cutting edge stroke by stroke
//! through dexels of the blank, and measures what is left.
//!
//! The modules follow the data's path: [`scene`] -> [`gear`] and [`tool`] -> [`linkage`] -> [`passes`] -> [`dexel`] ->
//! [`cut`] -> [`measure`] -> [`output`]; [`run`] alone knows the whole order.

pub mod error;
pub mod gear;
pub mod linkage;
pub mod output;
pub mod scene;
pub mod units;

pub use error::{Error, Refusal, Result};
