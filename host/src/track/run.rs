//! One run over an image folder or a video: load, read, step, record, frame by frame.

use super::input::SkippedImage;
use super::options::{FaceSource, FrontEnd, TrackOptions, check_rate};
use super::particles::{PARTICLE_HEADER, particle_rows};
use super::pictures::{Pictures, Shot};
use super::report::RunReport;
use super::resume;
use super::sample::HandSample;
use super::source::FrameSource;
use super::stream::{ArmStream, StreamAnswer, StreamFrame};
use super::table::{HEADER, TrackRow};
use crate::error::{Result, WriteContext, bail};
use crate::frames::FrameView;
use crate::output::{OutputDir, OutputLock, PendingFile};
use crate::person::HandTable;
use crate::pixels::is_grey;
use crate::resume::{Begun, Checkpoints, PARTICLE_TABLE, TRACK_TABLE};
use crate::skin::SkinModel;
use image::RgbImage;
use sinew_core::camera::Camera;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Maximum number of frames that are read ahead.
const MAX_CHUNK: usize = 32;
/// Memory that frames which are read ahead may take, bytes.
const CHUNK_BYTES: usize = 64 << 20;

/// What a run reports while it goes on.
#[derive(Debug, Clone, Copy)]
pub enum Event<'a> {
    /// An image could not be read.
    Skipped(&'a SkippedImage),
    /// So many frames are in the table.
    Finished(usize),
}

/// Opens the table of a name in a folder, with its header if it is new.
pub(super) type TableOpener<'a> = &'a dyn Fn(&str, &OutputDir, &[&str]) -> Result<csv::Writer<PendingFile>>;

/// A run whose inputs were all checked.
#[derive(Debug)]
pub struct TrackRun {
    pub(super) frames: FrameSource,
    pub(super) stream: ArmStream,
    hands: Option<HandTable>,
    camera: Camera,
    pub(super) out: OutputDir,
    _lock: OutputLock,
    checkpoints: Checkpoints,
    /// How it was begun, once that was asked.
    pub(super) begun: Option<Begun>,
    pub(super) started: Instant,
    pub(super) pictures: Option<Pictures>,
    pub(super) track: csv::Writer<PendingFile>,
    pub(super) particles: Option<csv::Writer<PendingFile>>,
    pub(super) report: RunReport,
    pub(super) samples: Vec<HandSample>,
    /// Time that was spent before a resumption, seconds.
    pub(super) seconds: f64,
    /// CRC-32 of the pixels of the last finished frame; none where its image could not be read.
    pub(super) last_image_crc32: Option<u32>,
}

impl TrackRun {
    /// Checks everything that can be checked before the first frame, the output folder last.
    ///
    /// # Errors
    /// Names the option or file, the rule it broke, and the remedy.
    pub fn prepare(options: TrackOptions, out: &Path) -> Result<Self> {
        Self::set_up(options, out, &|name, out, header| out.begin_table(name, header))
    }

