//! `sinew angles` as a user types it.

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew::cyclic::AngleTable;
use sinew_tests::{shared_data, sinew_command};
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

fn sinew(folder: &Path) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(folder).arg("angles");
    command
}

/// Distance of two angles on the circle.
fn apart(a: f64, b: f64) -> f64 {
    ((a - b + PI).rem_euclid(TAU) - PI).abs()
}

/// COCO-17 points of a walker at `frame`: x forward, facing right; the left knee swings.
fn walker(frame: usize, shift: f64, sign: f64) -> Vec<f64> {
    let swing = 20.0 * (TAU * frame as f64 / 30.0).sin();
    let (u, hip, neck) = (4.0 * frame as f64, 200.0, 120.0);
    let points = [
        (15.0, 95.0),
        (0.0, 90.0),
        (0.0, 90.0),
        (0.0, 95.0),
        (0.0, 95.0),
        (1.0, neck),
        (-1.0, neck),
        (-swing, 150.0),
        (swing, 150.0),
        (-swing, 180.0),
        (swing, 180.0),
        (2.0, hip),
        (-2.0, hip),
        (swing, 250.0),
        (-swing, 250.0),
        (swing * 1.5 - 5.0, 300.0),
        (-swing * 1.5 - 5.0, 300.0),
    ];
    points.iter().flat_map(|(du, v)| [shift + sign * (u + du), *v, 0.9]).collect()
}

fn write_openpose(folder: &Path, frames: usize, sign: f64, passer_by: bool) {
    fs::create_dir_all(folder).unwrap();
    for frame in 0..frames {
        let person = |values: Vec<f64>| serde_json::json!({ "pose_keypoints_2d": values });
        let mut people = vec![person(walker(frame, 500.0, sign))];
        if passer_by {
            let small: Vec<f64> =
                walker(frame, 900.0, -sign).iter().map(|x| if *x < 1.0 { *x } else { x * 0.5 }).collect();
            people.insert(frame % 2, person(small));
        }
        let text = serde_json::json!({ "people": people }).to_string();
        fs::write(folder.join(format!("v_{frame:012}_keypoints.json")), text).unwrap();
    }
}

fn table(path: &Path) -> AngleTable {
    AngleTable::read(path).unwrap()
}

#[test]
fn a_folder_of_keypoints_gives_angles_root_and_lengths() {
    let root = tempfile::tempdir().unwrap();
    write_openpose(&root.path().join("right"), 60, 1.0, false);
    write_openpose(&root.path().join("left"), 60, -1.0, false);
    write_openpose(&root.path().join("two"), 60, 1.0, true);
    for name in ["right", "left", "two"] {
        let mut command = sinew(root.path());
        let run = command.args([name, "--out", &format!("{name}.csv")]).assert().success();
        match name {
            "left" => drop(run.stderr(contains("faces left"))),
            "two" => drop(run.stderr(contains("up to 2 people in a frame"))),
            _ => drop(run.stderr("").stdout(contains("60 frames").and(contains("0.0 % of the angles missing")))),
        }
    }
    let [right, left, two] = ["right", "left", "two"].map(|name| table(&root.path().join(format!("{name}.csv"))));
    assert_eq!(right.extra_columns()[..2], ["hip_center_u_px", "hip_center_v_px"]);
    assert_eq!(right.rows()[3].extra[..2], ["512.000", "200.000"]);
    assert_eq!(left.rows()[3].extra[..2], ["488.000", "200.000"], "the root stays where it was");
    for (a, b) in right.rows().iter().zip(two.rows()) {
        assert_eq!(a, b, "the larger person was followed");
    }
    // The mirror image of the left walker is the right walker, with their own left and right.
    for (a, b) in right.rows().iter().zip(left.rows()) {
        for i in 0..13 {
            assert!(apart(a.angles_rad[i].unwrap(), b.angles_rad[i].unwrap()) < 1.0e-5, "{i}");
        }
    }
    let mut command = sinew(root.path());
    command.args(["left", "--facing", "right", "--out", "as_is.csv"]).assert().success().stderr("");
    let as_is = table(&root.path().join("as_is.csv"));
    assert!(apart(as_is.rows()[9].angles_rad[8].unwrap(), PI - right.rows()[9].angles_rad[8].unwrap()) < 1.0e-5);
}

