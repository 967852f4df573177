//! The phase-coupled filter on made-up motion.

use crate::cyclic::model::HumanModelTable;
use crate::cyclic::phase::{position_difference, wrap_position};
use crate::cyclic::synthetic::{mean_angle, table};
use crate::cyclic::{AngleMeasurement, CoupledFilter, CoupledModel};
use crate::math::wrap_angle;
use crate::random::Stream;
use crate::saved_state::{StateKind, restore, save};
use core::f32::consts::TAU;
use std::boxed::Box;
use std::vec::Vec;

const N: usize = 13;

/// The first row without noise.
fn exact(angles_rad: &[Option<f32>; N]) -> AngleMeasurement<N> {
    AngleMeasurement::new(angles_rad, 0.01).unwrap()
}

/// A person who differs from the mean cycle by a constant and a swing.
fn person(index: usize, position: f32) -> f32 {
    let sign = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
    mean_angle(index, position) + 0.1 * sign + 0.06 * (TAU * position).cos()
}

/// Ten cycles at a cadence 8 % above the model's, with noise of 0.1 rad and every seventh frame
/// missing.
#[test]
fn it_follows_another_person_at_another_cadence() {
    let table = table(0.001, 9);
    let model = table.model().unwrap();
    let velocity = 1.08 / 65.0;
    let first = core::array::from_fn(|i| Some(person(i, 0.0)));
    let mut filter = CoupledFilter::<N>::new(&model, &exact(&first), Some(0.0), None).unwrap();
    let mut stream = Stream::new(5, 0, 0);
    let (mut inside, mut all, mut error) = (0, 0, 0.0_f32);
    let frames = 602;
    let mut last = None;
    for frame in 1..=frames {
        let position = velocity * frame as f32;
        let seen = core::array::from_fn(|i| {
            let angle = person(i, position) + 0.1 * stream.normal();
            (frame % 7 != 0).then_some(angle)
        });
        let estimate = filter.step(&model, &AngleMeasurement::new(&seen, 0.1).unwrap());
        for i in 0..N {
            let off = wrap_angle(estimate.angles_rad[i] - person(i, position)).abs();
            inside += i32::from(off <= 1.645 * estimate.angle_variance_rad2[i].sqrt());
            all += 1;
            error += off;
        }
        last = Some(estimate);
    }
    let estimate = last.unwrap();
    let phase = velocity * frames as f32 - (filter.cycles() as f32 + estimate.cycle_position);
    assert!(phase.abs() < 0.05, "phase is off by {phase} cycles");
    assert_eq!(filter.cycles(), 10 - i32::from(estimate.cycle_position > 0.5));
    assert!((estimate.cycle_velocity_per_frame / velocity - 1.0).abs() < 0.02);
    assert!((9..=10).contains(&estimate.turns[12]), "angle 12 winds once a cycle: {}", estimate.turns[12]);
    let mean_error = error / all as f32;
    assert!(mean_error < 0.035, "a third of the noise, not {mean_error}");
    let share = inside as f32 / all as f32;
    assert!((0.85..=0.99).contains(&share), "{share} of the truth lies in the 90 % band");
}

/// Angles of a table are unwrapped and may begin many turns away from zero. The count continues
/// from there without a jump, in both directions.
#[test]
fn turns_are_counted_from_those_of_the_first_row() {
    let table = table(0.001, 9);
    let model = table.model().unwrap();
    for direction in [1.0_f32, -1.0] {
        let truth = |i: usize, frame: u16| person(i, direction * f32::from(frame) / 65.0) + TAU * (i as f32 - 5.0);
        let first = core::array::from_fn(|i| Some(truth(i, 0)));
        let mut filter = CoupledFilter::<N>::new(&model, &exact(&first), Some(0.0), Some(direction / 65.0)).unwrap();
        for frame in 1..=400 {
            let seen = core::array::from_fn(|i| Some(truth(i, frame)));
            let estimate = filter.step(&model, &AngleMeasurement::new(&seen, 0.1).unwrap());
            for i in 0..N {
                let unwrapped = estimate.angles_rad[i] + TAU * estimate.turns[i] as f32;
                assert!((unwrapped - truth(i, frame)).abs() < 0.3, "angle {i} in frame {frame}: {unwrapped}");
            }
        }
    }
}

