//! `sinew simulate`: scenes with known truth.

use super::console::Console;
use super::scene_args::{clear_frames, pair};
use super::simulate_cyclic::{self, SimulateCyclicArgs};
use super::simulate_keypoints::{self, SimulateKeypointsArgs};
use super::simulate_stereo::{self, SimulateStereoArgs};
use crate::motion;
use crate::output::OutputDir;
use crate::registry::{Kind, choice};
use crate::scene::{MotionSource, Scene, SceneOptions};
use crate::track::SideChoice;
use anyhow::{Context, Result};
use clap::{Args, Subcommand};
use serde_json::json;
use std::path::PathBuf;

/// What to simulate.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate arm --motion builtin --frames 30 --out scene
  sinew simulate stereo --motion stick-wave --points 300 --out points
  sinew simulate cyclic --model running --out run.csv
  sinew simulate keypoints --out keypoints.csv")]
pub struct SimulateArgs {
    /// The subject.
    #[command(subcommand)]
    pub subject: SimulateSubject,
}

/// Subjects of `sinew simulate`.
#[derive(Debug, Subcommand)]
pub enum SimulateSubject {
    /// A person before a webcam who performs an arm motion: frames, camera and truth.
    Arm(SimulateArmArgs),
    /// A whole body before a stereo camera: points, truth and first pose.
    Stereo(SimulateStereoArgs),
    /// A person who walks, runs or moves as another model says: measured angles.
    Cyclic(SimulateCyclicArgs),
    /// The same person filmed from the side: keypoints as a pose detector writes them.
    Keypoints(SimulateKeypointsArgs),
}

/// Arguments of `sinew simulate arm`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  sinew simulate arm --motion builtin --frames 30 --out scene")]
pub struct SimulateArmArgs {
    /// Motion: a file, or `builtin` for random reaches.
    #[arg(long, value_name = "FILE|builtin", help = format!(
        "Motion: a {} file, or `builtin` for random reaches",
        choice(&[Kind::JointMotion])
    ))]
    pub motion: PathBuf,
    /// Skeleton of a .amc motion [default: the only .asf beside it].
    #[arg(long, value_name = "FILE.asf")]
    pub skeleton: Option<PathBuf>,
    /// Frames per second of a motion file that does not say.
    #[arg(long, value_name = "HZ", default_value_t = motion::DEFAULT_FRAMES_PER_SECOND, help = format!(
        "Frames per second of a motion file that does not say ({})",
        motion::endings_without_rate()
    ))]
    pub motion_rate: f32,
    /// Part of the motion that is used, in seconds from its beginning.
    #[arg(long, value_name = "START,END", value_parser = pair::<f32>)]
    pub between: Option<(f32, f32)>,
    /// Take a motion with fewer frames than its header promises.
    #[arg(long)]
    pub partial: bool,
    /// Exchange left and right of the motion.
    #[arg(long)]
    pub mirror: bool,
    /// Which arms move and show their hands; left is the person's left.
    #[arg(long, value_enum, default_value_t = SideChoice::Right)]
    pub side: SideChoice,
    /// Number of frames [default: the motion's length, 250 for builtin]; a shorter motion runs to
    /// and fro.
    #[arg(long, value_name = "N")]
    pub frames: Option<usize>,
    /// Frames per second of the camera.
    #[arg(long, value_name = "HZ", default_value_t = 15.0)]
    pub rate: f32,
    /// Seed of all that is random.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Share of the frames in which face and neck show skin.
    #[arg(long, value_name = "SHARE", default_value_t = 0.5)]
    pub false_blob: f32,
    /// Share of the frames in which a hand is hidden.
    #[arg(long, value_name = "SHARE", default_value_t = 0.1)]
    pub hidden: f32,
    /// Frames in which the hand is away (behind the back), first and one past the last.
    #[arg(long, value_name = "FIRST,END", value_parser = pair::<usize>)]
    pub away: Option<(usize, usize)>,
    /// Standard deviation of the sensor noise, levels of 255.
    #[arg(long, value_name = "LEVELS", default_value_t = 2.5)]
    pub noise: f32,
    /// Folder for frames/, camera.toml and truth.csv.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Replace the scene that DIR already holds.
    #[arg(long)]
    pub force: bool,
}

