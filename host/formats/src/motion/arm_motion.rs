//! Motion of the arms alone, as directions in the torso's frame, ready for a body with other
//! segment lengths.

use super::error::MotionError;
use super::landmarks::{Arm, Torso};
use super::recording::Motion;
use sinew_core::math::{Vec3, floor, unit};
use std::path::Path;

/// Side of a body, the person's own.
pub use sinew_core::skeleton::Side as ArmSide;

/// Unit directions of one arm in torso axes: x to the body's left, y up, z to the front.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmDirections {
    /// Shoulder to elbow.
    pub upper_arm: Vec3,
    /// Elbow to wrist.
    pub forearm: Vec3,
}

impl ArmDirections {
    /// Directions a `share` of the way to `other`, linear and brought back to unit length.
    #[must_use]
    pub fn towards(&self, other: &Self, share: f32) -> Self {
        let mix = |a: Vec3, b: Vec3| unit(a * (1.0 - share) + b * share).unwrap_or(a);
        Self { upper_arm: mix(self.upper_arm, other.upper_arm), forearm: mix(self.forearm, other.forearm) }
    }

    fn mirrored(&self) -> Self {
        let flip = |v: Vec3| Vec3::new(-v.x, v.y, v.z);
        Self { upper_arm: flip(self.upper_arm), forearm: flip(self.forearm) }
    }
}

/// Both arms over time; as many frames on the left as on the right, at least one.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmMotion {
    frames_per_second: f32,
    left: Vec<ArmDirections>,
    right: Vec<ArmDirections>,
}

impl ArmMotion {
    /// Builds the motion from directions of each frame.
    ///
    /// # Errors
    /// If the sides differ in length, are empty, or the rate is not above zero.
    pub fn new(
        frames_per_second: f32,
        left: Vec<ArmDirections>,
        right: Vec<ArmDirections>,
    ) -> Result<Self, MotionError> {
        rate_above_zero(frames_per_second)?;
        if left.is_empty() || left.len() != right.len() {
            let rule = format!("must hold as many frames as the right side, and one at least ({})", left.len());
            return Err(MotionError::Parameter { parameter: "left", rule });
        }
        Ok(Self { frames_per_second, left, right })
    }

    /// The arms of a whole-body `motion`. An arm without a known name hangs down, as does an arm in
    /// a frame that gives no direction. `path` is for messages only.
    ///
    /// # Errors
    /// If the torso is not found, or neither arm.
    pub fn from_motion(motion: &Motion, path: &Path) -> Result<Self, MotionError> {
        let torso = Torso::find(motion, path)?;
        let arms = [ArmSide::Left, ArmSide::Right].map(|side| Arm::find(motion, side));
        if arms == [None, None] {
            return Err(MotionError::NoJoint {
                path: path.to_path_buf(),
                wanted: "an arm (e.g. lclavicle, lhumerus, lradius, or LeftArm, LeftForeArm, LeftHand)".into(),
                joints: motion.joints.clone(),
            });
        }
        let down = ArmDirections { upper_arm: -Vec3::y(), forearm: -Vec3::y() };
        let [left, right] = arms.map(|arm| {
            let mut last = down;
            let frames = (0..motion.len()).map(|frame| {
                last = arm.and_then(|arm| directions(&torso, &arm, motion.frame(frame))).unwrap_or(last);
                last
            });
            frames.collect::<Vec<_>>()
        });
        Self::new(motion.frames_per_second, left, right)
    }

    /// Frames in a second.
    #[must_use]
    pub fn frames_per_second(&self) -> f32 {
        self.frames_per_second
    }

    /// How many frames there are, at least one.
    #[must_use]
    #[allow(clippy::len_without_is_empty)] // never empty
    pub fn len(&self) -> usize {
        self.left.len()
    }

    /// One side's directions, frame by frame.
    #[must_use]
    pub fn side(&self, side: ArmSide) -> &[ArmDirections] {
        match side {
            ArmSide::Left => &self.left,
            ArmSide::Right => &self.right,
        }
    }

    /// Seen at `frames_per_second`: at each instant the directions between the two nearest frames.
    /// No low-pass filter: a camera, too, samples instants.
    ///
    /// # Errors
    /// If the rate is not above zero.
    pub fn resampled(&self, frames_per_second: f32) -> Result<Self, MotionError> {
        rate_above_zero(frames_per_second)?;
        let step = self.frames_per_second / frames_per_second;
        let last = self.len() - 1;
        let count = floor(last as f32 / step + 1.0e-3) as usize + 1;
        let at = |frames: &[ArmDirections], index: usize| {
            let position = index as f32 * step;
            let before = (floor(position) as usize).min(last);
            frames[before].towards(&frames[(before + 1).min(last)], (position - before as f32).clamp(0.0, 1.0))
        };
        let resample = |frames: &[ArmDirections]| (0..count).map(|index| at(frames, index)).collect::<Vec<_>>();
        Ok(Self { frames_per_second, left: resample(&self.left), right: resample(&self.right) })
    }

    /// The part from `start_s` to `end_s` seconds (cut to what is there; one frame at least).
    #[must_use]
    pub fn between(&self, start_s: f32, end_s: f32) -> Self {
        let last = self.len() - 1;
        let start = ((start_s * self.frames_per_second).max(0.0) as usize).min(last);
        let end = ((end_s * self.frames_per_second).max(0.0) as usize).clamp(start, last);
        let cut = |frames: &[ArmDirections]| frames[start..=end].to_vec();
        Self { frames_per_second: self.frames_per_second, left: cut(&self.left), right: cut(&self.right) }
    }

