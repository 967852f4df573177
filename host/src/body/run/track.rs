//! One run over a folder of clouds: read, step, record, frame by frame.

use super::answer::Answer;
use super::cloud_check::check_points;
use super::inputs::BodyInputs;
use super::options::{BodyTrackOptions, DEPTH_POINTS};
use super::pictures::BodyPictures;
use super::report::{BodyRunReport, SkippedCloud};
use super::resume;
use super::score::{BodyScore, RunningMean};
use super::{particles, table};
use crate::body::tracking::facing::{begin_from_frames, is_upside_down};
use crate::body::tracking::frame_time::decision_frames;
use crate::body::tracking::size_from_frames::{size_frames, size_from_frames, sizing_options};
use crate::body::tracking::{BodyStream, BodyStreamOptions, FrameTime, SeenPoints};
use crate::cloud::{CloudError, CloudFrame, CloudSource, MAX_POINTS};
use crate::error::{Context, Result, WriteContext, bail};
use crate::output::{OutputDir, OutputLock, PendingFile};
use crate::reading_again::read_again;
use crate::resume::{Begun, Checkpoints, PARTICLE_TABLE, TRACK_TABLE};
use rayon::prelude::*;
use sinew_core::math::Vec3;
use sinew_core::pik::processes::stick::StickSight;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Clouds that are read ahead.
const CHUNK: usize = 16;
/// Clouds that are looked at for points where no first pose is given.
const START_CLOUDS: usize = 100;

