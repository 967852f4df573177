//! The core's body tracker for one size of skeleton, its particles over many threads.
//!
//! Every particle draws from its own stream and results are stored by index, so the bits do not
//! depend on the threads.

use super::ambiguity::{elsewhere_share, with_rival};
use super::by_joint::ByJoint;
use super::end_effectors::{CARRIED, END_EFFECTORS, JOINTS, MAX_BODY_PARTICLES};
use super::model_kind::BodyModelKind;
use super::paper_tuning::PaperTuning;
use super::tuning::BodyTuning;
use rayon::prelude::*;
use sinew_core::error::ParameterError;
use sinew_core::math::Vec3;
use sinew_core::observation::point_likelihood::PointLikelihood;
use sinew_core::observation::self_penetration::SelfPenetration;
use sinew_core::pik::angular::AngularMotion;
use sinew_core::pik::end_effector::EndEffectorMotion;
use sinew_core::pik::goal::LinearExtrapolation;
use sinew_core::pik::guided::GuidedMotion;
use sinew_core::pik::motion::{BodyMotion, BodyParticle, BodyScene};
use sinew_core::pik::processes::extrapolation::LinearGoals;
use sinew_core::pik::processes::paper_extrapolation::PaperGoals;
use sinew_core::pik::processes::pelvic_lift::FixedGoals;
use sinew_core::pik::processes::stick::{StickGoals, StickSight};
use sinew_core::pik::root::RootProcess;
use sinew_core::saved_state::{SavedState, StateVisitor};
use sinew_core::skeleton::Skeleton;
use sinew_core::skeleton::full_body::FOREARMS;
use sinew_core::tracker::body::modes::ModeTracker;
use sinew_core::tracker::body::{BodyEstimate, BodyFrame, BodyTracker};

type Particle<const BONES: usize, const ANGLES: usize> = BodyParticle<BONES, ANGLES>;
pub(super) type Tracker<const BONES: usize, const ANGLES: usize> =
    BodyTracker<BONES, ANGLES, MAX_BODY_PARTICLES, Vec<Particle<BONES, ANGLES>>>;

/// A skeleton with its flesh, and which of a whole body's coordinates it has.
#[derive(Debug, Clone)]
pub(super) struct SizedBody<const BONES: usize, const ANGLES: usize> {
    pub skeleton: Skeleton<BONES, ANGLES>,
    pub radii_m: [f32; BONES],
    pub coordinates: [usize; ANGLES],
}

/// What a frame shows, and where the floor of the pelvic lift is.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeenFrame<'a> {
    pub frame: BodyFrame<'a>,
    pub stick: StickSight,
    /// Second shift of the floor, metres (camera axes, y down).
    pub floor_y_m: f32,
}

/// The core's tracker by particles, or by modes.
#[derive(Debug, Clone)]
pub(super) enum AnyTracker<const BONES: usize, const ANGLES: usize> {
    Particles(Box<Tracker<BONES, ANGLES>>),
    Modes(Box<ModeTracker<BONES, ANGLES>>),
}

impl<const BONES: usize, const ANGLES: usize> SavedState for AnyTracker<BONES, ANGLES> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        match self {
            Self::Particles(tracker) => tracker.visit(visitor),
            Self::Modes(tracker) => tracker.visit(visitor),
        }
    }
}

/// A body of one size, tracked.
#[derive(Debug, Clone)]
pub(super) struct SizedFilter<const BONES: usize, const ANGLES: usize> {
    kind: BodyModelKind,
    tuning: BodyTuning,
    scene: BodyScene<BONES, ANGLES>,
    coordinates: [usize; ANGLES],
    goals: LinearGoals,
    fit_trunk: bool,
    tracker: AnyTracker<BONES, ANGLES>,
    /// The poses of the modes and their weights; not read of a tracker by particles.
    modes: (Vec<Particle<BONES, ANGLES>>, Vec<f32>),
}

