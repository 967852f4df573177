//! An upper body for firmware: up to 512 points a frame, one mode, 10 KB, nothing allocated.
//!
//! It gives the poses of the host's `modes` with one mode, no draws and points that are taken as
//! they are (`tests/firmware_run/tests/body.rs`). Two modes of the same, the exchanged arms beside
//! the leading one, have the same error on such points and cost twice as much (docs/decisions.md).

use super::estimate::BodyEstimate;
use super::frame::BodyFrame;
use super::legs::Legs;
use super::modes::{DEFAULT_MODE_OPTIONS, ModeOptions, SingleModeTracker};
use super::pace::SpeedScaledNoise;
use crate::error::{ParameterError, Rule, within};
use crate::kinematics::solver_memory::SolverMemory;
use crate::math::Vec3;
use crate::observation::point_cloud::{BLOCK_POINTS, LeftOut, PointCloud};
use crate::observation::point_likelihood::PointLikelihood;
use crate::pik::goal::LinearExtrapolation;
use crate::pik::guided::GuidedMotion;
use crate::pik::motion::{BodyParticle, BodyScene};
use crate::pik::processes::extrapolation::LinearGoals;
use crate::pik::root::{NO_PLANES, RootProcess};
use crate::saved_state::{SavedState, StateVisitor};
use crate::skeleton::BodyMeasures;
use crate::skeleton::full_body::{COLLARS, FOREARMS, HEAD, TRUNK};
use crate::skeleton::upper_body::{UPPER_ANGLES, UPPER_BONES, upper_body, upper_radii_m};
use crate::slot::Slot;

/// Most points of a frame.
pub const UPPER_POINTS: usize = UPPER_BLOCKS * BLOCK_POINTS;
/// Blocks of them.
const UPPER_BLOCKS: usize = 32;

/// Bones whose ends have goals, and about whose ends they swing: as the host's `modes`.
const END_EFFECTORS: [usize; 3] = [HEAD, FOREARMS[0], FOREARMS[1]];
const JOINTS: [usize; 3] = [TRUNK, COLLARS[0], COLLARS[1]];

/// The numbers of the host's guided models, tuned on the motions that docs/data_split.md names.
const GOAL_PERSISTENCE: f32 = 0.5;
const GOAL_STD_M_PER_SQRT_S: f32 = 0.3;
const REACH_STD_M: f32 = 0.03;
const ANGLE_PERSISTENCE: f32 = 0.5;
/// Head, then shoulder and elbow of either arm; those of the root are not read.
const ANGLE_STD_RAD_PER_SQRT_S: [f32; UPPER_ANGLES] =
    [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.6, 0.6, 0.6, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0];
const PACE: SpeedScaledNoise = SpeedScaledNoise {
    rest_share: 0.4,
    full_speed_m_per_s: 1.6,
    max_scale_seen: 5.0,
    fade_s: 0.3,
    unseen_growth_s: 0.5,
    max_scale_unseen: 2.5,
};
const ROOT_PERSISTENCE: f32 = 0.85;

/// Options of an upper body.
///
/// ```
/// use sinew_core::tracker::body::upper::{DEFAULT_UPPER_OPTIONS, UpperBodyOptions, UpperBodyTracker};
/// use sinew_core::skeleton::upper_body::UPPER_ANGLES;
///
/// // A child; a wrong option is refused by its name.
/// let child = UpperBodyOptions { height_m: 1.2, ..DEFAULT_UPPER_OPTIONS };
/// let mut pose = [0.0; UPPER_ANGLES];
/// pose[2] = 1.5;
/// assert!(UpperBodyTracker::empty().begin(&child, pose).is_ok());
/// let giant = UpperBodyOptions { height_m: 9.0, ..child };
/// assert_eq!(UpperBodyTracker::empty().begin(&giant, pose).map_err(|error| error.parameter), Err("height_m"));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UpperBodyOptions {
    /// Height of the person, metres, 0.5 to 2.5: lengths and radii of all bones follow from it.
    pub height_m: f32,
    /// sigma of PIK (25), metres, 0.001 to 1.
    pub point_std_m: f32,
    /// Root of tau of PIK (29): beyond this distance a point is an outlier, metres, 0.001 to 1.
    pub outlier_m: f32,
    /// How far the root may get, metres by root second, 0.001 to 10.
    pub root_shift_std_m_per_sqrt_s: f32,
    /// How far it may turn, radians by root second, 0.001 to 10.
    pub root_turn_std_rad_per_sqrt_s: f32,
    /// Deadband of the reported pose at rest, metres, 0 to 1.
    pub jitter_std_m: f32,
    /// Most steps of the solver, 1 to 20: the time of a frame grows with them.
    pub solver_steps: usize,
}

