use super::*;
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::tracking::{Tracked, TrackingOptions, track};
use crate::cyclic::{AngleRow, AngleTable, CyclicModel};
use crate::output::OutputDir;

/// The shipped walk at 60 cycles a minute and 60 frames a second: frame f is at f / 60 of a cycle.
fn walk(frames: impl Iterator<Item = u64>, missing: &[usize]) -> AngleTable {
    let model = CyclicModel::from_option("walking").unwrap();
    let view = model.view();
    let rows = frames.map(|frame| {
        let pose = view.mean_pose_rad::<ANGLES>(view.point((frame % 60) as f32 / 60.0));
        let angles_rad = std::array::from_fn(|i| (!missing.contains(&i)).then_some(f64::from(pose[i])));
        AngleRow { frame, angles_rad, extra: Vec::new() }
    });
    AngleTable::new(rows.collect(), Vec::new()).unwrap()
}

fn report(table: &AngleTable) -> (Report, Tracked, TrackingOptions) {
    let model = CyclicModel::from_option("walking").unwrap();
    let options = TrackingOptions { rate_hz: Some(60.0), ..TrackingOptions::default() };
    let tracked = track(table, &model, &options).unwrap();
    (Report::new(table, &tracked, &options, None), tracked, options)
}

#[test]
fn whole_cycles_are_repetitions_of_their_length() {
    let (report, ..) = report(&walk(10..400, &[]));
    assert_eq!(report.cycles.len(), report.summary.cycle_starts_s.len() - 1);
    assert!((4..=6).contains(&report.cycles.len()), "{:?}", report.cycles);
    for one in &report.repetitions {
        assert!((one.tempo_per_min - 60.0).abs() < 6.0, "{one:?}");
        assert!(one.ranges[4].is_some_and(|range| (30.0..90.0).contains(&range.extent_deg())), "{one:?}");
    }
    assert!(report.measured_shares.iter().all(|share| *share == 1.0));
}

#[test]
fn what_was_never_measured_is_not_reported() {
    let (report, ..) = report(&walk(0..200, &[11, 12]));
    assert!(report.series.angles_deg.iter().all(|pose| pose[7].is_none() && pose[8].is_none() && pose[3].is_some()));
    let knee = report.symmetries.iter().find(|one| one.angle == "knee_flexion").unwrap();
    assert!(knee.left_range_deg.is_some() && knee.right_range_deg.is_none() && knee.right_lag_cycles.is_none());
}

#[test]
fn short_gaps_are_bridged_and_long_ones_stay() {
    let frames = (0..400).filter(|frame| frame % 2 == 0 && !(150..180).contains(frame));
    let (report, ..) = report(&walk(frames, &[]));
    assert!(report.series.at(0, 100.5).is_some() && report.series.at(0, 101.0).is_some());
    assert!(report.series.at(0, 160.0).is_none());
    assert_eq!(report.summary.skipped_frames, 199 + 15);
    assert!(report.curves.curves[4].iter().all(|point| point.mean_deg.is_some()));
}

#[test]
fn the_folder_holds_every_file() {
    let table = walk(0..250, &[]);
    let (report, tracked, options) = report(&table);
    let folder = tempfile::tempdir().unwrap();
    let output = OutputDir::create(folder.path()).unwrap();
    let origin = Origin {
        table: "walk.csv",
        model: "walking",
        options: &options,
        height_m: 1.8,
        motions: None,
        overlay: None,
        is_finished: false,
        about: None,
        doubts: &[],
        notes: &[],
    };
    report.write(&origin, &table, &tracked, &output).unwrap();
    let mut names: Vec<String> =
        std::fs::read_dir(folder.path()).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let wanted = "anatomical.csv angles.mot cadence.png curves.csv curves_elbow_flexion.png curves_hip_flexion.png \
        curves_knee_flexion.png curves_shoulder_flexion.png curves_trunk_lean.png cycle_position.png estimates.csv events.csv \
        gait_curves.csv joints.trc measured.csv measured_anatomical.csv phase_portrait.png range_of_motion.png \
        repetitions.csv strides.csv summary.json symmetry.csv trajectories_left_arm.png trajectories_left_leg.png \
        trajectories_right_arm.png trajectories_right_leg.png trajectories_trunk_and_links.png";
    assert_eq!(names.join(" "), wanted);
    let json: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("summary.json")).unwrap()).unwrap();
    assert_eq!((json["format"].as_str(), json["version"].as_u64()), (Some("sinew-track-cyclic"), Some(1)));
    assert_eq!(json["options"]["filter"], "coupled");
    assert_eq!(json["repetitions"].as_array().unwrap().len(), report.repetitions.len());
    assert!(json["repetitions"][0]["range_of_motion"]["l_knee_flexion"]["range_deg"].as_f64().unwrap() > 30.0);
}

