//! A body or its upper part, tracked. There is one tracker of the core for each size, and its
//! answers are in the order of a whole body's bones.

use super::model_kind::BodyModelKind;
use super::sized::{SeenFrame, SizedBody, SizedFilter};
use super::tuning::BodyTuning;
use crate::body::{BodyPart, BodySize};
use crate::cloud::blocks_of;
use crate::error::Result;
use crate::resume::{from_text, to_text};
use sinew_core::error::ParameterError;
use sinew_core::math::{Vec3, axis_rotation, wrap_angle};
use sinew_core::observation::point_cloud::PointBlock;
use sinew_core::observation::point_likelihood::PointLikelihood;
use sinew_core::observation::range_smoothing::RangeSmoothing;
use sinew_core::pik::motion::{BodyParticle, BodyScene};
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::saved_state::StateKind;
use sinew_core::skeleton::full_body::{BODY_ANGLES, BODY_BONES, BodySkeleton, PELVIS, TRUNK, body_radii_m, full_body};
use sinew_core::skeleton::tree::{FREE_ROOT_COORDINATES, SHIFTS};
use sinew_core::skeleton::upper_body::{
    UPPER_ANGLES, UPPER_BONES, UPPER_COORDINATES, upper_body, upper_bones, upper_coordinates, upper_radii_m,
};
use sinew_core::skeleton::{BodyMeasures, Joint};
use sinew_core::tracker::body::{BodyEstimate, BodyFrame, Legs, angles_of_rotation};
use std::sync::OnceLock;

/// A whole body's estimate. Of an upper body the legs hang, are not observed and have no spread.
pub type WholeBodyEstimate = BodyEstimate<BODY_BONES, BODY_ANGLES>;
/// A whole body's hypothesis.
pub type WholeBodyParticle = BodyParticle<BODY_BONES, BODY_ANGLES>;

/// One tracker for each size of skeleton.
#[derive(Debug, Clone)]
enum Sizes {
    Whole(Box<SizedFilter<BODY_BONES, BODY_ANGLES>>),
    Upper(Box<SizedFilter<UPPER_BONES, UPPER_ANGLES>>),
}

/// One body, tracked.
#[derive(Debug, Clone)]
pub struct BodyFilter {
    tracked: Sizes,
    /// The whole body, with flesh where it is tracked.
    scene: BodyScene<BODY_BONES, BODY_ANGLES>,
    floor_y_m: f32,
    smoothing: Option<RangeSmoothing>,
    /// Particles of an upper body as those of a whole one, once somebody asks for them.
    completed: OnceLock<Vec<WholeBodyParticle>>,
}

impl BodyFilter {
    /// `particles` particles of a body with `measures` that begins at `first_rad`.
    ///
    /// # Errors
    /// Names the parameter that broke a rule.
    pub fn new(
        kind: BodyModelKind,
        tuning: BodyTuning,
        measures: &BodyMeasures,
        first_rad: [f32; BODY_ANGLES],
        particles: usize,
        seed: u64,
    ) -> Result<Self, ParameterError> {
        Self::of_part(BodyPart::Whole, kind, tuning, (measures, first_rad), particles, seed)
    }

