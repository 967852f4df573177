//! The body tracker's step: resample, move on, weigh, estimate (PIK paper, sections 5.1 and 6).

use super::alignment::RootAlignment;
use super::estimate::{BodyEstimate, mean_pose, spread_m};
use super::observed::observed;
use super::tempering::temper;
use crate::error::{ParameterError, Rule};
use crate::math::{Vec3, clamp};
use crate::observation::point_cloud::PointBlock;
use crate::particle::Weights;
use crate::particle::resampling::systematic;
use crate::pik::motion::{BodyMotion, BodyParticle, BodyScene, FramePast};
use crate::random::Stream;

/// Stream of the resampling; particles have their own index.
const RESAMPLING_STREAM: u32 = u32::MAX;
/// Velocities are not followed for longer than this across a gap, seconds; the noise grows all the same.
const LONGEST_STRIDE_S: f32 = 0.2;

/// Options of the filter itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyOptions {
    /// Weights are flattened until at least this share of the particles is effective; zero never flattens.
    pub least_effective_share: f32,
    /// How the root is laid onto the points before particles are drawn; `None` leaves it to its process.
    pub alignment: Option<RootAlignment>,
}

/// What is used unless told otherwise.
pub const DEFAULT_BODY_OPTIONS: BodyOptions = BodyOptions { least_effective_share: 0.0, alignment: None };

/// One frame.
#[derive(Debug, Clone, Copy)]
pub struct BodyFrame<'a> {
    /// Time since the frame before, seconds; frames that were dropped are simply not given.
    pub dt_s: f32,
    /// The points; none is a frame without evidence.
    pub blocks: &'a [PointBlock],
}

/// What is needed to move and weigh any particle of a frame, in any order, on any thread.
#[derive(Debug)]
pub struct Advance<'a, M, const BONES: usize, const ANGLES: usize> {
    motion: &'a M,
    past: FramePast<'a, BONES, ANGLES>,
    ancestors: &'a [u16],
    particles: &'a [BodyParticle<BONES, ANGLES>],
    seed: u64,
    frame: u64,
}

impl<M: BodyMotion<BONES, ANGLES>, const BONES: usize, const ANGLES: usize> Advance<'_, M, BONES, ANGLES> {
    /// Makes particle `index` of the new set and returns its log-weight.
    pub fn particle(&self, index: usize, slot: &mut BodyParticle<BONES, ANGLES>) -> f32 {
        let ancestor = self.ancestors.get(index).and_then(|&ancestor| self.particles.get(usize::from(ancestor)));
        let Some(ancestor) = ancestor else { return f32::NEG_INFINITY };
        let mut stream = Stream::new(self.seed, self.frame, index as u32);
        let mut memory = ancestor.memory;
        let proposed = self.motion.propose(&self.past, ancestor, &mut memory, &mut stream);
        *slot = BodyParticle { angles_rad: proposed.angles_rad, ends_m: proposed.posture.ends, memory };
        let scene = self.past.scene;
        proposed.log_ratio + scene.log_weight(&scene.surface(&proposed.posture), self.past.blocks)
    }
}

/// State of the tracker: up to `N` particles, kept in two sets `S` (arrays in firmware, vectors on a host).
#[derive(Debug, Clone)]
pub struct BodyTracker<const BONES: usize, const ANGLES: usize, const N: usize, S> {
    particles: S,
    next: S,
    weights: Weights<N>,
    ancestors: heapless::Vec<u16, N>,
    options: BodyOptions,
    first_m: [Vec3; BONES],
    before: BodyParticle<BONES, ANGLES>,
    angle_velocity_per_s: [f32; ANGLES],
    velocity_m_per_s: [Vec3; BONES],
    seed: u64,
    frame: u64,
}

