//! The body's models on real motion before the simulated camera, as the book compares them
//! (docs/measurements.md). Runs in release where `../shared/data` is at hand, and says so where
//! not.

use crate::shared_data;

use sinew::body::BodyPart;
use sinew::body::tracking::{BodyModelKind, BodyTuning};
use sinew::resume::Cells;
use sinew_lab::body::MotionChoice;
use sinew_lab::body::hidden_arm::{HiddenArmSummary, follow, summaries, windows};
use sinew_lab::body::trial::trial;
use std::ops::RangeInclusive;
use std::path::Path;

/// Largest mean error (34) of the end-effector and the angular model with 100 particles, metres.
const LARGEST_UNGUIDED_M: f64 = 0.0080;
/// Largest mean error (34) of the guided model with 30 particles, metres.
const LARGEST_GUIDED_M: f64 = 0.0045;
/// Largest error (34) of the pelvic lift model with 100 particles, metres.
const LARGEST_LIFT_M: f64 = 0.03;

/// Largest mean errors (34) of an upper body, metres: end-effector with 100 particles, guided with
/// 25.
const LARGEST_UPPER_M: [f64; 2] = [0.0075, 0.0032];

/// Runners and a jogger, whose feet go farther between two frames than the likelihood reaches.
/// Largest mean error, PIK (34), of the guided model with 50 particles and of the end-effector
/// model with 100, metres. Without the coarse-to-fine search the former loses feet: 0.026 m.
const RUNNERS: [&str; 3] = [
    "bandai/dataset-2_run_active_001.bvh@0-3",
    "cmu-expmap/train_running_3.txt@0-2",
    "cmu-exercise/13_30.amc@16.5-19.5",
];
const LARGEST_RUNNING_M: [f64; 2] = [0.016, 0.024];

/// Arms over fixed legs, a walk, jumping jacks: none of them was tuned on.
const MOTIONS: [&str; 3] =
    ["bandai/dataset-2_wave-both-hands_normal_001.bvh@0-4", "cmu-walk/02/02_01.amc", "cmu-exercise/13_29.amc@0-3.9"];

/// Smallest share of hidden arms whose error is below twice its level within ten frames of their
/// return, and whose spread grew. Two dozen arms measure a share of nine tenths to 6 %, so that
/// models that have little more (docs/measurements.md) are held to eight.
const MIN_FOUND_AGAIN: [(BodyModelKind, usize, f64); 3] =
    [(BodyModelKind::Guided, 30, 0.9), (BodyModelKind::EndEffector, 100, 0.8), (BodyModelKind::Angular, 100, 0.8)];
/// Smallest share of them that are said to be unobserved in all 15 hidden frames.
const MIN_SAID_UNOBSERVED: f64 = 0.9;
/// Fast and slow arms, walks, exercises.
const HIDING_MOTIONS: [&str; 6] = [
    "cmu-expmap/train_directing_traffic_1.txt@0-8",
    "bandai/dataset-2_wave-both-hands_normal_001.bvh@0-8",
    "cmu-walk/02/02_01.amc",
    "cmu-walk/35/35_01.amc",
    "cmu-exercise/13_29.amc@0-3.9",
    "cmu-exercise/13_29.amc@31.7-36",
];

/// Mean errors (34) of some models with so many particles over motions and seeds, metres.
fn mean_errors_m<const CELLS: usize>(
    folder: &Path,
    (motions, part): (&[&str], BodyPart),
    seeds: RangeInclusive<u64>,
    cells: [(BodyModelKind, usize); CELLS],
) -> [f64; CELLS] {
    let skeleton = folder.join("cmu-walk/35/35.asf");
    let mut errors_m = [(); CELLS].map(|()| Vec::new());
    for motion in motions {
        let motion: MotionChoice = format!("{}/{motion}", folder.display()).parse().unwrap();
        let read = motion.read(Some(skeleton.as_path()).filter(|_| part == BodyPart::Whole)).unwrap();
        for seed in seeds.clone() {
            let seen = read.seen(part, seed).unwrap();
            for (errors_m, (model, particles)) in errors_m.iter_mut().zip(cells) {
                errors_m.push(trial(&seen, model, &BodyTuning::default(), particles, seed).unwrap().0.error_m);
            }
        }
    }
    errors_m.map(|errors_m| errors_m.iter().sum::<f64>() / errors_m.len() as f64)
}

/// By how much goals are below angles with the paper's structure and 100 particles, PIK (34): six
/// motions and five seeds have 27 % (18 to 35, docs/reproduce_pik.md), three motions scatter more.
const GOALS_LEAD: [f64; 2] = [0.10, 0.50];

#[test]
fn goals_lead_angles_with_the_papers_structure() {
    let Some(folder) = shared_data::in_long_form("mocap") else { return };
    let cells = [(BodyModelKind::EndEffectorPaper, 100), (BodyModelKind::AngularPaper, 100)];
    let motions = [MOTIONS[0], MOTIONS[1], "cmu-expmap/train_directing_traffic_1.txt@0-5"];
    let [goals_m, angles_m] = mean_errors_m(&folder, (&motions, BodyPart::Upper), 1..=2, cells);
    let lead = 1.0 - goals_m / angles_m;
    println!("goals {goals_m:.4} m, angles {angles_m:.4} m");
    assert!((GOALS_LEAD[0]..GOALS_LEAD[1]).contains(&lead), "goals {goals_m}, angles {angles_m}: lead {lead}");
    assert!((0.008..0.03).contains(&goals_m), "{goals_m}");
}