/// Runs `sinew simulate`.
///
/// # Errors
/// A motion that cannot be read, an option out of range, a folder that cannot be written or holds
/// frames already.
pub fn run(args: &SimulateArgs, console: &Console) -> Result<()> {
    match &args.subject {
        SimulateSubject::Arm(args) => run_arm(args, console),
        SimulateSubject::Stereo(args) => simulate_stereo::run(args, console),
        SimulateSubject::Cyclic(args) => simulate_cyclic::run(args, console),
        SimulateSubject::Keypoints(args) => simulate_keypoints::run(args, console),
    }
}

fn run_arm(args: &SimulateArmArgs, console: &Console) -> Result<()> {
    let source = MotionSource {
        skeleton: args.skeleton.as_deref(),
        rate_hz: args.motion_rate,
        between: args.between,
        partial: args.partial,
        mirror: args.mirror,
        ..MotionSource::of(&args.motion)
    };
    let (motion, shortfall) = source.motion(args.seed, args.rate, args.frames)?;
    let notes: Vec<String> = shortfall.iter().map(ToString::to_string).collect();
    notes.iter().for_each(|note| console.note(note));
    let options = SceneOptions {
        frames: args.frames.unwrap_or_else(|| motion.len()),
        frames_per_second: args.rate,
        seed: args.seed,
        sides: args.side.into(),
        false_blob_fraction: args.false_blob,
        hidden_fraction: args.hidden,
        away: args.away.map(|(first, end)| first..end),
        noise_std: args.noise,
        ..SceneOptions::default()
    };
    let scene = Scene::new(&motion, &options).context("this scene cannot be made; change the option")?;
    let output = OutputDir::create(&args.out)?;
    clear_frames(&output.join("frames"), "frame_", ".png", args.force)?;
    scene.write_folder(&output)?;
    let text = format!("{} frames, camera.toml and truth.csv in `{}`\n", scene.len(), args.out.display());
    console.answer(&text, &json!({ "frames": scene.len(), "notes": notes, "out": args.out }))
}

#[cfg(test)]
mod tests {
    use super::{Scene, SceneOptions};
    use crate::cli::{Cli, run};
    use crate::config::Config;
    use crate::motion::{ArmSide, reach};
    use clap::Parser;
    use std::fs;
    use std::path::Path;

    /// Runs `sinew simulate arm --out OUT` with more words.
    fn simulate(out: &Path, words: &[&str]) -> anyhow::Result<()> {
        let out = out.to_str().unwrap();
        let begin = ["sinew", "simulate", "arm", "--out", out];
        let line = begin.iter().chain(words);
        run(&Cli::try_parse_from(line)?)
    }