impl<const BONES: usize, const ANGLES: usize> SizedFilter<BONES, ANGLES> {
    /// `particles` particles of `body` that begin at `first_rad`.
    ///
    /// # Errors
    /// Names the parameter that broke a rule.
    pub fn new(
        kind: BodyModelKind,
        tuning: BodyTuning,
        body: SizedBody<BONES, ANGLES>,
        first_rad: [f32; ANGLES],
        particles: usize,
        seed: u64,
    ) -> Result<Self, ParameterError> {
        let (points, goals) = tuning.points_and_goals(kind);
        let scene = BodyScene {
            self_penetration: kept_apart(&tuning, &body.skeleton, &body.radii_m)?,
            skeleton: body.skeleton,
            radii_m: body.radii_m,
            camera_m: Vec3::zeros(),
            likelihood: PointLikelihood { std_m: points.std_m, outlier_m: points.outlier_m },
        };
        let goals = LinearGoals::new(end_effectors(BONES), BONES, goals.extrapolation(), goals.reach_std_m)?
            .spreading_by(&goals.goal_std.per_end_effector())?
            .carrying(CARRIED)
            .swinging_about(&JOINTS, BONES)?;
        let first = BodyParticle::at(&scene.skeleton, first_rad);
        let options = tuning.options(kind);
        let fit_trunk = options.alignment.is_some_and(|alignment| alignment.fit_trunk);
        let set = vec![first; particles];
        let tracker = match kind {
            BodyModelKind::Modes => {
                AnyTracker::Modes(Box::new(ModeTracker::new(&first, tuning.mode_options(particles), seed)?))
            }
            _ => AnyTracker::Particles(Box::new(Tracker::new(&first, (set.clone(), set.clone()), options, seed)?)),
        };
        let weights = vec![1.0 / particles as f32; particles];
        Ok(Self {
            kind,
            tuning,
            scene,
            coordinates: body.coordinates,
            goals,
            fit_trunk,
            tracker,
            modes: (set, weights),
        })
    }

    /// Goes on with the same poses of a body with other lengths and radii.
    ///
    /// # Errors
    /// Names the parameter that broke a rule.
    pub fn resize(&mut self, skeleton: Skeleton<BONES, ANGLES>, radii_m: [f32; BONES]) -> Result<(), ParameterError> {
        match &mut self.tracker {
            AnyTracker::Particles(tracker) => tracker.reshape(&skeleton),
            AnyTracker::Modes(tracker) => tracker.reshape(&skeleton),
        }
        self.scene.self_penetration = kept_apart(&self.tuning, &skeleton, &radii_m)?;
        (self.scene.skeleton, self.scene.radii_m) = (skeleton, radii_m);
        Ok(())
    }

    /// The particles after the last step.
    pub fn particles(&self) -> &[Particle<BONES, ANGLES>] {
        match &self.tracker {
            AnyTracker::Particles(tracker) => tracker.particles(),
            AnyTracker::Modes(_) => &self.modes.0,
        }
    }

    /// The pose that is reported, before the deadband.
    pub fn mean(&self) -> &Particle<BONES, ANGLES> {
        match &self.tracker {
            AnyTracker::Particles(tracker) => tracker.mean(),
            AnyTracker::Modes(tracker) => &tracker.modes()[0].pose,
        }
    }

    /// The particles' weights.
    pub fn weights(&self) -> &[f32] {
        match &self.tracker {
            AnyTracker::Particles(tracker) => tracker.weights(),
            AnyTracker::Modes(_) => &self.modes.1,
        }
    }

    /// Share of the weight that puts each bone's end elsewhere than `ends_m`.
    pub fn ambiguous(&self, ends_m: &[Vec3; BONES]) -> [f32; BONES] {
        let shares = elsewhere_share(self.particles(), self.weights(), ends_m);
        match &self.tracker {
            AnyTracker::Particles(tracker) => tracker.rival().map_or(shares, |(rival, log_weight)| {
                with_rival(&shares, (&rival.ends_m, sinew_core::math::exp(log_weight)), ends_m)
            }),
            AnyTracker::Modes(_) => shares,
        }
    }

    /// The core's tracker, whose state is saved.
    pub fn tracker_mut(&mut self) -> &mut AnyTracker<BONES, ANGLES> {
        &mut self.tracker
    }

