//! 2D keypoints as pose detectors write them: OpenPose and COCO JSON, and CSV tables.
//!
//! `docs/keypoints.md` has the formats and how they are read.

pub mod arrays;
mod clock;
mod coco;
mod columns;
pub mod detections;
mod doubts;
pub mod error;
pub mod facing;
pub mod feet;
mod file_numbers;
mod folder;
mod frame_lists;
pub mod layout;
mod openpose;
mod orders;
mod part_names;
pub mod person;
mod pixels;
mod point_lists;
mod point_values;
mod sheet;
pub mod swaps;
pub mod table;
mod table_rows;
mod times;
mod upright;
mod yolo;

pub use crate::cyclic::facing::Facing;
pub use detections::Detections;
pub use error::KeypointError;
pub use layout::{DetectedFrame, Keypoint};
pub use person::PersonChoice;
pub use swaps::Mended;

use crate::cyclic::image_joints::{ImageJoints, JointFrame};
use crate::motion::joint_names::JOINTS;
use crate::registry::{Kind, extensions};
use layout::stick_joints;
use person::PersonTrack;
use std::path::Path;

/// How sure a detector has to be of a keypoint unless something else is said.
pub const DEFAULT_MIN_CONFIDENCE: f64 = 0.3;

/// Reads keypoints: a folder with one file a frame, one file of JSON, or a CSV table. Coordinates
/// that are shares of the picture become pixels by `image_size_px` (width and height) or by what
/// the file says, and y points down.
///
/// # Errors
/// Names the file, the place in it and the rule that it broke.
pub fn read(path: &Path, image_size_px: Option<[f64; 2]>) -> Result<Detections, KeypointError> {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("").to_ascii_lowercase();
    let found = match extension.as_str() {
        _ if path.is_dir() => {
            let found = folder::read(path)?;
            let mut named = orders::name_points(&found.frames);
            named.notes.splice(0..0, found.notes);
            named
        }
        "json" => {
            let found = coco::read(path)?;
            let named = orders::name_points(&found.frames);
            Detections { image_size_px: found.image_size_px, ..found.times.applied_to(named) }
        }
        "csv" => table::read(path)?,
        _ => return Err(KeypointError::unusable(path, unknown_kind())),
    };
    Ok(upright::upright(pixels::to_pixels(found, image_size_px, path)?))
}

fn unknown_kind() -> String {
    let files = extensions(&[Kind::Keypoints]).replace(", ", ", or a ");
    format!("is of no known kind; give a folder of OpenPose or YOLO files, a {files}")
}

/// Whom to follow, and by which points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackOptions {
    /// Points of which the detector was less sure are missing.
    pub min_confidence: f64,
    /// Which of several people.
    pub person: PersonChoice,
    /// Frames per second, where the file does not say.
    pub rate_hz: Option<f64>,
}

impl Default for TrackOptions {
    fn default() -> Self {
        Self { min_confidence: DEFAULT_MIN_CONFIDENCE, person: PersonChoice::default(), rate_hz: None }
    }
}

/// One person over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// The joints of the stick figure, pixels.
    pub joints: ImageJoints,
    /// Which way the person faces, as far as face, feet, knees and travel show.
    pub facing: Option<Facing>,
    /// Frames in which the person was not found.
    pub frames_without: usize,
    /// Largest number of people in a frame.
    pub max_people: usize,
    /// Frames in which left and right were exchanged.
    pub mended: Mended,
    /// What makes the angles doubtful, each with its remedy.
    pub doubts: Vec<String>,
}

/// Follows one person through `detections`, and gives their left and right back where the detector
/// exchanged them.
///
/// # Errors
/// No frame has a person with a usable keypoint, or there is none of that number; `path` is for the
/// message.
pub fn track(detections: &Detections, options: &TrackOptions, path: &Path) -> Result<Track, KeypointError> {
    let min_confidence = options.min_confidence;
    let sure: Vec<DetectedFrame> =
        detections.frames.iter().map(|frame| layout::sure_of(frame, min_confidence)).collect();
    let tracks = person::tracks(&sure);
    if tracks.is_empty() {
        let rule = format!("has no person with a keypoint of confidence {min_confidence} or more in any frame");
        return Err(KeypointError::unusable(path, rule));
    }
    let Some(chosen) = person::choose(&tracks, options.person) else {
        let rule = format!(
            "has {} people, counted by the frames in which they are seen; give `--person` a number up to that",
            tracks.len()
        );
        return Err(KeypointError::unusable(path, rule));
    };
    Ok(followed(&sure, &tracks[chosen], options.rate_hz.or(detections.rate_hz)))
}

/// Numbers of the people who are seen in ten frames or more, for [`PersonChoice::Number`]; the
/// first one at least.
#[must_use]
pub fn people(detections: &Detections, min_confidence: f64) -> Vec<usize> {
    let sure: Vec<DetectedFrame> =
        detections.frames.iter().map(|frame| layout::sure_of(frame, min_confidence)).collect();
    let long = person::tracks(&sure).iter().filter(|track| track.seen.len() >= person::MIN_TRACK_FRAMES).count();
    (1..=long.max(1)).collect()
}

fn followed(frames: &[DetectedFrame], track: &PersonTrack, rate_hz: Option<f64>) -> Track {
    let choices = track.choices(frames.len());
    let mut people: Vec<Option<Vec<Keypoint>>> = frames
        .iter()
        .zip(choices)
        .map(|(frame, choice)| choice.and_then(|index| frame.people.get(index)).cloned())
        .collect();
    let numbers: Vec<u64> = frames.iter().map(|frame| frame.frame).collect();
    let trunk_px = facing::trunk_px(&image_joints(&numbers, &people)).unwrap_or(0.0);
    let mended = swaps::mend(&numbers, &mut people, trunk_px);
    let joints = image_joints(&numbers, &people);
    let seen: Vec<Option<&Vec<Keypoint>>> = people.iter().map(Option::as_ref).collect();
    let facing = facing::find(&joints, &seen);
    let doubts = doubts::find(&doubts::Followed { joints: &joints, people: &seen, facing, rate_hz });
    Track {
        facing,
        frames_without: people.iter().filter(|person| person.is_none()).count(),
        max_people: frames.iter().map(|frame| frame.people.len()).max().unwrap_or(0),
        joints,
        mended,
        doubts,
    }
}

fn image_joints(numbers: &[u64], people: &[Option<Vec<Keypoint>>]) -> ImageJoints {
    let joints = |person: &Option<Vec<Keypoint>>| person.as_ref().map_or([None; JOINTS], |person| stick_joints(person));
    let frame = |(frame, person): (&u64, &Option<Vec<Keypoint>>)| JointFrame {
        frame: *frame,
        joints: joints(person),
        feet: person.as_ref().map_or_else(Default::default, |person| feet::feet(person)),
    };
    ImageJoints { frames: numbers.iter().zip(people).map(frame).collect(), unit: "px" }
}
