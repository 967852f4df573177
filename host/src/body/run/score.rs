//! How far a track is from the truth: on the skin by PIK (34), at the joints, and lost joints.

use crate::body::tracking::BodyFilter;
use crate::body::tracking::ambiguity::LOST_JOINT_M;
use crate::body::tracking::filter::WholeBodyEstimate;
use crate::body::{BodyJoints, BodyPart};
use sinew_core::math::Vec3;
use sinew_core::skeleton::upper_body::{UPPER_BONES, upper_bones};
use sinew_core::tracker::body::Legs;

/// A mean that grows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RunningMean {
    sum: f64,
    count: f64,
}

impl RunningMean {
    /// Takes one more value.
    pub fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1.0;
    }

    /// The mean; `None` of nothing.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0.0).then(|| self.sum / self.count)
    }
}

/// Errors of the frames so far.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BodyScore {
    /// Distance of the markers from the skin of the estimate, PIK (34), metres.
    pub marker_m: RunningMean,
    /// Distance of the joints from the true ones, metres.
    pub joint_m: RunningMean,
    /// One for a frame with a lost joint ([`LOST_JOINT_M`]), zero for one without.
    pub lost: RunningMean,
}

impl BodyScore {
    /// Compares one frame with its true joints and markers, metres; returns the mean distance of
    /// its joints, metres.
    pub fn add(
        &mut self,
        filter: &BodyFilter,
        estimate: &WholeBodyEstimate,
        joints_m: &BodyJoints,
        markers_m: &[Option<Vec3>],
    ) -> Option<f64> {
        let surface = filter.scene().surface(&filter.scene().posture(&estimate.angles_rad));
        let legs = untracked_legs(filter, joints_m);
        for marker_m in markers_m.iter().flatten().filter(|marker_m| !legs.is_some_and(|legs| legs.hold(marker_m))) {
            self.marker_m.add(f64::from(surface.skin_distance_m(marker_m)));
        }
        let (mut frame, mut farthest_m) = (RunningMean::default(), None);
        for (found_m, true_m) in estimate.ends_m.iter().zip(joints_m).take(filter.part().bones()) {
            if let Some(true_m) = true_m {
                let distance_m = f64::from((found_m - true_m).norm());
                self.joint_m.add(distance_m);
                frame.add(distance_m);
                farthest_m = Some(distance_m.max(farthest_m.unwrap_or(0.0)));
            }
        }
        if let Some(farthest_m) = farthest_m {
            self.lost.add(f64::from(u8::from(farthest_m > f64::from(LOST_JOINT_M))));
        }
        frame.mean()
    }
}

/// The true legs where only the upper body is tracked.
fn untracked_legs(filter: &BodyFilter, joints_m: &BodyJoints) -> Option<Legs> {
    if filter.part() == BodyPart::Whole {
        return None;
    }
    let mut ends_m = [Vec3::zeros(); UPPER_BONES];
    for (end_m, joint_m) in ends_m.iter_mut().zip(joints_m) {
        *end_m = (*joint_m)?;
    }
    let scene = filter.scene();
    Some(Legs::of(&ends_m, &upper_bones(&scene.radii_m), scene.likelihood.outlier_m))
}
