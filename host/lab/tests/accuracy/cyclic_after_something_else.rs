//! Walks that begin in the middle of a recording: somebody stands, waves, squats or gives signals
//! before. Is the walk found, and how soon? Runs in release where `../shared/data` is at hand, and
//! says so where not.

use crate::shared_data;
use anyhow::Result;
use sinew_lab::cyclic::after_something_else::{WalkAfter, of_other_sources, of_strangers, off_shares};
use std::path::Path;

/// Noise, degrees, with the greatest share of frames off in the second second of walking, and from
/// then on.
const BOUNDS: [(f64, f64, f64); 3] = [(1.5, 0.04, 0.02), (6.0, 0.04, 0.02), (29.0, 0.16, 0.06)];
/// The same for people of the training.
const STRANGERS_BOUNDS: [(f64, f64, f64); 3] = [(1.5, 0.03, 0.01), (6.0, 0.03, 0.01), (29.0, 0.16, 0.05)];
const SEEDS: [u64; 2] = [1, 2];

fn expect_found(walks: fn(&Path) -> Result<Vec<WalkAfter>>, bounds: [(f64, f64, f64); 3]) {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let walks = walks(&data).unwrap();
    for (sigma_deg, most_soon, most_later) in bounds {
        let [soon, later] = off_shares(&walks, (sigma_deg, &SEEDS)).unwrap();
        println!("sigma {sigma_deg}: {soon:.3} off in the second second, {later:.3} from then on");
        assert!(soon < most_soon && later < most_later, "sigma {sigma_deg}: {soon}, {later}");
    }
}

#[test]
fn walks_are_found_after_standing_waving_and_squatting() {
    expect_found(of_other_sources, BOUNDS);
}

#[test]
fn people_of_the_training_are_found_after_standing_and_signals() {
    expect_found(of_strangers, STRANGERS_BOUNDS);
}
