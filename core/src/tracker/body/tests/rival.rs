//! Legs that are exchanged at first.

use super::*;
use crate::pik::guided::GuidedMotion;
use crate::skeleton::full_body::THIGHS;

const RIVAL: RivalOptions = RivalOptions { evidence_share: 0.2, switch_cost: 10.0 };
/// First coordinates of the legs.
const LEGS: [usize; 2] = [20, 25];

/// Someone 2.5 m away who walks on the spot, a stride a second.
fn walk_rad(frame: usize) -> [f32; BODY_ANGLES] {
    let swing = 0.5 * libm::sinf(core::f32::consts::TAU * DT_S * frame as f32 + 0.5);
    let mut pose = [0.0; BODY_ANGLES];
    (pose[2], pose[LEGS[0]], pose[LEGS[1]]) = (2.5, swing, -swing);
    (pose[23], pose[28]) = (0.4 + 0.6 * swing, 0.4 - 0.6 * swing);
    pose
}

fn sharp_scene() -> Scene {
    Scene { likelihood: PointLikelihood { std_m: 0.05, outlier_m: 0.08 }, ..scene() }
}

fn walker(scene: &Scene, (rival, is_exchanged): (Option<RivalOptions>, bool)) -> Tracker {
    let mut first_rad = walk_rad(0);
    if is_exchanged {
        let (left, right) = first_rad.split_at_mut(LEGS[1]);
        left[LEGS[0]..].swap_with_slice(&mut right[..5]);
    }
    let first = Particle::at(&scene.skeleton, first_rad);
    let options = BodyOptions { alignment: None, rival, ..OPTIONS };
    Tracker::new(&first, (vec![first; 20], vec![first; 20]), options, 1).unwrap()
}

fn walk_on(tracker: &mut Tracker, scene: &Scene, frame: usize) -> BodyEstimate<BODY_BONES, BODY_ANGLES> {
    let goals = goals();
    let motion = GuidedMotion { refining_steps: 3, ..guided(&goals) };
    let cloud = cloud_of(scene, &walk_rad(frame), frame, &[]);
    tracker.step(scene, &motion, &BodyFrame { dt_s: DT_S, blocks: cloud.blocks() })
}

/// Mean distance of knees and ankles from the truth after ten frames, metres.
fn legs_off_m(who: (Option<RivalOptions>, bool)) -> f32 {
    let scene = sharp_scene();
    let mut tracker = walker(&scene, who);
    let mut ends_m = [Vec3::zeros(); BODY_BONES];
    for frame in 1..=10 {
        ends_m = walk_on(&mut tracker, &scene, frame).ends_m;
    }
    let true_m = scene.posture(&walk_rad(10)).ends;
    let off_m = |bone: usize| (ends_m[bone] - true_m[bone]).norm();
    [THIGHS, SHANKS].concat().into_iter().map(off_m).sum::<f32>() / 4.0
}

#[test]
fn exchanged_legs_are_found_again_by_the_rival_and_not_without() {
    let found_m = legs_off_m((Some(RIVAL), true));
    assert!(found_m < 0.03, "{found_m}");
    let alone_m = legs_off_m((None, true));
    assert!(alone_m > 0.1, "{alone_m}");
}

#[test]
fn legs_that_are_right_stay_as_they_are() {
    let scene = sharp_scene();
    let [mut with, mut without] = [Some(RIVAL), None].map(|rival| walker(&scene, (rival, false)));
    for frame in 1..=15 {
        assert_eq!(walk_on(&mut with, &scene, frame), walk_on(&mut without, &scene, frame), "frame {frame}");
        assert!(with.rival().is_none_or(|(_, log_weight)| log_weight < 0.0), "frame {frame}");
        assert_eq!(without.rival(), None);
    }
}

#[test]
fn a_frame_without_points_gives_the_rival_up() {
    let scene = sharp_scene();
    let mut tracker = walker(&scene, (Some(RIVAL), true));
    let _ = walk_on(&mut tracker, &scene, 1);
    assert!(tracker.rival().is_some());
    let goals = goals();
    let motion = GuidedMotion { refining_steps: 3, ..guided(&goals) };
    let _ = tracker.step(&scene, &motion, &BodyFrame { dt_s: DT_S, blocks: &[] });
    assert_eq!(tracker.rival(), None);
}

#[test]
fn a_state_with_a_rival_goes_on_as_if_nothing_had_been() {
    let scene = sharp_scene();
    let mut tracker = walker(&scene, (Some(RIVAL), true));
    let _ = walk_on(&mut tracker, &scene, 1);
    assert!(tracker.rival().is_some());
    let mut bytes = vec![0; saved_bytes(&mut tracker)];
    save(StateKind::Body, 1, &mut tracker, &mut bytes).unwrap();
    let mut other = walker(&scene, (Some(RIVAL), false));
    restore(StateKind::Body, 1, &mut other, &bytes).unwrap();
    for frame in 2..6 {
        assert_eq!(walk_on(&mut other, &scene, frame), walk_on(&mut tracker, &scene, frame), "frame {frame}");
        assert_eq!(other.rival(), tracker.rival());
    }
}
