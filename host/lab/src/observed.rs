//! A rendered scene after the front end: what the trackers see, beside the truth. Rendered once,
//! tracked many times.

use super::clips::Clip;
use anyhow::Result;
use image::RgbImage;
use rayon::prelude::*;
use serde_json::{Value, json};
use sinew::config::Config;
use sinew::frames::{FrameReader, FrameView};
use sinew::motion::ArmSide;
use sinew::resume::{Cells, crc32_of};
use sinew::scene::{Scene, SceneOptions, Sides};
use sinew::skin::SkinModel;
use sinew::track::{ArmStream, FaceSource, SideChoice, StreamOptions};
use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;
use std::borrow::Borrow;

/// Truth of one frame of the tracked arm.
#[derive(Debug, Clone, Copy)]
pub struct HandTruth {
    /// Hand, metres.
    pub hand_m: Vec3,
    /// Its pixel, also where it is hidden.
    pub hand_px: Pixel,
    /// Whether its skin can be seen.
    pub visible: bool,
    /// Whether a skin-coloured face is shown.
    pub false_blob: bool,
}

/// All frames of one scene as blobs and edges.
#[derive(Debug, Clone)]
pub struct ObservedScene {
    /// Name of the clip.
    pub clip: String,
    /// Seed of the scene.
    pub seed: u64,
    /// Camera and body, as a user would give them.
    pub config: Config,
    /// Image size.
    pub size_px: (u32, u32),
    /// Tracked arm.
    pub side: SideChoice,
    /// Time between frames, microseconds.
    pub frame_us: u64,
    /// What the front end found.
    pub views: Vec<FrameView>,
    /// The truth.
    pub truth: Vec<HandTruth>,
}

/// What a tracker needs of a scene or a film.
#[derive(Debug, Clone, Copy)]
pub struct Footage<'a> {
    /// Camera and body, as a user would give them.
    pub config: &'a Config,
    /// Image size.
    pub size_px: (u32, u32),
    /// Tracked arm.
    pub side: SideChoice,
    /// Seed of the tracker.
    pub seed: u64,
    /// Time between frames, microseconds.
    pub frame_us: u64,
    /// What the front end found.
    pub views: &'a [FrameView],
}

impl ObservedScene {
    /// What a tracker needs of it.
    #[must_use]
    pub fn footage(&self) -> Footage<'_> {
        let Self { config, size_px, side, seed, frame_us, views, .. } = self;
        Footage { config, size_px: *size_px, side: *side, seed: *seed, frame_us: *frame_us, views }
    }

    /// What distinguishes this scene from others that the same options and skin model make.
    #[must_use]
    pub fn key(&self) -> Value {
        json!([self.clip, self.seed, crc32_of(&self.truth)])
    }
}

/// How the pictures of a scene are read.
#[derive(Debug, Clone, Copy)]
pub enum Reading {
    /// As `sinew track arm --no-face`: what rests is learned as background.
    OverTime,
    /// As the arm paper: each picture by itself, in its own light.
    Alone,
}

/// What reads the pictures of scenes.
#[derive(Debug, Clone, Copy)]
pub struct FrontEnd<'a> {
    /// Thresholds, tracker, ranking of blobs; camera and body are those of a scene.
    pub config: &'a Config,
    /// Colours of skin.
    pub skin: &'a SkinModel,
    /// How pictures are read.
    pub reading: Reading,
}

impl FrontEnd<'_> {
    /// What the `images` of a camera of `config` show, so many a second.
    ///
    /// # Errors
    /// As [`ArmStream::see`] and [`FrameReader::read`].
    pub fn views(
        &self,
        images: impl Iterator<Item = impl Borrow<RgbImage>>,
        config: &Config,
        (rate_hz, size_px): (f32, (u32, u32)),
    ) -> Result<Vec<FrameView>> {
        match self.reading {
            Reading::OverTime => {
                let (rate_hz, config) = (f64::from(rate_hz), config.clone());
                let options = StreamOptions { rate_hz, face: FaceSource::Unknown, config, ..StreamOptions::default() };
                let mut stream = ArmStream::new(options, self.skin.clone(), size_px)?;
                let mut see = |(number, image): (usize, _)| stream.see(number, Some(Borrow::borrow(&image)), None);
                let seen = images.enumerate().filter_map(|frame| see(frame).transpose());
                seen.map(|seen| Ok(seen?.0)).collect()
            }
            Reading::Alone => {
                let mut reader = FrameReader::new(config.likelihood.build()?, config.edges.build()?)?;
                let mut read = |image: &RgbImage| Ok(reader.read(image, &*self.skin.for_image(image)?)?);
                images.map(|image| read(image.borrow())).collect()
            }
        }
    }
}

/// Renders the scene of `clip` and sends every frame through the front end.
///
/// # Errors
/// A clip that cannot be read, an option out of range.
pub fn observe(clip: &Clip, options: &SceneOptions, front_end: &FrontEnd<'_>) -> Result<ObservedScene> {
    let options = SceneOptions { sides: Sides::One(clip.side), ..options.clone() };
    let motion = clip.load(options.frames_per_second, options.frames)?;
    let scene = Scene::new(&motion, &options)?;
    let parsed = Config::parse(&scene.config_toml())?;
    let config = Config { camera: parsed.camera, body: parsed.body, ..front_end.config.clone() };
    let (rate_hz, size_px) = (options.frames_per_second, (options.width_px, options.height_px));
    let images = (0..scene.len()).map(|frame| scene.render(frame));
    let views = front_end.views(images, &config, (rate_hz, size_px))?;
    let camera = scene.camera();
    let truth = (0..scene.len()).map(|frame| {
        let truth = scene.truth(frame);
        let side = truth.sides[0];
        HandTruth {
            hand_m: side.joints.hand_m,
            hand_px: side.hand_px(&camera).unwrap_or(Pixel::new(f32::NAN, f32::NAN)),
            visible: side.hand_visible,
            false_blob: truth.false_blob,
        }
    });
    Ok(ObservedScene {
        clip: clip.name.clone(),
        seed: options.seed,
        config,
        size_px,
        side: if clip.side == ArmSide::Left { SideChoice::Left } else { SideChoice::Right },
        frame_us: (1.0e6 / f64::from(rate_hz)) as u64,
        views,
        truth: truth.collect(),
    })
}

/// All clips with all seeds, in parallel; the order does not depend on the threads.
///
/// # Errors
/// As [`observe`] and [`Cells::go_on`].
pub fn observe_all(
    clips: &[Clip],
    seeds: &[u64],
    options: &SceneOptions,
    front_end: &FrontEnd<'_>,
    cells: &Cells<'_>,
) -> Result<Vec<ObservedScene>> {
    let jobs: Vec<(&Clip, u64)> = clips.iter().flat_map(|clip| seeds.iter().map(move |&seed| (clip, seed))).collect();
    jobs.into_par_iter()
        .map(|(clip, seed)| {
            cells.go_on()?;
            observe(clip, &SceneOptions { seed, ..options.clone() }, front_end)
        })
        .collect()
}
