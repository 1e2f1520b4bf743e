//! The program as a user starts it.

mod axes;
mod check;
mod compare;
mod cut;
mod hobbing;
mod nothing_lost;
mod once;
mod pair;
#[cfg(unix)]
mod stopped;
mod texture;
mod usage;
mod warnings;
