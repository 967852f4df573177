//! A synthetic person with their own cycle, whose recording is finished.

use super::{Seen, Shape, finish, noise};
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::tracking::{Tracked, TrackingOptions, Updates, track};
use crate::cyclic::turns::least_angle;
use crate::cyclic::{AngleRow, AngleTable, CyclicModel, SyntheticPerson};
use proptest::prelude::*;
use sinew_core::random::Stream;
use std::f64::consts::TAU;
use std::ops::Range;

/// A person at 30 frames a second, and `cycles` of theirs with noise of a degree.
fn recorded(model: &CyclicModel, cycles: u32, seed: u64) -> (SyntheticPerson<'_>, AngleTable) {
    let person = SyntheticPerson::draw(model, 30.0, seed).unwrap();
    let table = person.measured(cycles, 1.0_f64.to_radians(), 0.0, seed).unwrap();
    (person, table)
}

fn finished(model: &CyclicModel, table: &AngleTable) -> Tracked {
    let options =
        TrackingOptions { rate_hz: Some(30.0), sigma_rad: 1.0_f64.to_radians(), ..TrackingOptions::default() };
    finish(table, model, track(table, model, &options).unwrap(), &options, None).unwrap()
}

/// The table with `change` made to each row.
fn with(table: &AngleTable, change: impl Fn(&mut AngleRow)) -> AngleTable {
    let mut rows = table.rows().to_vec();
    rows.iter_mut().for_each(change);
    AngleTable::new(rows, Vec::new()).unwrap()
}

/// A mean cycle does not close to the last degree: there harmonics go between both ends.
#[test]
fn the_models_shape_is_its_mean_cycle() {
    let model = CyclicModel::from_option("walking").unwrap();
    let shape = Shape::<ANGLES>::of_model(&model);
    let mut offs_deg = Vec::new();
    for percent in 0..100 {
        let phase = f64::from(percent) / 100.0;
        let pose = model.view().mean_pose_rad::<ANGLES>(model.view().point(phase as f32));
        let off = |(found, wanted): (&f64, f32)| least_angle(found - f64::from(wanted)).abs().to_degrees();
        offs_deg.extend(shape.at(phase).0.iter().zip(pose).map(off));
    }
    let mean = offs_deg.iter().sum::<f64>() / offs_deg.len() as f64;
    let worst = offs_deg.into_iter().fold(0.0, f64::max);
    assert!(mean < 0.2 && worst < 2.0, "{mean} degrees on the mean, {worst} at worst");
}

#[test]
fn phases_and_angles_are_those_of_the_person() {
    let model = CyclicModel::from_option("walking").unwrap();
    for seed in 1..4 {
        let (person, table) = recorded(&model, 6, seed);
        let run = finished(&model, &table);
        let frames = &run.frames;
        let per_frame = frames[frames.len() - 1].cycles / (frames.len() - 1) as f64;
        assert!((per_frame * person.cycle_frames() - 1.0).abs() < 0.01, "seed {seed}: {per_frame}");
        let squares = frames.iter().map(|frame| {
            let truth = person.pose_rad(frame.frame as f64);
            least_angle(frame.angles_rad[9] - truth[9]).powi(2)
        });
        let rms = (squares.sum::<f64>() / frames.len() as f64).sqrt().to_degrees();
        assert!((0.2..1.0).contains(&rms), "seed {seed}: shank {rms} degrees off at one of noise");
    }
}

/// Share of the angles at these places (frame, angle) that lie inside their 90 % band.
fn inside_90(run: &Tracked, person: &SyntheticPerson<'_>, is_looked_at: impl Fn(u64, usize) -> bool) -> f64 {
    let (mut inside, mut count) = (0, 0);
    for frame in &run.frames {
        let truth = person.pose_rad(frame.frame as f64);
        for angle in (0..ANGLES).filter(|angle| is_looked_at(frame.frame, *angle)) {
            let std_rad = f64::from(frame.estimate.angle_variance_rad2[angle]).sqrt();
            inside += usize::from(least_angle(frame.angles_rad[angle] - truth[angle]).abs() < 1.645 * std_rad);
            count += 1;
        }
    }
    f64::from(inside as u32) / f64::from(count)
}

