//! Recorded input of each image, made anew from synthetic motions: the same bytes on every machine.

use anyhow::Result;
use sinew::config::Config;
use sinew::cyclic::tracking::TrackingOptions;
use sinew::cyclic::{AngleRow, AngleTable, CyclicModel};
use sinew::motion::{ArmSide, reach};
use sinew::output::OutputDir;
use sinew::record::{Form, cyclic_stream, interleaved, record};
use sinew::scene::{Scene, SceneOptions, Sides};
use sinew::skin::model::DEFAULT_SKIN;
use sinew::track::{FrontEnd, RunOutcome, SideChoice, TrackOptions, TrackRun};
use sinew_core::random::Stream;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Input of the image `name`; `None` for an image that reads none.
///
/// # Errors
/// None in practice.
pub fn of_image(name: &str) -> Result<Option<Vec<u8>>> {
    match name {
        "cyclic" => cyclic().map(Some),
        "particles" => short_walk().map(Some),
        "arm" => arm().map(Some),
        "camera" => Ok(Some(interleaved(&camera()?, &cyclic()?)?)),
        _ => Ok(None),
    }
}

/// Frames of the synthetic walk.
const WALK_FRAMES: u64 = 1200;
/// Frames that are left out: a few, a second, more than the filter believes its position for, and
/// more than it counts.
const LEFT_OUT: [std::ops::Range<u64>; 4] = [150..153, 330..390, 420..480, 520..1140];
/// Noise of its angles, radians.
const WALK_NOISE_RAD: f32 = 0.1;

/// The shipped model's own cycle with noise. Angles are missing now and then, and one second has
/// none. The speed changes, and the position jumps. Up to hundreds of rows in a row are left out.
///
/// # Errors
/// None in practice.
pub fn synthetic_walk(model: &CyclicModel) -> Result<AngleTable> {
    let numbers = model.numbers();
    let (n, l) = (numbers.angle_count, numbers.mean_pose_rad.len() / numbers.angle_count);
    let mut position = 0.3_f32;
    let mut rows = Vec::new();
    for frame in 0..WALK_FRAMES {
        let mut noise = Stream::new(7, frame, 0);
        let slow = if frame > 200 { 0.8 } else { 1.0 };
        position = (position + slow / numbers.mean_duration_frames + if frame == 300 { 0.4 } else { 0.0 }).fract();
        if LEFT_OUT.iter().any(|gap| gap.contains(&frame)) {
            continue;
        }
        let hidden = (120..140).contains(&frame);
        let pose = &numbers.mean_pose_rad[n * ((position * l as f32) as usize).min(l - 1)..][..n];
        let angles_rad = std::array::from_fn(|i| {
            let angle = f64::from(pose[i] + WALK_NOISE_RAD * noise.normal());
            let missing = noise.uniform() < 0.1;
            (!hidden && !missing).then_some(angle)
        });
        rows.push(AngleRow { frame, angles_rad, extra: Vec::new() });
    }
    Ok(AngleTable::new(rows, Vec::new())?)
}

fn cyclic() -> Result<Vec<u8>> {
    let model = CyclicModel::from_option("walking")?;
    let table = synthetic_walk(&model)?;
    Ok(cyclic_stream(&table, &model, &TrackingOptions::default())?)
}

/// Rows of [`synthetic_walk`] that the image `particles` gets: a gap of three frames and a jump of
/// the position, and none of the gaps of a second and more, each frame of which takes a whole step.
const SHORT_WALK_ROWS: usize = 320;

/// The first rows of the same walk.
///
/// # Errors
/// None in practice.
pub fn short_walk() -> Result<Vec<u8>> {
    let model = CyclicModel::from_option("walking")?;
    let mut rows = synthetic_walk(&model)?.rows().to_vec();
    rows.truncate(SHORT_WALK_ROWS);
    let table = AngleTable::new(rows, Vec::new())?;
    Ok(cyclic_stream(&table, &model, &TrackingOptions::default())?)
}

/// Frames of the rendered scene: four seconds.
const SCENE_FRAMES: usize = 60;
/// Its frames per second.
const SCENE_HZ: f32 = 15.0;

/// Renders a person who reaches about into `folder`, one of the images broken, and tracks the arm
/// as `sinew track arm --no-face` does.
///
/// # Errors
/// A folder that cannot be written.
pub fn tracked_scene(folder: &Path) -> Result<RunOutcome> {
    track(folder, SceneOptions::default(), |options| options)
}

/// The same of a person whose face shows in all images and is given three times, as `sinew track
/// arm --front-end lines --head` does.
///
/// # Errors
/// A folder that cannot be written.
pub fn person_by_lines(folder: &Path) -> Result<RunOutcome> {
    let head = folder.join("head.csv");
    std::fs::write(&head, FACES)?;
    let scene = SceneOptions { false_blob_fraction: 1.0, hidden_fraction: 0.0, ..SceneOptions::default() };
    track(folder, scene, |options| TrackOptions { front_end: FrontEnd::Lines, head: Some(head), face: true, ..options })
}

/// Where the scene's face is.
const FACES: &str = "frame,u_px,v_px,size_px\n0,172,53,34\n20,172.5,52,35\n40,172,53,33\n";

fn track(folder: &Path, scene: SceneOptions, change: impl FnOnce(TrackOptions) -> TrackOptions) -> Result<RunOutcome> {
    let motion = reach::random_reaches(1, SCENE_HZ, SCENE_FRAMES)?;
    let options = SceneOptions {
        width_px: 320,
        height_px: 240,
        frames: SCENE_FRAMES,
        frames_per_second: SCENE_HZ,
        sides: Sides::One(ArmSide::Right),
        ..scene
    };
    let scene = OutputDir::create(&folder.join("scene"))?;
    Scene::new(&motion, &options)?.write_folder(&scene)?;
    std::fs::write(scene.join("frames/frame_0033.png"), "no image")?;
    let options = TrackOptions {
        folder: scene.join("frames"),
        side: SideChoice::Right,
        rate_hz: f64::from(SCENE_HZ),
        seed: 1,
        skin: DEFAULT_SKIN.to_owned(),
        calibrate: None,
        front_end: FrontEnd::Pictures,
        hands: None,
        head: None,
        face: false,
        overlay: false,
        particles_csv: false,
        strict: false,
        config: Config::load(&scene.join("camera.toml"))?,
    };
    Ok(TrackRun::prepare(change(options), folder)?.run(&AtomicBool::new(false), &mut |_| ())?)
}

fn arm() -> Result<Vec<u8>> {
    let folder = tempfile::tempdir()?;
    tracked_scene(folder.path())?;
    Ok(record(folder.path(), Form::Tracker)?.bytes)
}

fn camera() -> Result<Vec<u8>> {
    let folder = tempfile::tempdir()?;
    person_by_lines(folder.path())?;
    Ok(record(folder.path(), Form::Camera)?.bytes)
}
