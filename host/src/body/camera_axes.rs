//! Motions of files, whose axes are their own, in the axes of a camera.

use crate::cyclic::projection::upwards;
use crate::error::{Context, Result};
use crate::motion::MarkerMotion;
use crate::motion::joint_names::JointSources;
use sinew_core::math::{Mat3, Vec3};
use std::path::Path;

/// The coordinate axis along which the person of `motion` stands, a unit vector; `path` is for the
/// message.
///
/// # Errors
/// Limb joints go by no name that is known, or neck and hips are in no frame together.
pub fn up_of(motion: &MarkerMotion, path: &Path) -> Result<Vec3> {
    let figure = JointSources::find(&motion.names, false, path)?.of_motion(motion);
    upwards(&figure, None).with_context(|| format!("`{}` does not show which way is up", path.display()))
}

/// What turns axes of which `up` is the coordinate axis that points up into those of a camera: y
/// down, by at most half a turn about a coordinate axis. `None` where `up` is no coordinate axis.
#[must_use]
pub fn turn_to_camera(up: &Vec3) -> Option<Mat3> {
    let turn = match <[f32; 3]>::from(*up) {
        [1.0, 0.0, 0.0] => [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        [-1.0, 0.0, 0.0] => [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        [0.0, 1.0, 0.0] => [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]],
        [0.0, -1.0, 0.0] => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [0.0, 0.0, 1.0] => [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        [0.0, 0.0, -1.0] => [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]],
        _ => return None,
    };
    Some(Mat3::from_fn(|row, column| turn[row][column]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_becomes_minus_y_without_a_mirror() {
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let mut up = Vec3::zeros();
                up[axis] = sign;
                let turn = turn_to_camera(&up).unwrap();
                assert_eq!(turn * up, -Vec3::y());
                assert_eq!(turn.determinant(), 1.0);
            }
        }
        assert!(turn_to_camera(&Vec3::new(0.6, 0.8, 0.0)).is_none());
    }
}