    #[test]
    fn a_scene_folder_holds_frames_truth_and_camera() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("scene");
        simulate(&out, &["--motion", "builtin", "--frames", "4", "--side", "both"]).unwrap();
        for frame in 0..4 {
            let image = image::open(out.join(format!("frames/frame_{frame:04}.png"))).unwrap();
            assert_eq!((image.width(), image.height()), (640, 480));
        }
        let truth = fs::read_to_string(out.join("truth.csv")).unwrap();
        let lines: Vec<&str> = truth.lines().collect();
        assert_eq!(lines.len(), 1 + 2 * 4);
        assert!(lines.iter().all(|line| line.split(',').count() == lines[0].split(',').count()));
        assert!(lines[1].starts_with("0,0.0000,left,") && lines[8].starts_with("3,0.2000,right,"));
        let config: toml::Table = fs::read_to_string(out.join("camera.toml")).unwrap().parse().unwrap();
        let keys = |section: &str| config[section].as_table().unwrap().keys().cloned().collect::<Vec<_>>();
        let camera = ["centre_u_px", "centre_v_px", "focal_u_px", "focal_v_px", "height_px", "width_px"];
        assert_eq!(keys("camera"), camera);
        assert_eq!(keys("body"), ["forearm_m", "left_shoulder_m", "right_shoulder_m", "upper_arm_m"]);
    }

    #[test]
    fn the_camera_file_is_a_configuration_of_the_tracker() {
        let motion = reach::random_reaches(1, 15.0, 2).unwrap();
        let scene = Scene::new(&motion, &SceneOptions { frames: 2, ..SceneOptions::default() }).unwrap();
        let config = Config::parse(&scene.config_toml()).unwrap();
        let shoulders_m = [ArmSide::Left, ArmSide::Right].map(|side| scene.body().shoulder_m(side));
        assert_eq!(config.body.shoulders_m(), shoulders_m);
        assert_eq!(config.body.forearm_m, Some(scene.body().forearm_m()));
        let camera = config.camera.build(640, 480).unwrap();
        for frame in 0..2 {
            let hand_m = scene.truth(frame).sides[0].joints.hand_m;
            assert_eq!(camera.project(&hand_m), scene.camera().project(&hand_m));
        }
    }

    #[test]
    fn an_older_scene_is_replaced_only_with_force() {
        let folder = tempfile::tempdir().unwrap();
        let builtin = ["--motion", "builtin", "--frames"];
        simulate(folder.path(), &[&builtin[..], &["3"]].concat()).unwrap();
        let message = simulate(folder.path(), &[&builtin[..], &["2"]].concat()).unwrap_err().to_string();
        assert!(message.contains("--force"), "{message}");
        simulate(folder.path(), &[&builtin[..], &["2", "--force"]].concat()).unwrap();
        assert_eq!(fs::read_dir(folder.path().join("frames")).unwrap().count(), 2);
    }

    #[test]
    fn what_cannot_be_done_is_said_before_anything_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("scene");
        let lonely = folder.path().join("lonely.amc");
        fs::write(&lonely, "1\n").unwrap();
        let broken = folder.path().join("broken.bvh");
        fs::write(&broken, "HIERARCHY\nROOT Hips\n{\n").unwrap();
        let picture = folder.path().join("picture.png");
        fs::write(&picture, "").unwrap();
        let cases: [(&[&str], &str); 11] = [
            (&["--motion", "builtin", "--frames", "0"], "`frames`"),
            (&["--motion", "builtin", "--rate", "0"], "`frames_per_second`"),
            (&["--motion", "builtin", "--hidden", "2"], "`hidden_fraction`"),
            (&["--motion", "builtin", "--false-blob", "NaN"], "`false_blob_fraction`"),
            (&["--motion", "builtin", "--away", "9,4"], "`away`"),
            (&["--motion", "builtin", "--away", "9"], "two numbers with a comma"),
            (&["--motion", "builtin", "--side", "middle"], "middle"),
            (&["--motion", "no-such.bvh"], "no-such.bvh"),
            (&["--motion", lonely.to_str().unwrap()], "--skeleton FILE.asf"),
            (&["--motion", broken.to_str().unwrap()], "broken.bvh:3: the file ends"),
            (&["--motion", picture.to_str().unwrap()], "give a .bvh, a .amc"),
        ];
        for (words, part) in cases {
            let message = format!("{:#}", simulate(&out, words).unwrap_err());
            assert!(message.contains(part), "{words:?}: {message}");
            assert!(!out.exists(), "{words:?} left a folder");
        }
        let message = format!("{:#}", simulate(&lonely, &["--motion", "builtin", "--frames", "1"]).unwrap_err());
        assert!(message.contains("is a file"), "{message}");
    }
}
