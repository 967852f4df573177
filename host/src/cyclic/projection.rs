//! Motion in space as a camera sees it that stands beside, or before, the person.

use super::heading::{headings, straightness};
use super::image_joints::{ImageJoints, JointFrame};
use super::planar::{knee_direction, level_axis};
use crate::error::{Context, Result, bail};
use crate::motion::joint_names::{HIP_CENTER, HIPS, JOINTS, NECK, SpatialJoints};
use sinew_core::math::Vec3;

/// From where the person is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
pub enum View {
    /// `side`, but `path` for a person who turns.
    #[default]
    Auto,
    /// From the person's right: x is forward, the mean direction of travel.
    Side,
    /// From the person's right wherever they turn: x is where the hips face. The root stays at 0.
    Path,
    /// From before: x is the person's left.
    Front,
    /// As `auto`, and beside each angle how far the segment points out of that plane: two angles a
    /// joint.
    Space,
}

/// A coordinate axis that points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
pub enum UpAxis {
    /// The first coordinate.
    X,
    /// The second, as in BVH, ASF and OpenSim files.
    Y,
    /// The third, as in most C3D files.
    Z,
}

/// Where the forward direction comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Forward {
    /// The way from the first to the last frame.
    Travel,
    /// The hips: the person stays about where they are.
    Hips,
    /// The hips of each moment: the person turns.
    Turning,
    /// The knees of a planar recording: the person stays about where they are.
    Knees,
}

/// The plane of a view.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Right in the image: one for all frames, or one for each; `None` where it is unknown.
    pub right: Vec<Option<Vec3>>,
    /// Up in the image.
    pub up: Vec3,
    /// Where the forward direction comes from.
    pub forward: Forward,
}

/// How far a person has to get, in lengths of the trunk, to count as travelling.
const TRAVEL_TRUNKS: f32 = 1.0;
/// Length of the mean heading below which a person turns: headings spread over more than about 50
/// degrees to each side.
const TURNING_BELOW: f32 = 0.85;
/// Ankles, for the direction that is up where a person stands.
const ANKLES: [usize; 2] = [10, 13];

impl Plane {
    /// Chooses the plane of `view`. Up is the axis that the necks lie along from the ankles (or
    /// hips), unless `up` says it. Forward is the mean direction of travel. Of a person who gets
    /// less far than the trunk is long, it is square to the line through the hips. A recording in
    /// one plane is seen along the plane's normal: forward is the way, or where the knees point.
    ///
    /// # Errors
    /// Neck and hips are in no frame together, or neither travel nor hips give a direction.
    pub fn choose(frames: &[SpatialJoints], view: View, up: Option<UpAxis>, rate_hz: f64) -> Result<Self> {
        let up = upwards(frames, up)?;
        if let Some(axis) = level_axis(frames, up) {
            let (right, forward) = ahead_in_plane(frames, axis, view)?;
            return Ok(Self { right: vec![Some(right)], up, forward });
        }
        let headings = headings(frames, up, rate_hz);
        if view == View::Path || (matches!(view, View::Auto | View::Space) && straightness(&headings) < TURNING_BELOW) {
            return Ok(Self { right: headings, up, forward: Forward::Turning });
        }
        let (ahead, forward) = ahead(frames, up)?;
        let right = if view == View::Front { up.cross(&ahead) } else { ahead };
        Ok(Self { right: vec![Some(right)], up, forward })
    }

    /// The plane square to this one that is seen from before: x is the person's left.
    #[must_use]
    pub fn from_before(&self) -> Self {
        let left = |ahead: &Option<Vec3>| ahead.map(|ahead| self.up.cross(&ahead));
        Self { right: self.right.iter().map(left).collect(), ..self.clone() }
    }

    /// Sees `frames` in this plane, metres; frames are counted from 0.
    #[must_use]
    pub fn project(&self, frames: &[SpatialJoints]) -> ImageJoints {
        self.project_with_feet(frames, &[])
    }

    /// As [`Plane::project`], with the feet of each frame.
    #[must_use]
    pub fn project_with_feet(&self, frames: &[SpatialJoints], feet: &[[[Option<Vec3>; 2]; 2]]) -> ImageJoints {
        let frame = |index: usize, joints: &SpatialJoints| {
            let right = if let [right] = self.right[..] { right } else { self.right.get(index).copied().flatten() };
            let root = if self.forward == Forward::Turning { joints[HIP_CENTER] } else { Some(Vec3::zeros()) };
            let point = |position: Option<Vec3>| {
                let from_root = position? - root?;
                Some([f64::from(from_root.dot(&right?)), -f64::from(from_root.dot(&self.up))])
            };
            JointFrame {
                frame: index as u64,
                joints: std::array::from_fn::<_, JOINTS, _>(|joint| point(joints[joint])),
                feet: feet.get(index).map_or_else(Default::default, |feet| feet.map(|foot| foot.map(point))),
            }
        };
        ImageJoints {
            frames: frames.iter().enumerate().map(|(index, joints)| frame(index, joints)).collect(),
            unit: "m",
        }
    }
}

