//! Events and strides of walks whose timing is known.

use super::{Direction, Foot, Gait, NoGait, PointUsed, Scale, of_table};
use crate::cyclic::angle_table::{ANGLES, AngleRow, AngleTable};
use crate::cyclic::recording::{RecordingOptions, angles};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::{Path, PathBuf};

/// A file of the shared data, if it is here.
fn shared(path: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data").join(path);
    if !path.exists() {
        println!("skipped: there is no {}", path.display());
    }
    path.exists().then_some(path)
}

/// A person whose straight legs swing by `swing_rad` in 40 frames, the right one `lag` cycles
/// later.
fn swinging(frames: impl Iterator<Item = u64>, swing_rad: f64, lag: f64) -> AngleTable {
    let row = |frame: u64| {
        let leg = |lag: f64| Some(FRAC_PI_2 - swing_rad * (TAU * (frame as f64 / 40.0 - lag)).cos());
        let mut angles_rad = [Some(FRAC_PI_2); ANGLES];
        (angles_rad[8], angles_rad[9], angles_rad[11], angles_rad[12]) = (leg(0.0), leg(0.0), leg(lag), leg(lag));
        AngleRow { frame, angles_rad, extra: Vec::new() }
    };
    AngleTable::new(frames.map(row).collect(), Vec::new()).unwrap()
}

#[test]
fn strides_of_swinging_legs_are_those_of_the_swing() {
    let gait = of_table(&swinging(7..260, 0.4, 0.5), 60.0, Scale { height_m: Some(1.8) }).unwrap();
    assert!(!gait.is_running || gait.left.stance_share.is_some());
    let time = gait.left.stride_time_s.unwrap();
    assert!((time.mean - 40.0 / 60.0).abs() < 1.0e-3 && time.std.unwrap() < 1.0e-3, "{time:?}");
    assert!((gait.right.step_time_s.unwrap().mean - 20.0 / 60.0).abs() < 1.0e-3);
    let strike = gait.events.left.strikes[1];
    let phase = (strike / 40.0).fract();
    assert!(phase < 0.13, "after the leg is farthest ahead at frame 0: {strike}");
    assert_eq!(gait.events.left.strikes_from, PointUsed::Ankle);
    let step = gait.left.step_length_m.unwrap().mean;
    assert!((0.6..1.3).contains(&step), "{step}");
    assert!(of_table(&swinging(7..260, 0.4, 0.5), 60.0, Scale::default()).unwrap().left.step_length_m.is_none());
    assert_eq!(gait.strides_to_csv(60.0).lines().count(), gait.strides.len() + 1);
    assert!(gait.events.to_csv(60.0).starts_with("frame,time_s,foot,event,from\n"));
}

#[test]
fn no_stride_goes_over_a_gap() {
    let gap = 90..110;
    let gait =
        of_table(&swinging((0..300).filter(|frame| !gap.contains(frame)), 0.4, 0.5), 60.0, Scale::default()).unwrap();
    let over = |from: f64, to: f64| from < 110.0 && to > 90.0;
    assert!(gait.strides.iter().all(|stride| !over(stride.strike, stride.next_strike)), "{:?}", gait.strides);
    assert!(gait.strides.len() >= 4);
}

#[test]
fn no_stride_goes_over_a_stop() {
    let walk = swinging(0..300, 0.4, 0.5);
    let row = |frame: u64| {
        let angles_rad = walk.rows()[(frame.min(130) + frame.saturating_sub(250)) as usize].angles_rad;
        AngleRow { frame, angles_rad, extra: Vec::new() }
    };
    let gait = of_table(&AngleTable::new((0..420).map(row).collect(), Vec::new()).unwrap(), 60.0, Scale::default());
    let gait = gait.unwrap();
    for means in [gait.left, gait.right] {
        let time = means.stride_time_s.unwrap();
        assert!((time.mean - 40.0 / 60.0).abs() < 0.02 && time.count >= 4, "{time:?}");
    }
}

