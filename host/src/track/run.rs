//! One run over an image folder or a video: load, read, step, record, frame by frame.

use super::arms::{ArmSet, SideChoice};
use super::input::SkippedImage;
use super::particles::{PARTICLE_HEADER, particle_rows};
use super::pictures::{Pictures, Shot};
use super::report::RunReport;
use super::resume;
use super::sample::HandSample;
use super::source::FrameSource;
use super::table::{HEADER, TrackRow};
use crate::config::Config;
use crate::error::{Context, Error, Result, WriteContext, bail};
use crate::frames::{FrameReader, FrameView};
use crate::output::{OutputDir, PendingFile};
use crate::resume::Interrupted;
use crate::skin::{Rectangle, SkinModel};
use image::RgbImage;
use serde::Serialize;
use sinew_core::camera::Camera;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Slowest and fastest rate of frames, Hz.
pub const RATES_HZ: [f64; 2] = [0.001, 10_000.0];
/// Most frames that are read ahead.
const MAX_CHUNK: usize = 32;
/// Memory that frames which are read ahead may take, bytes.
const CHUNK_BYTES: usize = 64 << 20;

/// Everything that decides the result of a run.
#[derive(Debug, Clone, Serialize)]
pub struct TrackOptions {
    /// Folder of the frames, or a video.
    pub folder: PathBuf,
    /// Which arms.
    pub side: SideChoice,
    /// Frames per second of the camera; of a video, how many are taken.
    pub rate_hz: f64,
    /// Seed of all that is random.
    pub seed: u64,
    /// The skin model, as for `--skin`.
    pub skin: String,
    /// Rectangle of skin in the first frame.
    pub calibrate: Option<Rectangle>,
    /// Whether overlays and a contact sheet are drawn.
    pub overlay: bool,
    /// Whether every particle is written.
    pub particles_csv: bool,
    /// Whether an unreadable image is refused.
    pub strict: bool,
    /// Camera, person, tracker, thresholds.
    pub config: Config,
}

/// What a run tells while it goes on.
#[derive(Debug, Clone, Copy)]
pub enum Event<'a> {
    /// An image could not be read.
    Skipped(&'a SkippedImage),
    /// So many frames are in the table.
    Finished(usize),
}

/// What a run returns beside its files.
#[derive(Debug, Clone)]
pub struct RunOutcome {
    /// The content of `run.json`.
    pub report: RunReport,
    /// Every side's answer to every finished frame, in the order of frames; places are given for a lost arm, too.
    pub samples: Vec<HandSample>,
}

/// A run whose inputs were all checked.
#[derive(Debug)]
pub struct TrackRun {
    pub(super) frames: FrameSource,
    pub(super) skin: SkinModel,
    pub(super) reader: FrameReader,
    pub(super) arms: ArmSet,
    camera: Camera,
    pub(super) out: OutputDir,
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
        if !(RATES_HZ[0]..=RATES_HZ[1]).contains(&options.rate_hz) {
            bail!("`rate` must lie from {} to {} Hz, not {}", RATES_HZ[0], RATES_HZ[1], options.rate_hz);
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
        let arms = ArmSet::new(&options.config, frames.size_px(), options.side, options.seed)?;
        let camera = *arms.models().first().context("no arm is tracked")?.camera();
        let reader = FrameReader::new(options.config.likelihood.build()?, options.config.edges.build()?)?;
        refuse_output_in_input(&options.folder, out)?;
        let out = OutputDir::create(out)?;
        let pictures = if options.overlay { Some(Pictures::new(&frames, out.subfolder("overlay")?)?) } else { None };
        let table = |name: &str, header: &[&str]| -> Result<csv::Writer<PendingFile>> {
            let mut writer = csv::Writer::from_writer(out.begin(name)?);
            writer.write_record(header)?;
            Ok(writer)
        };
        let track = table("track.csv", &HEADER)?;
        let particles = if options.particles_csv { Some(table("particles.csv", &PARTICLE_HEADER)?) } else { None };
        let names = (0..frames.files().len()).map(|frame| frames.name(frame)).collect();
        let report = RunReport { frames: frames.count(), ..RunReport::new(options, names, frames.size_px()) };
        Ok(Self {
            frames,
            skin,
            reader,
            arms,
            camera,
            out,
            pictures,
            track,
            particles,
            report,
            samples: Vec::new(),
            seconds: 0.0,
            last_image_crc32: None,
        })
    }

    /// Number of frames; of a video, what it says.
    #[must_use]
    pub fn frame_count(&self) -> usize {
        self.frames.count()
    }

    /// Number of frames that were finished before the run was ended and taken up again; otherwise none.
    #[must_use]
    pub fn frames_finished(&self) -> usize {
        self.report.frames_finished
    }

