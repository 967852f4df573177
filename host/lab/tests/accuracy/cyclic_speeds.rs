//! Real walks played slower, faster and with changes of speed, with small and large noise:
//! `coupled` keeps the position. Runs in release where `../shared/data` is present, and reports
//! where it is not.

use crate::shared_data;

use crate::walk_cuts::list;
use crate::walks::WALKS;
use sinew::cyclic::tracking::FilterName;
use sinew::cyclic::{AngleTable, CutList, CyclicModel};
use sinew_lab::cyclic::tempo::{TEMPOS, Walk};
use sinew_lab::cyclic::{LongRun, Recording, tracked};

/// Noise, degrees, with the largest mean error of the cadence from the third cycle on over all
/// tempos. Then the largest share of runs whose position is off by a fifth of a cycle at some time.
const BOUNDS: [(f64, f64, f64); 3] = [(1.5, 0.006, 0.06), (6.0, 0.005, 0.045), (29.0, 0.008, 0.07)];
/// Seeds of the noise.
const SEEDS: [u64; 3] = [1, 2, 3];

fn walks(list: &CutList) -> Vec<Walk> {
    let of_one_file = list.cuts().chunk_by(|before, after| before.file == after.file);
    of_one_file
        .map(|cuts| {
            let (first, last) = (cuts[0].start_frame, cuts[cuts.len() - 1].end_frame);
            let table = AngleTable::read(&list.table_path(&cuts[0])).unwrap();
            let rows = table.rows().iter().filter(|row| (first..=last).contains(&row.frame)).cloned().collect();
            let borders = cuts.iter().map(|cut| cut.start_frame - first).chain([last - first]).collect();
            Walk { name: cuts[0].file.clone(), rows, borders }
        })
        .collect()
}

#[test]
fn walkers_of_any_tempo_are_followed_with_little_and_with_much_noise() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let model = CyclicModel::from_option("walking").unwrap();
    let walks = walks(&list(&data, folder, &WALKS));
    let lists = TEMPOS.map(|tempo| {
        let played: Vec<Recording> = walks.iter().map(|walk| walk.played(tempo).unwrap()).collect();
        let run = |sigma_deg: f64| -> Vec<LongRun> {
            let of_seed = |seed| tracked(&played, &model, 60.0, &[FilterName::Coupled], (sigma_deg, seed)).unwrap();
            SEEDS.into_iter().flat_map(of_seed).collect()
        };
        BOUNDS.map(|(sigma_deg, ..)| run(sigma_deg))
    });
    for (column, (sigma_deg, most_cadence, most_lost)) in BOUNDS.into_iter().enumerate() {
        for ((name, _), runs) in TEMPOS.iter().zip(&lists) {
            let [error, lost] = LongRun::cadence_error_and_lost(&runs[column]);
            println!("sigma {sigma_deg}, {name}: cadence {:.1} % off, lost {:.1} %", 100.0 * error, 100.0 * lost);
        }
        let [error, lost] = LongRun::cadence_error_and_lost(lists.iter().flat_map(|runs| &runs[column]));
        println!("sigma {sigma_deg}: cadence {:.2} % off, lost {:.1} %", 100.0 * error, 100.0 * lost);
        assert!(error > 0.001 && error < most_cadence, "sigma {sigma_deg}: cadence off by {error}");
        assert!(lost < most_lost, "sigma {sigma_deg}: {lost} lost");
    }
}
