//! The 14 joints of the stick figure in recordings of many makers, by the names that they usually
//! give.
//!
//! Names are compared without case, without what stands before a colon, and without `_`, `.`, `-`
//! and spaces. A prefix that no side and no part of a body is in is dropped where the whole name is
//! not known.

mod feet;
pub(super) mod given;
#[cfg(test)]
mod tests;

pub use super::figure::{HIP_CENTER, HIPS, JOINTS, NECK, SHOULDERS};
pub use super::markers::middle;
pub use feet::FootPoints;

use super::error::MotionError;
use super::joint_table::{
    COLLARS, LATERAL, LIMBS, Limb, MEDIAL, NECK_MARKERS, NECKS, PELVIS_BACK, PELVIS_FRONT, ROOT, SACRUM, TROCHANTER,
};
use super::markers::MarkerMotion;
use super::missing_joint::MissingJoint;
use super::name_forms::NameForms;
use feet::FootSources;
use given::GivenNames;
use sinew_core::math::{Vec3, unit};
use std::path::Path;

/// Hip joint centre from the middle of the front of the pelvis, in units of its width: behind,
/// below, to the side (A. L. Bell, R. A. Brand, D. R. Pedersen, Human Movement Science 8, 1989).
const HIP_FROM_FRONT: [f32; 3] = [0.22, 0.30, 0.36];

/// Where a joint comes from.
#[derive(Debug, Clone, PartialEq)]
enum Source {
    /// The middle of these points of the file.
    Points(Vec<usize>),
    /// The middle of two joints of the figure, found before.
    Joints([usize; 2]),
    /// Hip joint from the corners of the pelvis; +1 is the left one.
    Pelvis(Pelvis, f32),
}

/// Points of the pelvis.
#[derive(Debug, Clone, PartialEq)]
struct Pelvis {
    /// Front left and front right.
    front: [usize; 2],
    /// The middle of these is the middle of the back: both corners, or one point of the sacrum.
    back: Vec<usize>,
}

/// The joints of one frame, metres; `None` where one was not seen.
pub type SpatialJoints = [Option<Vec3>; JOINTS];

/// Which points of a file make up each joint.
#[derive(Debug, Clone, PartialEq)]
pub struct JointSources {
    sources: [Option<Source>; JOINTS],
    feet: [FootSources; 2],
}

/// The points of one more joint, by `patterns` as for the limbs. Each entry is an alternative. `+`
/// is the middle of points, `{L}` and `{l}` the side. `{s}` at the beginning is any form of the
/// side before or behind the rest. `None` where no choice is among `names`.
#[must_use]
pub fn named_points(names: &[String], patterns: &[&str], left: bool) -> Option<Vec<usize>> {
    NameForms::new(names).points(patterns, left)
}

/// Position of a limb joint of one side among the joints; `limb` counts `LIMBS`.
const fn limb_joint(limb: usize, side: usize) -> usize {
    (if limb < 3 { SHOULDERS[side] } else { HIPS[side] }) + limb % 3
}

impl JointSources {
    /// Finds the joints of `motion`; points that are never seen do not count. See [`Self::find`].
    ///
    /// # Errors
    /// As [`Self::find`].
    pub fn of_seen(motion: &MarkerMotion, partial: bool, path: &Path) -> Result<Self, MotionError> {
        let is_seen = |point: &usize| motion.positions_m.iter().any(|positions_m| positions_m[*point].is_some());
        let name = |(point, name): (usize, &String)| if is_seen(&point) { name.clone() } else { String::new() };
        Self::find(&motion.names.iter().enumerate().map(name).collect::<Vec<_>>(), partial, path)
    }

    /// Finds the joints among `names`. Without `partial` every limb joint has to be there; `path`
    /// is for the message.
    ///
    /// # Errors
    /// Lists the joints that go by no name that is known, and the names that are there.
    pub fn find(names: &[String], partial: bool, path: &Path) -> Result<Self, MotionError> {
        let given = GivenNames::in_motion(names);
        let own = given.own();
        let known = NameForms::new(&own);
        let pelvis = pelvis(&known);
        let mut sources: [Option<Source>; JOINTS] = std::array::from_fn(|_| None);
        for (side, left) in [(0, true), (1, false)] {
            for (limb, entry) in LIMBS.iter().enumerate() {
                let mut source = limb_points(&known, entry, left, pelvis.is_none()).map(Source::Points);
                if entry.name == "hip" && source.is_none() {
                    let sign = if left { 1.0 } else { -1.0 };
                    let of_pelvis = pelvis.clone().map(|pelvis| Source::Pelvis(pelvis, sign));
                    source = of_pelvis.or_else(|| known.points(TROCHANTER, left).map(Source::Points));
                }
                sources[limb_joint(limb, side)] = source;
            }
        }
        let of_given = |sources: &mut [Option<Source>; JOINTS]| {
            given.joints().for_each(|(joint, point)| sources[joint] = Some(Source::Points(vec![point])));
        };
        // Which points are shoulders says which are collars.
        of_given(&mut sources);
        sources[HIP_CENTER] = known.points(ROOT, true).map(Source::Points).or(Some(Source::Joints(HIPS)));
        let collars = collars(&known, &sources).filter(|_| pelvis.is_none());
        let neck = known.points(NECKS, true).or(collars).or_else(|| known.points(NECK_MARKERS, true));
        sources[NECK] = neck.map(Source::Points).or(Some(Source::Joints(SHOULDERS)));
        of_given(&mut sources);
        let feet = [true, false].map(|left| FootSources::find(&known, &given, left));
        let found = Self { sources, feet };
        let missing = found.missing(&own);
        if missing.is_empty() || (partial && missing.len() < 2 * LIMBS.len()) {
            return Ok(found);
        }
        Err(MotionError::NoLimbJoints { path: path.to_path_buf(), missing, partial, names: own })
    }

