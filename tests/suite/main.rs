//! All integration tests in one program: one link instead of fifty, and cuts that several tests look at are made once.
//!
//! `cargo test --test suite gpu::` runs a part, `-- --skip slow::` leaves out what takes minutes: every test of more
//! than some ten seconds stands in a module `slow` beside the quick ones of its subject. `tests/run` says which part
//! runs when.

mod broken_files;
mod dependencies;
mod export;
mod fixtures;

mod bevel;
mod floors;
#[cfg(feature = "gpu")]
mod gpu;
mod hobbing;
mod influence;
mod library;
mod notices;
mod output;
mod posts;
mod program;
mod scene;
mod shaping;
mod study;
mod texture;
mod tools;
