//! Studies: cases and their rows.

mod cases;
mod command;
mod data_set;
mod left_out;
