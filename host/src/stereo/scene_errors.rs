//! What makes a scene harder than noise of disparities alone: errors of what a tracker is given,
//! and of matching, background and shutter.

use crate::body::body_size::lengths_times;
use crate::error::{Result, ensure};
use serde::Serialize;
use sinew_core::camera::Pixel;
use sinew_core::random::Stream;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_ANGLES, BODY_BONES, BodySkeleton, UPPER_ARMS};
use sinew_core::skeleton::tree::SHIFTS;

/// Numbers of the frame whose streams the errors of a person are drawn from: no frame of a scene,
/// nor that of the patches.
const PERSON_FRAMES: [u64; 3] = [u64::MAX - 1, u64::MAX - 2, u64::MAX - 3];
/// Added to a frame's number for the streams of its windows.
const WINDOW_FRAMES: u64 = 1 << 62;
/// Largest window of a matcher, pixels.
pub const MAX_MATCH_WINDOW_PX: u32 = 1000;
/// Longest exposure, seconds.
const MAX_EXPOSURE_S: f32 = 1.0;
/// Largest error of the first pose, degrees.
const MAX_FIRST_POSE_DEG: f32 = 90.0;

/// Errors of a scene, all zero by default.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct SceneErrors {
    /// By which share each radius of the seen body differs from that of `body.json`; the sign is
    /// drawn for each bone, alike on both sides.
    pub radius_share: f32,
    /// By which share each length of `body.json` differs from the seen person's; the sign is drawn
    /// for each length.
    pub length_share: f32,
    /// By how much each angle of the first pose is off, degrees; the sign is drawn for each angle.
    pub first_pose_deg: f32,
    /// Points in one square of so many pixels share the error of their disparity; with 0 each point
    /// has its own.
    pub match_window_px: u32,
    /// Share of the windows that are matched falsely: their points share one disparity from
    /// anywhere in the body's box.
    pub false_matches: f32,
    /// Share of the points that lie on a wall behind the person.
    pub background: f32,
    /// How long the shutter is open, seconds: each point lies where its bone is at a moment of it.
    pub exposure_s: f32,
}

/// How one point is matched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Match {
    /// An error of the disparity, in its standard deviations.
    Noise(f32),
    /// A disparity that has nothing to do with the point: this share of the range that is searched.
    False(f32),
}

impl SceneErrors {
    /// A hard scene. Radii, lengths and first pose are off by what the requirement names.
    ///
    /// Chosen: windows of 11 pixels, one in twenty of them false, as a block matcher's on skin and
    /// cloth; a tenth of the points on the wall; half of a frame's time at 15 Hz as exposure.
    pub const HARD: Self = Self {
        radius_share: 0.15,
        length_share: 0.05,
        first_pose_deg: 10.0,
        match_window_px: 11,
        false_matches: 0.05,
        background: 0.1,
        exposure_s: 1.0 / 30.0,
    };

    /// Refuses what cannot be; `outliers` is the scene's share of them.
    ///
    /// # Errors
    /// Names the number and its range.
    pub fn check(&self, outliers: f32) -> Result<()> {
        let Self { radius_share, length_share, false_matches, background, .. } = *self;
        for (name, share) in [("radius error", radius_share), ("length error", length_share)] {
            ensure!((0.0..1.0).contains(&share), "the {name} has to be from 0 to below 1, not {share}");
        }
        for (name, share) in [("false matches", false_matches), ("background", background)] {
            ensure!((0.0..=1.0).contains(&share), "the share of {name} has to be from 0 to 1, not {share}");
        }
        let both = outliers + background;
        ensure!(both <= 1.0, "the shares of outliers and background have to be at most 1 together, not {both}");
        let (degrees, exposure_s) = (self.first_pose_deg, self.exposure_s);
        ensure!(
            (0.0..=MAX_FIRST_POSE_DEG).contains(&degrees),
            "the error of the first pose has to be from 0 to {MAX_FIRST_POSE_DEG} degrees, not {degrees}"
        );
        let window_px = self.match_window_px;
        ensure!(
            window_px <= MAX_MATCH_WINDOW_PX,
            "the window of a match has to be at most {MAX_MATCH_WINDOW_PX} pixels, not {window_px}"
        );
        ensure!(
            (0.0..=MAX_EXPOSURE_S).contains(&exposure_s),
            "the exposure has to be from 0 to {MAX_EXPOSURE_S} s, not {exposure_s}"
        );
        Ok(())
    }

