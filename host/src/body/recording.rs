//! A body's 17 joints over time, from any motion file, before a camera.

use super::joints::{BodyJoints, BodySources};
use super::placing::Placement;
use crate::cyclic::projection::upwards;
use crate::error::{Context, Result, ensure};
use crate::motion::joint_names::JointSources;
use crate::motion::markers::MarkerMotion;
use crate::motion::{self, ReadOptions, Shortfall, has_skin_markers};
use sinew_core::math::Vec3;
use sinew_core::skeleton::full_body::BODY_BONES;
use std::ops::Range;
use std::path::Path;

/// Joints of a body over time in camera axes, metres.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyRecording {
    /// Frames in a second.
    pub rate_hz: f32,
    /// The ends of the bones in each frame, in the order of `BODY_JOINT_NAMES`; `None` where one
    /// was not recorded.
    pub joints_m: Vec<BodyJoints>,
}

/// Places of markers in each frame, metres.
pub type MarkerFrames = Vec<Vec<Option<Vec3>>>;

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
    /// Take a motion with fewer frames than its header promises; an error if not.
    pub partial: bool,
}

/// What a motion file gives.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedBody {
    /// The joints.
    pub recording: BodyRecording,
    /// The markers of each frame: those of a .c3d whose name does not begin with `*`, as an
    /// unlabelled one's does. Other files have joints, not markers.
    pub markers_m: MarkerFrames,
    /// How many frames of the file are missing, if some are.
    pub shortfall: Option<Shortfall>,
}

/// Frames in a second of a stereo camera by default.
pub const DEFAULT_RATE_HZ: f32 = 15.0;
/// Maximum number of frames that are made; more is taken for a mistake in a rate.
const MAX_FRAMES: f32 = 1.0e6;
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
            partial: false,
        }
    }
}

impl BodyRecording {
    /// Reads any motion in space.
    ///
    /// # Errors
    /// Names the file and the line, joint or rate that cannot be used.
    pub fn read(path: &Path, options: &BodyRecordingOptions<'_>) -> Result<Self> {
        Ok(Self::read_with_markers(path, options)?.recording)
    }

    /// As [`Self::read`], with the markers of each frame.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_with_markers(path: &Path, options: &BodyRecordingOptions<'_>) -> Result<RecordedBody> {
        let read = ReadOptions {
            skeleton: options.skeleton,
            frames_per_second: options.input_rate_hz,
            partial: options.partial,
            ..ReadOptions::default()
        };
        let motion = motion::read_space(path, &read)?;
        let figure = JointSources::find(&motion.names, false, path)?.of_motion(&motion);
        let up = upwards(&figure, None).with_context(|| format!("`{}` cannot be placed", path.display()))?;
        let joints_m = BodySources::find(&motion.names, path)?.of_motion(&motion);
        let recorded = Self { rate_hz: motion.frames_per_second, joints_m };
        let mut recording = recorded.resampled(options.rate_hz)?;
        let mut markers_m =
            resampled(&labelled(path, &motion), motion.frames_per_second, options.rate_hz, |a, b, share| {
                a.iter().zip(b).map(|(a, b)| Some((*a)? * (1.0 - share) + (*b)? * share)).collect()
            });
        if let Some((start_s, end_s)) = options.between_s {
            let kept = recording.frames_between(start_s, end_s);
            markers_m = markers_m.get(kept).unwrap_or(&[]).to_vec();
            recording = recording.between(start_s, end_s);
            ensure!(
                !recording.joints_m.is_empty(),
                "`{}` has no frame from {start_s} to {end_s} seconds",
                path.display()
            );
        }
        let placed = options.placement.motion(&recording.joints_m, up);
        let placed = placed.with_context(|| {
            format!("`{}` shows both hips in no frame; they say where the person faces", path.display())
        })?;
        for place in recording.joints_m.iter_mut().flatten().chain(markers_m.iter_mut().flatten()).flatten() {
            *place = placed.apply(place);
        }
        Ok(RecordedBody { recording, markers_m, shortfall: motion.shortfall })
    }

    /// The same motion at `rate_hz`: each joint on the line between the two frames nearest in time;
    /// missing where one of them misses it. No low-pass filter: a camera, too, samples
    /// instants.
    ///
    /// # Errors
    /// Both rates have to be greater than zero and give at most a million frames.
    pub fn resampled(&self, rate_hz: f32) -> Result<Self> {
        for rate in [self.rate_hz, rate_hz] {
            ensure!(rate > 0.0 && rate.is_finite(), "the rate {rate} has to be greater than zero");
        }
        let frames = self.joints_m.len() as f32 * rate_hz / self.rate_hz;
        ensure!(frames <= MAX_FRAMES, "the rate {rate_hz} gives {frames} frames; at most {MAX_FRAMES} are made");
        let joints_m = resampled(&self.joints_m, self.rate_hz, rate_hz, |a, b, share| {
            std::array::from_fn::<_, BODY_BONES, _>(|bone| Some(a[bone]? * (1.0 - share) + b[bone]? * share))
        });
        Ok(Self { rate_hz, joints_m })
    }

    /// The part from `start_s` to `end_s` seconds; empty where the recording has nothing there.
    #[must_use]
    pub fn between(&self, start_s: f32, end_s: f32) -> Self {
        Self { rate_hz: self.rate_hz, joints_m: self.joints_m[self.frames_between(start_s, end_s)].to_vec() }
    }

    fn frames_between(&self, start_s: f32, end_s: f32) -> Range<usize> {
        let frame = |time_s: f32| ((time_s * self.rate_hz).round().max(0.0) as usize).min(self.joints_m.len());
        frame(start_s)..frame(end_s).max(frame(start_s))
    }
}

