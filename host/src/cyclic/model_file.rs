//! Motion models as JSON files.

use super::angle_table::{ANGLES, angle_columns};
use super::model::{CyclicModel, DeviationNumbers, ModelNumbers, TrainedOn};
use crate::error::{Context, Result, bail, ensure};
use crate::model_text::{self, ModelFileKind};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use serde_json::value::RawValue;
use sinew_core::numeric::semi_definite::packed_len;
use std::path::Path;
use std::sync::OnceLock;

const KIND: ModelFileKind =
    ModelFileKind { name: "motion", command: "sinew train cyclic --cuts CUTS.csv", max_file_bytes: 64 << 20 };
/// Value of the field `format`.
pub const FORMAT: &str = "sinew-cyclic";
/// Value of the field `version`.
pub const VERSION: u64 = 1;

/// The models that are shipped, by name; `models/cuts/NAME.csv` lists the cycles each was trained.
const SHIPPED: [(&str, &str); 3] = [
    ("walking", include_str!("../../models/walking.json")),
    ("running", include_str!("../../models/running.json")),
    ("arm-circles", include_str!("../../models/arm-circles.json")),
];

/// What an option for a model takes, for help texts.
pub const MODEL_VALUE: &str = "MODEL.json|walking|running|arm-circles";

type Rows<T> = Vec<Vec<T>>;

/// What says whether the rest can be read.
#[derive(Debug, Deserialize)]
struct Head {
    format: Option<Value>,
    version: Option<Value>,
}

/// The file: one row a position in every table.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ModelFile<Table> {
    format: String,
    version: u64,
    trained_on: TrainedOn,
    rate_hz: f32,
    mean_duration_frames: f32,
    angles: Vec<String>,
    turns_per_cycle: Vec<i8>,
    mean_pose_rad: Table,
    mean_velocity: Table,
    mean_acceleration: Table,
    acceleration_covariance: Table,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    deviation: Option<DeviationNumbers>,
}

impl CyclicModel {
    /// The model that an option names: one of those shipped (see [`MODEL_VALUE`]), else a file.
    ///
    /// # Errors
    /// No such file, or a file that is no model.
    pub fn from_option(option: &str) -> Result<Self> {
        if let Some(model) = shipped(option) {
            return Ok(model.clone());
        }
        let path = Path::new(option);
        if !path.exists() {
            let names = shipped_names().join(", ");
            bail!("`--model {option}`: there is no such file; give {names}, or a file made by `sinew train cyclic`");
        }
        read(path)
    }
}

/// Names of the models that are shipped.
#[must_use]
pub fn shipped_names() -> [&'static str; 3] {
    SHIPPED.map(|(name, _)| name)
}

/// The shipped model of this name, parsed once a process.
///
/// # Panics
/// Never: tests read each of them.
#[must_use]
pub fn shipped(name: &str) -> Option<&'static CyclicModel> {
    static MODELS: [OnceLock<CyclicModel>; 3] = [const { OnceLock::new() }; 3];
    let index = SHIPPED.iter().position(|(shipped, _)| *shipped == name)?;
    Some(MODELS[index].get_or_init(|| parse(SHIPPED[index].1).expect("tests read each shipped model")))
}

/// The JSON text of a model, one line for each position of a table.
///
/// # Errors
/// None in practice: all fields can be written.
pub fn to_json(model: &CyclicModel) -> Result<String> {
    let numbers = model.numbers();
    let n = numbers.angle_count;
    let file = ModelFile {
        format: FORMAT.to_owned(),
        version: VERSION,
        trained_on: model.trained_on().clone(),
        rate_hz: numbers.rate_hz,
        mean_duration_frames: numbers.mean_duration_frames,
        angles: angle_names(n),
        turns_per_cycle: numbers.turns_per_cycle.clone(),
        mean_pose_rad: lines(&numbers.mean_pose_rad, n)?,
        mean_velocity: lines(&numbers.mean_velocity, n)?,
        mean_acceleration: lines(&numbers.mean_acceleration, n)?,
        acceleration_covariance: lines(&numbers.acceleration_covariance, packed_len(n))?,
        deviation: numbers.deviation.clone(),
    };
    Ok(serde_json::to_string_pretty(&file)? + "\n")
}

