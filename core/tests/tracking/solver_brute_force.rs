//! Both solvers against brute force on chains of two and three hinges: what a grid over the limits
//! finds, refined.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use sinew_core::kinematics::forward::posture;
use sinew_core::kinematics::gradient_projection::mode_by_gradient;
use sinew_core::kinematics::inverse::{Goal, Mode, PoseDensity, PoseObjective, Solve};
use sinew_core::math::{Mat3, Vec3};
use sinew_core::skeleton::{Bone, Joint, Limit, Skeleton};
use std::cell::RefCell;

/// A solver that stops on its own is this near to the largest log density around its pose, beside a
/// share of that density. Its steps end where the next one promises 0.05. Beyond reach Gauss-Newton
/// steps promise too little.
const TOLERANCE: f32 = 0.1;
const RELATIVE_TOLERANCE: f32 = 2.0e-3;
/// Maximum number of steps of Gauss and Newton, and along the gradient.
const STEPS: usize = 40;
const GRADIENT_STEPS: usize = 400;
/// Runs for each pair of bounds.
const CASES: u32 = 160;

fn chain<const N: usize>(axes: [Vec3; N], limits_deg: [[f32; 2]; N]) -> Skeleton<N, N> {
    let bone = |i: usize| Bone {
        parent: i.checked_sub(1).map(|parent| parent as u8),
        joint: Joint::Hinge(axes[i]),
        offset_m: Vec3::x() * (0.4 - 0.05 * i as f32),
    };
    let limits = limits_deg.map(|[low, high]| Limit::from_degrees(low, high));
    Skeleton::new(std::array::from_fn(bone), limits).expect("a sound chain")
}

/// Two hinges in a plane.
fn planar() -> Skeleton<2, 2> {
    chain([Vec3::z(); 2], [[-100.0, 80.0], [0.0, 140.0]])
}

/// Three hinges about different axes.
fn spatial() -> Skeleton<3, 3> {
    chain([Vec3::z(), Vec3::y(), Vec3::z()], [[-100.0, 80.0], [-70.0, 60.0], [0.0, 140.0]])
}

/// Largest log density over all poses of a grid, and its pose. The angles are `about` plus a whole
/// number, `reach` at most either way, of `step_rad`, cut to the limits.
fn best_around<const N: usize>(
    density: &PoseDensity<'_, N, N>,
    about: [f32; N],
    step_rad: [f32; N],
    reach: usize,
) -> ([f32; N], f32) {
    let wide = 2 * reach + 1;
    let mut best = (about, f32::NEG_INFINITY);
    for place in 0..wide.pow(N as u32) {
        let index = |i: usize| (place / wide.pow(i as u32)) % wide;
        let pose = std::array::from_fn(|i| about[i] + (index(i) as f32 - reach as f32) * step_rad[i]);
        let pose = density.skeleton.clamp(pose);
        let log_density = density.log_density(&pose, &density.posture(&pose));
        if log_density > best.1 {
            best = (pose, log_density);
        }
    }
    best
}

/// The grid over the whole box, then ever finer ones about its best.
fn brute_force<const N: usize>(density: &PoseDensity<'_, N, N>) -> f32 {
    let limits = density.skeleton.limits();
    let reach = if N == 2 { 40 } else { 12 };
    let mut step = limits.map(|limit| 0.5 * (limit.high_rad - limit.low_rad) / reach as f32);
    let middle = limits.map(|limit| 0.5 * (limit.high_rad + limit.low_rad));
    let mut best = best_around(density, middle, step, reach);
    for _ in 0..5 {
        step = step.map(|width| width / 3.0);
        best = best_around(density, best.0, step, 4);
    }
    best.1
}

/// A run: the angles that the search begins at, and the goal. The goal is that of a pose inside the
/// limits, or anywhere from beside the root to beyond reach.
#[derive(Debug, Clone)]
struct Case<const N: usize> {
    start_rad: [f32; N],
    position_m: Vec3,
}

/// Begins within `near_rad` of the pose that the goal is of, or anywhere; every other goal lies
/// anywhere if `far_goals`.
fn case<const N: usize>(
    skeleton: &Skeleton<N, N>,
    near_rad: Option<f32>,
    far_goals: bool,
) -> impl Strategy<Value = Case<N>> {
    let shares = || prop::array::uniform::<_, N>(0.0_f32..1.0);
    let anywhere = prop::array::uniform3(-0.9_f32..0.9);
    let at = |shares: [f32; N]| -> [f32; N] {
        let limits = skeleton.limits();
        std::array::from_fn(|i| limits[i].low_rad + (limits[i].high_rad - limits[i].low_rad) * shares[i])
    };
    (shares(), shares(), anywhere, any::<bool>()).prop_map(move |(start, goal, anywhere, is_far)| {
        let reached_rad = at(goal);
        let start_rad = match near_rad {
            Some(near) => std::array::from_fn(|i| reached_rad[i] + near * (2.0 * start[i] - 1.0)),
            None => at(start),
        };
        let reached = posture(skeleton, &Vec3::zeros(), &reached_rad).ends[N - 1];
        let position_m = if far_goals && is_far { Vec3::from(anywhere) } else { reached };
        Case { start_rad: skeleton.clamp(start_rad), position_m }
    })
}

