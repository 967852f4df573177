//! A frame by modes: rivals and drawn limbs join, all climb, the most likely stay.

use super::super::estimate::BodyEstimate;
use super::super::frame::BodyFrame;
use super::super::observed::observed;
use super::super::step::frame_time_s;
use super::jumps::{MAX_RIVALS, rivals};
use super::options::{MAX_DRAWS, MAX_MODES};
use super::select::select;
use super::state::{BodyMode, ModeTracker};
use crate::kinematics::forward::Posture;
use crate::kinematics::inverse::Solve;
use crate::kinematics::jacobian::column;
use crate::kinematics::solver_memory::SolverMemory;
use crate::math::{Vec3, exp, sqrt};
use crate::observation::point_cloud::PointBlock;
use crate::pik::goal::GoalProcess;
use crate::pik::guided::{GuidedDensity, GuidedMotion, GuidedPrior};
use crate::pik::motion::{BodyMotion, BodyScene, FramePast};
use crate::random::Stream;
use crate::skeleton::Limbs;
use crate::skeleton::limbs::{MAX_GROUPS, TRUNK_GROUP};
use heapless::Vec;

/// Starts of a frame at most.
const MAX_STARTS: usize = MAX_MODES + MAX_RIVALS + MAX_DRAWS * MAX_GROUPS;

/// What is needed to climb from any start of a frame, in any order, on any thread.
///
/// ```
/// use sinew_core::pik::example::{arm_points, arm_scene, bending_elbow, guided_arm, hand_goals};
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::tracker::body::BodyFrame;
/// use sinew_core::tracker::body::modes::{DEFAULT_MODE_OPTIONS, ModeTracker};
///
/// let (scene, goals) = (arm_scene()?, hand_goals()?);
/// let motion = guided_arm(&goals);
/// let first = BodyParticle::at(&scene.skeleton, bending_elbow(0));
/// let new = || ModeTracker::<2, 4>::new(&first, DEFAULT_MODE_OPTIONS, 1);
/// // Starts in any order, or on any thread: the answer is the same to the bit.
/// let cloud = arm_points(&scene, &bending_elbow(1));
/// let frame = BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() };
/// let backwards = new()?.step_with(&scene, &motion, &frame, |advance, starts| {
///     starts.iter_mut().rev().for_each(|start| advance.climb(start));
/// });
/// assert_eq!(backwards, new()?.step(&scene, &motion, &frame));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug)]
pub struct ModeAdvance<'a, P, const BONES: usize, const ANGLES: usize> {
    pub(super) motion: &'a GuidedMotion<'a, P, ANGLES>,
    pub(super) scene: &'a BodyScene<BONES, ANGLES>,
    pub(super) limbs: &'a Limbs<BONES>,
    pub(super) blocks: &'a [PointBlock],
    pub(super) noise_share: [f32; BONES],
    pub(super) first_m: &'a [Vec3; BONES],
    pub(super) dt_s: f32,
    pub(super) evidence_share: f32,
    pub(super) seed: u64,
    pub(super) frame: u64,
}

/// What is expected of a start.
struct Expected<const ANGLES: usize> {
    prior: GuidedPrior<ANGLES>,
    /// The pose with a limb drawn, if one was.
    drawn_rad: Option<[f32; ANGLES]>,
    /// Whether a limb may be farther off than points reach.
    is_loose: bool,
}

