//! Walkers of the training tracked by a model of the other people, at nine tempos: `coupled` keeps
//! the position. Runs in release where `../shared/data` is at hand, and says so where not.

use crate::shared_data;
use sinew_lab::cyclic::LongRun;
use sinew_lab::cyclic::stress::{ELSEWHERE, strangers, stress_runs};

/// Noise, degrees, with the largest mean error of the cadence and the largest share of lost runs.
const BOUNDS: [(f64, f64, f64); 3] = [(1.5, 0.004, 0.005), (6.0, 0.005, 0.005), (29.0, 0.012, 0.04)];
/// Seeds of the noise.
const SEEDS: [u64; 4] = [1, 2, 3, 4];

#[test]
fn strangers_are_followed_at_any_tempo_also_with_joints_elsewhere() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let strangers = strangers(&data.join("cmu-walk")).unwrap();
    for (sigma_deg, most_cadence, most_lost) in BOUNDS {
        let sets = stress_runs(&strangers, sigma_deg, &SEEDS).unwrap();
        for ((farther, _), runs) in ELSEWHERE.iter().zip(&sets) {
            let [error, lost] = LongRun::cadence_error_and_lost(runs);
            println!(
                "sigma {sigma_deg}, joints {farther} times elsewhere: cadence {:.2} % off, lost {:.1} %",
                100.0 * error,
                100.0 * lost
            );
        }
        let [error, lost] = LongRun::cadence_error_and_lost(sets.iter().flatten());
        println!("sigma {sigma_deg}: cadence {:.2} % off, lost {:.1} %", 100.0 * error, 100.0 * lost);
        assert!(error > 0.001 && error < most_cadence, "sigma {sigma_deg}: cadence off by {error}");
        assert!(lost < most_lost, "sigma {sigma_deg}: {lost} lost");
    }
}
