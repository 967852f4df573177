//! Walks that begin in the middle of a recording: somebody stands, waves, squats or gives signals
//! before. Is the walk found, and how soon? Runs in release where `../shared/data` is at hand, and
//! says so where not.

use crate::shared_data;
use sinew_lab::cyclic::after_something_else::{WalkAfter, of_other_sources, of_strangers, off_shares};
use sinew_lab::cyclic::stress::ELSEWHERE;

/// Noise, degrees, with the greatest share of frames off in the second second of walking, and from
/// then on.
const BOUNDS: [(f64, f64, f64); 3] = [(1.5, 0.05, 0.02), (6.0, 0.05, 0.01), (29.0, 0.1, 0.03)];
/// The same looking back over the recording.
const SMOOTHED_BOUNDS: [(f64, f64, f64); 3] = [(1.5, 0.03, 0.01), (6.0, 0.04, 0.01), (29.0, 0.11, 0.07)];
/// The same for people of the training, by [`ELSEWHERE`].
const STRANGERS_BOUNDS: [[(f64, f64, f64); 3]; ELSEWHERE.len()] = [
    [(1.5, 0.01, 0.005), (6.0, 0.01, 0.005), (29.0, 0.03, 0.01)],
    [(1.5, 0.02, 0.01), (6.0, 0.03, 0.01), (29.0, 0.12, 0.04)],
    [(1.5, 0.07, 0.02), (6.0, 0.08, 0.03), (29.0, 0.22, 0.15)],
    [(1.5, 0.14, 0.08), (6.0, 0.14, 0.09), (29.0, 0.30, 0.27)],
];
const SEEDS: [u64; 2] = [1, 2];

fn expect_found(walks: &[WalkAfter], bounds: [(f64, f64, f64); 3], smooth: bool) {
    for (sigma_deg, most_soon, most_later) in bounds {
        let [soon, later] = off_shares(walks, (sigma_deg, &SEEDS), smooth).unwrap();
        println!("sigma {sigma_deg}: {soon:.3} off in the second second, {later:.3} from then on");
        assert!(soon < most_soon && later < most_later, "sigma {sigma_deg}: {soon}, {later}");
    }
}

#[test]
fn walks_are_found_after_standing_waving_and_squatting() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let walks = of_other_sources(&data).unwrap();
    expect_found(&walks, BOUNDS, false);
    expect_found(&walks, SMOOTHED_BOUNDS, true);
}

#[test]
fn people_of_the_training_are_found_after_standing_and_signals() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let sets = of_strangers(&data).unwrap();
    for ((farther, _), (walks, bounds)) in ELSEWHERE.into_iter().zip(sets.iter().zip(STRANGERS_BOUNDS)) {
        println!("joints {farther} times elsewhere");
        expect_found(walks, bounds, false);
    }
}
