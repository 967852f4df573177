//! Clouds of points in space, one file a frame: PLY, PCD and CSV are read, PLY is written.
//!
//! Coordinates are metres in the camera's axes (x right, y down, z forward; the camera's centre is the origin) and are
//! taken as they stand: a PCD file's `VIEWPOINT` is not applied.

pub mod csv;
pub mod error;
pub mod folder;
pub mod frame_number;
pub mod pcd;
pub mod ply;
pub mod subsample;

pub use error::CloudError;
pub use folder::{CloudFolder, CloudFrame};
pub use ply::write_ply;

use sinew_core::math::Vec3;
use sinew_core::observation::point_cloud::{self, BLOCK_POINTS, PointBlock};
use sinew_core::observation::range_smoothing::{RangeSmoothing, SightLine};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Most points of a frame that a tracker is given; [`PointCloud::limit`] draws them from a larger cloud.
pub const MAX_POINTS: usize = 20_000;
/// Radius around the camera's centre in which no point can be: matching that failed is often written as the origin.
pub const CENTRE_RADIUS_M: f32 = point_cloud::NEAREST_M;
/// Distance beyond which no point can be: far more than a stereo camera measures, and its square is an ordinary number.
pub const MAX_DISTANCE_M: f32 = 1_000.0;
/// Largest file that is read, and largest content of a compressed one.
pub const MAX_FILE_BYTES: u64 = 1 << 30;
/// File endings that are read, lower case.
pub const EXTENSIONS: [&str; 3] = ["ply", "pcd", "csv"];

/// The points of one frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PointCloud {
    /// Points in metres in the order of the file: finite, between [`CENTRE_RADIUS_M`] and [`MAX_DISTANCE_M`] from the
    /// camera's centre.
    pub points_m: Vec<Vec3>,
    /// Points of the file that were left out, because they are not so.
    pub skipped: usize,
}

impl PointCloud {
    /// Takes the points that can be used and counts the others.
    pub fn from_points(points_m: impl IntoIterator<Item = Vec3>) -> Self {
        let mut cloud = Self::default();
        for point_m in points_m {
            cloud.push(point_m);
        }
        cloud
    }

    /// Adds a point, or counts it if it cannot be used.
    pub fn push(&mut self, point_m: Vec3) {
        let distance_m = point_m.norm();
        // False for NaN and infinity.
        if distance_m > CENTRE_RADIUS_M && distance_m <= MAX_DISTANCE_M {
            self.points_m.push(point_m);
        } else {
            self.skipped += 1;
        }
    }
}

/// The points, brought in place into the order and the blocks in which the core weighs them, after their distances were averaged where
/// `smoothing` says how; those beyond [`MAX_POINTS`] are left out.
#[must_use]
pub fn blocks_of(points_m: &mut [Vec3], smoothing: Option<&RangeSmoothing>) -> Vec<PointBlock> {
    if let Some(smoothing) = smoothing {
        smoothing.smooth(points_m, &Vec3::zeros(), &mut vec![SightLine::default(); points_m.len()]);
    }
    let mut weighed = Box::new(point_cloud::PointCloud::<{ MAX_POINTS / BLOCK_POINTS }>::new());
    // What it leaves out, the reader's rules have left out already.
    let _ = weighed.set(points_m, &Vec3::zeros());
    weighed.blocks().to_vec()
}

/// Reads a cloud by its file ending: `.ply`, `.pcd` (ascii, binary or compressed) or `.csv`. No point at all is a cloud too.
///
/// # Errors
/// Names the file, the rule that it broke, and the remedy.
pub fn read(path: &Path) -> Result<PointCloud, CloudError> {
    let extension = extension(path).ok_or_else(|| CloudError::UnknownKind { path: path.to_path_buf() })?;
    let unreadable = |reason| CloudError::Unreadable { path: path.to_path_buf(), reason };
    let bytes_there = std::fs::metadata(path).map_err(unreadable)?.len();
    if bytes_there > MAX_FILE_BYTES {
        return Err(CloudError::TooLarge { path: path.to_path_buf(), bytes: bytes_there });
    }
    parse(extension, &std::fs::read(path).map_err(unreadable)?)
        .map_err(|rule| CloudError::Broken { path: path.to_path_buf(), rule })
}

/// One of [`EXTENSIONS`] if the name ends so, in any case.
#[must_use]
pub fn extension(path: &Path) -> Option<&'static str> {
    let found = path.extension()?.to_str()?;
    EXTENSIONS.into_iter().find(|known| found.eq_ignore_ascii_case(known))
}

/// The parsers of others are given damaged files here too: should one panic, that is an error like any other.
fn parse(extension: &str, bytes: &[u8]) -> Result<PointCloud, String> {
    let parsed = catch_unwind(AssertUnwindSafe(|| match extension {
        "ply" => ply::parse(bytes),
        "pcd" => pcd::parse(bytes),
        _ => csv::parse(bytes),
    }));
    parsed.unwrap_or_else(|_| Err("it is damaged in a way that its reader does not know".to_owned()))
}

#[cfg(test)]
mod tests;
