//! Training of a motion model from cut cycles (cyclic paper, section 2.3).

pub mod cycle;
pub mod deviation;
pub mod statistics;
pub mod winding;

pub use cycle::TrainingCycle;
pub use winding::{UnevenTurns, uneven_turns};

use super::angle_table::{ANGLES, AngleTable};
use super::cuts::{Cut, CutList};
use super::error::CyclicError;
use super::model::{CyclicModel, ModelNumbers, TrainedOn};
use super::rate;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// How to train.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrainingOptions {
    /// Positions l of the reference cycle, 10 to 1000; the paper's is 100.
    pub length: usize,
    /// Frames per second of tables that do not say, greater than zero.
    pub rate_hz: Option<f64>,
    /// Each cycle also with left and right exchanged, half a cycle later: a motion that is the same
    /// on both sides.
    pub mirror: bool,
}

impl Default for TrainingOptions {
    fn default() -> Self {
        Self { length: 100, rate_hz: None, mirror: false }
    }
}

/// Trains a model on the cycles of `list`.
///
/// # Errors
/// A table that cannot be read, a cut that cannot be used (named with the list's line), or less
/// than two cycles. Also options out of their range.
pub fn train(list: &CutList, options: TrainingOptions) -> Result<CyclicModel, CyclicError> {
    train_on(&read_cycles(list, options.mirror)?, list, options)
}

/// Trains a model on `cycles`, which were read from `list`.
///
/// # Errors
/// Less than two cycles, or options out of their range.
pub fn train_on(
    cycles: &[TrainingCycle],
    list: &CutList,
    options: TrainingOptions,
) -> Result<CyclicModel, CyclicError> {
    if !(10..=1000).contains(&options.length) {
        return Err(CyclicError::parameter("length", format!("has to lie from 10 to 1000, not {}", options.length)));
    }
    if let Some(rate) = options.rate_hz.filter(|rate| !(*rate > 0.0 && rate.is_finite())) {
        return Err(CyclicError::parameter("rate", format!("has to be greater than zero, not {rate}")));
    }
    if cycles.len() < 2 {
        let rule = "one training cycle only: how cycles differ (the covariance) is then not known; add a second row";
        return Err(CyclicError::broken(list.path(), list.cuts()[0].line, rule));
    }
    let rate_hz = rate_hz(cycles, list, options.rate_hz)?;
    let numbers = numbers(cycles, options.length, rate_hz);
    let mut tables: Vec<String> = list.cuts().iter().map(|cut| file_name(&cut.file)).collect();
    tables.sort();
    tables.dedup();
    let trained_on = TrainedOn { tables, cycles: cycles.len() as u64, shrinkage: 0.0 };
    CyclicModel::new(numbers, trained_on).map_err(|error| {
        CyclicError::broken(list.path(), list.cuts()[0].line, format!("the cycles give no usable model: {error}"))
    })
}

/// The cycles of `list` in its order; where `mirror` says so, then those of the mirror image, of
/// all cycles beside which the table goes on for half a cycle.
///
/// # Errors
/// A table that cannot be read, or a cut that cannot be used, named with the list's line. To mirror
/// a motion in space.
pub fn read_cycles(list: &CutList, mirror: bool) -> Result<Vec<TrainingCycle>, CyclicError> {
    cycles_of(list, mirror, &AngleTable::read)
}

