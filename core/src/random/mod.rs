//! Seeded random streams and draws with bounded work.
//!
//! Every particle of every frame draws from a [`Stream`] of its own, derived from (seed, frame,
//! index). So a result depends neither on the order nor on the number of threads in which particles
//! are handled.
//!
//! ```
//! use sinew_core::random::Stream;
//!
//! // The stream of particle 7 in frame 3 is always the same, and no other's.
//! let draws = |index| {
//!     let mut stream = Stream::new(1, 3, index);
//!     [stream.uniform(), stream.normal(), stream.truncated_normal(2.0, 2.5), stream.von_mises(0.0, 10.0)]
//! };
//! assert_eq!(draws(7), draws(7));
//! assert_ne!(draws(7), draws(8));
//! assert!((2.0..=2.5).contains(&draws(7)[2]));
//! ```

pub mod lanes;
pub mod normal;
pub mod normal_table;
pub mod stream;
pub mod truncated_normal;
pub mod von_mises;

pub use lanes::StreamLanes;
pub use stream::Stream;
