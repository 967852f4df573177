//! Both hands on a stick whose ends are known, in space or in the image (PIK (36) and PIK (37),
//! section 7.2).

use super::extrapolation::LinearGoals;
use crate::kinematics::inverse::Goal;
use crate::math::{Mat3, Vec3, clamp, max, min, sqrt, unit};
use crate::pik::goal::{GoalMemory, GoalPast, GoalProcess, Goals};
use crate::random::Stream;

/// Where a hand is on the stick at first: not known, so its own place decides.
/// Zero, as in a new memory.
const UNKNOWN: f32 = 0.0;

/// What is known of the stick in a frame.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::example::goal_past;
/// use sinew_core::pik::goal::{GoalProcess, Goals, LinearExtrapolation, MEMORY};
/// use sinew_core::pik::processes::extrapolation::LinearGoals;
/// use sinew_core::pik::processes::stick::{StickGoals, StickSight};
/// use sinew_core::random::Stream;
///
/// // A camera sees in which directions the ends of the stick are, not how far away:
/// // hands go to the wedge between both rays.
/// let hands_m = [Vec3::new(0.3, 0.2, 2.0), Vec3::new(0.1, 0.2, 2.0)];
/// let past = goal_past(&hands_m);
/// let process = LinearExtrapolation { persistence: 0.0, std_m_per_sqrt_s: 0.0 };
/// let others = LinearGoals::new(&[0, 1], 2, process, 0.05)?;
/// let sight = StickSight::Rays([Vec3::new(0.3, 0.0, 1.0).normalize(), Vec3::z()]);
/// let stick = StickGoals {
///     hands: [0, 1],
///     sight,
///     camera_m: Vec3::zeros(),
///     gamma_std_per_sqrt_s: 0.1,
///     reach_std_m: 0.01,
///     others: &others,
/// };
/// # let hands_y_m = |sight| {
/// #     let mut goals = Goals::new();
/// #     StickGoals { sight, ..stick }.draw(&past, &mut [0.0; MEMORY], &mut Stream::new(1, 0, 0), &mut goals);
/// #     [goals[0].position_m.y, goals[1].position_m.y]
/// };
/// // Both hands were at y = 0.2; where do their goals lie?
/// assert_eq!(hands_y_m(sight), [0.0; 2], "both rays lie at y = 0");
/// assert_eq!(hands_y_m(StickSight::Unseen), [0.2; 2], "without a stick hands stay where they were");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StickSight {
    /// Both end points in space, metres.
    Ends([Vec3; 2]),
    /// Only the directions in which the camera sees both end points: unit vectors from its centre,
    /// in camera axes.
    Rays([Vec3; 2]),
    /// The stick was not seen: hands go on as if there were none.
    Unseen,
}

/// Each hand lies at its share gamma of the way along the stick. The share walks a little from
/// frame to frame inside [0, 1]. Other end-effectors (the head) go on linearly.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::example::goal_past;
/// use sinew_core::pik::goal::{GoalProcess, Goals, LinearExtrapolation, MEMORY};
/// use sinew_core::pik::processes::extrapolation::LinearGoals;
/// use sinew_core::pik::processes::stick::{StickGoals, StickSight};
/// use sinew_core::random::Stream;
///
/// // Two hands (bones 0 and 1) near a stick of a metre, both ends of which are known in space.
/// let hands_m = [Vec3::new(0.3, 0.05, 2.0), Vec3::new(0.7, -0.05, 2.0)];
/// let past = goal_past(&hands_m);
/// let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.2 };
/// let stick = StickGoals {
///     hands: [0, 1],
///     sight: StickSight::Ends([Vec3::new(1.0, 0.0, 2.0), Vec3::new(0.0, 0.0, 2.0)]),
///     camera_m: Vec3::zeros(),
///     gamma_std_per_sqrt_s: 0.1,
///     reach_std_m: 0.01,
///     others: &LinearGoals::new(&[0, 1], 2, process, 0.05)?,
/// };
/// let mut goals = Goals::new();
/// stick.draw(&past, &mut [0.0; MEMORY], &mut Stream::new(1, 0, 0), &mut goals);
/// let [left_m, right_m] = [goals[0].position_m, goals[1].position_m];
/// assert!(left_m.y == 0.0 && right_m.y == 0.0, "on the stick");
/// assert!((left_m.x - 0.3).abs() < 0.15 && (right_m.x - 0.7).abs() < 0.15, "near where they held it");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StickGoals<'a> {
    /// The bones whose ends hold the stick.
    pub hands: [usize; 2],
    /// The stick in this frame.
    pub sight: StickSight,
    /// Centre of the camera, metres.
    pub camera_m: Vec3,
    /// sigma of PIK (37) after one second.
    pub gamma_std_per_sqrt_s: f32,
    /// How closely a hand reaches its place on the stick, metres.
    pub reach_std_m: f32,
    /// All end-effectors, the hands among them, when the stick says nothing.
    pub others: &'a LinearGoals,
}

