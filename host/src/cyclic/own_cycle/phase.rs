//! The phase of each frame: where the shape fits the frames around it best.

use super::noise::MIN_NOISE_RAD;
use super::path;
use super::seen::Seen;
use super::shape::Shape;
use crate::cyclic::turns::least_angle;
use crate::signal::median::STD_PER_MEDIAN;

/// Rounds of shape and phase. Chosen: the cadence of three seconds changes by less than 0.1 % after
/// six.
const ROUNDS: usize = 8;
/// How far the frames reach that a phase is fitted to, cycles: their weight falls by e in it.
/// Chosen: with one cycle, slow changes of the tempo are lost; with a tenth, noise comes through.
const REACH_CYCLES: f64 = 0.3;
/// Largest step of a phase in a round, cycles: what is linear about a walker's knee.
const MAX_STEP_CYCLES: f64 = 0.05;

/// Phases, in cycles, and the cycle that they were fitted to.
#[derive(Debug, Clone, PartialEq)]
pub struct Phased<const N: usize> {
    /// Phase of each frame; its whole part counts cycles.
    pub phases: Vec<f64>,
    /// Angles and slopes of that cycle in each frame.
    pub expected: Expected<N>,
    /// Standard deviation of what was seen from the shape, radians.
    pub std_rad: [f64; N],
}

/// Fits the person's cycle and the phases to each other, from the phases of a filter on. Frames in
/// which the person `stands` are left out, and have a phase on the straight line between those
/// beside them.
#[must_use]
pub fn fitted<const N: usize>(seen: &Seen<N>, phases: Vec<f64>, prior: &Shape<N>, stands: &[bool]) -> Phased<N> {
    if !stands.contains(&true) {
        let (phases, expected, std_rad, _) = fitted_all(seen, phases, prior);
        return Phased { phases, expected, std_rad };
    }
    let moving: Vec<usize> = (0..stands.len()).filter(|frame| !stands[*frame]).collect();
    let angles_rad = moving.iter().map(|frame| seen.angles_rad[*frame]).collect();
    let mut moving_phases = vec![phases[moving[0]]];
    for (index, pair) in moving.windows(2).enumerate() {
        let way = phases[pair[1]] - phases[pair[0]];
        // Whole cycles over a stop are none.
        let way = if pair[1] > pair[0] + 1 { way - way.round() } else { way };
        moving_phases.push(moving_phases[index] + way);
    }
    let seen = Seen { first_frame: seen.first_frame, angles_rad };
    let (moving_phases, _, std_rad, shape) = fitted_all(&seen, moving_phases, prior);
    let phases = spread_over_stops(&moving, &moving_phases, stands.len());
    Phased { expected: along(&shape, &phases), phases, std_rad }
}

/// Phases of all frames of those of `moving` frames.
fn spread_over_stops(moving: &[usize], phases: &[f64], count: usize) -> Vec<f64> {
    let mut all = vec![phases[0]; moving[0]];
    for (pair, ends) in moving.windows(2).zip(phases.windows(2)) {
        let frames = pair[1] - pair[0];
        all.extend((0..frames).map(|k| ends[0] + (ends[1] - ends[0]) * k as f64 / frames as f64));
    }
    all.resize(count, phases[phases.len() - 1]);
    all
}

/// Phases, the person's cycle in each frame, its distance from what was seen, and that cycle.
fn fitted_all<const N: usize>(
    seen: &Seen<N>,
    mut phases: Vec<f64>,
    prior: &Shape<N>,
) -> (Vec<f64>, Expected<N>, [f64; N], Shape<N>) {
    let mut shape = prior.fitted(seen, &phases);
    let mut std_rad = spread(seen, &along(&shape, &phases));
    phases = path::likeliest(seen, &shape, &std_rad, median_step(&phases));
    let mut expected = along(&shape, &phases);
    for _ in 0..ROUNDS {
        let steps = steps(seen, &phases, &expected, &std_rad);
        // The shape moves with the phases: their mean stays that of the filter.
        let mean = steps.iter().sum::<f64>() / steps.len() as f64;
        for (phase, step) in phases.iter_mut().zip(&steps) {
            *phase += step - mean;
        }
        shape = prior.fitted(seen, &phases);
        expected = along(&shape, &phases);
        std_rad = spread(seen, &expected);
    }
    (phases, expected, std_rad, shape)
}

/// Cycles from frame to frame at a frame.
#[must_use]
pub fn velocity(phases: &[f64], frame: usize) -> f64 {
    let (before, after) = (frame.saturating_sub(1), (frame + 1).min(phases.len() - 1));
    (phases[after] - phases[before]) / (after - before).max(1) as f64
}

/// How far phases are from even progress, standard deviations. What goes unevenly in each cycle is
/// the shape, so the rest is the phases' error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unevenness {
    /// Of the phase, cycles.
    pub position_std: f64,
    /// Of what is passed from frame to frame, cycles.
    pub velocity_std_per_frame: f64,
}

/// The unevenness of a recording's phases in each frame, against the mean progress in the cycle
/// around it. The first and the last half cycle have one of their own, against the nearest whole
/// cycle: they are fitted from one side. Frames in which the person `stands` are left out, and have
/// that of the frame before them. `None` for less than a cycle.
#[must_use]
pub fn unevenness(phases: &[f64], stands: &[bool]) -> Option<Vec<Unevenness>> {
    let pairs = || phases.iter().zip(stands);
    let moving: Vec<f64> = pairs().filter(|(_, stands)| !**stands).map(|(phase, _)| *phase).collect();
    let of_moving = unevenness_of_moving(&moving)?;
    let mut passed: usize = 0;
    let of_all = pairs().map(|(_, stands)| {
        passed += usize::from(!*stands);
        of_moving[passed.saturating_sub(1)]
    });
    Some(of_all.collect())
}

