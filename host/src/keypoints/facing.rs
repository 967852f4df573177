//! Which way a person in a side view faces.

use super::layout::{Keypoint, Part, Side};
use crate::cyclic::facing::Facing;
use crate::cyclic::image_joints::{ImageJoints, Point};
use crate::motion::joint_names::{HIP_CENTER, JOINTS, NECK};

/// Way across the image, in lengths of the trunk, beyond which travel decides.
pub const TRAVEL_TRUNKS: f64 = 1.5;
/// Mean of toes before heels, of the nose before the neck or of the knees before their legs, beyond
/// which they decide, in lengths of the trunk. Chosen: a foot has half a trunk and the knees of a
/// walk 0.13 or more; who faces the camera has less than this.
pub const CLEAR_TRUNKS: f64 = 0.05;

/// Toes before heels (or ankles) decide if they point clearly to a side, then the nose before the
/// neck, then the knees before the line from hip to ankle. Next comes travel if the person gets far
/// enough: who walks backward turns it round, and so may a camera that pans. Then come toes, nose
/// and knees that are less clear. `None` if none of these was seen.
#[must_use]
pub fn find(joints: &ImageJoints, people: &[Option<&Vec<Keypoint>>]) -> Option<Facing> {
    let [toes, nose, knees] = [mean_over(people, toes), mean_over(people, nose), knees(joints)];
    let clear_px = trunk_px(joints).map_or(0.0, |trunk| CLEAR_TRUNKS * trunk);
    let clear = |hint: Option<f64>| hint.filter(|hint| hint.abs() > clear_px);
    let hints = [clear(toes), clear(nose), clear(knees), travel(joints), toes, nose, knees];
    side(hints.into_iter().flatten().find(|hint| *hint != 0.0)?)
}

/// The side that a hint points to.
fn side(hint: f64) -> Option<Facing> {
    (hint != 0.0).then_some(if hint < 0.0 { Facing::Left } else { Facing::Right })
}

/// Where feet point, or the nose where feet are not seen, in one frame; pixels to the right.
#[must_use]
pub fn hint_px(person: &[Keypoint]) -> Option<f64> {
    toes(person).or_else(|| nose(person))
}

/// Median length of the trunk.
#[must_use]
pub fn trunk_px(joints: &ImageJoints) -> Option<f64> {
    let trunk = |joints: &[Option<Point>; JOINTS]| {
        let (neck, hip) = (joints[NECK]?, joints[HIP_CENTER]?);
        Some((neck[0] - hip[0]).hypot(neck[1] - hip[1]))
    };
    let mut trunks: Vec<f64> = joints.frames.iter().filter_map(|frame| trunk(&frame.joints)).collect();
    trunks.sort_by(f64::total_cmp);
    trunks.get(trunks.len() / 2).copied()
}

/// Way of the root to the right, pixels, if it is long enough.
#[must_use]
pub fn travel(joints: &ImageJoints) -> Option<f64> {
    let roots: Vec<Point> = joints.frames.iter().filter_map(|frame| frame.joints[HIP_CENTER]).collect();
    let way = roots.last()?[0] - roots.first()?[0];
    (way.abs() > TRAVEL_TRUNKS * trunk_px(joints)?).then_some(way)
}

fn mean_over(people: &[Option<&Vec<Keypoint>>], hint: fn(&[Keypoint]) -> Option<f64>) -> Option<f64> {
    let hints: Vec<f64> = people.iter().flatten().filter_map(|person| hint(person)).collect();
    (!hints.is_empty()).then(|| hints.iter().sum::<f64>() / hints.len() as f64)
}

fn place(person: &[Keypoint], part: Part) -> Option<f64> {
    person.iter().find(|keypoint| keypoint.part == part).map(|keypoint| keypoint.position_px[0])
}