/// Up: as said, or the axis that the necks lie along from the ankles (or hips).
///
/// # Errors
/// Neck and hips are in no frame together.
pub fn upwards(frames: &[SpatialJoints], said: Option<UpAxis>) -> Result<Vec3> {
    Ok(match said {
        Some(UpAxis::X) => Vec3::x(),
        Some(UpAxis::Y) => Vec3::y(),
        Some(UpAxis::Z) => Vec3::z(),
        None => {
            let from_ankles = mean(frames, |joints| {
                let [left, right] = ANKLES.map(|joint| joints[joint]);
                Some(joints[NECK]? - (left? + right?) / 2.0)
            });
            let body = from_ankles.or_else(|| mean(frames, |joints| Some(joints[NECK]? - joints[HIP_CENTER]?)));
            main_axis(body.context("neck and hips are in no frame together, so that nothing tells which way is up")?)
        }
    })
}

/// The one direction that is forward in all frames.
fn ahead(frames: &[SpatialJoints], up: Vec3) -> Result<(Vec3, Forward)> {
    let level = |vector: Vec3| vector - up * vector.dot(&up);
    let trunk_m = mean_trunk_m(frames).context("neck and hips are in no frame together")?;
    let travel = level(travel(frames));
    let (direction, forward) = if travel.norm() > TRAVEL_TRUNKS * trunk_m {
        (travel, Forward::Travel)
    } else {
        (level(mean_left(frames)).cross(&up), Forward::Hips)
    };
    direction_of(direction, trunk_m).map(|direction| (direction, forward))
}

/// The direction along the level `axis` of a planar recording that is on the right of a `view`.
fn ahead_in_plane(frames: &[SpatialJoints], axis: Vec3, view: View) -> Result<(Vec3, Forward)> {
    let along = |vector: Vec3| axis * vector.dot(&axis);
    let trunk_m = mean_trunk_m(frames).context("neck and hips are in no frame together")?;
    let travel = along(travel(frames));
    let (direction, forward) = if view == View::Front {
        (along(mean_left(frames)), Forward::Hips)
    } else if travel.norm() > TRAVEL_TRUNKS * trunk_m {
        (travel, Forward::Travel)
    } else {
        (knee_direction(frames, axis), Forward::Knees)
    };
    direction_of(direction, trunk_m).map(|direction| (direction, forward))
}

/// The way of the root from the first to the last frame that shows it.
fn travel(frames: &[SpatialJoints]) -> Vec3 {
    let mut roots = frames.iter().filter_map(|joints| joints[HIP_CENTER]);
    match (roots.next(), roots.next_back()) {
        (Some(first), Some(last)) => last - first,
        _ => Vec3::zeros(),
    }
}

/// From the right to the left hip, in the mean.
fn mean_left(frames: &[SpatialJoints]) -> Vec3 {
    mean(frames, |joints| Some(joints[HIPS[0]]? - joints[HIPS[1]]?)).unwrap_or_else(Vec3::zeros)
}

fn direction_of(vector: Vec3, trunk_m: f32) -> Result<Vec3> {
    let length = vector.norm();
    if !(length > 1.0e-3 * trunk_m) {
        bail!("neither the way that the person takes nor hips or knees show which way is forward");
    }
    Ok(vector / length)
}

fn mean(frames: &[SpatialJoints], vector: impl Fn(&SpatialJoints) -> Option<Vec3>) -> Option<Vec3> {
    let vectors: Vec<Vec3> = frames.iter().filter_map(vector).collect();
    (!vectors.is_empty()).then(|| vectors.iter().sum::<Vec3>() / vectors.len() as f32)
}

fn mean_trunk_m(frames: &[SpatialJoints]) -> Option<f32> {
    let lengths: Vec<f32> =
        frames.iter().filter_map(|joints| Some((joints[NECK]? - joints[HIP_CENTER]?).norm())).collect();
    (!lengths.is_empty()).then(|| lengths.iter().sum::<f32>() / lengths.len() as f32)
}