/// Smoothing leaves a part of the noise, and the band says how much.
#[test]
fn nine_of_ten_angles_are_inside_their_band() {
    let model = CyclicModel::from_option("walking").unwrap();
    for seed in 1..4 {
        let (person, table) = recorded(&model, 6, seed);
        let share = inside_90(&finished(&model, &table), &person, |_, _| true);
        assert!((0.85..0.95).contains(&share), "seed {seed}: {share}");
    }
}

/// A band of twice the noise that the recording shows, which is one degree, is twice as wide.
#[test]
fn a_given_noise_makes_the_bands() {
    let model = CyclicModel::from_option("walking").unwrap();
    let (_, table) = recorded(&model, 6, 1);
    let options = TrackingOptions { rate_hz: Some(30.0), ..TrackingOptions::default() };
    let stds_rad = |noise_rad: Option<f64>| -> Vec<f64> {
        let filtered = track(&table, &model, &options).unwrap();
        let run = finish(&table, &model, filtered, &options, noise_rad).unwrap();
        run.frames.iter().map(|row| f64::from(row.estimate.angle_variance_rad2[9]).sqrt()).collect()
    };
    let found = stds_rad(None);
    let times: Vec<f64> = stds_rad(Some(2.0_f64.to_radians())).iter().zip(&found).map(|(a, b)| a / b).collect();
    assert!((1.6..2.5).contains(&times[0]), "{}", times[0]);
    // All but outliers, which are gaps.
    let alike = times.iter().filter(|other| (*other / times[0] - 1.0).abs() < 1.0e-5).count();
    assert!(20 * alike >= 19 * times.len(), "{times:?}");
}

/// Three quarters of the angles are missing, one by one: few determine the person's cycle.
#[test]
fn bands_know_how_little_the_cycle_was_fitted_to() {
    let model = CyclicModel::from_option("walking").unwrap();
    let is_missing = |frame: u64, angle: usize| Stream::new(frame, 0, angle as u32).uniform() < 0.75;
    let mut shares = Vec::new();
    for seed in 1..4 {
        let (person, table) = recorded(&model, 6, seed);
        let sparse = with(&table, |row| {
            let frame = row.frame;
            (0..ANGLES).filter(|angle| is_missing(frame, *angle)).for_each(|angle| row.angles_rad[angle] = None);
        });
        shares.push(inside_90(&finished(&model, &sparse), &person, is_missing));
    }
    assert!(shares.iter().all(|share| (0.8..0.98).contains(share)), "{shares:?}");
}

/// In a table of twice as many rows, each between two measured ones.
#[test]
fn noise_is_found_between_interpolated_rows() {
    let model = CyclicModel::from_option("walking").unwrap();
    let (_, table) = recorded(&model, 6, 1);
    let rows = table.rows();
    let between = |frame: usize, angle: usize| {
        let [before, after] = [frame / 2, frame.div_ceil(2)].map(|row| rows[row].angles_rad[angle].unwrap());
        Some(before + 0.5 * least_angle(after - before) * (frame % 2) as f64)
    };
    let twice: Vec<[Option<f64>; ANGLES]> =
        (0..2 * rows.len() - 1).map(|frame| std::array::from_fn(|angle| between(frame, angle))).collect();
    let twice = AngleTable::from_angles(0, &twice).unwrap();
    let seen = Seen::<ANGLES>::of_table(&twice, &Updates::All).unwrap();
    let found_deg =
        |stride| (0..ANGLES).filter_map(|angle| noise::of_angle(&seen, angle, stride)).sum::<f64>().to_degrees();
    let [neighbours_deg, thirtieths_deg] =
        [1, noise::thirtieth_frames(60.0)].map(|stride| found_deg(stride) / ANGLES as f64);
    assert!(neighbours_deg < 0.5, "{neighbours_deg} between neighbours");
    assert!((0.5..1.1).contains(&thirtieths_deg), "{thirtieths_deg} instead of 1");
}