fn unevenness_of_moving(phases: &[f64]) -> Option<Vec<Unevenness>> {
    let half = (0.5 / median_step(phases)).round().max(1.0) as usize;
    let last = phases.len().checked_sub(half + 1).filter(|last| *last >= half)?;
    let is_end = |frame: usize| frame < half || frame > last;
    let off = |frame: usize| {
        let middle = frame.clamp(half, last);
        let around = &phases[middle - half..=middle + half];
        let mean = around.iter().sum::<f64>() / around.len() as f64;
        let mean_velocity = (around[2 * half] - around[0]) / (2 * half) as f64;
        let even = mean + mean_velocity * (frame as f64 - middle as f64);
        [phases[frame] - even, velocity(phases, frame) - mean_velocity]
    };
    let of = |is_of_ends: bool| {
        let frames = (0..phases.len()).filter(|frame| is_end(*frame) == is_of_ends);
        let (mut count, mut squares) = (0.0, [0.0; 2]);
        for off in frames.map(off) {
            squares.iter_mut().zip(off).for_each(|(sum, off)| *sum += off * off);
            count += 1.0;
        }
        let [position_std, velocity_std_per_frame] = squares.map(|sum: f64| (sum / count).sqrt());
        Unevenness { position_std, velocity_std_per_frame }
    };
    let [inside, ends] = [false, true].map(of);
    Some((0..phases.len()).map(|frame| if is_end(frame) { ends } else { inside }).collect())
}

/// Median of the cycles passed from frame to frame.
fn median_step(phases: &[f64]) -> f64 {
    /// Least velocity, cycles per frame: an hour a cycle.
    const MIN_VELOCITY: f64 = 1.0e-5;
    let mut steps: Vec<f64> = phases.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).map_or(MIN_VELOCITY, |step| step.max(MIN_VELOCITY))
}

/// Angles of each frame by the person's own cycle, and their slopes: [`Shape::at`].
pub type Expected<const N: usize> = Vec<([f64; N], [f64; N])>;

fn along<const N: usize>(shape: &Shape<N>, phases: &[f64]) -> Expected<N> {
    phases.iter().map(|phase| shape.at(*phase)).collect()
}

/// Standard deviation of each angle from the shape, by the median of its size. A few wrong
/// measurements do not move the median. It is at least the least noise of a measurement.
fn spread<const N: usize>(seen: &Seen<N>, expected: &Expected<N>) -> [f64; N] {
    std::array::from_fn(|angle| {
        let frames = seen.angles_rad.iter().zip(expected);
        let mut sizes: Vec<f64> =
            frames.filter_map(|(frame, (pose, _))| Some(least_angle(frame[angle]? - pose[angle]).abs())).collect();
        if sizes.is_empty() {
            return f64::INFINITY;
        }
        let middle = sizes.len() / 2;
        let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
        (STD_PER_MEDIAN * *median).max(MIN_NOISE_RAD)
    })
}

/// One Gauss-Newton step of each phase, over the frames around it.
fn steps<const N: usize>(seen: &Seen<N>, phases: &[f64], expected: &Expected<N>, std_rad: &[f64; N]) -> Vec<f64> {
    let weights = std_rad.map(|std_rad| std_rad.powi(-2));
    let normal = |frame: &[Option<f64>; N], (pose, slope): &([f64; N], [f64; N])| {
        let mut sums = [0.0; 2];
        for angle in 0..N {
            let Some(angle_rad) = frame[angle] else { continue };
            let off = least_angle(angle_rad - pose[angle]);
            // What is far off says no more than what is three deviations off (Huber's weight).
            let trust = (3.0 * std_rad[angle] / off.abs().max(1.0e-9)).min(1.0);
            sums[0] += trust * weights[angle] * slope[angle] * off;
            sums[1] += trust * weights[angle] * slope[angle] * slope[angle];
        }
        sums
    };
    let mut sums: Vec<[f64; 2]> =
        seen.angles_rad.iter().zip(expected).map(|(frame, expected)| normal(frame, expected)).collect();
    spread_over(&mut sums, phases);
    let step = |[right, gram]: [f64; 2]| if gram > 0.0 { right / gram } else { 0.0 };
    sums.into_iter().map(|sums| step(sums).clamp(-MAX_STEP_CYCLES, MAX_STEP_CYCLES)).collect()
}

/// Sums over all frames, with weights that fall by e in [`REACH_CYCLES`]: once forwards, once
/// backwards.
fn spread_over(sums: &mut [[f64; 2]], phases: &[f64]) {
    let alone = sums.to_vec();
    let fade = |from: usize, to: usize| (-(phases[to] - phases[from]).abs() / REACH_CYCLES).exp();
    let mut before = [0.0; 2];
    let mut forwards = vec![[0.0; 2]; sums.len()];
    for frame in 0..sums.len() {
        let keep = if frame > 0 { fade(frame - 1, frame) } else { 0.0 };
        before = std::array::from_fn(|i| keep * before[i] + alone[frame][i]);
        forwards[frame] = before;
    }
    let mut after = [0.0; 2];
    for frame in (0..sums.len()).rev() {
        let keep = if frame + 1 < sums.len() { fade(frame, frame + 1) } else { 0.0 };
        after = std::array::from_fn(|i| keep * after[i] + alone[frame][i]);
        sums[frame] = std::array::from_fn(|i| forwards[frame][i] + after[i] - alone[frame][i]);
    }
}