    /// The same with tables that `table` opens.
    pub(super) fn set_up(options: TrackOptions, out: &Path, table: TableOpener<'_>) -> Result<Self> {
        check_rate(options.rate_hz)?;
        if options.front_end == FrontEnd::Lines && options.hands.is_some() {
            bail!("--hands takes the place of what is seen, and --front-end lines is a way to see: leave one out");
        }
        let trained = SkinModel::from_option(&options.skin)?;
        let frames = FrameSource::open(&options.folder, options.strict, options.rate_hz)?;
        if let (Some(_), (1.., _)) = (options.calibrate, frames.first()) {
            bail!(
                "`{}` cannot be read, and --calibrate needs the first image; take it out",
                frames.files()[0].display()
            );
        }
        let chosen = options.stream()?;
        let hands = options.hands.as_deref().map(HandTable::read).transpose()?;
        check_tables(&options, hands.as_ref(), &chosen.face, &frames)?;
        let mut stream = ArmStream::new(chosen, trained, frames.size_px())?;
        stream.begin(frames.first().1)?;
        let camera = *stream.camera();
        refuse_output_in_input(&options.folder, out)?;
        let out = OutputDir::create(out)?;
        let lock = OutputLock::of_folder(out.path(), resume::COMMAND)?;
        let pictures = match options.overlay {
            true => {
                let folder = out.subfolder("overlay")?;
                lock.sweep(folder.path());
                Some(Pictures::new(&frames, folder)?)
            }
            false => None,
        };
        let track = table(TRACK_TABLE, &out, &HEADER)?;
        let particles = if options.particles_csv { Some(table(PARTICLE_TABLE, &out, &PARTICLE_HEADER)?) } else { None };
        let names = (0..frames.files().len()).map(|frame| frames.name(frame)).collect();
        let report = RunReport { frames: frames.count(), ..RunReport::new(options, names, frames.size_px()) };
        Ok(Self {
            frames,
            stream,
            hands,
            camera,
            out,
            _lock: lock,
            checkpoints: Checkpoints::default(),
            begun: None,
            started: Instant::now(),
            pictures,
            track,
            particles,
            report,
            samples: Vec::new(),
            seconds: 0.0,
            last_image_crc32: None,
        })
    }

    /// Saves the state at least so often, in place of every ten seconds.
    #[must_use]
    pub fn checkpoint_every(mut self, every: Duration) -> Self {
        self.checkpoints = Checkpoints::every(every);
        self
    }

    /// Number of frames; of a video, what it says.
    #[must_use]
    pub fn frame_count(&self) -> usize {
        self.frames.count()
    }

    /// Number of frames that were finished before the run was resumed; 0 in a new run.
    #[must_use]
    pub fn frames_finished(&self) -> usize {
        self.report.frames_finished
    }

