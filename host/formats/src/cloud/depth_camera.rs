//! The camera that took depth images: a JSON file in one of the usual forms.

use super::error::CloudError;
use crate::file::read_bytes;
use crate::limits::MAX_FILE_BYTES;
use serde_json::{Map, Value};
use sinew_core::math::Vec3;
use std::path::Path;

/// Metres of a depth image's unit where its camera does not say: a millimetre.
pub const DEFAULT_UNIT_M: f32 = 0.001;

/// A pinhole camera that measures z, without distortion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthCamera {
    /// Focal lengths along x and y, pixels.
    pub focal_px: [f32; 2],
    /// Where the optical axis meets the image, pixels; the middle of the first pixel is 0, 0.
    pub centre_px: [f32; 2],
    /// Metres of a unit of the images.
    pub unit_m: f32,
    /// Width and height of the images, pixels, where they are known.
    pub size_px: Option<[u32; 2]>,
}

impl DepthCamera {
    /// Reads a camera: `fx`, `fy`, `cx`, `cy` (`ppx`, `ppy` of RealSense), or the nine numbers of a
    /// matrix: `K`, row by row, or `intrinsic_matrix` of Open3D, column by column. `depth_scale` is
    /// metres of a unit below one, units of a metre from one on. `width` and `height` are checked
    /// against the images.
    ///
    /// # Errors
    /// Names the file, the rule that it broke, and the remedy.
    pub fn read(path: &Path) -> Result<Self, CloudError> {
        Self::read_noting(path).map(|(camera, _)| camera)
    }

    /// As [`Self::read`], and what a user should know of keys that are not read.
    pub(super) fn read_noting(path: &Path) -> Result<(Self, Option<String>), CloudError> {
        let bytes = read_bytes(path, MAX_FILE_BYTES).map_err(|error| CloudError::of_file(path, error))?;
        Self::parse(&bytes).map_err(|rule| CloudError::Camera { path: path.to_path_buf(), rule })
    }

    fn parse(bytes: &[u8]) -> Result<(Self, Option<String>), String> {
        let value: Value = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
        let file = value.as_object().ok_or("it is no JSON object")?;
        let (focal_px, centre_px) = pinhole(file)?;
        check_distortion(file)?;
        let scale = number(file, &["depth_scale"])?.unwrap_or(DEFAULT_UNIT_M);
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(format!("depth_scale has to be greater than zero, not {scale}"));
        }
        let unit_m = if scale < 1.0 { scale } else { 1.0 / scale };
        let side = |name: &str| file.get(name).and_then(Value::as_u64).and_then(|side| u32::try_from(side).ok());
        let size_px = side("width").zip(side("height")).map(|(w, h)| [w, h]);
        Ok((Self { focal_px, centre_px, unit_m, size_px }, unread_keys(file)))
    }

    /// The point that is seen `depth` units away by the pixel of column `u` and row `v`, metres.
    #[must_use]
    pub fn point_m(&self, (u, v): (u32, u32), depth: u16) -> Vec3 {
        let z_m = f32::from(depth) * self.unit_m;
        let [x, y] = [(u, 0), (v, 1)].map(|(at, axis)| (at as f32 - self.centre_px[axis]) / self.focal_px[axis]);
        Vec3::new(x * z_m, y * z_m, z_m)
    }
}

/// Focal lengths and centre, pixels.
fn pinhole(file: &Map<String, Value>) -> Result<([f32; 2], [f32; 2]), String> {
    let named = |names: &[&str]| number(file, names);
    let four = if let Some(k) = matrix(file, "K")? {
        check_layout("K", "row by row", [k[6], k[7]])?;
        [k[0], k[4], k[2], k[5]]
    } else if let Some(k) = matrix(file, "intrinsic_matrix")? {
        check_layout("intrinsic_matrix", "column by column", [k[2], k[5]])?;
        [k[0], k[4], k[6], k[7]]
    } else {
        let [fx, fy, cx, cy] = [named(&["fx"])?, named(&["fy"])?, named(&["cx", "ppx"])?, named(&["cy", "ppy"])?];
        let (Some(fx), Some(fy), Some(cx), Some(cy)) = (fx, fy, cx, cy) else {
            return Err("it needs fx, fy, cx and cy in pixels, or the nine numbers of K or intrinsic_matrix".to_owned());
        };
        [fx, fy, cx, cy]
    };
    let [fx, fy, cx, cy] = four;
    if !(fx > 0.0 && fy > 0.0 && four.iter().all(|number| number.is_finite())) {
        return Err(format!(
            "focal lengths have to be greater than zero and all numbers finite: {fx}, {fy}, {cx}, {cy}"
        ));
    }
    Ok(([fx, fy], [cx, cy]))
}

