//! A body before a stereo camera.

use crate::arrays::{frames_array, points_array};
use crate::body::json_of_measures;
use crate::errors::{exception, in_python, wrong};
use crate::process::detached;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sinew::body::{BodyFile, BodyPart};
use sinew::error::Result;
use sinew::stereo::{Hidden, SceneErrors, StereoMotion, StereoOptions, StereoScene, StereoSource};
use sinew_core::math::Vec3;
use sinew_core::skeleton::full_body::{BODY_ANGLES, BODY_BONES};
use std::path::PathBuf;

/// What is made of a scene.
struct Made {
    scene: StereoScene,
    clouds: Vec<Vec<Vec3>>,
    first_pose: [f32; BODY_ANGLES],
    stick_m: Option<Vec<[Vec3; 2]>>,
    floor_y_m: f32,
    notes: Vec<String>,
}

/// Does what the command `sinew simulate stereo` does.
fn make(source: &StereoSource, options: StereoOptions) -> Result<Made> {
    let motion = source.read()?;
    motion.check_hidden(&options.hidden)?;
    let StereoMotion { recording, stick_m, floor_y_m, notes } = motion;
    let scene = StereoScene::new(recording, options)?;
    let clouds = scene.clouds_m();
    let first_pose = scene.first_pose()?.angles;
    Ok(Made { scene, clouds, first_pose, stick_m, floor_y_m, notes })
}

/// Clouds of a moving body, and what is true of it.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the options of `sinew simulate stereo`")]
pub fn simulate_stereo<'py>(
    py: Python<'py>,
    motion: PathBuf,
    skeleton: Option<PathBuf>,
    motion_rate_hz: Option<f32>,
    between_s: Option<(f32, f32)>,
    partial: bool,
    distance_m: f32,
    heading_deg: f32,
    rate_hz: f32,
    part: &str,
    points: usize,
    outliers: f32,
    patches: u32,
    hide: Vec<String>,
    hard: bool,
    seed: u64,
) -> PyResult<Bound<'py, PyDict>> {
    let part: BodyPart = part.parse().map_err(|rule: String| wrong("part", &rule))?;
    let hidden: Vec<Hidden> = hide
        .iter()
        .map(|text| text.parse().map_err(|rule: String| wrong("hide", &format!("{text:?}: {rule}"))))
        .collect::<PyResult<_>>()?;
    let source =
        StereoSource { motion, skeleton, motion_rate_hz, between_s, partial, distance_m, heading_deg, rate_hz, seed };
    let errors = if hard { SceneErrors::HARD } else { SceneErrors::default() };
    let options = StereoOptions { part, points, outliers, patches, hidden, errors, seed, ..StereoOptions::default() };
    let made = detached(py, || make(&source, options))?.map_err(|error| exception(&error))?;
    answer(py, &made)
}

fn answer<'py>(py: Python<'py>, made: &Made) -> PyResult<Bound<'py, PyDict>> {
    let Made { scene, clouds, first_pose, stick_m, floor_y_m, notes } = made;
    let frames = 0..scene.len();
    let clouds: Vec<Bound<'_, PyArray2<f32>>> = clouds.iter().map(|cloud| points_array(py, cloud)).collect();
    let markers: Vec<Vec<Option<Vec3>>> = frames.map(|frame| scene.markers_m(frame)).collect();
    let named = PyDict::new(py);
    named.set_item("clouds", clouds)?;
    named.set_item("rate_hz", scene.recording().rate_hz)?;
    named.set_item("joints_m", frames_array(py, &scene.recording().joints_m, BODY_BONES))?;
    named.set_item("markers_m", frames_array(py, &markers, markers.first().map_or(0, Vec::len)))?;
    let stick: Option<Vec<[Option<Vec3>; 2]>> =
        stick_m.as_ref().map(|stick| stick.iter().map(|ends| ends.map(Some)).collect());
    named.set_item("stick_m", stick.map(|stick| frames_array(py, &stick, 2)))?;
    named.set_item("first_pose", first_pose.to_vec().into_pyarray(py))?;
    named.set_item("measures_json", json_of_measures(&BodyFile::from(scene.measures()))?)?;
    let camera = serde_json::to_string(&scene.options().camera).map_err(|error| exception(&error.into()))?;
    named.set_item("camera_json", camera)?;
    named.set_item("floor_y_m", floor_y_m)?;
    named.set_item("notes", notes.iter().map(|note| in_python(note)).collect::<Vec<_>>())?;
    Ok(named)
}
