//! A made-up person before a camera.

use crate::errors::{exception, wrong};
use crate::process::detached;
use numpy::ndarray::Array4;
use numpy::{IntoPyArray, PyArray2, PyArray4};
use pyo3::prelude::*;
use sinew::error::{Error, Result};
use sinew::scene::{MotionSource, Scene, SceneOptions};
use sinew::track::SideChoice;
use sinew_core::camera::Camera;
use sinew_core::error::ParameterError;
use sinew_core::skeleton::Side;
use std::path::PathBuf;

/// Most bytes of all frames together.
const MAX_BYTES: usize = 4 << 30;
/// Cells of a row of truth.
const CELLS: usize = 20;

/// Frames, rows of truth, configuration as JSON, what is to be known of the motion.
pub type Filmed<'py> = (Bound<'py, PyArray4<u8>>, Bound<'py, PyArray2<f64>>, String, Vec<String>);

/// Does what `sinew simulate arm` does.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the options of `sinew simulate arm`")]
pub fn simulate_arm<'py>(
    py: Python<'py>,
    motion: PathBuf,
    frames: Option<usize>,
    rate_hz: f64,
    side: &str,
    seed: u64,
    false_blob: f64,
    hidden: f64,
    away: Option<(usize, usize)>,
    noise_std: f64,
) -> PyResult<Filmed<'py>> {
    let side: SideChoice = side.parse().map_err(|rule: String| wrong("side", &rule))?;
    let mut options = SceneOptions {
        frames_per_second: rate_hz as f32,
        seed,
        sides: side.into(),
        false_blob_fraction: false_blob as f32,
        hidden_fraction: hidden as f32,
        away: away.map(|(first, end)| first..end),
        noise_std: noise_std as f32,
        ..SceneOptions::default()
    };
    let film = || -> Result<_> {
        let check_size = |options: &SceneOptions| {
            let frame_bytes = 3 * options.width_px as usize * options.height_px as usize;
            let most = MAX_BYTES / frame_bytes;
            match options.frames {
                count if count > most => Err(Error::Option(format!(
                    "`frames` has to be at most {most}, not {count}; `sinew simulate arm` writes more into a folder"
                ))),
                _ => Ok(()),
            }
        };
        options.frames = frames.unwrap_or(options.frames);
        check_size(&options)?;
        options.validate().map_err(option)?;
        let (motion, shortfall) = MotionSource::of(&motion).motion(seed, options.frames_per_second, frames)?;
        options.frames = frames.unwrap_or_else(|| motion.len());
        check_size(&options)?;
        let scene = Scene::new(&motion, &options).map_err(option)?;
        let config = serde_json::to_string(&scene.config()?)?;
        let notes: Vec<String> = shortfall.iter().map(ToString::to_string).collect();
        Ok((scene.pixels(), truth(&scene), config, notes, scene.len()))
    };
    let (pixels, truth, config, notes, count) = detached(py, film)?.map_err(|error| exception(&error))?;
    let (width, height) = (SceneOptions::default().width_px as usize, SceneOptions::default().height_px as usize);
    let pixels = Array4::from_shape_vec((count, height, width, 3), pixels).unwrap_or_default();
    Ok((pixels.into_pyarray(py), crate::arrays::array(py, truth.into_iter()), config, notes))
}

/// A parameter of a scene that breaks its rule, by its name in Python.
fn option(error: ParameterError) -> Error {
    let names =
        [("frames_per_second", "rate_hz"), ("hidden_fraction", "hidden"), ("false_blob_fraction", "false_blob")];
    Error::Option(names.iter().fold(error.to_string(), |text, (name, python)| text.replace(name, python)))
}

/// The rows of truth.csv as numbers; 1 is the right side.
fn truth(scene: &Scene) -> Vec<[f64; CELLS]> {
    let camera: Camera = scene.camera();
    let mut rows = Vec::new();
    for frame in 0..scene.len() {
        let truth = scene.truth(frame);
        for side in &truth.sides {
            let joints = [side.joints.shoulder_m, side.joints.elbow_m, side.joints.hand_m];
            let mut row = [f64::NAN; CELLS];
            row[0] = truth.frame as f64;
            row[1] = f64::from(truth.time_s);
            row[2] = f64::from(u8::from(side.side == Side::Right));
            for (joint, place_m) in joints.iter().enumerate() {
                for axis in 0..3 {
                    row[3 + 3 * joint + axis] = f64::from(place_m[axis]);
                }
                if let Some(pixel) = camera.project(place_m) {
                    row[12 + 2 * joint] = f64::from(pixel.u_px);
                    row[13 + 2 * joint] = f64::from(pixel.v_px);
                }
            }
            row[18] = f64::from(u8::from(side.hand_visible));
            row[19] = f64::from(u8::from(truth.false_blob));
            rows.push(row);
        }
    }
    rows
}
