//! The anatomical angles: names, signs, and their course over time.

use crate::cyclic::angle_table::{ANGLES, AngleTable};
use crate::cyclic::turns::{unwrap_along_time, wrapped};
use std::f64::consts::{FRAC_PI_2, PI};

/// Number of anatomical angles.
pub const COUNT: usize = 9;

/// Names and signs:
///
/// | angle | positive |
/// |---|---|
/// | trunk lean | the neck is before the hips |
/// | hip flexion | the thigh is before the line that continues the trunk |
/// | knee flexion | the shank is behind the line that continues the thigh |
/// | shoulder flexion | the upper arm is before the trunk |
/// | elbow flexion | the forearm is before the line that continues the upper arm |
pub const ANATOMICAL_ANGLES: [&str; COUNT] = [
    "trunk_lean",
    "l_shoulder_flexion",
    "l_elbow_flexion",
    "l_hip_flexion",
    "l_knee_flexion",
    "r_shoulder_flexion",
    "r_elbow_flexion",
    "r_hip_flexion",
    "r_knee_flexion",
];

/// Pairs of the same angle, left and right, with the name without its side.
pub const PAIRS: [(&str, usize, usize); 4] =
    [("shoulder_flexion", 1, 5), ("elbow_flexion", 2, 6), ("hip_flexion", 3, 7), ("knee_flexion", 4, 8)];

/// Places of the stick figure's angles that are needed here.
const NECK: usize = 0;
/// Upper arm and forearm of one side.
const ARMS: [[usize; 2]; 2] = [[2, 3], [5, 6]];
/// Thigh and shank of one side.
const LEGS: [[usize; 2]; 2] = [[8, 9], [11, 12]];

/// Anatomical angles of one pose, degrees in (-180, 180]; `None` where a segment that it needs is
/// missing.
#[must_use]
pub fn of_pose(angles_rad: &[Option<f64>; ANGLES]) -> [Option<f64>; COUNT] {
    let neck = angles_rad[NECK];
    // From the hips on, the line of the trunk points the other way than from hips to neck.
    let down = neck.map(|neck| neck + PI);
    let turn = |from: Option<f64>, to: Option<f64>| Some(wrapped(from? - to?).to_degrees());
    let mut found = [None; COUNT];
    found[0] = neck.map(|neck| wrapped(neck + FRAC_PI_2).to_degrees());
    for (side, first) in [(0, 1), (1, 5)] {
        let [upper_arm, forearm] = ARMS[side].map(|segment| angles_rad[segment]);
        let [thigh, shank] = LEGS[side].map(|segment| angles_rad[segment]);
        found[first] = turn(down, upper_arm);
        found[first + 1] = turn(upper_arm, forearm);
        found[first + 2] = turn(down, thigh);
        found[first + 3] = turn(shank, thigh);
    }
    found
}

/// A moment: the index of the frame before it, and the share of the way to the next one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    index: usize,
    share: f64,
}

/// Anatomical angles over time.
#[derive(Debug, Clone, PartialEq)]
pub struct AnatomicalSeries {
    /// Number of each frame, rising.
    pub frames: Vec<u64>,
    /// Angles of each frame, degrees, without jumps over whole turns.
    pub angles_deg: Vec<[Option<f64>; COUNT]>,
    /// Frames per second.
    pub rate_hz: f64,
}

impl AnatomicalSeries {
    /// The angles of a table that was recorded at `rate_hz`.
    #[must_use]
    pub fn of_table(table: &AngleTable, rate_hz: f64) -> Self {
        let frames = table.rows().iter().map(|row| row.frame).collect();
        let poses: Vec<[Option<f64>; ANGLES]> = table.rows().iter().map(|row| row.angles_rad).collect();
        Self::of_poses(frames, &poses, rate_hz)
    }

    /// The angles of `poses` at `frames`.
    #[must_use]
    pub fn of_poses(frames: Vec<u64>, poses: &[[Option<f64>; ANGLES]], rate_hz: f64) -> Self {
        let mut angles_deg: Vec<[Option<f64>; COUNT]> = poses.iter().map(of_pose).collect();
        for angle in 0..COUNT {
            let mut series: Vec<Option<f64>> = angles_deg.iter().map(|pose| pose[angle].map(f64::to_radians)).collect();
            unwrap_along_time(&mut series);
            for (pose, value) in angles_deg.iter_mut().zip(series) {
                pose[angle] = value.map(f64::to_degrees);
            }
        }
        Self { frames, angles_deg, rate_hz }
    }