impl<const BONES: usize> GoalProcess<BONES> for StickGoals<'_> {
    fn end_effectors(&self) -> &[usize] {
        GoalProcess::<BONES>::end_effectors(self.others)
    }

    fn draw(&self, past: &GoalPast<'_, BONES>, memory: &mut GoalMemory, stream: &mut Stream, goals: &mut Goals) {
        self.others.draw(past, memory, stream, goals);
        self.hold(past, memory, stream, goals);
    }

    fn expect(&self, past: &GoalPast<'_, BONES>, memory: &mut GoalMemory, stream: &mut Stream, goals: &mut Goals) {
        self.others.expect(past, memory, stream, goals);
        self.hold(past, memory, stream, goals);
    }
}

impl StickGoals<'_> {
    /// Puts the hands' goals on the stick.
    fn hold<const BONES: usize>(
        &self,
        past: &GoalPast<'_, BONES>,
        memory: &mut GoalMemory,
        stream: &mut Stream,
        goals: &mut Goals,
    ) {
        for (hand, gamma) in self.hands.iter().zip(memory.iter_mut()) {
            let Some(goal) = goals.iter_mut().find(|goal| goal.bone == *hand) else { continue };
            match self.sight {
                StickSight::Ends(ends_m) => {
                    if past.is_first || *gamma == UNKNOWN {
                        let reached_m = past.reached_m.get(*hand).copied().unwrap_or(goal.position_m);
                        *gamma = share_along(&ends_m, &reached_m);
                    }
                    let std = self.gamma_std_per_sqrt_s * sqrt(past.dt_s);
                    // Strictly inside, so that a hand at the very end is not taken for an unknown
                    // one.
                    let z = stream.truncated_normal((f32::EPSILON - *gamma) / std, (1.0 - *gamma) / std);
                    *gamma = clamp(*gamma + std * z, f32::EPSILON, 1.0);
                    // gamma is the share of the first end, as in PIK (36).
                    *goal = self.goal(*hand, ends_m[0] * *gamma + ends_m[1] * (1.0 - *gamma));
                }
                StickSight::Rays(rays) => *goal = self.goal(*hand, into_wedge(&self.camera_m, &rays, &goal.position_m)),
                StickSight::Unseen => {}
            }
        }
    }

    fn goal(&self, bone: usize, position_m: Vec3) -> Goal {
        Goal { bone, position_m, precision: Mat3::identity() / (self.reach_std_m * self.reach_std_m) }
    }
}

/// gamma of the place on the stick nearest to `place_m`, in (0, 1].
fn share_along(ends_m: &[Vec3; 2], place_m: &Vec3) -> f32 {
    let along = ends_m[0] - ends_m[1];
    let squared = max(along.dot(&along), f32::MIN_POSITIVE);
    clamp((place_m - ends_m[1]).dot(&along) / squared, f32::EPSILON, 1.0)
}

