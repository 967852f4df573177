//! Seeded random streams and draws with bounded work.
//!
//! Every particle of every frame draws from a [`Stream`] of its own, derived from (seed, frame, index), so a result
//! depends neither on the order nor on the number of threads in which particles are handled.

pub mod lanes;
pub mod normal;
pub mod normal_table;
pub mod stream;
pub mod truncated_normal;
pub mod von_mises;

pub use lanes::StreamLanes;
pub use stream::Stream;