impl<P: GoalProcess<BONES>, const BONES: usize, const ANGLES: usize> ModeAdvance<'_, P, BONES, ANGLES> {
    /// Takes a start to the mode near it, and adds the frame's evidence to its weight.
    pub fn climb(&self, start: &mut BodyMode<BONES, ANGLES>) {
        self.climb_within(start, &mut SolverMemory::new());
    }

    /// As [`Self::climb`], in memory of the caller.
    pub(super) fn climb_within(&self, start: &mut BodyMode<BONES, ANGLES>, memory: &mut SolverMemory<BONES, ANGLES>) {
        let Expected { prior, drawn_rad, is_loose } = self.expected(start);
        let prior = prior.density(&self.scene.skeleton);
        let density = GuidedDensity::of_some(prior, self.scene, self.blocks, self.motion.pulling_blocks);
        // A limb begins where it was drawn; else coarse steps look for what is farther off than
        // points reach.
        let mut starts: Vec<[f32; ANGLES], 2> = Vec::new();
        if let Some(drawn_rad) = drawn_rad {
            let _ = starts.push(drawn_rad);
        } else if is_loose {
            let _ = starts.push(prior.previous_rad);
            let _ = starts.push(density.far_start_rad(&prior, memory));
        }
        let solution = density.solve_within(&starts, self.motion.solver_steps, memory);
        self.arrive(start, &solution.angles_rad, memory);
        start.log_density = solution.log_density;
        start.log_weight += self.evidence_share * solution.log_density;
    }

    /// What is expected of a start. Not inlined: the past leaves the stack before the solver needs
    /// it.
    #[inline(never)]
    fn expected(&self, start: &mut BodyMode<BONES, ANGLES>) -> Expected<ANGLES> {
        let velocity = start.velocity.expected(0.0, self.dt_s);
        let root_change = self.motion.root().expected_change(&velocity.angles_per_s, self.dt_s);
        let past = FramePast {
            scene: self.scene,
            blocks: self.blocks,
            angle_velocity_per_s: velocity.angles_per_s,
            shared_change: core::array::from_fn(|i| {
                root_change.get(i).copied().filter(|_| i < self.scene.skeleton.root_coordinates())
            }),
            velocity_m_per_s: &velocity.ends_m_per_s,
            noise_share: &self.noise_share,
            first_m: self.first_m,
            dt_s: self.dt_s,
            is_first: self.frame == 1,
        };
        let (group, index) = start.drawn.take().unwrap_or((TRUNK_GROUP, 0));
        let mut stream = Stream::new(self.seed, self.frame, index);
        let mut memory = start.pose.memory;
        let prior = self.motion.prior(&past, &start.pose, &mut memory, &mut stream);
        start.pose.memory = memory;
        let is_drawn = group != TRUNK_GROUP;
        let drawn_rad = is_drawn.then(|| self.drawn_rad(&past, group, &prior.expected_rad, &mut stream));
        Expected { prior, drawn_rad, is_loose: self.motion.is_any_loose(&past) }
    }

    /// The expected pose with the angles of one limb drawn from the motion model's noise.
    fn drawn_rad(
        &self,
        past: &FramePast<'_, BONES, ANGLES>,
        group: usize,
        expected_rad: &[f32; ANGLES],
        stream: &mut Stream,
    ) -> [f32; ANGLES] {
        let std_rad = past.angle_std_rad(&self.motion.angle_std_rad_per_sqrt_s);
        let mut drawn_rad = *expected_rad;
        for (angle, (drawn, std_rad)) in drawn_rad.iter_mut().zip(std_rad).enumerate() {
            if self.limbs.group(self.scene.skeleton.bone_of_angle(angle)) == group {
                *drawn += std_rad * stream.normal();
            }
        }
        self.scene.skeleton.clamp(drawn_rad)
    }

    /// Brings `start` to the pose that the solver found.
    // Not inlined: its memory is not the solver's.
    #[inline(never)]
    fn arrive(
        &self,
        start: &mut BodyMode<BONES, ANGLES>,
        angles_rad: &[f32; ANGLES],
        memory: &mut SolverMemory<BONES, ANGLES>,
    ) {
        let (ancestor, posture) = (start.pose, self.scene.posture(angles_rad));
        (start.pose.angles_rad, start.pose.ends_m) = (*angles_rad, posture.ends);
        // A precision that cannot be inverted says nothing new: the spread stays.
        start.spread_m = self.spread_m(&posture, memory).unwrap_or(start.spread_m);
        start.velocity.follow(&ancestor, &start.pose, self.dt_s);
    }

    /// Standard deviations of the bones' ends, of the normal with the Hessian PIK (21) as
    /// precision: root of the trace of J H^-1 J'.
    fn spread_m(
        &self,
        posture: &Posture<BONES, ANGLES>,
        memory: &mut SolverMemory<BONES, ANGLES>,
    ) -> Option<[f32; BONES]> {
        let factor = memory.factor_hessian()?;
        let skeleton = &self.scene.skeleton;
        Some(core::array::from_fn(|bone| {
            let columns: [Vec3; ANGLES] = core::array::from_fn(|angle| column(skeleton, posture, bone, angle));
            let mut variance_m2 = 0.0;
            for row in [columns.map(|column| column.x), columns.map(|column| column.y), columns.map(|column| column.z)]
            {
                for (entry, solved) in row.iter().zip(factor.solve(&row)) {
                    variance_m2 += entry * solved;
                }
            }
            sqrt(crate::math::max(variance_m2, 0.0))
        }))
    }
}