/// Names of the first `count` angles: the joints', then with `_side`.
fn angle_names(count: usize) -> Vec<String> {
    angle_columns().take(count).map(|column| column.trim_end_matches("_rad").to_owned()).collect()
}

/// Rows of `width` numbers, each on one line.
fn lines(values: &[f32], width: usize) -> Result<Vec<Box<RawValue>>> {
    values.chunks(width).map(|row| Ok(RawValue::from_string(serde_json::to_string(row)?)?)).collect()
}

/// Reads a model file.
///
/// # Errors
/// Names the file, what is wrong with it, and how to make one.
pub fn read(path: &Path) -> Result<CyclicModel> {
    model_text::read(path, &KIND, parse)
}

/// Reads a model from JSON text.
///
/// # Errors
/// Says which field is missing or has a value that cannot be used.
pub fn parse(text: &str) -> Result<CyclicModel> {
    let head: Head = serde_json::from_str(text).context("it is not JSON, or not a model")?;
    let format = head.format.as_ref().and_then(Value::as_str).unwrap_or("missing");
    ensure!(format == FORMAT, "its field `format` is `{format}`, but has to be {FORMAT}");
    let version = head.version.map_or_else(|| "missing".to_owned(), |version| version.to_string());
    ensure!(
        version == VERSION.to_string(),
        "its field `version` is {version}, but this program reads version {VERSION}"
    );
    let file: ModelFile<Rows<f32>> = serde_json::from_str(text)?;
    let n = if file.angles.len() > ANGLES { 2 * ANGLES } else { ANGLES };
    let wanted = angle_names(n);
    ensure!(file.angles == wanted, "its field `angles` has to be {}", wanted.join(", "));
    let mut deviation = file.deviation;
    if let Some(DeviationNumbers { cosine_std_rad, sine_std_rad, .. }) = &mut deviation
        && sine_std_rad.is_empty()
    {
        // Sinew 0.2 has one number for both.
        sine_std_rad.clone_from(cosine_std_rad);
    }
    if let Some(DeviationNumbers { inflation, shrinkage, .. }) = deviation {
        for (name, value) in [("inflation", inflation), ("shrinkage", shrinkage)] {
            ensure!(value.is_finite(), "`deviation.{name}` has to be a finite number");
        }
    }
    let l = file.mean_acceleration.len();
    let table = |name: &str, rows: Rows<f32>, width: usize| -> Result<Vec<f32>> {
        ensure!(rows.len() == l, "`{name}` has {} rows, but `mean_acceleration` has {l}", rows.len());
        if let Some((index, row)) = rows.iter().enumerate().find(|(_, row)| row.len() != width) {
            bail!("`{name}` has {} numbers in row {index}, but {width} are needed", row.len());
        }
        Ok(rows.concat())
    };
    let numbers = ModelNumbers {
        angle_count: n,
        mean_acceleration: table("mean_acceleration", file.mean_acceleration, n)?,
        acceleration_covariance: table("acceleration_covariance", file.acceleration_covariance, packed_len(n))?,
        mean_pose_rad: table("mean_pose_rad", file.mean_pose_rad, n)?,
        mean_velocity: table("mean_velocity", file.mean_velocity, n)?,
        turns_per_cycle: file.turns_per_cycle,
        mean_duration_frames: file.mean_duration_frames,
        rate_hz: file.rate_hz,
        deviation,
    };
    Ok(CyclicModel::new(numbers, file.trained_on)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn walking_json() -> String {
        to_json(&CyclicModel::from_option("walking").unwrap()).unwrap()
    }

    fn refusal(text: &str) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.json");
        fs::write(&path, text).unwrap();
        let message = format!("{:#}", read(&path).unwrap_err());
        assert!(message.contains("model.json") && message.contains("sinew train cyclic"), "{message}");
        message
    }

    fn changed(change: impl FnOnce(&mut Value)) -> String {
        let mut value: Value = serde_json::from_str(&walking_json()).unwrap();
        change(&mut value);
        refusal(&value.to_string())
    }

    #[test]
    fn a_number_beyond_the_range_is_refused() {
        let message = changed(|value| value["deviation"]["shrinkage"] = serde_json::json!(1.0e308));
        assert!(message.contains("`deviation.shrinkage` has to be a finite number"), "{message}");
    }

    #[test]
    fn a_model_survives_its_file() {
        let text = walking_json();
        assert!(text.len() < 300 * 1024, "{} bytes", text.len());
        assert_eq!(to_json(&parse(&text).unwrap()).unwrap(), text);
    }

    #[test]
    fn one_spread_of_the_swing_serves_cosine_and_sine() {
        let mut value: Value = serde_json::from_str(&walking_json()).unwrap();
        let deviation = value["deviation"].as_object_mut().unwrap();
        let swing = deviation.remove("cosine_std_rad").unwrap();
        deviation.remove("sine_std_rad");
        deviation.insert("swing_std_rad".into(), swing);
        let deviation = parse(&value.to_string()).unwrap().numbers().deviation.clone().unwrap();
        assert_eq!(deviation.cosine_std_rad, deviation.sine_std_rad);
        assert!(!deviation.sine_std_rad.is_empty());
    }

    #[test]
    fn a_byte_order_mark_is_no_part_of_a_model() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.json");
        fs::write(&path, format!("\u{feff}{}", walking_json())).unwrap();
        assert_eq!(to_json(&read(&path).unwrap()).unwrap(), walking_json());
    }

    #[test]
    fn what_is_no_model_is_refused_with_the_reason() {
        let long = refusal(&format!(r#"{{"format": "{}"}}"#, "x".repeat(100_000)));
        assert!(long.contains("`format` is `xxx") && long.len() < 1000, "{long}");
        assert!(refusal("no json").contains("not JSON"));
        assert!(refusal("{}").contains("`format` is `missing`"));
        assert!(changed(|v| v["version"] = 2.into()).contains("`version` is 2, but this program reads version 1"));
        assert!(changed(|v| v["rate_hz"] = 0.into()).contains("`rate_hz`"));
        assert!(
            changed(|v| v["mean_pose_rad"][3] = vec![1.0].into()).contains("`mean_pose_rad` has 1 numbers in row 3")
        );
        assert!(
            changed(|v| drop(v["mean_velocity"].as_array_mut().unwrap().pop())).contains("`mean_velocity` has 99 rows")
        );
        assert!(changed(|v| v["angles"][2] = "elbow".into()).contains("`angles` has to be neck, l_shoulder"));
        assert!(changed(|v| v["mean_velocity"][1][1] = 1.0e39.into()).contains("`mean_velocity` at cycle position 1"));
        assert!(changed(|v| v["unknown"] = 1.into()).contains("unknown"));
    }

    #[test]
    fn an_indefinite_covariance_is_refused_with_its_place() {
        let message = changed(|v| v["acceleration_covariance"][7][1] = 1.0.into());
        assert!(message.contains("cycle position 7") && message.contains("positive semi-definite"), "{message}");
        let negative = changed(|v| v["acceleration_covariance"][0][0] = (-1.0e-6).into());
        assert!(negative.contains("cycle position 0") && negative.contains("positive semi-definite"), "{negative}");
    }

    #[test]
    fn shipped_models_are_sound_and_have_the_cadence_of_people() {
        for (name, cycles_per_s) in [("walking", 0.7..1.2), ("running", 1.1..1.7), ("arm-circles", 0.8..1.4)] {
            let model = CyclicModel::from_option(name).unwrap();
            let view = model.view();
            let found = view.mean_cycle_velocity() * view.rate_hz();
            assert!(cycles_per_s.contains(&found), "{name}: {found} cycles a second");
            assert!(model.trained_on().cycles >= 6, "{name}");
        }
    }

    #[test]
    fn an_unknown_name_is_refused_with_the_choices() {
        let message = CyclicModel::from_option("wlaking").unwrap_err().to_string();
        assert!(message.contains("walking, running, arm-circles") && message.contains("wlaking"), "{message}");
        let named = SHIPPED.map(|(name, _)| name).join("|");
        assert_eq!(MODEL_VALUE, format!("MODEL.json|{named}"));
    }
}
