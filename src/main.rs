//! The `gearcut` command.
fn main() {}
