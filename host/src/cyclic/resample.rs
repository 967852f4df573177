//! Another number of frames a second for joints in the plane.

use super::error::CyclicError;
use super::feet::{FOOT_POINTS, Feet};
use super::image_joints::{ImageJoints, JointFrame, Point};
use super::spline::CubicSpline;
use crate::motion::joint_names::JOINTS;

/// Maximum number of frames that are made; more is taken for a mistake in a rate.
const MAX_FRAMES: f64 = 1.0e7;
/// How near to a recorded frame a time counts as that frame, frames.
const SAME_FRAME: f64 = 1.0e-6;

/// `joints` at `to_hz` instead of `from_hz` frames a second. Frame f of the recording is
/// frame f times `to_hz` over `from_hz` of the result, rounded at the first one.
///
/// A rate that divides the other picks every n-th frame. Else each coordinate is a cubic spline
/// through each run of frames in which the joint was seen; between runs it stays missing.
///
/// # Errors
/// A rate that is not greater than zero, or more than ten million frames.
pub fn resample(joints: &ImageJoints, from_hz: f64, to_hz: f64) -> Result<ImageJoints, CyclicError> {
    for (name, rate) in [("rate of the recording", from_hz), ("rate", to_hz)] {
        if !(rate > 0.0 && rate.is_finite()) {
            return Err(CyclicError::parameter(name, format!("has to be greater than zero, not {rate}")));
        }
    }
    let (Some(first), Some(last)) = (joints.frames.first(), joints.frames.last()) else { return Ok(joints.clone()) };
    let step = from_hz / to_hz;
    let count = ((last.frame - first.frame) as f64 / step + SAME_FRAME).floor() + 1.0;
    if count > MAX_FRAMES {
        return Err(CyclicError::parameter(
            "rate",
            format!("{to_hz} gives {count} frames; at most {MAX_FRAMES} are made"),
        ));
    }
    let base = (first.frame as f64 / step).round() as u64;
    let mut frames: Vec<JointFrame> = (base..base + count as u64)
        .map(|frame| JointFrame { frame, joints: [None; JOINTS], feet: Feet::default() })
        .collect();
    for index in 0..POINTS {
        for run in runs(joints, index, first.frame) {
            let first_inside = ((run.start - SAME_FRAME) / step).ceil().max(0.0) as usize;
            for (number, frame) in frames.iter_mut().enumerate().skip(first_inside) {
                let place = number as f64 * step;
                if place > run.end + SAME_FRAME {
                    break;
                }
                *point_mut(frame, index) = Some(run.at(place));
            }
        }
    }
    // A frame that no joint was seen in, between frames that the recording leaves out, is left out
    // as well.
    frames.retain(|frame| frame.joints.iter().any(Option::is_some));
    Ok(ImageJoints { frames, unit: joints.unit })
}

/// Successive frames in which a joint was seen.
struct Run {
    /// First and last frame, from the recording's first one.
    start: f64,
    end: f64,
    points: Vec<Point>,
    /// Curves of x and y; none through a single point.
    curves: Option<[CubicSpline; 2]>,
}

impl Run {
    fn new(start: u64, points: Vec<Point>) -> Self {
        let places: Vec<f64> = (0..points.len()).map(|i| (start + i as u64) as f64).collect();
        let curve =
            |axis: usize| CubicSpline::natural(places.clone(), points.iter().map(|point| point[axis]).collect());
        let curves = curve(0).zip(curve(1)).map(|(x, y)| [x, y]);
        Self { start: start as f64, end: (start + points.len() as u64 - 1) as f64, points, curves }
    }

    fn at(&self, place: f64) -> Point {
        let nearest = place.round();
        let recorded = self.points.get((nearest - self.start).max(0.0) as usize);
        match (recorded, &self.curves) {
            (Some(point), _) if (place - nearest).abs() < SAME_FRAME => *point,
            (_, Some([x, y])) => [x.at(place), y.at(place)],
            _ => self.points[0],
        }
    }
}

/// Points of a frame: the joints, then heels and toes.
const POINTS: usize = JOINTS + FOOT_POINTS.len();

fn point(frame: &JointFrame, index: usize) -> Option<Point> {
    index.checked_sub(JOINTS).map_or_else(|| frame.joints[index], |foot| frame.feet.as_flattened()[foot])
}

fn point_mut(frame: &mut JointFrame, index: usize) -> &mut Option<Point> {
    match index.checked_sub(JOINTS) {
        None => &mut frame.joints[index],
        Some(foot) => &mut frame.feet.as_flattened_mut()[foot],
    }
}

fn runs(joints: &ImageJoints, index: usize, first_frame: u64) -> Vec<Run> {
    let mut runs = Vec::new();
    let mut open: Option<(u64, Vec<Point>)> = None;
    for frame in &joints.frames {
        let place = frame.frame - first_frame;
        let goes_on = open.as_ref().is_some_and(|(start, points)| start + points.len() as u64 == place);
        if !goes_on || point(frame, index).is_none() {
            runs.extend(open.take().map(|(start, points)| Run::new(start, points)));
        }
        if let Some(point) = point(frame, index) {
            open.get_or_insert_with(|| (place, Vec::new())).1.push(point);
        }
    }
    runs.extend(open.map(|(start, points)| Run::new(start, points)));
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn swinging(frames: impl Iterator<Item = u64>) -> ImageJoints {
        let frame = |frame: u64| {
            let time = frame as f64 * 0.2;
            let point = Some([time.sin(), time]);
            JointFrame { frame, joints: [point; JOINTS], feet: [[point; 2]; 2] }
        };
        ImageJoints { frames: frames.map(frame).collect(), unit: "m" }
    }

    #[test]
    fn half_the_rate_picks_every_second_frame() {
        let original = swinging(6..27);
        assert_eq!(resample(&original, 60.0, 60.0).unwrap(), original);
        let halved = resample(&original, 120.0, 60.0).unwrap();
        assert_eq!(halved.frames.len(), 11);
        for (index, frame) in halved.frames.iter().enumerate() {
            let recorded = &original.frames[2 * index];
            assert_eq!((frame.frame, frame.joints, frame.feet), (index as u64 + 3, recorded.joints, recorded.feet));
        }
    }

    #[test]
    fn another_rate_follows_the_curve_and_gaps_stay() {
        let original = swinging((0..40).filter(|frame| *frame != 20));
        let doubled = resample(&original, 30.0, 60.0).unwrap();
        for frame in doubled.frames.iter().filter(|frame| (4..36).contains(&(frame.frame / 2))) {
            let time = frame.frame as f64 * 0.1;
            let [x, y] = frame.joints[3].unwrap();
            assert!((x - time.sin()).abs() < 2.0e-3 && (y - time).abs() < 1.0e-9, "{time}: {x}");
        }
        let numbers: Vec<u64> = doubled.frames.iter().map(|frame| frame.frame).collect();
        assert!(!numbers.contains(&39) && !numbers.contains(&40) && !numbers.contains(&41) && numbers.contains(&42));
        assert_eq!(numbers.last(), Some(&78));
    }

    #[test]
    fn rates_that_are_none_are_refused() {
        for (from, to) in [(0.0, 60.0), (60.0, -1.0), (f64::NAN, 60.0), (60.0, 1.0e12)] {
            assert!(resample(&swinging(0..3), from, to).is_err(), "{from} {to}");
        }
    }
}
