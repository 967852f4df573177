//! The core's body tracker over many threads.
//!
//! Every particle draws from its own stream and results are stored by index, so the bits do not depend on the threads.

use super::model_kind::BodyModelKind;
use super::tuning::BodyTuning;
use rayon::prelude::*;
use sinew_core::error::ParameterError;
use sinew_core::math::Vec3;
use sinew_core::observation::point_cloud::PointBlock;
use sinew_core::observation::point_likelihood::PointLikelihood;
use sinew_core::pik::angular::AngularMotion;
use sinew_core::pik::end_effector::EndEffectorMotion;
use sinew_core::pik::goal::GoalProcess;
use sinew_core::pik::guided::GuidedMotion;
use sinew_core::pik::motion::{BodyMotion, BodyParticle, BodyScene};
use sinew_core::pik::processes::extrapolation::LinearGoals;
use sinew_core::pik::processes::paper_extrapolation::PaperGoals;
use sinew_core::pik::processes::pelvic_lift::FixedGoals;
use sinew_core::pik::processes::stick::{StickGoals, StickSight};
use sinew_core::pik::root::RootProcess;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_ANGLES, BODY_BONES, FOREARMS, HEAD, SHANKS, body_radii_m, full_body};
use sinew_core::tracker::body::{BodyEstimate, BodyFrame, BodyOptions, BodyTracker};

/// Most particles of a body tracker.
pub const MAX_BODY_PARTICLES: usize = 16_384;

/// End-effectors with goals: head, hands and feet.
pub const END_EFFECTORS: [usize; 5] = [HEAD, FOREARMS[0], FOREARMS[1], SHANKS[0], SHANKS[1]];
/// Of these head and hands go with the root; feet stand.
const CARRIED: usize = 3;
/// End-effectors of the PIK paper (section 7.1.2): head and hands.
const PAPER_END_EFFECTORS: [usize; 3] = [HEAD, FOREARMS[0], FOREARMS[1]];
/// Standard deviation of every angle a frame for kappa = 500, radians (PIK paper, fig. 2).
const PAPER_ANGLE_STD_RAD: f32 = 0.044_721_36;
/// sigma of eq. (33), metres a frame: the paper does not print it.
const PAPER_GOAL_STD_M: f32 = 0.05;

/// A whole body's estimate.
pub type WholeBodyEstimate = BodyEstimate<BODY_BONES, BODY_ANGLES>;
/// A whole body's hypothesis.
pub type WholeBodyParticle = BodyParticle<BODY_BONES, BODY_ANGLES>;

type Tracker = BodyTracker<BODY_BONES, BODY_ANGLES, MAX_BODY_PARTICLES, Vec<WholeBodyParticle>>;