/// Gaps of random length: blocks stay symmetric with variances above zero, and every number finite.
#[test]
fn numbers_stay_finite_and_variances_positive_through_random_gaps() {
    let table = table(0.001, 9);
    let model = table.model().unwrap();
    let first = core::array::from_fn(|i| Some(person(i, 0.0)));
    let mut filter = CoupledFilter::<N>::new(&model, &exact(&first), None, None).unwrap();
    let mut stream = Stream::new(9, 0, 0);
    let mut time = 0.0;
    for _ in 0..20_000 {
        let gap = stream.normal().abs() > 2.5;
        let step = if gap { 1.0 + 40.0 * stream.normal().abs() } else { 1.0 };
        time += step / 65.0;
        time -= time.floor();
        let seen = core::array::from_fn(|i| (stream.normal() > -0.5).then_some(person(i, time)));
        let estimate = filter.step(&model, &AngleMeasurement::new(&seen, 0.05).unwrap().after(step).unwrap());
        assert!(estimate.angles_rad.iter().all(|angle| angle.is_finite()));
        assert!(estimate.angle_variance_rad2.iter().all(|variance| variance.is_finite() && *variance > 0.0));
        assert!((0.0..1.0).contains(&estimate.cycle_position) && estimate.cycle_velocity_variance > 0.0);
    }
}

/// After a gap in which the phase is lost, the position is found again.
#[test]
fn a_lost_phase_is_found_again() {
    let table = table(0.001, 9);
    let model = table.model().unwrap();
    let first = core::array::from_fn(|i| Some(person(i, 0.0)));
    let mut filter = CoupledFilter::<N>::new(&model, &exact(&first), Some(0.0), None).unwrap();
    filter.predict(&model, 600.0);
    let mut last = 0.0;
    for frame in 0..65 {
        let position = 0.37 + frame as f32 / 65.0;
        let seen = core::array::from_fn(|i| Some(person(i, position)));
        last = position_difference(
            filter.step(&model, &AngleMeasurement::new(&seen, 0.05).unwrap()).cycle_position,
            wrap_position(position),
        );
    }
    assert!(last.abs() < 0.05, "off by {last} cycles");
}

/// Way from the person's position to the filter's after each of `positions` was shown with noise of
/// 0.1 rad.
fn ways(filter: &mut CoupledFilter<N>, model: &CoupledModel<'_>, seed: u64, positions: &[f32]) -> Vec<f32> {
    let mut stream = Stream::new(seed, 0, 0);
    let mut way = |&position: &f32| {
        let seen = core::array::from_fn(|i| Some(person(i, position) + 0.1 * stream.normal()));
        let estimate = filter.step(model, &AngleMeasurement::new(&seen, 0.1).unwrap());
        position_difference(estimate.cycle_position, wrap_position(position))
    };
    positions.iter().map(&mut way).collect()
}

/// Positions of a person whose speed, in parts of the model's, is `ratio(frame)`.
fn walked(frames: u16, ratio: impl Fn(u16) -> f32) -> Vec<f32> {
    let mut position = 0.0;
    (1..=frames)
        .map(|frame| {
            position += ratio(frame) / 65.0;
            position
        })
        .collect()
}

#[test]
fn it_follows_a_person_who_speeds_up_slows_down_or_stops_and_goes_on() {
    let table = table(0.001, 9);
    let model = table.model().unwrap();
    let first = core::array::from_fn(|i| Some(person(i, 0.0)));
    for (name, ratio) in [("speeds up", 1.5), ("slows down", 0.6), ("stops", 0.0)] {
        for seed in 1..=5 {
            let mut filter = CoupledFilter::<N>::new(&model, &exact(&first), Some(0.0), None).unwrap();
            let positions = walked(400, |frame| if (131..261).contains(&frame) { ratio } else { 1.0 });
            let ways = ways(&mut filter, &model, seed, &positions);
            // Two cycles later at the most the filter is with the person again, and stays there.
            let settled = |range: core::ops::Range<usize>| ways[range].iter().all(|way| way.abs() < 0.12);
            assert!(settled(60..131), "{name}, seed {seed}: steady before");
            assert!(settled(380..400), "{name}, seed {seed}: {:?}", &ways[380..]);
        }
    }
}

