//! The run of one arm, as its `run.json` describes it.

use super::form::Form;
use crate::config::Config;
use crate::error::{Context, Result, ensure};
use crate::file::read_text;
use crate::person::{FaceLooks, FaceTable};
use crate::skin::{Rectangle, SkinModel};
use crate::track::{ArmSet, FrameSource, SideChoice};
use image::RgbImage;
use serde::Deserialize;
use serde_json::Value;
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::options::LimbCombination;
use sinew_record::ArmSetup;
use std::path::{Path, PathBuf};

/// Frames that are read ahead.
const CHUNK: usize = 8;

/// The pictures of a run and how the tracker saw them.
#[derive(Debug)]
pub(crate) struct SeenFrames {
    pub frames: FrameSource,
    pub skin: SkinModel,
    pub config: Config,
}

impl SeenFrames {
    /// Opens the images or the video that the `options` of a run's record name.
    pub fn open(options: &Value) -> Result<Self> {
        let text = |name: &str| options[name].as_str().with_context(|| format!("run.json has no option `{name}`"));
        let config: Config =
            serde_json::from_value(options["config"].clone()).context("run.json has no configuration")?;
        let rate_hz = options["rate_hz"].as_f64().context("run.json has no option `rate_hz`")?;
        let frames = FrameSource::open(Path::new(text("folder")?), false, rate_hz)?;
        let mut skin = SkinModel::from_option(text("skin")?)?;
        if let Some(rectangle) = rectangle(&options["calibrate"]) {
            skin = skin.calibrated(frames.first().1, rectangle)?;
        }
        Ok(Self { frames, skin, config })
    }
}

/// What is needed to see the frames of a run again.
#[derive(Debug)]
pub(super) struct ArmRun {
    pub frames: FrameSource,
    pub skin: SkinModel,
    pub config: Config,
    pub setup: ArmSetup,
    pub rate_hz: f64,
    /// Whether it looked for a face in lines.
    looks: bool,
    /// Table of faces.
    head: Option<PathBuf>,
}

impl ArmRun {
    /// Reads `run.json` and opens the images that it names.
    pub fn open(report: &Path, form: Form) -> Result<Self> {
        let json: Value = serde_json::from_str(&read_text(report)?).context("run.json is not JSON")?;
        let options = &json["options"];
        let text = |name: &str| options[name].as_str().with_context(|| format!("run.json has no option `{name}`"));
        let side = SideChoice::deserialize(Value::from(text("side")?)).unwrap_or_default();
        ensure!(
            side != SideChoice::Both,
            "both arms were tracked; firmware plays one: `--side left` or `--side right`"
        );
        let reads_lines = options["front_end"] == "lines";
        ensure!(
            options["hands"].is_null(),
            "its hands came from --hands, and firmware's stream holds blobs; run `sinew track arm` without"
        );
        ensure!(
            reads_lines && form == Form::Camera || json["seen"]["with_face"].as_u64().is_none_or(|frames| frames == 0),
            "its hands came from a face, and this stream holds blobs; run `sinew track arm` with --no-face, or with \
             --front-end lines and `sinew record` with --form camera"
        );
        let seed = options["seed"].as_u64().context("run.json has no option `seed`")?;
        let rate_hz = options["rate_hz"].as_f64().context("run.json has no option `rate_hz`")?;
        let SeenFrames { frames, skin, config } = SeenFrames::open(options)?;
        let setup = setup(&config, frames.size_px(), side, seed)?;
        let looks = reads_lines && options["face"] == true;
        let head = options["head"].as_str().map(PathBuf::from);
        Ok(Self { frames, skin, config, setup, rate_hz, looks, head })
    }

    /// Where its faces came from, in pictures whose pixels are blocks; none of a run without.
    pub fn faces(&self, block: u32) -> Result<Option<FaceLooks>> {
        let given = self.head.as_deref().map(FaceTable::read).transpose()?;
        self.looks.then(|| FaceLooks::new(self.rate_hz, block, given)).transpose()
    }

    /// Shows every frame with its time in microseconds, once and in order; `None` is an image that
    /// cannot be read. Gives their number.
    pub fn each_frame(&mut self, mut show: impl FnMut(usize, u64, Option<RgbImage>) -> Result<()>) -> Result<usize> {
        let mut frame = 0;
        loop {
            let images = self.frames.load(frame, CHUNK)?;
            if images.is_empty() {
                return Ok(frame);
            }
            for image in images {
                show(frame, (frame as f64 * 1.0e6 / self.rate_hz).round() as u64, image.ok())?;
                frame += 1;
            }
        }
    }
}

fn rectangle(json: &Value) -> Option<Rectangle> {
    let number = |name: &str| json[name].as_u64().and_then(|value| u32::try_from(value).ok());
    let [x_px, y_px, width_px, height_px] = ["x_px", "y_px", "width_px", "height_px"].map(number);
    Some(Rectangle { x_px: x_px?, y_px: y_px?, width_px: width_px?, height_px: height_px? })
}

/// The arm as a record, if it says everything of it.
fn setup(config: &Config, size_px: (u32, u32), side: SideChoice, seed: u64) -> Result<ArmSetup> {
    let arms = ArmSet::new(config, size_px, side, seed)?;
    let model = arms.models().first().context("no arm was tracked")?;
    let [left_m, right_m] = config.body.shoulders_m();
    let (camera, geometry, options) = (model.camera(), model.geometry(), model.options());
    let setup = ArmSetup {
        focal_px: [camera.focal_px(); 2],
        centre: camera.centre(),
        image_size_px: [size_px.0, size_px.1],
        side: geometry.side,
        lengths_m: [geometry.upper_arm_m, geometry.forearm_m],
        shoulder_m: if geometry.side == Side::Left { left_m } else { right_m },
        particles: u16::try_from(options.particles)?,
        product_floor: match options.combination {
            LimbCombination::Mean => None,
            LimbCombination::Auto | LimbCombination::Product => Some(options.product_floor),
        },
        area_cue: options.area_cue,
        seed,
    };
    ensure!(
        setup.model()? == *model,
        "it was tracked with options that firmware's records do not hold: a record has the arm's lengths, shoulders, seed and \
         particles, a camera with square pixels and without distortion, and the defaults of [tracker]"
    );
    Ok(setup)
}
