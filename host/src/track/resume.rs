//! Going on with a run that Ctrl-C ended: `resume.json` holds what the other files of the run directory do not.

use super::input::SkippedImage;
use super::run::{TrackOptions, TrackRun};
use crate::draw::plot::HandSample;
use crate::output::{OutputDir, PendingFile};
use crate::skin::model_file;
use anyhow::{Context, Result, bail, ensure};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::Status;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

/// Name of the file in the run directory.
pub const RESUME_FILE: &str = "resume.json";
/// Version of its form.
const VERSION: u32 = 1;
/// What to do where a run cannot be gone on with.
const REMEDY: &str = "leave --resume out to begin anew";

/// The content of [`RESUME_FILE`].
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Left {
    version: u32,
    sinew_version: String,
    /// All options but the folder.
    options: Value,
    /// The folder, absolute.
    folder: PathBuf,
    /// What tells the frames from others.
    frames: Vec<String>,
    frames_finished: usize,
    seconds: f64,
    skipped: Vec<SkippedImage>,
    /// CRC-32 of the skin model as it was used, calibrated if that was asked for.
    skin_crc32: u32,
    /// CRC-32 of the pixels of the last finished frame; none where its image could not be read.
    last_image_crc32: Option<u32>,
    /// CRC-32 of each table.
    tables_crc32: BTreeMap<String, u32>,
    /// The trackers' state, base64 of a saved state of the core.
    trackers: String,
    /// What the plots show, base64 of little-endian words.
    samples: String,
}

impl Left {
    /// Of a run that goes no further; its tables are added by [`Left::write`].
    pub fn of(run: &mut TrackRun) -> Result<Self> {
        let finished = run.report.frames_finished;
        Ok(Self {
            version: VERSION,
            sinew_version: env!("CARGO_PKG_VERSION").to_owned(),
            options: compared(&run.report.options)?,
            folder: absolute(&run.report.options.folder)?,
            frames: run.frames.identity(),
            frames_finished: finished,
            seconds: run.seconds,
            skipped: run.report.skipped.clone(),
            skin_crc32: crc32fast::hash(model_file::to_json(&run.skin)?.as_bytes()),
            last_image_crc32: run.last_image_crc32,
            tables_crc32: BTreeMap::new(),
            trackers: STANDARD.encode(run.arms.saved()?),
            samples: STANDARD.encode(run.samples.iter().flat_map(sample_bytes).collect::<Vec<u8>>()),
        })
    }

    /// Writes the file beside the tables that it belongs to; without anything left removes that of an earlier run.
    pub fn write(left: Option<Self>, out: &OutputDir) -> Result<()> {
        let path = out.join(RESUME_FILE);
        let Some(mut left) = left else {
            return match fs::remove_file(&path) {
                Err(error) if path.exists() => Err(error).context(format!("`{}` cannot be removed", path.display())),
                _ => Ok(()),
            };
        };
        for name in ["track.csv", "particles.csv"] {
            if name == "track.csv" || left.options["particles_csv"] == true {
                let sum = copy_with_sum(&out.join(name), &mut std::io::sink())?;
                left.tables_crc32.insert(name.to_owned(), sum);
            }
        }
        out.write(RESUME_FILE, |writer| Ok(serde_json::to_writer_pretty(writer, &left)?))
    }

    fn read(out: &Path) -> Result<Self> {
        let path = out.join(RESUME_FILE);
        if !path.exists() {
            let complete =
                fs::read(out.join("run.json")).ok().and_then(|bytes| serde_json::from_slice::<Value>(&bytes).ok());
            match complete {
                Some(report) if report["complete"] == true => {
                    bail!("the run in `{}` is complete; {REMEDY}", out.display())
                }
                _ => bail!("`{}` holds no run that Ctrl-C ended (no {RESUME_FILE}); {REMEDY}", out.display()),
            }
        }
        let text =
            fs::read_to_string(&path).with_context(|| format!("`{}` cannot be read; {REMEDY}", path.display()))?;
        let value: Value =
            serde_json::from_str(&text).with_context(|| format!("`{}` is not JSON; {REMEDY}", path.display()))?;
        ensure!(
            value["version"] == VERSION && value["sinew_version"] == env!("CARGO_PKG_VERSION"),
            "`{}` was written by sinew {}, and this is {}; {REMEDY}",
            path.display(),
            value["sinew_version"].as_str().unwrap_or("of another version"),
            env!("CARGO_PKG_VERSION")
        );
        serde_json::from_value(value).with_context(|| format!("`{}` is not whole; {REMEDY}", path.display()))
    }

    /// Refuses options that would give other results.
    fn check(&self, options: &TrackOptions, out: &Path) -> Result<()> {
        if let Some((name, before, now)) = first_difference(&self.options, &compared(options)?, String::new()) {
            bail!(
                "the run in `{}` was begun with {name} = {before}, not {now}; give the same, or {REMEDY}",
                out.display()
            );
        }
        let folder = absolute(&options.folder)?;
        ensure!(
            self.folder == folder,
            "the run in `{}` was begun on `{}`, not on `{}`; give the same, or {REMEDY}",
            out.display(),
            self.folder.display(),
            folder.display()
        );
        Ok(())
    }

