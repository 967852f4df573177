//! Small files, whole, cut and broken.

use super::*;
use crate::limits::{MAX_JOINTS, MAX_SKELETON_DEPTH};

const BVH: &str = "HIERARCHY\nROOT Hips\n{\n OFFSET 5 5 5\n CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n \
    JOINT Arm\n {\n  OFFSET 10 0 0\n  CHANNELS 3 Zrotation Xrotation Yrotation\n  JOINT Hand\n  {\n   OFFSET 20 0 0\n   \
    CHANNELS 4 Xposition Zrotation Xrotation Yrotation\n   End Site\n   {\n    OFFSET 0 3 0\n   }\n  }\n }\n}\n\
    MOTION\nFrames: 1\nFrame Time: 0.05\n1 2 3 0 0 90 90 0 0 30 0 90 0\n";

fn parsed(text: &str) -> Result<Motion, MotionError> {
    parse(text, Path::new("m.bvh"), Some(0.01))
}

/// Root at (1, 2, 3) instead of its offset, turned 90 degrees about y: x -> -z. Arm: at -10 z,
/// its own 90 degrees about z turn x to y. Hand: 30 instead of 20, along y. Its 90 degrees
/// about x turn the end's y to z, which the root turns to x.
#[test]
fn positions_replace_offsets_and_rotations_chain() {
    let motion = parsed(BVH).unwrap();
    let expected = [[1.0, 2.0, 3.0], [1.0, 2.0, -7.0], [1.0, 32.0, -7.0], [4.0, 32.0, -7.0]];
    for (found, wanted) in motion.frame(0).iter().zip(expected) {
        assert!((found * 100.0 - Vec3::from(wanted)).norm() < 1.0e-4, "{found:?} is not {wanted:?} cm");
    }
    assert_eq!(motion.joints, ["Hips", "Arm", "Hand", "Hand_end"]);
    assert!((motion.frames_per_second - 20.0).abs() < 1.0e-4);
}

#[test]
fn the_unit_follows_from_the_arms() {
    for (scale, unit_m) in [(0.3, 1.0), (29.0, 0.01), (290.0, 0.001), (11.5, 0.0254), (5.2, 0.0254 / 0.45)] {
        let text = format!(
            "HIERARCHY\nROOT LeftArm\n{{\nOFFSET 0 0 0\nCHANNELS 0\nJOINT LeftForeArm\n{{\nOFFSET {scale} 0 0\nCHANNELS 1 Zrotation\n\
            JOINT LeftHand\n{{\nOFFSET {scale} 0 0\nCHANNELS 0\n}}\n}}\n}}\nMOTION\nFrames: 1\nFrame Time: 0.1\n0\n"
        );
        let motion = parse(&text, Path::new("m.bvh"), None).unwrap();
        let length_m = motion.frame(0)[2].norm();
        assert!((length_m - 2.0 * scale * unit_m).abs() < 1.0e-5, "{scale}: {length_m} m");
    }
}

