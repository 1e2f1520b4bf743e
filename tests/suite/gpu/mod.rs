//! The shaders on a software adapter; every test here needs one, but for those of the shaders as text.

mod blades;
mod deferred;
mod failures;
mod golden;
mod hobbed_blank;
mod kernel;
mod patches;
mod scenes;
mod shaders;
mod shaped_blank;
mod spatial;
