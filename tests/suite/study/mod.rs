//! Studies: cases and their rows.

mod cases;
mod command;
mod left_out;
