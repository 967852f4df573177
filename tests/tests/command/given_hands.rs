//! `sinew track arm` with hands and faces that another detector found.

use sinew_core::vision::objects::head::HeadBox;
use sinew_record::{CameraFace, Kind, RecordStream};
use sinew_tests::{sinew_command, table_rows};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A scene of both arms with a table of its true hands, with or without their sides.
fn scene(with_sides: bool) -> TempDir {
    let root = tempfile::tempdir().unwrap();
    succeeds(root.path(), "simulate arm --motion builtin --frames 40 --side both --out scene");
    let mut text = String::from(if with_sides {
        "frame,side,u_px,v_px,size_px,probability\n"
    } else {
        "frame,u_px,v_px,size_px,probability\n"
    });
    for row in table_rows(&root.path().join("scene/truth.csv")) {
        if row["hand_visible"] == "1" {
            let side = if with_sides { format!("{},", row["side"]) } else { String::new() };
            text += &format!("{},{side}{},{},60,0.9\n", row["frame"], row["hand_u_px"], row["hand_v_px"]);
        }
    }
    fs::write(root.path().join("hands.csv"), text).unwrap();
    root
}

fn ends(folder: &Path, words: &str) -> (Option<i32>, String, String) {
    let output = sinew_command().current_dir(folder).args(words.split(' ')).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

fn succeeds(folder: &Path, words: &str) -> String {
    let (code, text, errors) = ends(folder, words);
    assert_eq!(code, Some(0), "{words}: {errors}");
    text
}

const TRACK: &str = "track arm scene/frames --config scene/camera.toml --side both --hands hands.csv";

/// Rows that say `tracking`, and how many of them are within 30 pixels of the true hand of their
/// side.
fn near_truth(folder: &Path) -> [usize; 2] {
    let truth = table_rows(&folder.join("scene/truth.csv"));
    let tracked = table_rows(&folder.join("run/track.csv"));
    let sure: Vec<_> = tracked.iter().filter(|row| row["status"] == "tracking").collect();
    let is_near = sure.iter().filter(|row| {
        let own = truth.iter().find(|other| other["frame"] == row["frame"] && other["side"] == row["side"]).unwrap();
        let [du, dv] = ["hand_u_px", "hand_v_px"]
            .map(|axis| row[axis].parse::<f32>().unwrap() - own[axis].parse::<f32>().unwrap());
        du.hypot(dv) < 30.0
    });
    [is_near.count(), sure.len()]
}

#[test]
fn hands_of_a_table_are_followed_with_and_without_sides() {
    for with_sides in [true, false] {
        let root = scene(with_sides);
        succeeds(root.path(), &format!("{TRACK} --out run"));
        let [near, sure] = near_truth(root.path());
        assert!(sure >= 70 && near * 100 >= sure * 97, "with sides {with_sides}: {near} of {sure}");
    }
}

#[test]
fn a_face_of_a_table_gives_the_shoulders_and_is_recorded_by_lines_alone() {
    let root = scene(false);
    fs::write(root.path().join("head.csv"), "frame,u_px,v_px,size_px\n2,300,100,50\n").unwrap();
    let track = "track arm scene/frames --out run --head head.csv";
    succeeds(root.path(), track);
    let rows = table_rows(&root.path().join("run/track.csv"));
    // One width to the person's right, one down.
    let shoulder = ["shoulder_u_px", "shoulder_v_px"].map(|axis| rows[5][axis].parse::<f32>().unwrap());
    assert!((shoulder[0] - 250.0).hypot(shoulder[1] - 150.0) < 1.0, "{shoulder:?}");
    assert_ne!(rows[1]["shoulder_u_px"], rows[5]["shoulder_u_px"], "the face counts from its frame on");
    let (code, _, message) = ends(root.path(), "record run --out run.stream");
    assert!(code == Some(65) && message.contains("--no-face"), "{message}");
    // By lines the face goes into the stream, its box in the pixels that the camera sees.
    succeeds(root.path(), &format!("{track} --front-end lines"));
    let rows = table_rows(&root.path().join("run/track.csv"));
    let shoulder = ["shoulder_u_px", "shoulder_v_px"].map(|axis| rows[39][axis].parse::<f32>().unwrap());
    assert!((shoulder[0] - 250.0).hypot(shoulder[1] - 150.0) < 1.5, "{shoulder:?}");
    let (code, _, message) = ends(root.path(), "record run --out run.stream");
    assert!(code == Some(65) && message.contains("--form camera"), "{message}");
    succeeds(root.path(), "record run --form camera --out run.stream");
    let bytes = fs::read(root.path().join("run.stream")).unwrap();
    let mut stream = RecordStream::<_, 1024>::new(bytes.as_slice());
    let mut faces = Vec::new();
    while let Some(record) = stream.next_record() {
        let record = record.unwrap();
        if record.kind == Kind::CameraFace {
            faces.push(record.read::<CameraFace>().unwrap().head);
        }
    }
    assert_eq!(faces, [HeadBox { centre_px: [149.75, 49.75], width_px: 25.0 }]);
}

#[test]
fn a_table_that_cannot_be_used_is_refused_and_one_that_misses_frames_is_noticed() {
    let root = scene(false);
    let hands = |text: &str| fs::write(root.path().join("hands.csv"), text).unwrap();
    let refused = |status: i32, part: &str| {
        let (code, _, message) = ends(root.path(), &format!("{TRACK} --out run"));
        assert!(code == Some(status) && message.contains(part), "{code:?} {message}");
    };
    hands("frame,u_px,v_px\n0,1,2\n");
    refused(65, "frame,u_px,v_px,size_px,probability");
    hands("frame,u_px,v_px,size_px,probability\n0,1,2,0.5,1\n");
    let (code, _, message) = ends(root.path(), &format!("{TRACK} --out run --front-end lines"));
    assert!(code == Some(65) && message.contains("leave one out"), "{message}");
    hands("frame,u_px,v_px,size_px,probability\n0,1,2,-3,1\n");
    refused(65, "`size_px` has to be above zero, not -3");
    fs::remove_file(root.path().join("hands.csv")).unwrap();
    refused(66, "hands `hands.csv` cannot be read");
    hands("frame,u_px,v_px,size_px,probability\n0,0.25,0.5,0.1,1\n");
    refused(65, "hands `hands.csv` holds shares of the picture");
    hands("frame,u_px,v_px,size_px,probability\n40,100,200,60,1\n");
    refused(65, "hands `hands.csv` has rows for frames 40 to 40, and the last of 40 frames is 39; count frames from 0");
    hands("frame,u_px,v_px,size_px,probability\n4001,100,200,60,1\n");
    let text = succeeds(root.path(), &format!("{TRACK} --out run"));
    assert!(text.contains("--hands has a row for 0 of 40 frames; does it count them from 0?"), "{text}");
}
