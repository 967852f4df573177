//! Skin models as JSON files.

use super::colour_cube::CELLS;
use super::confusion::Scores;
use super::gaussian::GaussianModel;
use super::histogram::{EVIDENCE_LEVELS, HistogramModel};
use super::model::{ModelKind, ModelNumbers, SkinModel, TrainedOn};
use crate::error::{Context, Result, bail, ensure};
use crate::model_text::{self, ModelFileKind};
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;
use std::path::Path;

const KIND: ModelFileKind =
    ModelFileKind { name: "skin", command: "sinew train skin --pixels FILE", max_file_bytes: 4 << 20 };
/// Value of the field `format`.
pub const FORMAT: &str = "sinew-skin";
/// Value of the field `version`.
pub const VERSION: u64 = 1;
const SHIPPED_GAUSSIAN: &str = include_str!("../../models/skin_gaussian.json");
const SHIPPED_HISTOGRAM: &str = include_str!("../../models/skin_histogram.json");
/// Cells in one line of the file: all blues of a red and a green.
const CELLS_PER_LINE: usize = 32;

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ModelFile {
    format: String,
    version: u64,
    kind: ModelKind,
    trained_on: TrainedOn,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    gaussian: Option<GaussianModel>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    histogram: Option<HistogramText>,
}

/// A histogram as text: two hexadecimal digits a cell for the probability, one for the evidence.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct HistogramText {
    min_probability: u8,
    probability: Vec<String>,
    evidence: Vec<String>,
}

impl SkinModel {
    /// The model that `--skin` names: `gaussian`, `histogram` (the shipped ones), or a file made by
    /// `sinew train skin`.
    ///
    /// # Errors
    /// Says what is wrong with the file and how to make one.
    pub fn from_option(option: &str) -> Result<Self> {
        match option {
            "gaussian" => parse(SHIPPED_GAUSSIAN),
            "histogram" => parse(SHIPPED_HISTOGRAM),
            path if Path::new(path).exists() => read(Path::new(path)),
            other => {
                bail!(
                    "`--skin {other}`: there is no such file; give gaussian, histogram, or a file made by `sinew train skin`"
                )
            }
        }
    }
}

/// The JSON text of a model.
///
/// # Errors
/// None in practice: all fields can be written.
pub fn to_json(model: &SkinModel) -> Result<String> {
    let (gaussian, histogram) = match model.numbers() {
        ModelNumbers::Gaussian(gaussian) => (Some(*gaussian), None),
        ModelNumbers::Histogram(histogram) => (None, Some(histogram_to_text(histogram))),
    };
    let (format, trained_on) = (FORMAT.to_owned(), model.trained_on.clone());
    let file = ModelFile { format, version: VERSION, kind: model.kind(), trained_on, gaussian, histogram };
    Ok(serde_json::to_string_pretty(&file)? + "\n")
}

/// Reads a model file.
///
/// # Errors
/// Names the file, what is wrong with it, and how to make one.
pub fn read(path: &Path) -> Result<SkinModel> {
    model_text::read(path, &KIND, parse)
}

/// Reads a model from JSON text.
///
/// # Errors
/// Says which field is missing or has a value that cannot be used.
pub fn parse(text: &str) -> Result<SkinModel> {
    let value: serde_json::Value = serde_json::from_str(text).context("it is not JSON")?;
    let format = value.get("format").and_then(serde_json::Value::as_str).unwrap_or("missing");
    ensure!(format == FORMAT, "its field `format` is `{format}`, but has to be {FORMAT}");
    let version = value.get("version").and_then(serde_json::Value::as_u64);
    ensure!(version == Some(VERSION), "its field `version` is {version:?}, but this program reads version {VERSION}");
    let file: ModelFile = serde_json::from_value(value)?;
    let numbers = match (file.kind, file.gaussian, file.histogram) {
        (ModelKind::Gaussian, Some(gaussian), None) => ModelNumbers::Gaussian(gaussian),
        (ModelKind::Histogram, None, Some(text)) => ModelNumbers::Histogram(histogram_from_text(&text)?),
        (kind, _, _) => bail!("its kind is {kind:?}, so it needs the numbers of that kind and of no other"),
    };
    let Scores { precision, recall, f1 } = file.trained_on.cross_validated;
    for (name, score) in [("precision", precision), ("recall", recall), ("f1", f1)] {
        ensure!((0.0..=1.0).contains(&score), "its score `{name}` is {score}, but has to lie from 0 to 1");
    }
    SkinModel::new(numbers, file.trained_on)
}