    /// As [`Self::new`], of the `part` of a body that is seen; its first pose is a whole body's.
    ///
    /// # Errors
    /// Names the parameter that broke a rule.
    pub fn of_part(
        part: BodyPart,
        kind: BodyModelKind,
        tuning: BodyTuning,
        (measures, first_rad): (&BodyMeasures, [f32; BODY_ANGLES]),
        particles: usize,
        seed: u64,
    ) -> Result<Self, ParameterError> {
        let tuning = tuning.of_kind(kind);
        let (points, _) = tuning.points_and_goals(kind);
        let scene = BodyScene {
            skeleton: full_body(measures)?,
            radii_m: part.fleshed(&body_radii_m(measures)),
            camera_m: Vec3::zeros(),
            likelihood: PointLikelihood { std_m: points.std_m, outlier_m: points.outlier_m },
            self_penetration: None,
        };
        let tracked = match part {
            BodyPart::Whole => {
                let coordinates = std::array::from_fn(|index| index);
                let body = SizedBody { skeleton: scene.skeleton.clone(), radii_m: body_radii_m(measures), coordinates };
                Sizes::Whole(Box::new(SizedFilter::new(kind, tuning, body, first_rad, particles, seed)?))
            }
            BodyPart::Upper => {
                let (skeleton, coordinates) = (upper_body(measures)?, UPPER_COORDINATES);
                let body = SizedBody { skeleton, radii_m: upper_radii_m(measures), coordinates };
                let first_rad = upper_pose(&scene.skeleton, &scene.skeleton.clamp(first_rad));
                Sizes::Upper(Box::new(SizedFilter::new(kind, tuning, body, first_rad, particles, seed)?))
            }
        };
        let smoothing = tuning.range_smoothing()?;
        Ok(Self { tracked, scene, floor_y_m: f32::INFINITY, smoothing, completed: OnceLock::new() })
    }

    /// Puts the floor of the pelvic lift: the pelvis stays above (camera axes, y down), metres.
    #[must_use]
    pub fn above_floor(mut self, floor_y_m: f32) -> Self {
        self.floor_y_m = floor_y_m;
        self
    }

    /// Goes on with the same poses of a body of another size.
    ///
    /// # Errors
    /// Lengths that no body has.
    pub fn resize(&mut self, size: &BodySize) -> Result<(), ParameterError> {
        let BodySize { measures, radii_m } = size;
        let part = self.part();
        self.scene.skeleton = full_body(measures)?;
        self.scene.radii_m = part.fleshed(radii_m);
        self.completed = OnceLock::new();
        match &mut self.tracked {
            Sizes::Whole(filter) => filter.resize(full_body(measures)?, *radii_m),
            Sizes::Upper(filter) => filter.resize(upper_body(measures)?, upper_bones(radii_m)),
        }
    }

    /// How much of the body is tracked.
    #[must_use]
    pub fn part(&self) -> BodyPart {
        match self.tracked {
            Sizes::Whole(_) => BodyPart::Whole,
            Sizes::Upper(_) => BodyPart::Upper,
        }
    }

    /// The body and its camera; what is not tracked has no flesh.
    #[must_use]
    pub fn scene(&self) -> &BodyScene<BODY_BONES, BODY_ANGLES> {
        &self.scene
    }

    /// The particles after the last step and their weights.
    #[must_use]
    pub fn particles(&self) -> (&[WholeBodyParticle], &[f32]) {
        match &self.tracked {
            Sizes::Whole(filter) => (filter.particles(), filter.weights()),
            Sizes::Upper(filter) => {
                let complete = |particle: &BodyParticle<UPPER_BONES, UPPER_ANGLES>| {
                    let whole = BodyParticle::at(&self.scene.skeleton, whole_pose(&particle.angles_rad));
                    BodyParticle { memory: particle.memory, ..whole }
                };
                let all = || filter.particles().iter().map(complete).collect();
                (self.completed.get_or_init(all), filter.weights())
            }
        }
    }

    /// Share of the hypotheses' weight that puts each joint more than
    /// [`LOST_JOINT_M`](super::ambiguity::LOST_JOINT_M) from `estimate`, the last step's; zero of
    /// what is not tracked.
    #[must_use]
    pub fn ambiguous(&self, estimate: &WholeBodyEstimate) -> [f32; BODY_BONES] {
        match &self.tracked {
            Sizes::Whole(filter) => filter.ambiguous(&estimate.ends_m),
            Sizes::Upper(filter) => {
                let upper = filter.ambiguous(&upper_bones(&estimate.ends_m));
                std::array::from_fn(|bone| upper.get(bone).copied().unwrap_or(0.0))
            }
        }
    }