/// Noise of 3 degrees on each angle, as a detector leaves on a person of 300 pixels.
#[test]
fn noise_moves_events_by_less_than_a_frame_and_adds_none() {
    let clean = swinging(0..400, 0.4, 0.5);
    let mut rows = clean.rows().to_vec();
    for (index, angle) in rows.iter_mut().flat_map(|row| &mut row.angles_rad).enumerate() {
        let noise = (12.9898 * index as f64).sin() * 43_758.545_3;
        *angle = angle.map(|rad| rad + 0.18 * (noise - noise.floor() - 0.5));
    }
    let noisy = of_table(&AngleTable::new(rows, Vec::new()).unwrap(), 60.0, Scale::default()).unwrap();
    let clean = of_table(&clean, 60.0, Scale::default()).unwrap();
    for (noisy, clean) in [(noisy.events.left, clean.events.left), (noisy.events.right, clean.events.right)] {
        assert_eq!((noisy.strikes.len(), noisy.toe_offs.len()), (clean.strikes.len(), clean.toe_offs.len()));
        let off_frames = off_ms(&noisy.strikes, &clean.strikes, 1000.0)[1];
        assert!(off_frames < 1.0, "{off_frames}");
    }
}

#[test]
fn who_stands_or_jumps_has_no_gait() {
    assert_eq!(of_table(&swinging(0..300, 0.03, 0.5), 60.0, Scale::default()), Err(NoGait::NoStride));
    let at_once = of_table(&swinging(0..300, 0.4, 0.0), 60.0, Scale::default());
    assert_eq!(at_once, Err(NoGait::NoTurns), "both legs at once");
    assert_eq!(of_table(&swinging(0..3, 0.4, 0.5), 60.0, Scale::default()), Err(NoGait::NoStride));
}

/// Both legs swing together, and noise lets either foot strike first: shares lie at 0 and at 1, and
/// their median anywhere.
#[test]
fn feet_that_strike_together_in_either_order_take_no_turns() {
    let late = |frame: u64| if (frame / 80).is_multiple_of(2) { 0.04 } else { -0.04 };
    let row = |frame: u64| {
        let leg = |lag: f64| Some(FRAC_PI_2 - 0.4 * (TAU * (frame as f64 / 40.0 - lag)).cos());
        let mut angles_rad = [Some(FRAC_PI_2); ANGLES];
        (angles_rad[8], angles_rad[9]) = (leg(0.0), leg(0.0));
        (angles_rad[11], angles_rad[12]) = (leg(late(frame)), leg(late(frame)));
        AngleRow { frame, angles_rad, extra: Vec::new() }
    };
    let table = AngleTable::new((0..640).map(row).collect(), Vec::new()).unwrap();
    assert_eq!(of_table(&table, 60.0, Scale::default()), Err(NoGait::NoTurns));
}

/// A person whose thighs swing, and whose knee bends while its foot goes forward; `time` is 1, or
/// -1 for a walk backward.
fn stepping(frames: std::ops::Range<i64>, time: i64) -> AngleTable {
    let row = |frame: i64| {
        let leg = |lag: f64| {
            let phase = TAU * ((time * frame) as f64 / 40.0 - lag);
            let thigh = FRAC_PI_2 - 0.4 * phase.cos();
            [thigh, thigh + 0.6 * (-phase.sin()).max(0.0)].map(Some)
        };
        let mut angles_rad = [Some(FRAC_PI_2); ANGLES];
        ([angles_rad[8], angles_rad[9]], [angles_rad[11], angles_rad[12]]) = (leg(0.0), leg(0.5));
        AngleRow { frame: frame as u64, angles_rad, extra: Vec::new() }
    };
    AngleTable::new(frames.map(row).collect(), Vec::new()).unwrap()
}

/// The table as if nothing of these angles had been seen.
fn without(table: &AngleTable, angles: std::ops::Range<usize>) -> AngleTable {
    let mut rows = table.rows().to_vec();
    rows.iter_mut().for_each(|row| row.angles_rad[angles.clone()].fill(None));
    AngleTable::new(rows, Vec::new()).unwrap()
}