    /// Tracks all frames, or those before `stop` is set, and writes the run directory.
    ///
    /// # Errors
    /// [`Interrupted`] if `stop` was set, or an output that cannot be written; the table of the finished frames is written all
    /// the same.
    pub fn run(mut self, stop: &AtomicBool, notify: &mut dyn FnMut(Event<'_>)) -> Result<RunOutcome> {
        let start = Instant::now();
        let out = self.out.path().to_path_buf();
        let tracked = self.track_all(stop, notify);
        let finished = self.report.frames_finished;
        if matches!(self.frames, FrameSource::Video(_)) {
            // Only now it is known how many there are.
            self.report.inputs.files = (0..finished).map(|frame| self.frames.name(frame)).collect();
            self.report.frames = if matches!(tracked, Ok(true)) { finished } else { self.report.frames.max(finished) };
        }
        let frames = self.report.frames;
        self.seconds += start.elapsed().as_secs_f64();
        self.report.frames_per_second = finished as f64 / self.seconds.max(1.0e-9);
        self.report.complete = matches!(tracked, Ok(true));
        let interrupted = matches!(tracked, Ok(false));
        let written = self.write_results(interrupted);
        if let Err(error) = tracked {
            let kept = match &written {
                Ok(_) => format!("the results of the {finished} finished frames are in `{}`", out.display()),
                Err(other) => format!("and then {}", other.chain()),
            };
            return Err(Error::Unfinished { error: Box::new(error), kept });
        }
        let outcome = written?;
        if interrupted {
            return Err(Interrupted { finished, all: Some(frames), unit: "frames", out }.into());
        }
        Ok(outcome)
    }

    /// Whether the last frame was reached.
    fn track_all(&mut self, stop: &AtomicBool, notify: &mut dyn FnMut(Event<'_>)) -> Result<bool> {
        let (most, mut begin) = (self.chunk_length(), self.report.frames_finished);
        loop {
            let images = self.frames.load(begin, most)?;
            if images.is_empty() {
                return Ok(true);
            }
            let mut shots = Vec::new();
            for (frame, image) in (begin..).zip(images) {
                if stop.load(Ordering::Relaxed) {
                    break;
                }
                shots.extend(self.track_frame(frame, image, notify)?);
                notify(Event::Finished(self.report.frames_finished));
            }
            if let Some(pictures) = &mut self.pictures {
                pictures.draw(&shots, &self.arms)?;
            }
            begin += most;
            if stop.load(Ordering::Relaxed) {
                // A folder's last frame is known as such.
                let is_folder = matches!(self.frames, FrameSource::Folder(_));
                return Ok(is_folder && self.report.frames_finished == self.frames.count());
            }
        }
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
        let view = image.as_ref().map(|image| self.reader.read(image, &self.skin)).transpose()?;
        let arms = self.arms.step(self.timestamp_us(frame), view.as_ref());
        for arm in &arms {
            let row = TrackRow {
                frame,
                image: self.frames.name(frame),
                time_s: frame as f64 / self.report.options.rate_hz,
                view: arm.clone(),
                blob_count: view.as_ref().map(|view| view.blobs.len()),
                dropped_blobs: view.as_ref().map_or(0, |view| view.dropped_blobs),
            };
            self.record(&row)?;
        }
        self.report.frames_finished += 1;
        let name = self.frames.name(frame);
        let shot = |(image, view): (RgbImage, FrameView)| Shot { frame, name, image, view, arms };
        Ok(image.zip(view).filter(|_| self.pictures.is_some()).map(shot))
    }

    /// Notes a missing image; the next one has no frame before it.
    fn skip(&mut self, skipped: SkippedImage, notify: &mut dyn FnMut(Event<'_>)) {
        notify(Event::Skipped(&skipped));
        self.report.skipped.push(skipped);
        self.reader.forget_last_frame();
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

    /// Gives the tables their names and writes plot, sheet and report. Each file is tried, also where another one failed. An
    /// interrupted run leaves what [`TrackRun::resume`] needs.
    fn write_results(mut self, interrupted: bool) -> Result<RunOutcome> {
        let left = if interrupted { Some(resume::left(&mut self)?) } else { None };
        let Self { out, track, particles, pictures, report, samples, .. } = self;
        let mut results = vec![finish(track)];
        results.extend(particles.map(finish));
        let json = serde_json::to_string_pretty(&report)? + "\n";
        results.push(out.write("run.json", |writer| Ok(writer.write_all(json.as_bytes())?)));
        #[cfg(feature = "plots")]
        results.push(
            crate::draw::plot::hand_plot(&samples, report.image_size_px)
                .and_then(|plot| out.write_png("hand.png", &plot)),
        );
        results.extend(pictures.map(|pictures| out.write_png("contact_sheet.png", &pictures.contact_sheet())));
        results.into_iter().collect::<Result<()>>()?;
        resume::put(left, &report.options, &out)?;
        Ok(RunOutcome { report, samples })
    }
}

fn finish(table: csv::Writer<PendingFile>) -> Result<()> {
    let file = table.into_inner().writing(|| "a table cannot be written")?;
    file.finish()
}

/// Pictures among the frames would be frames of the next run, and overlays could replace the frames themselves.
fn refuse_output_in_input(folder: &Path, out: &Path) -> Result<()> {
    let Ok(input) = folder.canonicalize() else { return Ok(()) };
    for output in [out.to_path_buf(), out.join("overlay")] {
        if output.canonicalize().is_ok_and(|output| output == input) {
            bail!("`{}` would receive pictures among the frames that are read; choose another --out", output.display());
        }
    }
    Ok(())
}