/// The place nearest to `place_m` in the plane through the camera and both rays, inside the wedge
/// between them. Parallel rays make a wedge that is a ray.
fn into_wedge(camera_m: &Vec3, rays: &[Vec3; 2], place_m: &Vec3) -> Vec3 {
    let from = place_m - camera_m;
    if let Some(normal) = unit(rays[0].cross(&rays[1])) {
        let inside = from - normal * from.dot(&normal);
        // Between the rays: on the inner side of both.
        let (first, second) = (rays[0].cross(&inside).dot(&normal), inside.cross(&rays[1]).dot(&normal));
        if min(first, second) >= 0.0 {
            return camera_m + inside;
        }
    }
    let on = |ray: &Vec3| ray * max(from.dot(ray), 0.0);
    let (one, other) = (on(&rays[0]), on(&rays[1]));
    camera_m + if (from - one).dot(&(from - one)) <= (from - other).dot(&(from - other)) { one } else { other }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pik::goal::LinearExtrapolation;

    fn others() -> LinearGoals {
        let process = LinearExtrapolation { persistence: 0.0, std_m_per_sqrt_s: 0.2 };
        LinearGoals::new(&[0, 1, 2], 3, process, 0.05).unwrap()
    }

    fn drawn(sight: StickSight, seed: u64, memory: &mut GoalMemory, is_first: bool) -> Goals {
        let others = others();
        let stick = StickGoals {
            hands: [1, 2],
            sight,
            camera_m: Vec3::zeros(),
            gamma_std_per_sqrt_s: 0.3,
            reach_std_m: 0.01,
            others: &others,
        };
        let reached_m = [Vec3::zeros(), Vec3::new(0.3, 0.1, 2.0), Vec3::new(0.7, 0.0, 2.0)];
        let past = GoalPast {
            reached_m: &reached_m,
            velocity_m_per_s: &[Vec3::zeros(); 3],
            noise_share: &[1.0; 3],
            first_m: &reached_m,
            root_shift_m: Vec3::zeros(),
            dt_s: 1.0 / 15.0,
            is_first,
        };
        let mut goals = Goals::new();
        stick.draw(&past, memory, &mut Stream::new(seed, 0, 0), &mut goals);
        goals
    }

    #[test]
    fn hands_stay_on_the_stick_and_near_where_they_held_it() {
        let ends = [Vec3::new(1.0, 0.0, 2.0), Vec3::new(0.0, 0.0, 2.0)];
        let mut memory = [0.0; 32];
        let (mut sum, mut square) = (0.0, 0.0);
        for seed in 0..400 {
            memory = [0.0; 32];
            let goals = drawn(StickSight::Ends(ends), seed, &mut memory, true);
            let place = goals[1].position_m;
            assert!(place.y == 0.0 && place.z == 2.0 && place.x > 0.0 && place.x <= 1.0, "{place:?}");
            sum += (place.x - 0.3) / 400.0;
            square += (place.x - 0.3) * (place.x - 0.3) / 400.0;
        }
        assert!(sum.abs() < 0.015, "mean {sum}");
        assert!((square.sqrt() / (0.3 * (1.0_f32 / 15.0).sqrt()) - 1.0).abs() < 0.15, "spread {}", square.sqrt());
        assert!(memory[0] > 0.0 && memory[1] > memory[0]);
    }

    #[test]
    fn with_rays_alone_hands_lie_in_the_wedge() {
        let rays = [Vec3::new(0.4, 0.0, 1.0).normalize(), Vec3::new(0.0, 0.0, 1.0)];
        for seed in 0..200 {
            let goals = drawn(StickSight::Rays(rays), seed, &mut [0.0; 32], true);
            for goal in &goals[1..] {
                let p = goal.position_m;
                assert!(p.y.abs() < 1.0e-5 && p.x >= -1.0e-5 && p.x <= 0.4 * p.z + 1.0e-4, "{p:?}");
            }
        }
        let parallel = [Vec3::new(0.1, 0.0, 1.0).normalize(); 2];
        let p = drawn(StickSight::Rays(parallel), 3, &mut [0.0; 32], true)[1].position_m;
        assert!(p.cross(&parallel[0]).norm() < 1.0e-5, "{p:?} is not on the ray");
    }

    #[test]
    fn an_unseen_stick_holds_nobody() {
        let goals = drawn(StickSight::Unseen, 5, &mut [0.0; 32], false);
        assert!((goals[1].position_m - Vec3::new(0.3, 0.1, 2.0)).norm() > 1.0e-4);
        assert_eq!(goals.len(), 3);
    }
}