impl<const BONES: usize, const ANGLES: usize, const N: usize, S> BodyTracker<BONES, ANGLES, N, S>
where
    S: AsRef<[BodyParticle<BONES, ANGLES>]> + AsMut<[BodyParticle<BONES, ANGLES>]>,
{
    /// A tracker whose particles, as many as `particles` and `next` have room for, all are at `first`.
    ///
    /// # Errors
    /// Both sets have to be of the same size, from 1 to `N`; options finite, the share in [0, 1].
    pub fn new(
        first: &BodyParticle<BONES, ANGLES>,
        (mut particles, next): (S, S),
        options: BodyOptions,
        seed: u64,
    ) -> Result<Self, ParameterError> {
        let count = particles.as_ref().len();
        if next.as_ref().len() != count {
            return Err(ParameterError::new("next", Rule::SameLength { expected: count }));
        }
        if !(options.least_effective_share >= 0.0 && options.least_effective_share <= 1.0) {
            return Err(ParameterError::new("least_effective_share", Rule::Within { low: 0.0, high: 1.0 }));
        }
        particles.as_mut().fill(*first);
        let mut ancestors = heapless::Vec::new();
        let weights = Weights::uniform(count)?;
        // As many as there are weights, which fit.
        let _ = ancestors.resize(count, 0);
        Ok(Self {
            particles,
            next,
            weights,
            ancestors,
            options,
            first_m: first.ends_m,
            before: *first,
            angle_velocity_per_s: [0.0; ANGLES],
            velocity_m_per_s: [Vec3::zeros(); BONES],
            seed,
            frame: 0,
        })
    }

    /// The particles after the last step.
    #[must_use]
    pub fn particles(&self) -> &[BodyParticle<BONES, ANGLES>] {
        self.particles.as_ref()
    }

    /// Their weights, which sum to one.
    #[must_use]
    pub fn weights(&self) -> &[f32] {
        self.weights.normalised()
    }

    /// One frame, particle by particle.
    pub fn step<M: BodyMotion<BONES, ANGLES>>(
        &mut self,
        scene: &BodyScene<BONES, ANGLES>,
        motion: &M,
        frame: &BodyFrame<'_>,
    ) -> BodyEstimate<BONES, ANGLES> {
        self.step_with(scene, motion, frame, |advance, particles, store| {
            for (index, slot) in particles.iter_mut().enumerate() {
                store(index, advance.particle(index, slot));
            }
        })
    }

    /// One frame whose particles `advance_all` moves: it has to call [`Advance::particle`] once for each slot, in any order, and
    /// to store each log-weight.
    pub fn step_with<M: BodyMotion<BONES, ANGLES>>(
        &mut self,
        scene: &BodyScene<BONES, ANGLES>,
        motion: &M,
        frame: &BodyFrame<'_>,
        advance_all: impl FnOnce(
            &Advance<'_, M, BONES, ANGLES>,
            &mut [BodyParticle<BONES, ANGLES>],
            &mut dyn FnMut(usize, f32),
        ),
    ) -> BodyEstimate<BONES, ANGLES> {
        let is_first = self.frame == 0;
        self.frame += 1;
        let offset = Stream::new(self.seed, self.frame, RESAMPLING_STREAM).uniform();
        systematic(self.weights.normalised(), offset, &mut self.ancestors);
        // No time, or time that runs back, is the shortest time that still lets particles differ.
        let dt_s = clamp(frame.dt_s, 1.0e-4, 10.0);
        let fades = crate::math::min(1.0, LONGEST_STRIDE_S / dt_s);
        let angle_velocity_per_s = self.angle_velocity_per_s.map(|velocity| velocity * fades);
        let mut root_change = motion.root().expected_change(&angle_velocity_per_s, dt_s);
        if let Some(alignment) = self.options.alignment {
            root_change = alignment.root_change(scene, frame.blocks, &self.before.angles_rad, &root_change, dt_s);
        }
        let advance = Advance {
            motion,
            past: FramePast {
                scene,
                blocks: frame.blocks,
                angle_velocity_per_s,
                root_change,
                velocity_m_per_s: &self.velocity_m_per_s.map(|velocity| velocity * fades),
                first_m: &self.first_m,
                dt_s,
                is_first,
            },
            ancestors: &self.ancestors,
            particles: self.particles.as_ref(),
            seed: self.seed,
            frame: self.frame,
        };
        let weights = &mut self.weights;
        advance_all(&advance, self.next.as_mut(), &mut |index, log_weight| weights.set_log(index, log_weight));
        core::mem::swap(&mut self.particles, &mut self.next);
        self.conclude(scene, frame, dt_s)
    }

    /// Weights, mean pose, spread and velocities of the new set.
    fn conclude(
        &mut self,
        scene: &BodyScene<BONES, ANGLES>,
        frame: &BodyFrame<'_>,
        dt_s: f32,
    ) -> BodyEstimate<BONES, ANGLES> {
        let mut tempering = 1.0;
        if self.options.least_effective_share > 0.0 {
            tempering = temper(&self.weights, self.options.least_effective_share * self.weights.len() as f32);
            for index in 0..self.weights.len() {
                let log_weight = self.weights.log().get(index).copied().unwrap_or(f32::NEG_INFINITY);
                self.weights.set_log(index, tempering * log_weight);
            }
        }
        let evidence = self.weights.normalise();
        let (particles, weights) = (self.particles.as_ref(), self.weights.normalised());
        let angles_rad = mean_pose(scene, particles, weights);
        let posture = scene.posture(&angles_rad);
        let mean = BodyParticle { angles_rad, ends_m: posture.ends, ..self.before };
        let spread_m = spread_m(particles, weights);
        for i in 0..ANGLES {
            self.angle_velocity_per_s[i] = (mean.angles_rad[i] - self.before.angles_rad[i]) / dt_s;
        }
        for bone in 0..BONES {
            self.velocity_m_per_s[bone] = (mean.ends_m[bone] - self.before.ends_m[bone]) / dt_s;
        }
        self.before = mean;
        BodyEstimate {
            angles_rad: mean.angles_rad,
            ends_m: mean.ends_m,
            spread_m,
            observed: observed(&scene.surface(&posture), frame.blocks),
            effective_sample_size: self.weights.effective_sample_size(),
            log_evidence: evidence.unwrap_or(0.0),
            tempering,
            is_degenerate: evidence.is_err(),
        }
    }
}
