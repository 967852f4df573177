//! How an arm tracker is set up, and that as text.

use crate::errors::{exception, wrong};
use crate::process::detached;
use pyo3::prelude::*;
use serde_json::Value;
use sinew::config::{Config, MAX_PARTICLES};
use sinew::error::{Error, Result};
use sinew::person::FaceTable;
use sinew::skin::{Rectangle, SkinModel, model_file};
use sinew::track::{ArmStream, FaceSource, FrontEnd, RATES_HZ, SideChoice, StreamOptions};
use sinew_core::tracker::arm::Variant;
use std::path::Path;

/// All that decides an arm tracker.
#[derive(Debug)]
pub struct ArmSetup {
    pub options: StreamOptions,
    face: String,
    skin: Option<SkinModel>,
}

impl ArmSetup {
    /// With the `names` of side, front end and face.
    pub fn new(
        names: [&str; 3],
        rate_hz: f64,
        seed: u64,
        calibrate: Option<Rectangle>,
        config: Config,
    ) -> PyResult<Self> {
        let [side, front_end, face] = names;
        let [low, high] = RATES_HZ;
        if !(low..=high).contains(&rate_hz) {
            return Err(wrong("rate_hz", &format!("has to lie from {low} to {high} Hz, not {rate_hz}")));
        }
        let source = match face {
            "found" if calibrate.is_none() => FaceSource::Found,
            "given" if calibrate.is_none() => FaceSource::Given(FaceTable::default()),
            _ => FaceSource::Unknown,
        };
        let options = StreamOptions {
            side: side.parse::<SideChoice>().map_err(|rule| wrong("side", &rule))?,
            rate_hz,
            seed,
            calibrate,
            front_end: front_end.parse::<FrontEnd>().map_err(|rule| wrong("front_end", &rule))?,
            face: source,
            config,
        };
        Ok(Self { options, face: face.to_owned(), skin: None })
    }

    /// With the skin model of a name or file.
    pub fn with_skin(self, py: Python<'_>, skin: &str) -> PyResult<Self> {
        let skin = detached(py, || SkinModel::from_option(skin))?.map_err(|error| exception(&error))?;
        Ok(Self { skin: Some(skin), ..self })
    }

    /// The configuration of a file or of JSON, with what was set beside it.
    pub fn config(
        file: Option<&Path>,
        json: Option<&str>,
        variant: Option<&str>,
        particles: Option<usize>,
    ) -> PyResult<Config> {
        let config = match (file, json) {
            (Some(file), _) => Config::load(file),
            (None, Some(json)) => Config::parse_json(json).map_err(|error| Error::Option(in_config(&error))),
            (None, None) => Ok(Config::default()),
        };
        let mut config = config.map_err(|error| exception(&error))?;
        if let Some(name) = variant {
            config.tracker.variant = Variant::from_name(name).ok_or_else(|| {
                let names = Variant::ALL.map(|variant| variant.traits().name).join(", ");
                wrong("variant", &format!("has to be one of {names}, not `{name}`"))
            })?;
        }
        if let Some(count) = particles {
            if !(1..=MAX_PARTICLES).contains(&count) {
                return Err(wrong("particles", &format!("has to be from 1 to {MAX_PARTICLES}, not {count}")));
            }
            config.tracker.particles = count;
        }
        Ok(config)
    }

    /// Whether a face may be known.
    pub fn knows_faces(&self) -> bool {
        self.options.face != FaceSource::Unknown
    }

    /// A tracker before its first frame.
    pub fn stream(&self, size_px: (u32, u32)) -> PyResult<ArmStream> {
        let Some(skin) = &self.skin else { return Err(wrong("skin", "is missing")) };
        ArmStream::new(self.options.clone(), skin.clone(), size_px).map_err(|error| exception(&error))
    }

    /// What [`saved_setup`] wrote.
    pub fn restored(json: &Value) -> PyResult<Self> {
        let text = |name: &str| json[name].as_str().unwrap_or_default();
        let number = |name: &str| json[name].as_u64().unwrap_or_default();
        let config = Config::parse_json(&json["config"].to_string()).map_err(|error| exception(&error))?;
        let rectangle = json["calibrate"].as_array().map(|sides| {
            let side = |index: usize| sides.get(index).and_then(Value::as_u64).unwrap_or(1) as u32;
            Rectangle { x_px: side(0), y_px: side(1), width_px: side(2), height_px: side(3) }
        });
        let rate_hz = json["rate_hz"].as_f64().unwrap_or_default();
        let names = ["side", "front_end", "face"].map(text);
        let setup = Self::new(names, rate_hz, number("seed"), rectangle, config)?;
        let skin = model_file::parse(text("skin")).map_err(|error| exception(&error))?;
        Ok(Self { skin: Some(skin), ..setup })
    }
}

/// An error of a configuration that is no file.
fn in_config(error: &Error) -> String {
    format!("`config`: {}", error.chain())
}

/// The text of a saved tracker.
pub fn json(text: &str) -> PyResult<Value> {
    serde_json::from_str(text).map_err(|error| exception(&error.into()))
}

/// The set-up with the state of the stream: next frame, time of the last one, whether there are
/// times, and whether hands and faces are known to be in pixels.
pub fn saved_setup(
    setup: &ArmSetup,
    size_px: Option<(u32, u32)>,
    state: Option<&str>,
    (next, last_us, is_timed, has_pixels): (usize, Option<u64>, bool, [bool; 2]),
) -> Result<String> {
    let options = &setup.options;
    let skin = setup.skin.as_ref().map(model_file::to_json).transpose()?;
    let json = serde_json::json!({
        "side": options.side,
        "front_end": options.front_end,
        "face": setup.face,
        "rate_hz": options.rate_hz,
        "seed": options.seed,
        "calibrate": options.calibrate.map(|r| [r.x_px, r.y_px, r.width_px, r.height_px]),
        "config": options.config,
        "skin": skin,
        "size_px": size_px,
        "state": state,
        "next": next,
        "last_us": last_us,
        "is_timed": is_timed,
        "has_pixels": has_pixels,
    });
    Ok(json.to_string())
}