    /// Radii of the seen body, metres; `radii_m` are those that the tracker is given.
    #[must_use]
    pub fn seen_radii_m(&self, radii_m: &[f32; BODY_BONES], seed: u64) -> [f32; BODY_BONES] {
        std::array::from_fn(|bone| radii_m[bone] * factor(self.radius_share, seed, 0, left_of(bone) as u32))
    }

    /// Measures that the tracker is given of a person with `measures`.
    #[must_use]
    pub fn given_measures(&self, measures: &BodyMeasures, seed: u64) -> BodyMeasures {
        lengths_times(measures, |index| factor(self.length_share, seed, 1, index as u32))
    }

    /// `pose` with every angle off to one side, to the other one where a limit is in the way.
    #[must_use]
    pub fn given_pose(&self, skeleton: &BodySkeleton, pose: &[f32; BODY_ANGLES], seed: u64) -> [f32; BODY_ANGLES] {
        let mut given = *pose;
        if self.first_pose_deg == 0.0 {
            return given;
        }
        for (index, angle) in given.iter_mut().enumerate().skip(SHIFTS) {
            let off_rad = self.first_pose_deg.to_radians() * sign(seed, 2, index as u32);
            let limit = &skeleton.limits()[index];
            let is_inside = (limit.low_rad..=limit.high_rad).contains(&(*angle + off_rad));
            *angle += if is_inside { off_rad } else { -off_rad };
        }
        skeleton.clamp(given)
    }

    /// How a point at `pixel` of a picture `width_px` wide is matched; `own` is the point's stream.
    pub fn matched(&self, (seed, frame): (u64, u64), pixel: Pixel, width_px: u32, own: &mut Stream) -> Match {
        if self.match_window_px == 0 {
            return self.drawn(own);
        }
        let window = |place_px: f32| place_px.max(0.0) as u32 / self.match_window_px;
        let index = window(pixel.v_px) * (width_px / self.match_window_px + 1) + window(pixel.u_px);
        self.drawn(&mut Stream::new(seed, WINDOW_FRAMES + frame, index))
    }

    fn drawn(&self, stream: &mut Stream) -> Match {
        if self.false_matches > 0.0 && stream.uniform() < self.false_matches {
            return Match::False(stream.uniform());
        }
        Match::Noise(stream.normal())
    }
}

/// A sign of a person's error; `kind` is which.
fn sign(seed: u64, kind: usize, index: u32) -> f32 {
    if Stream::new(seed, PERSON_FRAMES[kind], index).uniform() < 0.5 { -1.0 } else { 1.0 }
}

fn factor(share: f32, seed: u64, kind: usize, index: u32) -> f32 {
    if share > 0.0 { 1.0 + share * sign(seed, kind, index) } else { 1.0 }
}

