//! What holds for every text reader of motions: damaged files are read or refused, within bounds.

use super::asf::Skeleton;
use super::*;
use crate::limits::{FREE_POSITIONS, MAX_NUMBER};
use proptest::prelude::*;
use proptest::sample::Index;
use std::path::Path;

const BVH: &str = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 4 Xposition Zrotation Xrotation Yrotation\nJOINT Arm\n{\n\
    OFFSET 1 2 3\nCHANNELS 1 Zrotation\nEnd Site\n{\nOFFSET 0 3 0\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.05\n1 2 3 4 5\n1 2 3 4 5\n";
const TRC: &str = "PathFileType\t4\t(X/Y/Z)\tm.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n60\t60\t2\t2\tmm\n\
    Frame#\tTime\tRHip\t\t\tLHip\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n1\t0.0\t1\t2\t3\t\t\t\n2\t0.016\tNaN\tNaN\tNaN\t4\t5\t6\t\n";
const ASF: &str = ":units\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n:bonedata\n begin\n name upper\n\
    direction 0 -1 0\n length 4.5\n axis 0 0 90 XYZ\n dof rx ry rz\n end\n begin\n name tip\n direction 1 0 0\n length 0.45\n\
    end\n:hierarchy\n begin\n root upper\n upper tip\n end\n";
const AMC: &str = ":DEGREES\n1\nroot 0.45 0 0 0 0 0\nupper 0 1 2\n2\nroot 0.45 0 0 0 0 0\nupper 0 1 2\n";

/// What is put into a file in place of one of its words.
const WORDS: [&str; 16] = [
    "",
    "-1",
    "0",
    "1e308",
    "-1e38",
    "1e-45",
    "inf",
    "NaN",
    "99999999999999999999",
    "4294967295",
    "}",
    "{",
    "JOINT x",
    "End Site\n{",
    "`",
    "\u{feff}",
];

fn row_of_maps() -> String {
    vec!["0.5"; exponential_map::COLUMNS].join(",") + "\n"
}

fn skeleton() -> Skeleton {
    asf::parse(ASF, Path::new("s.asf")).unwrap()
}

/// Reads the text as one of the formats; the error's text if it is refused.
fn read(format: usize, text: &str, partial: bool) -> Result<MarkerMotion, String> {
    let (path, options) = (Path::new("m"), ReadOptions { partial, ..ReadOptions::default() });
    let motion = match format {
        0 => bvh::parse_with(text, path, &options).map(|motion| MarkerMotion::from(&motion)),
        1 => trc::parse_with(text, path, &options),
        2 => amc::parse(text, path, &skeleton(), 60.0).map(|motion| MarkerMotion::from(&motion)),
        3 => exponential_map::parse(text, path, 60.0).map(|motion| MarkerMotion::from(&motion)),
        _ => asf::parse(text, path)
            .and_then(|skeleton| amc::parse(AMC, path, &skeleton, 60.0))
            .map(|motion| MarkerMotion::from(&motion)),
    };
    motion.map_err(|error| error.to_string())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn damaged_texts_are_read_or_refused_within_bounds(
        format in 0_usize..5,
        changes in prop::collection::vec((any::<Index>(), 0..WORDS.len(), 1_usize..2000), 0..4),
        cut in any::<Index>(),
        is_cut: bool,
        partial: bool,
    ) {
        let maps = row_of_maps().repeat(3);
        let whole = [BVH, TRC, AMC, &maps, ASF][format];
        let separators: &[char] = &[' ', '\n', '\t', ','];
        let mut words: Vec<String> = whole.split_inclusive(separators).map(str::to_owned).collect();
        for (at, word, times) in changes {
            let at = at.index(words.len());
            let end = words[at].pop().unwrap_or('\n');
            words[at] = format!("{}{end}", WORDS[word]).repeat(if times > 1900 { times } else { 1 });
        }
        let mut text = words.concat();
        if is_cut {
            let mut end = cut.index(text.len() + 1);
            while !text.is_char_boundary(end) {
                end -= 1;
            }
            text.truncate(end);
        }
        match read(format, &text, partial) {
            Ok(motion) => {
                let positions: usize = motion.positions_m.iter().map(Vec::len).sum();
                prop_assert!(positions <= FREE_POSITIONS + text.len());
                let farthest_m = 300.0 * MAX_NUMBER;
                let is_sound = |position: &sinew_core::math::Vec3| position.iter().all(|x| x.abs() <= farthest_m);
                prop_assert!(format == 4 || motion.positions_m.iter().flatten().flatten().all(is_sound));
                prop_assert!(motion.frames_per_second.is_finite() && motion.frames_per_second > 0.0);
                prop_assert!(partial || motion.shortfall.is_none());
            }
            Err(message) => prop_assert!(message.chars().count() < 2200, "{message}"),
        }
    }
}

#[test]
fn whole_texts_are_read() {
    let maps = row_of_maps().repeat(3);
    for (format, text) in [BVH, TRC, AMC, &maps, ASF].into_iter().enumerate() {
        assert_eq!(read(format, text, false).unwrap().positions_m.len(), 2, "{format}");
    }
}

#[test]
fn a_byte_order_mark_is_no_part_of_a_motion() {
    let folder = tempfile::tempdir().unwrap();
    let maps = row_of_maps().repeat(3);
    for (name, text) in [("s.asf", ASF), ("m.amc", AMC), ("m.bvh", BVH), ("m.trc", TRC), ("m.txt", &maps)] {
        let path = folder.path().join(name);
        std::fs::write(&path, format!("\u{feff}{text}")).unwrap();
        if name != "s.asf" {
            assert_eq!(read_space(&path, &ReadOptions::default()).unwrap().positions_m.len(), 2, "{name}");
        }
    }
}
