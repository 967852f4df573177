//! One tracker on one motion: the PIK paper's measures, PIK (34) and PIK (35), and errors at the
//! joints.

use super::flagged::loses_unflagged;
use anyhow::Result;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sinew::body::recording::MarkerFrames;
use sinew::body::run::score::{BodyScore, RunningMean};
use sinew::body::tracking::filter::WholeBodyEstimate;
use sinew::body::tracking::{BodyFilter, BodyModelKind, BodyTuning};
use sinew::body::{BodyJoints, BodyPart, fit_pose};
use sinew::resume::crc32_of;
use sinew::stereo::StereoScene;
use sinew_core::kinematics::forward::posture;
use sinew_core::math::Vec3;
use sinew_core::observation::body_surface::BodySurface;
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::skeleton::full_body::{BODY_ANGLES, BODY_BONES, BODY_PARENTS, PELVIS, body_radii_m, full_body};
use std::time::Instant;

/// A motion as one camera saw it, ready for any number of trials.
#[derive(Debug, Clone)]
pub struct SeenMotion {
    /// How much of the body was seen and is tracked.
    pub part: BodyPart,
    /// Frames in a second.
    pub rate_hz: f32,
    /// True joints of each frame, metres.
    pub joints_m: Vec<BodyJoints>,
    /// Markers of each frame, metres.
    pub markers_m: Vec<Vec<Option<Vec3>>>,
    /// Markers of each frame that were recorded on the person, metres: of a .c3d; empty of other
    /// files.
    pub recorded_markers_m: MarkerFrames,
    /// Points of each frame, metres.
    pub clouds_m: Vec<Vec<Vec3>>,
    /// The person's measures.
    pub measures: sinew_core::skeleton::BodyMeasures,
    /// The pose of the first frame.
    pub first_rad: [f32; BODY_ANGLES],
    /// What is known of a stick in each frame; empty where there is none.
    pub stick: Vec<StickSight>,
    /// Place of the floor along y, metres; infinite where it is not known.
    pub floor_y_m: f32,
}

impl SeenMotion {
    /// Looks at a scene.
    ///
    /// # Errors
    /// Measures that no body has.
    pub fn of_scene(scene: &StereoScene) -> Result<Self> {
        let frames: Vec<usize> = (0..scene.len()).collect();
        let clouds_m = frames.par_iter().map(|&frame| scene.points_m(frame)).collect();
        let measures = *scene.measures();
        let joints_m: Vec<BodyJoints> = frames.iter().map(|&frame| *scene.joints_m(frame)).collect();
        Ok(Self {
            part: scene.options().part,
            rate_hz: scene.recording().rate_hz,
            first_rad: scene.first_pose()?.angles,
            markers_m: frames.iter().map(|&frame| scene.markers_m(frame)).collect(),
            recorded_markers_m: Vec::new(),
            joints_m,
            clouds_m,
            measures,
            stick: Vec::new(),
            floor_y_m: f32::INFINITY,
        })
    }

    /// What distinguishes this motion from others that the same options and seed make.
    #[must_use]
    pub fn key(&self) -> Value {
        crc32_of(&(&self.joints_m, &self.recorded_markers_m, &self.measures, &self.first_rad, &self.stick))
    }

    /// Eq. (34) of the poses nearest to the true joints, over the recorded markers and from the
    /// second frame on, metres. No tracker of this body gets below it. `None` without such markers.
    ///
    /// # Errors
    /// Measures that no body has.
    pub fn recorded_floor_m(&self) -> Result<Option<f64>> {
        let (skeleton, radii_m) = (full_body(&self.measures)?, body_radii_m(&self.measures));
        let (mut sum, mut pose_rad) = (RunningMean::default(), self.first_rad);
        for (joints, markers) in self.joints_m.iter().zip(&self.recorded_markers_m).skip(1) {
            pose_rad = fit_pose(&skeleton, joints, Some(&pose_rad)).angles;
            let surface = BodySurface::new(&posture(&skeleton, &Vec3::zeros(), &pose_rad), &radii_m, Vec3::zeros());
            for marker_m in markers.iter().flatten() {
                sum.add(f64::from(surface.skin_distance_m(marker_m)));
            }
        }
        Ok(sum.mean())
    }

    /// Mean length that a joint goes in a frame, PIK (35), metres.
    #[must_use]
    pub fn smoothness_m(&self) -> f64 {
        smoothness_m(self.part, self.joints_m.iter().copied())
    }
}

/// A person nearer than this is near, metres.
///
/// Chosen: from here on the simulated camera's distances scatter by less than a limb's thickness
/// after smoothing.
pub const NEAR_M: f32 = 6.0;

/// Errors at the joints of a person who is near.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NearErrors {
    /// Mean distance of the joints from the true ones, metres.
    pub joint_error_m: f64,
    /// Share of frames that have a joint more than 10 cm off.
    pub lost_joint_share: f64,
    /// Share of frames that have such a joint on a limb that is neither unobserved nor ambiguous.
    pub lost_unflagged_share: f64,
}

/// Measures of a pose over the frames of a trial, always together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PoseMeasures {
    /// Mean distance of the markers from the skin, PIK (34), metres.
    pub error_m: f64,
    /// Mean distance of the joints from the true ones, metres.
    pub joint_error_m: f64,
    /// Share of frames that have a joint more than 10 cm off.
    pub lost_joint_share: f64,
    /// Mean length that the start of a bone goes in a frame, PIK (35), metres.
    pub smoothness_m: f64,
}

