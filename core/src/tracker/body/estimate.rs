//! One pose out of many particles (PIK (30)).

use super::mean_rotation::{angles_of_rotation, mean_rotation};
use crate::math::{Mat3, Vec3, axis_rotation, product, sqrt};
use crate::pik::motion::BodyParticle;
use crate::skeleton::tree::SHIFTS;
use crate::skeleton::{Joint, Limbs, Skeleton};

/// What is known after a frame.
///
/// ```
/// use sinew_core::pik::example::{arm_points, arm_scene, bending_elbow, guided_arm, hand_goals};
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::tracker::body::{BodyFrame, BodyTracker, DEFAULT_BODY_OPTIONS};
///
/// let (scene, goals) = (arm_scene()?, hand_goals()?);
/// let motion = guided_arm(&goals);
/// let first = BodyParticle::at(&scene.skeleton, bending_elbow(0));
/// // A body of two bones, an arm; thirty particles.
/// let sets = ([first; 30], [first; 30]);
/// let mut tracker = BodyTracker::<2, 4, 30, _>::new(&first, sets, DEFAULT_BODY_OPTIONS, 1)?;
/// let cloud = arm_points(&scene, &bending_elbow(1));
/// let estimate = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() });
/// assert_eq!(estimate.ends_m, scene.posture(&estimate.angles_rad).ends, "one pose, not a mean of places");
/// assert_eq!(estimate.observed, [true; 2], "the points show both bones");
/// assert!(!estimate.is_degenerate && (1.0..=30.0).contains(&estimate.effective_sample_size));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyEstimate<const BONES: usize, const ANGLES: usize> {
    /// Coordinates of the mean pose, or of what the motion model refines it to, inside the limits;
    /// with the deadband of the options.
    pub angles_rad: [f32; ANGLES],
    /// Ends of all bones in that pose, metres.
    pub ends_m: [Vec3; BONES],
    /// Standard deviation of each bone's end over the particles, metres (root of the summed
    /// variances).
    pub spread_m: [f32; BONES],
    /// Whether the points show each bone; `false` as well where the frame had no points.
    pub observed: [bool; BONES],
    /// Effective number of particles; limb by limb that of the group with the fewest.
    pub effective_sample_size: f32,
    /// ln of the mean weight of whole poses before tempering, a frame's part of the log evidence.
    /// On the same points with the same likelihood it compares runs and motion models. Without
    /// points only what a proposal owes its motion model is left in it: zero for models that draw
    /// from themselves. Of a tracker by modes it is the log density at the leading mode.
    pub log_evidence: f32,
    /// Exponent that the weights of whole poses were flattened with; 1 where they were not.
    pub tempering: f32,
    /// Whether no particle had a weight: the frame was then as if it had no points.
    pub is_degenerate: bool,
}

/// Puts the weighted mean of one group's coordinates into `mean_rad`: shifts and hinges by their
/// mean, balls by their mean rotation, then inside the limits.
///
/// An angle that winds (a free root's turn) is given the turn nearest to the heaviest particle's.
pub(super) fn mean_of_group<const BONES: usize, const ANGLES: usize>(
    skeleton: &Skeleton<BONES, ANGLES>,
    (particles, weights): (&[BodyParticle<BONES, ANGLES>], &[f32]),
    (limbs, group): (&Limbs<BONES>, usize),
    mean_rad: &mut [f32; ANGLES],
) {
    let heaviest = particles.iter().zip(weights).fold(None, |best: Option<(&BodyParticle<_, _>, f32)>, (p, &w)| {
        if best.is_none_or(|(_, most)| w > most) { Some((p, w)) } else { best }
    });
    let mut result = heaviest.map_or([0.0; ANGLES], |(particle, _)| particle.angles_rad);
    let mut first = 0;
    for (index, bone) in skeleton.bones().iter().enumerate() {
        let count = bone.joint.angle_count();
        if limbs.group(index) == group {
            match bone.joint {
                Joint::Fixed => {}
                Joint::Hinge(_) => mean_coordinates(&mut result, first..first + count, particles, weights),
                Joint::Ball(axes) => mean_ball(&mut result, first, &axes, particles, weights),
                Joint::Free([_, _, _, a, b, c]) => {
                    mean_coordinates(&mut result, first..first + SHIFTS, particles, weights);
                    mean_ball(&mut result, first + SHIFTS, &[a, b, c], particles, weights);
                }
            }
        }
        first += count;
    }
    let result = skeleton.clamp(result);
    for angle in 0..ANGLES {
        if limbs.group(skeleton.bone_of_angle(angle)) == group {
            mean_rad[angle] = result[angle];
        }
    }
}

