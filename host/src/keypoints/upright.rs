//! Pictures whose y points up.

use super::detections::Detections;
use super::layout::{Keypoint, Part, stick_joints};
use crate::motion::joint_names::{HIP_CENTER, NECK};

/// Share of the people in all frames who have to stand on their heads before y is taken to point
/// up. Chosen: one wrong detection in ten is no proof against it, and nobody walks on hands.
const MIN_SHARE: f64 = 0.9;
/// The ankles of the stick figure.
const ANKLES: [usize; 2] = [10, 13];

/// Turns y over, with a note, where the neck lies below the hips and these below the ankles in
/// nearly all frames. Then y is counted down from the picture's height, or from the highest point.
#[must_use]
pub fn upright(mut detections: Detections) -> Detections {
    let people = detections.frames.iter().flat_map(|frame| &frame.people);
    let order = |person: &Vec<Keypoint>| {
        let joints = stick_joints(person);
        let (neck, hips) = (joints[NECK]?[1], joints[HIP_CENTER]?[1]);
        let ankles = ANKLES.iter().filter_map(|ankle| joints[*ankle]);
        let ankle = ankles.map(|point| point[1]).reduce(f64::max)?;
        Some(neck > hips && hips > ankle)
    };
    let (all, over) = people
        .filter_map(order)
        .fold((0_usize, 0_usize), |(all, over), is_over| (all + 1, over + usize::from(is_over)));
    if all == 0 || (over as f64) < MIN_SHARE * all as f64 {
        return detections;
    }
    let points = || detections.frames.iter().flat_map(|frame| frame.people.iter().flatten());
    let highest =
        points().filter(|point| point.part != Part::Other).map(|point| point.position_px[1]).fold(0.0, f64::max);
    let height = detections.image_size_px.map_or(highest, |size| size[1]);
    for keypoint in detections.frames.iter_mut().flat_map(|frame| frame.people.iter_mut().flatten()) {
        keypoint.position_px[1] = height - keypoint.position_px[1];
    }
    detections.notes.push(format!(
        "y points up in this file (the neck lies below the hips and these below the ankles in {over} of {all} figures): y was turned over, and is now {height:.0} minus the file's"
    ));
    detections
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keypoints::layout::DetectedFrame;

    fn of(heights: &[[f64; 3]]) -> Detections {
        let figure = |[neck, hip, ankle]: &[f64; 3]| {
            let points = [(NECK, *neck), (HIP_CENTER, *hip), (10, *ankle)];
            points
                .map(|(joint, v)| Keypoint { part: Part::Joint(joint), position_px: [5.0, v], confidence: 1.0 })
                .to_vec()
        };
        let frames = (0..).zip(heights).map(|(frame, heights)| DetectedFrame { frame, people: vec![figure(heights)] });
        Detections { frames: frames.collect(), ..Detections::default() }
    }

    #[test]
    fn who_stands_on_the_head_in_all_frames_is_turned_over() {
        let found = upright(of(&[[90.0, 60.0, 10.0]; 5]));
        let heights: Vec<f64> = found.frames[0].people[0].iter().map(|point| point.position_px[1]).collect();
        assert_eq!((heights, found.notes.len()), (vec![0.0, 30.0, 80.0], 1));
        let sized = upright(Detections { image_size_px: Some([100.0, 100.0]), ..of(&[[90.0, 60.0, 10.0]]) });
        assert_eq!(sized.frames[0].people[0][0].position_px[1], 10.0);
        for others in
            [of(&[[10.0, 60.0, 90.0]; 5]), of(&[[60.0, 50.0, 90.0]; 5]), of(&[[90.0, 60.0, 10.0], [10.0, 60.0, 90.0]])]
        {
            assert_eq!(upright(others.clone()), others);
        }
    }
}
