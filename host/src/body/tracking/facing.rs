//! Which of two opposite ways a person faces: both are tracked for half a second.

use super::frame_time::{FrameTime, decision_frames};
use super::model_kind::BodyModelKind;
use super::seen_points::SeenPoints;
use super::start::FirstPose;
use super::stream::BodyStream;
use super::stream_options::BodyStreamOptions;
use crate::cloud::PointCloud;
use crate::error::Result;
use sinew_core::math::Vec3;
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::skeleton::full_body::BODY_ANGLES;

/// Begins `stream` with the pose found in the first of these numbered frames, or with its opposite.
/// The one by which the points of the first [`decision_frames`] are likelier wins, each tracked
/// with the guided model. The margin in the answer is the mean over all of these points.
///
/// # Errors
/// As [`BodyStream::begin_from`].
pub fn begin_from_frames(stream: &mut BodyStream, frames: &[(u64, SeenPoints)]) -> Result<FirstPose> {
    let frames = &frames[..frames.len().min(decision_frames(stream.options().rate_hz))];
    let first = stream.begin_from(frames.first().map_or(&[], |(_, seen)| &seen.points_m))?;
    if frames.len() < 2 {
        return Ok(first);
    }
    let decided = decided(stream, first, frames)?;
    stream.begin_at(decided.angles_rad)?;
    Ok(decided)
}

/// Whether someone upright is likelier in these points upside down than `first` is in them as they
/// are: then y points up, or the person stands on their hands. `first` and `frames` are those of
/// [`begin_from_frames`].
///
/// # Errors
/// As [`BodyStream::begin_from`].
pub fn is_upside_down(stream: &BodyStream, first: &FirstPose, frames: &[(u64, SeenPoints)]) -> Result<bool> {
    let turned = |(frame, seen): &(u64, SeenPoints)| {
        let points_m = seen.points_m.iter().map(|point_m| Vec3::new(-point_m.x, -point_m.y, point_m.z));
        (*frame, stream.seen(PointCloud::from_points(points_m), *frame))
    };
    let turned: Vec<_> = frames.iter().map(turned).collect();
    let mut upside_down = BodyStream::new(stream.options().clone(), *stream.size(), None)?;
    Ok(begin_from_frames(&mut upside_down, &turned)?.log_evidence > first.log_evidence)
}

/// The way by which the points of all frames are likelier, with the margin.
fn decided(stream: &BodyStream, first: FirstPose, frames: &[(u64, SeenPoints)]) -> Result<FirstPose> {
    let FirstPose { angles_rad, opposite_rad, .. } = first;
    let taken = log_evidence(stream, angles_rad, frames)?;
    let opposite = log_evidence(stream, opposite_rad, frames)?;
    let points: usize = frames.iter().map(|(_, seen)| seen.points_m.len()).sum();
    let facing_margin = (taken - opposite).abs() / points.max(1) as f32;
    let (angles_rad, opposite_rad) =
        if opposite > taken { (opposite_rad, angles_rad) } else { (angles_rad, opposite_rad) };
    Ok(FirstPose { angles_rad, opposite_rad, facing_margin, log_evidence: taken.max(opposite), ..first })
}

/// Summed log evidence of the frames, tracked from that pose.
fn log_evidence(stream: &BodyStream, first_rad: [f32; BODY_ANGLES], frames: &[(u64, SeenPoints)]) -> Result<f32> {
    let model = BodyModelKind::Guided;
    let options = BodyStreamOptions { model, particles: model.default_particles(), ..stream.options().clone() };
    let mut tracked = BodyStream::new(options, *stream.size(), Some(first_rad))?;
    let mut sum = 0.0;
    for (frame, seen) in frames {
        let estimate = tracked.step(seen, FrameTime::Number(*frame), StickSight::Unseen)?;
        sum += estimate.map_or(0.0, |estimate| estimate.log_evidence);
    }
    Ok(sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stereo::{StereoOptions, StereoScene, stick_wave};

    #[test]
    fn frames_take_back_the_wrong_way() {
        let mut recording = stick_wave(1, 15.0, 1.0, 3.0).unwrap().recording;
        recording.joints_m.truncate(8);
        let scene = StereoScene::new(recording, StereoOptions { points: 500, ..StereoOptions::default() }).unwrap();
        let mut stream = BodyStream::new(BodyStreamOptions::default(), *scene.measures(), None).unwrap();
        let seen = |(at, cloud_m)| (at, stream.seen(PointCloud::from_points(cloud_m), at));
        let frames: Vec<_> = (0..).zip(scene.clouds_m()).map(seen).collect();
        let found = begin_from_frames(&mut stream, &frames).unwrap();
        assert_eq!(stream.first_rad(), Some(found.angles_rad));
        let exchanged = FirstPose { angles_rad: found.opposite_rad, opposite_rad: found.angles_rad, ..found };
        assert_eq!(decided(&stream, exchanged, &frames).unwrap(), found);
        assert!(!found.is_facing_doubtful(), "{}", found.facing_margin);
    }

    #[test]
    fn clouds_whose_y_points_up_are_upside_down() {
        let mut recording = stick_wave(1, 15.0, 1.0, 3.0).unwrap().recording;
        recording.joints_m.truncate(1);
        let scene = StereoScene::new(recording, StereoOptions { points: 500, ..StereoOptions::default() }).unwrap();
        let mut stream = BodyStream::new(BodyStreamOptions::default(), *scene.measures(), None).unwrap();
        let mut is_upside_down = |x: f32, y: f32| {
            let seen_m =
                scene.points_m(0).into_iter().map(|point_m| Vec3::new(x * point_m.x, y * point_m.y, point_m.z));
            let frames = [(0, stream.seen(PointCloud::from_points(seen_m), 0))];
            let first = begin_from_frames(&mut stream, &frames).unwrap();
            is_upside_down(&stream, &first, &frames).unwrap()
        };
        assert_eq!([(1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(x, y)| is_upside_down(x, y)), [false, true, true]);
    }

    #[test]
    fn one_frame_is_enough_to_begin() {
        let mut stream = BodyStream::new(
            BodyStreamOptions::default(),
            sinew_core::skeleton::BodyMeasures::of_height(1.75).unwrap(),
            None,
        )
        .unwrap();
        assert_eq!(begin_from_frames(&mut stream, &[]).unwrap().facing_margin, 0.0);
        assert!(stream.first_rad().is_some());
    }
}
