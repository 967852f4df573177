//! The likeliest way through the cycle: Viterbi's algorithm over even phases, which finds start,
//! pauses and what a filter took for another phase. Source: Forney, "The Viterbi algorithm",
//! Proceedings of the IEEE 61, 1973.

use super::seen::Seen;
use super::shape::Shape;
use crate::cyclic::turns::least_angle;

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
/// angles lie about it (radians), and the mean velocity, cycles per frame.
#[must_use]
pub fn likeliest<const N: usize>(seen: &Seen<N>, shape: &Shape<N>, std_rad: &[f64; N], velocity: f64) -> Vec<f64> {
    let count = seen.angles_rad.len();
    let stride = ((STEP_STATES / STATES as f64 / velocity).round() as usize).clamp(1, count.max(1));
    let poses: Vec<[f64; N]> = (0..STATES).map(|state| shape.at(state as f64 / STATES as f64).0).collect();
    let frames: Vec<usize> = (0..count).step_by(stride).collect();
    let steps = step_costs(velocity * stride as f64 * STATES as f64);
    let mut costs = vec![0.0; STATES];
    // How many states were passed to come to each state of each step.
    let mut passed: Vec<[u8; STATES]> = Vec::with_capacity(frames.len());
    for (index, frame) in frames.iter().enumerate() {
        let (came, before) = if index == 0 { ([0; STATES], costs) } else { best_steps(&costs, &steps) };
        let off = |state: usize| off(&seen.angles_rad[*frame], &poses[state], std_rad);
        costs = before.iter().enumerate().map(|(state, cost)| cost + off(state)).collect();
        passed.push(came);
    }
    let mut state = (0..STATES).min_by(|a, b| costs[*a].total_cmp(&costs[*b])).unwrap_or(0);
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

/// The cheapest step to each state, and its cost with what was before.
fn best_steps(costs: &[f64], steps: &[f64]) -> ([u8; STATES], Vec<f64>) {
    let mut came = [0_u8; STATES];
    let cost = |state: usize, way: usize| costs[(state + STATES - way) % STATES] + steps[way];
    let best = (0..STATES)
        .map(|state| {
            let way = (0..steps.len()).min_by(|a, b| cost(state, *a).total_cmp(&cost(state, *b))).unwrap_or(0);
            came[state] = way as u8;
            cost(state, way)
        })
        .collect();
    (came, best)
}

/// How badly a frame fits a pose.
fn off<const N: usize>(frame: &[Option<f64>; N], pose: &[f64; N], std_rad: &[f64; N]) -> f64 {
    let seen = (0..N).filter_map(|angle| Some(least_angle(frame[angle]? - pose[angle]) / std_rad[angle]));
    seen.map(|off| off.abs().min(MAX_OFF).powi(2) / 2.0).sum()
}

/// The line through the corners, which goes on at the mean velocity.
fn between(corners: &[f64], place: f64, step: f64) -> f64 {
    let index = (place.floor() as usize).min(corners.len() - 1);
    let share = place - index as f64;
    let next = corners.get(index + 1).copied().unwrap_or(corners[index] + step);
    corners[index] + share * (next - corners[index])
}