/// What a trial measured.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TrialResult {
    /// Mean distance of the markers from the skin of the estimate, PIK (34), metres.
    pub error_m: f64,
    /// The same for the recorded markers of a .c3d, metres.
    pub recorded_error_m: Option<f64>,
    /// Mean distance of the joints from the true ones, metres.
    pub joint_error_m: f64,
    /// Share of frames that have a joint more than 10 cm off.
    pub lost_joint_share: f64,
    /// Both of the frames in which the true pelvis is nearer than [`NEAR_M`]; absent where none is.
    pub near: Option<NearErrors>,
    /// Mean length that the start of a bone goes in a frame, PIK (35), metres.
    pub smoothness_m: f64,
    /// The same measures of the pose before the deadband: each frame's own mean, PIK (30).
    pub before_deadband: PoseMeasures,
    /// Wall time of the tracker's step with what is done to the points before it, seconds a frame.
    pub seconds_per_frame: f64,
    /// Mean share of effective particles.
    pub effective_share: f64,
}

/// Tracks `motion` with `particles` particles; the first frame is given.
///
/// # Errors
/// Names a parameter of the tracker that broke a rule.
pub fn trial(
    motion: &SeenMotion,
    kind: BodyModelKind,
    tuning: &BodyTuning,
    particles: usize,
    seed: u64,
) -> Result<(TrialResult, Vec<WholeBodyEstimate>)> {
    let who = (&motion.measures, motion.first_rad);
    let mut filter =
        BodyFilter::of_part(motion.part, kind, *tuning, who, particles, seed)?.above_floor(motion.floor_y_m);
    let mut estimates = Vec::with_capacity(motion.clouds_m.len());
    let mut before_deadband: Vec<WholeBodyEstimate> = Vec::with_capacity(motion.clouds_m.len());
    let mut seconds = 0.0;
    let (mut near, mut near_unflagged) = (BodyScore::default(), RunningMean::default());
    for (frame, points_m) in motion.clouds_m.iter().enumerate().skip(1) {
        let stick = motion.stick.get(frame).copied().unwrap_or(StickSight::Unseen);
        let mut points_m = points_m.clone();
        let start = Instant::now();
        let blocks = filter.blocks(&mut points_m);
        let estimate = filter.step(&blocks, 1.0 / motion.rate_hz, stick);
        seconds += start.elapsed().as_secs_f64();
        let (angles_rad, ends_m) = filter.before_deadband();
        before_deadband.push(WholeBodyEstimate { angles_rad, ends_m, ..estimate });
        let joints_m = &motion.joints_m[frame];
        if joints_m[PELVIS].is_some_and(|pelvis_m| pelvis_m.norm() < NEAR_M) {
            let _ = near.add(&filter, &estimate, joints_m, &[]);
            near_unflagged.add(f64::from(u8::from(loses_unflagged(&filter, &estimate, joints_m))));
        }
        estimates.push(estimate);
    }
    let frames = estimates.len().max(1) as f64;
    let (reported, before_deadband) =
        (measures(motion, &filter, &estimates), measures(motion, &filter, &before_deadband));
    let mut recorded = BodyScore::default();
    for (estimate, markers) in estimates.iter().zip(motion.recorded_markers_m.iter().skip(1)) {
        let _ = recorded.add(&filter, estimate, &[None; BODY_BONES], markers);
    }
    let result = TrialResult {
        error_m: reported.error_m,
        recorded_error_m: recorded.marker_m.mean(),
        joint_error_m: reported.joint_error_m,
        lost_joint_share: reported.lost_joint_share,
        near: near_errors(&near, &near_unflagged),
        smoothness_m: reported.smoothness_m,
        before_deadband,
        seconds_per_frame: seconds / frames,
        effective_share: estimates.iter().map(|e| f64::from(e.effective_sample_size)).sum::<f64>()
            / (frames * particles as f64),
    };
    Ok((result, estimates))
}

/// The measures of poses whose first one is that of the second frame.
fn measures(motion: &SeenMotion, filter: &BodyFilter, poses: &[WholeBodyEstimate]) -> PoseMeasures {
    let mut score = BodyScore::default();
    for (pose, (joints, markers)) in poses.iter().zip(motion.joints_m.iter().zip(&motion.markers_m).skip(1)) {
        let _ = score.add(filter, pose, joints, markers);
    }
    PoseMeasures {
        error_m: score.marker_m.mean().unwrap_or(0.0),
        joint_error_m: score.joint_m.mean().unwrap_or(0.0),
        lost_joint_share: score.lost.mean().unwrap_or(0.0),
        smoothness_m: smoothness_m(motion.part, poses.iter().map(|pose| pose.ends_m.map(Some))),
    }
}

fn near_errors(near: &BodyScore, unflagged: &RunningMean) -> Option<NearErrors> {
    Some(NearErrors {
        joint_error_m: near.joint_m.mean()?,
        lost_joint_share: near.lost.mean()?,
        lost_unflagged_share: unflagged.mean()?,
    })
}

/// Eq. (35) from the second frame on: the mean over bones of how far a_l, the bone's start, goes in
/// a frame.
fn smoothness_m(part: BodyPart, frames: impl Iterator<Item = BodyJoints>) -> f64 {
    let mut sum = RunningMean::default();
    let mut before: Option<BodyJoints> = None;
    for joints in frames {
        if let Some(before) = before {
            for parent in BODY_PARENTS[..part.bones()].iter().flatten() {
                let start = usize::from(*parent);
                if let (Some(a), Some(b)) = (joints[start], before[start]) {
                    sum.add(f64::from((a - b).norm()));
                }
            }
        }
        before = Some(joints);
    }
    sum.mean().unwrap_or(0.0)
}
