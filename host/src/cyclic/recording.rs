//! Any recording that holds a moving person, as an angle table.

use super::about::About;
use super::angle_table::AngleTable;
use super::image_joints::{ExtraColumns, ImageJoints};
use super::place_columns::PlaceColumns;
use super::projection::{Forward, Plane, UpAxis, View};
use super::resample::resample;
use crate::cyclic::CyclicError;
use crate::error::{Context, Result, bail, ensure, ensure_option};
use crate::keypoints::{self, Detections, Facing, PersonChoice, Track, TrackOptions};
use crate::motion::joint_names::JointSources;
use crate::motion::markers::MarkerMotion;
use crate::motion::{self, ReadOptions};
use crate::registry::{Kind, MOTION, choice, described, find};
use std::path::{Path, PathBuf};

mod space_doubts;

/// A user's rate may be this far from that of the file, as a share of it. Chosen: 29.97 is called
/// 30.
const MAX_RATE_DIFFERENCE: f64 = 0.05;

/// How to turn a recording into an angle table.
#[derive(Debug, Clone, Default)]
pub struct RecordingOptions {
    /// Skeleton of an AMC file; the only .asf of its folder where there is none.
    pub skeleton: Option<PathBuf>,
    /// Frames per second of the table; those of the recording where there is none.
    pub rate_hz: Option<f64>,
    /// Frames per second of a recording that does not say, or says wrong.
    pub input_rate_hz: Option<f64>,
    /// From where a motion in space is seen.
    pub view: View,
    /// Which coordinate points up in space; found where there is none.
    pub up: Option<UpAxis>,
    /// Which way the person faces in the image; found where there is none.
    pub facing: Option<Facing>,
    /// Smallest confidence of a keypoint.
    pub min_confidence: f64,
    /// Take a motion that lacks joints, or frames that its header promises.
    pub partial: bool,
    /// Exchange the names of left and right.
    pub swap_sides: bool,
    /// File of names for points of a motion in space; see [`ReadOptions::names`].
    pub names: Option<PathBuf>,
    /// Width and height of the picture of keypoints, pixels.
    pub image_size_px: Option<[f64; 2]>,
    /// Which of several people in keypoints.
    pub person: PersonChoice,
}

/// An angle table and what was found on the way to it.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedAngles {
    /// The table.
    pub table: AngleTable,
    /// Frames per second of the table; `None` for keypoints without a known rate.
    pub rate_hz: Option<f64>,
    /// What a user should know, one sentence a line.
    pub notes: Vec<String>,
    /// What speaks against the result, one sentence a line.
    pub doubts: Vec<String>,
    /// Which way the person faces in the image; `None` for a motion in space.
    pub facing: Option<Facing>,
    /// Width and height of the picture of keypoints, pixels, if the file says.
    pub image_size_px: Option<[f64; 2]>,
    /// The detector's order of points, for keypoints.
    pub layout: Option<String>,
}

impl RecordedAngles {
    /// A table about which nothing else is known.
    #[must_use]
    pub fn of_table(table: AngleTable) -> Self {
        Self {
            rate_hz: table.rate_hz(),
            table,
            notes: Vec::new(),
            doubts: Vec::new(),
            facing: None,
            image_size_px: None,
            layout: None,
        }
    }

    /// What later commands read beside the table; `source` is what was read.
    #[must_use]
    pub fn about(&self, source: &Path) -> About {
        let mut about = About::of_source(source);
        about.rate_hz = self.rate_hz;
        about.facing = self.facing;
        about.image_size_px = self.image_size_px;
        about.layout.clone_from(&self.layout);
        about.unit = PlaceColumns::find(&self.table).map(|columns| columns.unit.to_owned());
        about.notes.clone_from(&self.notes);
        about.doubts.clone_from(&self.doubts);
        about
    }
}

/// Reads a motion in space or keypoints, and gives its angles.
///
/// # Errors
/// Names the file or option, the rule that it broke, and the remedy.
pub fn angles(path: &Path, options: &RecordingOptions) -> Result<RecordedAngles> {
    check(path, options)?;
    if !holds_keypoints(path) {
        return from_space(path, options);
    }
    of_detections(&read_keypoints(path, options)?, path, options)
}

/// Checks what does not depend on the kind of recording.
fn check(path: &Path, options: &RecordingOptions) -> Result<()> {
    for (name, rate) in [("--rate", options.rate_hz), ("--input-rate", options.input_rate_hz)] {
        if let Some(rate) = rate {
            ensure!(rate > 0.0 && rate.is_finite(), "`{name} {rate}`: a rate has to be greater than zero");
        }
    }
    // Before its kind, which the name of a file that is not there may not show.
    std::fs::metadata(path).map_err(|reason| CyclicError::Unreadable { path: path.to_path_buf(), reason })?;
    Ok(())
}

