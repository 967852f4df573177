//! What moving edges say of the limbs, for every place where the hand may be.
//!
//! Edge pixels are sorted to the limbs of a supposed arm. The last estimate is one such arm. Each
//! blob that particles are sent to gives another (the last estimate with its hand corrected to the
//! blob). So a blob whose arm moves is preferred to one at which nothing moves, also when the last
//! estimate was wrong.

use super::context::FrameContext;
use super::estimate::ArmJoints;
use super::frame::ArmImage;
use crate::correction::elbow::nearest_elbow;
use crate::math::{Vec3, max, unit};
use crate::observation::hough::dynamic_hough;
use crate::observation::limbs::{LimbPixels, split};
use crate::observation::orientation::OrientationDensity;
use crate::random::Stream;
use crate::vision::edges::EdgePixel;
use heapless::Vec;

/// Blobs that get orientation densities of their own.
pub(super) const MAX_HYPOTHESES: usize = 3;

/// Orientation densities of both limbs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LimbDensities {
    pub upper: OrientationDensity,
    pub fore: OrientationDensity,
}

/// Densities of the last estimate's arm and of the arms that reach to the first blobs.
#[derive(Debug, Clone)]
pub(super) struct LimbHypotheses {
    pub estimate: LimbDensities,
    pub blobs: Vec<LimbDensities, MAX_HYPOTHESES>,
}

impl LimbHypotheses {
    /// The densities for a hand at candidate `index`, or at none.
    pub fn at(&self, index: Option<usize>) -> &LimbDensities {
        index.and_then(|index| self.blobs.get(index)).unwrap_or(&self.estimate)
    }
}

impl LimbDensities {
    /// Before [`OrientationDensity::begin`].
    pub const fn empty() -> Self {
        Self { upper: OrientationDensity::empty(), fore: OrientationDensity::empty() }
    }
}

/// Where a frame's hypotheses are measured: part of the tracker, so that a step takes less stack.
/// Holds nothing between frames.
#[derive(Debug, Clone)]
pub(super) struct LimbRoom {
    pub hypotheses: LimbHypotheses,
    pixels: LimbPixels,
}

impl LimbRoom {
    pub const fn empty() -> Self {
        Self {
            hypotheses: LimbHypotheses { estimate: LimbDensities::empty(), blobs: Vec::new() },
            pixels: LimbPixels::none(),
        }
    }
}

/// Measures all hypotheses in `room`, whose estimate is what is still known from before of the last
/// estimate's arm.
#[inline(never)]
pub(super) fn observe(
    context: &FrameContext<'_>,
    last: &ArmJoints,
    image: &ArmImage<'_>,
    stream_of: impl Fn(u32) -> Stream,
    room: &mut LimbRoom,
) {
    let LimbRoom { hypotheses: LimbHypotheses { estimate, blobs }, pixels } = room;
    measure(context, last, image.edges, &mut stream_of(0), (pixels, estimate));
    blobs.clear();
    let hand = context.model.camera().project(&last.hand_m);
    for index in 0..context.candidates.len().min(MAX_HYPOTHESES) {
        // One entry a candidate, and no more candidates than entries.
        let _ = blobs.push(*estimate);
        let Some(densities) = blobs.last_mut() else { break };
        if context.counts.get(index) == Some(&0) || context.candidate_at(hand) == Some(index) {
            continue;
        }
        densities.upper.forget();
        densities.fore.forget();
        if let Some(arm) = arm_to_blob(context, last, index) {
            measure(context, &arm, image.edges, &mut stream_of(1 + index as u32), (pixels, densities));
        }
    }
}

/// The last estimate with its hand corrected to candidate `index` and its elbow made to fit.
fn arm_to_blob(context: &FrameContext<'_>, last: &ArmJoints, index: usize) -> Option<ArmJoints> {
    let (mean_m, ray, _) =
        context.corrected_hand(&last.hand_m, &unit(last.hand_m - last.elbow_m).unwrap_or(Vec3::zeros()), index)?;
    let hand_m = context.reachable.along_ray(&mean_m, &ray);
    let geometry = context.model.geometry();
    let elbow_m = nearest_elbow(&context.shoulder_m, &hand_m, geometry.upper_arm_m, geometry.forearm_m, &last.elbow_m);
    Some(ArmJoints { shoulder_m: context.shoulder_m, elbow_m, hand_m })
}

/// Densities of the moving edges near `arm`; a limb without them keeps what it had.
#[inline(never)]
fn measure(
    context: &FrameContext<'_>,
    arm: &ArmJoints,
    edges: &[EdgePixel],
    stream: &mut Stream,
    (pixels, densities): (&mut LimbPixels, &mut LimbDensities),
) {
    let options = context.model.options();
    let points = context.model.image_points(&arm.shoulder_m, &arm.elbow_m, &arm.hand_m);
    let Some(points) = points else { return };
    let band_px = options.limb_band_m * context.model.camera().focal_px() / max(arm.elbow_m.z, 0.1);
    split(edges, &points, band_px, pixels);
    for (pixels, density) in [(&pixels.upper, &mut densities.upper), (&pixels.fore, &mut densities.fore)] {
        if let Some(found) = dynamic_hough(pixels.as_slice(), &options.hough, stream) {
            *density = found.density;
        }
    }
}
