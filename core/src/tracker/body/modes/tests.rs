//! The tracker by modes on a constructed walk.

use super::super::estimate::BodyEstimate;
use super::super::frame::BodyFrame;
use super::options::{DEFAULT_MODE_OPTIONS, ModeOptions};
use super::select::select;
use super::state::{BodyMode, ModeTracker};
use crate::math::Vec3;
use crate::observation::point_cloud::PointCloud;
use crate::observation::point_likelihood::PointLikelihood;
use crate::pik::goal::LinearExtrapolation;
use crate::pik::guided::GuidedMotion;
use crate::pik::motion::{BodyParticle, BodyScene};
use crate::pik::processes::extrapolation::LinearGoals;
use crate::pik::root::{NO_PLANES, RootProcess};
use crate::random::Stream;
use crate::saved_state::{StateKind, restore, save, saved_bytes};
use crate::skeleton::BodyMeasures;
use crate::skeleton::full_body::{BODY_ANGLES, BODY_BONES, FOREARMS, SHANKS, body_radii_m, full_body};

const DT_S: f32 = 1.0 / 15.0;

type Scene = BodyScene<BODY_BONES, BODY_ANGLES>;
type Tracker = ModeTracker<BODY_BONES, BODY_ANGLES>;

fn scene() -> Scene {
    let measures = BodyMeasures::of_height(1.75).unwrap();
    BodyScene {
        skeleton: full_body(&measures).unwrap(),
        radii_m: body_radii_m(&measures),
        camera_m: Vec3::zeros(),
        likelihood: PointLikelihood { std_m: 0.05, outlier_m: 0.08 },
        self_penetration: None,
    }
}

/// Someone 2.5 m away who walks on the spot, a stride a second.
fn walk_rad(frame: usize) -> [f32; BODY_ANGLES] {
    let swing = 0.5 * libm::sinf(core::f32::consts::TAU * DT_S * frame as f32 + 0.5);
    let mut pose = [0.0; BODY_ANGLES];
    (pose[2], pose[20], pose[25]) = (2.5, swing, -swing);
    (pose[23], pose[28]) = (0.4 + 0.6 * swing, 0.4 - 0.6 * swing);
    (pose[12], pose[16]) = (0.3 - 0.4 * swing, 0.3 + 0.4 * swing);
    pose
}

/// A thousand points on the skin that the camera sees, with a centimetre of noise.
fn cloud(scene: &Scene, frame: usize) -> PointCloud<63> {
    let surface = scene.surface(&scene.posture(&walk_rad(frame)));
    let mut stream = Stream::new(3, frame as u64, 0);
    let mut points_m: Vec<Vec3> = Vec::new();
    for seen in surface.capsules.iter().cycle().take(1000) {
        let axis_m = seen.capsule.start_m + seen.along_m * stream.uniform();
        let skin_m = seen.capsule.nearest_visible(&scene.camera_m, &(axis_m + stream.normal3()));
        points_m.push(skin_m + stream.normal3() * 0.01);
    }
    let mut cloud = PointCloud::new();
    let _ = cloud.set(&mut points_m, &scene.camera_m);
    cloud
}

fn goals() -> LinearGoals {
    let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.5 };
    let ends = [FOREARMS[0], FOREARMS[1], SHANKS[0], SHANKS[1]];
    LinearGoals::new(&ends, BODY_BONES, process, 0.05).unwrap().carrying(2)
}

fn motion(goals: &LinearGoals) -> GuidedMotion<'_, LinearGoals, BODY_ANGLES> {
    GuidedMotion {
        process: goals,
        root: RootProcess {
            persistence: 0.5,
            std_per_sqrt_s: [0.3, 0.3, 0.3, 0.7, 0.7, 0.7],
            shift_limits_m: NO_PLANES,
        },
        angle_std_rad_per_sqrt_s: [2.0; BODY_ANGLES],
        angle_persistence: 0.5,
        solver_steps: 4,
        pulling_blocks: usize::MAX,
        refining_steps: 0,
    }
}

/// A tracker whose first pose has the legs exchanged.
fn exchanged_tracker(scene: &Scene, options: ModeOptions) -> Tracker {
    let mut first_rad = walk_rad(0);
    for angle in 20..25 {
        first_rad.swap(angle, angle + 5);
    }
    Tracker::new(&BodyParticle::at(&scene.skeleton, first_rad), options, 1).unwrap()
}

fn step(tracker: &mut Tracker, scene: &Scene, frame: usize) -> BodyEstimate<BODY_BONES, BODY_ANGLES> {
    let goals = goals();
    let cloud = cloud(scene, frame);
    tracker.step(scene, &motion(&goals), &BodyFrame { dt_s: DT_S, blocks: cloud.blocks() })
}