    /// Exactly `frames` frames: a shorter motion runs to and fro, a longer one is cut.
    ///
    /// # Errors
    /// If `frames` is zero.
    pub fn with_length(&self, frames: usize) -> Result<Self, MotionError> {
        if frames == 0 {
            let rule = "must be greater than zero".to_string();
            return Err(MotionError::Parameter { parameter: "frames", rule });
        }
        let last = self.len() - 1;
        let fold = |index: usize| {
            let phase = if last == 0 { 0 } else { index % (2 * last) };
            if phase <= last { phase } else { 2 * last - phase }
        };
        let play = |side: &[ArmDirections]| (0..frames).map(|index| side[fold(index)]).collect();
        Ok(Self { frames_per_second: self.frames_per_second, left: play(&self.left), right: play(&self.right) })
    }

    /// Left and right exchanged, as in a mirror.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let flip = |frames: &[ArmDirections]| frames.iter().map(ArmDirections::mirrored).collect();
        Self { frames_per_second: self.frames_per_second, left: flip(&self.right), right: flip(&self.left) }
    }
}

fn rate_above_zero(frames_per_second: f32) -> Result<(), MotionError> {
    if frames_per_second > 0.0 && frames_per_second.is_finite() {
        return Ok(());
    }
    let rule = format!("must be greater than zero, not {frames_per_second}");
    Err(MotionError::Parameter { parameter: "frames_per_second", rule })
}

fn directions(torso: &Torso, arm: &Arm, positions: &[Vec3]) -> Option<ArmDirections> {
    let axes = torso.axes(positions)?;
    Some(ArmDirections {
        upper_arm: unit(axes * (positions[arm.elbow] - positions[arm.shoulder]))?,
        forearm: unit(axes * (positions[arm.wrist] - positions[arm.elbow]))?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const NAMES: [&str; 8] =
        ["lclavicle", "lhumerus", "lradius", "lhipjoint", "rclavicle", "rhumerus", "rradius", "rhipjoint"];

    /// A body that looks along world +x, its left hand stretched out to the front, its right one
    /// hanging.
    fn looking_along_x() -> Motion {
        let positions_m = [
            [0.0, 1.4, -0.2],
            [0.0, 1.1, -0.2],
            [0.25, 1.1, -0.2],
            [0.0, 0.9, -0.1],
            [0.0, 1.4, 0.2],
            [0.0, 1.1, 0.2],
            [0.0, 0.85, 0.2],
            [0.0, 0.9, 0.1],
        ];
        Motion {
            frames_per_second: 30.0,
            joints: NAMES.map(String::from).to_vec(),
            parents: vec![None; NAMES.len()],
            positions_m: positions_m.map(Vec3::from).to_vec(),
            shortfall: None,
        }
    }

    #[test]
    fn directions_are_in_torso_axes() {
        let arms = ArmMotion::from_motion(&looking_along_x(), Path::new("m")).unwrap();
        let left = arms.side(ArmSide::Left)[0];
        assert!((left.upper_arm + Vec3::y()).norm() < 1.0e-6);
        assert!((left.forearm - Vec3::z()).norm() < 1.0e-6, "front is {:?}", left.forearm);
        assert!((arms.side(ArmSide::Right)[0].forearm + Vec3::y()).norm() < 1.0e-6);
        assert_eq!(arms.mirrored().side(ArmSide::Right)[0].forearm, left.forearm);
    }

    #[test]
    fn a_motion_without_arms_is_refused_with_its_joints() {
        let mut motion = looking_along_x();
        for joint in &mut motion.joints {
            joint.push('2');
        }
        let message = ArmMotion::from_motion(&motion, Path::new("m.bvh")).unwrap_err().to_string();
        assert!(message.contains("m.bvh") && message.contains("lclavicle2"), "{message}");
    }

    fn turning(frames: usize) -> ArmMotion {
        let frames: Vec<ArmDirections> = (0..frames)
            .map(|index| {
                let (sine, cosine) = sinew_core::math::sin_cos(0.1 * index as f32);
                let direction = Vec3::new(cosine, sine, 0.0);
                ArmDirections { upper_arm: direction, forearm: -direction }
            })
            .collect();
        ArmMotion::new(120.0, frames.clone(), frames).unwrap()
    }

    #[test]
    fn a_short_motion_runs_to_and_fro() {
        let motion = turning(3);
        let long = motion.with_length(6).unwrap();
        let at = |index: usize| motion.side(ArmSide::Left)[index];
        assert_eq!(long.side(ArmSide::Left), [at(0), at(1), at(2), at(1), at(0), at(1)]);
        assert!(motion.with_length(0).is_err());
    }

    #[test]
    fn eight_to_one_takes_every_eighth_frame() {
        let motion = turning(33);
        let slow = motion.resampled(15.0).unwrap();
        assert_eq!(slow.len(), 5);
        for (index, found) in slow.side(ArmSide::Left).iter().enumerate() {
            assert!((found.upper_arm - motion.side(ArmSide::Left)[8 * index].upper_arm).norm() < 1.0e-5);
        }
    }

    proptest! {
        #[test]
        fn resampled_directions_have_unit_length(rate in 1.0_f32..400.0, frames in 1_usize..60) {
            let resampled = turning(frames).resampled(rate).unwrap();
            prop_assert!(resampled.len() as f32 / rate <= frames as f32 / 120.0 + 1.0 / rate);
            for directions in resampled.side(ArmSide::Right) {
                prop_assert!((directions.upper_arm.norm() - 1.0).abs() < 1.0e-5);
                prop_assert!((directions.forearm.norm() - 1.0).abs() < 1.0e-5);
            }
        }
    }
}
