//! What moving edges say of the limbs, for every place where the hand may be.
//!
//! Edge pixels are sorted to the limbs of a supposed arm. The last estimate is one such arm; each blob that particles are
//! sent to gives another (the last estimate with its hand corrected to the blob). So a blob whose arm moves is
//! preferred to one at which nothing moves, also when the last estimate was wrong.

use super::estimate::ArmJoints;
use super::frame::ArmImage;
use super::propose::FrameContext;
use crate::correction::elbow::nearest_elbow;
use crate::math::{Vec3, max, unit};
use crate::observation::hough::dynamic_hough;
use crate::observation::limbs::split;
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

/// Measures all hypotheses into `result`, whose estimate is what is still known from before of the last estimate's arm.
///
/// In place and not inlined, so that a step's stack holds the densities once.
#[inline(never)]
pub(super) fn observe(
    context: &FrameContext<'_>,
    last: &ArmJoints,
    image: &ArmImage<'_>,
    stream_of: impl Fn(u32) -> Stream,
    result: &mut LimbHypotheses,
) {
    result.estimate = measure(context, last, image.edges, &result.estimate, &mut stream_of(0));
    result.blobs.clear();
    let known = result.estimate.upper;
    let uniform = OrientationDensity::uniform(known.bin_count()).unwrap_or(known);
    let unknown = LimbDensities { upper: uniform, fore: uniform };
    let hand = context.model.camera().project(&last.hand_m);
    for index in 0..context.candidates.len().min(MAX_HYPOTHESES) {
        let densities = if context.counts.get(index) == Some(&0) || context.candidate_at(hand) == Some(index) {
            result.estimate
        } else {
            arm_to_blob(context, last, index)
                .map_or(unknown, |arm| measure(context, &arm, image.edges, &unknown, &mut stream_of(1 + index as u32)))
        };
        // One entry a candidate, and no more candidates than entries.
        let _ = result.blobs.push(densities);
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

/// Densities of the moving edges near `arm`; a limb without them keeps `before`.
fn measure(
    context: &FrameContext<'_>,
    arm: &ArmJoints,
    edges: &[EdgePixel],
    before: &LimbDensities,
    stream: &mut Stream,
) -> LimbDensities {
    let options = context.model.options();
    let points = context.model.image_points(&arm.shoulder_m, &arm.elbow_m, &arm.hand_m);
    let Some(points) = points else { return *before };
    let band_px = options.limb_band_m * context.model.camera().focal_px() / max(arm.elbow_m.z, 0.1);
    let pixels = split(edges, &points, band_px);
    let mut density = |pixels: &[EdgePixel], before: OrientationDensity| {
        dynamic_hough(pixels, &options.hough, stream).map_or(before, |found| found.density)
    };
    LimbDensities { upper: density(&pixels.upper, before.upper), fore: density(&pixels.fore, before.fore) }
}
