//! The accuracy of the cyclic filters that the book states, on real walkers. Runs in release where
//! `../shared/data` is at hand, and says so where not.

use crate::shared_data;

use sinew::cyclic::CutList;
use sinew::cyclic::tracking::FilterName;
use sinew::cyclic::training::{TrainingOptions, train};
use sinew::resume::Cells;
use sinew_lab::cyclic::experiments::SIGMAS_DEG;
use sinew_lab::cyclic::{Cell, Protocol, Setting, test_cycles};

/// Degrees over 13 angles at each sigma, by an independent implementation of the paper's filter
/// with the same training.
const REFERENCE_DEG: [(Protocol, FilterName, [f64; 6]); 4] = [
    (Protocol::ExactMean, FilterName::Paper, [0.35, 0.83, 1.39, 3.80, 5.33, 6.69]),
    (Protocol::ExactMean, FilterName::PaperCut, [0.18, 0.57, 1.03, 3.11, 4.56, 6.23]),
    (Protocol::Noisy, FilterName::Paper, [0.65, 1.55, 2.61, 7.87, 12.3, 27.2]),
    (Protocol::Noisy, FilterName::PaperCut, [0.70, 1.67, 2.75, 7.56, 11.3, 20.9]),
];
/// Largest relative distance from the reference.
const AGREEMENT: f64 = 0.05;
/// The same at sigma 115 with noise, where runs that lose the pose differ by seed.
const LOST_AGREEMENT: f64 = 0.08;
/// Largest error of `coupled` as a share of the better of `paper` and `paper-cut`.
const COUPLED_SHARE: [(Protocol, [f64; 6]); 2] =
    [(Protocol::ExactMean, [1.0, 1.0, 1.0, 1.0, 1.0, 1.05]), (Protocol::Noisy, [1.0, 1.0, 1.0, 0.8, 0.8, 0.6])];
/// Largest error of `coupled` with two updates a cycle as a share of that of `paper`.
const TWO_UPDATES_SHARE: f64 = 0.85;
/// Share of the truth inside `coupled`'s 90 % band: over all angles and sigmas, and for each angle.
const BAND: [f64; 2] = [0.85, 0.97];
const BAND_EACH: [f64; 2] = [0.75, 0.99];

fn errors_deg(cells: &[Cell], protocol: Protocol, filter: FilterName) -> Vec<f64> {
    let wanted = |cell: &&Cell| cell.protocol == protocol && cell.filter == filter;
    cells.iter().filter(wanted).map(|cell| cell.error_deg).collect()
}

#[test]
fn the_filters_are_as_accurate_as_the_book_says() {
    let Some(folder) = shared_data::in_release("cyclic-walking") else { return };
    let list = CutList::read(&folder.join("train_cuts.csv")).unwrap();
    let model = train(&list, TrainingOptions { rate_hz: Some(60.0), ..TrainingOptions::default() }).unwrap();
    let cycles = test_cycles(&CutList::read(&folder.join("test_cuts.csv")).unwrap()).unwrap();
    assert_eq!(cycles.iter().map(|cycle| cycle.truth.rows().len()).sum::<usize>(), 886);
    let setting = Setting { cycles: &cycles, model: &model, rate_hz: 60.0, seeds: 20, cells: &Cells::not_kept() };
    let cells = setting.noise_table().unwrap();
    for (protocol, filter, wanted) in REFERENCE_DEG {
        for ((found, wanted), sigma) in errors_deg(&cells, protocol, filter).iter().zip(wanted).zip(SIGMAS_DEG) {
            let lost = protocol == Protocol::Noisy && sigma > 100.0;
            // The reference has two decimals.
            let room = 0.006 + wanted * if lost { LOST_AGREEMENT } else { AGREEMENT };
            assert!((found - wanted).abs() < room, "{protocol:?} {filter:?} sigma {sigma}: {found} beside {wanted}");
        }
    }
    for (protocol, shares) in COUPLED_SHARE {
        let [paper, cut, coupled] = [FilterName::Paper, FilterName::PaperCut, FilterName::Coupled]
            .map(|filter| errors_deg(&cells, protocol, filter));
        for i in 0..SIGMAS_DEG.len() {
            let share = coupled[i] / paper[i].min(cut[i]);
            println!("{protocol:?} sigma {}: coupled {:.2}, share {share:.2}", SIGMAS_DEG[i], coupled[i]);
            assert!(share > 0.2 && share < shares[i], "{protocol:?} sigma {}: share {share}", SIGMAS_DEG[i]);
        }
    }
    bands_hold(&cells);
    let sparse = setting.sparse_measurements().unwrap();
    let two = |filter| {
        let wanted =
            |cell: &&Cell| cell.filter == filter && cell.protocol == Protocol::Noisy && cell.updates.starts_with("two");
        sparse.iter().find(wanted).unwrap().error_deg
    };
    let share = two(FilterName::Coupled) / two(FilterName::Paper);
    assert!(share > 0.2 && share < TWO_UPDATES_SHARE, "two updates a cycle: share {share}");
}

fn bands_hold(cells: &[Cell]) {
    let noisy: Vec<&Cell> =
        cells.iter().filter(|cell| cell.protocol == Protocol::Noisy && cell.filter == FilterName::Coupled).collect();
    let mean = |value: &dyn Fn(&Cell) -> f64| noisy.iter().map(|cell| value(cell)).sum::<f64>() / noisy.len() as f64;
    let pooled = mean(&|cell| cell.inside_90);
    let each: Vec<f64> = (0..13).map(|angle| mean(&|cell| cell.each_inside_90[angle])).collect();
    println!("inside the 90 % band: {pooled:.3}, each {each:.3?}");
    assert!((BAND[0]..BAND[1]).contains(&pooled), "{pooled}");
    assert!(each.iter().all(|share| (BAND_EACH[0]..BAND_EACH[1]).contains(share)), "{each:?}");
}
