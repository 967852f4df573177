//! The pose that is reported: still where the body rests, and where the particles say as soon as it
//! moves.
//!
//! The mean of a hundred particles has a jitter of a centimetre or two about a limb at rest. A low
//! pass against it is late whenever the limb moves. Two frames in a row separate jitter from
//! motion. Jitter lies on one side of the reported pose and then on the other. A limb that moves is
//! ahead of it twice. The standard error of the particles' mean estimates the jitter.

use super::estimate::mean_of_group;
use crate::kinematics::inverse::{Goal, PoseDensity, Solve};
use crate::kinematics::solver_memory::SolverMemory;
use crate::math::{Mat3, Vec3, max, min, sqrt};
use crate::pik::motion::{BodyParticle, BodyScene};
use crate::skeleton::{Joint, Limbs, Skeleton};

/// Motion within the jitter is followed too, in this time, seconds.
/// Chosen: much longer than a frame.
const REST_S: f32 = 2.0;
/// A way counts this much of itself if the frame before was not off to the same side. A limb that
/// starts at once is not waited for. Chosen: below one, since a single frame may be jitter.
const ALONE: f32 = 0.7;
/// Particles that all are in one place still have some jitter, metres.
/// Chosen: far below any visible motion; avoids a division by zero.
const MIN_JITTER_STD_M: f32 = 1.0e-6;
/// Of the place of a bone's end: known to a centimetre, inverse square metres.
/// Chosen: ends weigh much more than angles.
const PRECISION: f32 = 1.0e4;
/// Of an angle: known to 0.3 rad, inverse square radians.
/// Chosen: holds angles that no end determines.
const STIFFNESS: f32 = 11.0;
/// Steps of the solver.
const SOLVER_STEPS: usize = 3;

/// What is reported of a body, frame after frame.
#[derive(Debug, Clone)]
pub(super) struct Deadband<const BONES: usize, const ANGLES: usize> {
    /// The pose that was reported last.
    pub(super) reported: BodyParticle<BONES, ANGLES>,
    /// How far from the pose reported before it the particles found the ends of all bones, metres.
    pub(super) off_m: [Vec3; BONES],
}

impl<const BONES: usize, const ANGLES: usize> Deadband<BONES, ANGLES> {
    /// Nothing was reported yet of a body at `first`.
    pub(super) const fn new(first: BodyParticle<BONES, ANGLES>) -> Self {
        Self { reported: first, off_m: [Vec3::new(0.0, 0.0, 0.0); BONES] }
    }

    /// The pose to report where the particles' mean is `now`. The ends of each limb's bones go from
    /// where they were reported to where they are. They go the whole way if the limb moves by much
    /// more than the jitter of its ends, `jitter_std_m`. The pose between the two has its ends
    /// there. A mix of angles alone would move a hand with the jitter of the trunk's angles.
    pub(super) fn filter(
        &mut self,
        (scene, limbs): (&BodyScene<BONES, ANGLES>, &Limbs<BONES>),
        now: &BodyParticle<BONES, ANGLES>,
        jitter_std_m: &[f32; BONES],
        dt_s: f32,
    ) -> &BodyParticle<BONES, ANGLES> {
        self.filter_within((scene, limbs), now, jitter_std_m, dt_s, &mut SolverMemory::new())
    }

    /// As [`Self::filter`], in memory of the caller.
    pub(super) fn filter_within(
        &mut self,
        (scene, limbs): (&BodyScene<BONES, ANGLES>, &Limbs<BONES>),
        now: &BodyParticle<BONES, ANGLES>,
        jitter_std_m: &[f32; BONES],
        dt_s: f32,
        memory: &mut SolverMemory<BONES, ANGLES>,
    ) -> &BodyParticle<BONES, ANGLES> {
        if !jitter_std_m.iter().any(|&end_m| end_m > 0.0) {
            self.reported = *now;
            return &self.reported;
        }
        let groups: [usize; BONES] = core::array::from_fn(|bone| group_of_end((&scene.skeleton, limbs), bone));
        let off_m: [Vec3; BONES] = core::array::from_fn(|bone| now.ends_m[bone] - self.reported.ends_m[bone]);
        let mut between_rad = self.reported.angles_rad;
        let mut goals = self.reported.ends_m.map(|position_m| Goal {
            bone: 0,
            position_m,
            precision: Mat3::from_diagonal_element(PRECISION),
        });
        for group in 0..limbs.count() {
            let group_jitter_m = root_mean((&groups, group), |bone| jitter_std_m[bone] * jitter_std_m[bone]);
            let share = share(self.moved_m((&groups, group), &off_m) / max(group_jitter_m, MIN_JITTER_STD_M), dt_s);
            let (poses, weights) = ([self.reported, *now], [1.0 - share, share]);
            mean_of_group(&scene.skeleton, (&poses, &weights), (limbs, group), &mut between_rad);
            for (bone, (goal, (off_m, of_end))) in goals.iter_mut().zip(off_m.iter().zip(&groups)).enumerate() {
                if *of_end == group {
                    goal.bone = bone;
                    goal.position_m += off_m * share;
                }
            }
        }
        let nearest = PoseDensity {
            skeleton: &scene.skeleton,
            root_m: Vec3::zeros(),
            goals: &goals,
            previous_rad: between_rad,
            stiffness: [STIFFNESS; ANGLES],
            held: 0,
        };
        let angles_rad = nearest.solve_within(&[], SOLVER_STEPS, memory).angles_rad;
        self.off_m = off_m;
        self.reported = BodyParticle { angles_rad, ends_m: scene.posture(&angles_rad).ends, ..*now };
        &self.reported
    }

