//! The motions that an evaluation is given: files, parts of files, and the built-in ones.

use super::trial::SeenMotion;
use anyhow::{Context, Result, bail, ensure};
use sinew::body::recording::{DEFAULT_RATE_HZ, MarkerFrames};
use sinew::body::{BodyPart, BodyRecording, BodyRecordingOptions, Placement};
use sinew::motion::{Shortfall, asf, needs_skeleton};
use sinew::stereo::{Hidden, StereoOptions, StereoScene, pelvic_lift, stick_wave};
use sinew_core::pik::processes::stick::StickSight;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// A motion by name.
#[derive(Debug, Clone, PartialEq)]
pub enum MotionChoice {
    /// A person who moves a stick with both hands.
    StickWave,
    /// Six pelvic lifts.
    PelvicLift,
    /// A file, or a part of it in seconds.
    File {
        /// The file.
        path: PathBuf,
        /// First and last second.
        between_s: Option<(f32, f32)>,
    },
}

impl FromStr for MotionChoice {
    type Err = String;

    /// `FILE`, `FILE@START-END` with seconds, `stick-wave` or `pelvic-lift`.
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "stick-wave" => return Ok(Self::StickWave),
            "pelvic-lift" => return Ok(Self::PelvicLift),
            _ => {}
        }
        let whole = || Self::File { path: PathBuf::from(text), between_s: None };
        let Some((path, part)) = text.rsplit_once('@') else { return Ok(whole()) };
        let Some((start, end)) = part.split_once('-') else { return Ok(whole()) };
        match (start.parse::<f32>(), end.parse::<f32>()) {
            (Ok(start), Ok(end)) if start >= 0.0 && end > start => {
                Ok(Self::File { path: PathBuf::from(path), between_s: Some((start, end)) })
            }
            _ => Err(format!("`@{part}` has to be @START-END in seconds, as @2-7.5")),
        }
    }
}

impl MotionChoice {
    /// Its name in tables: the file's name, or the built-in's.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::StickWave => "stick-wave".into(),
            Self::PelvicLift => "pelvic-lift".into(),
            Self::File { path, between_s } => {
                let file = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
                between_s.map_or_else(|| file.to_string(), |(start, end)| format!("{file}@{start}-{end}"))
            }
        }
    }

    /// Reads the motion, once for all seeds; `skeleton` is for .amc files without one beside them.
    ///
    /// # Errors
    /// A file that cannot be read, by name.
    pub fn read(&self, skeleton: Option<&Path>) -> Result<ReadMotion> {
        self.read_turned(skeleton, 0.0, false)
    }

    /// As [`Self::read`], the person of a file turned to their left by `heading_rad`. With
    /// `partial` a file may have fewer frames than its header promises.
    ///
    /// # Errors
    /// As [`Self::read`]; a turn of a built-in motion.
    pub fn read_turned(&self, skeleton: Option<&Path>, heading_rad: f32, partial: bool) -> Result<ReadMotion> {
        let placement = Placement { heading_rad, ..Placement::default() };
        let is_file = matches!(self, Self::File { .. });
        ensure!(is_file || heading_rad == 0.0, "--heading is for motion files; `{}` is built in", self.name());
        let (mut markers_m, mut shortfall) = (Vec::new(), None);
        let recording = match self {
            Self::StickWave => return Ok(ReadMotion { name: self.name(), recording: None, markers_m, shortfall }),
            Self::PelvicLift => pelvic_lift(DEFAULT_RATE_HZ, placement.camera_height_m, placement.mean_distance_m)?,
            Self::File { path, between_s } => {
                let skeleton = skeleton.filter(|_| needs_skeleton(path) && asf::beside(path).is_err());
                let between_s = *between_s;
                let options =
                    BodyRecordingOptions { skeleton, between_s, placement, partial, ..BodyRecordingOptions::default() };
                let read = BodyRecording::read_with_markers(path, &options)?;
                (markers_m, shortfall) = (read.markers_m, read.shortfall);
                read.recording
            }
        };
        let frames = recording.joints_m.len();
        if frames < 2 {
            bail!("`{}` has {frames} frames; tracking needs two", self.name());
        }
        Ok(ReadMotion { name: self.name(), recording: Some(recording), markers_m, shortfall })
    }

    /// The motion as the simulated stereo camera sees all of it with `seed`.
    ///
    /// # Errors
    /// As [`Self::read`] and [`ReadMotion::seen`].
    pub fn seen(&self, skeleton: Option<&Path>, seed: u64) -> Result<SeenMotion> {
        self.read(skeleton)?.seen(BodyPart::Whole, seed)
    }
}

