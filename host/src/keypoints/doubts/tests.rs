use super::*;
use crate::cyclic::image_joints::JointFrame;
use crate::keypoints::layout::{Part, stick_joints};

/// A person of 60 frames whose trunk is 100 px. The numbers are the place of the hips, where the
/// nose is before the neck, and the length of the left thigh.
fn doubts(of: impl Fn(f64) -> (Point, f64, f64)) -> Vec<String> {
    let point = |part: Part, position_px: Point| Keypoint { part, position_px, confidence: 1.0 };
    let person = |frame: u32| {
        let ([u, v], nose, thigh) = of(f64::from(frame));
        vec![
            point(Part::Joint(HIP_CENTER), [u, v]),
            point(Part::Joint(NECK), [u, v - 100.0]),
            point(Part::Nose, [u + nose, v - 120.0]),
            point(Part::Joint(8), [u, v]),
            point(Part::Joint(9), [u, v + thigh]),
        ]
    };
    let people: Vec<Vec<Keypoint>> = (0..60).map(person).collect();
    let frame = |(frame, person): (u64, &Vec<Keypoint>)| JointFrame {
        frame,
        joints: stick_joints(person),
        feet: Default::default(),
    };
    let joints = ImageJoints { frames: (0..).zip(&people).map(frame).collect(), unit: "px" };
    let people: Vec<Option<&Vec<Keypoint>>> = people.iter().map(Some).collect();
    let facing = facing::find(&joints, &people);
    find(&Followed { joints: &joints, people: &people, facing, rate_hz: Some(30.0) })
}

/// Legs (or arms) of 200 px below hips (or shoulders) at one place, whose left and right angle at
/// each time are the numbers, radians; 100 frames.
fn limb_doubts(limb: usize, of: impl Fn(f64) -> [f64; 2]) -> Option<String> {
    let frame = |frame: u64| {
        let mut joints = [None; crate::motion::joint_names::JOINTS];
        for (side, angle_rad) in LIMBS[limb].2.iter().zip(of(frame as f64)) {
            for (place, joint) in side.iter().enumerate() {
                let reach_px = 100.0 * place as f64;
                joints[*joint] = Some([500.0 + reach_px * angle_rad.sin(), 300.0 + reach_px * angle_rad.cos()]);
            }
        }
        JointFrame { frame, joints, feet: Default::default() }
    };
    let joints = ImageJoints { frames: (0..100).map(frame).collect(), unit: "px" };
    twins(&Followed { joints: &joints, people: &[], facing: None, rate_hz: None }, LIMBS[limb])
}

#[test]
fn a_limb_that_was_found_twice_is_doubted_and_one_that_passes_or_rests_is_not() {
    let swing = |t: f64| 0.5 * (t / 5.0).sin();
    for (limb, words) in [(0, "right knees and ankles lie within 5 % of the leg's"), (1, "right elbows and wrists")] {
        let twice = limb_doubts(limb, |t| [swing(t), swing(t) + 0.02 * (1.7 * t).sin()]).unwrap();
        assert!(twice.contains(words) && twice.contains("in 100 of 100 frames"), "{twice}");
        assert_eq!(limb_doubts(limb, |t| [swing(t), -swing(t)]), None, "a walk");
        assert_eq!(limb_doubts(limb, |t| [swing(t), swing(t - 3.0)]), None, "a lag of a tenth");
        assert_eq!(limb_doubts(limb, |t| [0.02 * t.sin(), 0.02 * t.cos()]), None, "who stands");
    }
}

fn only(doubts: &[String], words: &str) {
    assert!(doubts.len() == 1 && doubts[0].contains(words), "{words}: {doubts:?}");
}

#[test]
fn who_walks_ahead_is_not_doubted() {
    assert_eq!(doubts(|t| ([4.0 * t, 300.0], 20.0, 80.0)), [""; 0]);
    assert_eq!(doubts(|t| ([-4.0 * t, 300.0], -20.0, 80.0)), [""; 0]);
    assert_eq!(doubts(|t| ([100.0, 300.0 + t], 0.5 * (t % 3.0 - 1.0), 80.0)), [""; 0], "who faces the camera");
}

#[test]
fn each_kind_is_named_with_its_numbers() {
    only(&doubts(|t| ([-4.0 * t, 300.0], 20.0, 80.0)), "faces right and moves 236 px (2.4 trunks) to the left");
    let turned = |t: f64| if t < 30.0 { (4.0 * t, 20.0) } else { (120.0, -20.0) };
    only(&doubts(|t| ([turned(t).0, 300.0], turned(t).1, 80.0)), "right at first and left from about frame");
    only(&doubts(|t| ([300.0 - 10.0 * (t - 30.0).abs(), 300.0], 0.1, 80.0)), "turns back at frame 30");
    let rower = |t: f64| 300.0 + 90.0 * (0.5 * t).sin();
    assert_eq!(doubts(|t| ([rower(t), 300.0], 0.1, 80.0)), [""; 0], "there and back with each cycle");
    only(&doubts(|t| ([4.0 * t, 300.0], 20.0, 40.0 + 40.0 * (t % 2.0))), "left thigh is 0.40 to 0.80 trunks");
    only(&doubts(|t| ([4.0 * t, if t == 20.0 { 370.0 } else { 300.0 }], 20.0, 80.0)), "in 2 frames, first in frame 20");
}
