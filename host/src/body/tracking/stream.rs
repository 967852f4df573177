//! A body tracked frame by frame: points, time and a stick go in, an estimate comes out.
//!
//! `sinew track body` steps this type over a folder of clouds. Programs step it as frames come.

use super::filter::{BodyFilter, WholeBodyEstimate};
use super::frame_time::{FrameTime, Moment, decision_frames};
use super::seen_points::SeenPoints;
use super::start::{FirstPose, pose_from_points, unexplained_share};
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

/// Share of the points away from the body, beyond which it may be lost. Chosen: of 90 runs of
/// fifteen tuning clips, near and far, none has more than 0.73 for half a second.
const MOST_AWAY: f32 = 0.75;
/// A pose that leaves at most this share of them away is where the body is. Chosen: half.
const LEFT_AWAY: f32 = 0.5;

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
    #[serde(default)]
    away_frames: usize,
    #[serde(default)]
    begun_anew: Option<u64>,
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
    /// Frames in a row whose points were mostly away from the body.
    away_frames: usize,
    begun_anew: Option<u64>,
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
        Ok(Self { options, size, filter, threads, phase, last: None, away_frames: 0, begun_anew: None })
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
        let first = self.found_in(points_m)?;
        self.begin_at(first.angles_rad)?;
        Ok(first)
    }

    fn found_in(&self, points_m: &[Vec3]) -> Result<FirstPose> {
        let BodyStreamOptions { part, tuning, .. } = &self.options;
        let blocks = blocks_of(&mut points_m.to_vec(), tuning.range_smoothing()?.as_ref());
        self.threads.install(|| pose_from_points(*part, &self.size, &tuning.guided_points, points_m, &blocks))
    }

    /// Begins at this pose.
    ///
    /// # Errors
    /// Numbers that broke a rule.
    pub fn begin_at(&mut self, first_rad: [f32; BODY_ANGLES]) -> Result<()> {
        self.filter = filter(&self.options, &self.size, first_rad)?;
        self.phase = Phase::Placed;
        Ok(())
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
        if self.phase == Phase::Waiting && seen.show_a_body() {
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
        if let Some(away_share) = self.lost_share(seen)
            && self.finds_anew(seen, away_share)?
        {
            self.begun_anew = Some(moment.frame);
            self.phase = Phase::Tracking;
            let (threads, filter) = (&self.threads, &self.filter);
            return Ok(Some(threads.install(|| first_look(filter, seen, stick))));
        }
        Ok(Some(estimate))
    }

    /// Number of the last frame in which the body was looked for anew and found elsewhere.
    #[must_use]
    pub const fn begun_anew(&self) -> Option<u64> {
        self.begun_anew
    }

    /// Share of these points that are away from the body, where for half a second most were.
    fn lost_share(&mut self, seen: &SeenPoints) -> Option<f32> {
        if !seen.show_a_body() {
            return None;
        }
        let (pose_rad, _) = self.filter.before_deadband();
        let share = unexplained_share(self.filter.scene(), &pose_rad, &seen.points_m);
        self.away_frames = if share > MOST_AWAY { self.away_frames + 1 } else { 0 };
        (self.away_frames >= decision_frames(self.options.rate_hz)).then_some(share)
    }

    /// Begins anew at the pose found in these points, where it explains most of what the tracked
    /// one does not.
    fn finds_anew(&mut self, seen: &SeenPoints, away_share: f32) -> Result<bool> {
        self.away_frames = 0;
        let found_rad = self.found_in(&seen.points_m)?.angles_rad;
        if unexplained_share(self.filter.scene(), &found_rad, &seen.points_m) > LEFT_AWAY * away_share {
            return Ok(false);
        }
        self.begin_at(found_rad)?;
        Ok(true)
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
        let tracker = self.filter.saved()?;
        let &mut Self { phase, last, away_frames, begun_anew, .. } = self;
        Ok(StreamState { phase, last, away_frames, begun_anew, tracker })
    }

    /// Goes on from there.
    ///
    /// # Errors
    /// The state is not whole, or of another stream.
    pub fn set_state(&mut self, state: &StreamState) -> Result<()> {
        self.filter.restore(&state.tracker)?;
        (self.phase, self.last) = (state.phase, state.last);
        (self.away_frames, self.begun_anew) = (state.away_frames, state.begun_anew);
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
    fn a_body_that_went_elsewhere_is_found_again() {
        let scene = scene();
        let mut stream = stream(&scene, 1);
        let shift_m = Vec3::new(1.5, 0.0, 1.0);
        let elsewhere = || scene.points_m(2).into_iter().map(|point_m| point_m + shift_m);
        for frame in 0..2 {
            stream.update(scene.points_m(frame), FrameTime::Next, UNSEEN).unwrap();
        }
        let mut pelvis_m = Vec::new();
        for _ in 0..decision_frames(2.0) {
            assert_eq!(stream.begun_anew(), None);
            let estimate = stream.update(elsewhere(), FrameTime::Next, UNSEEN).unwrap().estimate.unwrap();
            pelvis_m.push(estimate.ends_m[sinew_core::skeleton::full_body::TRUNK]);
        }
        assert_eq!(stream.begun_anew(), Some(9));
        let wanted_m = scene.joints_m(2)[sinew_core::skeleton::full_body::TRUNK].unwrap() + shift_m;
        let off_m: Vec<f32> = pelvis_m.iter().map(|found_m| (found_m - wanted_m).norm()).collect();
        assert!(off_m[0] > 0.5 && off_m[7] < 0.15, "{off_m:?}");
        // A wall that no body explains is no other place.
        let wall = || (0..300).map(|at| Vec3::new(0.3 * (at % 20) as f32 - 3.0, 0.2 * (at / 20) as f32 - 1.5, 5.0));
        for _ in 0..10 {
            stream.update(wall(), FrameTime::Next, UNSEEN).unwrap();
        }
        assert_eq!(stream.begun_anew(), Some(9));
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
