//! The motion before a stereo camera: a file, or one that is built in.

use super::hidden::Hidden;
use super::pelvic_lift::pelvic_lift;
use super::stick_wave::{StickEnds, stick_wave};
use crate::body::recording::DEFAULT_RATE_HZ;
use crate::body::{BodyRecording, BodyRecordingOptions, Placement, RecordedBody};
use crate::error::{Result, ensure_option};
use std::path::PathBuf;

/// Name of the built-in motion with a stick.
pub const STICK_WAVE: &str = "stick-wave";
/// Name of the built-in motion of a person who lies.
pub const PELVIC_LIFT: &str = "pelvic-lift";

/// Which motion, and where it is put before the camera.
#[derive(Debug, Clone, PartialEq)]
pub struct StereoSource {
    /// A file, or [`STICK_WAVE`] or [`PELVIC_LIFT`].
    pub motion: PathBuf,
    /// Skeleton of an AMC motion; the only .asf beside it where there is none.
    pub skeleton: Option<PathBuf>,
    /// Frames per second of a motion file that does not say.
    pub motion_rate_hz: Option<f32>,
    /// Part of the motion that is used, seconds from its beginning.
    pub between_s: Option<(f32, f32)>,
    /// Take a motion with fewer frames than its header promises.
    pub partial: bool,
    /// Mean distance of the pelvis from the camera, metres; larger if the person would come too
    /// near or leave the picture.
    pub distance_m: f32,
    /// Turn of the person to their left, degrees; 0 faces the camera on the mean.
    pub heading_deg: f32,
    /// Frames per second of the camera.
    pub rate_hz: f32,
    /// Seed of the stick's motion.
    pub seed: u64,
}

impl Default for StereoSource {
    fn default() -> Self {
        Self {
            motion: PathBuf::from(STICK_WAVE),
            skeleton: None,
            motion_rate_hz: None,
            between_s: None,
            partial: false,
            distance_m: Placement::default().mean_distance_m,
            heading_deg: 0.0,
            rate_hz: DEFAULT_RATE_HZ,
            seed: 1,
        }
    }
}

/// A motion before the camera.
#[derive(Debug, Clone)]
pub struct StereoMotion {
    /// The person's joints.
    pub recording: BodyRecording,
    /// The ends of a stick in each frame.
    pub stick_m: Option<Vec<StickEnds>>,
    /// The floor, camera axes, metres.
    pub floor_y_m: f32,
    /// What a user should know of the motion, one sentence each.
    pub notes: Vec<String>,
}

impl StereoSource {
    /// Reads or draws the motion.
    ///
    /// # Errors
    /// An option out of range, a motion that cannot be read.
    pub fn read(&self) -> Result<StereoMotion> {
        let placement = self.placement()?;
        let floor_y_m = placement.camera_height_m;
        let drawn = |recording, stick_m| StereoMotion { recording, stick_m, floor_y_m, notes: Vec::new() };
        let built_in = self.motion.to_str().filter(|name| [STICK_WAVE, PELVIC_LIFT].contains(name));
        let Some(name) = built_in else { return self.recorded(placement) };
        let is_plain = self.skeleton.is_none() && self.motion_rate_hz.is_none() && self.between_s.is_none();
        ensure_option!(
            is_plain && self.heading_deg == 0.0,
            "--skeleton, --motion-rate, --between and --heading are for motion files; leave them out"
        );
        if name == STICK_WAVE {
            let wave = stick_wave(self.seed, self.rate_hz, floor_y_m, self.distance_m)?;
            return Ok(drawn(wave.recording, Some(wave.stick_m)));
        }
        Ok(drawn(pelvic_lift(self.rate_hz, floor_y_m, self.distance_m)?, None))
    }

    fn recorded(&self, placement: Placement) -> Result<StereoMotion> {
        let floor_y_m = placement.camera_height_m;
        let options = BodyRecordingOptions {
            skeleton: self.skeleton.as_deref(),
            input_rate_hz: self.motion_rate_hz,
            rate_hz: self.rate_hz,
            between_s: self.between_s,
            placement,
            partial: self.partial,
        };
        let RecordedBody { recording, shortfall, .. } = BodyRecording::read_with_markers(&self.motion, &options)?;
        let notes = shortfall.iter().map(ToString::to_string).collect();
        Ok(StereoMotion { recording, stick_m: None, floor_y_m, notes })
    }

    fn placement(&self) -> Result<Placement> {
        let Self { rate_hz, distance_m, .. } = *self;
        ensure_option!(rate_hz > 0.0 && rate_hz.is_finite(), "--rate has to be greater than zero, not {rate_hz}");
        ensure_option!(rate_hz <= 1000.0, "--rate has to be at most 1000 Hz, not {rate_hz}");
        ensure_option!(
            (1.0..=20.0).contains(&distance_m),
            "--distance has to be from 1 to 20 metres, not {distance_m}"
        );
        let default = Placement::default();
        let heading_rad = self.heading_deg.to_radians();
        ensure_option!(heading_rad.is_finite(), "--heading has to be finite");
        Ok(Placement {
            mean_distance_m: distance_m,
            least_distance_m: default.least_distance_m.min(distance_m),
            heading_rad,
            ..default
        })
    }
}

impl StereoMotion {
    /// Refuses limbs that are hidden in frames that there are not.
    ///
    /// # Errors
    /// Names the frame and the last one.
    pub fn check_hidden(&self, hidden: &[Hidden]) -> Result<()> {
        let frames = self.recording.joints_m.len();
        for hidden in hidden {
            let last = hidden.frames.end();
            ensure_option!(*last < frames, "--hide names frame {last}; the last one is {}", frames.saturating_sub(1));
        }
        Ok(())
    }
}
