//! Weights, resampling and the order of particles.

use super::*;

#[test]
fn the_order_of_the_particles_does_not_matter() {
    let (scene, goals) = (scene(), goals());
    let motion = end_effector(&goals);
    let (mut one, mut other) = (tracker(&scene, 60, 9), tracker(&scene, 60, 9));
    for frame in 1..6 {
        let cloud = cloud(&scene, frame, &[]);
        let frame = BodyFrame { dt_s: DT_S, blocks: cloud.blocks() };
        let a = one.step(&scene, &motion, &frame);
        let b = other.step_with(&scene, &motion, &frame, |advance, particles| {
            for (index, slot) in particles.iter_mut().enumerate().rev() {
                advance.particle(index, slot);
            }
        });
        assert_eq!(a, b);
    }
    assert_ne!(
        tracker(&scene, 60, 10).step(
            &scene,
            &motion,
            &BodyFrame { dt_s: DT_S, blocks: cloud(&scene, 1, &[]).blocks() }
        ),
        tracker(&scene, 60, 9).step(&scene, &motion, &BodyFrame { dt_s: DT_S, blocks: cloud(&scene, 1, &[]).blocks() })
    );
}

#[test]
fn limb_by_limb_no_group_has_fewer_effective_particles_than_asked_and_all_go_on_alike() {
    let (scene, goals) = (scene(), goals());
    let mut tracker = tracker_of(&scene, 100, 2, LIMB_BY_LIMB);
    for frame in 1..6 {
        let cloud = cloud(&scene, frame, &[]);
        let estimate = tracker.step(&scene, &end_effector(&goals), &BodyFrame { dt_s: DT_S, blocks: cloud.blocks() });
        assert!((19.9..60.0).contains(&estimate.effective_sample_size), "{}", estimate.effective_sample_size);
        assert!(tracker.weights().iter().all(|weight| (weight - 0.01).abs() < 1.0e-6));
        for particle in tracker.particles() {
            assert_eq!(scene.posture(&particle.angles_rad).ends, particle.ends_m, "ends are those of the joined pose");
        }
    }
}

/// Twice as many particles are flattened to 1.4 times as many effective ones.
#[test]
fn the_number_of_effective_particles_grows_with_the_root_of_theirs() {
    let (scene, goals) = (scene(), goals());
    let mean_of = |count: usize| {
        let mut tracker = tracker_of(&scene, count, 2, OPTIONS);
        let mut sum = 0.0;
        for frame in 1..6 {
            let cloud = cloud(&scene, frame, &[]);
            let frame = BodyFrame { dt_s: DT_S, blocks: cloud.blocks() };
            sum += tracker.step(&scene, &end_effector(&goals), &frame).effective_sample_size / 5.0;
        }
        sum
    };
    for (count, effective) in [(50, 9.9), (100, 14.0), (200, 19.8)] {
        let mean = mean_of(count);
        assert!((mean / effective - 1.0).abs() < 0.02, "{mean} of {count}");
    }
}

/// The first frame's particles are the same however weights are flattened.
#[test]
fn the_log_evidence_is_that_of_weights_before_tempering() {
    let (scene, goals) = (scene(), goals());
    let cloud = cloud(&scene, 1, &[]);
    let first = |least_effective_share: f32, limb_by_limb: bool| {
        let options = BodyOptions { least_effective_share, limb_by_limb, ..OPTIONS };
        let frame = BodyFrame { dt_s: DT_S, blocks: cloud.blocks() };
        tracker_of(&scene, 60, 4, options).step(&scene, &end_effector(&goals), &frame)
    };
    for limb_by_limb in [false, true] {
        let (plain, tempered) = (first(0.0, limb_by_limb), first(0.5, limb_by_limb));
        assert!(plain.tempering == 1.0 && tempered.tempering < 0.9, "{}", tempered.tempering);
        assert_eq!(plain.log_evidence, tempered.log_evidence, "limb by limb: {limb_by_limb}");
    }
}