#[test]
fn broken_files_name_file_line_and_rule() {
    let changes = [
        ("HIERARCHY", "HIERACHY", "m.bvh:1: a BVH file has to begin"),
        ("CHANNELS 3", "CHANNELS 2", "m.bvh:9: `CHANNELS 2` is followed by 3 names"),
        ("Xposition Yposition", "Xposition Qposition", "m.bvh:5: `Qposition` is no channel"),
        ("  }\n }\n}\n", "  }\n }\n", "m.bvh:20: `MOTION` before the hierarchy is closed"),
        ("30 0 90 0", "30 0 90", "m.bvh:24: a frame needs 13 numbers, found 12"),
        ("30 0 90 0", "30 0 inf 0", "m.bvh:24: `inf` is not finite"),
        ("Frames: 1", "Frames: 2", "m.bvh:22: the recording ends early: 1 of the 2 frames that its header"),
        ("30 0 90 0", "30 0 1e10 0", "m.bvh:24: `1e10` is beyond 1e9; every value has to be within (joint `Hand`)"),
        ("Frame Time: 0.05", "Frame Time: 0", "m.bvh:23: the frame time has to be"),
        ("OFFSET 10 0 0", "OFFSET 10 0", "m.bvh:8: `OFFSET 10 0` has no place"),
        ("JOINT Arm\n {", "JOINT Arm\n", "m.bvh:8: `{` was expected after joint `Arm`"),
    ];
    for (from, to, message) in changes {
        let found = parsed(&BVH.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(found.starts_with(message), "{found} does not start with {message}");
    }
    let found = parsed(&format!("{BVH}1 2 3 0 0 90 90 0 0 30 0 90 0")).unwrap_err().to_string();
    assert!(found.starts_with("m.bvh:22: `Frames: 1` was promised, 2 frames are there"), "{found}");
    assert!(parsed("HIERARCHY\nROOT a\n{\n").unwrap_err().to_string().contains("the file ends where"));
}
fn partial(text: &str) -> Result<Motion, MotionError> {
    parse_with(text, Path::new("m.bvh"), &ReadOptions { partial: true, ..ReadOptions::default() })
}

#[test]
fn a_file_that_was_cut_is_read_as_far_as_it_is_whole() {
    let row = "1 2 3 0 0 90 90 0 0 30 0 90 0\n";
    let text = BVH.replace("Frames: 1", "Frames: 9") + row + row;
    for missing in [0, 1, 3, row.len() - 1] {
        let cut = &text[..text.len() - missing];
        let message = parsed(cut).unwrap_err().to_string();
        let frames = if missing == 0 { 3 } else { 2 };
        assert!(message.contains(&format!("{frames} of the 9 frames")) && message.contains("--partial"), "{message}");
        let motion = partial(cut).unwrap();
        assert_eq!((motion.len(), motion.shortfall), (frames, Some(Shortfall { frames, promised: 9 })));
    }
    // A whole file whose last line has no end.
    assert_eq!(partial(BVH.trim_end()).unwrap().shortfall, None);
    let none = text.lines().take(23).collect::<Vec<_>>().join("\n") + "\n";
    assert!(partial(&none).unwrap_err().to_string().contains("0 of the 9 frames"));
}

#[test]
fn depth_number_and_names_of_joints_are_bounded() {
    let nested = |depth: usize| {
        let open = "JOINT b\n{\nOFFSET 0 0 0\n".repeat(depth);
        format!(
            "HIERARCHY\nROOT a\n{{\nCHANNELS 1 Xrotation\n{open}{}}}\nMOTION\nFrames: 1\nFrame Time: 1\n0\n",
            "}\n".repeat(depth)
        )
    };
    assert_eq!(parsed(&nested(MAX_SKELETON_DEPTH - 1)).unwrap().joints.len(), MAX_SKELETON_DEPTH);
    let message = parsed(&nested(MAX_SKELETON_DEPTH)).unwrap_err().to_string();
    assert!(message.contains("256 of them below each other") && message.len() < 400, "{message}");
    let many = format!("HIERARCHY\nROOT a\n{{\n{}", "End Site\n{\n}\n".repeat(MAX_JOINTS));
    assert!(parsed(&many).unwrap_err().to_string().contains("4096 joints"));
    let long = parsed(&BVH.replace("Arm", &"m".repeat(100_000))).unwrap_err().to_string();
    assert!(long.contains("names of 256 bytes") && long.len() < 400, "{long}");
    let ends = "End Site\n{\n}\n".repeat(4000);
    let wide = format!(
        "HIERARCHY\nROOT a\n{{\nCHANNELS 1 Xrotation\n{ends}}}\nMOTION\nFrames: 9000\nFrame Time: 1\n{}",
        "0\n".repeat(9000)
    );
    assert!(parsed(&wide).unwrap_err().to_string().contains("more than a file of"));
}