/// The motion of [`table`] in which the angle that winds moves as the first one.
fn swinging() -> Box<HumanModelTable> {
    let mut swinging = table(0.001, 9);
    swinging.turns_per_cycle[12] = 0;
    swinging.mean_pose_rad.iter_mut().for_each(|pose| pose[12] = pose[0]);
    swinging
}

/// Runs of 40 in which the second speed leads after a cycle, of a person so many times as fast as
/// the mean. The noise is stated as half a radian, and is a part of that.
fn led_by_the_second_speed_of_40(model: &CoupledModel<'_>, times: f32, part: f32) -> usize {
    let angle = |i: usize, position| if i == 12 { person(0, position) } else { person(i, position) };
    let is_led = |seed: &u64| {
        let mut stream = Stream::new(*seed, 0, 0);
        let mut seen = |position: f32| {
            let angles = core::array::from_fn(|i| Some(angle(i, position) + 0.5 * part * stream.normal()));
            AngleMeasurement::new(&angles, 0.5).unwrap()
        };
        let mut filter = CoupledFilter::<N>::new(model, &seen(0.0), Some(0.0), None).unwrap();
        for position in walked(65, |_| times) {
            filter.step(model, &seen(position));
        }
        filter.leader.number == 1
    };
    (0..40).filter(is_led).count()
}

/// Both speeds are judged by the same noise: else a stated noise that is too large would speak for
/// the second one.
#[test]
fn the_second_speed_leads_people_who_are_far_faster_and_no_others() {
    let table = swinging();
    let model = table.model().unwrap();
    for part in [1.0, 0.3, 0.01] {
        for times in [0.7, 1.0, 1.15] {
            let led = led_by_the_second_speed_of_40(&model, times, part);
            assert_eq!(led, 0, "{times} times as fast, {part} of the stated noise");
        }
        let led = led_by_the_second_speed_of_40(&model, 1.6, part);
        assert!(led >= 36, "{led} of 40 at 1.6 times the speed, {part} of the stated noise");
    }
}

/// The second speed is no rival of the grid's: it ends after a cycle, and circles have none.
#[test]
fn the_second_speed_of_a_start_lasts_one_cycle() {
    for (table, lasts) in [(swinging(), true), (table(0.001, 9), false)] {
        let model = table.model().unwrap();
        let angles =
            |frame: u16| core::array::from_fn(|i| Some(table.mean_pose_rad[usize::from(frame) * 100 / 65 % 100][i]));
        let mut filter = CoupledFilter::<N>::new(&model, &exact(&angles(0)), Some(0.0), None).unwrap();
        for frame in 1..=70 {
            // By the sum of steps the 65th frame may be the first or the last one.
            if frame != 66 {
                assert_eq!(filter.rival.exists(), lasts && frame < 66, "frame {frame}");
            }
            filter.step(&model, &AngleMeasurement::new(&angles(frame), 2.0).unwrap());
        }
    }
}

/// Angle of a motion there and back, as of squats: its ways differ by a lag of some angles.
fn there_and_back(index: usize, position: f32) -> f32 {
    (0.2 + 0.05 * index as f32) * (TAU * (position + 0.004 * (index % 4) as f32)).cos()
}

/// At a deviation that follows each frame, a filter that stands would explain any motion.
#[test]
fn a_motion_there_and_back_is_found_again_after_a_stop_half_way() {
    let mut table = swinging();
    for (l, pose) in table.mean_pose_rad.iter_mut().enumerate() {
        *pose = core::array::from_fn(|i| there_and_back(i, l as f32 / 100.0));
    }
    (table.rest_std_rad, table.rest_rate_per_cycle) = ([0.2; N], [60.0; N]);
    let model = table.model().unwrap();
    let mut found = 0;
    for seed in 1..=12_u16 {
        let angle =
            |i: usize, position| there_and_back(i, position) + 0.1 * if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let first = core::array::from_fn(|i| Some(angle(i, 0.0)));
        let mut filter = CoupledFilter::<N>::new(&model, &exact(&first), Some(0.0), None).unwrap();
        let mut stream = Stream::new(u64::from(seed), 0, 0);
        let mut way = 0.0;
        let stop = 200 + 5 * seed..330 + 5 * seed;
        for position in walked(700, |frame| if stop.contains(&frame) { 0.0 } else { 1.0 }) {
            let seen = core::array::from_fn(|i| Some(angle(i, position) + 0.1 * stream.normal()));
            let estimate = filter.step(&model, &AngleMeasurement::new(&seen, 0.1).unwrap());
            way = position_difference(estimate.cycle_position, wrap_position(position));
        }
        found += i32::from(way.abs() < 0.1);
    }
    assert!(found >= 11, "{found} of 12");
}

