//! Readers of recorded motion.

use crate::Target;
use crate::file::file;
use sinew::cyclic::recording::{RecordingOptions, angles};
use sinew_formats::limits::{FREE_POSITIONS, MAX_NUMBER};
use sinew_formats::motion::{self, MarkerMotion, ReadOptions};
use std::path::Path;

/// BVH, AMC, ASF, exponential maps, TRC and C3D.
pub const TARGETS: &[Target] = &[
    Target { name: "bvh", run: |bytes| read("m.bvh", bytes), seeds: || vec![BVH.into(), FINGERS.into()] },
    Target { name: "amc", run: |bytes| read("m.amc", bytes), seeds: || vec![AMC.into()] },
    Target { name: "asf", run: asf, seeds: || vec![ASF.into()] },
    Target { name: "trc", run: |bytes| read("m.trc", bytes), seeds: || vec![TRC.into()] },
    Target { name: "c3d", run: |bytes| read("m.c3d", bytes), seeds: || vec![c3d(&[]), c3d(b"\x04")] },
    Target { name: "exponential_maps", run: |bytes| read("m.txt", bytes), seeds: || vec![maps(), maps().repeat(3)] },
];

const BVH: &str = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
    JOINT LeftShoulder\n{\nOFFSET 17 50 3\nCHANNELS 3 Zrotation Xrotation Yrotation\nJOINT LeftElbow\n{\nOFFSET 30 0 0\n\
    CHANNELS 3 Zrotation Xrotation Yrotation\nJOINT LeftWrist\n{\nOFFSET 25 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n\
    End Site\n{\nOFFSET 8 0 0\n}\n}\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.05\n\
    1 2 3 4 5 6 7 8 9 10 11 12 13 14 15\n1 2 3 4 5 6 7 8 9 10 11 12 13 14 15\n";
const FINGERS: &str = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 4 Xposition Zrotation Xrotation Yrotation\nJOINT Arm\n{\n\
    OFFSET 1 2 3\nCHANNELS 1 Zrotation\nEnd Site\n{\nOFFSET 0 3 0\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.05\n\
    1 2 3 4 5\n1 2 3 4 5\n";
const TRC: &str = "PathFileType\t4\t(X/Y/Z)\tm.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n60\t60\t2\t2\tmm\n\
    Frame#\tTime\tRHip\t\t\tLHip\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n1\t0.0\t1\t2\t3\t\t\t\n2\t0.016\tNaN\tNaN\tNaN\t4\t5\t6\t\n";
const ASF: &str = ":version 1.10\n:units\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n:bonedata\n begin\n\
    name upper\n direction 0 -1 0\n length 4.5\n axis 0 0 90 XYZ\n dof rx ry rz\n limits (-60 60)\n (-45 45)\n (0 9)\n end\n\
    begin\n name tip\n direction 1 0 0\n length 0.45\n end\n:hierarchy\n begin\n root upper\n upper tip\n end\n";
const AMC: &str = ":DEGREES\n1\nroot 0.45 0 0 0 0 0\nupper 0 1 2\n2\nroot 0.45 0 0 0 0 0\nupper 0 1 2\n";

fn maps() -> Vec<u8> {
    (vec!["0.5"; motion::exponential_map::COLUMNS].join(",") + "\n").repeat(2).into_bytes()
}

/// The C3D file of the reader's own tests: three markers in two frames; `analog` is the number of
/// analog channels, in a parameter.
fn c3d(analog: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0; 1024];
    (bytes[0], bytes[1]) = (2, 0x50);
    for (at, word) in [(2, 3), (6, 1), (8, 2), (16, 3)] {
        bytes[at] = word;
    }
    bytes[12..16].copy_from_slice(&(-1.0_f32).to_le_bytes());
    bytes[20..24].copy_from_slice(&50.0_f32.to_le_bytes());
    let mut section = vec![1, 0x50, 1, 84];
    for (number, name) in [(1_i8, "POINT"), (2, "ANALOG")] {
        section.extend([name.len() as u8, number.wrapping_neg().cast_unsigned()]);
        section.extend(name.bytes().chain([3, 0, 0]));
    }
    let mut parameter = |group: u8, name: &str, kind: u8, dimensions: &[u8], data: &[u8]| {
        section.extend([name.len() as u8, group]);
        section.extend(name.bytes());
        section.extend([(5 + dimensions.len() + data.len()) as u8, 0, kind, dimensions.len() as u8]);
        section.extend(dimensions.iter().chain(data).chain(&[0]));
    };
    parameter(1, "USED", 2, &[], &[3, 0]);
    parameter(1, "FRAMES", 2, &[], &[2, 0]);
    parameter(1, "UNITS", 0xff, &[2], b"mm");
    parameter(1, "LABELS", 0xff, &[4, 3], b"LANKRANKLHIP");
    if let [channels] = analog {
        parameter(2, "USED", 2, &[], &[*channels, 0]);
    }
    bytes[512..512 + section.len()].copy_from_slice(&section);
    for value in [1.0_f32, 2.0, 3.0, 0.0].repeat(6) {
        bytes.extend(value.to_le_bytes());
    }
    bytes.resize(2048, 0);
    bytes
}

/// Reads a file in all ways in which a motion is read.
fn read(name: &str, bytes: &[u8]) {
    let path = file(name, bytes);
    let skeleton = motion::needs_skeleton(&path).then(|| file("s.asf", ASF.as_bytes()));
    for partial in [false, true] {
        let options = ReadOptions { partial, skeleton: skeleton.as_deref(), ..ReadOptions::default() };
        if let Ok(motion) = motion::read_space(&path, &options) {
            check(&motion, bytes.len(), partial);
        }
        if let Ok(motion) = motion::read(&path, &options) {
            check(&MarkerMotion::from(&motion), bytes.len(), partial);
            let _ = motion::ArmMotion::from_motion(&motion, &path);
        }
    }
    let _ = angles(&path, &RecordingOptions { skeleton, ..RecordingOptions::default() });
}

/// Positions are numbers, and no more than the file has bytes for.
fn check(motion: &MarkerMotion, bytes: usize, partial: bool) {
    let positions: usize = motion.positions_m.iter().map(Vec::len).sum();
    assert!(positions <= FREE_POSITIONS + bytes, "{positions} positions of {bytes} bytes");
    let all = motion.positions_m.iter().flatten().flatten();
    assert!(all.flatten().all(|coordinate| coordinate.abs() <= 1000.0 * MAX_NUMBER), "a position without bounds");
    assert!(motion.frames_per_second.is_finite() && motion.frames_per_second > 0.0, "a rate without bounds");
    assert!(motion.positions_m.iter().all(|frame| frame.len() == motion.names.len()), "a frame of another length");
    assert!(partial || motion.shortfall.is_none(), "fewer frames than promised");
}

fn asf(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let Ok(skeleton) = motion::asf::parse(&text, Path::new("s.asf")) else { return };
    let _ = motion::amc::parse(AMC, Path::new("m.amc"), &skeleton, 60.0);
    let partial = bytes.len().is_multiple_of(2);
    let _ = sinew::body::run::measures_source::read_measures(&file("s.asf", bytes), partial, &mut Vec::new());
}