fn histogram_to_text(histogram: &HistogramModel) -> HistogramText {
    let lines = |cells: &[u8], digits: usize| -> Vec<String> {
        let line = |cells: &[u8]| {
            cells.iter().fold(String::new(), |mut text, cell| {
                // Writing to a string cannot fail.
                let _ = write!(text, "{cell:0digits$x}");
                text
            })
        };
        cells.chunks(CELLS_PER_LINE).map(line).collect()
    };
    HistogramText {
        min_probability: histogram.min_probability,
        probability: lines(&histogram.probability, 2),
        evidence: lines(&histogram.evidence, 1),
    }
}

fn histogram_from_text(text: &HistogramText) -> Result<HistogramModel> {
    ensure!(text.min_probability > 0, "`min_probability` has to lie from 1 to 255");
    let cells = |name: &str, lines: &[String], digits: usize| -> Result<Vec<u8>> {
        let all: Vec<u8> = lines.concat().into_bytes();
        let expected = CELLS * digits;
        ensure!(all.len() == expected, "`{name}` has {} digits, but {expected} are needed", all.len());
        let digit = |&byte: &u8| char::from(byte).to_digit(16).map(|digit| digit as u8);
        let value = |digits: &[u8]| digits.iter().try_fold(0_u8, |sum, byte| Some((sum << 4) | digit(byte)?));
        let values: Option<Vec<u8>> = all.chunks(digits).map(value).collect();
        values.with_context(|| format!("`{name}` has a character that is no hexadecimal digit"))
    };
    let evidence = cells("evidence", &text.evidence, 1)?;
    debug_assert!(evidence.iter().all(|&level| level < EVIDENCE_LEVELS));
    let probability = cells("probability", &text.probability, 2)?;
    Ok(HistogramModel { probability, evidence, min_probability: text.min_probability })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn gaussian_json() -> String {
        to_json(&SkinModel::from_option("gaussian").unwrap()).unwrap()
    }

    fn refusal(text: &str) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.json");
        fs::write(&path, text).unwrap();
        let message = format!("{:#}", read(&path).unwrap_err());
        assert!(message.contains("model.json") && message.contains("sinew train skin"), "{message}");
        message
    }

    #[test]
    fn models_survive_a_file() {
        for name in ["gaussian", "histogram"] {
            let model = SkinModel::from_option(name).unwrap();
            let text = to_json(&model).unwrap();
            assert!(text.len() < 200 * 1024, "{name} takes {} bytes", text.len());
            assert_eq!(parse(&text).unwrap(), model, "{name}");
        }
    }

    #[test]
    fn a_byte_order_mark_is_no_part_of_a_model() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.json");
        fs::write(&path, format!("\u{feff}{}", gaussian_json())).unwrap();
        assert_eq!(to_json(&read(&path).unwrap()).unwrap(), gaussian_json());
    }

    #[test]
    fn what_is_no_model_is_refused_with_the_reason() {
        let long = refusal(&format!(r#"{{"format": "{}"}}"#, "x".repeat(100_000)));
        assert!(long.contains("`format` is `xxx") && long.len() < 1000, "{long}");
        assert!(refusal("no json").contains("not JSON"));
        assert!(refusal("{}").contains("`format` is `missing`"));
        assert!(refusal(&gaussian_json().replace("\"version\": 1", "\"version\": 2")).contains("Some(2)"));
        assert!(
            refusal(&gaussian_json().replace("\"kind\": \"gaussian\"", "\"kind\": \"histogram\""))
                .contains("Histogram")
        );
        assert!(refusal(&gaussian_json().replace("\"threshold\": ", "\"threshold\": -")).contains("threshold"));
        let mut infinite: serde_json::Value = serde_json::from_str(&gaussian_json()).unwrap();
        infinite["gaussian"]["threshold"] = 1.0e39.into();
        assert!(refusal(&infinite.to_string()).contains("threshold"));
        assert!(refusal(&gaussian_json().replace("\"f1\": 0.", "\"f1\": 1")).contains("score `f1`"));
        assert!(refusal(&gaussian_json().replace("\"threshold\": ", "\"treshold\": ")).contains("treshold"));
        assert!(
            refusal(&gaussian_json().replace("\"threshold\": ", "\"threshold\": NaN, \"x\": ")).contains("not JSON")
        );
    }

    #[test]
    fn a_damaged_histogram_is_refused() {
        let text = to_json(&SkinModel::from_option("histogram").unwrap()).unwrap();
        let line = text.lines().find(|line| line.trim().len() == 67).unwrap();
        assert!(refusal(&text.replacen(&format!("{line}\n"), "", 1)).contains("digits"));
        assert!(refusal(&text.replacen(line, &line.replacen('0', "g", 1), 1)).contains("hexadecimal"));
    }
}