/// Reads any motion in space.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read_space(path: &Path, options: &RecordingOptions) -> Result<MarkerMotion> {
    ensure!(
        find(path, MOTION).is_some(),
        "`{}` is of no known kind; give a {}, a {} of keypoints, or a folder of OpenPose files",
        path.display(),
        described(MOTION),
        choice(&[Kind::Keypoints])
    );
    let read = ReadOptions {
        skeleton: options.skeleton.as_deref(),
        frames_per_second: options.input_rate_hz.map(|rate| rate as f32),
        metres_per_unit: None,
        partial: options.partial,
        names: options.names.as_deref(),
    };
    Ok(motion::read_space(path, &read)?)
}

fn from_space(path: &Path, options: &RecordingOptions) -> Result<RecordedAngles> {
    let motion = read_space(path, options)?;
    let sources = JointSources::of_seen(&motion, options.partial, path)?;
    let frames = sources.of_motion(&motion);
    let recorded_hz = rounded_rate(f64::from(motion.frames_per_second));
    // The way from the table's first to its last frame, whatever the recording has after that.
    let step = recorded_hz / options.rate_hz.unwrap_or(recorded_hz);
    let last = ((frames.len() as f64 - 1.0) / step + 1.0e-6).floor() * step;
    let covered = &frames[..(last.floor() as usize + 1).clamp(1, frames.len())];
    let plane = Plane::choose(covered, options.view, options.up, recorded_hz)
        .with_context(|| format!("`{}` cannot be seen from the side", path.display()))?;
    let mut notes: Vec<String> = motion.shortfall.iter().map(ToString::to_string).chain(motion.notes.clone()).collect();
    match plane.forward {
        Forward::Travel => {}
        Forward::Hips => {
            notes.push("the person stays about where they are: forward was taken square to the hips".to_owned());
        }
        Forward::Knees => notes.push("all points lie in a plane: the person faces where the knees point".to_owned()),
        Forward::Turning => {
            notes.push(
                "the person turns: each frame was seen from where the hips face (--view side changes it)".to_owned(),
            );
        }
    }
    let size = space_doubts::leg_length(covered, path).filter(|_| !motion.is_scale_assumed);
    let seen = plane.project_with_feet(covered, &sources.feet_of_motion(&motion));
    let facing = options.facing.unwrap_or(Facing::Right);
    let table = if options.view == View::Space {
        in_space(&seen, &plane.from_before().project(covered), recorded_hz, options)?
    } else {
        // Places without a scale, or of a wrong one, would pass for metres.
        let is_bare = options.view == View::Front || motion.is_scale_assumed || size.is_some();
        let extra = if is_bare { ExtraColumns::None } else { ExtraColumns::RootAndLengths { facing } };
        finished(&seen, Some(recorded_hz), options, facing, extra)?
    };
    let rate_hz = Some(options.rate_hz.unwrap_or(recorded_hz));
    Ok(RecordedAngles {
        table: table.at_rate(rate_hz),
        rate_hz,
        notes,
        doubts: size.into_iter().chain(space_doubts::rate(&motion, path)).collect(),
        facing: None,
        image_size_px: None,
        layout: None,
    })
}

/// Two angles a joint: those of `side`, and how far each segment points out of its plane.
fn in_space(
    side: &ImageJoints,
    front: &ImageJoints,
    recorded_hz: f64,
    options: &RecordingOptions,
) -> Result<AngleTable> {
    ensure!(
        options.facing.is_none(),
        "`--facing` says from where a picture was taken; a motion seen with `--view space` has none: leave it out"
    );
    let rate_hz = options.rate_hz.unwrap_or(recorded_hz);
    let [mut side, mut front] = [resample(side, recorded_hz, rate_hz)?, resample(front, recorded_hz, rate_hz)?];
    if options.swap_sides {
        (side, front) = (side.sides_swapped(), front.sides_swapped().x_negated());
    }
    Ok(side.angle_table(ExtraColumns::None)?.with_side(side.side_angles_rad(&front))?)
}

/// The rate without the rounding of a frame time in a file: 1 / 0.0083333 is 120.
fn rounded_rate(rate_hz: f64) -> f64 {
    let whole = rate_hz.round();
    if (rate_hz - whole).abs() < 1.0e-3 * rate_hz { whole } else { rate_hz }
}

fn holds_keypoints(path: &Path) -> bool {
    path.is_dir() || find(path, &[Kind::Keypoints]).is_some()
}

fn read_keypoints(path: &Path, options: &RecordingOptions) -> Result<Detections> {
    ensure_option!(
        options.view != View::Space,
        "`--view space` needs a motion in space ({}); keypoints of a picture have one angle a joint",
        described(MOTION)
    );
    Ok(keypoints::read(path, options.image_size_px)?)
}