/// Plain means: limits keep a hinge within less than a turn.
fn mean_coordinates<const BONES: usize, const ANGLES: usize>(
    result: &mut [f32; ANGLES],
    range: core::ops::Range<usize>,
    particles: &[BodyParticle<BONES, ANGLES>],
    weights: &[f32],
) {
    for index in range {
        if let Some(slot) = result.get_mut(index) {
            // About the heaviest particle's, so that large shifts lose no digits.
            let about = *slot;
            let mut off = 0.0;
            for (particle, weight) in particles.iter().zip(weights) {
                off += weight * (particle.angles_rad.get(index).copied().unwrap_or(about) - about);
            }
            *slot = about + off;
        }
    }
}

/// The mean rotation of a ball joint whose angles begin at `first`.
fn mean_ball<const BONES: usize, const ANGLES: usize>(
    result: &mut [f32; ANGLES],
    first: usize,
    axes: &[Vec3; 3],
    particles: &[BodyParticle<BONES, ANGLES>],
    weights: &[f32],
) {
    let mut sum = Mat3::zeros();
    for (particle, &weight) in particles.iter().zip(weights) {
        let Some(&[a, b, c]) = particle.angles_rad.get(first..first + 3).and_then(|three| three.first_chunk()) else {
            return;
        };
        let [a, b, c] = [axis_rotation(&axes[0], a), axis_rotation(&axes[1], b), axis_rotation(&axes[2], c)];
        sum += product(&product(&a, &b), &c) * weight;
    }
    let Some(mean) = mean_rotation(&sum) else { return };
    for (slot, angle) in result.iter_mut().skip(first).zip(angles_of_rotation(&mean, axes)) {
        *slot += crate::math::wrap_angle(angle - *slot);
    }
}

/// Puts the standard deviation of the ends of one group's bones into `spread_m`, and that of their
/// means into `standard_error_m`, metres. Particles of so many weights scatter their mean by the
/// root of the summed squares of weight times distance.
pub(super) fn spread_of_group<const BONES: usize, const ANGLES: usize>(
    (particles, weights): (&[BodyParticle<BONES, ANGLES>], &[f32]),
    (limbs, group): (&Limbs<BONES>, usize),
    (spread_m, standard_error_m): (&mut [f32; BONES], &mut [f32; BONES]),
) {
    for bone in 0..BONES {
        if limbs.group(bone) != group {
            continue;
        }
        let mut mean = Vec3::zeros();
        for (particle, &weight) in particles.iter().zip(weights) {
            mean += particle.ends_m[bone] * weight;
        }
        let (mut variance, mut error_variance) = (0.0, 0.0);
        for (particle, weight) in particles.iter().zip(weights) {
            let off = particle.ends_m[bone] - mean;
            let weighed = weight * off.dot(&off);
            variance += weighed;
            error_variance += weight * weighed;
        }
        spread_m[bone] = sqrt(variance);
        standard_error_m[bone] = sqrt(error_variance);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;
    use crate::skeleton::arm::FOREARM;
    use crate::skeleton::{ArmGeometry, Side};

    /// Sets of particles of unlike weights. Their means are off from the place that they were drawn
    /// about, root mean square. That error is compared with the standard error that each set
    /// estimates.
    #[test]
    fn means_are_off_by_their_standard_error() {
        let skeleton = ArmGeometry::new(Side::Left, 0.30, 0.35).unwrap().skeleton().unwrap();
        let (mut stream, mut off, mut estimated) = (Stream::new(3, 0, 0), 0.0, 0.0);
        for _ in 0..400 {
            let mut particles = [BodyParticle::at(&skeleton, [0.5, 0.1, 0.1, 1.0]); 40];
            let mut weights = [0.0; 40];
            for (particle, weight) in particles.iter_mut().zip(&mut weights) {
                (particle.ends_m[FOREARM], *weight) = (stream.normal3() * 0.05, stream.uniform() * stream.uniform());
            }
            let sum: f32 = weights.iter().sum();
            weights = weights.map(|weight| weight / sum);
            let (mut spread_m, mut standard_error_m) = ([0.0; 2], [0.0; 2]);
            let kept = (&mut spread_m, &mut standard_error_m);
            spread_of_group((&particles, &weights), (&Limbs::none(), 0), kept);
            let mean_m: Vec3 = particles.iter().zip(&weights).map(|(p, &weight)| p.ends_m[FOREARM] * weight).sum();
            off += mean_m.norm_squared();
            estimated += standard_error_m[FOREARM] * standard_error_m[FOREARM];
            assert!((0.05..0.12).contains(&spread_m[FOREARM]), "{spread_m:?}");
        }
        // The mean that distances are taken from is the set's own, so that the estimated error is a
        // little small.
        assert!((0.85..1.05).contains(&(estimated / off)), "{}", estimated / off);
    }
}
