//! What the files of a folder are, and which of their points count.

use super::depth_camera::DepthCamera;
use super::depth_image;
use super::error::CloudError;
use super::folder::CloudFolder;
use super::point_cloud::PointCloud;
use super::reading::{read_noting, read_with};
use super::region::Region;
use crate::registry::Kind;
use std::path::{Path, PathBuf};

/// Clouds of points, or depth images of one camera.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CloudSource {
    /// The camera of depth images; `None` of clouds.
    pub camera: Option<DepthCamera>,
    /// Where points count.
    pub region: Region,
}

/// A source and where it is.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundSource {
    /// What the files are.
    pub source: CloudSource,
    /// The folder of the files.
    pub folder: PathBuf,
    /// The file of the camera.
    pub camera: Option<PathBuf>,
    /// What a user should know of the camera.
    pub notes: Vec<String>,
}

impl FoundSource {
    /// Clouds lie in `points` of `folder`, depth images in `depth`, or either in `folder` itself.
    /// Depth images are what has a camera: `camera`, or `camera.json` in a folder without clouds.
    ///
    /// # Errors
    /// A camera that cannot be read.
    pub fn find(folder: &Path, camera: Option<&Path>, region: Region) -> Result<Self, CloudError> {
        let points = folder.join("points");
        let has_clouds = || points.is_dir() || CloudFolder::open(folder).is_ok();
        let beside = || Some(folder.join("camera.json")).filter(|path| path.is_file() && !has_clouds());
        let file = camera.map(Path::to_path_buf).or_else(beside);
        let (camera, note) = file.as_deref().map(DepthCamera::read_noting).transpose()?.unzip();
        let notes =
            file.iter().zip(note.flatten()).map(|(file, note)| format!("`{}`: {note}", file.display())).collect();
        let inside = if camera.is_some() { folder.join("depth") } else { points };
        let folder = if inside.is_dir() { inside } else { folder.to_path_buf() };
        Ok(Self { source: CloudSource { camera, region }, folder, camera: file, notes })
    }
}

impl CloudSource {
    /// Lists the frames of a folder.
    ///
    /// # Errors
    /// As [`CloudFolder::open`].
    pub fn open(&self, folder: &Path) -> Result<CloudFolder, CloudError> {
        CloudFolder::open_kind(folder, if self.camera.is_some() { Kind::Depth } else { Kind::Cloud })
    }

    /// The points of a frame that count; `note` is shown the bytes of its file first.
    ///
    /// # Errors
    /// As [`super::read`].
    pub fn read_noting(&self, path: &Path, note: impl FnOnce(&[u8])) -> Result<PointCloud, CloudError> {
        let mut cloud = match &self.camera {
            Some(camera) => read_with(path, note, |bytes| depth_image::parse(bytes, camera))?,
            None => read_noting(path, note)?,
        };
        cloud.cut_to(&self.region);
        Ok(cloud)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_beside_clouds_makes_no_depth_images_of_them() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("camera.json"), r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 1}"#).unwrap();
        let find = || FoundSource::find(folder.path(), None, Region::default()).unwrap();
        assert!(find().camera.is_some());
        std::fs::write(folder.path().join("1.ply"), "").unwrap();
        assert_eq!((find().camera, find().source), (None, CloudSource::default()));
    }
}