    /// Limb joints that were not found.
    fn missing(&self, names: &[String]) -> Vec<MissingJoint> {
        let is_free = |point: usize| {
            let of_joint = |source: &Option<Source>| matches!(source, Some(Source::Points(of)) if of.contains(&point));
            !self.sources.iter().any(of_joint)
        };
        let free = names.iter().enumerate().filter(|(point, _)| is_free(*point)).map(|(_, name)| name.as_str());
        let free: Vec<&str> = free.collect();
        let all = [0, 1].into_iter().flat_map(|side| (0..LIMBS.len()).map(move |limb| (limb, side)));
        let missing = all.filter(|&(limb, side)| self.sources[limb_joint(limb, side)].is_none());
        missing.map(|(limb, side)| MissingJoint::new(&LIMBS[limb], side == 0, &free)).collect()
    }

    /// The point of the file that is `joint`; `None` where it is made of several, or not found.
    #[must_use]
    pub fn point(&self, joint: usize) -> Option<usize> {
        match self.sources.get(joint)?.as_ref()? {
            Source::Points(points) if points.len() == 1 => Some(points[0]),
            _ => None,
        }
    }

    /// The joints of one frame.
    #[must_use]
    pub fn joints(&self, positions_m: &[Option<Vec3>]) -> SpatialJoints {
        let mut joints: SpatialJoints = [None; JOINTS];
        let limbs_first = (2..JOINTS).chain([HIP_CENTER, NECK]);
        for joint in limbs_first {
            joints[joint] = match &self.sources[joint] {
                None => None,
                Some(Source::Points(points)) => middle(points.iter().map(|&point| positions_m[point])),
                Some(Source::Joints(two)) => middle(two.iter().map(|&joint| joints[joint])),
                Some(Source::Pelvis(pelvis, side)) => {
                    let back_m = middle(pelvis.back.iter().map(|&point| positions_m[point]));
                    hip_centre(pelvis.front.map(|point| positions_m[point]), back_m, *side)
                }
            };
        }
        joints
    }

    /// The joints of all frames of `motion`.
    #[must_use]
    pub fn of_motion(&self, motion: &MarkerMotion) -> Vec<SpatialJoints> {
        motion.positions_m.iter().map(|positions_m| self.joints(positions_m)).collect()
    }

    /// Heel and toe of the left and the right foot in each frame, metres; axes as in the file.
    #[must_use]
    pub fn feet_of_motion(&self, motion: &MarkerMotion) -> Vec<FootPoints> {
        let frame = |positions_m: &Vec<Option<Vec3>>| self.feet.each_ref().map(|foot| foot.points(positions_m));
        motion.positions_m.iter().map(frame).collect()
    }
}

/// The points of one limb joint; its segments count where `with_segments`.
fn limb_points(known: &NameForms, limb: &Limb, left: bool, with_segments: bool) -> Option<Vec<usize>> {
    let segments = || known.points(limb.segments, left).filter(|_| with_segments);
    let others = || known.points(limb.markers, left);
    let rest = || {
        let segments_first = limb.name == "shoulder";
        if segments_first { segments().or_else(others) } else { others().or_else(segments) }
    };
    known.points(limb.usual, left).or_else(|| on_skin(known, limb.skin, left)).or_else(rest)
}

/// The middle of the outer and the inner marker of a joint, or the outer one.
fn on_skin(known: &NameForms, words: &[&str], left: bool) -> Option<Vec<usize>> {
    let point = |forms: &[&str], word: &str| {
        let forms: Vec<String> = forms.iter().map(|form| form.replace('*', word)).collect();
        known.points(&forms.iter().map(String::as_str).collect::<Vec<_>>(), left)
    };
    words.iter().find_map(|word| {
        let mut points = point(&LATERAL, word)?;
        points.extend(point(&MEDIAL, word).unwrap_or_default());
        Some(points)
    })
}

fn pelvis(known: &NameForms) -> Option<Pelvis> {
    let both = |patterns: &[&str]| {
        let [left, right] = [true, false].map(|left| known.points(patterns, left).map(|points| points[0]));
        Some([left?, right?])
    };
    let back = both(PELVIS_BACK).map(Vec::from).or_else(|| known.points(SACRUM, true))?;
    Some(Pelvis { front: both(PELVIS_FRONT)?, back })
}

/// Both points where collar bones begin, if the shoulders are others.
fn collars(known: &NameForms, sources: &[Option<Source>; JOINTS]) -> Option<Vec<usize>> {
    let points: Option<Vec<usize>> =
        [true, false].map(|left| Some(known.points(COLLARS, left)?[0])).into_iter().collect();
    let is_shoulder = |point: &usize| {
        SHOULDERS.iter().any(|&shoulder| matches!(&sources[shoulder], Some(Source::Points(of)) if of.contains(point)))
    };
    points.filter(|points| !points.iter().any(is_shoulder))
}

fn hip_centre(front_m: [Option<Vec3>; 2], back_m: Option<Vec3>, side: f32) -> Option<Vec3> {
    let [front_left, front_right] = front_m;
    let (front_left, front_right) = (front_left?, front_right?);
    let front = (front_left + front_right) / 2.0;
    let across = front_left - front_right;
    let left = unit(across)?;
    let ahead = front - back_m?;
    let ahead = unit(ahead - left * ahead.dot(&left))?;
    let up = ahead.cross(&left);
    let [behind, below, beside] = HIP_FROM_FRONT.map(|fraction| fraction * across.norm());
    Some(front - ahead * behind - up * below + left * (side * beside))
}
