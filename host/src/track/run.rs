//! One run over an image folder or a video: load, read, step, record, frame by frame.

use super::arms::{ArmSet, ArmView};
use super::input::SkippedImage;
use super::options::{FrontEnd, RATES_HZ, TrackOptions};
use super::particles::{PARTICLE_HEADER, particle_rows};
use super::pictures::{Pictures, Shot};
use super::report::RunReport;
use super::resume;
use super::sample::HandSample;
use super::source::FrameSource;
use super::table::{HEADER, TrackRow};
use super::vision::RunVision;
use crate::error::{Result, WriteContext, bail};
use crate::frames::FrameView;
use crate::output::{OutputDir, OutputLock, PendingFile};
use crate::person::{GivenHands, HandTable};
use crate::resume::{Begun, Checkpoints, PARTICLE_TABLE, TRACK_TABLE};
use crate::skin::SkinModel;
use image::RgbImage;
use sinew_core::camera::Camera;
use sinew_core::math::Vec3;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Maximum number of frames that are read ahead.
const MAX_CHUNK: usize = 32;
/// Memory that frames which are read ahead may take, bytes.
const CHUNK_BYTES: usize = 64 << 20;

/// What a frame showed.
#[derive(Debug)]
struct Seen {
    view: FrameView,
    /// Hands that take the place of the view's candidates.
    hands: Option<GivenHands>,
    /// By the face.
    shoulders_m: Option<[Vec3; 2]>,
}

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
    pub(super) skin: SkinModel,
    pub(super) vision: RunVision,
    pub(super) arms: ArmSet,
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
        if !(RATES_HZ[0]..=RATES_HZ[1]).contains(&options.rate_hz) {
            bail!("`rate` must lie from {} to {} Hz, not {}", RATES_HZ[0], RATES_HZ[1], options.rate_hz);
        }
        if options.front_end == FrontEnd::Lines && options.hands.is_some() {
            bail!("--hands takes the place of what is seen, and --front-end lines is a way to see: leave one out");
        }
        let trained = SkinModel::from_option(&options.skin)?;
        let frames = FrameSource::open(&options.folder, options.strict, options.rate_hz)?;
        let skin = match (options.calibrate, frames.first()) {
            (None, _) => trained,
            (Some(rectangle), (0, first)) => trained.calibrated(first, rectangle)?,
            (Some(_), _) => bail!(
                "`{}` cannot be read, and --calibrate needs the first image; take it out",
                frames.files()[0].display()
            ),
        };
        let (width, height) = frames.size_px();
        let camera = options.config.camera.build(width, height)?;
        let block = RunVision::block(&options, frames.size_px());
        let (seen_by, seen_px) = (camera.of_blocks(block), (width / block, height / block));
        let arms = ArmSet::of_camera(&options.config, (seen_by, seen_px), options.side, options.seed)?;
        let vision = RunVision::new(&options, (frames.size_px(), frames.first().1), camera, &skin)?;
        let hands = options.hands.as_deref().map(HandTable::read).transpose()?;
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
            skin,
            vision,
            arms,
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
                pictures.draw(&shots, &self.arms)?;
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
        let seen = image.as_ref().map(|image| self.see(frame, image)).transpose()?;
        let arms = self.step(frame, seen.as_ref());
        let view = seen.map(|seen| seen.view);
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
        Ok(drawn.map(|(image, view)| shot((self.vision.seen(image), view))))
    }

    /// Moves the trackers on to a frame.
    fn step(&mut self, frame: usize, seen: Option<&Seen>) -> Vec<ArmView> {
        let timestamp_us = self.timestamp_us(frame);
        let Some(Seen { view, hands, shoulders_m }) = seen else { return self.arms.step(timestamp_us, None) };
        if let Some(shoulders_m) = shoulders_m {
            self.arms.place_shoulders(shoulders_m);
        }
        self.report.seen.count(view, shoulders_m.is_some(), &self.arms);
        match hands {
            Some(GivenHands::OfPerson(hands)) => self.arms.step_hands(timestamp_us, &view.edges, hands),
            Some(GivenHands::OfSides(hands)) => self.arms.step_each(timestamp_us, &view.edges, hands),
            None => self.arms.step(timestamp_us, Some(view)),
        }
    }

    /// What an image shows. Hands that are given take the place of blobs, and of the person's.
    fn see(&mut self, frame: usize, image: &RgbImage) -> Result<Seen> {
        let (mut view, person) = self.vision.see(frame, image)?;
        let shoulders_m = person.as_ref().map(|person| person.shoulders_m);
        let given = self.hands.as_ref().map(|hands| hands.at(frame));
        if let Some(hands) = &given {
            view.blobs.clear();
            view.candidates = match hands {
                GivenHands::OfPerson(hands) => hands.clone(),
                GivenHands::OfSides(hands) => hands.concat(),
            };
        }
        let hands = given.or_else(|| Some(GivenHands::OfSides(person?.hands)));
        Ok(Seen { view, hands, shoulders_m })
    }

    /// Notes a missing image; the next one has no frame before it.
    fn skip(&mut self, skipped: SkippedImage, notify: &mut dyn FnMut(Event<'_>)) {
        notify(Event::Skipped(&skipped));
        self.report.skipped.push(skipped);
        self.vision.forget_last_frame();
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
