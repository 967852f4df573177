//! The likeliest way through the cycle: Viterbi's algorithm over even phases, which finds start,
//! pauses and what a filter took for another phase. Source: Forney, "The Viterbi algorithm",
//! Proceedings of the IEEE 61, 1973.

use super::seen::Seen;
use super::shape::Shape;
use crate::cyclic::turns::least_angle;
use std::f64::consts::TAU;

/// Even phases of a cycle: one is half of what a walker passes in a frame at 60 frames a second.
const STATES: usize = 100;
/// States that are passed in a step at the mean velocity: so many frames are taken together.
const STEP_STATES: f64 = 3.0;
/// Standard deviation of a step over the mean step. Chosen: a pause of a second costs as much as
/// ten frames in another phase.
const STEP_SPREAD: f64 = 0.5;
/// Steps are at most this many mean steps long.
const LONGEST_STEP: f64 = 3.0;
/// The way is smoothed over so much to both sides, cycles. Its corners lie on even phases, and a
/// tempo does not change from one to the next. Chosen: half of what a phase is fitted over later.
const SMOOTH_CYCLES: f64 = 0.15;
/// How far an angle may be off, standard deviations: more says no more.
const MAX_OFF: f64 = 3.0;

/// Phases, in cycles, of every frame, given the shape of the cycle. Also given are how far the
/// angles lie about it (radians), and the mean velocity, cycles per frame. With AVX2 wherever it
/// is: the bits are the same.
#[must_use]
#[multiversion::multiversion(targets("x86_64+avx2"))]
pub fn likeliest<const N: usize>(seen: &Seen<N>, shape: &Shape<N>, std_rad: &[f64; N], velocity: f64) -> Vec<f64> {
    let count = seen.angles_rad.len();
    let stride = ((STEP_STATES / STATES as f64 / velocity).round() as usize).clamp(1, count.max(1));
    let costs = PoseCosts::new(shape, std_rad);
    let frames: Vec<usize> = (0..count).step_by(stride).collect();
    let steps = step_costs(velocity * stride as f64 * STATES as f64);
    let mut total = [0.0; STATES];
    // How many states were passed to come to each state of each step.
    let mut passed: Vec<[u8; STATES]> = Vec::with_capacity(frames.len());
    for (index, frame) in frames.iter().enumerate() {
        let came = if index == 0 { [0; STATES] } else { take_best_steps(&mut total, &steps) };
        costs.add(&seen.angles_rad[*frame], &mut total);
        passed.push(came);
    }
    let mut state = (0..STATES).min_by(|a, b| total[*a].total_cmp(&total[*b])).unwrap_or(0);
    let mut ways: Vec<usize> = Vec::with_capacity(passed.len());
    for came in passed.iter().rev() {
        ways.push(usize::from(came[state]));
        state = (state + STATES - usize::from(came[state]) % STATES) % STATES;
    }
    ways.reverse();
    let mut place = state as f64 / STATES as f64;
    let corners: Vec<f64> = ways
        .iter()
        .map(|way| {
            place += *way as f64 / STATES as f64;
            place
        })
        .collect();
    let way = (0..count).map(|frame| between(&corners, frame as f64 / stride as f64, velocity * stride as f64));
    smoothed(&way.collect::<Vec<f64>>(), (SMOOTH_CYCLES / velocity).round() as usize)
}

/// Means of the phases around each, as many on both sides, so that even progress stays as it is.
fn smoothed(phases: &[f64], half_width: usize) -> Vec<f64> {
    let mean = |frame: usize| {
        let half = half_width.min(frame).min(phases.len() - 1 - frame);
        let around = &phases[frame - half..=frame + half];
        around.iter().sum::<f64>() / around.len() as f64
    };
    (0..phases.len()).map(mean).collect()
}

/// Cost of passing each number of states in a step.
fn step_costs(mean: f64) -> Vec<f64> {
    let longest = ((LONGEST_STEP * mean).ceil() as usize).clamp(1, STATES / 2);
    (0..=longest).map(|way| ((way as f64 - mean) / (STEP_SPREAD * mean)).powi(2) / 2.0).collect()
}

/// Adds the cheapest step that ends in each state to what was before it; the states that it passes.
#[inline(always)]
fn take_best_steps(total: &mut [f64; STATES], steps: &[f64]) -> [u8; STATES] {
    // Twice, so that no step crosses the seam of the cycle.
    let mut before = [0.0; 2 * STATES];
    before[..STATES].copy_from_slice(total);
    before[STATES..].copy_from_slice(total);
    // As wide as the costs, so that both are chosen in vectors.
    let mut came = [0.0; STATES];
    *total = [f64::INFINITY; STATES];
    for (way, step) in steps.iter().enumerate() {
        let from = &before[STATES - way..2 * STATES - way];
        for state in 0..STATES {
            let cost = from[state] + step;
            let is_less = cost < total[state];
            total[state] = if is_less { cost } else { total[state] };
            came[state] = if is_less { way as f64 } else { came[state] };
        }
    }
    came.map(|way| way as u8)
}

/// How badly a frame fits each state's pose.
struct PoseCosts<const N: usize> {
    /// Poses, angle by angle, radians within a turn.
    angles_rad: [[f64; STATES]; N],
    /// One over each angle's standard deviation.
    inverse_std: [f64; N],
}

impl<const N: usize> PoseCosts<N> {
    fn new(shape: &Shape<N>, std_rad: &[f64; N]) -> Self {
        let mut angles_rad = [[0.0; STATES]; N];
        for state in 0..STATES {
            let (pose, _) = shape.at(state as f64 / STATES as f64);
            (0..N).for_each(|angle| angles_rad[angle][state] = least_angle(pose[angle]));
        }
        Self { angles_rad, inverse_std: std_rad.map(|std_rad| 1.0 / std_rad) }
    }

    /// Adds the cost of what was seen in a frame; what was not seen costs nothing.
    #[inline(always)]
    fn add(&self, frame: &[Option<f64>; N], total: &mut [f64; STATES]) {
        for angle in 0..N {
            let Some(seen_rad) = frame[angle].map(least_angle) else { continue };
            for (cost, pose_rad) in total.iter_mut().zip(&self.angles_rad[angle]) {
                let one_way = (seen_rad - pose_rad).abs();
                let off = (one_way.min(TAU - one_way) * self.inverse_std[angle]).min(MAX_OFF);
                *cost += 0.5 * off * off;
            }
        }
    }
}

/// The line through the corners, which goes on at the mean velocity.
fn between(corners: &[f64], place: f64, step: f64) -> f64 {
    let index = (place.floor() as usize).min(corners.len() - 1);
    let share = place - index as f64;
    let next = corners.get(index + 1).copied().unwrap_or(corners[index] + step);
    corners[index] + share * (next - corners[index])
}