/// Share of the 90 % bands that hold `person`, with true noise of 0.1 rad and stated noise of
/// `stated` rad.
fn inside_the_band(model: &CoupledModel<'_>, person: impl Fn(usize, f32) -> f32, stated: f32) -> f64 {
    let first = core::array::from_fn(|i| Some(person(i, 0.0)));
    let mut filter = CoupledFilter::<N>::new(model, &exact(&first), Some(0.0), None).unwrap();
    let mut stream = Stream::new(7, 0, 0);
    let (mut inside, mut all) = (0_u32, 0_u32);
    for (frame, position) in walked(600, |_| 1.0).into_iter().enumerate() {
        let seen = core::array::from_fn(|i| Some(person(i, position) + 0.1 * stream.normal()));
        let estimate = filter.step(model, &AngleMeasurement::new(&seen, stated).unwrap());
        for i in (0..N).filter(|_| frame > 200) {
            let off = wrap_angle(estimate.angles_rad[i] - person(i, position)).abs();
            inside += u32::from(off <= 1.645 * estimate.angle_variance_rad2[i].sqrt());
            all += 1;
        }
    }
    f64::from(inside) / f64::from(all)
}

/// The stated noise is half of the true one, and the bands hold. A winding motion assumes a larger
/// spread of the cycle's shape, so its bands are wider.
#[test]
fn the_bands_hold_where_the_noise_is_larger_than_stated() {
    let (winding, swinging) = (table(0.001, 9), swinging());
    for stated in [0.05, 0.1] {
        let share = inside_the_band(&winding.model().unwrap(), person, stated);
        assert!((0.8..0.99).contains(&share), "stated {stated} rad: {share} inside the 90 % band, winding");
        let share = inside_the_band(&swinging.model().unwrap(), |i, position| person(i % 12, position), stated);
        assert!((0.8..0.98).contains(&share), "stated {stated} rad: {share} inside the 90 % band");
    }
}

#[test]
fn a_person_who_walks_backwards_is_followed_backwards() {
    let table = table(0.001, 9);
    let model = table.model().unwrap();
    let first = core::array::from_fn(|i| Some(person(i, 0.0)));
    for seed in 1..=5 {
        let velocity = Some(-1.0 / 65.0);
        let mut filter = CoupledFilter::<N>::new(&model, &exact(&first), Some(0.0), velocity).unwrap();
        let ways = ways(&mut filter, &model, seed, &walked(400, |_| -1.0));
        assert!(ways.iter().all(|way| way.abs() < 0.1), "seed {seed}");
        assert!((-7..=-5).contains(&filter.cycles()), "seed {seed}: {} cycles", filter.cycles());
    }
}

#[test]
fn a_steady_motion_is_never_relocked() {
    let table = table(0.001, 9);
    let model = table.model().unwrap();
    let first = core::array::from_fn(|i| Some(person(i, 0.0)));
    let mut filter = CoupledFilter::<N>::new(&model, &exact(&first), Some(0.0), None).unwrap();
    ways(&mut filter, &model, 3, &walked(3000, |_| 1.08));
    assert_eq!(filter.leader.number, 0);
}

