//! Real walks played slower, faster and with changes of speed, with small and large noise:
//! `coupled` keeps the position. Runs in release where `../shared/data` is present, and reports
//! where it is not.

use crate::shared_data;

use crate::walk_cuts::list;
use crate::walks::WALKS;
use sinew::cyclic::cuts::{self, Cut};
use sinew::cyclic::tracking::FilterName;
use sinew::cyclic::{AngleRow, AngleTable, CutList, CyclicModel};
use sinew_lab::cyclic::{LongRun, long_runs};
use std::f64::consts::TAU;
use std::path::Path;

/// Noise, degrees, with the largest mean error of the cadence from the third cycle on over all
/// tempos. Then the largest share of runs whose position is off by a fifth of a cycle at some time.
const BOUNDS: [(f64, f64, f64); 3] = [(1.5, 0.012, 0.06), (6.0, 0.012, 0.045), (29.0, 0.02, 0.07)];
/// Seeds of the noise.
const SEEDS: [u64; 3] = [1, 2, 3];
/// Position errors beyond which a run was lost for a while, cycles.
const LOST: f64 = 0.2;

/// The frame of the recording, of which there are so many, that is seen at a frame of the new one.
type Tempo = (&'static str, fn(f64, f64) -> f64);

const TEMPOS: [Tempo; 9] = [
    ("as recorded", |frame, _| frame),
    ("0.7 times the speed", |frame, _| 0.7 * frame),
    ("0.8 times", |frame, _| 0.8 * frame),
    ("1.25 times", |frame, _| 1.25 * frame),
    ("1.4 times", |frame, _| 1.4 * frame),
    ("slower and slower", |frame, frames| frame - 0.16 * frame * frame / frames),
    ("faster and faster", |frame, frames| frame + 0.24 * frame * frame / frames),
    ("0.75 times from the middle on", |frame, frames| frame - 0.25 * (frame - 0.5 * frames).max(0.0)),
    ("1.3 times from the middle on", |frame, frames| frame + 0.3 * (frame - 0.5 * frames).max(0.0)),
];

/// A recording from its first cut on, its borders counted from there.
struct Walk {
    rows: Vec<AngleRow>,
    borders: Vec<u64>,
}

fn walks(list: &CutList) -> Vec<Walk> {
    let of_one_file = list.cuts().chunk_by(|before, after| before.file == after.file);
    of_one_file
        .map(|cuts| {
            let (first, last) = (cuts[0].start_frame, cuts[cuts.len() - 1].end_frame);
            let table = AngleTable::read(&list.table_path(&cuts[0])).unwrap();
            let rows = table.rows().iter().filter(|row| (first..=last).contains(&row.frame)).cloned().collect();
            let borders = cuts.iter().map(|cut| cut.start_frame - first).chain([last - first]).collect();
            Walk { rows, borders }
        })
        .collect()
}

/// Angles between two rows, the shorter way round.
fn between(before: &AngleRow, after: &AngleRow, part: f64, frame: u64) -> AngleRow {
    let mut row = AngleRow { frame, extra: Vec::new(), ..before.clone() };
    for (angle, after) in row.angles_rad.iter_mut().zip(&after.angles_rad) {
        *angle = angle.zip(*after).map(|(before, after)| {
            let way = after - before;
            before + part * (way - TAU * (way / TAU).round())
        });
    }
    row
}

/// Writes the walk at another tempo and gives its cuts.
fn play(walk: &Walk, (_, source): Tempo, folder: &Path, file: &str) -> Vec<Cut> {
    let count = walk.rows.len();
    let seen = |frame: u64| source(frame as f64, count as f64);
    let frames: Vec<u64> = (0..).take_while(|&frame| seen(frame) < (count - 1) as f64).collect();
    let rows = frames.iter().map(|&frame| {
        let before = seen(frame) as usize;
        between(&walk.rows[before], &walk.rows[before + 1], seen(frame) - before as f64, frame)
    });
    AngleTable::new(rows.collect(), Vec::new()).unwrap().write(&folder.join(file)).unwrap();
    let frame_of = |border: u64| frames.partition_point(|&frame| seen(frame) < border as f64 - 0.5) as u64;
    let borders: Vec<u64> = walk.borders.iter().map(|&border| frame_of(border)).collect();
    let cut =
        |pair: &[u64]| Cut { file: file.to_owned(), start_frame: pair[0], end_frame: pair[1], person: None, line: 0 };
    borders.windows(2).map(cut).collect()
}

#[test]
fn walkers_of_any_tempo_are_followed_with_little_and_with_much_noise() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let model = CyclicModel::from_option("walking").unwrap();
    let walks = walks(&list(&data, folder, &WALKS));
    let lists = TEMPOS.map(|tempo| {
        let number = |index: usize| format!("played_{index}.csv");
        let all = walks.iter().enumerate().flat_map(|(index, walk)| play(walk, tempo, folder, &number(index)));
        let path = folder.join("played.csv");
        cuts::write(&path, &all.collect::<Vec<Cut>>()).unwrap();
        let list = CutList::read(&path).unwrap();
        let run = |sigma_deg: f64| -> Vec<LongRun> {
            let of_seed = |seed| long_runs(&list, &model, 60.0, &[FilterName::Coupled], (sigma_deg, seed)).unwrap();
            SEEDS.into_iter().flat_map(of_seed).collect()
        };
        BOUNDS.map(|(sigma_deg, ..)| run(sigma_deg))
    });
    for (column, (sigma_deg, most_cadence, most_lost)) in BOUNDS.into_iter().enumerate() {
        let (mut errors, mut lost) = (Vec::new(), Vec::new());
        for ((name, _), runs) in TEMPOS.iter().zip(&lists) {
            let runs = &runs[column];
            let error = runs.iter().map(|run| run.cadence_error.abs()).sum::<f64>() / runs.len() as f64;
            let off = runs.iter().filter(|run| run.phase_max > LOST).count();
            println!("sigma {sigma_deg}, {name}: cadence {:.1} % off, {off} of {} lost", 100.0 * error, runs.len());
            errors.push(error);
            lost.push(off as f64 / runs.len() as f64);
        }
        let [error, lost] = [errors, lost].map(|values| values.iter().sum::<f64>() / values.len() as f64);
        println!("sigma {sigma_deg}: cadence {:.2} % off, lost {:.1} %", 100.0 * error, 100.0 * lost);
        assert!(error > 0.001 && error < most_cadence, "sigma {sigma_deg}: cadence off by {error}");
        assert!(lost < most_lost, "sigma {sigma_deg}: {lost} lost");
    }
}
