use super::*;
use crate::keypoints::layout::{stick_joints, sure_of};
use crate::motion::joint_names::JOINTS;

/// Values of points at (number + 1, 10) with confidence 0.9.
fn numbered(count: usize) -> Vec<f64> {
    (0..count).flat_map(|i| [i as f64 + 1.0, 10.0, 0.9]).collect()
}

fn joints(count: usize) -> [Option<f64>; JOINTS] {
    let person = named(&points(&numbered(count)).unwrap(), &parts(count).unwrap());
    stick_joints(&person).map(|joint| joint.map(|[u, _]| u - 1.0))
}

#[test]
fn each_layout_has_its_order() {
    let coco = [11.5, 5.5, 5.0, 7.0, 9.0, 6.0, 8.0, 10.0, 11.0, 13.0, 15.0, 12.0, 14.0, 16.0];
    for count in [17, 23, 133] {
        assert_eq!(joints(count), coco.map(Some));
    }
    let mut halpe = coco;
    (halpe[HIP_CENTER], halpe[NECK]) = (19.0, 18.0);
    for count in [26, 136] {
        assert_eq!(joints(count), halpe.map(Some));
    }
    let body_25 = [8.0, 1.0, 5.0, 6.0, 7.0, 2.0, 3.0, 4.0, 12.0, 13.0, 14.0, 9.0, 10.0, 11.0];
    assert_eq!(joints(25), body_25.map(Some));
    let openpose_18 = [9.5, 1.0, 5.0, 6.0, 7.0, 2.0, 3.0, 4.0, 11.0, 12.0, 13.0, 8.0, 9.0, 10.0];
    assert_eq!(joints(18), openpose_18.map(Some));
    let mpii = [6.0, 7.0, 13.0, 14.0, 15.0, 12.0, 11.0, 10.0, 3.0, 4.0, 5.0, 2.0, 1.0, 0.0];
    assert_eq!(joints(16), mpii.map(Some));
    let mediapipe = [23.5, 11.5, 11.0, 13.0, 15.0, 12.0, 14.0, 16.0, 23.0, 25.0, 27.0, 24.0, 26.0, 28.0];
    assert_eq!(joints(33), mediapipe.map(Some));
    assert!(points(&[0.0; 24]).unwrap_err().starts_with("8 keypoints; 7 (head and arms), 14 (CrowdPose)"));
    assert!(points(&[0.0; 50]).unwrap_err().contains("x, y and confidence"));
}

#[test]
fn every_order_has_each_side_once() {
    for order in &ORDERS {
        let parts = order.parts();
        assert_eq!(parts.len(), order.count, "{}", order.name);
        for joint in 2..JOINTS {
            let count = parts.iter().filter(|part| **part == Part::Joint(joint)).count();
            assert_eq!(count, usize::from(order.count != 7 || joint < 8), "{}: joint {joint}", order.name);
        }
    }
}

/// A standing figure in each order is known by where its points lie.
#[test]
fn orders_of_as_many_points_differ_by_where_the_points_lie() {
    let place = |part: Part| match part {
        Part::Nose => [108.0, 40.0],
        Part::Joint(joint) => [
            [100.0, 150.0],
            [100.0, 62.0],
            [97.0, 60.0],
            [90.0, 100.0],
            [95.0, 140.0],
            [103.0, 61.0],
            [106.0, 102.0],
            [112.0, 138.0],
            [97.0, 150.0],
            [104.0, 200.0],
            [99.0, 250.0],
            [103.0, 151.0],
            [108.0, 199.0],
            [111.0, 248.0],
        ][joint],
        Part::Toe(_) => [120.0, 258.0],
        Part::Heel(_) => [95.0, 258.0],
        Part::Other => [101.0, 41.0],
    };
    for order in &ORDERS {
        let person: Points = order.parts().into_iter().map(|part| [place(part)[0], place(part)[1], 0.9]).collect();
        let found = name_points(&[PointFrame { frame: 0, people: vec![person] }]);
        assert_eq!(found.layout, format!("{}, {} points", order.name, order.count));
        assert_eq!(found.doubts, [""; 0]);
    }
}

#[test]
fn places_that_no_picture_has_are_refused_by_name() {
    let mut values = numbered(17);
    values[3 * 9] = 1.0e308;
    let message = points(&values).unwrap_err();
    assert_eq!(message, "keypoint `9` (l_wrist) lies at (1e308, 1e1), and 1e9 pixels are the most");
    values[3 * 9] = -1.0e9;
    assert!(points(&values).is_ok());
}

#[test]
fn points_that_were_not_found_are_missing() {
    let mut values = numbered(17);
    values[15..18].copy_from_slice(&[0.0, 0.0, 0.0]);
    values[21] = f64::NAN;
    values[29] = 0.1;
    let person = named(&points(&values).unwrap(), &parts(17).unwrap());
    let frame = DetectedFrame { frame: 0, people: vec![person] };
    let found = stick_joints(&sure_of(&frame, 0.3).people[0]);
    assert!(found[2].is_none() && found[3].is_none() && found[4].is_none() && found[NECK].is_none());
    assert!(found[5].is_some());
    assert!(sure_of(&frame, 0.95).people.is_empty());
}