    /// How far the ends of a group's bones went, metres. It is the root mean of the products of how
    /// far they are off with how far they were in the frame before.
    fn moved_m(&self, (groups, group): (&[usize; BONES], usize), off_m: &[Vec3; BONES]) -> f32 {
        let twice_m = root_mean((groups, group), |bone| off_m[bone].dot(&self.off_m[bone]));
        let once_m = root_mean((groups, group), |bone| off_m[bone].dot(&off_m[bone]));
        max(twice_m, ALONE * once_m)
    }
}

/// Root of the mean over the ends that go with a group; zero of a negative mean.
fn root_mean<const BONES: usize>((groups, group): (&[usize; BONES], usize), of: impl Fn(usize) -> f32) -> f32 {
    let (mut sum, mut count) = (0.0, 0.0);
    for bone in (0..BONES).filter(|&bone| groups[bone] == group) {
        sum += of(bone);
        count += 1.0;
    }
    sqrt(max(sum, 0.0) / max(count, 1.0))
}

/// The group that a bone's end goes with: a bone without a joint of its own is carried by its
/// parent. Shoulders go with the trunk, and an arm that waves does not take the trunk along.
fn group_of_end<const BONES: usize, const ANGLES: usize>(
    (skeleton, limbs): (&Skeleton<BONES, ANGLES>, &Limbs<BONES>),
    mut bone: usize,
) -> usize {
    while let Some(parent) =
        skeleton.bones().get(bone).filter(|held| held.joint == Joint::Fixed).and_then(|held| held.parent)
    {
        bone = usize::from(parent);
    }
    limbs.group(bone)
}

