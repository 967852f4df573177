//! A body's 17 joints over time, from any motion file, before a camera.

use super::joints::{BodyJoints, BodySources};
use super::placing::Placement;
use crate::cyclic::projection::upwards;
use crate::motion::joint_names::JointSources;
use crate::motion::{self, ReadOptions};
use anyhow::{Context, Result, ensure};
use sinew_core::skeleton::full_body::BODY_BONES;
use std::path::Path;

/// Joints of a body over time in camera axes, metres.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyRecording {
    /// Frames in a second.
    pub rate_hz: f32,
    /// The ends of the bones in each frame, in the order of `BODY_JOINT_NAMES`; `None` where one was not recorded.
    pub joints_m: Vec<BodyJoints>,
}

/// How a motion file becomes a recording.
#[derive(Debug, Clone)]
pub struct BodyRecordingOptions<'a> {
    /// Skeleton of an AMC file; the only .asf of its folder where there is none.
    pub skeleton: Option<&'a Path>,
    /// Frames in a second of a file that does not say, or says wrong.
    pub input_rate_hz: Option<f32>,
    /// Frames in a second of the recording.
    pub rate_hz: f32,
    /// The part that is used, seconds from the beginning; all of it where there is none.
    pub between_s: Option<(f32, f32)>,
    /// Where the person is put.
    pub placement: Placement,
}

/// Frames in a second of a stereo camera where nobody says another number.
pub const DEFAULT_RATE_HZ: f32 = 15.0;
/// Most frames that are made; more is taken for a mistake in a rate.
const MOST_FRAMES: f32 = 1.0e6;
/// How near to a recorded frame a time counts as that frame, frames.
const SAME_FRAME: f32 = 1.0e-3;

impl Default for BodyRecordingOptions<'_> {
    fn default() -> Self {
        Self {
            skeleton: None,
            input_rate_hz: None,
            rate_hz: DEFAULT_RATE_HZ,
            between_s: None,
            placement: Placement::default(),
        }
    }
}

impl BodyRecording {
    /// Reads a .bvh, .amc, .txt of exponential maps, .trc or .c3d.
    ///
    /// # Errors
    /// Names the file and the line, joint or rate that cannot be used.
    pub fn read(path: &Path, options: &BodyRecordingOptions<'_>) -> Result<Self> {
        let read =
            ReadOptions { skeleton: options.skeleton, frames_per_second: options.input_rate_hz, metres_per_unit: None };
        let motion = motion::read_space(path, &read)?;
        let figure = JointSources::find(&motion.names, false, path)?.of_motion(&motion);
        let up = upwards(&figure, None).with_context(|| format!("`{}` cannot be placed", path.display()))?;
        let joints_m = BodySources::find(&motion.names, path)?.of_motion(&motion);
        let recorded = Self { rate_hz: motion.frames_per_second, joints_m };
        let mut recording = recorded.resampled(options.rate_hz)?;
        if let Some((start_s, end_s)) = options.between_s {
            recording = recording.between(start_s, end_s);
            ensure!(
                !recording.joints_m.is_empty(),
                "`{}` has no frame from {start_s} to {end_s} seconds",
                path.display()
            );
        }
        ensure!(
            options.placement.place(&mut recording.joints_m, up),
            "`{}` shows both hips in no frame; they say where the person faces",
            path.display()
        );
        Ok(recording)
    }

    /// The same motion at `rate_hz`: each joint on the line between the two frames nearest in time; missing where one of
    /// them misses it. No low-pass filter: a camera, too, samples instants.
    ///
    /// # Errors
    /// Both rates have to be greater than zero and give at most a million frames.
    pub fn resampled(&self, rate_hz: f32) -> Result<Self> {
        for rate in [self.rate_hz, rate_hz] {
            ensure!(rate > 0.0 && rate.is_finite(), "the rate {rate} has to be greater than zero");
        }
        let step = self.rate_hz / rate_hz;
        let Some(last) = self.joints_m.len().checked_sub(1) else { return Ok(Self { rate_hz, joints_m: Vec::new() }) };
        let count = (last as f32 / step + SAME_FRAME).floor() + 1.0;
        ensure!(count <= MOST_FRAMES, "the rate {rate_hz} gives {count} frames; at most {MOST_FRAMES} are made");
        let at = |index: usize| {
            // In double precision: a long recording has more frames than single precision has places.
            let place = index as f64 * f64::from(self.rate_hz) / f64::from(rate_hz);
            let nearest = place.round();
            let before = (place.floor() as usize).min(last);
            let share = (place - before as f64) as f32;
            if (place - nearest).abs() < f64::from(SAME_FRAME) {
                return self.joints_m[(nearest as usize).min(last)];
            }
            let (a, b) = (&self.joints_m[before], &self.joints_m[(before + 1).min(last)]);
            std::array::from_fn::<_, BODY_BONES, _>(|bone| Some(a[bone]? * (1.0 - share) + b[bone]? * share))
        };
        Ok(Self { rate_hz, joints_m: (0..count as usize).map(at).collect() })
    }

    /// The part from `start_s` to `end_s` seconds; empty where the recording has nothing there.
    #[must_use]
    pub fn between(&self, start_s: f32, end_s: f32) -> Self {
        let frame = |time_s: f32| ((time_s * self.rate_hz).round().max(0.0) as usize).min(self.joints_m.len());
        let (start, end) = (frame(start_s), frame(end_s));
        Self { rate_hz: self.rate_hz, joints_m: self.joints_m[start..end.max(start)].to_vec() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::math::Vec3;

    fn moving(frames: usize) -> BodyRecording {
        let joints_m = (0..frames).map(|frame| [Some(Vec3::new(frame as f32, 0.0, 3.0)); BODY_BONES]).collect();
        BodyRecording { rate_hz: 120.0, joints_m }
    }

    #[test]
    fn joints_lie_on_the_line_between_frames_and_gaps_stay() {
        let mut recorded = moving(100);
        recorded.joints_m[50][3] = None;
        let seen = recorded.resampled(50.0).unwrap();
        assert_eq!(seen.joints_m.len(), 42);
        for (index, joints) in seen.joints_m.iter().enumerate() {
            let x = joints[4].unwrap().x;
            assert!((x - 2.4 * index as f32).abs() < 1.0e-3, "{index}: {x}");
            let touches = (49.01..50.99).contains(&(2.4 * index as f32));
            assert_eq!(joints[3].is_none(), touches, "{index}");
        }
        assert_eq!(recorded.resampled(120.0).unwrap(), recorded);
        assert_eq!(recorded.between(0.25, 0.5).joints_m.len(), 30);
        assert!(recorded.between(7.0, 2.0).joints_m.is_empty());
    }

    #[test]
    fn rates_that_are_none_are_refused() {
        for rate in [0.0, -1.0, f32::NAN, 1.0e9] {
            assert!(moving(3).resampled(rate).is_err(), "{rate}");
        }
    }
}