/// The angles of one person in keypoints; `path` is for messages.
///
/// # Errors
/// As [`angles`].
pub fn of_detections(detections: &Detections, path: &Path, options: &RecordingOptions) -> Result<RecordedAngles> {
    let input_rate_hz = input_rate(detections, options, path)?;
    let chosen =
        TrackOptions { min_confidence: options.min_confidence, person: options.person, rate_hz: input_rate_hz };
    let track = keypoints::track(detections, &chosen, path)?;
    let mut notes = detections.notes.clone();
    notes.extend(keypoint_notes(&track, detections.frames.len()));
    let doubts: Vec<String> = detections.doubts.iter().chain(&track.doubts).cloned().collect();
    let facing = match (options.facing, track.facing) {
        (Some(facing), _) => facing,
        (None, Some(Facing::Left)) => {
            notes.push(
                "the person faces left: angles are those of the mirror image; left and right are their own".to_owned(),
            );
            Facing::Left
        }
        (None, Some(Facing::Right)) => Facing::Right,
        (None, None) => {
            notes.push("it is unknown which way the person faces: right is assumed (--facing changes it)".to_owned());
            Facing::Right
        }
    };
    if options.rate_hz.is_some() && input_rate_hz.is_none() {
        bail!("`--rate` needs `--input-rate HZ` for keypoints, which do not say how many frames a second they have");
    }
    let extra = ExtraColumns::RootAndLengths { facing };
    let table = finished(&track.joints, input_rate_hz, options, facing, extra)?;
    let rate_hz = options.rate_hz.or(input_rate_hz);
    Ok(RecordedAngles {
        table: table.at_rate(rate_hz),
        rate_hz,
        notes,
        doubts,
        facing: Some(facing),
        image_size_px: detections.image_size_px,
        layout: Some(detections.layout.clone()),
    })
}

/// Frames per second of keypoints: what their times say, else what the user says.
fn input_rate(detections: &Detections, options: &RecordingOptions, path: &Path) -> Result<Option<f64>> {
    if let (Some(given), Some(found)) = (options.input_rate_hz, detections.rate_hz) {
        ensure!(
            (given / found - 1.0).abs() <= MAX_RATE_DIFFERENCE,
            "`--input-rate {given}`: the times in `{}` say {found:.2} frames per second; leave the option out, or remove the column of times",
            path.display()
        );
    }
    Ok(detections.rate_hz.or(options.input_rate_hz))
}

/// What is said about whom a track follows.
fn keypoint_notes(track: &Track, frames: usize) -> Vec<String> {
    let mut notes = Vec::new();
    if track.max_people > 1 {
        notes.push(format!(
            "up to {} people in a frame: the one of --person (default largest) was followed by nearness, and is missing in {} of {frames} frames",
            track.max_people, track.frames_without
        ));
    } else if track.frames_without > 0 {
        notes.push(format!(
            "no person is seen in {} of {frames} frames: all angles are missing there",
            track.frames_without
        ));
    }
    if track.mended.frames > 0 {
        notes.push(format!(
            "left and right were exchanged by the detector and were mended in {} of {frames} frames: legs in {}, arms in {}",
            track.mended.frames, track.mended.legs, track.mended.arms
        ));
    }
    notes
}

/// The angles of everybody who is seen in ten frames or more, by the number of `--person`. Of a
/// motion in space they are those of its one person.
///
/// # Errors
/// As [`angles`].
pub fn all_angles(path: &Path, options: &RecordingOptions) -> Result<Vec<RecordedAngles>> {
    check(path, options)?;
    if !holds_keypoints(path) {
        return Ok(vec![from_space(path, options)?]);
    }
    let detections = read_keypoints(path, options)?;
    let of_person = |number| {
        let options = RecordingOptions { person: PersonChoice::Number(number), ..options.clone() };
        of_detections(&detections, path, &options)
    };
    keypoints::people(&detections, options.min_confidence).into_iter().map(of_person).collect()
}

/// Resamples, mirrors, and takes the angles.
fn finished(
    joints: &ImageJoints,
    recorded_hz: Option<f64>,
    options: &RecordingOptions,
    facing: Facing,
    extra: ExtraColumns,
) -> Result<AngleTable> {
    let joints = match (recorded_hz, options.rate_hz) {
        (Some(from), Some(to)) => resample(joints, from, to)?,
        _ => joints.clone(),
    };
    let joints = if facing == Facing::Left { joints.x_negated() } else { joints };
    let joints = if options.swap_sides { joints.sides_swapped() } else { joints };
    Ok(joints.angle_table(extra)?)
}