    /// Coordinates and bones' ends (metres) of the last step's pose before the deadband; of an
    /// upper body the legs hang.
    #[must_use]
    pub fn before_deadband(&self) -> ([f32; BODY_ANGLES], [Vec3; BODY_BONES]) {
        match &self.tracked {
            Sizes::Whole(filter) => (filter.mean().angles_rad, filter.mean().ends_m),
            Sizes::Upper(filter) => whole_ends(&self.scene, &filter.mean().angles_rad, &filter.mean().ends_m),
        }
    }

    /// The state of the tracker after the last step as text, which [`Self::restore`] takes.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub fn saved(&mut self) -> Result<String> {
        match &mut self.tracked {
            Sizes::Whole(filter) => to_text(StateKind::Body, filter.tracker_mut()),
            Sizes::Upper(filter) => to_text(StateKind::Body, filter.tracker_mut()),
        }
    }

    /// Puts the tracker into a state that was saved with the same part, model, numbers and count of
    /// particles.
    ///
    /// # Errors
    /// The text is not whole, or of another tracker.
    pub fn restore(&mut self, saved: &str) -> Result<()> {
        self.completed = OnceLock::new();
        match &mut self.tracked {
            Sizes::Whole(filter) => from_text(StateKind::Body, saved, filter.tracker_mut()),
            Sizes::Upper(filter) => from_text(StateKind::Body, saved, filter.tracker_mut()),
        }
    }

    /// How the points of a frame are smoothed before they are weighed; `None` where they are taken
    /// as they are.
    #[must_use]
    pub fn smoothing(&self) -> Option<&RangeSmoothing> {
        self.smoothing.as_ref()
    }

    /// A frame's points as this model weighs them: smoothed, in place, and in blocks.
    #[must_use]
    pub fn blocks(&self, points_m: &mut [Vec3]) -> Vec<PointBlock> {
        blocks_of(points_m, self.smoothing())
    }

    /// One frame, `dt_s` seconds after the one before; `stick` is what is known of the stick, which
    /// only the stick model asks. Points of an upper body's [legs](Legs) are left out.
    pub fn step(&mut self, blocks: &[PointBlock], dt_s: f32, stick: StickSight) -> WholeBodyEstimate {
        let floor_y_m = self.floor_y_m;
        let seen = |blocks| SeenFrame { frame: BodyFrame { dt_s, blocks }, stick, floor_y_m };
        match &mut self.tracked {
            Sizes::Whole(filter) => filter.step(&seen(blocks)),
            Sizes::Upper(filter) => {
                self.completed = OnceLock::new();
                let radii_m = upper_bones(&self.scene.radii_m);
                let legs = Legs::of(&filter.mean().ends_m, &radii_m, self.scene.likelihood.outlier_m);
                let blocks: Vec<PointBlock> =
                    blocks.iter().filter_map(|block| block.retained(|point_m| !legs.hold(point_m))).collect();
                let estimate = filter.step(&seen(&blocks));
                whole_estimate(&self.scene, &estimate)
            }
        }
    }
}

/// Coordinates of an upper body that is posed as a whole one: its root turns as root and trunk
/// together.
fn upper_pose(whole: &BodySkeleton, angles_rad: &[f32; BODY_ANGLES]) -> [f32; UPPER_ANGLES] {
    let mut pose = upper_coordinates(angles_rad);
    let (Joint::Free([_, _, _, a, b, c]), Joint::Ball(trunk)) =
        (whole.bones()[PELVIS].joint, whole.bones()[TRUNK].joint)
    else {
        return pose;
    };
    let turned = |axes: &[Vec3; 3], first: usize| {
        axis_rotation(&axes[0], angles_rad[first])
            * axis_rotation(&axes[1], angles_rad[first + 1])
            * axis_rotation(&axes[2], angles_rad[first + 2])
    };
    let root = [a, b, c];
    let rotation = turned(&root, SHIFTS) * turned(&trunk, FREE_ROOT_COORDINATES);
    let [turn, tilt, pitch] = angles_of_rotation(&rotation, &root);
    // Only the turn winds; the others have limits of less than a turn.
    pose[SHIFTS] += wrap_angle(turn - pose[SHIFTS]);
    (pose[SHIFTS + 1], pose[SHIFTS + 2]) = (tilt, pitch);
    pose
}