/// The matrix by this name is no transposed one, which has its centre where a camera has zeros.
fn check_layout(name: &str, order: &str, zeros: [f32; 2]) -> Result<(), String> {
    if zeros == [0.0, 0.0] {
        return Ok(());
    }
    let [a, b] = zeros;
    Err(format!("`{name}` has to be {order}, and {a} and {b} stand where a camera has zeros; transpose it"))
}

/// Keys that are read.
const READ: [&str; 11] =
    ["K", "intrinsic_matrix", "fx", "fy", "cx", "cy", "ppx", "ppy", "depth_scale", "width", "height"];
/// Keys of a lens' coefficients, in small letters without underscores: those of RealSense, ROS,
/// OpenCV, Kalibr, Pose2Sim, and Kinect.
const COEFFICIENTS: [&str; 16] = [
    "coeffs",
    "d",
    "dist",
    "distcoeffs",
    "distortion",
    "distortions",
    "distortioncoeffs",
    "distortioncoefficients",
    "k1",
    "k2",
    "k3",
    "k4",
    "k5",
    "k6",
    "p1",
    "p2",
];
/// Keys of what a lens is called; its coefficients say whether it distorts.
const LENS_NAMES: [&str; 2] = ["model", "distortion_model"];

fn is_of_coefficients(key: &str) -> bool {
    COEFFICIENTS.contains(&key.replace('_', "").to_lowercase().as_str())
}

/// Images have to be undistorted.
fn check_distortion(file: &Map<String, Value>) -> Result<(), String> {
    match file.iter().find(|(key, value)| is_of_coefficients(key) && !is_zero(value)) {
        Some((key, _)) => Err(format!(
            "`{key}` says that its images are distorted, and they are taken as those of a pinhole; undistort the \
             images and take `{key}` out"
        )),
        None => Ok(()),
    }
}

/// Whether all numbers of a value are zero, as those of a lens that does not distort.
fn is_zero(value: &Value) -> bool {
    match value {
        Value::Array(all) => all.iter().all(is_zero),
        // A matrix of OpenCV has its size beside its numbers.
        Value::Object(all) => all.get("data").map_or_else(|| all.values().all(is_zero), is_zero),
        one => one.is_null() || one.as_f64() == Some(0.0),
    }
}

/// What a user should know of keys that are not read.
fn unread_keys(file: &Map<String, Value>) -> Option<String> {
    let has_coefficients = file.keys().any(|key| is_of_coefficients(key));
    let is_known =
        |key: &str| READ.contains(&key) || is_of_coefficients(key) || (has_coefficients && LENS_NAMES.contains(&key));
    let unread: Vec<String> = file.keys().filter(|key| !is_known(key)).map(|key| format!("`{key}`")).collect();
    let read = READ.join(", ");
    (!unread.is_empty()).then(|| format!("keys that are not read: {}; those that are: {read}", unread.join(", ")))
}

/// The number by one of these names.
fn number(file: &Map<String, Value>, names: &[&str]) -> Result<Option<f32>, String> {
    let Some((name, value)) = names.iter().find_map(|&name| Some((name, file.get(name)?))) else { return Ok(None) };
    let number = value.as_f64().ok_or_else(|| format!("`{name}` has to be a number"))?;
    Ok(Some(number as f32))
}