#[test]
fn from_anywhere_the_position_is_found_and_the_bands_hold_meanwhile() {
    let table = table(0.001, 9);
    let model = table.model().unwrap();
    let (mut inside, mut all) = (0_u32, 0_u32);
    for start in 0..10_u8 {
        let begin = f32::from(start) / 10.0;
        let mut stream = Stream::new(u64::from(start), 1, 0);
        let mut seen = |frame: u16| {
            let position = begin + f32::from(frame) / 65.0;
            let noisy = core::array::from_fn(|i| Some(person(i, position) + 0.5 * stream.normal()));
            (position, AngleMeasurement::new(&noisy, 0.5).unwrap())
        };
        let mut filter = CoupledFilter::<N>::anywhere(&model, &seen(0).1).unwrap();
        let mut way = 1.0;
        for frame in 1..=130 {
            let (position, measurement) = seen(frame);
            let estimate = filter.step(&model, &measurement);
            way = position_difference(estimate.cycle_position, wrap_position(position));
            if filter.is_searching() {
                for i in 0..N {
                    let off = wrap_angle(estimate.angles_rad[i] - person(i, position)).abs();
                    inside += u32::from(off <= 1.645 * estimate.angle_variance_rad2[i].sqrt());
                    all += 1;
                }
            }
        }
        assert!(!filter.is_searching() && way.abs() < 0.1, "start {begin}: {way} off");
    }
    let share = f64::from(inside) / f64::from(all);
    assert!(all > 13 && (0.8..=1.0).contains(&share), "{share} of {all} inside the band while searching");
}

/// A gap costs a few substeps, and the prediction is nearly that of one substep a frame.
#[test]
fn a_gap_in_few_parts_is_the_gap_frame_by_frame() {
    let table = table(0.001, 9);
    let model = table.model().unwrap();
    let first = core::array::from_fn(|i| Some(person(i, 0.1)));
    let mut filter = CoupledFilter::<N>::new(&model, &exact(&first), Some(0.1), None).unwrap();
    for frame in 1..=130 {
        let seen = core::array::from_fn(|i| Some(person(i, 0.1 + frame as f32 / 65.0)));
        filter.step(&model, &AngleMeasurement::new(&seen, 0.1).unwrap());
    }
    for gap in [9_u16, 20, 60, 200] {
        let (mut few, mut many) = (filter, filter);
        few.predict(&model, f32::from(gap));
        for _ in 0..gap {
            many.predict(&model, 1.0);
        }
        let (a, b) = (few.cycle(), many.cycle());
        assert!(position_difference(a.position, b.position).abs() < 1.0e-3, "{gap}: {a:?} {b:?}");
        let stds = [(a.position_variance, b.position_variance), (a.velocity_variance, b.velocity_variance)];
        for (x, y) in stds {
            assert!(((x / y).sqrt() - 1.0).abs() < 0.03, "{gap}: {a:?} {b:?}");
        }
        let (pose_a, pose_b) = (
            few.current_estimate(&model, &AngleMeasurement::nothing()),
            many.current_estimate(&model, &AngleMeasurement::nothing()),
        );
        for i in 0..N {
            let std = pose_b.angle_variance_rad2[i].sqrt();
            assert!(wrap_angle(pose_a.angles_rad[i] - pose_b.angles_rad[i]).abs() < 0.05 * std, "{gap}: angle {i}");
            let ratio = pose_a.angle_variance_rad2[i].sqrt() / std;
            assert!((ratio - 1.0).abs() < 0.05, "{gap}: angle {i}: {ratio}");
        }
    }
}

/// While the phase is unknown, a precise measurement of an uncertain angle leaves no variance below
/// zero.
#[test]
fn a_search_with_little_noise_reports_no_negative_variance() {
    let table = table(0.001, 9);
    let model = table.model().unwrap();
    let mut stream = Stream::new(8, 0, 0);
    for _ in 0..200 {
        let mut seen = || {
            let seen = core::array::from_fn(|i| Some(mean_angle(i, 0.0) + stream.normal()));
            AngleMeasurement::new(&seen, 1.0e-4).unwrap()
        };
        let mut filter = CoupledFilter::<N>::anywhere(&model, &seen()).unwrap();
        for _ in 0..20 {
            let estimate = filter.step(&model, &seen());
            let variances = estimate.angle_variance_rad2;
            assert!(variances.iter().all(|variance| *variance >= 0.0), "{variances:?}");
        }
    }
}

