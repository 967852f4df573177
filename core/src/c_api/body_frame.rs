//! What goes into the body tracker, and what comes out.

use crate::math::Vec3;
use crate::observation::point_cloud::LeftOut;
use crate::skeleton::upper_body::{UPPER_ANGLES, UPPER_BONES};
use crate::tracker::body::BodyEstimate;

/// Bones of an upper body: pelvis, trunk, head, left collar, upper arm, forearm, then the right
/// ones.
pub const SINEW_BODY_BONES: usize = 9;
/// Coordinates of an upper body: three shifts of the pelvis, its turn, tilt and pitch, three angles
/// of the head, then elevation, deviation and axial rotation of the shoulder and flexion of the
/// elbow, left and right.
pub const SINEW_BODY_COORDINATES: usize = 17;
/// Most points of a frame that are used.
pub const SINEW_BODY_POINTS: usize = 512;
/// The frame had no usable point: the pose is a prediction.
pub const SINEW_BODY_PREDICTED: u32 = 0;
/// The frame had points.
pub const SINEW_BODY_TRACKING: u32 = 1;

const _: () = assert!(SINEW_BODY_BONES == UPPER_BONES && SINEW_BODY_COORDINATES == UPPER_ANGLES);
const _: () = assert!(SINEW_BODY_POINTS == crate::tracker::body::upper::UPPER_POINTS);

/// The points of one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SinewBodyFrame {
    /// When the frame was taken, microseconds since any start. Dropped frames are simply not given.
    /// A counter of 32 bits goes through `sinew_clock_us`.
    pub timestamp_us: u64,
    /// Points in camera axes, metres: x to the right of the image, y down, z along the line of
    /// sight. They are brought into another order. A point at the camera, or with a NaN, is a
    /// hole. Not looked at if `point_count` is zero.
    pub points_m: *mut [f32; 3],
    /// Number of points, at most 65535; of more than `SINEW_BODY_POINTS` usable ones so many are
    /// taken evenly through the list.
    pub point_count: u32,
    /// Zero.
    pub reserved: u32,
}

/// An upper body after a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SinewBodyResult {
    /// That of the frame.
    pub timestamp_us: u64,
    /// `SINEW_BODY_TRACKING` or `SINEW_BODY_PREDICTED`.
    pub state: u32,
    /// Bit i is set where the points show bone i.
    pub observed: u32,
    /// The end of each bone, metres in camera axes: pelvis, neck, head, left shoulder, elbow,
    /// wrist, right shoulder, elbow, wrist.
    pub joints_m: [[f32; 3]; SINEW_BODY_BONES],
    /// Standard deviation of each, metres (root of the summed variances).
    pub joint_std_m: [f32; SINEW_BODY_BONES],
    /// Coordinates of the pose: shifts in metres, then angles in radians.
    pub coordinates: [f32; SINEW_BODY_COORDINATES],
    /// Natural logarithm of the density of pose and points, up to a constant.
    pub log_density: f32,
    /// Points that were used, and those that were left out: holes, and those over capacity.
    pub used_points: u32,
    /// See `used_points`.
    pub left_out_points: u32,
    /// Zero.
    pub reserved: u32,
}

impl SinewBodyResult {
    pub(super) fn of(
        timestamp_us: u64,
        estimate: &BodyEstimate<UPPER_BONES, UPPER_ANGLES>,
        point_count: u32,
        left_out: LeftOut,
    ) -> Self {
        let left_out_points =
            left_out.not_finite.saturating_add(left_out.at_camera).saturating_add(left_out.over_capacity);
        let used_points = point_count.saturating_sub(left_out_points);
        let mut observed = 0;
        for (bone, is_observed) in estimate.observed.iter().enumerate() {
            observed |= u32::from(*is_observed) << bone;
        }
        Self {
            timestamp_us,
            state: if used_points > 0 { SINEW_BODY_TRACKING } else { SINEW_BODY_PREDICTED },
            observed,
            joints_m: estimate.ends_m.map(|end_m: Vec3| end_m.into()),
            joint_std_m: estimate.spread_m,
            coordinates: estimate.angles_rad,
            log_density: estimate.log_evidence,
            used_points,
            left_out_points,
            reserved: 0,
        }
    }
}
