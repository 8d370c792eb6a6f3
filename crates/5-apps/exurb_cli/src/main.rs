//! The `exurb` command.
fn main() {}