/// Ankles' distance from the truth after ten frames, metres, from a first pose with exchanged legs.
fn ankles_off_m(options: ModeOptions) -> f32 {
    let scene = scene();
    let mut tracker = exchanged_tracker(&scene, options);
    let mut ends_m = [Vec3::zeros(); BODY_BONES];
    for frame in 1..=10 {
        ends_m = step(&mut tracker, &scene, frame).ends_m;
    }
    let true_m = scene.posture(&walk_rad(10)).ends;
    SHANKS.iter().map(|&bone| 0.5 * (ends_m[bone] - true_m[bone]).norm()).sum()
}

#[test]
fn exchanged_legs_are_found_again_by_rivals_and_not_without() {
    let found_m = ankles_off_m(DEFAULT_MODE_OPTIONS);
    let alone_m = ankles_off_m(ModeOptions { max_modes: 1, draws: 0, ..DEFAULT_MODE_OPTIONS });
    assert!(found_m < 0.03, "{found_m}");
    assert!(alone_m > 0.1, "{alone_m}");
}

#[test]
fn a_saved_tracker_goes_on_to_the_bit() {
    let scene = scene();
    let mut tracker = exchanged_tracker(&scene, DEFAULT_MODE_OPTIONS);
    for frame in 1..4 {
        let _ = step(&mut tracker, &scene, frame);
    }
    let mut bytes = vec![0; saved_bytes(&mut tracker)];
    save(StateKind::Body, 7, &mut tracker, &mut bytes).unwrap();
    let mut again = exchanged_tracker(&scene, DEFAULT_MODE_OPTIONS);
    restore(StateKind::Body, 7, &mut again, &bytes).unwrap();
    assert_eq!(again.modes(), tracker.modes());
    assert_eq!(step(&mut again, &scene, 4), step(&mut tracker, &scene, 4));
    // One that follows fewer modes refuses more.
    let mut alone = exchanged_tracker(&scene, ModeOptions { max_modes: 1, ..DEFAULT_MODE_OPTIONS });
    assert_eq!(restore(StateKind::Body, 7, &mut alone, &bytes).is_err(), tracker.modes().len() > 1);
}

#[test]
fn without_points_the_leading_mode_alone_goes_on_and_spreads() {
    let scene = scene();
    let mut tracker = exchanged_tracker(&scene, DEFAULT_MODE_OPTIONS);
    let seen = step(&mut tracker, &scene, 1);
    let goals = goals();
    let unseen = tracker.step(&scene, &motion(&goals), &BodyFrame { dt_s: DT_S, blocks: &[] });
    assert_eq!(unseen.observed, [false; BODY_BONES]);
    for bone in FOREARMS {
        assert!(unseen.spread_m[bone] > 3.0 * seen.spread_m[bone], "{:?} {:?}", unseen.spread_m, seen.spread_m);
    }
}

/// Modes with these weights, the first of which leads, all at poses of their own.
fn candidates(weights: &[(f32, bool)]) -> Vec<BodyMode<BODY_BONES, BODY_ANGLES>> {
    let scene = scene();
    let tracker = exchanged_tracker(&scene, DEFAULT_MODE_OPTIONS);
    let mode = |(index, &(log_weight, is_rival)): (usize, &(f32, bool))| {
        let mut pose_rad = walk_rad(0);
        pose_rad[0] = 0.5 * index as f32;
        let pose = BodyParticle::at(&scene.skeleton, pose_rad);
        BodyMode { pose, log_weight, is_rival, ..tracker.modes()[0] }
    };
    weights.iter().enumerate().map(mode).collect()
}

/// Weights of the modes that are kept of these.
fn kept(candidates: &[BodyMode<BODY_BONES, BODY_ANGLES>], max_modes: usize) -> Vec<f32> {
    let mut kept = heapless::Vec::new();
    let options = ModeOptions { max_modes, switch_cost: 10.0, ..DEFAULT_MODE_OPTIONS };
    select(candidates, &options, &mut kept);
    kept.iter().map(|mode| mode.log_weight).collect()
}

#[test]
fn a_rival_leads_once_it_is_heavier_and_the_last_leader_pays_the_cost() {
    let waits = candidates(&[(5.0, false), (4.0, true), (-6.0, true)]);
    assert_eq!(kept(&waits, 8), [0.0, -1.0, -11.0]);
    let leads = candidates(&[(5.0, false), (6.0, true), (-6.0, true)]);
    assert_eq!(kept(&leads, 8), [0.0, -10.0, -12.0]);
    // A better pose of the leading mode is no rival.
    let refined = candidates(&[(5.0, false), (6.0, false), (-6.0, true)]);
    assert_eq!(kept(&refined, 8), [0.0, -1.0, -12.0]);
}

#[test]
fn alike_modes_are_merged_and_unlikely_ones_pruned() {
    let mut modes = candidates(&[(5.0, false), (4.0, true), (-26.0, true)]);
    assert_eq!(kept(&modes, 8), [0.0, -1.0], "31 lighter");
    assert_eq!(kept(&modes, 1), [0.0]);
    modes[1].pose = modes[0].pose;
    assert_eq!(kept(&modes, 8), [0.0]);
}