    /// One frame.
    pub fn step(&mut self, seen: &SeenFrame<'_>) -> BodyEstimate<BONES, ANGLES> {
        let (tuning, goals) = (self.tuning, self.goals.clone());
        let (frame, root) = (seen.frame, tuning.root.process());
        let goal_std = self.angle_std(&tuning.end_effector.joint_std);
        match self.kind {
            BodyModelKind::EndEffector => self.advance(&with_goals(&tuning, goal_std, &goals, root), &frame),
            BodyModelKind::Guided => {
                let steps = (tuning.guided.solver_steps, tuning.refining_steps);
                let motion = self.guided(&goals, steps, tuning.pulling_blocks);
                self.advance(&motion, &frame)
            }
            BodyModelKind::Modes => {
                let motion = self.guided(&goals, (tuning.modes.solver_steps, 0), usize::MAX);
                self.climb(&motion, &frame)
            }
            BodyModelKind::Angular => {
                let angle_std_rad_per_sqrt_s = self.angle_std(&tuning.angular.joint_std);
                let persistence = tuning.angular.persistence;
                self.advance(
                    &AngularMotion { root, persistence, angle_std_rad_per_sqrt_s, own_velocity: false },
                    &frame,
                )
            }
            BodyModelKind::Stick => {
                let process = StickGoals {
                    hands: FOREARMS,
                    sight: seen.stick,
                    camera_m: self.scene.camera_m,
                    gamma_std_per_sqrt_s: tuning.stick_gamma_std,
                    reach_std_m: tuning.stick_reach_std_m,
                    others: &goals,
                };
                self.advance(&with_goals(&tuning, goal_std, &process, root), &frame)
            }
            BodyModelKind::PelvicLift => {
                let reach_std_m = tuning.lift_reach_std_m;
                let process = FixedGoals { end_effectors: end_effectors(BONES), reach_std_m };
                let root = RootProcess::pelvic_lift(tuning.lift_std_m, tuning.lift_turn_std_rad, seen.floor_y_m);
                self.advance(&with_goals(&tuning, goal_std, &process, root), &frame)
            }
            BodyModelKind::EndEffectorPaper => self.step_to_paper_goals(&frame),
            BodyModelKind::AngularPaper => self.step_by_paper_angles(&frame),
        }
    }

    /// The guided model with so many steps of the solver, then to the reported mode, and so many
    /// blocks that pull.
    fn guided<'a>(
        &self,
        goals: &'a LinearGoals,
        (solver_steps, refining_steps): (usize, usize),
        pulling_blocks: usize,
    ) -> GuidedMotion<'a, LinearGoals, ANGLES> {
        GuidedMotion {
            process: goals,
            root: self.tuning.root.guided_process(),
            angle_std_rad_per_sqrt_s: self.angle_std(&self.tuning.guided.joint_std),
            angle_persistence: self.tuning.guided.angle_persistence,
            solver_steps,
            pulling_blocks,
            refining_steps,
        }
    }

    /// A frame of the end-effector model with the PIK paper's structure.
    fn step_to_paper_goals(&mut self, frame: &BodyFrame<'_>) -> BodyEstimate<BONES, ANGLES> {
        let PaperTuning { lambda, reach_std_m, goal_std_m, own_velocity, .. } = self.tuning.paper;
        let PaperTuning { solver_steps, gradient_projection: by_gradient, .. } = self.tuning.paper;
        let bones = end_effectors(BONES);
        let own = PaperGoals { end_effectors: bones, std_m: goal_std_m, reach_std_m };
        let std_m_per_sqrt_s = goal_std_m / frame.dt_s.max(MIN_DT_S).sqrt();
        let full = LinearExtrapolation { persistence: 1.0, std_m_per_sqrt_s };
        let reached = LinearGoals::new(bones, BONES, full, reach_std_m);
        let angle_std = by_root_second(&[1.0 / lambda.sqrt(); ANGLES], frame.dt_s);
        let printed = PaperStructure { angle_std, solver_steps, by_gradient, root: self.tuning.root.process() };
        match reached {
            Ok(reached) if !own_velocity => self.advance(&printed.motion(&reached), frame),
            _ => self.advance(&printed.motion(&own), frame),
        }
    }

    /// A frame of the angular model with the PIK paper's structure.
    fn step_by_paper_angles(&mut self, frame: &BodyFrame<'_>) -> BodyEstimate<BONES, ANGLES> {
        let PaperTuning { own_velocity, .. } = self.tuning.paper;
        let per_angle = self.tuning.paper.angle_std_rad().per_angle();
        let per_frame = self.coordinates.map(|index| per_angle[index]);
        let angle_std_rad_per_sqrt_s = by_root_second(&per_frame, frame.dt_s);
        let root = self.tuning.root.process();
        let motion = AngularMotion { root, persistence: 1.0, angle_std_rad_per_sqrt_s, own_velocity };
        self.advance(&motion, frame)
    }

    /// The noise of each coordinate; the trunk's own where it is fitted to the points.
    fn angle_std(&self, joints: &ByJoint) -> [f32; ANGLES] {
        let trunk = if self.fit_trunk { self.tuning.root.trunk_std_rad } else { joints.trunk };
        let per_angle = ByJoint { trunk, ..*joints }.per_angle();
        self.coordinates.map(|index| per_angle[index])
    }

    /// The core's step, its particles shared out over the threads of the current pool.
    fn advance<M: BodyMotion<BONES, ANGLES> + Sync>(
        &mut self,
        motion: &M,
        frame: &BodyFrame<'_>,
    ) -> BodyEstimate<BONES, ANGLES> {
        let AnyTracker::Particles(tracker) = &mut self.tracker else {
            unreachable!("models but the modes have particles")
        };
        tracker.step_with(&self.scene, motion, frame, |advance, particles| {
            particles.par_iter_mut().enumerate().for_each(|(index, slot)| advance.particle(index, slot));
        })
    }

    /// The core's step by modes, its starts shared out over the threads of the current pool.
    fn climb(
        &mut self,
        motion: &GuidedMotion<'_, LinearGoals, ANGLES>,
        frame: &BodyFrame<'_>,
    ) -> BodyEstimate<BONES, ANGLES> {
        let AnyTracker::Modes(tracker) = &mut self.tracker else { unreachable!("modes have a tracker of their own") };
        let estimate = tracker.step_with(&self.scene, motion, frame, |advance, starts| {
            starts.par_iter_mut().for_each(|start| advance.climb(start));
        });
        self.modes = poses_and_weights(tracker);
        estimate
    }
}

