//! Which run a directory holds, and its input as a stream.

use super::arm::tracker_stream;
use super::arm_run::ArmRun;
use super::camera::camera_stream;
use super::cyclic_stream;
use super::form::Form;
use crate::cyclic::report::document::FORMAT as CYCLIC_FORMAT;
use crate::cyclic::tracking::{FilterName, StartName, TrackingOptions, Updates};
use crate::cyclic::{AngleTable, CyclicModel};
use crate::error::{Context, Error, Result, bail, ensure};
use crate::file::read_text;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The input of a run.
#[derive(Debug, Clone)]
pub struct Recorded {
    /// The stream.
    pub bytes: Vec<u8>,
    /// What it holds, for a terminal.
    pub what: String,
}

/// Makes the stream of the run in `folder`: one of `sinew track arm` or `sinew demo`, or a report
/// of `sinew track cyclic --report`.
///
/// # Errors
/// A folder that holds no run, a run that firmware cannot play, an input of the run that is not
/// there any more.
pub fn record(folder: &Path, form: Form) -> Result<Recorded> {
    const REMEDY: &str = "give one that `sinew track arm`, `sinew demo` or `sinew track cyclic --report` wrote";
    ensure!(folder.is_dir(), "`{}` is no folder; {REMEDY}", folder.display());
    let (arm, cyclic) = (folder.join("run.json"), folder.join("summary.json"));
    let recorded = match (arm.is_file(), cyclic.is_file(), form) {
        (true, _, _) => arm_run(&arm, form),
        (_, true, Form::Tracker) => cyclic_run(&cyclic),
        (_, true, Form::Camera) => bail!("a table of angles has no images: leave out `--form camera`"),
        _ => bail!("`{}` holds no run; {REMEDY}", folder.display()),
    };
    recorded.with_context(|| format!("`{}` cannot be recorded", folder.display()))
}

fn arm_run(report: &Path, form: Form) -> Result<Recorded> {
    let mut run = ArmRun::open(report, form)?;
    let ((bytes, frames), what) = match form {
        Form::Tracker => (tracker_stream(&mut run)?, "blobs and edges"),
        Form::Camera => (camera_stream(&mut run)?, "lines"),
    };
    Ok(Recorded { bytes, what: format!("{what} of {frames} frames") })
}

fn cyclic_run(summary: &Path) -> Result<Recorded> {
    let json: Value = serde_json::from_str(&read_text(summary)?).context("summary.json is not JSON")?;
    let text = |name: &str| json[name].as_str().with_context(|| format!("summary.json has no `{name}`"));
    ensure!(text("format")? == CYCLIC_FORMAT, "summary.json is not that of a tracked motion");
    let table = AngleTable::read(&PathBuf::from(text("table")?))?;
    let name = text("model")?;
    ensure!(!name.contains(", "), "it was tracked with several models; firmware plays one");
    let model = CyclicModel::from_option(name)?;
    let bytes = cyclic_stream(&table, &model, &tracking_options(&json["options"])?)?;
    Ok(Recorded { bytes, what: format!("{} rows of angles for the model {name}", table.rows().len()) })
}

/// The options as a report's summary has them.
fn tracking_options(json: &Value) -> Result<TrackingOptions> {
    fn named<T: DeserializeOwned>(json: &Value, name: &str) -> Result<T> {
        T::deserialize(&json[name])
            .map_err(|_| Error::Invalid(format!("summary.json has no option `{name}` that is known")))
    }
    let updates = match (json["update_every"].as_u64(), json["update_at"].as_array()) {
        (Some(every), _) => Updates::Every(every),
        (None, Some(frames)) => Updates::At(frames.iter().filter_map(Value::as_u64).collect()),
        (None, None) => Updates::All,
    };
    ensure!(
        json["finished"].as_bool() != Some(true),
        "firmware knows no later frames, and this run is of a finished recording: track it with `--online`"
    );
    Ok(TrackingOptions {
        filter: named::<FilterName>(json, "filter")?,
        sigma_rad: json["sigma_deg"].as_f64().context("summary.json has no option `sigma_deg`")?.to_radians(),
        start: named::<StartName>(json, "init")?,
        initial_cycle_position: json["initial_cycle_position"].as_f64(),
        initial_cycle_velocity: json["initial_cycle_velocity"].as_f64(),
        updates,
        rate_hz: json["rate_hz"].as_f64(),
        smooth: json["smooth"].as_bool().unwrap_or(false),
        ..TrackingOptions::default()
    })
}
