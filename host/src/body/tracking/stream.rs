//! A body tracked frame by frame: points, time and a stick go in, an estimate comes out.
//!
//! `sinew track body` steps this type over a folder of clouds. Programs step it as frames come.

use super::filter::{BodyFilter, WholeBodyEstimate};
use super::frame_time::{FrameTime, Moment};
use super::seen_points::SeenPoints;
use super::start::{FirstPose, pose_from_points};
use super::stream_options::BodyStreamOptions;
use crate::body::{BodyFile, BodySize};
use crate::cloud::{MAX_DISTANCE_M, PointCloud, blocks_of};
use crate::error::{Context, Result};
use crate::resume::text_crc32;
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde::{Deserialize, Serialize};
use sinew_core::math::Vec3;
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::skeleton::full_body::BODY_ANGLES;

/// How far a stream has got.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Phase {
    /// No first pose is known.
    Waiting,
    /// It is known, and no frame was answered with it.
    Placed,
    /// At least one frame was answered.
    Tracking,
}

/// Where a stream is: what its options, person and first pose do not say.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StreamState {
    phase: Phase,
    last: Option<Moment>,
    /// The filter.
    tracker: String,
}

/// A stream as text.
#[derive(Debug, Serialize, Deserialize)]
struct SavedStream {
    options: BodyStreamOptions,
    body: BodyFile,
    state: StreamState,
}

/// A frame that was answered.
#[derive(Debug, Clone, PartialEq)]
pub struct StreamedFrame {
    /// Number of the frame.
    pub frame: u64,
    /// Its time, seconds.
    pub time_s: f64,
    /// The estimate; `None` where no first pose is given and no point was seen yet.
    pub estimate: Option<WholeBodyEstimate>,
    /// Points that were weighed.
    pub points: usize,
    /// Points that are none.
    pub skipped: usize,
    /// Points left out by chance.
    pub over_cap: usize,
}

/// One body, tracked frame by frame.
///
/// ```
/// use sinew::body::tracking::{BodyStream, BodyStreamOptions, FrameTime};
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::processes::stick::StickSight;
/// use sinew_core::skeleton::BodyMeasures;
///
/// let options = BodyStreamOptions { particles: 10, ..BodyStreamOptions::default() };
/// let mut stream = BodyStream::new(options, BodyMeasures::of_height(1.75)?, None)?;
/// let unseen = stream.update([], FrameTime::Next, StickSight::Unseen)?;
/// assert!(unseen.estimate.is_none(), "nothing says where the person is");
/// let points = (0..100).map(|index| Vec3::new(0.0, 0.01 * index as f32 - 0.5, 2.9));
/// let seen = stream.update(points, FrameTime::Next, StickSight::Unseen)?;
/// assert_eq!((seen.frame, seen.points), (1, 100));
/// assert!(seen.estimate.is_some());
/// # Ok::<(), sinew::Error>(())
/// ```
#[derive(Debug)]
pub struct BodyStream {
    options: BodyStreamOptions,
    size: BodySize,
    filter: BodyFilter,
    threads: ThreadPool,
    phase: Phase,
    last: Option<Moment>,
}

impl BodyStream {
    /// A stream of a person of that size. Without a first pose it is found in the first points.
    ///
    /// # Errors
    /// Names the option or number that broke a rule.
    pub fn new(
        options: BodyStreamOptions,
        size: impl Into<BodySize>,
        first_rad: Option<[f32; BODY_ANGLES]>,
    ) -> Result<Self> {
        options.check()?;
        let size = size.into();
        let filter = filter(&options, &size, first_rad.unwrap_or([0.0; BODY_ANGLES]))?;
        let threads = threads(&options)?;
        let phase = if first_rad.is_some() { Phase::Placed } else { Phase::Waiting };
        Ok(Self { options, size, filter, threads, phase, last: None })
    }

    /// How it was made.
    #[must_use]
    pub const fn options(&self) -> &BodyStreamOptions {
        &self.options
    }

    /// The person.
    #[must_use]
    pub const fn size(&self) -> &BodySize {
        &self.size
    }

    /// The filter with its particles.
    #[must_use]
    pub const fn filter(&self) -> &BodyFilter {
        &self.filter
    }

    /// The first pose, where it is known and no frame was answered.
    #[must_use]
    pub fn first_rad(&self) -> Option<[f32; BODY_ANGLES]> {
        (self.phase == Phase::Placed).then(|| self.filter.before_deadband().0)
    }

    /// Goes on with a person of that size.
    ///
    /// # Errors
    /// Lengths that no body has.
    pub fn resize(&mut self, size: &BodySize) -> Result<()> {
        self.filter.resize(size)?;
        self.size = *size;
        Ok(())
    }

    /// Number of the last frame; `None` before the first one.
    #[must_use]
    pub fn frame(&self) -> Option<u64> {
        self.last.map(|last| last.frame)
    }

    /// Starts the threads anew, in a process that was forked from the one in which they run.
    ///
    /// # Errors
    /// The system starts no more threads.
    pub fn renew_threads(&mut self) -> Result<()> {
        // Threads that are not there cannot be told to end.
        std::mem::forget(std::mem::replace(&mut self.threads, threads(&self.options)?));
        Ok(())
    }