    /// Whether the last frame was reached.
    pub(super) fn track_all(&mut self, stop: &AtomicBool, notify: &mut dyn FnMut(Event<'_>)) -> Result<bool> {
        self.save_if_due()?;
        let (most, mut begin) = (self.chunk_length(), self.report.frames_finished);
        loop {
            let images = self.frames.load(begin, most)?;
            if images.is_empty() {
                return Ok(true);
            }
            let read = images.len();
            let mut shots = Vec::new();
            for (frame, image) in (begin..).zip(images) {
                if stop.load(Ordering::Relaxed) {
                    break;
                }
                shots.extend(self.track_frame(frame, image, notify)?);
                notify(Event::Finished(self.report.frames_finished));
                if self.pictures.is_none() {
                    self.save_if_due()?;
                }
            }
            if let Some(pictures) = &mut self.pictures {
                // A resumed run has to find them.
                pictures.draw(&shots, self.stream.arms())?;
                self.save_if_due()?;
            }
            begin += read;
            if stop.load(Ordering::Relaxed) {
                // A folder's last frame is known as such.
                let is_folder = matches!(self.frames, FrameSource::Folder(_));
                return Ok(is_folder && self.report.frames_finished == self.frames.count());
            }
        }
    }

    fn save_if_due(&mut self) -> Result<()> {
        if self.checkpoints.is_due() { self.save() } else { Ok(()) }
    }

    /// Saves the state, from which [`TrackRun::resume`] goes on.
    pub(super) fn save(&mut self) -> Result<()> {
        let left = resume::left(self)?;
        resume::file_in(self.out.path()).put(&left)
    }

    /// One frame from pixels to its row of the table.
    fn track_frame(
        &mut self,
        frame: usize,
        image: Result<RgbImage, SkippedImage>,
        notify: &mut dyn FnMut(Event<'_>),
    ) -> Result<Option<Shot>> {
        let image = image.map_err(|skipped| self.skip(skipped, notify)).ok();
        self.last_image_crc32 = image.as_ref().map(|image| crc32fast::hash(image.as_raw()));
        let StreamAnswer { arms, view, knows_face } = self.stream.step(StreamFrame {
            number: frame,
            timestamp_us: self.timestamp_us(frame),
            image: image.as_ref(),
            hands: self.hands.as_ref().filter(|_| image.is_some()).map(|hands| hands.at(frame)),
            head: None,
        })?;
        if let (Some(view), Some(image)) = (&view, &image) {
            self.report.seen.count(view, is_grey(image), knows_face, self.stream.arms());
        }
        for arm in &arms {
            let row = TrackRow {
                frame,
                image: self.frames.name(frame),
                time_s: frame as f64 / self.report.options.rate_hz,
                view: arm.clone(),
                blob_count: view.as_ref().map(|view| view.candidates.len()),
                dropped_blobs: view.as_ref().map_or(0, |view| view.dropped_blobs),
            };
            self.record(&row)?;
        }
        self.report.frames_finished += 1;
        let name = self.frames.name(frame);
        let shot = |(image, view): (RgbImage, FrameView)| Shot { frame, name, image, view, arms };
        let drawn = image.zip(view).filter(|_| self.pictures.is_some());
        Ok(drawn.map(|(image, view)| shot((self.stream.seen(image), view))))
    }

    /// Notes a missing image.
    fn skip(&mut self, skipped: SkippedImage, notify: &mut dyn FnMut(Event<'_>)) {
        notify(Event::Skipped(&skipped));
        self.report.skipped.push(skipped);
    }

    fn record(&mut self, row: &TrackRow) -> Result<()> {
        let estimate = &row.view.estimate;
        self.track.write_record(row.cells(&self.camera)).writing(|| "`track.csv` cannot be written")?;
        if let Some(particles) = &mut self.particles {
            for cells in particle_rows(row.frame, &row.view, &self.camera) {
                particles.write_record(cells).writing(|| "`particles.csv` cannot be written")?;
            }
        }
        self.report.count(estimate.side, estimate.status);
        self.samples.push(HandSample {
            time_s: row.time_s as f32,
            side: estimate.side,
            status: estimate.status,
            hand_px: self.camera.project(&estimate.joints.hand_m),
            hand_m: Some(estimate.joints.hand_m),
            likelihood: estimate.hand_likelihood,
            hand_std_m: estimate.hand_std_m,
            effective_sample_size: estimate.effective_sample_size,
        });
        Ok(())
    }

    fn chunk_length(&self) -> usize {
        let (width, height) = self.frames.size_px();
        let image_bytes = 3 * width as usize * height as usize;
        (CHUNK_BYTES / image_bytes.max(1)).clamp(1, MAX_CHUNK)
    }

    fn timestamp_us(&self, frame: usize) -> u64 {
        (frame as f64 * 1.0e6 / self.report.options.rate_hz).round() as u64
    }
}

/// Refuses tables that count the frames of a folder from 1.
fn check_tables(
    options: &TrackOptions,
    hands: Option<&HandTable>,
    face: &FaceSource,
    frames: &FrameSource,
) -> Result<()> {
    let Some(count) = frames.certain_count() else { return Ok(()) };
    if let (Some(table), Some(path)) = (hands, &options.hands) {
        table.check_frames(count, path)?;
    }
    if let (FaceSource::Given(table), Some(path)) = (face, &options.head) {
        table.check_frames(count, path)?;
    }
    Ok(())
}

/// Pictures among the frames would be frames of the next run, and overlays could replace the frames
/// themselves.
fn refuse_output_in_input(folder: &Path, out: &Path) -> Result<()> {
    let Ok(input) = folder.canonicalize() else { return Ok(()) };
    for output in [out.to_path_buf(), out.join("overlay")] {
        if output.canonicalize().is_ok_and(|output| output == input) {
            bail!("`{}` would receive pictures among the frames that are read; choose another --out", output.display());
        }
    }
    Ok(())
}