/// The signed coordinate axis nearest to `vector`.
fn main_axis(vector: Vec3) -> Vec3 {
    let axis = vector.iamax();
    let mut up = Vec3::zeros();
    up[axis] = if vector[axis] < 0.0 { -1.0 } else { 1.0 };
    up
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A person with z up who faces y (left is -x) and moves `speed` metres a frame along y.
    fn person(speed: f32) -> Vec<SpatialJoints> {
        let joints = |frame: usize| {
            let root = Vec3::new(0.1, speed * frame as f32, 1.0);
            let mut joints = [None; JOINTS];
            joints[HIP_CENTER] = Some(root);
            joints[NECK] = Some(root + Vec3::new(0.0, 0.05, 0.5));
            joints[HIPS[0]] = Some(root + Vec3::new(-0.1, 0.0, 0.0));
            joints[HIPS[1]] = Some(root + Vec3::new(0.1, 0.0, 0.0));
            joints
        };
        (0..50).map(joints).collect()
    }

    #[test]
    fn forward_is_the_way_or_square_to_the_hips() {
        for (speed, forward) in [(0.02, Forward::Travel), (0.001, Forward::Hips), (-0.005, Forward::Hips)] {
            let frames = person(speed);
            let plane = Plane::choose(&frames, View::Auto, None, 60.0).unwrap();
            assert_eq!(plane.forward, forward);
            assert!(
                (plane.right[0].unwrap() - Vec3::y()).norm() < 1.0e-6 && (plane.up - Vec3::z()).norm() < 1.0e-6,
                "{plane:?}"
            );
            let seen = plane.project(&frames);
            let [root, neck] = [HIP_CENTER, NECK].map(|joint| seen.frames[0].joints[joint].unwrap());
            assert!((neck[0] - root[0] - 0.05).abs() < 1.0e-6 && (neck[1] - root[1] + 0.5).abs() < 1.0e-6);
        }
    }

    #[test]
    fn from_before_the_left_is_on_the_right() {
        let plane = Plane::choose(&person(0.0), View::Front, None, 60.0).unwrap();
        assert!((plane.right[0].unwrap() + Vec3::x()).norm() < 1.0e-6, "{plane:?}");
    }

    /// Left, up and forward are a right-handed system: what is to the left of the person has a
    /// positive x from before.
    #[test]
    fn the_view_from_before_goes_with_that_from_the_side() {
        let frames = person(0.02);
        let plane = Plane::choose(&frames, View::Space, None, 60.0).unwrap();
        assert_eq!(plane, Plane::choose(&frames, View::Auto, None, 60.0).unwrap());
        let front = plane.from_before().project(&frames);
        let [left, right] = HIPS.map(|joint| front.frames[7].joints[joint].unwrap());
        assert!((left[0] - right[0] - 0.2).abs() < 1.0e-6, "{left:?} {right:?}");
    }

    /// A person in a plane whose `level` coordinate is forward by `sense`; `upright` is up.
    fn planar(level: usize, upright: usize, sense: f32, speed: f32) -> Vec<SpatialJoints> {
        let joint = |ahead: f32, height: f32, frame: usize| {
            let mut place = Vec3::repeat(0.25);
            (place[level], place[upright]) = (sense * (ahead + speed * frame as f32), height);
            Some(place)
        };
        let joints = |frame: usize| {
            let mut joints = [None; JOINTS];
            joints[HIP_CENTER] = joint(0.0, 1.0, frame);
            joints[NECK] = joint(0.05, 1.5, frame);
            for hip in HIPS {
                joints[hip] = joint(0.0, 1.0, frame);
                joints[hip + 1] = joint(0.1, 0.5, frame);
                joints[hip + 2] = joint(-0.1, 0.1, frame);
            }
            joints
        };
        (0..50).map(joints).collect()
    }

    #[test]
    fn a_planar_recording_is_seen_along_its_normal() {
        for (level, upright) in [(0, 1), (0, 2), (1, 2), (2, 1), (1, 0), (2, 0)] {
            for (sense, speed) in [(1.0, 0.02), (-1.0, 0.02), (1.0, 0.0), (-1.0, 0.0)] {
                let frames = planar(level, upright, sense, speed);
                let plane = Plane::choose(&frames, View::Auto, None, 60.0).unwrap();
                let wanted = if speed > 0.0 { Forward::Travel } else { Forward::Knees };
                assert_eq!(plane.forward, wanted, "{level} {upright} {sense}");
                let seen = plane.project(&frames);
                let [root, neck] = [HIP_CENTER, NECK].map(|joint| seen.frames[7].joints[joint].unwrap());
                assert!((neck[0] - root[0] - 0.05).abs() < 1.0e-6 && (neck[1] - root[1] + 0.5).abs() < 1.0e-6);
            }
        }
        // Pictures have y down.
        let mut frames = planar(0, 1, 1.0, 0.02);
        frames.iter_mut().flatten().flatten().for_each(|place| place.y = -place.y);
        assert_eq!(Plane::choose(&frames, View::Auto, None, 60.0).unwrap().up, -Vec3::y());
    }

    #[test]
    fn without_a_direction_there_is_no_plane() {
        let mut frames = person(0.0);
        for joints in &mut frames {
            joints[HIPS[0]] = None;
        }
        assert!(Plane::choose(&frames, View::Side, None, 60.0).is_err());
        assert!(Plane::choose(&[[None; JOINTS]], View::Side, None, 60.0).is_err());
    }
}
