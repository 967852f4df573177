//! Writes a scene as a folder: the points of each frame, the truth, who is seen, and the first
//! pose.

use super::camera::StereoCamera;
use super::hidden::Hidden;
use super::scene::StereoScene;
use super::scene_errors::SceneErrors;
use super::stick_file::stick_csv;
use super::stick_wave::StickEnds;
use super::truth::truth_csv;
use crate::body::pose_file::pose_json;
use crate::body::{BodyFile, BodyPart};
use crate::cloud::write_ply;
use crate::error::Result;
use crate::output::OutputDir;
use rayon::prelude::*;
use serde::Serialize;

/// Version of `run.json`.
const REPORT_VERSION: u32 = 1;

/// What `run.json` says of a scene.
#[derive(Debug, Clone, Serialize)]
pub struct StereoReport<'a> {
    /// Version of this file.
    pub version: u32,
    /// Version of the program.
    pub sinew_version: &'static str,
    /// Whether all files are there; it is written last.
    pub complete: bool,
    /// The motion: a file's path or a built-in name.
    pub motion: &'a str,
    /// Seed of all that is random.
    pub seed: u64,
    /// Number of frames.
    pub frames: usize,
    /// Frames in a second.
    pub rate_hz: f32,
    /// The camera.
    pub camera: &'a StereoCamera,
    /// Height of the camera above the floor, metres: the floor is the plane y = this.
    pub floor_y_m: f32,
    /// How much of the body the camera saw.
    pub body: BodyPart,
    /// Points asked for in a frame.
    pub points: usize,
    /// Points found in a frame, the mean.
    pub points_mean: f32,
    /// Share of outliers.
    pub outliers: f32,
    /// Number of missing patches.
    pub patches: u32,
    /// Limbs without points.
    pub hidden: &'a [Hidden],
    /// What else is wrong with the scene.
    pub errors: &'a SceneErrors,
    /// Distance of the first pose's joints from the true ones, the mean, metres.
    pub first_pose_residual_m: f32,
    /// What a user should know of the motion, one sentence each.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    pub notes: &'a [String],
}

impl StereoScene {
    /// Writes `points/000000.ply` and on, `truth.csv`, `body.json`, `first_pose.json`, with a stick
    /// `stick.csv`, and at last `run.json` with the `notes`.
    ///
    /// # Errors
    /// A file that cannot be written, by name.
    pub fn write_folder(
        &self,
        motion: &str,
        floor_y_m: f32,
        stick_m: Option<&[StickEnds]>,
        notes: &[String],
        output: &OutputDir,
    ) -> Result<()> {
        let points = output.begin_series("points")?;
        let counts = (0..self.len())
            .into_par_iter()
            .map(|frame| {
                let cloud = self.points_m(frame);
                points.folder().write_frame(format!("{frame:06}.ply"), |writer| Ok(write_ply(&cloud, writer)?))?;
                Ok(cloud.len())
            })
            .collect::<Result<Vec<usize>>>()?;
        points.finish()?;
        output.write("truth.csv", |writer| Ok(writer.write_all(truth_csv(self).as_bytes())?))?;
        let body = serde_json::to_string_pretty(&BodyFile::from(self.measures()))?;
        output.write("body.json", |writer| Ok(writer.write_all(body.as_bytes())?))?;
        let first = self.first_pose()?;
        output.write("first_pose.json", |writer| Ok(writer.write_all(pose_json(&first.angles).as_bytes())?))?;
        if let Some(stick_m) = stick_m {
            let text = stick_csv(&self.options().camera, stick_m);
            output.write("stick.csv", |writer| Ok(writer.write_all(text.as_bytes())?))?;
        }
        let options = self.options();
        let report = StereoReport {
            version: REPORT_VERSION,
            sinew_version: env!("CARGO_PKG_VERSION"),
            complete: true,
            motion,
            seed: options.seed,
            frames: self.len(),
            rate_hz: self.recording().rate_hz,
            camera: &options.camera,
            floor_y_m,
            body: options.part,
            points: options.points,
            points_mean: counts.iter().sum::<usize>() as f32 / counts.len().max(1) as f32,
            outliers: options.outliers,
            patches: options.patches,
            hidden: &options.hidden,
            errors: &options.errors,
            first_pose_residual_m: first.mean_m(),
            notes,
        };
        let report = serde_json::to_string_pretty(&report)?;
        output.write("run.json", |writer| Ok(writer.write_all(report.as_bytes())?))
    }
}
