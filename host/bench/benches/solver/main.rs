//! The solver alone against the crate `k` on an arm of four angles. Both have the same poses,
//! goals, limits and tolerance, and run in turns in one process on one thread.
//!
//! `k` moves along the pseudo-inverse of its Jacobian and cuts to the limits until the hand is
//! within the tolerance. It takes whole steps, which are fastest here, and half steps, its default.
//! Ours gets a precision with which it does not stop before.

mod k_peer;

use k_peer::{KPeer, Number};
use sinew_core::kinematics::forward::posture;
use sinew_core::kinematics::inverse::{Goal, PoseDensity, Solve};
use sinew_core::math::{Mat3, Vec3};
use sinew_core::random::Stream;
use sinew_core::skeleton::arm::FOREARM;
use sinew_core::skeleton::{ArmGeometry, Side, Skeleton};
use std::hint::black_box;
use std::time::Instant;

/// Goals, and rounds over all of them.
const GOALS: usize = 200;
const ROUNDS: usize = 101;
/// How near the hand has to come, metres.
const TOLERANCE_M: f32 = 1.0e-3;
/// A step ends the search when it promises less log density than this (`kinematics::inverse`). Half
/// of it is what a miss of the tolerance may cost.
const MIN_LOG_GAIN: f32 = 0.01;
const MAX_STEPS: usize = 100;
/// Largest difference of an angle between the start and the pose that the goal is of, radians.
const CHANGE_RAD: f32 = 0.3;

/// Where the search begins and where the hand has to go.
struct Task {
    start_rad: [f32; 4],
    goal_m: Vec3,
}

fn tasks(arm: &Skeleton<2, 4>) -> Vec<Task> {
    let task = |index: usize| {
        let mut stream = Stream::new(1, 0, index as u32);
        let limits = arm.limits();
        let goal_rad: [f32; 4] = std::array::from_fn(|i| {
            limits[i].low_rad + (limits[i].high_rad - limits[i].low_rad) * (0.1 + 0.8 * stream.uniform())
        });
        let start_rad = goal_rad.map(|angle| angle + CHANGE_RAD * (2.0 * stream.uniform() - 1.0));
        Task { start_rad: arm.clamp(start_rad), goal_m: posture(arm, &Vec3::zeros(), &goal_rad).ends[FOREARM] }
    };
    (0..GOALS).map(task).collect()
}

/// Microseconds of the mean search of a round, and how many reached their goal.
type Round = (f64, usize);

fn sinew_round(arm: &Skeleton<2, 4>, tasks: &[Task]) -> Round {
    let precision = Mat3::identity() * (2.0 * MIN_LOG_GAIN / (TOLERANCE_M * TOLERANCE_M));
    let (mut seconds, mut reached) = (0.0, 0);
    for task in tasks {
        let goals = [Goal { bone: FOREARM, position_m: task.goal_m, precision }];
        let (root_m, previous_rad) = (Vec3::zeros(), task.start_rad);
        let density = PoseDensity { skeleton: arm, root_m, goals: &goals, previous_rad, stiffness: [0.1; 4], held: 0 };
        let start = Instant::now();
        let mode = black_box(black_box(&density).mode(MAX_STEPS));
        seconds += start.elapsed().as_secs_f64();
        reached += usize::from(mode.residual_m < TOLERANCE_M);
    }
    (1.0e6 * seconds / GOALS as f64, reached)
}

fn k_round<T: Number>(peer: &KPeer<T>, tasks: &[Task]) -> Round {
    let (mut seconds, mut reached) = (0.0, 0);
    for task in tasks {
        peer.pose(&task.start_rad);
        let goal = KPeer::<T>::goal(&task.goal_m.into());
        let start = Instant::now();
        let is_there = black_box(peer.solve(black_box(&goal)));
        seconds += start.elapsed().as_secs_f64();
        reached += usize::from(is_there);
    }
    (1.0e6 * seconds / GOALS as f64, reached)
}

/// Both arms are the same: their hands are in the same places.
fn check(arm: &Skeleton<2, 4>, peer: &KPeer<f64>, tasks: &[Task]) {
    for task in tasks {
        peer.pose(&task.start_rad);
        let own = posture(arm, &Vec3::zeros(), &task.start_rad).ends[FOREARM];
        for (a, b) in peer.end_m().into_iter().zip(own.iter()) {
            assert!((a - f64::from(*b)).abs() < 1.0e-5, "{a} {b}");
        }
    }
}

fn main() {
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let arm = ArmGeometry::new(Side::Left, 0.3, 0.35).and_then(|arm| arm.skeleton()).expect("sound lengths");
    let tasks = tasks(&arm);
    let k64 = |share| KPeer::<f64>::new(&arm, TOLERANCE_M.into(), share, MAX_STEPS);
    let (whole, half) = (k64(1.0), k64(0.5));
    let single = KPeer::<f32>::new(&arm, TOLERANCE_M.into(), 1.0, MAX_STEPS);
    check(&arm, &whole, &tasks);
    let mut rounds: [Vec<Round>; 4] = Default::default();
    for _ in 0..ROUNDS {
        rounds[0].push(sinew_round(&arm, &tasks));
        rounds[1].push(k_round(&single, &tasks));
        rounds[2].push(k_round(&whole, &tasks));
        rounds[3].push(k_round(&half, &tasks));
    }
    println!("{:<24}{:>12}{:>12}{:>10}{:>10}", "a search", "us median", "us least", "ratio", "reached");
    let mut unit = f64::NAN;
    for (name, mut rounds) in ["sinew", "k, f32", "k, f64", "k, f64, half steps"].into_iter().zip(rounds) {
        rounds.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (least, (median, reached)) = (rounds[0].0, rounds[ROUNDS / 2]);
        unit = if unit.is_nan() { median } else { unit };
        println!("{name:<24}{median:>12.2}{least:>12.2}{:>10.1}{reached:>10}", median / unit);
    }
}
