//! Coordinates that are shares of a picture, to pixels.

use super::detections::Detections;
use super::error::KeypointError;
use super::layout::Part;
use crate::motion::joint_names::HIPS;
use std::path::Path;

/// Coordinates of pixels are larger than this: nobody is seen in three pixels. Shares of points
/// outside the picture, which detectors guess, are smaller. Chosen.
const MAX_SHARE: f64 = 3.0;
/// Hips this near to the origin, in metres, are the origin: MediaPipe's world landmarks.
const MAX_HIP_OFFSET: f64 = 0.01;

/// Maps shares of the picture to pixels. `image_size_px` is what a user said; else what the file
/// says is taken. Pixels stay as they are.
///
/// # Errors
/// Coordinates are shares and no size is known, or are metres about the hips.
pub fn to_pixels(
    mut detections: Detections,
    image_size_px: Option<[f64; 2]>,
    path: &Path,
) -> Result<Detections, KeypointError> {
    let size = image_size_px.or(detections.image_size_px);
    detections.image_size_px = size;
    let positions = || detections.frames.iter().flat_map(|frame| frame.people.iter().flatten());
    let are_shares = positions().all(|keypoint| keypoint.position_px.iter().all(|share| share.abs() <= MAX_SHARE));
    if !are_shares || positions().next().is_none() {
        return Ok(detections);
    }
    let is_hip = |part: Part| HIPS.iter().any(|hip| part == Part::Joint(*hip));
    let (hips, centred) =
        detections.frames.iter().flat_map(|frame| &frame.people).fold((0, 0), |(all, near), person| {
            let hips: Vec<[f64; 2]> =
                person.iter().filter(|point| is_hip(point.part)).map(|point| point.position_px).collect();
            let is_pair = hips.len() == 2;
            let is_near =
                is_pair && [0, 1].iter().all(|axis| (hips[0][*axis] + hips[1][*axis]).abs() < 2.0 * MAX_HIP_OFFSET);
            (all + usize::from(is_pair), near + usize::from(is_near))
        });
    if hips > 0 && centred == hips {
        let rule = "holds metres about the hips (MediaPipe's world landmarks), not places in the picture; give its normalised landmarks, with `--image-size WIDTH,HEIGHT`";
        return Err(KeypointError::unusable(path, rule));
    }
    let Some(size) = size else {
        let rule = "holds shares of the picture (no coordinate is beyond 3), and angles need its shape; give `--image-size WIDTH,HEIGHT` in pixels";
        return Err(KeypointError::unusable(path, rule));
    };
    for keypoint in detections.frames.iter_mut().flat_map(|frame| frame.people.iter_mut().flatten()) {
        keypoint.position_px = [0, 1].map(|axis| keypoint.position_px[axis] * size[axis]);
    }
    detections.notes.push(format!(
        "coordinates are shares of the picture: they were multiplied by its size, {} x {} pixels",
        size[0], size[1]
    ));
    Ok(detections)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keypoints::layout::{DetectedFrame, Keypoint};

    fn of(points: &[(usize, [f64; 2])]) -> Detections {
        let keypoint = |&(joint, position_px): &(usize, [f64; 2])| Keypoint {
            part: Part::Joint(joint),
            position_px,
            confidence: 1.0,
        };
        let person = points.iter().map(keypoint).collect();
        Detections { frames: vec![DetectedFrame { frame: 0, people: vec![person] }], ..Detections::default() }
    }

    fn read(points: &[(usize, [f64; 2])], size: Option<[f64; 2]>) -> Result<[f64; 2], String> {
        let found = to_pixels(of(points), size, Path::new("k.csv")).map_err(|error| error.to_string())?;
        Ok(found.frames[0].people[0][0].position_px)
    }

    #[test]
    fn shares_need_a_size_and_pixels_do_not() {
        let shares = [(8, [0.5, 0.25]), (11, [0.6, -0.1])];
        assert_eq!(read(&shares, Some([1920.0, 1080.0])), Ok([960.0, 270.0]));
        assert!(read(&shares, None).unwrap_err().contains("--image-size WIDTH,HEIGHT"));
        let pixels = [(8, [300.0, 0.5]), (11, [310.0, 2.0])];
        assert_eq!(read(&pixels, Some([1920.0, 1080.0])), Ok([300.0, 0.5]));
        assert_eq!(read(&pixels, None), Ok([300.0, 0.5]));
        let world = [(8, [0.11, 0.01]), (11, [-0.11, -0.01])];
        assert!(read(&world, Some([1920.0, 1080.0])).unwrap_err().contains("metres about the hips"));
    }

    #[test]
    fn the_files_own_size_is_used() {
        let detections = Detections { image_size_px: Some([200.0, 100.0]), ..of(&[(8, [0.5, 0.5]), (11, [0.6, 0.5])]) };
        let found = to_pixels(detections, None, Path::new("k.csv")).unwrap();
        assert_eq!((found.frames[0].people[0][0].position_px, found.notes.len()), ([100.0, 50.0], 1));
    }
}