/// At a steady cadence what a row's differs by is its error.
#[test]
fn a_rows_cadence_has_its_own_standard_deviation() {
    let model = CyclicModel::from_option("walking").unwrap();
    let (mut squares, mut count) = (0.0, 0.0);
    for seed in 1..9 {
        let (person, table) = recorded(&model, 8, seed);
        let run = finished(&model, &table);
        for frame in &run.frames {
            let velocity = f64::from(frame.estimate.cycle_velocity_per_frame) * run.step_frames;
            let std = f64::from(frame.estimate.cycle_velocity_variance).sqrt() * run.step_frames;
            squares += ((velocity - 1.0 / person.cycle_frames()) / std).powi(2);
            count += 1.0;
        }
    }
    let over_stated = f64::sqrt(squares / count);
    assert!((0.7..1.4).contains(&over_stated), "{over_stated}");
}

/// Largest error of an angle in these frames, degrees.
fn worst_deg(run: &Tracked, person: &SyntheticPerson<'_>, angle: usize, frames: Range<u64>) -> f64 {
    let off_deg = |frame: u64| {
        let truth = person.pose_rad(frame as f64)[angle];
        least_angle(run.frames[frame as usize].angles_rad[angle] - truth).abs().to_degrees()
    };
    frames.map(off_deg).fold(0.0, f64::max)
}

#[test]
fn a_gap_has_the_persons_own_knee() {
    let model = CyclicModel::from_option("walking").unwrap();
    let (person, table) = recorded(&model, 7, 2);
    let gap = 90..110;
    let run = finished(
        &model,
        &with(&table, |row| {
            if gap.contains(&row.frame) {
                row.angles_rad[9] = None;
            }
        }),
    );
    let worst = worst_deg(&run, &person, 9, gap);
    assert!(worst < 4.0, "{worst} degrees off in the gap");
    let std_deg = run.frames[100].estimate.angle_variance_rad2[9].sqrt().to_degrees();
    assert!((0.5..4.0).contains(&std_deg), "{std_deg} degrees are owned up to in the gap");
}

/// Upper arm and forearm of one side are missing for a part of a turn or longer, while the other
/// arm is seen. The forearm winds. In the half cycle before the gap up to 5 degrees are off, which
/// sets the bounds.
#[test]
fn a_gap_has_the_turns_of_a_winding_arm() {
    const ARM: [usize; 2] = [2, 3];
    let model = CyclicModel::from_option("arm-circles").unwrap();
    for (seed, turns) in [(1, 0.3), (2, 0.6), (3, 1.0), (4, 1.5)] {
        let (person, table) = recorded(&model, 10, seed);
        let cycle = person.cycle_frames();
        let gap = (4.0 * cycle) as u64..((4.0 + turns) * cycle) as u64;
        let run = finished(
            &model,
            &with(&table, |row| {
                if gap.contains(&row.frame) {
                    ARM.into_iter().for_each(|angle| row.angles_rad[angle] = None);
                }
            }),
        );
        for angle in ARM {
            let [inside, after] =
                [gap.clone(), gap.end..gap.end + 10].map(|part| worst_deg(&run, &person, angle, part));
            assert!(inside < 15.0 && after < 8.0, "{turns} turns, angle {angle}: {inside} degrees off, {after} after");
            let [first, last] = [0, run.frames.len() - 1].map(|row| run.frames[row].angles_rad[angle]);
            let wound = (last - first) / TAU;
            let wanted = 10.0 * f64::from(model.numbers().turns_per_cycle[angle]);
            assert!((wound - wanted).abs() < 0.3, "{turns} turns, angle {angle}: {wound} instead of {wanted} in all");
        }
    }
}

#[test]
fn nothing_is_known_before_the_first_and_after_the_last_measurement_and_in_between_for_long() {
    let model = CyclicModel::from_option("walking").unwrap();
    let (person, table) = recorded(&model, 9, 3);
    let last = table.rows().len() as u64 - 1;
    let is_seen = |frame: u64| (20..110).contains(&frame) || (180..last - 9).contains(&frame);
    let run = finished(
        &model,
        &with(&table, |row| {
            if !is_seen(row.frame) {
                row.angles_rad = [None; ANGLES];
            }
        }),
    );
    for frame in &run.frames {
        assert_eq!(frame.is_known, is_seen(frame.frame), "frame {}", frame.frame);
    }
    let summary = crate::cyclic::tracking::Summary::of(&run);
    let truth = 60.0 * 30.0 / person.cycle_frames();
    assert!((summary.cadence_per_min.unwrap() / truth - 1.0).abs() < 0.01, "{summary:?} {truth}");
    assert!(summary.seen_s < summary.duration_s - 3.0);
}