    /// Runs `work` on the threads of the stream.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.threads.install(work)
    }

    /// The points of a frame as [`Self::step`] takes them. Frames may be prepared in any order.
    #[must_use]
    pub fn seen(&self, cloud: PointCloud, frame: u64) -> SeenPoints {
        let BodyStreamOptions { max_points, seed, .. } = self.options;
        SeenPoints::new(cloud, max_points, (seed, frame), self.filter.smoothing())
    }

    /// Finds the first pose in these points: someone who stands or walks is fitted to
    /// them. Without points they stand 3 m before the camera. The answer has the pose, and whether
    /// the points decide where the person faces.
    ///
    /// # Errors
    /// Numbers that broke a rule.
    pub fn begin_from(&mut self, points_m: &[Vec3]) -> Result<FirstPose> {
        let BodyStreamOptions { part, tuning, .. } = &self.options;
        let blocks = blocks_of(&mut points_m.to_vec(), tuning.range_smoothing()?.as_ref());
        let first = pose_from_points(*part, &self.size, &tuning.guided_points, points_m, &blocks)?;
        self.filter = filter(&self.options, &self.size, first.angles_rad)?;
        self.phase = Phase::Placed;
        Ok(first)
    }

    /// Answers a frame: prepares its points and steps.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn update(
        &mut self,
        points_m: impl IntoIterator<Item = Vec3>,
        when: FrameTime,
        stick: StickSight,
    ) -> Result<StreamedFrame> {
        let Moment { frame, time_s, .. } = self.moment(when)?;
        let seen = self.seen(PointCloud::from_points(points_m), frame);
        let estimate = self.step(&seen, when, stick)?;
        let SeenPoints { points_m, skipped, over_cap, .. } = seen;
        Ok(StreamedFrame { frame, time_s, estimate, points: points_m.len(), skipped, over_cap })
    }

    /// One frame; `None` where no first pose is known. A frame without points is a prediction.
    ///
    /// The first pose is the answer to the first frame. One step from there shows which bones its
    /// points observe.
    ///
    /// # Errors
    /// A time that does not rise.
    pub fn step(&mut self, seen: &SeenPoints, when: FrameTime, stick: StickSight) -> Result<Option<WholeBodyEstimate>> {
        let moment = self.moment(when)?;
        if self.phase == Phase::Waiting && !seen.points_m.is_empty() {
            self.begin_from(&seen.points_m)?;
        }
        self.last = Some(moment);
        let (phase, threads, filter) = (self.phase, &self.threads, &mut self.filter);
        let estimate = match phase {
            Phase::Waiting => return Ok(None),
            Phase::Placed => threads.install(|| first_look(filter, seen, stick)),
            Phase::Tracking => threads.install(|| filter.step(&seen.blocks, moment.dt_s, stick)),
        };
        self.phase = Phase::Tracking;
        Ok(Some(estimate))
    }

    fn moment(&self, when: FrameTime) -> Result<Moment> {
        when.after(self.last.as_ref(), f64::from(self.options.rate_hz))
    }

    /// Where the stream is, which [`Self::set_state`] of one with the same options, person and
    /// first pose takes.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub fn state(&mut self) -> Result<StreamState> {
        Ok(StreamState { phase: self.phase, last: self.last, tracker: self.filter.saved()? })
    }

    /// Goes on from there.
    ///
    /// # Errors
    /// The state is not whole, or of another stream.
    pub fn set_state(&mut self, state: &StreamState) -> Result<()> {
        self.filter.restore(&state.tracker)?;
        (self.phase, self.last) = (state.phase, state.last);
        Ok(())
    }

    /// The stream as text, from which [`Self::restored`] makes it anew.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub fn saved(&mut self) -> Result<String> {
        let state = self.state()?;
        let saved = SavedStream { options: self.options.clone(), body: BodyFile::from(&self.size), state };
        Ok(serde_json::to_string(&saved)?)
    }

    /// A stream that goes on from what [`Self::saved`] said, bit for bit.
    ///
    /// # Errors
    /// The text is not whole.
    pub fn restored(saved: &str) -> Result<Self> {
        let inner = || -> Result<Self> {
            let SavedStream { options, body, state } = serde_json::from_str(saved)?;
            let mut stream = Self::new(options, body.size()?, None)?;
            stream.set_state(&state)?;
            Ok(stream)
        };
        inner().context("the saved state of a body tracker is not whole")
    }

    /// CRC-32 of the filter's saved state as text. Two runs that were stepped alike have the same
    /// number, at full precision.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub fn state_crc32(&mut self) -> Result<u32> {
        Ok(text_crc32(&self.filter.saved()?))
    }
}

fn threads(options: &BodyStreamOptions) -> Result<ThreadPool> {
    ThreadPoolBuilder::new()
        .num_threads(options.threads.unwrap_or(0))
        .build()
        .context("the threads cannot be started; give --threads a smaller number")
}

