//! A body whose root is held, and one whose root is free and fitted to the points.

use crate::corners::Corners;
use crate::drive::{Recovery, Subject, drive, holds};
use sinew_core::math::{Vec3, min};
use sinew_core::observation::point_cloud::{PointBlock, PointCloud};
use sinew_core::pik::example::{arm_points, arm_scene, bending_elbow, guided_arm, hand_goals, rod_points, rod_scene};
use sinew_core::pik::goal::LinearExtrapolation;
use sinew_core::pik::guided::GuidedMotion;
use sinew_core::pik::motion::{BodyParticle, BodyScene};
use sinew_core::pik::processes::extrapolation::LinearGoals;
use sinew_core::pik::root::RootProcess;
use sinew_core::saved_state::SavedState;
use sinew_core::tracker::body::{
    BodyEstimate, BodyFrame, BodyOptions, BodyTracker, DEFAULT_BODY_OPTIONS, RootAlignment, SpeedScaledNoise,
};

const DT_S: f32 = 1.0 / 15.0;
/// An end of the twin, metres: three times the noise of its particles.
const MAX_APART_M: f32 = 0.18;
const OPTIONS: BodyOptions = BodyOptions {
    jitter_std_errors: 1.0,
    jitter_std_m: 0.005,
    pace: Some(SpeedScaledNoise {
        rest_share: 0.4,
        full_speed_m_per_s: 1.3,
        max_scale_seen: 1.5,
        fade_s: 0.3,
        unseen_growth_s: 0.5,
        max_scale_unseen: 2.0,
    }),
    acceleration_share: 0.5,
    ..DEFAULT_BODY_OPTIONS
};

/// Blocks with hostile points, by the cloud's own border or around it.
fn hostile_blocks(corners: &mut Corners, clean: &[PointBlock], camera_m: &Vec3) -> Vec<PointBlock> {
    if corners.one_in(4) {
        return Vec::new();
    }
    let mut blocks = clean.to_vec();
    if corners.one_in(2) {
        let mut points_m: Vec<_> = blocks
            .iter()
            .flat_map(|block| (0..16).map(|i| block.point_m(i)))
            .map(|point_m| corners.place(point_m))
            .collect();
        let mut cloud = PointCloud::<3>::new();
        let _ = cloud.set(&mut points_m, camera_m);
        return cloud.blocks().to_vec();
    }
    let index = corners.below(blocks.len());
    let block = &mut blocks[index];
    for axis in [&mut block.x, &mut block.y, &mut block.z] {
        axis[corners.below(16)] = corners.corner();
    }
    block.centre_m = corners.place(block.centre_m);
    block.radius_m = corners.number(block.radius_m);
    block.count = if corners.one_in(3) { u8::MAX } else { 16 };
    blocks
}

type Tracker<const B: usize, const A: usize> = BodyTracker<B, A, 40, Vec<BodyParticle<B, A>>>;

struct Body<const B: usize, const A: usize> {
    scene: BodyScene<B, A>,
    goals: LinearGoals,
    motion: for<'a> fn(&'a LinearGoals) -> GuidedMotion<'a, LinearGoals, A>,
    points: fn(&BodyScene<B, A>) -> Vec<PointBlock>,
    trackers: [Tracker<B, A>; 2],
    last: Option<[BodyEstimate<B, A>; 2]>,
}

