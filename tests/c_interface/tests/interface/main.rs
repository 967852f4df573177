//! The interface for C: its header, examples, archives, stack and proofs. One program, so that the
//! libraries which these build compile beside each other.

mod examples;
mod header;
mod interrupts;
mod no_panic;
mod on_panic;
mod packages;
mod stack;