#[test]
fn flexion_angles_of_what_was_measured_are_written() {
    let root = tempfile::tempdir().unwrap();
    write_openpose(&root.path().join("k"), 61, 1.0, false);
    let mut command = sinew(root.path());
    command.args(["k", "--out", "t.csv", "--anatomical", "f.csv"]).assert().failure().stderr(contains("--input-rate"));
    let rate = ["k", "--input-rate", "30", "--out", "t.csv", "--anatomical", "f.csv"];
    for (more, rule) in [
        (["--cutoff", "14"], "give 13.500 or less"),
        (["--filter", "gcv"], ""),
        (["--gap-limit", "-1"], "zero or more"),
        (["--view", "front"], "from the side"),
    ] {
        let mut command = sinew(root.path());
        let run = command.args(rate).arg(format!("{}={}", more[0], more[1])).assert();
        if rule.is_empty() { drop(run.success()) } else { drop(run.failure().stderr(contains(rule))) }
    }
    let mut command = sinew(root.path());
    command.args(rate).assert().success().stdout(contains("wrote f.csv"));
    let text = fs::read_to_string(root.path().join("f.csv")).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let knee = rows[0].iter().position(|name| *name == "l_knee_flexion_deg").unwrap();
    assert_eq!((rows.len(), rows[0][..2].to_vec()), (62, vec!["frame", "time_s"]));
    assert!(!text.contains("foot"), "no heel and no toe was seen");
    let measured = table(&root.path().join("t.csv"));
    for frame in 15..45 {
        let angles_rad = &measured.row(frame).unwrap().angles_rad;
        let raw_deg = (angles_rad[9].unwrap() - angles_rad[8].unwrap()).to_degrees();
        let filtered_deg: f64 = rows[frame as usize + 1][knee].parse().unwrap();
        assert!((raw_deg - filtered_deg).abs() < 1.0, "{frame}: {raw_deg} became {filtered_deg}");
    }
}

#[test]
fn rates_change_the_number_of_frames() {
    let root = tempfile::tempdir().unwrap();
    write_openpose(&root.path().join("k"), 61, 1.0, false);
    let mut command = sinew(root.path());
    command.args(["k", "--rate", "60", "--out", "t.csv"]).assert().code(65).stderr(contains("--input-rate"));
    let mut command = sinew(root.path());
    command.args(["k", "--rate", "60", "--input-rate", "30", "--out", "t.csv"]).assert().success();
    assert_eq!(table(&root.path().join("t.csv")).rows().len(), 121);
    let mut command = sinew(root.path());
    command
        .args(["k", "--rate", "0", "--out", "t.csv"])
        .assert()
        .code(65)
        .stderr(contains("`--rate 0`: a rate has to be"));
}

#[test]
fn coco_results_and_tables_of_points_are_read() {
    let root = tempfile::tempdir().unwrap();
    let entries: Vec<_> =
        (0..30).map(|frame| serde_json::json!({ "image_id": frame, "keypoints": walker(frame, 0.0, 1.0) })).collect();
    fs::write(root.path().join("r.json"), serde_json::to_string(&entries).unwrap()).unwrap();
    let mut command = sinew(root.path());
    command.args(["r.json", "--out", "r.csv"]).assert().success();
    let mut text = "frame,l_hip_x_px,l_hip_y_px,l_knee_x_px,l_knee_y_px\n".to_owned();
    for frame in 0..30 {
        let points = walker(frame, 0.0, 1.0);
        writeln!(text, "{frame},{},{},{},{}", points[33], points[34], points[39], points[40]).unwrap();
    }
    fs::write(root.path().join("points.csv"), text).unwrap();
    let mut command = sinew(root.path());
    let note = "it is unknown which way the person faces";
    command.args(["points.csv", "--out", "p.csv"]).assert().success().stderr(contains(note));
    let (results, points) = (table(&root.path().join("r.csv")), table(&root.path().join("p.csv")));
    for (a, b) in results.rows().iter().zip(points.rows()) {
        assert!((a.angles_rad[8].unwrap() - b.angles_rad[8].unwrap()).abs() < 1.0e-5);
        assert_eq!(b.angles_rad.iter().flatten().count(), 1);
    }
}

const BVH: &str = "HIERARCHY\nROOT Hips\n{\n OFFSET 0 0 0\n CHANNELS 3 Xposition Yposition Zposition\n JOINT Neck\n {\n  OFFSET 0 50 0\n  \
    CHANNELS 1 Zrotation\n }\n}\nMOTION\nFrames: 1\nFrame Time: 0.05\n1 2 3 0\n";