    /// Refuses other images or another skin than the run was begun with.
    fn check_inputs(&self, run: &TrackRun) -> Result<()> {
        let (before, now) = (&self.frames, &run.frames.identity());
        if before != now {
            let place = before.iter().zip(now).position(|(a, b)| a != b).unwrap_or(before.len().min(now.len()));
            let name = |files: &[String]| files.get(place).cloned().unwrap_or_else(|| "none".to_owned());
            bail!(
                "the frames of `{}` have changed: number {place} was {} and is {}; {REMEDY}",
                self.folder.display(),
                name(before),
                name(now)
            );
        }
        let skin_crc32 = crc32fast::hash(model_file::to_json(&run.skin)?.as_bytes());
        ensure!(self.skin_crc32 == skin_crc32, "the skin model is not the one that the run was begun with; {REMEDY}");
        Ok(())
    }
}

impl TrackRun {
    /// Checks everything as [`TrackRun::prepare`] does, and takes up the run in `out` that was ended by Ctrl-C: what it will have
    /// written at its end is, bit for bit, what it would have written without a break, but for `frames_per_second` in `run.json`.
    ///
    /// # Errors
    /// As [`TrackRun::prepare`]; there is no such run in `out`, or it was begun with other options, images or another version.
    pub fn resume(options: TrackOptions, out: &Path) -> Result<Self> {
        let left = Left::read(out)?;
        left.check(&options, out)?;
        let mut run = Self::prepare(options, out)?;
        left.check_inputs(&run)?;
        run.track = left.reopened("track.csv", &run.out)?;
        if run.particles.is_some() {
            run.particles = Some(left.reopened("particles.csv", &run.out)?);
        }
        let decoded =
            |text: &str| STANDARD.decode(text).with_context(|| format!("`{RESUME_FILE}` is not whole; {REMEDY}"));
        run.arms.restore(&decoded(&left.trackers)?)?;
        run.samples = samples(&decoded(&left.samples)?)?;
        for sample in &run.samples {
            run.report.count(sample.side, sample.status);
        }
        run.report.frames_finished = left.frames_finished;
        run.seconds = left.seconds;
        if let Some(pictures) = &mut run.pictures {
            let is_drawn = |frame: &usize| !left.skipped.iter().any(|skipped| skipped.frame == *frame);
            let drawn = (0..left.frames_finished).filter(is_drawn);
            pictures.take_up(drawn.map(|frame| (frame, run.frames.name(frame))))?;
        }
        run.look_again(left.last_image_crc32)?;
        run.report.skipped = left.skipped;
        Ok(run)
    }

    /// Shows the front end the last finished frame, so that the next one has the edges that it would have had.
    fn look_again(&mut self, crc32: Option<u32>) -> Result<()> {
        let Some(last) = self.report.frames_finished.checked_sub(1) else { return Ok(()) };
        let image = self.frames.load(last, 1)?.pop().and_then(Result::ok);
        self.last_image_crc32 = crc32;
        ensure!(
            crc32 == image.as_ref().map(|image| crc32fast::hash(image.as_raw())),
            "`{}` has changed since the run was ended; {REMEDY}",
            self.frames.name(last)
        );
        if let Some(image) = image {
            self.reader.read(&image, &self.skin)?;
        }
        Ok(())
    }
}

impl Left {
    /// The table of the finished frames, to be written on.
    fn reopened(&self, name: &str, out: &OutputDir) -> Result<csv::Writer<PendingFile>> {
        let mut pending = out.begin(name)?;
        let sum = copy_with_sum(&out.join(name), &mut pending)?;
        ensure!(
            self.tables_crc32.get(name) == Some(&sum),
            "`{}` has changed since the run was ended; {REMEDY}",
            out.join(name).display()
        );
        Ok(csv::Writer::from_writer(pending))
    }
}

/// What has to be equal: all options but the folder, which is compared as a place.
fn compared(options: &TrackOptions) -> Result<Value> {
    // By way of text, as what is read from a file.
    let mut value: Value = serde_json::from_str(&serde_json::to_string(options)?)?;
    if let Some(map) = value.as_object_mut() {
        map.remove("folder");
    }
    Ok(value)
}

fn absolute(folder: &Path) -> Result<PathBuf> {
    folder
        .canonicalize()
        .with_context(|| format!("`{}` cannot be found; give the folder of the frames", folder.display()))
}

/// The name of the first option that differs, and its two values.
fn first_difference(before: &Value, now: &Value, name: String) -> Option<(String, Value, Value)> {
    let (Some(old), Some(new)) = (before.as_object(), now.as_object()) else {
        return (before != now).then(|| (name, before.clone(), now.clone()));
    };
    let below = |key: &str| if name.is_empty() { key.to_owned() } else { format!("{name}.{key}") };
    let keys = old.keys().chain(new.keys().filter(|key| !old.contains_key(*key)));
    let value = |map: &serde_json::Map<String, Value>, key: &str| map.get(key).cloned().unwrap_or(Value::Null);
    keys.into_iter().find_map(|key| first_difference(&value(old, key), &value(new, key), below(key)))
}