    /// Angle `angle` at a moment between frames, degrees, on the straight line between the frames
    /// beside it; `None` where one of these is not there or lacks the angle.
    #[must_use]
    pub fn at(&self, angle: usize, frame: f64) -> Option<f64> {
        self.between(angle, self.place(frame)?)
    }

    /// Where a moment lies, for all angles; `None` where a frame beside it is not there.
    pub(super) fn place(&self, frame: f64) -> Option<Place> {
        let below = frame.floor();
        let index = self.index_of(below as u64).filter(|_| below >= 0.0)?;
        let share = frame - below;
        if share < 1.0e-9 {
            return Some(Place { index, share: 0.0 });
        }
        (*self.frames.get(index + 1)? == below as u64 + 1).then_some(Place { index, share })
    }

    /// As [`Self::at`], of a place.
    pub(super) fn between(&self, angle: usize, Place { index, share }: Place) -> Option<f64> {
        let here = self.angles_deg[index][angle]?;
        if share == 0.0 {
            return Some(here);
        }
        Some(here + share * (self.angles_deg[index + 1][angle]? - here))
    }

    fn index_of(&self, frame: u64) -> Option<usize> {
        // Where no frame is left out, a frame's place is its number.
        let even = usize::try_from(frame.checked_sub(*self.frames.first()?)?).ok()?;
        if self.frames.get(even) == Some(&frame) { Some(even) } else { self.frames.binary_search(&frame).ok() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(change: &[(usize, f64)]) -> [Option<f64>; COUNT] {
        let mut angles = [Some(FRAC_PI_2); ANGLES];
        angles[NECK] = Some(-FRAC_PI_2);
        for &(angle, by_deg) in change {
            angles[angle] = angles[angle].map(|rad| rad + by_deg.to_radians());
        }
        of_pose(&angles)
    }

    fn check(change: &[(usize, f64)], wanted: &[(&str, f64)]) {
        for (name, found) in ANATOMICAL_ANGLES.iter().zip(pose(change)) {
            let wanted = wanted.iter().find(|other| other.0 == *name).map_or(0.0, |other| other.1);
            assert!((found.unwrap() - wanted).abs() < 1.0e-9, "{name}: {found:?} is not {wanted}");
        }
    }

    /// A segment that hangs down turns forward (towards x) as its angle falls.
    #[test]
    fn signs_are_those_of_the_table() {
        check(&[], &[]);
        check(
            &[(0, 10.0)],
            &[
                ("trunk_lean", 10.0),
                ("l_hip_flexion", 10.0),
                ("r_hip_flexion", 10.0),
                ("l_shoulder_flexion", 10.0),
                ("r_shoulder_flexion", 10.0),
            ],
        );
        check(&[(8, -30.0), (9, 20.0)], &[("l_hip_flexion", 30.0), ("l_knee_flexion", 50.0)]);
        check(&[(11, 15.0), (12, 15.0)], &[("r_hip_flexion", -15.0)]);
        check(&[(2, -90.0), (3, -120.0)], &[("l_shoulder_flexion", 90.0), ("l_elbow_flexion", 30.0)]);
        check(&[(5, 20.0), (6, 20.0)], &[("r_shoulder_flexion", -20.0)]);
    }

    #[test]
    fn what_lacks_a_segment_is_missing_and_winding_goes_on() {
        let mut angles = [Some(0.0); ANGLES];
        angles[8] = None;
        let found = of_pose(&angles);
        assert!(found[3].is_none() && found[4].is_none() && found[7].is_some());
        let poses: Vec<[Option<f64>; ANGLES]> = (0..40)
            .map(|frame| {
                let mut angles = [Some(FRAC_PI_2); ANGLES];
                angles[NECK] = Some(-FRAC_PI_2);
                angles[2] = Some(wrapped(FRAC_PI_2 - 0.5 * f64::from(frame)));
                angles
            })
            .collect();
        let series = AnatomicalSeries::of_poses((3..43).collect(), &poses, 60.0);
        assert!((series.at(1, 42.0).unwrap() - 19.5_f64.to_degrees()).abs() < 1.0e-6);
        assert!((series.at(1, 10.25).unwrap() - 3.625_f64.to_degrees()).abs() < 1.0e-6);
        assert_eq!((series.at(1, 42.5), series.at(1, 2.0)), (None, None));
    }
}