/// A filter that begins half a cycle from the person's place.
fn started_half_a_cycle_off(model: &CoupledModel<'_>) -> CoupledFilter<N> {
    let first = core::array::from_fn(|i| Some(person(i, 0.0)));
    CoupledFilter::<N>::new(model, &AngleMeasurement::new(&first, 0.1).unwrap(), Some(0.5), None).unwrap()
}

#[test]
fn a_rival_at_the_right_place_leads_within_half_a_cycle() {
    let table = swinging();
    let model = table.model().unwrap();
    for seed in 1..=5 {
        let mut filter = started_half_a_cycle_off(&model);
        let mut stream = Stream::new(seed, 0, 0);
        for (frame, position) in walked(65, |_| 1.0).into_iter().enumerate() {
            let seen = core::array::from_fn(|i| Some(person(i % 12, position) + 0.1 * stream.normal()));
            let estimate = filter.step(&model, &AngleMeasurement::new(&seen, 0.1).unwrap());
            let way = position_difference(estimate.cycle_position, wrap_position(position));
            assert!(frame < 33 || way.abs() < 0.08, "seed {seed}, frame {frame}: {way} off");
        }
        assert!(filter.leader.number > 0 && !filter.rival.exists(), "seed {seed}");
    }
}

/// Going back from where the rival won, its states are those of one hypothesis, to its first frame.
#[test]
fn a_winning_rival_is_followed_back_to_where_it_began() {
    let table = swinging();
    let model = table.model().unwrap();
    let mut followed = 0;
    for seed in 1..=5 {
        let mut filter = started_half_a_cycle_off(&model);
        let mut stream = Stream::new(seed, 0, 0);
        let mut states = vec![(filter, 0.0)];
        for position in walked(130, |_| 1.0) {
            let seen = core::array::from_fn(|i| Some(person(i % 12, position) + 0.7 * stream.normal()));
            filter.step(&model, &AngleMeasurement::new(&seen, 0.7).unwrap());
            states.push((filter, wrap_position(position)));
        }
        let won = states.iter().position(|(state, _)| state.leader.number > 0).unwrap();
        let mut later = states[won].0;
        for (state, position) in states[..won].iter().rev() {
            let Some(led) = state.led_as_in(&later) else { break };
            let way = position_difference(led.leader.position, *position);
            assert!(way.abs() < 0.25 && led.leader.number == later.leader.number, "seed {seed}: {way} off");
            (later, followed) = (led, followed + 1);
        }
        assert!(states[0].0.led_as_in(&later).is_none(), "seed {seed}: it began after the first frame");
    }
    assert!(followed > 2, "followed over {followed} frames");
}

#[test]
fn where_an_angle_winds_there_is_no_rival_and_the_leader_moves_to_the_grids_place() {
    let table = table(0.001, 9);
    let model = table.model().unwrap();
    let mut filter = started_half_a_cycle_off(&model);
    let ways = ways(&mut filter, &model, 1, &walked(130, |_| 1.0));
    assert!(!filter.rival.exists() && filter.leader.number > 0);
    assert!(ways[100..].iter().all(|way| way.abs() < 0.2), "{:?}", &ways[100..]);
}

#[test]
fn a_filter_with_a_rival_is_restored_as_it_was_saved() {
    let table = swinging();
    let model = table.model().unwrap();
    let mut filter = started_half_a_cycle_off(&model);
    let (mut other, mut stream, mut bytes) = (filter, Stream::new(1, 0, 0), [0; 8192]);
    let mut rivals = 0;
    for (frame, position) in walked(130, |_| 1.0).into_iter().enumerate() {
        let seen = core::array::from_fn(|i| Some(person(i % 12, position) + 0.5 * stream.normal()));
        filter.step(&model, &AngleMeasurement::new(&seen, 0.5).unwrap());
        rivals += i32::from(filter.rival.exists());
        let count = save(StateKind::Cyclic, 1, &mut filter, &mut bytes).unwrap();
        restore(StateKind::Cyclic, 1, &mut other, &bytes[..count]).unwrap();
        assert_eq!(other, filter, "frame {frame}");
    }
    assert!(rivals > 0);
}
