//! Limbs and frames without points.

use super::*;

/// Chance decides whether an arm that went on unseen is found again: most are, with either model.
#[test]
fn a_hidden_arm_grows_uncertain_is_said_to_be_unseen_and_comes_back() {
    let goals = goals();
    let guided = hidden_arms_found(&guided(&goals), 60, BodyOptions { pace: Some(PACE), ..OPTIONS });
    assert!(guided >= 4, "{guided} of 6");
    // Twice the reach of a limb in full swing: at rest, with two fifths of it, about what a goal
    // without a pace has.
    let mut goals = goals;
    goals.reach_std_m = 0.10;
    let by_goals = hidden_arms_found(&end_effector(&goals), 200, BodyOptions { pace: Some(PACE), ..LIMB_BY_LIMB });
    assert!(by_goals >= 5, "{by_goals} of 6");
}

/// Of six runs those in which a hand is where it is 15 frames after its arm was hidden for 15
/// frames. In all of them its spread grows meanwhile, and it is said to be unseen but for a frame
/// or two.
fn hidden_arms_found(motion: &impl BodyMotion<BODY_BONES, BODY_ANGLES>, count: usize, options: BodyOptions) -> usize {
    let (scene, hand, arm) = (scene(), FOREARMS[0], [UPPER_ARMS[0], FOREARMS[0]]);
    let mut found = 0;
    for seed in 4..10 {
        let mut tracker = tracker_of(&scene, count, seed, options);
        let (mut seen_spread, mut hidden_spread, mut said_seen, mut last_error) = (0.0, 0.0, 0, 0.0);
        for frame in 1..50 {
            let is_hidden = (20..35).contains(&frame);
            let cloud = cloud(&scene, frame, if is_hidden { &arm } else { &[] });
            let estimate = tracker.step(&scene, motion, &BodyFrame { dt_s: DT_S, blocks: cloud.blocks() });
            said_seen += usize::from(is_hidden && estimate.observed[hand]);
            match frame {
                19 => seen_spread = estimate.spread_m[hand],
                34 => hidden_spread = estimate.spread_m[hand],
                _ => {}
            }
            last_error = (estimate.ends_m[hand] - scene.posture(&truth(frame)).ends[hand]).norm();
        }
        assert!(hidden_spread > 1.7 * seen_spread, "{seen_spread} {hidden_spread}");
        assert!(said_seen <= 3, "{said_seen} of 15 frames");
        found += usize::from(last_error < 0.15);
    }
    found
}

#[test]
fn frames_without_points_and_gaps_are_frames_like_others() {
    [OPTIONS, LIMB_BY_LIMB].into_iter().for_each(frames_without_points);
}

fn frames_without_points(options: BodyOptions) {
    let (scene, goals) = (scene(), goals());
    let motion = end_effector(&goals);
    let mut tracker = tracker_of(&scene, 50, 4, options);
    let before = tracker.step(&scene, &motion, &BodyFrame { dt_s: DT_S, blocks: cloud(&scene, 1, &[]).blocks() });
    let mut last = before;
    for dt_s in [DT_S, 1.0, 0.0, f32::NAN, -3.0] {
        last = tracker.step(&scene, &motion, &BodyFrame { dt_s, blocks: &[] });
        assert!(last.angles_rad.iter().all(|angle| angle.is_finite()));
        assert!(last.observed.iter().all(|seen| !seen) && !last.is_degenerate);
    }
    assert!(last.spread_m[FOREARMS[0]] > 2.0 * before.spread_m[FOREARMS[0]]);
    let one_point = {
        let mut cloud = Cloud::new();
        let _ = cloud.set(&mut [Vec3::new(0.0, 0.0, 2.9)], &Vec3::zeros());
        cloud
    };
    let estimate = tracker.step(&scene, &motion, &BodyFrame { dt_s: DT_S, blocks: one_point.blocks() });
    assert!(estimate.log_evidence.is_finite());
}

/// Weighted mean depth of the left forearm in the trunk, metres, while the arm is hidden beside the
/// body.
fn mean_depth_m(self_penetration: Option<SelfPenetration<BODY_BONES>>, options: BodyOptions) -> f32 {
    let scene = Scene { self_penetration, ..scene() };
    let goals = goals();
    let motion = end_effector(&goals);
    let mut hanging = truth(0);
    // The hand before the belly.
    (hanging[12], hanging[14], hanging[15]) = (0.2, 1.0, 1.4);
    let first = Particle::at(&scene.skeleton, hanging);
    let mut tracker = Tracker::new(&first, (vec![first; 200], vec![first; 200]), options, 3).unwrap();
    let cloud = cloud(&scene, 0, &[UPPER_ARMS[0], FOREARMS[0]]);
    let (mut depth, mut frames) = (0.0, 0.0);
    for frame in 0..25 {
        tracker.step(&scene, &motion, &BodyFrame { dt_s: DT_S, blocks: cloud.blocks() });
        if frame < 5 {
            continue;
        }
        frames += 1.0;
        for (particle, weight) in tracker.particles().iter().zip(tracker.weights()) {
            let surface = scene.surface(&scene.posture(&particle.angles_rad));
            let of = |bone: usize| surface.capsules.iter().find(|seen| seen.bone == bone).unwrap().capsule;
            depth += weight * of(FOREARMS[0]).depth_m(&of(TRUNK)).max(0.0);
        }
    }
    depth / frames
}

#[test]
fn a_hidden_arm_stays_out_of_the_trunk_where_that_is_asked_for() {
    let scene = scene();
    let apart = SelfPenetration::new(&scene.skeleton, &scene.radii_m, 0.01).unwrap();
    for options in [OPTIONS, LIMB_BY_LIMB] {
        let (free, asked) = (mean_depth_m(None, options), mean_depth_m(Some(apart), options));
        assert!(free > 0.01 && free < 0.15, "{free}");
        assert!(asked < 0.3 * free, "{asked} of {free}");
    }
}