/// `frames` of one rate at another one: each time is the frame there, or what `mix` makes of the
/// two nearest.
fn resampled<T: Clone>(frames: &[T], from_hz: f32, to_hz: f32, mix: impl Fn(&T, &T, f32) -> T) -> Vec<T> {
    let Some(last) = frames.len().checked_sub(1) else { return Vec::new() };
    let count = (last as f32 / (from_hz / to_hz) + SAME_FRAME).floor() + 1.0;
    let at = |index: usize| {
        // In double precision: a long recording has more frames than single precision has places.
        let place = index as f64 * f64::from(from_hz) / f64::from(to_hz);
        let nearest = place.round();
        let before = (place.floor() as usize).min(last);
        if (place - nearest).abs() < f64::from(SAME_FRAME) {
            return frames[(nearest as usize).min(last)].clone();
        }
        mix(&frames[before], &frames[(before + 1).min(last)], (place - before as f64) as f32)
    };
    (0..count as usize).map(at).collect()
}

/// The markers of a .c3d with a name.
fn labelled(path: &Path, motion: &MarkerMotion) -> MarkerFrames {
    if !has_skin_markers(path) {
        return Vec::new();
    }
    let has_name: Vec<bool> = motion.names.iter().map(|name| !name.starts_with('*') && !name.is_empty()).collect();
    let of_frame = |row: &Vec<Option<Vec3>>| {
        row.iter().zip(&has_name).filter(|(_, has_name)| **has_name).map(|(place, _)| *place).collect()
    };
    motion.positions_m.iter().map(of_frame).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn markers_are_the_named_points_of_a_c3d() {
        let positions_m =
            vec![vec![None, Some(Vec3::x()), Some(Vec3::y())], vec![Some(Vec3::z()), None, Some(Vec3::y())]];
        let names = ["*0", "Someone:LFHD", "LSHO"].map(str::to_owned).to_vec();
        let motion = MarkerMotion { frames_per_second: 120.0, names, positions_m, ..MarkerMotion::default() };
        let markers_m = labelled(Path::new("a/take.C3D"), &motion);
        assert_eq!(markers_m, [vec![Some(Vec3::x()), Some(Vec3::y())], vec![None, Some(Vec3::y())]]);
        assert!(labelled(Path::new("take.trc"), &motion).is_empty());
    }

    #[test]
    fn rates_that_are_none_are_refused() {
        for rate in [0.0, -1.0, f32::NAN, 1.0e9] {
            assert!(moving(3).resampled(rate).is_err(), "{rate}");
        }
    }
}
