//! Real walks played slower, faster and with changes of speed, with small and large noise:
//! `coupled` keeps the position. Runs in release where `../shared/data` is present, and reports
//! where it is not.

use crate::shared_data;
use sinew::cyclic::CyclicModel;
use sinew_lab::cyclic::LongRun;
use sinew_lab::cyclic::other_sources::walks;
use sinew_lab::cyclic::tempo::tempo_runs;

/// Noise, degrees, with the largest mean error of the cadence from the third cycle on over all
/// tempos. Then the largest share of runs whose position is off by a fifth of a cycle at some time.
const BOUNDS: [(f64, f64, f64); 3] = [(1.5, 0.008, 0.02), (6.0, 0.006, 0.01), (29.0, 0.009, 0.02)];
/// Seeds of the noise.
const SEEDS: [u64; 10] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10];

#[test]
fn walkers_of_any_tempo_are_followed_with_little_and_with_much_noise() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let (walks, model) = (walks(&data).unwrap(), CyclicModel::from_option("walking").unwrap());
    for (sigma_deg, most_cadence, most_lost) in BOUNDS {
        let tempos = tempo_runs(&walks, &model, (sigma_deg, &SEEDS)).unwrap();
        for (name, runs) in &tempos {
            let [error, lost] = LongRun::cadence_error_and_lost(runs);
            println!("sigma {sigma_deg}, {name}: cadence {:.1} % off, lost {:.1} %", 100.0 * error, 100.0 * lost);
        }
        let [error, lost] = LongRun::cadence_error_and_lost(tempos.iter().flat_map(|(_, runs)| runs));
        println!("sigma {sigma_deg}: cadence {:.2} % off, lost {:.1} %", 100.0 * error, 100.0 * lost);
        assert!(error > 0.001 && error < most_cadence, "sigma {sigma_deg}: cadence off by {error}");
        assert!(lost < most_lost, "sigma {sigma_deg}: {lost} lost");
    }
}
