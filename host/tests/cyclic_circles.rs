//! Arms that circle steadily, by the shipped model: their cadence, and how many circles they did. People drawn from the model at seven
//! tempos, and the five recorded circles that the model knows, each closed and repeated.

#[path = "shared_data/circles.rs"]
mod circles;
mod shared_data;

use circles::{FORWARDS, table};
use sinew::cyclic::angle_table::ANGLES;
use sinew::cyclic::cuts::{self, Cut};
use sinew::cyclic::synthetic_person::SyntheticPerson;
use sinew::cyclic::tracking::FilterName;
use sinew::cyclic::{AngleTable, CutList, CyclicModel};
use sinew::evaluate::cyclic::{LongRun, long_runs};
use std::f64::consts::TAU;
use std::path::Path;

/// Noise, degrees.
const SIGMAS_DEG: [f64; 2] = [6.0, 29.0];
/// Seeds of the noise.
const SEEDS: [u64; 3] = [1, 2, 3];
/// Cycles of a recording.
const CYCLES: u64 = 8;
/// Tempos, as parts of the model's, with the greatest relative error of the mean cadence from the third cycle on, of people drawn from
/// the model, whose own pace adds a tenth to either side.
const TEMPOS: [(f64, f64); 7] =
    [(0.7, 0.01), (0.8, 0.01), (0.9, 0.01), (1.0, 0.01), (1.1, 0.01), (1.25, 0.01), (1.4, 0.04)];
/// Of the recorded circles: of each, and of each but one. The one takes a quarter less time than the mean of all, and all joints wind.
const RECORDED_CADENCE: [f64; 2] = [0.04, 0.01];
/// Greatest error of the number of cycles, of a person drawn from the model, and of the recorded circles.
const COUNT: [f64; 2] = [0.25, 0.35];

/// Writes the poses of `cycle_frames` a cycle and gives their cuts.
fn write(folder: &Path, file: &str, cycle_frames: u64, pose_rad: impl Fn(u64) -> [f64; ANGLES]) -> Vec<Cut> {
    let rows: Vec<_> = (0..=CYCLES * cycle_frames).map(|frame| pose_rad(frame).map(Some)).collect();
    AngleTable::from_angles(0, &rows).unwrap().write(&folder.join(file)).unwrap();
    let border = |cycle| cycle * cycle_frames;
    let cut = |cycle| Cut { file: file.to_owned(), start_frame: border(cycle), end_frame: border(cycle + 1), line: 0 };
    (0..CYCLES).map(cut).collect()
}

/// Tracks all recordings of `cuts` by the shipped model.
fn runs(folder: &Path, cuts: &[Cut], sigma_deg: f64) -> Vec<LongRun> {
    let path = folder.join("cuts.csv");
    cuts::write(&path, cuts).unwrap();
    let (list, model) = (CutList::read(&path).unwrap(), CyclicModel::from_option("arm-circles").unwrap());
    let of_seed = |seed| long_runs(&list, &model, 60.0, &[FilterName::Coupled], (sigma_deg, seed)).unwrap();
    SEEDS.into_iter().flat_map(of_seed).collect()
}

fn print(runs: &[LongRun], sigma_deg: f64) {
    for run in runs {
        let counted = run.counted_cycles - run.cycles;
        println!(
            "{} sigma {sigma_deg}: cadence {:+.2} %, counted {counted:+.2}, position {:.2} off at most",
            run.name,
            100.0 * run.cadence_error,
            run.phase_max
        );
    }
}

#[test]
fn people_who_circle_as_the_model_says_have_their_cadence_at_any_tempo() {
    let folder = tempfile::tempdir().unwrap();
    let model = CyclicModel::from_option("arm-circles").unwrap();
    for (number, (tempo, most)) in TEMPOS.into_iter().enumerate() {
        let cuts: Vec<Cut> = (1..=4)
            .flat_map(|seed| {
                // More frames a second than are told make somebody slow.
                let person = SyntheticPerson::draw(&model, 60.0 / tempo, seed).unwrap();
                let file = format!("{number}_{seed}.csv");
                write(folder.path(), &file, person.cycle_frames() as u64, |frame| unwound(&model, &person, frame))
            })
            .collect();
        for sigma_deg in SIGMAS_DEG {
            let runs = runs(folder.path(), &cuts, sigma_deg);
            print(&runs, sigma_deg);
            for run in &runs {
                let counted = run.counted_cycles - run.cycles;
                assert!(run.cadence_error.abs() < most, "{tempo}, {}: {}", run.name, run.cadence_error);
                assert!(counted.abs() < COUNT[0], "{tempo}, {}: {counted}", run.name);
            }
            assert!(runs.iter().any(|run| run.cadence_error.abs() > 1.0e-4), "too good to be true");
        }
    }
}

/// The person's pose with the whole turns of the cycles before.
fn unwound(model: &CyclicModel, person: &SyntheticPerson<'_>, frame: u64) -> [f64; ANGLES] {
    let cycles = (frame as f64 / person.cycle_frames()).floor();
    let (pose, turns) = (person.pose_rad(frame as f64), model.view().parts().turns_per_cycle);
    std::array::from_fn(|i| pose[i] + TAU * cycles * f64::from(turns[i]))
}

#[test]
fn recorded_circles_that_go_on_have_their_cadence() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut cuts = Vec::new();
    for (trial, circles) in FORWARDS {
        let table = table(&data, trial);
        for &(first, end) in circles {
            cuts.extend(write(folder.path(), &format!("{trial}_{first}.csv"), end - first, |frame| {
                closed(&table, first, end, frame)
            }));
        }
    }
    for sigma_deg in SIGMAS_DEG {
        let runs = runs(folder.path(), &cuts, sigma_deg);
        print(&runs, sigma_deg);
        for run in &runs {
            let (is_fast, counted) = (run.name.contains("13_31_1031"), run.counted_cycles - run.cycles);
            assert!(
                run.cadence_error.abs() < RECORDED_CADENCE[usize::from(!is_fast)],
                "{}: {}",
                run.name,
                run.cadence_error
            );
            assert!(counted.abs() < COUNT[1], "{}: {counted}", run.name);
        }
    }
}

/// The circle from frame `first` to `end`, closed by a drift and repeated: whole turns remain.
fn closed(table: &AngleTable, first: u64, end: u64, frame: u64) -> [f64; ANGLES] {
    let (cycle, within) = (frame / (end - first), frame % (end - first));
    std::array::from_fn(|angle| {
        let at = |frame| table.angle_rad(frame, angle).unwrap();
        let way = at(end) - at(first);
        let turns = (way / TAU).round() * TAU;
        at(first + within) - (way - turns) * within as f64 / (end - first) as f64 + turns * cycle as f64
    })
}