/// Keypoints of a person who faces left, 2 m high: trunk 60 px, leg 49 and 49.2 px, hips at (100 -
/// f, 50).
fn keypoints(frames: u64, hidden: std::ops::Range<u64>) -> AngleTable {
    let mut columns = vec!["hip_center_u_px".to_owned(), "hip_center_v_px".to_owned()];
    columns.extend(["neck", "l_knee", "l_ankle"].map(|name| format!("{name}_length_px")));
    columns.push("facing".to_owned());
    let walk = walk(0..frames, &[]);
    let rows = walk.rows().iter().map(|row| {
        let mut extra = [(100 - row.frame as i64).to_string(), "50".into(), "60".into(), "49".into(), "49.2".into()];
        if hidden.contains(&row.frame) {
            extra.fill(String::new());
        }
        AngleRow { extra: extra.into_iter().chain(["left".to_owned()]).collect(), ..row.clone() }
    });
    AngleTable::new(rows.collect(), columns).unwrap()
}

#[test]
fn a_body_in_pixels_gets_the_height_of_the_person() {
    let body = body::Body::of_table(&keypoints(3, 0..0), 2.0);
    assert!((body.metres_per_unit - 0.491 * 2.0 / 98.2).abs() < 1.0e-6, "{body:?}");
    assert!((body.lengths[0] - 60.0).abs() < 1.0e-12 && (body.lengths[3] * body.metres_per_unit - 0.292).abs() < 1e-6);
    assert!(body.is_in_pixels());
}

/// As in tables whose hips or feet were never apart.
#[test]
fn lengths_of_zero_are_those_of_an_adult() {
    let table = keypoints(60, 0..0);
    let rows = table.rows().iter().map(|row| AngleRow {
        extra: row.extra.iter().map(|cell| if cell == "49" { "0.000".to_owned() } else { cell.clone() }).collect(),
        ..row.clone()
    });
    let table = AngleTable::new(rows.collect(), table.extra_columns().to_vec()).unwrap();
    let (report, tracked, options) = report(&table);
    let body = body::Body::of_table(&table, 2.0);
    assert!((body.lengths[8] * body.metres_per_unit - 0.245 * 2.0).abs() < 0.01, "{body:?}");
    assert_eq!(joints::positions(&table, &tracked, &report, &body, options.sigma_rad).unwrap().len(), 60);
}

#[test]
fn the_root_is_followed_through_a_short_gap_and_given_up_in_a_long_one() {
    let table = keypoints(150, 60..150);
    let (report, tracked, options) = report(&table);
    let body = body::Body::of_table(&table, 2.0);
    let positions = joints::positions(&table, &tracked, &report, &body, options.sigma_rad).unwrap();
    for frame in [0, 59, 63] {
        let [x, y] = positions[frame].1[0].unwrap();
        assert!((x + 100.0 - frame as f64).abs() < 4.0 && (y - 50.0).abs() < 1.0, "frame {frame}: {x}, {y}");
    }
    assert!(positions[149].1.iter().all(Option::is_none), "the root was lost");
    let [neck, hip] = [positions[40].1[1].unwrap(), positions[40].1[0].unwrap()];
    assert!(((neck[0] - hip[0]).hypot(neck[1] - hip[1]) - 60.0).abs() < 0.1);
    let csv = joints::to_csv_px(&positions, &table, &body);
    let lines: Vec<&str> = csv.lines().collect();
    assert!(lines[0].starts_with("frame,hip_center_x_px,hip_center_y_px,neck_x_px") && lines.len() == 151);
    assert!(lines.iter().all(|line| line.split(',').count() == 29));
    assert!(lines[1].starts_with("0,100.00,50.00,"), "{}", lines[1]);
}