impl<const BONES: usize, const ANGLES: usize> ModeTracker<BONES, ANGLES> {
    /// One frame, start by start.
    pub fn step<P: GoalProcess<BONES>>(
        &mut self,
        scene: &BodyScene<BONES, ANGLES>,
        motion: &GuidedMotion<'_, P, ANGLES>,
        frame: &BodyFrame<'_>,
    ) -> BodyEstimate<BONES, ANGLES> {
        self.step_with(scene, motion, frame, |advance, starts| {
            starts.iter_mut().for_each(|start| advance.climb(start));
        })
    }

    /// One frame whose starts `climb_all` takes to their modes: it has to call
    /// [`ModeAdvance::climb`] once for each of them, in any order.
    pub fn step_with<P: GoalProcess<BONES>>(
        &mut self,
        scene: &BodyScene<BONES, ANGLES>,
        motion: &GuidedMotion<'_, P, ANGLES>,
        frame: &BodyFrame<'_>,
        climb_all: impl FnOnce(&ModeAdvance<'_, P, BONES, ANGLES>, &mut [BodyMode<BONES, ANGLES>]),
    ) -> BodyEstimate<BONES, ANGLES> {
        self.frame += 1;
        let dt_s = frame_time_s(frame);
        let is_usable = frame.blocks.iter().all(PointBlock::is_usable);
        let blocks = if is_usable { frame.blocks } else { &[] };
        let limbs = Limbs::of(&scene.skeleton);
        let mut starts: Vec<BodyMode<BONES, ANGLES>, MAX_STARTS> = self.modes.iter().copied().collect();
        if !blocks.is_empty() {
            self.add_starts((scene, &limbs), &mut starts);
        }
        let advance = ModeAdvance {
            motion,
            scene,
            limbs: &limbs,
            blocks,
            noise_share: self.noise.per_bone(&limbs),
            first_m: &self.first_m,
            dt_s,
            evidence_share: self.options.evidence_share,
            seed: self.seed,
            frame: self.frame,
        };
        climb_all(&advance, &mut starts);
        select(&starts, &self.options, &mut self.modes);
        self.conclude((scene, &limbs), blocks, dt_s)
    }

    /// New rivals of the leading mode, and that mode with one limb begun anew.
    fn add_starts(
        &self,
        (scene, limbs): (&BodyScene<BONES, ANGLES>, &Limbs<BONES>),
        starts: &mut Vec<BodyMode<BONES, ANGLES>, MAX_STARTS>,
    ) {
        let Some(leader) = self.modes.first() else { return };
        // What has no room is left out.
        if self.options.max_modes > 1 {
            for rival in rivals((&scene.skeleton, limbs), leader, self.options.turn_rad) {
                let _ = starts.push(BodyMode { log_weight: -self.options.switch_cost, ..rival });
            }
        }
        for draw in 0..self.options.draws * limbs.count() {
            let group = draw % limbs.count();
            if group != TRUNK_GROUP {
                let _ = starts.push(BodyMode { drawn: Some((group, draw as u32)), ..*leader });
            }
        }
    }

    /// The estimate by the leading mode.
    fn conclude(
        &mut self,
        (scene, limbs): (&BodyScene<BONES, ANGLES>, &Limbs<BONES>),
        blocks: &[PointBlock],
        dt_s: f32,
    ) -> BodyEstimate<BONES, ANGLES> {
        let leader = self.modes[0];
        let observed = observed(&scene.surface(&scene.posture(&leader.pose.angles_rad)), limbs, blocks);
        if let Some(pace) = &self.options.pace {
            self.noise.follow((pace, limbs), &leader.velocity.last.ends_m_per_s, (&observed, &scene.radii_m), dt_s);
        }
        let reported = *self.deadband.filter((scene, limbs), &leader.pose, &[self.options.jitter_std_m; BONES], dt_s);
        let (mut sum, mut squares) = (0.0, 0.0);
        for mode in &self.modes {
            let weight = exp(mode.log_weight);
            sum += weight;
            squares += weight * weight;
        }
        BodyEstimate {
            angles_rad: reported.angles_rad,
            ends_m: reported.ends_m,
            spread_m: leader.spread_m,
            observed,
            effective_sample_size: sum * sum / squares,
            log_evidence: leader.log_density,
            tempering: self.options.evidence_share,
            is_degenerate: false,
        }
    }
}