/// The numbers of the host's `modes`.
pub const DEFAULT_UPPER_OPTIONS: UpperBodyOptions = UpperBodyOptions {
    height_m: 1.75,
    point_std_m: 0.05,
    outlier_m: 0.08,
    root_shift_std_m_per_sqrt_s: 0.3,
    root_turn_std_rad_per_sqrt_s: 0.7,
    jitter_std_m: 0.0075,
    solver_steps: 4,
};

impl UpperBodyOptions {
    /// Checks every value.
    ///
    /// # Errors
    /// Names the first value that is out of its range.
    pub fn check(&self) -> Result<(), ParameterError> {
        within("height_m", self.height_m, 0.5, 2.5)?;
        within("point_std_m", self.point_std_m, 0.001, 1.0)?;
        within("outlier_m", self.outlier_m, 0.001, 1.0)?;
        within("root_shift_std_m_per_sqrt_s", self.root_shift_std_m_per_sqrt_s, 0.001, 10.0)?;
        within("root_turn_std_rad_per_sqrt_s", self.root_turn_std_rad_per_sqrt_s, 0.001, 10.0)?;
        within("jitter_std_m", self.jitter_std_m, 0.0, 1.0)?;
        if !(1..=20).contains(&self.solver_steps) {
            return Err(ParameterError::new("solver_steps", Rule::Within { low: 1.0, high: 20.0 }));
        }
        Ok(())
    }

    fn root(&self) -> RootProcess {
        let (s, t) = (self.root_shift_std_m_per_sqrt_s, self.root_turn_std_rad_per_sqrt_s);
        RootProcess { persistence: ROOT_PERSISTENCE, std_per_sqrt_s: [s, s, s, t, t, t], shift_limits_m: NO_PLANES }
    }
}

/// An upper body, its goals and its tracker.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::full_body::{FOREARMS, TRUNK};
/// use sinew_core::skeleton::upper_body::UPPER_ANGLES;
/// use sinew_core::tracker::body::upper::{DEFAULT_UPPER_OPTIONS, UpperBodyTracker};
///
/// // A person who sits 1.5 m before the camera, arms hanging, and no point: the pose stays.
/// let mut pose = [0.0; UPPER_ANGLES];
/// pose[2] = 1.5;
/// let mut body = UpperBodyTracker::empty();
/// body.begin(&DEFAULT_UPPER_OPTIONS, pose)?;
/// let (estimate, _) = body.step(&mut [], 1.0 / 15.0).expect("it has begun");
/// assert!(!estimate.observed[TRUNK]);
/// assert!((estimate.ends_m[FOREARMS[0]].z - 1.5).abs() < 0.05);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug)]
pub struct UpperBodyTracker {
    options: UpperBodyOptions,
    scene: Slot<BodyScene<UPPER_BONES, UPPER_ANGLES>>,
    goals: Slot<LinearGoals>,
    tracker: Slot<SingleModeTracker<UPPER_BONES, UPPER_ANGLES>>,
    cloud: PointCloud<UPPER_BLOCKS>,
    memory: SolverMemory<UPPER_BONES, UPPER_ANGLES>,
}

impl UpperBodyTracker {
    /// Before [`Self::begin`], for static memory: all zeros.
    #[must_use]
    pub const fn empty() -> Self {
        Self {
            options: UpperBodyOptions {
                height_m: 0.0,
                point_std_m: 0.0,
                outlier_m: 0.0,
                root_shift_std_m_per_sqrt_s: 0.0,
                root_turn_std_rad_per_sqrt_s: 0.0,
                jitter_std_m: 0.0,
                solver_steps: 0,
            },
            scene: Slot::Empty,
            goals: Slot::Empty,
            tracker: Slot::Empty,
            cloud: PointCloud::empty(),
            memory: SolverMemory::new(),
        }
    }