/// The part of the way that is gone by a limb that moved by so many times its jitter.
fn share(moved: f32, dt_s: f32) -> f32 {
    let rest = min(1.0, dt_s / REST_S);
    // Beyond it the other term is one to the last digit, and its square is an ordinary number.
    let squared = min(moved * moved, 1.0e4);
    let sixth = squared * squared * squared;
    rest + (1.0 - rest) * (sixth / (1.0 + sixth))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observation::point_likelihood::PointLikelihood;
    use crate::random::Stream;
    use crate::skeleton::BodyMeasures;
    use crate::skeleton::full_body::{
        BODY_ANGLES, BODY_BONES, COLLARS, FEET, FOREARMS, HEAD, HIPS, PELVIS, THIGHS, TRUNK, UPPER_ARMS, body_radii_m,
        full_body,
    };
    use crate::skeleton::limbs::TRUNK_GROUP;
    use proptest::prelude::*;

    type Scene = BodyScene<BODY_BONES, BODY_ANGLES>;
    type Pose = BodyParticle<BODY_BONES, BODY_ANGLES>;
    const JITTER_STD_M: f32 = 0.03;
    const DT_S: f32 = 1.0 / 15.0;
    const FRAMES: usize = 10;

    fn scene() -> Scene {
        let measures = BodyMeasures::of_height(1.75).unwrap();
        let likelihood = PointLikelihood { std_m: 0.15, outlier_m: 0.14 };
        let (skeleton, radii_m) = (full_body(&measures).unwrap(), body_radii_m(&measures));
        BodyScene { skeleton, radii_m, camera_m: Vec3::zeros(), likelihood, self_penetration: None }
    }

    /// Somebody 3 m away whose right elbow is bent, with noise on all angles.
    fn seen(scene: &Scene, elbow_rad: f32, noise_rad: f32, stream: &mut Stream) -> Pose {
        let mut angles_rad = [0.0; BODY_ANGLES];
        (angles_rad[2], angles_rad[16], angles_rad[19]) = (3.0, 0.5, elbow_rad);
        for angle in &mut angles_rad[6..] {
            *angle += noise_rad * stream.normal();
        }
        BodyParticle::at(&scene.skeleton, scene.skeleton.clamp(angles_rad))
    }

    /// How far the right wrist goes from frame to frame on the mean, as estimated and as reported.
    /// The third number is how far behind it is reported at last.
    fn followed(speed_rad_per_s: f32, noise_rad: f32) -> (f32, f32, f32) {
        let (scene, mut stream) = (scene(), Stream::new(5, 0, 0));
        let mut before = seen(&scene, 0.5, 0.0, &mut stream);
        let mut deadband = Deadband::new(before);
        let (mut way_m, mut reported_way_m, mut behind_m) = (0.0, 0.0, 0.0);
        let wrist = FOREARMS[1];
        for frame in 1..=FRAMES {
            let now = seen(&scene, 0.5 + speed_rad_per_s * DT_S * frame as f32, noise_rad, &mut stream);
            let reported = deadband.reported.ends_m[wrist];
            let next = deadband
                .filter((&scene, &Limbs::of(&scene.skeleton)), &now, &[JITTER_STD_M; BODY_BONES], DT_S)
                .ends_m[wrist];
            way_m += (now.ends_m[wrist] - before.ends_m[wrist]).norm() / FRAMES as f32;
            reported_way_m += (next - reported).norm() / FRAMES as f32;
            behind_m = (next - now.ends_m[wrist]).norm();
            before = now;
        }
        (way_m, reported_way_m, behind_m)
    }

    #[test]
    fn an_arm_at_rest_has_little_jitter() {
        let (way_m, reported_way_m, _) = followed(0.0, 0.03);
        assert!(way_m > 0.015 && reported_way_m < 0.25 * way_m, "{way_m} {reported_way_m}");
    }

    #[test]
    fn shoulders_and_hips_go_with_the_trunk() {
        let scene = scene();
        let limbs = Limbs::of(&scene.skeleton);
        let group = |bone| group_of_end((&scene.skeleton, &limbs), bone);
        assert_eq!([COLLARS[0], COLLARS[1], HIPS[0], HIPS[1], TRUNK, PELVIS].map(group), [TRUNK_GROUP; 6]);
        for bone in [UPPER_ARMS, FOREARMS, THIGHS, FEET].into_iter().flatten().chain([HEAD]) {
            assert_eq!(group(bone), limbs.group(bone), "a limb of its own");
            assert_ne!(group(bone), TRUNK_GROUP);
        }
    }

    #[test]
    fn a_waving_arm_does_not_take_the_trunk_along() {
        let (scene, mut stream) = (scene(), Stream::new(6, 0, 0));
        let mut deadband = Deadband::new(seen(&scene, 0.5, 0.0, &mut stream));
        let (mut neck_m, mut reported_neck_m) = (0.0, 0.0);
        let mut before = deadband.reported;
        for frame in 1..=FRAMES {
            let bend_rad = if frame % 2 == 0 { 0.5 } else { 1.5 };
            let now = seen(&scene, bend_rad, 0.01, &mut stream);
            let reported = deadband.reported.ends_m[TRUNK];
            let next = deadband.filter((&scene, &Limbs::of(&scene.skeleton)), &now, &[JITTER_STD_M; BODY_BONES], DT_S);
            reported_neck_m += (next.ends_m[TRUNK] - reported).norm();
            assert!((next.ends_m[FOREARMS[1]] - now.ends_m[FOREARMS[1]]).norm() < 0.03, "the wrist is where it is");
            neck_m += (now.ends_m[TRUNK] - before.ends_m[TRUNK]).norm();
            before = now;
        }
        assert!(reported_neck_m < 0.3 * neck_m, "{reported_neck_m} {neck_m}");
    }

    #[test]
    fn an_arm_that_moves_is_not_left_behind() {
        // The wrist goes 5 cm in a frame.
        let (way_m, reported_way_m, behind_m) = followed(3.0, 0.0);
        assert!((0.9..1.05).contains(&(reported_way_m / way_m)), "{way_m} {reported_way_m}");
        assert!(behind_m < 0.5 * way_m, "{way_m} {behind_m}");
        // Half as fast, within the jitter: a frame behind.
        let (way_m, reported_way_m, behind_m) = followed(1.5, 0.0);
        assert!((0.75..1.05).contains(&(reported_way_m / way_m)), "{way_m} {reported_way_m}");
        assert!(behind_m < 1.3 * way_m, "{way_m} {behind_m}");
    }

    proptest! {
        #[test]
        fn what_is_told_keeps_the_limits_and_lies_between(
            seed in 0_u64..1000, noise_rad in 0.0_f32..0.1, jitter_std_m in 0.0_f32..0.2,
        ) {
            let (scene, mut stream) = (scene(), Stream::new(seed, 0, 0));
            let [first, second, third] = core::array::from_fn(|_| seen(&scene, 0.8, noise_rad, &mut stream));
            let mut deadband = Deadband::new(first);
            deadband.filter((&scene, &Limbs::of(&scene.skeleton)), &second, &[jitter_std_m; BODY_BONES], DT_S);
            let before = deadband.reported;
            let next = *deadband.filter((&scene, &Limbs::of(&scene.skeleton)), &third, &[jitter_std_m; BODY_BONES], DT_S);
            prop_assert_eq!(next.angles_rad, scene.skeleton.clamp(next.angles_rad));
            prop_assert_eq!(next.ends_m, scene.posture(&next.angles_rad).ends);
            for bone in 0..BODY_BONES {
                let [from, to, at] = [before, third, next].map(|pose| pose.ends_m[bone]);
                // Where an angle has no room the ends need not be on the line between the two.
                prop_assert!((at - from).norm() + (to - at).norm() < (to - from).norm() + 0.04, "bone {}", bone);
            }
            if jitter_std_m == 0.0 {
                prop_assert_eq!(next.angles_rad, third.angles_rad);
            }
        }
    }
}