/// What a run reports while it goes on.
#[derive(Debug, Clone, Copy)]
pub enum BodyEvent<'a> {
    /// Something that a user should know.
    Note(&'a str),
    /// A doubt about the inputs.
    Warning(&'a str),
    /// A cloud could not be read.
    Skipped(&'a SkippedCloud),
    /// The first cloud with more points than are weighed.
    OverCap {
        /// Points of the cloud.
        points: usize,
        /// Points of it that are weighed.
        weighed: usize,
    },
    /// So many frames are in the table.
    Finished(usize),
}

/// The receiver of these reports.
pub type Notify<'a> = &'a mut (dyn FnMut(BodyEvent<'_>) + Send);

/// Opens the table of a name in a folder, with its header if it is new.
pub(super) type TableOpener<'a> = &'a dyn Fn(&str, &OutputDir, Vec<String>) -> Result<csv::Writer<PendingFile>>;

/// A cloud ready for the tracker.
#[derive(Debug)]
pub(super) struct ReadCloud {
    pub seen: SeenPoints,
    /// CRC-32 of its file.
    crc32: u32,
}

/// A run whose inputs were all checked.
#[derive(Debug)]
pub struct BodyTrackRun {
    pub(super) inputs: BodyInputs,
    pub(super) stream: BodyStream,
    pub(super) out: OutputDir,
    _lock: OutputLock,
    checkpoints: Checkpoints,
    /// How it was begun, once that was asked.
    pub(super) begun: Option<Begun>,
    pub(super) started: Instant,
    pub(super) table: csv::Writer<PendingFile>,
    pub(super) particles: Option<csv::Writer<PendingFile>>,
    pub(super) pictures: Option<BodyPictures>,
    pub(super) report: BodyRunReport,
    pub(super) score: BodyScore,
    pub(super) effective_share: RunningMean,
    /// Wall time of the steps, seconds.
    pub(super) step_s: f64,
    /// Time that was spent before a resumption, seconds.
    pub(super) seconds: f64,
    /// CRC-32 of the last finished frame's file; none where it could not be read.
    pub(super) last_cloud_crc32: Option<u32>,
    /// The answers so far.
    pub(super) answers: Vec<Answer>,
}

impl BodyTrackRun {
    /// Checks everything that can be checked before the first frame, the output folder last.
    ///
    /// # Errors
    /// Names the option or file, the rule it broke, and the remedy.
    pub fn prepare(options: BodyTrackOptions, out: &Path) -> Result<Self> {
        Self::set_up(options, out, &|name, out, header| out.begin_table(name, header))
    }

    /// The same with tables that `table` opens.
    pub(super) fn set_up(options: BodyTrackOptions, out: &Path, table: TableOpener<'_>) -> Result<Self> {
        options.check()?;
        let mut inputs = BodyInputs::read(&options)?;
        check_readable(&inputs)?;
        check_points(&mut inputs, START_CLOUDS)?;
        let mut stream = BodyStream::new(stream_options(&options, &inputs), inputs.size, inputs.first_rad)?;
        if inputs.estimates_size {
            stream = sized(&mut inputs, stream.options().clone())?;
        }
        if inputs.first_rad.is_none() {
            find_start(&mut inputs, &mut stream)?;
        }
        let part = inputs.part;
        refuse_output_in_input(&options.folder, out)?;
        let out = OutputDir::create(out)?;
        let lock = OutputLock::of_folder(out.path(), resume::COMMAND)?;
        Ok(Self {
            stream,
            table: table(TRACK_TABLE, &out, table::header(part))?,
            particles: if options.particles_csv {
                Some(table(PARTICLE_TABLE, &out, particles::header(part))?)
            } else {
                None
            },
            pictures: if options.pictures { Some(BodyPictures::new(inputs.clouds.frames.len())?) } else { None },
            out,
            _lock: lock,
            checkpoints: Checkpoints::default(),
            begun: None,
            started: Instant::now(),
            report: BodyRunReport::new(options, &inputs),
            inputs,
            score: BodyScore::default(),
            effective_share: RunningMean::default(),
            step_s: 0.0,
            seconds: 0.0,
            last_cloud_crc32: None,
            answers: Vec::new(),
        })
    }

    /// Saves the state at least so often, in place of every ten seconds.
    #[must_use]
    pub fn checkpoint_every(mut self, every: Duration) -> Self {
        self.checkpoints = Checkpoints::every(every);
        self
    }

    /// Number of clouds.
    #[must_use]
    pub fn frame_count(&self) -> usize {
        self.inputs.clouds.frames.len()
    }

    /// Number of frames that were finished before the run was resumed; 0 in a new run.
    #[must_use]
    pub fn frames_finished(&self) -> usize {
        self.report.frames_finished
    }

    /// Whether the last cloud was reached.
    pub(super) fn track_all(&mut self, stop: &AtomicBool, notify: Notify<'_>) -> Result<bool> {
        self.save_if_due()?;
        let frames = self.inputs.clouds.frames[self.report.frames_finished..].to_vec();
        for chunk in frames.chunks(CHUNK) {
            let (stream, source) = (&self.stream, &self.inputs.source);
            let clouds: Vec<Result<Result<ReadCloud, SkippedCloud>>> =
                stream.install(|| chunk.par_iter().map(|frame| read_cloud(frame, source, stream)).collect());
            for (frame, cloud) in chunk.iter().zip(clouds) {
                if stop.load(Ordering::Relaxed) {
                    return Ok(false);
                }
                let cloud = cloud?;
                self.last_cloud_crc32 = cloud.as_ref().ok().map(|cloud| cloud.crc32);
                let cloud = self.counted(cloud, notify)?;
                self.track_frame(frame.frame, cloud.as_ref())?;
                notify(BodyEvent::Finished(self.report.frames_finished));
                self.save_if_due()?;
            }
        }
        Ok(true)
    }

    fn save_if_due(&mut self) -> Result<()> {
        if self.checkpoints.is_due() { self.save() } else { Ok(()) }
    }

    /// Saves the state, from which [`BodyTrackRun::resume`] goes on.
    pub(super) fn save(&mut self) -> Result<()> {
        let left = resume::left(self)?;
        resume::file_in(self.out.path()).put(&left)
    }

    /// Counts a cloud's points; one that could not be read is nothing, or an error if the run is
    /// strict.
    fn counted(&mut self, cloud: Result<ReadCloud, SkippedCloud>, notify: Notify<'_>) -> Result<Option<ReadCloud>> {
        let cloud = match cloud {
            Ok(cloud) => cloud,
            Err(skipped) if self.report.options.strict => bail!("{}", skipped.reason),
            Err(skipped) => {
                notify(BodyEvent::Skipped(&skipped));
                self.report.skipped.push(skipped);
                self.report.points.frames_without_points += 1;
                return Ok(None);
            }
        };
        let (points, seen) = (&mut self.report.points, &cloud.seen);
        points.used += seen.points_m.len() as u64;
        points.skipped += seen.skipped as u64;
        points.outside += seen.outside as u64;
        points.frames_without_points += usize::from(seen.points_m.is_empty());
        if seen.over_cap > 0 {
            // Of depth images far fewer points than pixels are weighed.
            if points.frames_over_cap == 0 && self.inputs.source.camera.is_none() {
                let weighed = seen.points_m.len();
                notify(BodyEvent::OverCap { points: weighed + seen.over_cap, weighed });
            }
            points.over_cap += seen.over_cap as u64;
            points.frames_over_cap += 1;
        }
        Ok(Some(cloud))
    }

    /// One frame from points to its row.
    fn track_frame(&mut self, frame: u64, cloud: Option<&ReadCloud>) -> Result<()> {
        let nothing = SeenPoints::default();
        let seen = cloud.map_or(&nothing, |cloud| &cloud.seen);
        let stick = self.inputs.stick.get(&frame).copied().unwrap_or(StickSight::Unseen);
        let start = Instant::now();
        let estimate = self.stream.step(seen, FrameTime::Number(frame), stick)?;
        self.step_s += start.elapsed().as_secs_f64();
        let estimate = estimate.context("the tracker has no first pose")?;
        if self.stream.begun_anew() == Some(frame) {
            self.report.begun_anew.push(frame);
        }
        let points_m = &seen.points_m;
        let ambiguous = self.stream.filter().ambiguous(&estimate);
        self.table
            .write_record(table::cells(self.inputs.part, frame, &estimate, &ambiguous, points_m.len()))
            .writing(|| "`track.csv` cannot be written")?;
        if let Some(particles) = &mut self.particles {
            for row in particles::rows(self.inputs.part, frame, self.stream.filter()) {
                particles.write_record(row).writing(|| "`particles.csv` cannot be written")?;
            }
        }
        self.take(self.report.frames_finished, Answer { frame, estimate }, points_m);
        Ok(())
    }

    /// Takes the answer to the `index`-th cloud for everything but the tables.
    pub(super) fn take(&mut self, index: usize, answer: Answer, points_m: &[Vec3]) {
        let Answer { frame, estimate } = &answer;
        let truth = self.inputs.truth.get(frame).filter(|_| index > 0);
        let joint_error_m =
            truth.and_then(|truth| self.score.add(self.stream.filter(), estimate, &truth.joints_m, &truth.markers_m));
        if let Some(pictures) = &mut self.pictures {
            let time_s = *frame as f64 / f64::from(self.inputs.rate_hz);
            pictures.add((index, *frame, time_s), points_m, (self.stream.filter(), estimate), joint_error_m);
        }
        self.report.frames_finished += 1;
        self.report.degenerate_frames += usize::from(estimate.is_degenerate);
        self.report.count_observed(estimate);
        self.effective_share.add(f64::from(estimate.effective_sample_size) / self.report.options.particles as f64);
        self.answers.push(answer);
    }
}

/// What of the run's options and inputs decides the steps.
fn stream_options(options: &BodyTrackOptions, inputs: &BodyInputs) -> BodyStreamOptions {
    BodyStreamOptions {
        part: inputs.part,
        model: options.model,
        particles: options.particles,
        max_points: options.max_points.unwrap_or(if inputs.source.camera.is_some() {
            DEPTH_POINTS
        } else {
            MAX_POINTS
        }),
        seed: options.seed,
        rate_hz: inputs.rate_hz,
        floor_y_m: inputs.floor_y_m,
        threads: options.threads,
        tuning: options.tuning,
    }
}

/// Reads one cloud of `source` for `stream`. Where it is no cloud, the answer says why.
///
/// # Errors
/// The operating system refuses the file.
pub(super) fn read_cloud(
    frame: &CloudFrame,
    source: &CloudSource,
    stream: &BodyStream,
) -> Result<Result<ReadCloud, SkippedCloud>> {
    let mut crc32 = 0;
    let read = || source.read_noting(&frame.path, |bytes| crc32 = crc32fast::hash(bytes));
    match read_again(read, CloudError::is_io)? {
        Ok(cloud) => Ok(Ok(ReadCloud { seen: stream.seen(cloud, frame.frame), crc32 })),
        Err(error) => Ok(Err(SkippedCloud {
            frame: frame.frame,
            file: frame.path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            reason: error.to_string(),
        })),
    }
}

/// Refuses a folder of which no cloud can be read.
fn check_readable(inputs: &BodyInputs) -> Result<()> {
    let mut first = None;
    for frame in &inputs.clouds.frames {
        match inputs.source.read_noting(&frame.path, |_| ()) {
            Ok(_) => return Ok(()),
            Err(error) => first = first.or(Some(error)),
        }
    }
    let reason = first.map_or_else(String::new, |error| error.to_string());
    bail!(
        "no cloud in `{}` can be read; of the first one, {reason}; give a folder of intact clouds",
        inputs.files.clouds.display()
    )
}

/// A stream of the person whose size the first seconds with points show; notes it.
fn sized(inputs: &mut BodyInputs, options: BodyStreamOptions) -> Result<BodyStream> {
    let sizing = BodyStream::new(sizing_options(&options), inputs.size, inputs.first_rad)?;
    let frames = first_clouds(inputs, &sizing, size_frames(inputs.rate_hz));
    let first_rad = inputs.first_rad;
    let found = size_from_frames(&options, &inputs.size, first_rad, &frames)?;
    let how = match found {
        Some(_) => "lengths and radii are estimated from",
        None => "no lengths and radii make the points likelier than those at the start, in",
    };
    inputs.size = found.unwrap_or(inputs.size);
    inputs.notes.push(format!(
        "{how} {} frames: {:.2} m from the soles to the middle of the head (--size given keeps those that are given)",
        frames.len(),
        inputs.size.standing_m()
    ));
    BodyStream::new(options, inputs.size, first_rad)
}

/// The first clouds that have the points of a body, with their numbers, `most` at most.
fn first_clouds(inputs: &BodyInputs, stream: &BodyStream, most: usize) -> Vec<(u64, SeenPoints)> {
    let seen = |frame: &CloudFrame| {
        let cloud = read_cloud(frame, &inputs.source, stream).ok()?.ok()?;
        cloud.seen.show_a_body().then_some((frame.frame, cloud.seen))
    };
    let clouds = &inputs.clouds.frames[..inputs.clouds.frames.len().min(START_CLOUDS + most)];
    let mut frames = Vec::new();
    for some in clouds.chunks(most) {
        if frames.len() >= most {
            break;
        }
        frames.extend(stream.install(|| some.par_iter().filter_map(seen).collect::<Vec<_>>()));
    }
    frames.truncate(most);
    frames
}

/// Starts from the first clouds that have the points of a body, and notes it.
fn find_start(inputs: &mut BodyInputs, stream: &mut BodyStream) -> Result<()> {
    let frames = first_clouds(inputs, stream, decision_frames(inputs.rate_hz));
    let first = begin_from_frames(stream, &frames)?;
    let Some((frame, _)) = frames.first() else {
        inputs.notes.push(
            "no first pose is given and the first clouds have too few points; someone upright 3 m before the camera (--init)"
                .to_owned(),
        );
        return Ok(());
    };
    let facing = first.facing();
    inputs.notes.push(format!(
        "no first pose is given; someone who stands or walks is fitted to the points of frame {frame}, {facing} (--init)"
    ));
    if is_upside_down(stream, &first, &frames)? {
        inputs.warnings.push(format!(
            "the points of {} frames from {frame} on are likelier of someone upside down; axes have to be x to the right, y down, z \
             forward: where y points up, change its sign, and that of x where it points to the left; give the first \
             pose (--init) of someone who stands on their hands",
            frames.len()
        ));
    }
    if first.is_facing_doubtful() {
        inputs.warnings.push(format!(
            "the first pose may face the wrong way: the points of {} frames from {frame} on hardly separate the way \
             that is taken, {facing}, from the opposite one; look at the result, and give the first pose (--init) if \
             it is wrong",
            frames.len()
        ));
    }
    Ok(())
}

/// The report would replace that of the scene, and tables among the clouds would be read as clouds.
fn refuse_output_in_input(folder: &Path, out: &Path) -> Result<()> {
    let Ok(output) = out.canonicalize() else { return Ok(()) };
    for input in [folder.to_path_buf(), folder.join("points"), folder.join("depth")] {
        if input.canonicalize().is_ok_and(|input| input == output) {
            bail!("`{}` holds what is read; choose another --out", out.display());
        }
    }
    Ok(())
}