/// Copies a file and gives its CRC-32.
fn copy_with_sum(path: &Path, to: &mut dyn Write) -> Result<u32> {
    let mut inner = || -> Result<u32> {
        let (mut file, mut hasher, mut buffer) = (File::open(path)?, crc32fast::Hasher::new(), vec![0; 1 << 16]);
        loop {
            let count = file.read(&mut buffer)?;
            if count == 0 {
                return Ok(hasher.finalize());
            }
            hasher.update(&buffer[..count]);
            to.write_all(&buffer[..count])?;
        }
    };
    inner().with_context(|| format!("`{}` cannot be read; {REMEDY}", path.display()))
}

/// Words of a sample: time, side and status, the hand in the image and in space, each with whether it is known, and three numbers.
const SAMPLE_WORDS: usize = 12;

fn sample_bytes(sample: &HandSample) -> [u8; 4 * SAMPLE_WORDS] {
    let side = u32::from(sample.side == Side::Right);
    let status = match sample.status {
        Status::Tracking => 0,
        Status::Predicted => 1,
        Status::Lost => 2,
    };
    let (pixel, place) = (sample.hand_px.unwrap_or_default(), sample.hand_m.unwrap_or_default());
    let known = u32::from(sample.hand_px.is_some()) + 2 * u32::from(sample.hand_m.is_some());
    let reals = [
        sample.time_s,
        pixel.u_px,
        pixel.v_px,
        place.x,
        place.y,
        place.z,
        sample.likelihood,
        sample.hand_std_m,
        sample.effective_sample_size,
    ];
    let mut words = [side, status, known].into_iter().chain(reals.map(f32::to_bits)).flat_map(u32::to_le_bytes);
    std::array::from_fn(|_| words.next().unwrap_or(0))
}

fn samples(bytes: &[u8]) -> Result<Vec<HandSample>> {
    let (samples, rest) = bytes.as_chunks::<{ 4 * SAMPLE_WORDS }>();
    ensure!(rest.is_empty(), "`{RESUME_FILE}` is not whole; {REMEDY}");
    let sample = |bytes: &[u8; 4 * SAMPLE_WORDS]| {
        let words: [u32; SAMPLE_WORDS] = std::array::from_fn(|i| u32::from_le_bytes(bytes.as_chunks::<4>().0[i]));
        let [side, status, known, reals @ ..] = words;
        let [time_s, u_px, v_px, x, y, z, likelihood, hand_std_m, effective_sample_size] = reals.map(f32::from_bits);
        HandSample {
            time_s,
            side: if side == 1 { Side::Right } else { Side::Left },
            status: [Status::Tracking, Status::Predicted, Status::Lost][status.min(2) as usize],
            hand_px: (known & 1 != 0).then_some(Pixel::new(u_px, v_px)),
            hand_m: (known & 2 != 0).then_some(Vec3::new(x, y, z)),
            likelihood,
            hand_std_m,
            effective_sample_size,
        }
    };
    Ok(samples.iter().map(sample).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn samples_come_back_bit_for_bit() {
        let all = [
            HandSample {
                time_s: 0.1,
                side: Side::Left,
                status: Status::Lost,
                hand_px: None,
                hand_m: Some(Vec3::new(0.1, -0.2, 1.0 / 3.0)),
                likelihood: 0.7,
                hand_std_m: f32::MIN_POSITIVE,
                effective_sample_size: 49.9,
            },
            HandSample {
                time_s: 7.0,
                side: Side::Right,
                status: Status::Predicted,
                hand_px: Some(Pixel::new(1.5, -0.0)),
                hand_m: None,
                likelihood: 0.0,
                hand_std_m: 0.3,
                effective_sample_size: 1.0,
            },
        ];
        let bytes: Vec<u8> = all.iter().flat_map(sample_bytes).collect();
        assert_eq!(samples(&bytes).unwrap(), all);
        assert!(samples(&bytes[1..]).is_err());
    }

    #[test]
    fn the_first_difference_is_named_with_its_section() {
        let old = json!({ "a": 1, "b": { "c": 0.5, "d": [1, 2] } });
        let difference = |new: Value| first_difference(&old, &new, String::new());
        assert_eq!(difference(old.clone()), None);
        let (name, before, now) = difference(json!({ "a": 1, "b": { "c": 0.5, "d": [1, 3] } })).unwrap();
        assert_eq!((name.as_str(), before, now), ("b.d", json!([1, 2]), json!([1, 3])));
        let (name, _, now) = difference(json!({ "a": 1, "b": { "c": 0.5, "d": [1, 2] }, "e": true })).unwrap();
        assert_eq!((name.as_str(), now), ("e", json!(true)));
    }
}