/// One body, tracked.
#[derive(Debug, Clone)]
pub struct BodyFilter {
    kind: BodyModelKind,
    tuning: BodyTuning,
    scene: BodyScene<BODY_BONES, BODY_ANGLES>,
    goals: LinearGoals,
    /// Second shift of the floor, metres (camera axes, y down).
    floor_y_m: f32,
    tracker: Box<Tracker>,
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
        let (points, goals) = match kind {
            BodyModelKind::Guided => (tuning.guided_points, tuning.guided),
            _ => (tuning.points, tuning.end_effector),
        };
        let scene = BodyScene {
            skeleton: full_body(measures)?,
            radii_m: body_radii_m(measures),
            camera_m: Vec3::zeros(),
            likelihood: PointLikelihood { std_m: points.std_m, outlier_m: points.outlier_m },
        };
        let goals =
            LinearGoals::new(&END_EFFECTORS, BODY_BONES, goals.extrapolation(), goals.reach_std_m)?.carrying(CARRIED);
        let first = BodyParticle::at(&scene.skeleton, first_rad);
        let is_aligned = !matches!(kind, BodyModelKind::Guided | BodyModelKind::PelvicLift);
        let options = BodyOptions {
            least_effective_share: points.least_effective_share,
            alignment: tuning.root.alignment().filter(|_| is_aligned),
        };
        let set = vec![first; particles];
        let tracker = Box::new(Tracker::new(&first, (set.clone(), set), options, seed)?);
        Ok(Self { kind, tuning, scene, goals, floor_y_m: f32::INFINITY, tracker })
    }

    /// Puts the floor of the pelvic lift: the pelvis stays above (camera axes, y down), metres.
    #[must_use]
    pub fn above_floor(mut self, floor_y_m: f32) -> Self {
        self.floor_y_m = floor_y_m;
        self
    }

    /// The body and its camera.
    #[must_use]
    pub fn scene(&self) -> &BodyScene<BODY_BONES, BODY_ANGLES> {
        &self.scene
    }

    /// The particles after the last step and their weights.
    #[must_use]
    pub fn particles(&self) -> (&[WholeBodyParticle], &[f32]) {
        (self.tracker.particles(), self.tracker.weights())
    }

    /// One frame, `dt_s` seconds after the one before; `stick` is what is known of the stick, which only the stick model asks.
    pub fn step(&mut self, blocks: &[PointBlock], dt_s: f32, stick: StickSight) -> WholeBodyEstimate {
        let (tuning, goals) = (self.tuning, self.goals.clone());
        let root = tuning.root.process();
        let frame = BodyFrame { dt_s, blocks };
        match self.kind {
            BodyModelKind::EndEffector => self.advance(&with_goals(&tuning, &goals, root), &frame),
            BodyModelKind::Guided => self.advance(&guided(&tuning, &goals, tuning.root.guided_process()), &frame),
            BodyModelKind::Angular => self.advance(&angular(&tuning, root), &frame),
            BodyModelKind::Stick => {
                let process = StickGoals {
                    hands: FOREARMS,
                    sight: stick,
                    camera_m: self.scene.camera_m,
                    gamma_std_per_sqrt_s: tuning.stick_gamma_std,
                    reach_std_m: tuning.stick_reach_std_m,
                    others: &goals,
                };
                self.advance(&with_goals(&tuning, &process, root), &frame)
            }
            BodyModelKind::PelvicLift => {
                let reach_std_m = tuning.end_effector.reach_std_m;
                let process = FixedGoals { end_effectors: &END_EFFECTORS, reach_std_m };
                let root = RootProcess::pelvic_lift(tuning.lift_std_m, tuning.lift_turn_std_rad, self.floor_y_m);
                self.advance(&with_goals(&tuning, &process, root), &frame)
            }
            BodyModelKind::EndEffectorPaper => {
                let reach_std_m = tuning.end_effector.reach_std_m;
                let end_effectors = &PAPER_END_EFFECTORS;
                let process = PaperGoals { end_effectors, std_m: PAPER_GOAL_STD_M, reach_std_m };
                let motion = EndEffectorMotion {
                    angle_std_rad_per_sqrt_s: paper_angle_std(dt_s),
                    pays: true,
                    ..with_goals(&tuning, &process, root)
                };
                self.advance(&motion, &frame)
            }
            BodyModelKind::AngularPaper => {
                let angle_std_rad_per_sqrt_s = paper_angle_std(dt_s);
                self.advance(
                    &AngularMotion { root, persistence: 1.0, angle_std_rad_per_sqrt_s, own_velocity: true },
                    &frame,
                )
            }
        }
    }

    /// The core's step, its particles shared out over the threads of the current pool.
    fn advance<M: BodyMotion<BODY_BONES, BODY_ANGLES> + Sync>(
        &mut self,
        motion: &M,
        frame: &BodyFrame<'_>,
    ) -> WholeBodyEstimate {
        self.tracker.step_with(&self.scene, motion, frame, |advance, particles, store| {
            let advance_one = |(index, slot): (usize, &mut WholeBodyParticle)| advance.particle(index, slot);
            let log_weights: Vec<f32> = particles.par_iter_mut().enumerate().map(advance_one).collect();
            for (index, log_weight) in log_weights.into_iter().enumerate() {
                store(index, log_weight);
            }
        })
    }
}

/// kappa = 500 in every frame, as noise by root second.
fn paper_angle_std(dt_s: f32) -> [f32; BODY_ANGLES] {
    [PAPER_ANGLE_STD_RAD / dt_s.max(1.0e-4).sqrt(); BODY_ANGLES]
}

fn angular(tuning: &BodyTuning, root: RootProcess) -> AngularMotion<BODY_ANGLES> {
    AngularMotion {
        root,
        persistence: tuning.angular.persistence,
        angle_std_rad_per_sqrt_s: tuning.angular.joint_std.per_angle(),
        own_velocity: false,
    }
}

fn guided<'a>(
    tuning: &BodyTuning,
    process: &'a LinearGoals,
    root: RootProcess,
) -> GuidedMotion<'a, LinearGoals, BODY_ANGLES> {
    GuidedMotion {
        process,
        root,
        angle_std_rad_per_sqrt_s: tuning.guided.joint_std.per_angle(),
        solver_steps: tuning.guided.solver_steps,
        pulling_blocks: tuning.pulling_blocks,
    }
}

/// A model with goals, by the numbers of the end-effector model.
fn with_goals<'a, P: GoalProcess<BODY_BONES>>(
    tuning: &BodyTuning,
    process: &'a P,
    root: RootProcess,
) -> EndEffectorMotion<'a, P, BODY_ANGLES> {
    EndEffectorMotion {
        process,
        root,
        angle_std_rad_per_sqrt_s: tuning.end_effector.joint_std.per_angle(),
        solver_steps: tuning.end_effector.solver_steps,
        pays: tuning.end_effector.pays,
        draw_share: tuning.end_effector.draw_share,
    }
}