fn toes(person: &[Keypoint]) -> Option<f64> {
    let foot = |side: Side, ankle: usize| {
        let back = place(person, Part::Heel(side)).or_else(|| place(person, Part::Joint(ankle)));
        Some(place(person, Part::Toe(side))? - back?)
    };
    let feet = [foot(Side::Left, 10), foot(Side::Right, 13)];
    let seen = feet.iter().flatten().count();
    (seen > 0).then(|| feet.iter().flatten().sum::<f64>() / seen as f64)
}

fn nose(person: &[Keypoint]) -> Option<f64> {
    let shoulders = || Some((place(person, Part::Joint(2))? + place(person, Part::Joint(5))?) / 2.0);
    Some(place(person, Part::Nose)? - place(person, Part::Joint(NECK)).or_else(shoulders)?)
}

/// How far the knees stand before the line from hip to ankle, in the mean.
fn knees(joints: &ImageJoints) -> Option<f64> {
    let leg = |joints: &[Option<Point>; JOINTS], hip: usize| {
        let (hip, knee, ankle) = (joints[hip]?, joints[hip + 1]?, joints[hip + 2]?);
        let share = if ankle[1] == hip[1] { 0.5 } else { ((knee[1] - hip[1]) / (ankle[1] - hip[1])).clamp(0.0, 1.0) };
        Some(knee[0] - (hip[0] + share * (ankle[0] - hip[0])))
    };
    let bends: Vec<f64> =
        joints.frames.iter().flat_map(|frame| [leg(&frame.joints, 8), leg(&frame.joints, 11)]).flatten().collect();
    (!bends.is_empty()).then(|| bends.iter().sum::<f64>() / bends.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::facing::Facing;
    use crate::cyclic::image_joints::JointFrame;

    fn joints(speed: f64, knee: f64) -> ImageJoints {
        let frame = |frame: u64| {
            let u = speed * frame as f64;
            let mut joints = [None; JOINTS];
            joints[HIP_CENTER] = Some([u, 100.0]);
            joints[NECK] = Some([u, 50.0]);
            (joints[8], joints[9], joints[10]) = (Some([u, 100.0]), Some([u + knee, 140.0]), Some([u, 180.0]));
            JointFrame { frame, joints, feet: Default::default() }
        };
        ImageJoints { frames: (0..30).map(frame).collect(), unit: "px" }
    }

    fn point(part: Part, u: f64) -> Keypoint {
        Keypoint { part, position_px: [u, 0.0], confidence: 1.0 }
    }

    #[test]
    fn toes_count_before_nose_before_knees_before_travel() {
        let toes_left = vec![point(Part::Toe(Side::Left), 3.0), point(Part::Heel(Side::Left), 9.0)];
        let nose_right = [toes_left.clone(), vec![point(Part::Nose, 9.0), point(Part::Joint(NECK), 3.0)]].concat();
        assert_eq!(find(&joints(4.0, -5.0), &[Some(&nose_right)]), Some(Facing::Left));
        let nose_alone = nose_right[2..].to_vec();
        assert_eq!(find(&joints(-4.0, -5.0), &[Some(&nose_alone)]), Some(Facing::Right), "a camera that pans");
        let unclear = vec![point(Part::Nose, 9.0), point(Part::Joint(NECK), 8.0)];
        assert_eq!(find(&joints(-4.0, 5.0), &[Some(&unclear)]), Some(Facing::Right), "who walks backward");
        assert_eq!(find(&joints(-4.0, 2.0), &[Some(&unclear)]), Some(Facing::Left), "knees that are not clear");
        assert_eq!(find(&joints(0.5, -2.0), &[Some(&unclear)]), Some(Facing::Right));
        let nose_only = nose_right[2..].to_vec();
        assert_eq!(find(&joints(0.0, -5.0), &[None, Some(&nose_only)]), Some(Facing::Right));
        assert_eq!(find(&joints(0.0, -5.0), &[]), Some(Facing::Left));
        assert_eq!(find(&joints(0.0, 0.0), &[]), None);
    }
}
