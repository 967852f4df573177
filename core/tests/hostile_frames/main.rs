//! Trackers stay finite: hostile frames of every tracker, with clean ones after them.
//!
//! Numbers of a hostile frame are drawn from the corners of `f32`, each with both signs. The
//! corners are zeros, denormals, 1, 1e3, 1e10, 1e19, 1e35, the greatest number, infinity and NaN.
//! After each hostile frame the state is within its ranges and no variance is negative. After the
//! clean frames of a burst the estimate is that of a twin that was given no hostile frame.
//!
//! The long form gives each tracker a million hostile frames and takes an hour of one core:
//!
//! ```sh
//! SINEW_HOSTILE_FRAMES=1000000 cargo test --release -p sinew-core --test hostile_frames
//! ```

mod arm;
mod body;
mod corners;
mod cyclic;
mod cyclic_trackers;
mod drive;
mod hands;
mod options;
