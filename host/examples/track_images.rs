//! Images in memory to an arm: a person is rendered with known truth, tracked, and compared.
//!
//!     cargo run --release -p sinew --example track_images

use anyhow::{Context, Result, ensure};
use sinew::config::Config;
use sinew::frames::FrameReader;
use sinew::motion::{ArmSide, reach};
use sinew::scene::{Scene, SceneOptions, Sides};
use sinew::skin::model::{DEFAULT_SKIN, SkinModel};
use sinew::track::{ArmSet, SideChoice};

const FRAMES: usize = 60;
const RATE_HZ: f32 = 15.0;
/// The tracker needs a second to find the arm.
const FIRST_SCORED_FRAME: usize = 16;

fn main() -> Result<()> {
    // Any `image::RgbImage` would do; these come from a renderer, so that the truth is known.
    let options = SceneOptions {
        frames: FRAMES,
        frames_per_second: RATE_HZ,
        sides: Sides::One(ArmSide::Right),
        ..SceneOptions::default()
    };
    let scene = Scene::new(&reach::random_reaches(1, RATE_HZ, FRAMES)?, &options)?;
    let camera = scene.camera();

    // The camera and the person as the scene has them; a configuration file says the same.
    let config: Config = Config::parse(&scene.config_toml())?;
    let skin = SkinModel::from_option(DEFAULT_SKIN)?;
    let mut reader = FrameReader::new(config.likelihood.build()?, config.edges.build()?)?;
    let mut arms = ArmSet::new(&config, (options.width_px, options.height_px), SideChoice::Right, 1)?;

    let mut errors_px = Vec::new();
    for frame in 0..scene.len() {
        let image = scene.render(frame);
        let view = reader.read(&image, &*skin.for_image(&image)?)?;
        let timestamp_us = (frame as f64 * 1.0e6 / f64::from(RATE_HZ)) as u64;
        let arm = arms.step(timestamp_us, Some(&view)).remove(0);
        if frame >= FIRST_SCORED_FRAME {
            let truth = scene.truth(frame).sides[0].hand_px(&camera).context("the true hand is in view")?;
            let hand_px = camera.project(&arm.estimate.joints.hand_m).context("the hand is in front of the camera")?;
            errors_px.push(hand_px.distance_px(truth));
        }
    }
    errors_px.sort_by(f32::total_cmp);
    let median_px = errors_px[errors_px.len() / 2];
    println!("median error of the right hand: {median_px:.1} px in images of {} px", options.width_px);
    ensure!(median_px < 20.0, "{median_px} px");
    Ok(())
}