#[test]
fn thirty_guided_particles_do_what_a_hundred_do_by_goals_or_angles() {
    let Some(folder) = shared_data::in_release("mocap") else { return };
    let cells = [(BodyModelKind::EndEffector, 100), (BodyModelKind::Angular, 100), (BodyModelKind::Guided, 30)];
    let [end_effector, angular, guided] = mean_errors_m(&folder, (&MOTIONS, BodyPart::Whole), 1..=1, cells);
    println!("end-effector {end_effector:.4}, angular {angular:.4}, guided with 30 {guided:.4} m");
    // Which of both is better depends on the motions (docs/measurements.md); neither is lost on
    // any.
    for (model, error_m) in [("end-effector", end_effector), ("angular", angular)] {
        assert!((0.0055..=LARGEST_UNGUIDED_M).contains(&error_m), "{model} {error_m} m");
    }
    assert!((0.0025..=LARGEST_GUIDED_M).contains(&guided), "guided {guided} m");
}

/// Two seeds: what a stride loses differs from run to run.
#[test]
fn the_coarse_to_fine_search_finds_the_feet_of_runners() {
    let Some(folder) = shared_data::in_long_form("mocap") else { return };
    let cells = [(BodyModelKind::Guided, 30), (BodyModelKind::EndEffector, 100)];
    let means = mean_errors_m(&folder, (&RUNNERS, BodyPart::Whole), 1..=2, cells);
    println!("runners: guided with 30, end-effector with 100: {means:.4?} m");
    for (error_m, largest_m) in means.into_iter().zip(LARGEST_RUNNING_M) {
        assert!((0.4 * largest_m..=largest_m).contains(&error_m), "{means:?} m");
    }
}

/// A camera that sees no legs: arms that wave and direct traffic.
#[test]
fn an_upper_body_is_followed_without_legs() {
    let Some(folder) = shared_data::in_long_form("mocap") else { return };
    let motions = [MOTIONS[0], "cmu-expmap/train_directing_traffic_1.txt@0-5"];
    let cells = [(BodyModelKind::EndEffector, 100), (BodyModelKind::Guided, 25)];
    let means = mean_errors_m(&folder, (&motions, BodyPart::Upper), 1..=1, cells);
    println!("upper body: {means:.4?} m");
    for (error, largest) in means.into_iter().zip(LARGEST_UPPER_M) {
        assert!((0.7 * largest..=largest).contains(&error), "{means:?} m");
    }
}

/// Each arm in turns, 15 frames at a time, on six motions with three seeds.
#[test]
fn hidden_arms_are_found_again() {
    let Some(folder) = shared_data::in_long_form("mocap") else { return };
    let skeleton = folder.join("cmu-walk/35/35.asf");
    let mut arms = Vec::new();
    for motion in HIDING_MOTIONS {
        let motion: MotionChoice = format!("{}/{motion}", folder.display()).parse().unwrap();
        let read = motion.read(Some(&skeleton)).unwrap();
        let frames = read.seen(BodyPart::Whole, 1).unwrap().clouds_m.len();
        for seed in 1..=3 {
            let hidden = windows(frames, 15, seed);
            let seen = read.seen_hiding(BodyPart::Whole, seed, &hidden).unwrap();
            for (model, particles, _) in MIN_FOUND_AGAIN {
                let how = (&BodyTuning::default(), &Cells::not_kept());
                arms.extend(follow(&motion.name(), (&seen, &hidden), (model, particles), how, seed).unwrap());
            }
        }
    }
    let summaries = summaries(&arms);
    assert_eq!(summaries.len(), MIN_FOUND_AGAIN.len());
    for HiddenArmSummary { model, arms, spread_grew, said_unobserved, came_back, .. } in summaries {
        let (_, _, least) = MIN_FOUND_AGAIN.into_iter().find(|(kind, ..)| *kind == model).unwrap();
        println!("{model:?}: {arms} arms, {spread_grew:.2} {said_unobserved:.2} {came_back:.2}");
        assert!(arms >= 20, "{model:?}: {arms} arms");
        assert!(came_back >= least, "{model:?}: {came_back} came back");
        assert!(spread_grew >= least, "{model:?}: the spread of {spread_grew} grew");
        assert!(said_unobserved >= MIN_SAID_UNOBSERVED, "{model:?}: {said_unobserved} were said to be unobserved");
    }
}

/// The paper's own experiment: 100 particles follow six repetitions without loss.
#[test]
fn six_pelvic_lifts_are_followed_without_loss() {
    if cfg!(debug_assertions) {
        eprintln!("skipped: only in release");
        return;
    }
    let seen = MotionChoice::PelvicLift.seen(None, 1).unwrap();
    let (result, estimates) = trial(&seen, BodyModelKind::PelvicLift, &BodyTuning::default(), 100, 1).unwrap();
    let errors: Vec<f32> = estimates
        .iter()
        .zip(seen.joints_m.iter().skip(1))
        .map(|(estimate, joints)| {
            let off = estimate.ends_m.iter().zip(joints).filter_map(|(found, place)| Some((found - (*place)?).norm()));
            off.clone().sum::<f32>() / off.count() as f32
        })
        .collect();
    let lost = errors.windows(5).any(|five| five.iter().all(|error| *error > 0.3));
    assert!(
        !lost && errors.len() > 150,
        "{} frames, worst {:?}",
        errors.len(),
        errors.iter().copied().fold(0.0, f32::max)
    );
    assert!((0.005..=LARGEST_LIFT_M).contains(&result.error_m), "{} m", result.error_m);
}
