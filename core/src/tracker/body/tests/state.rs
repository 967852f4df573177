//! What is refused at the start, and states saved and restored.

use super::*;

#[test]
fn sets_and_options_that_do_not_fit_are_refused() {
    let scene = scene();
    let first = Particle::at(&scene.skeleton, truth(0));
    let sets = |a: usize, b: usize| (vec![first; a], vec![first; b]);
    assert_eq!(Tracker::new(&first, sets(4, 5), OPTIONS, 1).unwrap_err().parameter, "next");
    assert_eq!(Tracker::new(&first, sets(0, 0), OPTIONS, 1).unwrap_err().parameter, "particles");
    assert_eq!(Tracker::new(&first, sets(257, 257), OPTIONS, 1).unwrap_err().parameter, "particles");
    let options = BodyOptions { least_effective_share: f32::NAN, ..OPTIONS };
    assert_eq!(Tracker::new(&first, sets(4, 4), options, 1).unwrap_err().parameter, "least_effective_share");
    let options = BodyOptions { acceleration_share: -0.1, ..OPTIONS };
    assert_eq!(Tracker::new(&first, sets(4, 4), options, 1).unwrap_err().parameter, "acceleration_share");
}

#[test]
fn a_tracker_goes_on_from_its_saved_state_as_if_nothing_had_been() {
    let (scene, goals) = (scene(), goals());
    let motion = guided(&goals);
    for options in [OPTIONS, BodyOptions { jitter_std_errors: 4.0, jitter_std_m: 0.004, ..LIMB_BY_LIMB }] {
        let mut tracker = tracker_of(&scene, 20, 5, options);
        for frame in 1..=4 {
            tracker.step(&scene, &motion, &BodyFrame { dt_s: DT_S, blocks: cloud(&scene, frame, &[]).blocks() });
        }
        let mut bytes = vec![0; saved_bytes(&mut tracker)];
        save(StateKind::Body, 1, &mut tracker, &mut bytes).unwrap();
        let mut other = tracker_of(&scene, 20, 6, options);
        restore(StateKind::Body, 1, &mut other, &bytes).unwrap();
        for frame in 5..=7 {
            let cloud = cloud(&scene, frame, &[]);
            let seen = BodyFrame { dt_s: DT_S, blocks: cloud.blocks() };
            let whole = tracker.step(&scene, &motion, &seen);
            assert_eq!(other.step(&scene, &motion, &seen), whole, "frame {frame}");
        }
        assert_eq!((other.particles(), other.weights()), (tracker.particles(), tracker.weights()));
        let mut fewer = tracker_of(&scene, 19, 5, options);
        assert_eq!(restore(StateKind::Body, 1, &mut fewer, &bytes), Err(StateError::Illegal));
    }
}