#[test]
fn a_walk_backward_is_one_forward_that_runs_backwards() {
    let [ahead, back] = [1, -1].map(|time| of_table(&stepping(0..400, time), 60.0, Scale::default()).unwrap());
    assert_eq!((ahead.direction, back.direction), (Direction::Forward, Direction::Backward));
    assert!(!ahead.is_running && !back.is_running);
    let [stance, stance_back] = [&ahead, &back].map(|gait| gait.left.stance_share.unwrap().mean);
    assert!((stance - stance_back).abs() < 0.01, "{stance} {stance_back}");
    // The frames of one are those of the other, counted from the end of a cycle.
    let phase = |moment: f64| (moment / 40.0).rem_euclid(1.0);
    let [strike, toe_off] = [ahead.events.left.strikes[1], ahead.events.left.toe_offs[1]].map(phase);
    let [strike_back, toe_off_back] = [back.events.left.strikes[1], back.events.left.toe_offs[1]].map(phase);
    assert!((phase(-40.0 * toe_off) - strike_back).abs() < 0.01, "{toe_off} {strike_back}");
    assert!((phase(-40.0 * strike) - toe_off_back).abs() < 0.01, "{strike} {toe_off_back}");
    let straight = of_table(&swinging(7..260, 0.4, 0.5), 60.0, Scale::default()).unwrap();
    assert_eq!(straight.direction, Direction::Unknown, "straight legs are as high both ways");
}

#[test]
fn one_leg_gives_its_own_events_and_says_what_is_missing() {
    for (time, direction) in [(1, Direction::Forward), (-1, Direction::Backward)] {
        let both = of_table(&stepping(0..400, time), 60.0, Scale::default()).unwrap();
        let table = without(&stepping(0..400, time), 10..13);
        let one = of_table(&table, 60.0, Scale { height_m: Some(1.8) }).unwrap();
        assert_eq!((one.direction, one.unseen, one.is_running), (direction, Some(Foot::Right), false));
        assert_eq!(one.events.left, both.events.left);
        assert!(one.events.right.strikes.is_empty() && one.left.step_time_s.is_none());
        assert!(one.note().is_some_and(|note| note.starts_with("the right leg is not seen in any stride")));
        assert!(both.note().is_none() && both.unseen.is_none());
    }
    let of = |table: &AngleTable| of_table(table, 60.0, Scale::default()).unwrap_err();
    assert_eq!(of(&without(&stepping(0..400, 1), 7..13)), NoGait::NoLeg);
    let swinging = swinging(7..260, 0.4, 0.5);
    assert_eq!(of(&without(&swinging, 7..10)), NoGait::Unseen(Foot::Left), "a leg that swings without a step");
    assert!(of(&without(&swinging, 7..10)).to_string().contains("the left leg is not seen"));
}

/// Mean of how far events are from a reference, and of the absolute value, milliseconds.
fn off_ms(found: &[f64], reference: &[f64], rate_hz: f64) -> [f64; 2] {
    let nearest = |event: f64| {
        let off = |other: &f64| event - *other;
        found.iter().map(|found| -off(found)).min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap()
    };
    let offs: Vec<f64> = reference.iter().map(|event| 1000.0 * nearest(*event) / rate_hz).collect();
    let count = offs.len() as f64;
    [offs.iter().sum::<f64>() / count, offs.iter().map(|off| off.abs()).sum::<f64>() / count]
}

fn gait_of(path: &Path, without_feet: bool) -> (Gait, f64) {
    let found = angles(path, &RecordingOptions::default()).unwrap();
    let rate_hz = found.rate_hz.unwrap();
    let mut table = found.table;
    if without_feet {
        let kept = table.extra_columns().iter().take_while(|name| !name.contains("heel")).count();
        let row = |row: &AngleRow| AngleRow { extra: row.extra[..kept].to_vec(), ..row.clone() };
        table =
            AngleTable::new(table.rows().iter().map(row).collect(), table.extra_columns()[..kept].to_vec()).unwrap();
    }
    (of_table(&table, rate_hz, Scale::default()).unwrap(), rate_hz)
}