#[test]
fn bad_motions_are_refused_with_file_line_and_rule() {
    let root = tempfile::tempdir().unwrap();
    let refused = |name: &str, text: &str, message: &str| {
        fs::write(root.path().join(name), text).unwrap();
        let mut command = sinew(root.path());
        command.args([name, "--out", "t.csv"]).assert().code(65).stderr(contains(name).and(contains(message)));
        assert!(!root.path().join("t.csv").exists());
    };
    refused("m.bvh", &BVH.replace(" }\n}\n", " }\n"), "m.bvh:11: `MOTION` before the hierarchy is closed by `}`");
    refused("m.bvh", &BVH.replace("1 2 3 0", "1 2 3"), "m.bvh:15: a frame needs 4 numbers, found 3");
    refused("m.bvh", &BVH.replace("}\nMOTION", "}\n}\nMOTION"), "m.bvh:12: ");
    refused("m.bvh", &BVH.replace("ROOT Hips", "JOINT Hips"), "m.bvh:2: ");
    refused("m.bvh", &BVH.replace(" OFFSET 0 0 0\n CHANNELS 3", " OFFSET 0 0\n CHANNELS 3"), "m.bvh:4: ");
    refused("m.bvh", &BVH.replace("CHANNELS 1 Zrotation", "CHANNELS 2 Zrotation"), "m.bvh:9: ");
    refused("m.bvh", &BVH.replace("1 2 3 0", "1 2 x 0"), "m.bvh:15: ");
    refused("m.bvh", &BVH.replace("Frames: 1", "Frames: 2"), "1 of the 2 frames that its header promises");
    refused("m.bvh", BVH, "left shoulder (left_shoulder");
    refused("m.amc", "1\n", "--skeleton FILE.asf");
    refused("m.txt", "1,2\n", "m.txt:1: a row needs 117 numbers");
    refused("m.c3d", "no", "this is no C3D file");
    refused("m.mov", "no", "is of no known kind; give a .bvh");
    refused("m.json", "{}", "neither a list of COCO results");
    refused("m.json", "[[1, 2, 3]]", "frame 0: 1 keypoints; 7 (head and arms), 14 (CrowdPose)");
    refused("m.json", "[[], [1, 2]]", "frame 1: 2 numbers; each keypoint needs x, y and confidence");
    refused("m.csv", "a,b\n1,2\n", "line 1: no column is a known joint's");
    refused("m.csv", "neck_x,neck_y\n1,2,3\n", "line 2: a row needs 2 columns as the header has, found 3");
    refused("m.csv", "neck_x,neck_y\n1,2\n1\n", "line 3: a row needs 2 columns as the header has, found 1");
    refused(
        "m.csv",
        "neck_x,neck_y\n1,inf\n",
        "line 2: frame 0: `neck_y` has to be a finite number or empty, found `inf`",
    );
    refused("m.csv", "frame,neck_x,neck_y\n4,1,2\n3,1,2\n", "line 3: frame 3 follows frame 4; frame numbers have to");
    refused("m.csv", "neck_x,neck_y\n", "line 2: the table is empty");
    refused("m.csv", "neck_x,neck_y\nNaN,2\n", "has no person with a keypoint");
    let trc = "PathFileType\t4\t(X/Y/Z)\tm.trc\nDataRate\tUnits\n60\tmm\nFrame#\tTime\tLHip\t\t\tRHip\t\t\n\tX1\n\n1\t0\t1\t2\t3\t4\t5\t6\n";
    refused("m.trc", trc, "left knee (left_knee, leftleg");
    refused("m.trc", &trc.replace("\t6\n", "\n"), "m.trc:7: a frame needs 8 columns, found 7");
    fs::create_dir(root.path().join("empty")).unwrap();
    let mut command = sinew(root.path());
    command.args(["empty", "--out", "t.csv"]).assert().code(65).stderr(contains("has no .json file"));
    let mut command = sinew(root.path());
    command.args(["gone.bvh", "--out", "t.csv"]).assert().code(66).stderr(contains("gone.bvh` cannot be read"));
}

#[test]
fn recorded_walks_give_the_tables_of_the_data_folder() {
    let (Some(tables), Some(walks)) = (shared_data("cyclic-walking"), shared_data("mocap/cmu-walk")) else { return };
    let root = tempfile::tempdir().unwrap();
    let mut names: Vec<String> = fs::read_dir(&tables)
        .unwrap()
        .map(|entry| entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned())
        .filter(|name| name.len() == 5 && name.as_bytes()[2] == b'_')
        .collect();
    names.sort();
    assert_eq!(names.len(), 23);
    for name in names {
        let motion = walks.join(&name[..2]).join(format!("{name}.amc"));
        sinew(root.path()).arg(motion).args(["--rate", "60", "--out", "t.csv"]).assert().success();
        let (made, wanted) = (table(&root.path().join("t.csv")), table(&tables.join(format!("{name}.csv"))));
        assert_eq!(made.rows().len(), wanted.rows().len(), "{name}");
        for (a, b) in made.rows().iter().zip(wanted.rows()) {
            for (x, y) in a.angles_rad.iter().zip(b.angles_rad) {
                assert!((x.unwrap() - y.unwrap()).abs() < 1.0e-4, "{name}: {a:?} is not {b:?}");
            }
        }
    }
}

