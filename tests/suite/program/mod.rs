//! The program as a user starts it.

mod auto;
mod axes;
mod check;
mod check_cost;
mod compare;
mod cut;
mod damaged_programs;
mod defaults;
mod disk_faults;
mod error_layers;
mod hobbing;
mod measured_surface;
mod nothing_lost;
mod once;
mod pair;
mod paper;
mod quantities;
mod scatter;
#[cfg(unix)]
mod stopped;
#[cfg(target_os = "linux")]
mod terminal;
mod texture;
mod texture_lines;
mod usage;
mod warnings;
