//! Keypoints of a made-up person who passes a camera: what a pose detector would write, for trying
//! the commands without a video.

use super::angle_table::ANGLES;
use super::error::CyclicError;
use super::export::trc::{JointPositions, joint_positions, standard_lengths_m};
use super::facing::Facing;
use super::synthetic_person::SyntheticPerson;
use crate::motion::joint_names::JOINTS;
use sinew_core::random::Stream;
use sinew_core::skeleton::stick_figure::HUMAN;
use std::fmt::Write as _;

/// Height of the person, metres; only ratios of lengths matter.
const HEIGHT_M: f64 = 1.75;
/// Both ankles, by the order of the joints.
const ANKLES: [usize; 2] = [10, 13];
/// Free room at the rims of the picture, in heights of the person.
const MARGIN: f64 = 0.6;
/// Range of the confidences, which say nothing: evenly drawn.
const CONFIDENCE: [f32; 2] = [0.6, 1.0];
/// Index of the random numbers of a frame; 0 and 1 are the person's and their angles'.
const DRAWS: u32 = 2;

/// How a person is filmed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filming {
    /// Number of frames.
    pub frames: u32,
    /// Frames per second.
    pub rate_hz: f64,
    /// Height of the person in the picture, pixels.
    pub height_px: f64,
    /// Which way they go.
    pub facing: Facing,
    /// Standard deviation of each coordinate, pixels.
    pub noise_px: f64,
    /// Share of the keypoints that are missing.
    pub missing_share: f64,
    /// Seed of noise and gaps.
    pub seed: u64,
}

impl Filming {
    /// A person filmed for `seconds`, all else as in `like`.
    ///
    /// # Errors
    /// Names the value out of range as the command's option does.
    pub fn lasting(seconds: f64, like: Self) -> Result<Self, CyclicError> {
        let Self { rate_hz, height_px, noise_px, missing_share, .. } = like;
        let rules = [
            ("seconds", (0.1..=36_000.0).contains(&seconds), "from 0.1 to 36000".to_owned(), seconds),
            ("rate", (1.0..=1000.0).contains(&rate_hz), "from 1 to 1000 Hz".to_owned(), rate_hz),
            ("height-px", (10.0..=10_000.0).contains(&height_px), "from 10 to 10000 pixels".to_owned(), height_px),
            ("sigma-px", (0.0..=height_px).contains(&noise_px), format!("from 0 to {height_px} pixels"), noise_px),
            ("missing", (0.0..1.0).contains(&missing_share), "in [0, 1)".to_owned(), missing_share),
        ];
        match rules.into_iter().find(|(_, is_kept, ..)| !is_kept) {
            Some((name, _, range, value)) => {
                Err(CyclicError::parameter(name, format!("has to lie {range}, not {value}")))
            }
            None => Ok(Self { frames: (seconds * rate_hz).round().max(1.0) as u32, ..like }),
        }
    }
}

/// A recording of keypoints.
#[derive(Debug, Clone, PartialEq)]
pub struct FilmedPerson {
    /// Joints of each frame without noise, pixels: x right, y down.
    pub joints_px: Vec<JointPositions>,
    /// Width and height of a picture that holds all of them, pixels.
    pub size_px: [u32; 2],
}

impl FilmedPerson {
    /// Films `person`. The lower ankle is on the floor. The hips go as fast as that ankle goes
    /// back, on the average, so that feet on the floor stay about where they are.
    #[must_use]
    pub fn film(person: &SyntheticPerson<'_>, filming: &Filming) -> Self {
        let lengths = standard_lengths_m(HEIGHT_M);
        let poses: Vec<JointPositions> = (0..filming.frames)
            .map(|frame| joint_positions(Some([0.0; 2]), &lengths, &person.pose_rad(f64::from(frame)).map(Some)))
            .collect();
        let speed_m = speed_m(person, &lengths);
        let scale_px = filming.height_px / HEIGHT_M;
        let width_m = f64::from(filming.frames) * speed_m.abs() + 2.0 * MARGIN * HEIGHT_M;
        let floor_px = (1.0 + MARGIN / 2.0) * filming.height_px;
        let size_px = [width_m * scale_px, floor_px + MARGIN / 2.0 * filming.height_px].map(|side| side.ceil() as u32);
        let start_m = MARGIN * HEIGHT_M + if speed_m < 0.0 { width_m - 2.0 * MARGIN * HEIGHT_M } else { 0.0 };
        let place = |(frame, joints): (usize, &JointPositions)| {
            let lowest_m = ANKLES.iter().filter_map(|ankle| joints[*ankle]).map(|[_, y]| y).fold(0.0, f64::max);
            joints.map(|joint| {
                let [x, y] = joint?;
                let x_px = (start_m + frame as f64 * speed_m + x) * scale_px;
                let x_px = if filming.facing == Facing::Left { f64::from(size_px[0]) - x_px } else { x_px };
                Some([x_px, floor_px + (y - lowest_m) * scale_px])
            })
        };
        Self { joints_px: poses.iter().enumerate().map(place).collect(), size_px }
    }