#[test]
fn every_kind_of_recording_gives_a_standing_person_who_faces_right() {
    let Some(data) = shared_data("mocap") else { return };
    let root = tempfile::tempdir().unwrap();
    for (file, more) in [
        ("bandai/dataset-2_walk_normal_001.bvh", vec![]),
        ("pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh", vec![]),
        ("cmu-expmap/train_running_1.txt", vec![]),
        ("cmu-exercise/13_29.amc", vec!["--skeleton", "cmu-walk/35/35.asf"]),
        ("hdm05/HDM_dg_06-03_03_120.c3d", vec![]),
    ] {
        let more: Vec<_> =
            more.iter().map(|word| if word.contains('/') { data.join(word) } else { word.into() }).collect();
        sinew(root.path()).arg(data.join(file)).args(more).args(["--rate", "60", "--out", "t.csv"]).assert().success();
        let made = table(&root.path().join("t.csv"));
        let mean = |angle: usize, part: fn(f64) -> f64| {
            let values: Vec<f64> = made.rows().iter().filter_map(|row| row.angles_rad[angle]).map(part).collect();
            values.iter().sum::<f64>() / values.len() as f64
        };
        assert!(mean(0, f64::sin) < -0.7, "{file}: the neck is above");
        // A knee bends backwards: the shank points farther back than the thigh.
        for (thigh, shank) in [(8, 9), (11, 12)] {
            assert!(mean(thigh, f64::cos) > mean(shank, f64::cos) + 0.1, "{file}: the person faces right");
        }
    }
}

/// Arm circles wind: somewhere an arm goes round at least three times without a jump.
#[test]
fn arms_that_go_round_are_unwrapped() {
    let Some(data) = shared_data("mocap") else { return };
    let root = tempfile::tempdir().unwrap();
    let skeleton = data.join("cmu-walk/35/35.asf");
    let mut command = sinew(root.path());
    command.arg(data.join("cmu-exercise/13_29.amc")).arg("--skeleton").arg(skeleton);
    command.args(["--rate", "60", "--out", "t.csv"]).assert().success();
    let made = table(&root.path().join("t.csv"));
    let wrist: Vec<f64> = made.rows()[606..954].iter().filter_map(|row| row.angles_rad[6]).collect();
    assert!(wrist.windows(2).all(|pair| (pair[1] - pair[0]).abs() < PI));
    let (low, high) = wrist.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(*x), h.max(*x)));
    assert!(high - low > 3.0 * TAU, "{low} to {high}");
}

#[test]
fn swimmers_with_most_joints_missing_are_read() {
    let Some(data) = shared_data("swim2d/swimfix") else { return };
    let root = tempfile::tempdir().unwrap();
    for file in ["example_ml.csv", "ml_2021-03-12-17-36-11.csv"] {
        let mut command = sinew(root.path());
        let run = command.arg(data.join(file)).args(["--input-rate", "30", "--out", "t.csv"]).assert().success();
        run.stdout(contains("30 frames per second"));
        let made = table(&root.path().join("t.csv"));
        let seen = made.rows().iter().flat_map(|row| row.angles_rad).flatten().count();
        assert!((5..made.rows().len() * 6).contains(&seen), "{file}: {seen} angles");
    }
}

/// The same take as markers and as a skeleton: long segments differ by a few degrees, since markers
/// sit on the skin.
#[test]
fn markers_and_skeleton_of_one_take_agree() {
    let Some(folder) = shared_data("mocap/hdm05") else { return };
    let root = tempfile::tempdir().unwrap();
    let made = ["c3d", "amc"].map(|kind| {
        let mut command = sinew(root.path());
        command.arg(folder.join(format!("HDM_dg_06-03_03_120.{kind}")));
        command.args(["--rate", "60", "--view", "side", "--out", "t.csv"]).assert().success();
        table(&root.path().join("t.csv"))
    });
    assert_eq!(made[0].rows().len(), made[1].rows().len());
    for angle in [0, 2, 3, 5, 6, 8, 9, 11, 12] {
        let apart: Vec<f64> = made[0]
            .rows()
            .iter()
            .zip(made[1].rows())
            .map(|(a, b)| apart(a.angles_rad[angle].unwrap(), b.angles_rad[angle].unwrap()).to_degrees())
            .collect();
        let mean = apart.iter().sum::<f64>() / apart.len() as f64;
        assert!(mean < 9.0 && apart.iter().all(|one| *one < 20.0), "angle {angle}: {mean} degrees on the mean");
    }
}
