//! What is known of a format.

use crate::cloud::point_cloud::PointCloud;
use crate::motion::error::MotionError;
use crate::motion::markers::MarkerMotion;
use crate::motion::read_options::ReadOptions;
use crate::motion::recording::Motion;
use std::path::Path;

/// What the files of a format hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A skeleton's joints over time.
    JointMotion,
    /// Markers in space over time.
    MarkerMotion,
    /// A skeleton at rest.
    Skeleton,
    /// The points of one frame.
    Cloud,
    /// The depth of each pixel of one frame.
    Depth,
    /// One picture.
    Image,
    /// Pictures over time.
    Video,
    /// Joints in a picture over time.
    Keypoints,
}

/// One format of files.
#[derive(Debug, Clone, Copy)]
pub struct Format {
    /// Name, as its users call it.
    pub name: &'static str,
    /// Endings of its files' names, lower case; a file's own ending may be in any case.
    pub extensions: &'static [&'static str],
    /// What a text adds to the ending, e.g. `exponential maps`; empty where the ending is enough.
    pub note: &'static str,
    /// How its files begin; one of these holds. Empty for a format without a fixed beginning.
    pub signatures: &'static [Signature],
    /// What reads it.
    pub reader: Reader,
}

impl Format {
    /// What the format's files hold.
    #[must_use]
    pub const fn kind(&self) -> Kind {
        match self.reader {
            Reader::Joints(_) => Kind::JointMotion,
            Reader::Markers(_) => Kind::MarkerMotion,
            Reader::Skeleton => Kind::Skeleton,
            Reader::Cloud(_) => Kind::Cloud,
            Reader::Depth => Kind::Depth,
            Reader::Image => Kind::Image,
            Reader::Video => Kind::Video,
            Reader::Keypoints => Kind::Keypoints,
        }
    }

    /// Whether a file whose content starts with `bytes` begins as this format does.
    #[must_use]
    pub fn begins(&self, bytes: &[u8]) -> bool {
        let holds = |sign: &Signature| bytes.get(sign.offset..).is_some_and(|rest| rest.starts_with(sign.bytes));
        self.signatures.iter().any(holds)
    }

    /// What tells the first line of this format from other texts of its ending; `None` where the
    /// ending is enough.
    #[must_use]
    pub const fn first_line_rule(&self) -> Option<fn(&str) -> bool> {
        match self.reader {
            Reader::Joints(JointReader { is_first_line, .. }) => is_first_line,
            _ => None,
        }
    }
}

/// Bytes at a fixed place near a file's beginning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Signature {
    /// Place of the first byte, counted from 0.
    pub offset: usize,
    /// The bytes.
    pub bytes: &'static [u8],
}

/// What reads a format.
#[derive(Debug, Clone, Copy)]
pub enum Reader {
    /// Reads joints over time.
    Joints(JointReader),
    /// Reads markers over time.
    Markers(MarkerReader),
    /// Skeletons are read by `motion::asf::read`.
    Skeleton,
    /// Parses the content of a point cloud's file.
    Cloud(fn(&[u8]) -> Result<PointCloud, String>),
    /// Depth images are read by `cloud::CloudSource`, with their camera.
    Depth,
    /// Images are read by `images::load_rgb`, which goes by the content.
    Image,
    /// Videos are read by `images::VideoFrames`, through ffmpeg.
    Video,
    /// Keypoints are read by the crate `sinew`.
    Keypoints,
}

type ReadJoints = fn(&Path, &ReadOptions<'_>) -> Result<Motion, MotionError>;

/// Reader of joints over time.
#[derive(Debug, Clone, Copy)]
pub struct JointReader {
    /// Reads the joints.
    pub read: ReadJoints,
    /// Reads the whole body, where `read` gives torso and arms only.
    pub read_whole_body: Option<ReadJoints>,
    /// Whether the skeleton is in a file of its own.
    pub needs_skeleton: bool,
    /// Whether the file gives its frames per second.
    pub has_rate: bool,
    /// Whether a line can be the first one of a file; `None` where the ending is enough.
    pub is_first_line: Option<fn(&str) -> bool>,
}

/// Reader of markers over time.
#[derive(Debug, Clone, Copy)]
pub struct MarkerReader {
    /// Reads the markers.
    pub read: fn(&Path, &ReadOptions<'_>) -> Result<MarkerMotion, MotionError>,
    /// Whether the markers are on the skin, as motion capture records them. Joints if not.
    pub is_on_skin: bool,
}