/// A motion that was read.
#[derive(Debug, Clone)]
pub struct ReadMotion {
    name: String,
    /// None of the person with the stick, whose motion differs by the seed.
    recording: Option<BodyRecording>,
    /// Of a .c3d; else empty.
    markers_m: MarkerFrames,
    /// How many frames of the file are missing, if some are.
    shortfall: Option<Shortfall>,
}

impl ReadMotion {
    /// What a user should know of the file.
    #[must_use]
    pub fn note(&self) -> Option<String> {
        self.shortfall.map(|shortfall| format!("`{}`: {shortfall}", self.name))
    }

    /// The motion as the simulated stereo camera sees `part` of it with `seed`.
    ///
    /// # Errors
    /// A motion that makes no scene, by name.
    pub fn seen(&self, part: BodyPart, seed: u64) -> Result<SeenMotion> {
        self.seen_hiding(part, seed, &[])
    }

    /// As [`Self::seen`], without points on the limbs that are `hidden`.
    ///
    /// # Errors
    /// As [`Self::seen`]; a hidden frame that the motion does not have.
    pub fn seen_hiding(&self, part: BodyPart, seed: u64, hidden: &[Hidden]) -> Result<SeenMotion> {
        self.seen_as(StereoOptions { seed, part, hidden: hidden.to_vec(), ..StereoOptions::default() })
    }

    /// The motion in the scene that `options` describe.
    ///
    /// # Errors
    /// As [`Self::seen_hiding`].
    pub fn seen_as(&self, options: StereoOptions) -> Result<SeenMotion> {
        let StereoOptions { seed, part, .. } = options;
        let placement = Placement::default();
        let (height_m, distance_m) = (placement.camera_height_m, placement.mean_distance_m);
        let (recording, stick) = match &self.recording {
            Some(recording) => (recording.clone(), Vec::new()),
            None => {
                let wave = stick_wave(seed, DEFAULT_RATE_HZ, height_m, distance_m)?;
                (wave.recording, wave.stick_m.iter().map(|ends| StickSight::Ends(*ends)).collect())
            }
        };
        let frames = recording.joints_m.len();
        for last in options.hidden.iter().map(|hidden| *hidden.frames.end()) {
            ensure!(last < frames, "`{}` has no frame {last} to hide; the last one is {}", self.name, frames - 1);
        }
        let scene = StereoScene::new(recording, options).with_context(|| format!("`{}` makes no scene", self.name))?;
        // The count does not separate an upper body from the legs.
        let recorded_markers_m = if part == BodyPart::Whole { self.markers_m.clone() } else { Vec::new() };
        Ok(SeenMotion { stick, recorded_markers_m, floor_y_m: height_m, ..SeenMotion::of_scene(&scene)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_files_are_named_by_seconds() {
        let part: MotionChoice = "a/b@c.bvh@2-7.5".parse().unwrap();
        assert_eq!(part, MotionChoice::File { path: "a/b@c.bvh".into(), between_s: Some((2.0, 7.5)) });
        assert_eq!(part.name(), "b@c.bvh@2-7.5");
        assert_eq!("pelvic-lift".parse(), Ok(MotionChoice::PelvicLift));
        assert!("x.bvh@7-2".parse::<MotionChoice>().unwrap_err().contains("START-END"));
        assert_eq!("x@y.bvh".parse::<MotionChoice>().unwrap().name(), "x@y.bvh");
    }
}