/// Shares of the runs of one test.
#[derive(Debug, Default)]
struct Shares {
    /// That stopped of themselves.
    converged: f32,
    /// That ended in the grid's best mode, and not in another one.
    best: f32,
    /// That ended with an angle at its limit.
    at_a_limit: f32,
    /// That ended more than five centimetres from the goal.
    out_of_reach: f32,
}

/// Runs `solve` on `CASES` cases and compares each answer with the poses around it and with those
/// of the grid.
fn solve_many<const N: usize>(
    skeleton: &Skeleton<N, N>,
    cases: impl Strategy<Value = Case<N>>,
    solve: impl Fn(&PoseDensity<'_, N, N>) -> Mode<N>,
) -> Shares {
    let shares = RefCell::new(Shares::default());
    let run = |case: Case<N>| {
        let goals = [Goal { bone: N - 1, position_m: case.position_m, precision: Mat3::identity() * 400.0 }];
        let (root_m, previous_rad, stiffness) = (Vec3::zeros(), case.start_rad, [0.5; N]);
        let density = PoseDensity { skeleton, root_m, goals: &goals, previous_rad, stiffness, held: 0 };
        let mode = solve(&density);
        prop_assert_eq!(skeleton.clamp(mode.angles_rad), mode.angles_rad);
        let best = brute_force(&density);
        let tolerance = TOLERANCE + RELATIVE_TOLERANCE * best.abs();
        prop_assert!(mode.log_density <= best + tolerance, "{} above all: {}", mode.log_density, best);
        let (_, around) = best_around(&density, mode.angles_rad, [0.01; N], 3);
        if mode.converged() {
            prop_assert!(around - mode.log_density < tolerance, "{} beside {:?}", around, mode);
        }
        let limits = skeleton.limits();
        let is_at_a_limit =
            (0..N).any(|i| mode.angles_rad[i] == limits[i].low_rad || mode.angles_rad[i] == limits[i].high_rad);
        let mut shares = shares.borrow_mut();
        let share = |is: bool| if is { 1.0 / CASES as f32 } else { 0.0 };
        shares.converged += share(mode.converged());
        shares.best += share(best - mode.log_density < tolerance);
        shares.at_a_limit += share(is_at_a_limit);
        shares.out_of_reach += share(mode.residual_m > 0.05);
        Ok(())
    };
    let config = Config { cases: CASES, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    runner.run(&cases, run).unwrap_or_else(|failure| panic!("{failure}"));
    shares.into_inner()
}

/// Begins at the likeliest pose of a coarse grid, four values an angle.
fn from_a_grid<const N: usize>(density: &PoseDensity<'_, N, N>) -> Mode<N> {
    let limits = density.skeleton.limits();
    let start = |place: usize| -> [f32; N] {
        std::array::from_fn(|i| {
            let index = (place >> (2 * i)) & 3;
            limits[i].low_rad + (limits[i].high_rad - limits[i].low_rad) * (index as f32 + 0.5) / 4.0
        })
    };
    let starts: Vec<[f32; N]> = (0..1 << (2 * N)).map(start).collect();
    density.mode_from(&starts, STEPS)
}

fn assert_within(name: &str, share: f32, [least, most]: [f32; 2]) {
    assert!(share >= least && share <= most, "{name}: {share}, not from {least} to {most}");
}

/// Searches that begin near the goal's pose end in the best mode. Of those that begin anywhere, the
/// stated share does. The searches are Gauss-Newton, the gradient, and Gauss-Newton from the
/// likeliest pose of a coarse grid.
fn hold<const N: usize>(skeleton: &Skeleton<N, N>, best: [[f32; 2]; 3]) {
    let near = solve_many(skeleton, case(skeleton, Some(0.3), false), |density| density.mode(STEPS));
    assert_within("near: best", near.best, [0.999, 1.001]);
    let far = || case(skeleton, None, true);
    let by_gradient = |density: &PoseDensity<'_, N, N>| mode_by_gradient(density, GRADIENT_STEPS);
    let shares = [
        solve_many(skeleton, far(), |density| density.mode(STEPS)),
        solve_many(skeleton, far(), by_gradient),
        solve_many(skeleton, far(), from_a_grid),
    ];
    for (shares, best) in shares.iter().zip(best) {
        println!("{shares:?}");
        assert_within("converged", shares.converged, [0.96, 1.001]);
        assert_within("at a limit", shares.at_a_limit, [0.15, 0.5]);
        assert_within("out of reach", shares.out_of_reach, [0.3, 0.7]);
        assert_within("best", shares.best, best);
    }
    assert!(shares[2].best > shares[0].best, "{shares:?}");
}

#[test]
fn two_hinges_end_where_brute_force_does() {
    hold(&planar(), [[0.86, 0.97], [0.88, 0.98], [0.93, 1.001]]);
}

#[test]
fn three_hinges_end_where_brute_force_does() {
    hold(&spatial(), [[0.77, 0.91], [0.82, 0.95], [0.85, 0.97]]);
}