/// A walk over ground with markers on heels and toes, 100 frames a second; 52.5 strides a minute by
/// force plates. The reference is what the markers' own vertical velocities give, by SciPy at
/// 12 Hz. The foot's centre falls fastest before it strikes and rises fastest as it leaves the
/// ground. Source: C. M. O'Connor, S. K. Thorpe, M. J. O'Malley, C. L. Vaughan, Gait & Posture 25,
/// 2007.
#[test]
fn a_marker_walk_has_the_events_of_its_vertical_velocities() {
    let Some(path) = shared("cases/trc/base.trc") else { return };
    let reference = [([85.0, 200.0], [40.0, 155.0]), ([29.0, 143.0], [97.0, 211.0])];
    for (without_feet, limit_ms) in [(false, 1000.0 / 60.0), (true, 1000.0 / 60.0)] {
        let (gait, rate_hz) = gait_of(&path, without_feet);
        let both = |kind: usize| {
            let offs = [&gait.events.left, &gait.events.right].into_iter().zip(reference).map(
                |(foot, (strikes, toe_offs))| {
                    if kind == 0 {
                        off_ms(&foot.strikes, &strikes, rate_hz)
                    } else {
                        off_ms(&foot.toe_offs, &toe_offs, rate_hz)
                    }
                },
            );
            offs.fold([0.0; 2], |sum, off| [sum[0] + 0.5 * off[0], sum[1] + 0.5 * off[1]])
        };
        let [strikes_ms, toe_offs_ms] = [both(0), both(1)];
        println!("without feet {without_feet}: strikes {strikes_ms:.1?} ms, toe-offs {toe_offs_ms:.1?} ms");
        assert!(strikes_ms[1] < limit_ms && toe_offs_ms[1] < limit_ms, "{:?}", gait.events);
        let stride_s = gait.left.stride_time_s.unwrap().mean;
        assert!((60.0 / stride_s - 52.5).abs() < 1.0, "{stride_s} s");
        let stance = gait.right.stance_share.unwrap().mean;
        assert!(!gait.is_running && (0.55..0.68).contains(&stance), "{stance}");
        let speed = gait.left.speed_m_per_s.or(gait.right.speed_m_per_s).unwrap().mean;
        assert!((1.2..1.3).contains(&speed), "{speed} m/s where the hips have 1.25");
    }
}

/// Walks have double support, runs have flights.
#[test]
fn walks_and_runs_are_told_apart() {
    for (file, is_running) in [
        ("mocap/pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh", false),
        ("mocap/bandai/dataset-1_walk_tired_001.bvh", false),
        ("mocap/bandai/dataset-2_walk_normal_001.bvh", false),
        ("mocap/bandai/dataset-2_walk_elderly_001.bvh", false),
        ("mocap/bandai/dataset-2_run_active_001.bvh", true),
        ("mocap/bandai/dataset-2_run_active_002.bvh", true),
        ("mocap/cmu-expmap/train_running_1.txt", true),
        ("mocap/cmu-expmap/train_running_2.txt", true),
        ("mocap/cmu-expmap/train_walking_1.txt", false),
    ] {
        let Some(path) = shared(file) else { return };
        let (gait, _) = gait_of(&path, false);
        let show = |mean: Option<super::MeanStd>| mean.map(|mean| (mean.mean, mean.std, mean.count));
        println!(
            "{file}: running {}, {:?} {:?}, stride {:.3?} s, stance {:.3?} {:.3?}, double {:.3?}, flight {:.3?}, speed {:.3?}",
            gait.is_running,
            gait.events.left.strikes_from,
            gait.events.left.toe_offs_from,
            show(gait.left.stride_time_s),
            show(gait.left.stance_share),
            show(gait.right.stance_share),
            show(gait.left.double_support_share),
            show(gait.left.flight_time_s),
            show(gait.left.speed_m_per_s)
        );
        assert_eq!(gait.is_running, is_running, "{file}");
        let stance = gait.left.stance_share.unwrap().mean;
        assert!(if is_running { stance < 0.5 } else { (0.53..0.7).contains(&stance) }, "{file}: {stance}");
    }
}