    /// Whether it has never begun.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.tracker.get().is_none()
    }

    /// Begins, or begins anew, in place: the person is at `first_rad` (three shifts in metres, 14
    /// angles in radians, in the order of [`crate::skeleton::upper_body`]).
    ///
    /// # Errors
    /// Options out of their ranges; what is there stays then.
    pub fn begin(&mut self, options: &UpperBodyOptions, first_rad: [f32; UPPER_ANGLES]) -> Result<(), ParameterError> {
        options.check()?;
        self.options = *options;
        self.begin_scene()?;
        self.begin_goals()?;
        self.begin_tracker(first_rad)
    }

    // Each in a frame of its own, one after the other.
    #[inline(never)]
    fn begin_scene(&mut self) -> Result<(), ParameterError> {
        let measures = BodyMeasures::of_height(self.options.height_m)?;
        self.scene = Slot::Full(BodyScene {
            skeleton: upper_body(&measures)?,
            radii_m: upper_radii_m(&measures),
            camera_m: Vec3::zeros(),
            likelihood: PointLikelihood { std_m: self.options.point_std_m, outlier_m: self.options.outlier_m },
            self_penetration: None,
        });
        Ok(())
    }

    #[inline(never)]
    fn begin_goals(&mut self) -> Result<(), ParameterError> {
        let process = LinearExtrapolation { persistence: GOAL_PERSISTENCE, std_m_per_sqrt_s: GOAL_STD_M_PER_SQRT_S };
        let goals = LinearGoals::new(&END_EFFECTORS, UPPER_BONES, process, REACH_STD_M)?
            .carrying(END_EFFECTORS.len())
            .swinging_about(&JOINTS, UPPER_BONES)?;
        self.goals = Slot::Full(goals);
        Ok(())
    }

    #[inline(never)]
    fn begin_tracker(&mut self, first_rad: [f32; UPPER_ANGLES]) -> Result<(), ParameterError> {
        let Some(scene) = self.scene.get() else { return Ok(()) };
        let first = BodyParticle::at(&scene.skeleton, first_rad);
        let options = ModeOptions {
            max_modes: 1,
            draws: 0,
            jitter_std_m: self.options.jitter_std_m,
            pace: Some(PACE),
            ..DEFAULT_MODE_OPTIONS
        };
        self.tracker = Slot::Full(SingleModeTracker::new(&first, options)?);
        Ok(())
    }

    /// One frame, `dt_s` seconds after the one before: `points_m` in camera axes, metres, which are
    /// brought into another order. Those of the [legs](Legs), and those beyond 512, are left out.
    /// `None` before [`Self::begin`].
    pub fn step(
        &mut self,
        points_m: &mut [Vec3],
        dt_s: f32,
    ) -> Option<(BodyEstimate<UPPER_BONES, UPPER_ANGLES>, LeftOut)> {
        let (scene, goals, tracker) = (self.scene.get()?, self.goals.get()?, self.tracker.get_mut()?);
        let legs = Legs::of(&tracker.pose().ends_m, &scene.radii_m, self.options.outlier_m);
        let left_out = self.cloud.set(legs.leave_out(points_m), &scene.camera_m);
        let motion = GuidedMotion {
            process: goals,
            root: self.options.root(),
            angle_std_rad_per_sqrt_s: ANGLE_STD_RAD_PER_SQRT_S,
            angle_persistence: ANGLE_PERSISTENCE,
            solver_steps: self.options.solver_steps,
            pulling_blocks: UPPER_BLOCKS,
            refining_steps: 0,
        };
        let frame = BodyFrame { dt_s, blocks: self.cloud.blocks() };
        let estimate = tracker.step_within(scene, &motion, &frame, &mut self.memory);
        Some((estimate, left_out))
    }
}

impl SavedState for UpperBodyTracker {
    /// A state is for a tracker that has begun with the same options.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        match self.tracker.get_mut() {
            Some(tracker) => tracker.visit(visitor),
            None => visitor.refuse(),
        }
    }
}