/// The nine numbers by this name.
fn matrix(file: &Map<String, Value>, name: &str) -> Result<Option<[f32; 9]>, String> {
    let Some(value) = file.get(name) else { return Ok(None) };
    // Also as three rows, or columns, of three.
    let entries = value.as_array().into_iter().flatten();
    let entries = entries.flat_map(|entry| entry.as_array().map_or(std::slice::from_ref(entry), Vec::as_slice));
    let numbers: Option<Vec<f32>> = entries.map(|one| one.as_f64().map(|one| one as f32)).collect();
    let nine = numbers.and_then(|numbers| numbers.try_into().ok());
    nine.map(Some).ok_or_else(|| format!("`{name}` has to be nine numbers"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_forms_are_the_same_camera() {
        let forms = [
            r#"{"fx": 580.0, "fy": 570, "cx": 320, "cy": 240.5}"#,
            r#"{"fx": 580.0, "fy": 570, "ppx": 320, "ppy": 240.5, "coeffs": [0, 0, 0, 0, 0], "depth_scale": 0.001}"#,
            r#"{"K": [580, 0, 320, 0, 570, 240.5, 0, 0, 1], "D": [], "depth_scale": 1000}"#,
            r#"{"K": [[580, 0, 320], [0, 570, 240.5], [0, 0, 1]]}"#,
            r#"{"intrinsic_matrix": [580, 0, 0, 0, 570, 0, 320, 240.5, 1], "depth_scale": 1000.0}"#,
        ];
        let cameras = forms.map(|form| DepthCamera::parse(form.as_bytes()).unwrap()).map(|(camera, note)| {
            assert_eq!(note, None);
            camera
        });
        for camera in cameras {
            assert_eq!(camera, cameras[0]);
            assert_eq!((camera.centre_px, camera.size_px), ([320.0, 240.5], None));
        }
        let point_m = cameras[0].point_m((610, 0), 2000);
        assert!((point_m - Vec3::new(1.0, -0.843_86, 2.0)).norm() < 1.0e-4, "{point_m}");
    }

    #[test]
    fn keys_that_are_not_read_are_named() {
        let note = |keys: &str| {
            let text = format!(r#"{{"fx": 5, "fy": 5, "cx": 3, "cy": 1, {keys}}}"#);
            DepthCamera::parse(text.as_bytes()).unwrap().1
        };
        assert_eq!(note(r#""model": "brown_conrady", "distCoeffs": {"rows": 1, "data": [0, 0]}, "k1": 0"#), None);
        let found = note(r#""model": "fisheye", "dept_scale": 0.001"#).unwrap();
        assert!(found.starts_with("keys that are not read: `dept_scale`, `model`; those that are: K,"), "{found}");
    }

    #[test]
    fn broken_cameras_say_why() {
        for (form, message) in [
            ("[1]", "no JSON object"),
            ("{", "EOF"),
            (r#"{"fx": 500, "fy": 500, "cx": 320}"#, "it needs fx, fy, cx and cy"),
            (r#"{"fx": "500", "fy": 500, "cx": 320, "cy": 1}"#, "`fx` has to be a number"),
            (r#"{"fx": 0, "fy": 500, "cx": 320, "cy": 1}"#, "greater than zero"),
            (r#"{"K": [1, 2]}"#, "`K` has to be nine numbers"),
            (r#"{"K": [580, 0, 0, 0, 570, 0, 320, 240, 1]}"#, "`K` has to be row by row, and 320 and 240 stand"),
            (r#"{"intrinsic_matrix": [580, 0, 320, 0, 570, 240, 0, 0, 1]}"#, "`intrinsic_matrix` has to be column"),
            (r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 1, "depth_scale": -1}"#, "depth_scale has to be"),
            (r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 1, "coeffs": [0.1]}"#, "undistort the images"),
            (r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 1, "k1": -0.2}"#, "`k1` says that its images are distorted"),
            (r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 1, "dist_coeffs": [[0, 0.1]]}"#, "`dist_coeffs` says"),
            (r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 1, "distortion_coefficients": {"rows": 1, "data": [0.1]}}"#, "says"),
        ] {
            let found = DepthCamera::parse(form.as_bytes()).unwrap_err();
            assert!(found.contains(message), "{found} does not contain {message}");
        }
    }
}
