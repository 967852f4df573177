//! What goes into the arm trackers, and what comes out.

use super::object::list;
use super::status::{Answer, SinewStatus};
use crate::error::{finite, positive, within};
use crate::math::Vec3;
use crate::ranges::MAX_PX;
use crate::saved_state::{SavedState, StateVisitor};
use crate::skeleton::Side;
use crate::tracker::arm::{ArmEstimate, ArmImage, ArmModel, Status};
use crate::vision::candidate::HandCandidate;
use crate::vision::edges::EdgePixel;

/// Most particles of an arm tracker.
pub const SINEW_ARM_PARTICLES: usize = 50;
/// Most hand candidates of a frame; the eight most likely of them are considered.
pub const SINEW_MAX_CANDIDATES: usize = 32;
/// Most edge pixels of a frame.
pub const SINEW_MAX_EDGES: usize = 4096;
/// The person's own left arm.
pub const SINEW_SIDE_LEFT: u32 = 0;
/// The person's own right arm.
pub const SINEW_SIDE_RIGHT: u32 = 1;
/// No blob carried the estimate for so long that the prediction means nothing.
pub const SINEW_ARM_LOST: u32 = 0;
/// No blob of this frame carries the estimate; it is a prediction.
pub const SINEW_ARM_PREDICTED: u32 = 1;
/// A blob of this frame that is likely a hand carries the estimate.
pub const SINEW_ARM_TRACKING: u32 = 2;
/// A blob of this frame carries the estimate that is less likely a hand.
pub const SINEW_ARM_UNCERTAIN: u32 = 3;

/// What a frame showed.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct SinewArmFrame {
    /// When the frame was taken, microseconds since any start. Dropped frames are simply not given.
    /// A counter of 32 bits goes through `sinew_clock_us`.
    pub timestamp_us: u64,
    /// Blobs that may be a hand, as `sinew_vision_end_frame` gives them; not looked at if
    /// `candidate_count` is zero.
    pub candidates: *const HandCandidate,
    /// Temporal edge pixels; not looked at if `edge_count` is zero.
    pub edges: *const EdgePixel,
    /// Number of candidates, at most `SINEW_MAX_CANDIDATES`.
    pub candidate_count: u32,
    /// Number of edge pixels, at most `SINEW_MAX_EDGES`.
    pub edge_count: u32,
    /// 0 where the image is missing, so that the lists say nothing; else 1.
    pub has_image: u32,
    /// Left and right shoulder, metres in camera axes; a tracker of one arm looks at its own side
    /// only.
    pub shoulders_m: [[f32; 3]; 2],
}

/// An arm after a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SinewArmResult {
    /// That of the frame.
    pub timestamp_us: u64,
    /// `SINEW_SIDE_LEFT` or `SINEW_SIDE_RIGHT`.
    pub side: u32,
    /// `SINEW_ARM_TRACKING`, `SINEW_ARM_UNCERTAIN`, `SINEW_ARM_PREDICTED` or `SINEW_ARM_LOST`.
    pub state: u32,
    /// Shoulder, metres in camera axes.
    pub shoulder_m: [f32; 3],
    /// Elbow, metres in camera axes.
    pub elbow_m: [f32; 3],
    /// Middle of the hand, metres in camera axes.
    pub hand_m: [f32; 3],
    /// Image of the hand: column and row, pixels; -1 where it lies behind the camera.
    pub hand_px: [f32; 2],
    /// Elevation, deviation and axial rotation of the shoulder, flexion of the elbow, radians.
    pub angles_rad: [f32; 4],
    /// Standard deviation of the hand, metres along an axis.
    pub hand_std_m: f32,
    /// Effective number of particles.
    pub effective_sample_size: f32,
    /// Natural logarithm of the mean weight; zero where nothing was seen.
    pub log_evidence: f32,
    /// Likelihood of the blob that carries the estimate; zero without one.
    pub hand_likelihood: f32,
    /// Index of that blob in the frame's list, -1 without one.
    pub candidate: i32,
    /// Candidates that were not considered.
    pub dropped_candidates: u32,
    /// 1 if all weights were zero and the frame taught nothing.
    pub is_degenerate: u32,
    /// Zero.
    pub reserved: u32,
}

/// What changes from frame to frame in a tracker of one arm or of both.
#[derive(Debug)]
pub(super) struct ArmMemory<T> {
    /// That of the last frame, if there was one.
    timestamp_us: Option<u64>,
    pub tracker: T,
}

