//! How far the hypotheses of a body disagree about each joint: where they do, the estimate is one
//! of several answers.

use sinew_core::math::Vec3;
use sinew_core::pik::motion::BodyParticle;

/// A joint farther than this from its place is lost, metres.
///
/// Chosen: the width of a shank; PIK (34) takes the nearest skin of any bone, so that exchanged
/// legs cost nothing there.
pub const LOST_JOINT_M: f32 = 0.1;

/// Share of the weight of the hypotheses whose joint is more than [`LOST_JOINT_M`] from the
/// estimate's `ends_m`, for each joint.
///
/// `weights` are those of `particles`, of any sum. Without weight nothing is known, and the share
/// is one.
///
/// ```
/// use sinew::body::tracking::ambiguity::elsewhere_share;
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::{BODY_ANGLES, full_body};
///
/// let skeleton = full_body(&BodyMeasures::of_height(1.75)?)?;
/// let here = BodyParticle::at(&skeleton, [0.0; BODY_ANGLES]);
/// let mut there = here;
/// there.ends_m[5] += Vec3::new(0.3, 0.0, 0.0);
/// let share = elsewhere_share(&[here, there], &[0.75, 0.25], &here.ends_m);
/// assert_eq!((share[4], share[5]), (0.0, 0.25));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[must_use]
pub fn elsewhere_share<const BONES: usize, const ANGLES: usize>(
    particles: &[BodyParticle<BONES, ANGLES>],
    weights: &[f32],
    ends_m: &[Vec3; BONES],
) -> [f32; BONES] {
    let total: f32 = weights.iter().sum();
    std::array::from_fn(|bone| {
        let is_elsewhere = |end_m: Vec3| is_lost(&end_m, &ends_m[bone]);
        let weighed = particles.iter().zip(weights);
        let there = weighed.filter(|(particle, _)| is_elsewhere(particle.ends_m[bone]));
        // A sum of no numbers would be -0.
        let share = there.fold(0.0, |sum, (_, weight)| sum + weight) / total;
        if share.is_finite() { share.min(1.0) } else { 1.0 }
    })
}

/// `shares` where one more hypothesis, with its bones' ends at `rival_m`, has so many times the
/// weight of all others together.
///
/// ```
/// use sinew::body::tracking::ambiguity::with_rival;
/// use sinew_core::math::Vec3;
///
/// let ends_m = [Vec3::zeros(); 2];
/// let rival_m = [Vec3::new(0.3, 0.0, 0.0), Vec3::zeros()];
/// assert_eq!(with_rival(&[0.0, 0.5], (&rival_m, 1.0), &ends_m), [0.5, 0.25]);
/// ```
#[must_use]
pub fn with_rival<const BONES: usize>(
    shares: &[f32; BONES],
    (rival_m, times): (&[Vec3; BONES], f32),
    ends_m: &[Vec3; BONES],
) -> [f32; BONES] {
    std::array::from_fn(|bone| {
        let of_rival = if is_lost(&rival_m[bone], &ends_m[bone]) { times } else { 0.0 };
        (shares[bone] + of_rival) / (1.0 + times)
    })
}

/// Whether a joint is lost that is here where another has it there.
fn is_lost(here_m: &Vec3, there_m: &Vec3) -> bool {
    (here_m - there_m).norm_squared() > LOST_JOINT_M * LOST_JOINT_M
}