/// The bone on the left of one on the right; itself of others. Arms have three bones, legs four.
const fn left_of(bone: usize) -> usize {
    match bone {
        6..=8 => bone - (UPPER_ARMS[1] - UPPER_ARMS[0]),
        13..=16 => bone - 4,
        _ => bone,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::skeleton::full_body::{BODY_JOINT_NAMES, BODY_RADII_M, full_body};

    #[test]
    fn radii_and_lengths_are_off_by_their_share_to_either_side() {
        let errors = SceneErrors::HARD;
        let measures = BodyMeasures::of_height(1.75).unwrap();
        let (mut thicker, mut longer) = (0, 0);
        for seed in 1..=200 {
            let radii_m = errors.seen_radii_m(&BODY_RADII_M, seed);
            for bone in 1..BODY_BONES {
                let off = radii_m[bone] / BODY_RADII_M[bone] - 1.0;
                assert!((off.abs() - 0.15).abs() < 1.0e-5, "{off}");
                assert_eq!(radii_m[bone] / BODY_RADII_M[bone], radii_m[left_of(bone)] / BODY_RADII_M[left_of(bone)]);
                assert_eq!(BODY_JOINT_NAMES[bone].replace("r_", "l_"), BODY_JOINT_NAMES[left_of(bone)]);
            }
            thicker += u32::from(radii_m[1] > BODY_RADII_M[1]);
            let given = errors.given_measures(&measures, seed);
            let off = given.thigh_m / measures.thigh_m - 1.0;
            assert!((off.abs() - 0.05).abs() < 1.0e-5, "{off}");
            longer += u32::from(off > 0.0);
        }
        // Four standard deviations of a fair coin thrown 200 times are 28.
        assert!((72..=128).contains(&thicker) && (72..=128).contains(&longer), "{thicker} {longer}");
    }

    #[test]
    fn a_first_pose_is_off_in_every_angle_and_keeps_the_limits() {
        let skeleton = full_body(&BodyMeasures::of_height(1.75).unwrap()).unwrap();
        // Knees and elbows are straight: there the only way is to bend.
        let pose = skeleton.clamp([0.0; BODY_ANGLES]);
        let mut sum = 0.0;
        for seed in 1..=100 {
            let given = SceneErrors::HARD.given_pose(&skeleton, &pose, seed);
            assert_eq!(given, skeleton.clamp(given));
            assert_eq!(given[..SHIFTS], pose[..SHIFTS]);
            for index in SHIFTS..BODY_ANGLES {
                let off_deg = (given[index] - pose[index]).to_degrees();
                assert!((off_deg.abs() - 10.0).abs() < 1.0e-3, "{index}: {off_deg}");
            }
            sum += (given[SHIFTS] - pose[SHIFTS]).to_degrees();
        }
        // The mean of a hundred signs times ten degrees has a standard deviation of one degree.
        assert!((sum / 100.0_f32).abs() < 4.0, "{sum}");
        assert_eq!(SceneErrors::default().given_pose(&skeleton, &pose, 1), pose);
    }

    #[test]
    fn a_window_shares_its_match_and_false_ones_have_their_share() {
        let errors = SceneErrors { match_window_px: 10, false_matches: 0.2, ..SceneErrors::default() };
        let at = |u_px: f32, v_px: f32, frame: u64| {
            errors.matched((1, frame), Pixel::new(u_px, v_px), 640, &mut Stream::new(1, frame, 7))
        };
        assert_eq!(at(20.0, 30.0, 4), at(29.0, 39.0, 4));
        assert_ne!(at(20.0, 30.0, 4), at(30.0, 30.0, 4));
        assert_ne!(at(20.0, 30.0, 4), at(20.0, 40.0, 4));
        assert_ne!(at(20.0, 30.0, 4), at(20.0, 30.0, 5));
        let windows = (0..64).flat_map(|u| (0..48).map(move |v| (u, v)));
        let (mut falsely, mut squares, mut count) = (0.0, 0.0, 0.0_f32);
        for (u, v) in windows {
            match at(10.0 * u as f32, 10.0 * v as f32, 9) {
                Match::False(share) => {
                    assert!((0.0..1.0).contains(&share));
                    falsely += 1.0;
                }
                Match::Noise(noise) => {
                    squares += noise * noise;
                    count += 1.0;
                }
            }
        }
        let all = 64.0 * 48.0;
        assert!((falsely / all - 0.2_f32).abs() < 4.0 * (0.2_f32 * 0.8 / all).sqrt(), "{falsely}");
        assert!((squares / count - 1.0).abs() < 4.0 * (2.0 / count).sqrt(), "{squares} {count}");
    }

    #[test]
    fn errors_that_cannot_be_are_named() {
        let refused = |errors: SceneErrors| errors.check(0.5).unwrap_err().to_string();
        let none = SceneErrors::default();
        assert!(none.check(1.0).is_ok() && SceneErrors::HARD.check(0.1).is_ok());
        for (errors, wanted) in [
            (SceneErrors { radius_share: 1.0, ..none }, "radius error has to be from 0 to below 1"),
            (SceneErrors { length_share: -0.1, ..none }, "length error has to be from 0"),
            (SceneErrors { first_pose_deg: f32::NAN, ..none }, "from 0 to 90 degrees"),
            (SceneErrors { match_window_px: 1001, ..none }, "at most 1000 pixels"),
            (SceneErrors { false_matches: 1.1, ..none }, "false matches has to be from 0 to 1"),
            (SceneErrors { background: 0.6, ..none }, "at most 1 together, not 1.1"),
            (SceneErrors { exposure_s: -1.0, ..none }, "from 0 to 1 s"),
        ] {
            assert!(refused(errors).contains(wanted), "{}", refused(errors));
        }
    }
}
