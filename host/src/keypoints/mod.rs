//! 2D keypoints as pose detectors write them: OpenPose and COCO JSON, and CSV tables.
//!
//! `docs/keypoints.md` has the formats and how they are read.

pub mod coco;
pub mod error;
pub mod facing;
pub mod feet;
pub mod layout;
pub mod openpose;
pub mod person;
pub mod point_lists;
pub mod table;

pub use error::KeypointError;
pub use facing::Facing;
pub use layout::{DetectedFrame, Keypoint};

use crate::cyclic::image_joints::{ImageJoints, JointFrame};
use crate::registry::{Kind, extensions};
use layout::stick_joints;
use std::path::Path;

/// How sure a detector has to be of a keypoint unless something else is said.
pub const DEFAULT_MIN_CONFIDENCE: f64 = 0.3;

/// Reads keypoints: a folder of OpenPose files, one such file, a file of COCO results or
/// annotations, or a CSV table.
///
/// # Errors
/// Names the file, the place in it and the rule that it broke.
pub fn read(path: &Path) -> Result<Vec<DetectedFrame>, KeypointError> {
    if path.is_dir() {
        return openpose::read_folder(path);
    }
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("").to_ascii_lowercase();
    match extension.as_str() {
        "json" => coco::read(path),
        "csv" => table::read(path),
        _ => Err(KeypointError::unusable(
            path,
            format!(
                "is of no known kind; give a folder of OpenPose files, a {}",
                extensions(&[Kind::Keypoints]).replace(", ", ", or a ")
            ),
        )),
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
    pub most_people: usize,
}

/// Follows one person through `frames`; keypoints of which the detector was less sure than
/// `min_confidence` are missing.
///
/// # Errors
/// If no frame has a person with a usable keypoint; `path` is for the message.
pub fn track(frames: &[DetectedFrame], min_confidence: f64, path: &Path) -> Result<Track, KeypointError> {
    let sure: Vec<DetectedFrame> = frames.iter().map(|frame| layout::sure_of(frame, min_confidence)).collect();
    let followed = person::follow(&sure);
    let chosen: Vec<Option<&Vec<Keypoint>>> =
        sure.iter().zip(&followed).map(|(frame, choice)| choice.and_then(|index| frame.people.get(index))).collect();
    if chosen.iter().all(Option::is_none) {
        let rule = format!("has no person with a keypoint of confidence {min_confidence} or more in any frame");
        return Err(KeypointError::unusable(path, rule));
    }
    let joints = |person: &Option<&Vec<Keypoint>>| person.map_or([None; 14], |person| stick_joints(person));
    let frame = |(frame, person): (&DetectedFrame, &Option<&Vec<Keypoint>>)| JointFrame {
        frame: frame.frame,
        joints: joints(person),
        feet: person.map_or_else(Default::default, |person| feet::feet(person)),
    };
    let joints = ImageJoints { frames: sure.iter().zip(&chosen).map(frame).collect(), unit: "px" };
    Ok(Track {
        facing: facing::find(&joints, &chosen),
        joints,
        frames_without: chosen.iter().filter(|person| person.is_none()).count(),
        most_people: sure.iter().map(|frame| frame.people.len()).max().unwrap_or(0),
    })
}
