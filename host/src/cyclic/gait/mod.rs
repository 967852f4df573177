//! Gait events and what is read off them: foot strikes, toe-offs, stance, swing, steps, speed.
//!
//! Which cycle a foot is in shows in how far it is before the hips (J. A. Zeni, J. G. Richards, J.
//! S. Higginson, Gait & Posture 27, 2008): it strikes about where it is farthest before them, and
//! leaves the ground about where it is farthest behind. When it does shows in its speed (S.
//! Ghoussayni, C. Stevens, S. Durham, D. Ewins, Gait & Posture 20, 2004): on the ground it goes
//! back under the hips as fast as the person walks.

mod direction;
mod events;
mod extrema;
mod foot_paths;
mod means;
mod no_gait;
mod of_table;
mod scale;
mod strides;
#[cfg(test)]
mod tests;

pub use direction::Direction;
pub use events::{FootEvents, GaitEvents, PointUsed};
pub use means::{FootMeans, MeanStd};
pub use no_gait::NoGait;
pub use of_table::{Gait, of_table};
pub use scale::Scale;
pub use strides::{Foot, Stride};
