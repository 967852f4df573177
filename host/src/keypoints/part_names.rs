//! Names of the parts of a body in tables.

use super::layout::{Part, Side};
use crate::motion::joint_names::{HIP_CENTER, NECK};
use sinew_core::skeleton::stick_figure::HUMAN;

/// Words that tables put before or after a point's number.
const NUMBER_WORDS: [&str; 12] =
    ["", "landmark", "poselandmark", "keypoint", "keypoints", "kp", "kpt", "kpts", "point", "joint", "lm", "pose"];

/// The part of this name: `l_knee`, `left_knee`, `LKnee`, `knee_l`, `Knee Left`. Eyes, ears and
/// fingers have none.
#[must_use]
pub fn part(name: &str) -> Option<Part> {
    let lower = name.to_lowercase();
    let plain: String = lower.chars().filter(|letter| letter.is_ascii_alphanumeric()).collect();
    match plain.as_str() {
        "neck" | "thorax" => return Some(Part::Joint(NECK)),
        "hipcenter" | "hipcentre" | "midhip" | "pelvis" | "root" => return Some(Part::Joint(HIP_CENTER)),
        "nose" => return Some(Part::Nose),
        _ => {}
    }
    let sides = [("left", Side::Left), ("right", Side::Right), ("l", Side::Left), ("r", Side::Right)];
    for (word, side) in sides {
        for rest in [plain.strip_prefix(word), plain.strip_suffix(word)].into_iter().flatten() {
            if let Some(part) = part_of_side(rest, side) {
                return Some(part);
            }
        }
    }
    None
}

fn part_of_side(rest: &str, side: Side) -> Option<Part> {
    let rest = match rest {
        "bigtoe" | "toe" | "toes" | "footindex" | "hallux" => return Some(Part::Toe(side)),
        "heel" => return Some(Part::Heel(side)),
        "sho" | "shldr" => "shoulder",
        "elb" => "elbow",
        "wri" | "wr" => "wrist",
        "kne" => "knee",
        "ank" => "ankle",
        other => other,
    };
    let letter = if side == Side::Left { "l" } else { "r" };
    HUMAN.joint_index(&format!("{letter}_{rest}")).map(Part::Joint)
}

/// The number in a name that is only a number: `12`, `landmark_12`, `kp12`.
#[must_use]
pub fn number(name: &str) -> Option<usize> {
    let plain: String = name.to_lowercase().chars().filter(|letter| letter.is_ascii_alphanumeric()).collect();
    let word = plain.trim_end_matches(|letter: char| letter.is_ascii_digit());
    NUMBER_WORDS.contains(&word).then(|| plain[word.len()..].parse().ok()).flatten()
}

/// Names for messages, of which the nearest to a wrong one is proposed.
#[must_use]
pub fn nearest(name: &str) -> &'static str {
    const KNOWN: [&str; 19] = [
        "l_shoulder",
        "r_shoulder",
        "l_elbow",
        "r_elbow",
        "l_wrist",
        "r_wrist",
        "l_hip",
        "r_hip",
        "l_knee",
        "r_knee",
        "l_ankle",
        "r_ankle",
        "neck",
        "hip_center",
        "nose",
        "l_big_toe",
        "r_big_toe",
        "l_heel",
        "r_heel",
    ];
    let lower = name.to_lowercase();
    let likeness = |known: &&&str| strsim::jaro_winkler(known, &lower);
    KNOWN.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b))).copied().unwrap_or("l_hip")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_usual_names_are_known() {
        for (name, wanted) in [
            ("l_elbow", Part::Joint(3)),
            ("RAnkle", Part::Joint(13)),
            ("left_hip", Part::Joint(8)),
            ("hip_center", Part::Joint(0)),
            ("MidHip", Part::Joint(0)),
            ("LBigToe", Part::Toe(Side::Left)),
            ("right_heel", Part::Heel(Side::Right)),
            ("LEFT_FOOT_INDEX", Part::Toe(Side::Left)),
            ("Knee L", Part::Joint(9)),
            ("ankle-right", Part::Joint(13)),
            ("kneeR", Part::Joint(12)),
        ] {
            assert_eq!(part(name), Some(wanted), "{name}");
        }
        for name in ["head", "rear", "left_eye", "right_pinky", "x", "heel"] {
            assert_eq!(part(name), None, "{name}");
        }
    }

    #[test]
    fn numbers_and_near_names_are_found() {
        assert_eq!((number("landmark_12"), number("7"), number("kp3")), (Some(12), Some(7), Some(3)));
        assert_eq!((number("cam1"), number("nose"), number("")), (None, None, None));
        assert_eq!(nearest("l_sholder"), "l_shoulder");
    }
}