impl<T> ArmMemory<T> {
    /// Forgets the last frame's timestamp.
    pub const fn forget(&mut self) {
        self.timestamp_us = None;
    }

    /// Takes over the timestamp of a new frame, which has to lie after that of the last one.
    pub fn admit(&mut self, timestamp_us: u64) -> Answer {
        if self.timestamp_us.is_some_and(|last_us| timestamp_us <= last_us) {
            return Err(SinewStatus::OutOfOrder);
        }
        self.timestamp_us = Some(timestamp_us);
        Ok(())
    }
}

impl<T: SavedState> SavedState for ArmMemory<T> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.optional_long(&mut self.timestamp_us);
        self.tracker.visit(visitor);
    }
}

pub(super) fn shoulder(shoulders_m: &[[f32; 3]; 2], side: Side) -> Result<Vec3, SinewStatus> {
    let [left, right] = *shoulders_m;
    let place = match side {
        Side::Left => left,
        Side::Right => right,
    };
    Ok(crate::ranges::place("shoulders_m", &Vec3::from(place))?)
}

impl SinewArmFrame {
    /// The lists, checked; `None` without an image.
    ///
    /// # Safety
    /// The pointers have as many elements as is said.
    pub(super) unsafe fn image(&self) -> Result<Option<ArmImage<'_>>, SinewStatus> {
        let (candidate_count, edge_count) = (self.candidate_count as usize, self.edge_count as usize);
        if candidate_count > SINEW_MAX_CANDIDATES || edge_count > SINEW_MAX_EDGES {
            return Err(SinewStatus::OverCapacity);
        }
        if self.has_image == 0 {
            return Ok(None);
        }
        // SAFETY: the caller's duty.
        let (candidates, edges) = unsafe { (list(self.candidates, candidate_count)?, list(self.edges, edge_count)?) };
        for candidate in candidates {
            check_candidate(candidate)?;
        }
        Ok(Some(ArmImage { candidates, edges }))
    }

    /// The shoulder of `side`.
    pub(super) fn shoulder(&self, side: Side) -> Result<Vec3, SinewStatus> {
        shoulder(&self.shoulders_m, side)
    }
}

fn check_candidate(candidate: &HandCandidate) -> Answer {
    for coordinate in [candidate.centre.u_px, candidate.centre.v_px] {
        within("centre", coordinate, -MAX_PX, MAX_PX)?;
    }
    for moment in candidate.moments_px2 {
        within("moments_px2", finite("moments_px2", moment)?, -MAX_PX * MAX_PX, MAX_PX * MAX_PX)?;
    }
    within("area_px", positive("area_px", candidate.area_px)?, 0.0, MAX_PX * MAX_PX)?;
    within("likelihood", candidate.likelihood, 0.0, 1.0)?;
    Ok(())
}

impl SinewArmResult {
    pub(super) fn of(timestamp_us: u64, model: &ArmModel, estimate: &ArmEstimate) -> Self {
        let hand_px = model.camera().project(&estimate.joints.hand_m).map_or([-1.0; 2], |hand| [hand.u_px, hand.v_px]);
        Self {
            timestamp_us,
            side: if estimate.side == Side::Left { SINEW_SIDE_LEFT } else { SINEW_SIDE_RIGHT },
            state: match estimate.status {
                Status::Lost => SINEW_ARM_LOST,
                Status::Predicted => SINEW_ARM_PREDICTED,
                Status::Uncertain => SINEW_ARM_UNCERTAIN,
                Status::Tracking => SINEW_ARM_TRACKING,
            },
            shoulder_m: estimate.joints.shoulder_m.into(),
            elbow_m: estimate.joints.elbow_m.into(),
            hand_m: estimate.joints.hand_m.into(),
            hand_px,
            angles_rad: estimate.angles_rad,
            hand_std_m: estimate.hand_std_m,
            effective_sample_size: estimate.effective_sample_size,
            log_evidence: estimate.log_evidence,
            hand_likelihood: estimate.hand_likelihood,
            candidate: estimate.candidate.map_or(-1, |index| index as i32),
            dropped_candidates: estimate.dropped_candidates as u32,
            is_degenerate: u32::from(estimate.degenerate),
            reserved: 0,
        }
    }
}