/// As [`read_cycles`], of tables that `table` finds by the path that `list` gives them.
///
/// # Errors
/// As [`read_cycles`].
pub fn cycles_of(
    list: &CutList,
    mirror: bool,
    table: &dyn Fn(&Path) -> Result<AngleTable, CyclicError>,
) -> Result<Vec<TrainingCycle>, CyclicError> {
    let mut tables: BTreeMap<PathBuf, AngleTable> = BTreeMap::new();
    let (mut cycles, mut mirrored) = (Vec::with_capacity(list.cuts().len()), Vec::new());
    for cut in list.cuts() {
        let path = list.table_path(cut);
        if !tables.contains_key(&path) {
            tables.insert(path.clone(), table(&path)?);
        }
        let cycle = TrainingCycle::new(&tables[&path], cut)
            .map_err(|rule| CyclicError::broken(list.path(), cut.line, format!("`{}`: {rule}", path.display())))?;
        if let Some(first) =
            cycles.first().map(TrainingCycle::angle_count).filter(|first| *first != cycle.angle_count())
        {
            let rule = format!(
                "`{}` has {} angles a frame, the first table {first}; train on tables of one kind (sinew angles --view space or not)",
                path.display(),
                cycle.angle_count()
            );
            return Err(CyclicError::broken(list.path(), cut.line, rule));
        }
        cycles.push(cycle);
        if mirror {
            let image = mirror_image(&tables[&path], cut)
                .map_err(|rule| CyclicError::broken(list.path(), cut.line, format!("`{}`: {rule}", path.display())))?;
            mirrored.extend(image);
        }
    }
    cycles.append(&mut mirrored);
    cycle::weigh_people(&mut cycles);
    Ok(cycles)
}

/// The cycle of the mirror image that begins half a cycle later, or earlier where the table ends;
/// `None` where neither is in the table.
fn mirror_image(table: &AngleTable, cut: &Cut) -> Result<Option<TrainingCycle>, String> {
    if table.angle_count() > ANGLES {
        return Err("a motion in space cannot be mirrored; train on angles in the plane, or without --mirror".into());
    }
    let half = cut.duration_frames() / 2;
    let moved = |start_frame: u64, end_frame: u64| Cut { start_frame, end_frame, ..cut.clone() };
    let cut = if cut.end_frame + half <= table.end_frame() {
        moved(cut.start_frame + half, cut.end_frame + half)
    } else if cut.start_frame >= table.first_frame() + half {
        moved(cut.start_frame - half, cut.end_frame - half)
    } else {
        return Ok(None);
    };
    Ok(TrainingCycle::new(table, &cut)?.sides_exchanged())
}

/// Frames per second of all tables: a model has one rate.
fn rate_hz(cycles: &[TrainingCycle], list: &CutList, given: Option<f64>) -> Result<f64, CyclicError> {
    let mut all = None;
    for (cycle, cut) in cycles.iter().zip(list.cuts()) {
        let rate_hz = rate::of_recording(&list.table_path(cut), cycle.rate_hz(), given)?;
        let first = *all.get_or_insert(rate_hz);
        if !rate::is_same(rate_hz, first) {
            let rule = format!(
                "`{}` has {rate_hz} frames a second, the first table {first}; make them alike by `sinew angles --rate {first}`",
                list.table_path(cut).display()
            );
            return Err(CyclicError::broken(list.path(), cut.line, rule));
        }
    }
    all.ok_or_else(|| CyclicError::unusable(list.path(), "has no cycle"))
}

/// The model's numbers, rounded to `f32`.
fn numbers(cycles: &[TrainingCycle], length: usize, rate_hz: f64) -> ModelNumbers {
    let statistics = statistics::of_positions(cycles, length);
    let rows = |row: fn(&statistics::PositionStatistics) -> &[f64]| -> Vec<f32> {
        statistics.iter().flat_map(row).map(|&value| value as f32).collect()
    };
    let weights: f64 = cycles.iter().map(TrainingCycle::weight).sum();
    let mean_velocity = cycles.iter().map(|cycle| cycle.weight() / cycle.duration_frames()).sum::<f64>() / weights;
    ModelNumbers {
        angle_count: statistics::angle_count(cycles),
        mean_acceleration: rows(|at| &at.mean_acceleration),
        acceleration_covariance: rows(|at| &at.acceleration_covariance),
        mean_pose_rad: rows(|at| &at.mean_pose_rad),
        mean_velocity: rows(|at| &at.mean_velocity),
        turns_per_cycle: statistics::turns_per_cycle(cycles, length),
        mean_duration_frames: (1.0 / mean_velocity) as f32,
        rate_hz: rate_hz as f32,
        deviation: Some(deviation::of_cycles(cycles, length)),
    }
}

