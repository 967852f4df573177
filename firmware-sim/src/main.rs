//! What camera firmware does with the core, run on the host.

fn main() {}