impl<const B: usize, const A: usize> Subject for Body<B, A> {
    fn hostile(&mut self, corners: &mut Corners) -> Result<(), String> {
        let blocks = hostile_blocks(corners, &(self.points)(&self.scene), &self.scene.camera_m);
        let mut dt_s = corners.number(DT_S);
        // A time that is too long counts as the longest, ten seconds: after it the body may be
        // anywhere, so that is no number that is refused.
        if corners.only_refused() && dt_s.is_finite() {
            dt_s = min(dt_s, DT_S);
        }
        let frame = BodyFrame { dt_s, blocks: &blocks };
        let estimate = self.trackers[0].step(&self.scene, &(self.motion)(&self.goals), &frame);
        let is_sound = estimate.angles_rad.iter().chain([&estimate.log_evidence]).all(|x| x.is_finite())
            && estimate.ends_m.iter().all(|end_m| end_m.iter().all(|x| x.is_finite()))
            && estimate.spread_m.iter().all(|spread_m| *spread_m >= 0.0 && spread_m.is_finite());
        holds(is_sound, || format!("{estimate:?} by {frame:?}"))?;
        holds(self.trackers[0].is_finite(), || format!("the state by {frame:?}"))
    }

    fn clean(&mut self) {
        let blocks = (self.points)(&self.scene);
        let (frame, motion) = (BodyFrame { dt_s: DT_S, blocks: &blocks }, (self.motion)(&self.goals));
        self.last = Some(self.trackers.each_mut().map(|tracker| tracker.step(&self.scene, &motion, &frame)));
    }

    fn apart(&mut self) -> f32 {
        let Some([one, twin]) = &self.last else { return f32::INFINITY };
        let ends = one.ends_m.iter().zip(&twin.ends_m).map(|(a, b)| (a - b).norm());
        ends.fold(0.0, |sum: f32, apart_m| if apart_m <= sum { sum } else { apart_m }) / MAX_APART_M
    }
}

fn new<const B: usize, const A: usize>(first: &BodyParticle<B, A>, options: BodyOptions) -> [Tracker<B, A>; 2] {
    let tracker = BodyTracker::new(first, (vec![*first; 40], vec![*first; 40]), options, 1).unwrap();
    [tracker.clone(), tracker]
}

#[test]
fn a_body_survives_hostile_frames() {
    drive("body", 30, Recovery::FromRefused, || {
        let scene = arm_scene().unwrap();
        let first = BodyParticle::at(&scene.skeleton, bending_elbow(1));
        let options = BodyOptions { limb_by_limb: true, ..OPTIONS };
        Body {
            goals: hand_goals().unwrap(),
            motion: guided_arm,
            points: |scene| arm_points(scene, &bending_elbow(1)).blocks().to_vec(),
            trackers: new(&first, options),
            last: None,
            scene,
        }
    });
}

const ROD_POSE: [f32; 6] = [0.1, 0.0, 3.0, 0.0, 0.0, 0.0];

fn moving_rod(goals: &LinearGoals) -> GuidedMotion<'_, LinearGoals, 6> {
    GuidedMotion {
        process: goals,
        root: RootProcess { persistence: 0.5, std_per_sqrt_s: [0.3, 0.3, 0.3, 0.1, 0.1, 0.1], ..RootProcess::FIXED },
        angle_std_rad_per_sqrt_s: [1.0; 6],
        angle_persistence: 0.0,
        solver_steps: 2,
        pulling_blocks: 3,
        refining_steps: 2,
    }
}

#[test]
fn a_body_with_a_free_root_survives_hostile_frames() {
    // A rod that was turned end for end looks the same.
    drive("body, free root", 30, Recovery::FromRefused, || {
        let scene = rod_scene().unwrap();
        let first = BodyParticle::at(&scene.skeleton, ROD_POSE);
        let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.3 };
        let alignment = RootAlignment {
            steps: 10,
            coarse_to_fine: true,
            shift_std_m_per_sqrt_s: 1.0,
            turn_std_rad_per_sqrt_s: 0.1,
            angle_std_rad_per_sqrt_s: 1.0,
            pulling_blocks: 32,
            fit_trunk: true,
        };
        Body {
            goals: LinearGoals::new(&[0], 1, process, 0.05).unwrap(),
            motion: moving_rod,
            points: |scene| rod_points(scene, &ROD_POSE).blocks().to_vec(),
            trackers: new(&first, BodyOptions { alignment: Some(alignment), ..OPTIONS }),
            last: None,
            scene,
        }
    });
}