/// A filter that begins at `first_rad`.
fn filter(options: &BodyStreamOptions, size: &BodySize, first_rad: [f32; BODY_ANGLES]) -> Result<BodyFilter> {
    let BodyStreamOptions { part, model, tuning, particles, seed, floor_y_m, .. } = options;
    let who = (&size.measures, first_rad);
    let mut filter = BodyFilter::of_part(*part, *model, *tuning, who, *particles, *seed)?;
    filter.resize(size)?;
    Ok(match floor_y_m {
        Some(floor_y_m) => filter.above_floor(*floor_y_m),
        None => filter,
    })
}

/// The first frame: the first pose is its pose, and one step from there shows which bones its
/// points observe.
fn first_look(filter: &BodyFilter, seen: &SeenPoints, stick: StickSight) -> WholeBodyEstimate {
    let mut estimate = filter.clone().step(&seen.blocks, 0.0, stick);
    if let Some(first) = filter.particles().0.first() {
        (estimate.angles_rad, estimate.ends_m) = (first.angles_rad, first.ends_m);
    }
    estimate
}

/// A stick with these ends, metres; `None` where one is farther than [`MAX_DISTANCE_M`] or not
/// finite.
#[must_use]
pub fn stick_at(ends_m: [Vec3; 2]) -> Option<StickSight> {
    ends_m.iter().all(|end| end.norm() <= MAX_DISTANCE_M).then_some(StickSight::Ends(ends_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::tracking::BodyModelKind;
    use crate::stereo::{StereoOptions, StereoScene, StereoSource};
    use sinew_core::skeleton::BodyMeasures;

    const UNSEEN: StickSight = StickSight::Unseen;

    fn scene() -> StereoScene {
        let source = StereoSource { rate_hz: 2.0, ..StereoSource::default() };
        let options = StereoOptions { points: 300, ..StereoOptions::default() };
        StereoScene::new(source.read().unwrap().recording, options).unwrap()
    }

    fn stream(scene: &StereoScene, threads: usize) -> BodyStream {
        let options = BodyStreamOptions { particles: 12, threads: Some(threads), rate_hz: 2.0, ..Default::default() };
        BodyStream::new(options, *scene.measures(), None).unwrap()
    }

    #[test]
    fn a_stream_as_text_goes_on_bit_for_bit() {
        let scene = scene();
        let (mut whole, mut broken) = (stream(&scene, 1), stream(&scene, 2));
        for frame in 0..6 {
            // The person is not there in the first frame.
            let points_m = if frame == 0 { Vec::new() } else { scene.points_m(frame) };
            broken = BodyStream::restored(&broken.saved().unwrap()).unwrap();
            let wanted = whole.update(points_m.clone(), FrameTime::Next, UNSEEN).unwrap();
            assert_eq!(broken.update(points_m, FrameTime::Next, UNSEEN).unwrap(), wanted);
            assert_eq!(wanted.estimate.is_none(), frame == 0);
        }
        assert_eq!(broken.state_crc32().unwrap(), whole.state_crc32().unwrap());
        let mut other = stream(&scene, 1);
        assert_ne!(other.state_crc32().unwrap(), whole.state_crc32().unwrap());
        let cut = broken.saved().unwrap().replace("\"particles\":12", "\"particles\":13");
        for wrong in ["", "{}", &cut] {
            assert!(BodyStream::restored(wrong).unwrap_err().to_string().contains("not whole"));
        }
    }

    #[test]
    fn what_is_seen_may_be_prepared_ahead() {
        let scene = scene();
        let (mut ahead, mut at_once) = (stream(&scene, 1), stream(&scene, 1));
        let seen: Vec<SeenPoints> =
            (0..4).map(|frame| ahead.seen(PointCloud::from_points(scene.points_m(frame)), frame as u64)).collect();
        for (frame, seen) in seen.iter().enumerate() {
            let estimate = ahead.step(seen, FrameTime::Number(frame as u64), UNSEEN).unwrap();
            assert_eq!(estimate, at_once.update(scene.points_m(frame), FrameTime::Next, UNSEEN).unwrap().estimate);
        }
        assert!(ahead.step(&seen[0], FrameTime::Number(3), UNSEEN).is_err());
    }

    #[test]
    fn options_out_of_range_are_named() {
        let measures = BodyMeasures::of_height(1.75).unwrap();
        let default = BodyStreamOptions::default;
        for (options, name) in [
            (BodyStreamOptions { particles: 0, ..default() }, "--particles"),
            (BodyStreamOptions { threads: Some(0), ..default() }, "--threads"),
            (BodyStreamOptions { rate_hz: f32::NAN, ..default() }, "--rate"),
            (BodyStreamOptions { floor_y_m: Some(f32::NAN), ..default() }, "`floor_y_m`"),
            (
                BodyStreamOptions { part: crate::body::BodyPart::Upper, model: BodyModelKind::PelvicLift, ..default() },
                "--model pelvic-lift",
            ),
        ] {
            let message = BodyStream::new(options, measures, None).unwrap_err().to_string();
            assert!(message.contains(name), "{message}");
        }
    }
}