fn file_name(file: &str) -> String {
    Path::new(file).file_name().map_or_else(|| file.to_owned(), |name| name.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write_tables(folder: &Path) {
        for (name, amplitude) in [("a.csv", 0.4), ("b.csv", 0.6)] {
            let row = |frame: usize| [Some(amplitude * (std::f64::consts::TAU * frame as f64 / 60.0).sin()); ANGLES];
            let table = AngleTable::from_angles(0, &(0..200).map(row).collect::<Vec<_>>()).unwrap();
            table.write(&folder.join(name)).unwrap();
        }
    }

    fn trained(folder: &Path, rows: &str) -> Result<CyclicModel, String> {
        let list = CutList::parse(&format!("file,start_frame,end_frame\n{rows}"), &folder.join("cuts.csv"));
        train(&list.unwrap(), TrainingOptions { rate_hz: Some(60.0), ..TrainingOptions::default() })
            .map_err(|error| error.to_string())
    }

    #[test]
    fn two_cycles_give_a_model_that_the_core_accepts() {
        let folder = tempfile::tempdir().unwrap();
        write_tables(folder.path());
        let model = trained(folder.path(), "a.csv,10,70\nb.csv,12,60\n").unwrap();
        let view = model.view();
        assert_eq!((view.position_count(), view.angle_count()), (100, ANGLES));
        assert!((view.mean_cycle_velocity() - 0.5 * (1.0 / 60.0 + 1.0 / 48.0)).abs() < 1.0e-6);
        assert_eq!(
            (model.trained_on().cycles, model.trained_on().tables.as_slice()),
            (2, &["a.csv".to_owned(), "b.csv".to_owned()][..])
        );
    }

    /// The left side swings by 0.4 and the right one half a cycle later by 0.6: with the mirror
    /// image both swing by their mean.
    #[test]
    fn mirrored_cycles_make_both_sides_alike() {
        let folder = tempfile::tempdir().unwrap();
        let swing =
            |amplitude: f64, frame: usize| Some(amplitude * (std::f64::consts::TAU * frame as f64 / 60.0).sin());
        let row = |frame: usize| {
            let mut angles = [swing(0.1, frame); ANGLES];
            // Left and right hip.
            (angles[7], angles[10]) = (swing(0.4, frame), swing(0.6, frame + 30));
            angles
        };
        let table = AngleTable::from_angles(0, &(0..200).map(row).collect::<Vec<_>>()).unwrap();
        table.write(&folder.path().join("a.csv")).unwrap();
        let list =
            CutList::parse("file,start_frame,end_frame\na.csv,10,70\na.csv,130,190\n", &folder.path().join("c.csv"));
        let options = TrainingOptions { rate_hz: Some(60.0), mirror: true, ..TrainingOptions::default() };
        let model = train(&list.unwrap(), options).unwrap();
        assert_eq!(model.trained_on().cycles, 4, "the second one's image begins half a cycle sooner");
        let pose = |position: f32| model.view().mean_pose_rad::<ANGLES>(model.view().point(position));
        for i in 0..20 {
            let (here, later) = (pose(i as f32 / 20.0), pose((i as f32 / 20.0 + 0.5).fract()));
            assert!((here[7] - later[10]).abs() < 1.0e-3, "{i}: {} and {}", here[7], later[10]);
            let wanted = 0.5 * (std::f32::consts::TAU * (i as f32 / 20.0 + 1.0 / 6.0)).sin();
            assert!((here[7] - wanted).abs() < 2.0e-3, "{i}: {} is not {wanted}", here[7]);
        }
    }

    #[test]
    fn what_cannot_be_trained_on_is_named_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        write_tables(folder.path());
        let refusal = |rows: &str| trained(folder.path(), rows).unwrap_err();
        assert!(refusal("a.csv,10,70\n").contains("cuts.csv:2: one training cycle only"));
        let outside = refusal("a.csv,10,70\nb.csv,150,210\n");
        assert!(outside.contains("cuts.csv:3: `") && outside.contains("b.csv`: the cut 150 to 210"), "{outside}");
        assert!(refusal("a.csv,10,70\nc.csv,10,70\n").contains("c.csv` cannot be read"));
    }
}