/// Coordinates of a whole body whose trunk is straight and whose legs hang.
fn whole_pose(upper_rad: &[f32; UPPER_ANGLES]) -> [f32; BODY_ANGLES] {
    let mut pose = [0.0; BODY_ANGLES];
    for (&index, &angle) in UPPER_COORDINATES.iter().zip(upper_rad) {
        pose[index] = angle;
    }
    pose
}

fn whole_ends(
    scene: &BodyScene<BODY_BONES, BODY_ANGLES>,
    upper_rad: &[f32; UPPER_ANGLES],
    upper_m: &[Vec3; UPPER_BONES],
) -> ([f32; BODY_ANGLES], [Vec3; BODY_BONES]) {
    let angles_rad = whole_pose(upper_rad);
    let mut ends_m = scene.posture(&angles_rad).ends;
    ends_m[..UPPER_BONES].copy_from_slice(upper_m);
    (angles_rad, ends_m)
}

fn whole_estimate(
    scene: &BodyScene<BODY_BONES, BODY_ANGLES>,
    upper: &BodyEstimate<UPPER_BONES, UPPER_ANGLES>,
) -> WholeBodyEstimate {
    let (angles_rad, ends_m) = whole_ends(scene, &upper.angles_rad, &upper.ends_m);
    let (mut spread_m, mut observed) = ([0.0; BODY_BONES], [false; BODY_BONES]);
    spread_m[..UPPER_BONES].copy_from_slice(&upper.spread_m);
    observed[..UPPER_BONES].copy_from_slice(&upper.observed);
    WholeBodyEstimate {
        angles_rad,
        ends_m,
        spread_m,
        observed,
        effective_sample_size: upper.effective_sample_size,
        log_evidence: upper.log_evidence,
        tempering: upper.tempering,
        is_degenerate: upper.is_degenerate,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::kinematics::forward::posture;
    use sinew_core::skeleton::upper_body::UpperSkeleton;

    #[test]
    fn an_upper_body_is_posed_as_the_whole_one() {
        let measures = BodyMeasures::of_height(1.7).unwrap();
        let (whole, upper) = (full_body(&measures).unwrap(), upper_body(&measures).unwrap());
        let mut lying = [0.0; BODY_ANGLES];
        // As the pelvic lift begins: the trunk's bend on top of the pelvis' is more than half a
        // turn.
        (lying[3], lying[5], lying[6]) = (7.0, 3.1, 1.5);
        for angles in [std::array::from_fn(|index| 0.4 * (index as f32).sin()), lying] {
            an_upper_body_is_as(&whole.clamp(angles), &whole, &upper);
        }
    }

    fn an_upper_body_is_as(angles: &[f32; BODY_ANGLES], whole: &BodySkeleton, upper: &UpperSkeleton) {
        let pose = upper_pose(whole, angles);
        assert_eq!(upper.clamp(pose), pose, "limits");
        let found = posture(upper, &Vec3::zeros(), &pose).ends;
        let wanted = posture(whole, &Vec3::zeros(), angles).ends;
        for bone in 0..UPPER_BONES {
            assert!((found[bone] - wanted[bone]).norm() < 1.0e-4, "bone {bone}: {} {}", found[bone], wanted[bone]);
        }
        let completed = posture(whole, &Vec3::zeros(), &whole_pose(&pose)).ends;
        for bone in 0..UPPER_BONES {
            assert!((completed[bone] - found[bone]).norm() < 1.0e-4, "bone {bone}");
        }
    }
}
