//! Hostile options: refused by name, or of a tracker that stays finite.

use crate::corners::Corners;
use crate::cyclic::{STD_RAD, seen, sound};
use sinew_core::camera::{Camera, Pixel};
use sinew_core::cyclic::example::swing_table;
use sinew_core::cyclic::filter::{CyclicFilter, FilterChoice};
use sinew_core::cyclic::{AngleMeasurement, FigurePlace, KalmanOptions, PlaceOptions};
use sinew_core::saved_state::SavedState;
use sinew_core::skeleton::{ArmGeometry, Side};
use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob};
use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmModel, ArmOptions, ArmTracker, Variant};

const DRAWS: usize = 400;
const FRAMES: u8 = 20;

/// Options of which a few are hostile.
fn arm_options(corners: &mut Corners) -> ArmOptions {
    let mut options = ArmOptions { variant: Variant::ALL[corners.below(5)], particles: 20, ..ArmOptions::default() };
    let (mut gate, mut cue, mut memory) =
        (options.gate.unwrap(), options.area_cue.unwrap(), options.blob_memory.unwrap());
    let [angle, ..] = &mut options.angle_std_rad_per_sqrt_s;
    let numbers = [
        &mut options.product_floor,
        &mut gate.std_m,
        &mut gate.growth_m_per_s,
        &mut gate.floor,
        &mut gate.missed_share,
        &mut gate.allotment_reach,
        &mut cue.hand_area_m2,
        &mut cue.length_share,
        &mut cue.foreshortening,
        &mut cue.log_std,
        &mut memory.fall_time_s,
        &mut memory.rise_time_s,
        &mut memory.floor,
        &mut memory.rest_share,
        &mut memory.rest_time_s,
        &mut memory.moved_per_radius,
        &mut options.cluster_radius_per_focal,
        &mut options.velocity_persistence,
        &mut options.velocity_gain,
        &mut options.hand_std_m_per_sqrt_s,
        &mut options.elbow_std_m_per_sqrt_s,
        &mut options.ray_std_m_per_sqrt_s,
        &mut options.ray_std_per_path,
        &mut options.centre_std_per_focal,
        &mut options.reach_std_m,
        &mut options.reach_across_std_m,
        angle,
        &mut options.limb_band_m,
        &mut options.orientation_memory_s,
        &mut options.teleport_share,
        &mut options.clutter_share,
        &mut options.lost_after_s,
        &mut options.sure_likelihood,
        &mut options.sure_share,
    ];
    for number in numbers {
        if corners.one_in(20) {
            *number = corners.corner();
        }
    }
    (options.gate, options.area_cue, options.blob_memory) = (Some(gate), Some(cue), Some(memory));
    options.depth_from_area = corners.one_in(2);
    options
}

fn arm_model(corners: &mut Corners) -> Option<ArmModel> {
    let mut rarely = |clean: f32| if corners.one_in(20) { corners.corner() } else { clean };
    let camera = Camera::new(rarely(550.0), rarely(550.0), Pixel::new(rarely(320.0), rarely(240.0))).ok()?;
    let geometry = ArmGeometry::new(Side::Left, rarely(0.3), rarely(0.35)).ok()?;
    ArmModel::new(camera, (640, 480), geometry, arm_options(corners)).ok()
}

#[test]
fn an_arm_with_hostile_options_is_refused_or_stays_finite() {
    let mut corners = Corners::new(3, false);
    let mut accepted = 0;
    for _ in 0..DRAWS {
        let Some(model) = arm_model(&mut corners) else { continue };
        accepted += 1;
        let mut tracker = ArmTracker::<20>::new(&model, SHOULDERS_M[0], 1).unwrap();
        for frame in 0..FRAMES {
            let blobs = [hand_blob()];
            let image = (frame % 5 != 4).then_some(ArmImage { candidates: &blobs, edges: &[] });
            let timestamp_us = 66_667 * u64::from(frame);
            let estimate = tracker.step(&model, &ArmFrame { timestamp_us, image, shoulder_m: SHOULDERS_M[0] });
            let is_finite = tracker.is_finite() && estimate.hand_std_m >= 0.0 && estimate.log_evidence.is_finite();
            assert!(is_finite, "{estimate:?} by {model:?}");
        }
    }
    assert!((DRAWS / 20..DRAWS).contains(&accepted), "{accepted} accepted");
}

#[test]
fn a_cyclic_filter_with_hostile_options_is_refused_or_stays_finite() {
    let (table, mut corners) = (swing_table(), Corners::new(4, false));
    let (model, mut accepted) = (table.model().unwrap(), 0);
    for _ in 0..4 * DRAWS {
        let clean = KalmanOptions::default();
        let options = KalmanOptions {
            temporal_acceleration_std: corners.number(clean.temporal_acceleration_std),
            angle_variance: corners.number(clean.angle_variance),
            velocity_variance: corners.number(clean.velocity_variance),
            cycle_position_variance: corners.number(clean.cycle_position_variance),
            cycle_velocity_variance: corners.number(clean.cycle_velocity_variance),
            gate_sigmas: corners.number(clean.gate_sigmas),
            protect_from_outliers: corners.one_in(2),
            ..clean
        };
        let choice = if corners.one_in(2) { FilterChoice::Coupled } else { FilterChoice::Kalman(options) };
        let (position, velocity) = (Some(corners.number(0.0)), Some(corners.number(1.0 / 60.0)));
        let Ok(mut filter) = CyclicFilter::new(&model, &choice, &seen(0.0), position, velocity) else { continue };
        accepted += 1;
        for frame in 0..FRAMES {
            let estimate = filter.step(&model, &choice, &seen(f32::from(frame)));
            sound(&estimate).unwrap_or_else(|message| panic!("{message} by {choice:?}"));
            assert!(filter.is_finite(), "{choice:?}, {position:?}, {velocity:?}");
        }
    }
    assert!((DRAWS / 20..4 * DRAWS).contains(&accepted), "{accepted} accepted");
}

#[test]
fn a_place_with_hostile_options_is_refused_or_stays_finite() {
    let mut corners = Corners::new(5, false);
    let clean = PlaceOptions::of_person(100.0, 0.005, STD_RAD, 60.0).unwrap();
    for _ in 0..4 * DRAWS {
        let options = PlaceOptions {
            keypoint_std_px: corners.number(clean.keypoint_std_px),
            root_acceleration_px: corners.number(clean.root_acceleration_px),
            length_walk: corners.number(clean.length_walk),
            lost_std_px: corners.number(clean.lost_std_px),
        };
        let Ok(mut place) = FigurePlace::<1>::new(options) else { continue };
        for frame in 0..FRAMES {
            let seen_px = (frame % 5 != 4).then_some([300.0, 200.0]);
            place.step(if frame == 9 { 600.0 } else { 1.0 }, seen_px, &[Some(80.0)]);
            assert!(place.is_finite(), "{place:?}");
        }
    }
}

#[test]
fn a_wrong_noise_is_refused_by_its_name_and_rule() {
    for std_rad in [0.0, -1.0, 1.0e-9, 1.0e30, f32::NAN] {
        let refused = AngleMeasurement::new(&[Some(0.1)], std_rad).unwrap_err();
        assert_eq!(refused.parameter, "std_rad");
    }
    let refused = AngleMeasurement::new(&[Some(0.1)], 1.0e30).unwrap_err().to_string();
    assert_eq!(refused, "`std_rad` must lie from 0.0001 to 1000");
}