    /// What a detector would find of each joint: x and y in pixels, and its confidence.
    /// `None` where it finds nothing.
    #[must_use]
    pub fn detected(&self, filming: &Filming) -> Vec<[Option<[f64; 3]>; JOINTS]> {
        let detected = |(frame, joints): (u64, &JointPositions)| {
            let mut stream = Stream::new(filming.seed, frame, DRAWS);
            joints.map(|joint| {
                let noise_px = [(); 2].map(|()| filming.noise_px * f64::from(stream.normal()));
                let confidence = CONFIDENCE[0] + (CONFIDENCE[1] - CONFIDENCE[0]) * stream.uniform();
                let is_seen = f64::from(stream.uniform()) >= filming.missing_share;
                let [x, y] = joint.filter(|_| is_seen)?;
                Some([x + noise_px[0], y + noise_px[1], f64::from(confidence)])
            })
        };
        (0..).zip(&self.joints_px).map(detected).collect()
    }

    /// The table that a detector would write: `frame`, `time_s`, and place and confidence of each
    /// joint.
    #[must_use]
    pub fn to_csv(&self, filming: &Filming) -> String {
        let names = std::iter::once("hip_center").chain(HUMAN.angle_names()).take(JOINTS);
        let mut text = "frame,time_s".to_owned();
        // Writing to a string cannot fail.
        text.extend(names.map(|name| format!(",{name}_x_px,{name}_y_px,{name}_confidence")));
        text.push('\n');
        for (frame, joints) in (0_u64..).zip(self.detected(filming)) {
            let _ = write!(text, "{frame},{:.6}", frame as f64 / filming.rate_hz);
            for joint in joints {
                let _ = match joint {
                    Some([x, y, confidence]) => write!(text, ",{x:.2},{y:.2},{confidence:.2}"),
                    None => write!(text, ",,,"),
                };
            }
            text.push('\n');
        }
        text
    }
}

/// How far the hips go in a frame, metres.
fn speed_m(person: &SyntheticPerson<'_>, lengths: &[f64; ANGLES]) -> f64 {
    let frames = person.cycle_frames() as u32;
    let ankles = |frame: u32| {
        let joints = joint_positions(Some([0.0; 2]), lengths, &person.pose_rad(f64::from(frame)).map(Some));
        ANKLES.map(|ankle| joints[ankle].unwrap_or_default())
    };
    let back = |frame: u32| {
        let (now, next) = (ankles(frame), ankles(frame + 1));
        let lower = usize::from(now[1][1] > now[0][1]);
        now[lower][0] - next[lower][0]
    };
    (0..frames).map(back).sum::<f64>() / f64::from(frames)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::CyclicModel;

    const FILMING: Filming = Filming {
        frames: 180,
        rate_hz: 30.0,
        height_px: 400.0,
        facing: Facing::Right,
        noise_px: 2.0,
        missing_share: 0.1,
        seed: 4,
    };

    fn film(filming: &Filming) -> FilmedPerson {
        let model = CyclicModel::from_option("walking").unwrap();
        FilmedPerson::film(&SyntheticPerson::draw(&model, filming.rate_hz, 4).unwrap(), filming)
    }

    #[test]
    fn all_joints_lie_in_the_picture_and_the_person_walks_as_people_do() {
        let filmed = film(&FILMING);
        let [width, height] = filmed.size_px.map(f64::from);
        let inside = |[x, y]: &[f64; 2]| (0.0..width).contains(x) && (0.0..height).contains(y);
        assert!(filmed.joints_px.iter().flatten().all(|joint| joint.as_ref().is_some_and(inside)));
        let hips = |frame: usize| filmed.joints_px[frame][0].unwrap()[0];
        let speed_m_per_s = (hips(179) - hips(0)) / 179.0 * 30.0 / 400.0 * HEIGHT_M;
        assert!((0.8..1.8).contains(&speed_m_per_s), "{speed_m_per_s}");
    }

    #[test]
    fn who_goes_left_is_the_mirror_image() {
        let (right, left) = (film(&FILMING), film(&Filming { facing: Facing::Left, ..FILMING }));
        for (right_px, left_px) in right.joints_px.iter().flatten().zip(left.joints_px.iter().flatten()) {
            let ([x, y], [u, v]) = (right_px.unwrap(), left_px.unwrap());
            assert!((x + u - f64::from(right.size_px[0])).abs() < 1.0e-6 && y == v);
        }
    }

    #[test]
    fn noise_and_gaps_are_as_wide_as_was_asked_for() {
        let filmed = film(&FILMING);
        let text = filmed.to_csv(&FILMING);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let (mut errors_px, mut cells) = (Vec::new(), 0);
        for (row, joints) in reader.records().map(Result::unwrap).zip(&filmed.joints_px) {
            for (joint, place) in joints.iter().enumerate() {
                cells += 1;
                let x_px: Result<f64, _> = row[2 + 3 * joint].parse();
                errors_px.extend(x_px.ok().map(|x_px| x_px - place.unwrap()[0]));
            }
        }
        let missing = 1.0 - errors_px.len() as f64 / f64::from(cells);
        let std_px = (errors_px.iter().map(|error| error * error).sum::<f64>() / errors_px.len() as f64).sqrt();
        assert!((0.08..0.12).contains(&missing) && (1.9..2.1).contains(&std_px), "{missing} {std_px}");
    }
}
