//! Motion files that other programs write, with the right answers; they lie beside the project.
//! Without them these tests say that they are skipped.

use sinew_formats::motion::joint_names::{HIPS, JointSources, SpatialJoints};
use sinew_formats::motion::{MarkerMotion, ReadOptions, read_space};
use std::path::{Path, PathBuf};

fn cases() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/cases");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: no cases in {}", folder.display());
    None
}

fn read(folder: &Path, name: &str) -> (MarkerMotion, Vec<SpatialJoints>) {
    let path = folder.join(name);
    let motion = read_space(&path, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    let sources = JointSources::of_seen(&motion, false, &path).unwrap_or_else(|error| panic!("{error}"));
    let joints = sources.of_motion(&motion);
    (motion, joints)
}

/// Largest distance of a joint from where it is in the other recording, metres; frames that miss
/// it in one of them do not count.
fn difference_m(a: &[SpatialJoints], b: &[SpatialJoints]) -> f32 {
    let joints = a.iter().flatten().zip(b.iter().flatten());
    joints.filter_map(|(a, b)| Some(((*a)? - (*b)?).norm())).fold(0.0, f32::max)
}

fn missing(joints: &[SpatialJoints]) -> usize {
    joints.iter().flatten().filter(|joint| joint.is_none()).count()
}

#[test]
fn skeletons_with_other_names_are_the_same_motion() {
    let Some(folder) = cases() else { return };
    let (_, base) = read(&folder, "bvh/base.bvh");
    assert_eq!(missing(&base), 0);
    for name in ["bom", "mixamo_", "optitrack", "rigify", "spaces", "unreal"] {
        let (_, joints) = read(&folder, &format!("bvh/{name}.bvh"));
        let off_m = difference_m(&base, &joints);
        assert!(joints.len() == base.len() && missing(&joints) == 0 && off_m < 1.0e-5, "{name}: {off_m} m off");
    }
}

#[test]
fn c3d_files_of_other_programs_are_the_same_motion() {
    let Some(folder) = cases() else { return };
    let (motion, base) = read(&folder, "c3d/base_mm.c3d");
    assert_eq!((base.len(), motion.names.len(), motion.names[0].as_str()), (238, 19, "RSHO"));
    for name in ["vicon_empty_tail", "events", "h_noframes", "labels2"] {
        let (_, joints) = read(&folder, &format!("c3d/{name}.c3d"));
        let off_m = difference_m(&base, &joints);
        assert!(joints.len() == 238 && missing(&joints) == missing(&base) && off_m < 1.0e-5, "{name}: {off_m} m off");
    }
    // The sacral marker lies up to a finger's breadth from the middle of the other two.
    let (_, joints) = read(&folder, "c3d/sacr.c3d");
    let off_m = difference_m(&base, &joints);
    assert!(missing(&joints) == missing(&base) && off_m < 0.02, "{off_m} m off");
    let cut = read_space(&folder.join("c3d/cut_half.c3d"), &ReadOptions::default()).unwrap_err().to_string();
    assert!(cut.contains("of the 238 frames"), "{cut}");
    for name in ["c3d-alloc-98GB.c3d", "c3d_reader_panics.c3d"] {
        assert!(read_space(&folder.join("hostile").join(name), &ReadOptions::default()).is_err(), "{name}");
    }
}

#[test]
fn what_programs_write_for_missing_markers_is_missing() {
    let Some(folder) = cases() else { return };
    let (_, base) = read(&folder, "trc/base.trc");
    let knee_m = (base[0][HIPS[0] + 1].unwrap() - base[0][HIPS[0]].unwrap()).norm();
    assert!((0.3..0.55).contains(&knee_m), "a thigh of {knee_m} m");
    for (name, all) in [("bom", true), ("zeros", false), ("miss_qnan", false), ("trimmed_tabs", false)] {
        let (_, joints) = read(&folder, &format!("trc/{name}.trc"));
        let (off_m, lost) = (difference_m(&base, &joints), missing(&joints) - missing(&base));
        assert!(joints.len() == 238 && off_m < 1.0e-5, "{name}: {off_m} m off");
        println!("{name}: {lost} joints are missing");
        assert!(!all || lost == 0, "{name}: {lost} joints are missing");
    }
    let (motion, joints) = read(&folder, "trc/gap_in_frames.trc");
    assert_eq!(joints.len(), 238, "{:?}", motion.notes);
    assert!(missing(&joints) >= 30 * 14 && difference_m(&base, &joints) < 1.0e-5);
    let more = read_space(&folder.join("trc/numframes_more.trc"), &ReadOptions::default()).unwrap_err().to_string();
    assert!(more.contains("238 of the 239 frames"), "{more}");
    let (motion, _) = read(&folder, "trc/unit_px.trc");
    assert!(motion.is_scale_assumed && motion.notes[0].contains("px"), "{:?}", motion.notes);
}
