//! Arms that circle steadily: their cadence, and how many circles they did. The people are drawn
//! from the shipped model at seven tempos. There are also the five recorded circles that this model
//! knows, each closed and repeated. These are tracked by models of one recording's circles alone,
//! too.

use crate::shared_data;

use crate::circles::{Circles, FORWARDS, table, trained, write_tables};
use sinew::cyclic::angle_table::ANGLES;
use sinew::cyclic::cuts::{self, Cut};
use sinew::cyclic::synthetic_person::SyntheticPerson;
use sinew::cyclic::tracking::FilterName;
use sinew::cyclic::{AngleTable, CutList, CyclicModel};
use sinew_lab::cyclic::{LongRun, long_runs};
use std::f64::consts::TAU;
use std::path::Path;

/// Noise, degrees.
const SIGMAS_DEG: [f64; 3] = [1.5, 6.0, 29.0];
/// Seeds of the noise.
const SEEDS: [u64; 3] = [1, 2, 3];
/// Cycles of a recording.
const CYCLES: u64 = 8;
/// Tempos of people drawn from the model, as parts of its own; their own pace adds a tenth to
/// either side.
const TEMPOS: [f64; 7] = [0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.4];
/// Largest relative error of the mean cadence from the third cycle on, of people drawn from the
/// model and of the recorded circles.
const CADENCE: f64 = 0.01;
/// Largest error of the number of cycles.
const COUNT: f64 = 0.15;
/// Mean error of the cadence of the recorded circles by models of two or three of them. First for
/// circles that the model knows, then for those of the other recording, of which other joints go
/// round.
const FEW_CADENCE: f64 = 0.07;

/// Writes the poses of `cycle_frames` a cycle and gives their cuts.
fn write(folder: &Path, file: &str, cycle_frames: u64, pose_rad: impl Fn(u64) -> [f64; ANGLES]) -> Vec<Cut> {
    let rows: Vec<_> = (0..=CYCLES * cycle_frames).map(|frame| pose_rad(frame).map(Some)).collect();
    AngleTable::from_angles(0, &rows).unwrap().write(&folder.join(file)).unwrap();
    let border = |cycle| cycle * cycle_frames;
    let cut = |cycle| Cut {
        file: file.to_owned(),
        start_frame: border(cycle),
        end_frame: border(cycle + 1),
        person: None,
        line: 0,
    };
    (0..CYCLES).map(cut).collect()
}

/// Tracks all recordings of `cuts`.
fn runs(folder: &Path, cuts: &[Cut], model: &CyclicModel, sigma_deg: f64) -> Vec<LongRun> {
    let path = folder.join("cuts.csv");
    cuts::write(&path, cuts).unwrap();
    let list = CutList::read(&path).unwrap();
    let of_seed = |seed| long_runs(&list, model, 60.0, &[FilterName::Coupled], (sigma_deg, seed)).unwrap();
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
    for (number, tempo) in TEMPOS.into_iter().enumerate() {
        let cuts: Vec<Cut> = (1..=4)
            .flat_map(|seed| {
                // A higher rate than the filter assumes makes the motion slow.
                let person = SyntheticPerson::draw(&model, 60.0 / tempo, seed).unwrap();
                let file = format!("{number}_{seed}.csv");
                write(folder.path(), &file, person.cycle_frames() as u64, |frame| unwound(&model, &person, frame))
            })
            .collect();
        for sigma_deg in SIGMAS_DEG {
            let runs = runs(folder.path(), &cuts, &model, sigma_deg);
            print(&runs, sigma_deg);
            for run in &runs {
                let counted = run.counted_cycles - run.cycles;
                assert!(run.cadence_error.abs() < CADENCE, "{tempo}, {}: {}", run.name, run.cadence_error);
                assert!(counted.abs() < COUNT, "{tempo}, {}: {counted}", run.name);
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

/// The recorded circles of one recording, each closed and repeated in a table of its own.
fn repeated(data: &Path, (trial, circles): (&str, Circles), folder: &Path) -> Vec<Cut> {
    let table = table(data, trial);
    let cuts = circles.iter().map(|&(first, end)| {
        write(folder, &format!("{trial}_{first}.csv"), end - first, |frame| closed(&table, first, end, frame))
    });
    cuts.flatten().collect()
}

#[test]
fn recorded_circles_that_go_on_have_their_cadence() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let folder = tempfile::tempdir().unwrap();
    let model = CyclicModel::from_option("arm-circles").unwrap();
    let cuts: Vec<Cut> = FORWARDS.into_iter().flat_map(|circles| repeated(&data, circles, folder.path())).collect();
    for sigma_deg in SIGMAS_DEG {
        let runs = runs(folder.path(), &cuts, &model, sigma_deg);
        print(&runs, sigma_deg);
        for run in &runs {
            let counted = run.counted_cycles - run.cycles;
            assert!(run.cadence_error.abs() < CADENCE, "{}: {}", run.name, run.cadence_error);
            assert!(counted.abs() < COUNT, "{}: {counted}", run.name);
        }
    }
}

#[test]
fn models_of_two_or_three_circles_have_the_cadence_of_circles() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let folder = tempfile::tempdir().unwrap();
    write_tables(&data, folder.path());
    let models = FORWARDS.map(|recording| trained(folder.path(), &[recording]));
    let cuts = FORWARDS.map(|recording| repeated(&data, recording, folder.path()));
    for sigma_deg in SIGMAS_DEG {
        let mut errors = [Vec::new(), Vec::new()];
        for (known, model) in models.iter().enumerate() {
            for (tracked, cuts) in cuts.iter().enumerate() {
                let runs = runs(folder.path(), cuts, model, sigma_deg);
                print(&runs, sigma_deg);
                errors[usize::from(known != tracked)].extend(runs.iter().map(|run| run.cadence_error.abs()));
            }
        }
        let means = errors.map(|errors| errors.iter().sum::<f64>() / errors.len() as f64);
        println!("sigma {sigma_deg}: its own {:.4}, the other recording's {:.4}", means[0], means[1]);
        for mean in means {
            assert!(mean > 1.0e-4 && mean < FEW_CADENCE, "{sigma_deg}: {mean}");
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