#[test]
fn a_pause_is_no_cycle() {
    let model = CyclicModel::from_option("walking").unwrap();
    let person = SyntheticPerson::draw(&model, 30.0, 4).unwrap();
    // Two seconds of standing in mid-stride after three seconds.
    let moment = |frame: u64| frame.min(90) as f64 + frame.saturating_sub(150) as f64;
    let angles: Vec<[Option<f64>; ANGLES]> = (0..300).map(|frame| person.pose_rad(moment(frame)).map(Some)).collect();
    let table = AngleTable::from_angles(0, &angles).unwrap();
    let run = finished(&model, &table);
    let cycles = run.frames[299].cycles;
    assert!((cycles - moment(299) / person.cycle_frames()).abs() < 0.15, "{cycles}");
    let paused = run.frames[140].cycles - run.frames[100].cycles;
    assert!(paused.abs() < 0.1, "{paused}");
}

/// Stops in mid-stride of two seconds, half of the recording, and three quarters.
#[test]
fn cycles_and_cadence_are_those_of_the_walk_about_a_stop() {
    let model = CyclicModel::from_option("walking").unwrap();
    let person = SyntheticPerson::draw(&model, 30.0, 4).unwrap();
    let noise = person.measured(60, 1.0_f64.to_radians(), 0.0, 3).unwrap();
    for stop in [60, 300, 900] {
        let moment = |frame: u64| frame.min(150) as f64 + frame.saturating_sub(150 + stop) as f64;
        let angles = (0..300 + stop).map(|frame| {
            let off_rad = |angle: usize| {
                let row = &noise.rows()[frame as usize];
                least_angle(row.angles_rad[angle].unwrap() - person.pose_rad(frame as f64)[angle])
            };
            let pose_rad = person.pose_rad(moment(frame));
            std::array::from_fn(|angle| Some(pose_rad[angle] + off_rad(angle)))
        });
        let table = AngleTable::from_angles(0, &angles.collect::<Vec<_>>()).unwrap();
        let run = finished(&model, &table);
        let summary = crate::cyclic::tracking::Summary::of(&run);
        let [cycles, per_min] = [299.0, 1800.0].map(|frames| frames / person.cycle_frames());
        assert!((summary.cycles - cycles).abs() < 0.3, "{stop}: {} instead of {cycles}", summary.cycles);
        let cadence = summary.cadence_per_min.unwrap();
        assert!((cadence / per_min - 1.0).abs() < 0.02, "{stop}: {cadence} instead of {per_min}");
    }
}

#[test]
fn frame_numbers_that_must_be_wrong_are_refused() {
    let model = CyclicModel::from_option("walking").unwrap();
    let (_, table) = recorded(&model, 2, 1);
    let far = with(&table, |row| {
        if row.frame > 30 {
            row.frame += 900_000_000_000;
        }
    });
    let options = TrackingOptions { rate_hz: Some(30.0), ..TrackingOptions::default() };
    let error = finish(&far, &model, track(&far, &model, &options).unwrap(), &options, None).unwrap_err();
    assert!(error.to_string().contains("frame numbers jump"), "{error}");
    assert_eq!(Seen::<ANGLES>::of_table(&far, &Updates::All), None);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn every_recording_is_finished_with_finite_angles(
        angles in prop::collection::vec(prop::array::uniform13(prop::option::weighted(0.6, -9.0..9.0_f64)), 1..60),
    ) {
        prop_assume!(angles.iter().flatten().any(Option::is_some));
        let model = CyclicModel::from_option("walking").unwrap();
        let table = AngleTable::from_angles(5, &angles).unwrap();
        let run = finished(&model, &table);
        for frame in &run.frames {
            prop_assert!(frame.angles_rad.iter().all(|angle| angle.is_finite()) && frame.cycles.is_finite());
            prop_assert!((0.0..=1.0).contains(&frame.estimate.cycle_position));
        }
    }
}