/// What limbs in limbs cost, where they are kept apart.
fn kept_apart<const BONES: usize, const ANGLES: usize>(
    tuning: &BodyTuning,
    skeleton: &Skeleton<BONES, ANGLES>,
    radii_m: &[f32; BONES],
) -> Result<Option<SelfPenetration<BONES>>, ParameterError> {
    let std_m = tuning.self_penetration_std_m;
    (std_m > 0.0).then(|| SelfPenetration::new(skeleton, radii_m, std_m)).transpose()
}

/// The poses of the modes, and weights that sum to one.
fn poses_and_weights<const BONES: usize, const ANGLES: usize>(
    tracker: &ModeTracker<BONES, ANGLES>,
) -> (Vec<Particle<BONES, ANGLES>>, Vec<f32>) {
    let weights: Vec<f32> = tracker.modes().iter().map(|mode| sinew_core::math::exp(mode.log_weight)).collect();
    let sum: f32 = weights.iter().sum();
    (tracker.modes().iter().map(|mode| mode.pose).collect(), weights.iter().map(|weight| weight / sum).collect())
}

/// The end-effectors of a body of `bones` bones.
fn end_effectors(bones: usize) -> &'static [usize] {
    let count = END_EFFECTORS.iter().take_while(|&&bone| bone < bones).count();
    &END_EFFECTORS[..count]
}

/// Shortest time of a frame, seconds: that of the core's step.
const MIN_DT_S: f32 = 1.0e-4;

/// Noise of every frame as noise by root second.
fn by_root_second<const ANGLES: usize>(std_rad: &[f32; ANGLES], dt_s: f32) -> [f32; ANGLES] {
    std_rad.map(|std| std / dt_s.max(MIN_DT_S).sqrt())
}

/// What a model with goals has beside them with the PIK paper's structure.
struct PaperStructure<const ANGLES: usize> {
    angle_std: [f32; ANGLES],
    solver_steps: usize,
    by_gradient: bool,
    root: RootProcess,
}

impl<const ANGLES: usize> PaperStructure<ANGLES> {
    fn motion<'a, P>(&self, process: &'a P) -> EndEffectorMotion<'a, P, ANGLES> {
        EndEffectorMotion {
            process,
            root: self.root,
            angle_std_rad_per_sqrt_s: self.angle_std,
            angle_persistence: 0.0,
            solver_steps: self.solver_steps,
            by_gradient: self.by_gradient,
            corrects_weight: true,
            draw_share: 1.0,
        }
    }
}

/// A model with goals, by the numbers of the end-effector model.
fn with_goals<'a, P, const ANGLES: usize>(
    tuning: &BodyTuning,
    angle_std_rad_per_sqrt_s: [f32; ANGLES],
    process: &'a P,
    root: RootProcess,
) -> EndEffectorMotion<'a, P, ANGLES> {
    EndEffectorMotion {
        process,
        root,
        angle_std_rad_per_sqrt_s,
        angle_persistence: tuning.end_effector.angle_persistence,
        solver_steps: tuning.end_effector.solver_steps,
        by_gradient: false,
        corrects_weight: tuning.draw.corrects_weight,
        draw_share: tuning.draw.share,
    }
}
