//! A person's size from the first seconds of a recording, before it is tracked.

use super::facing::begin_from_frames;
use super::frame_time::FrameTime;
use super::model_kind::BodyModelKind;
use super::seen_points::SeenPoints;
use super::size_estimate::SizeEstimate;
use super::stream::BodyStream;
use super::stream_options::BodyStreamOptions;
use super::tuning::BodyTuning;
use crate::body::BodySize;
use crate::error::Result;
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::skeleton::full_body::BODY_ANGLES;

/// How much of a recording is looked at, seconds. Chosen: some strides of a walk.
const SIZE_SECONDS: f32 = 3.0;
/// How often it is tracked, each time with the size found before.
const PASSES: usize = 2;

/// How many frames with points are looked at, of `rate_hz` in a second.
#[must_use]
pub fn size_frames(rate_hz: f32) -> usize {
    (SIZE_SECONDS * rate_hz).ceil().max(1.0) as usize
}

/// The options under which a size is estimated: those of `options` with the guided model, whose
/// mean is taken. A mode fits a wrong size as well as it can, and says less of the true one.
#[must_use]
pub fn sizing_options(options: &BodyStreamOptions) -> BodyStreamOptions {
    let model = BodyModelKind::Guided;
    let tuning = BodyTuning { refining_steps: 0, ..options.tuning };
    BodyStreamOptions { model, particles: model.default_particles(), tuning, ..options.clone() }
}

/// The size of the person of these frames, or `None` where they are no likelier with it than with
/// `start`, the likeliest one before they are seen. The frames are as a stream of
/// [`sizing_options`] sees them, with their numbers.
///
/// # Errors
/// Options out of their range; a first pose or a size that no body has.
pub fn size_from_frames(
    options: &BodyStreamOptions,
    start: &BodySize,
    first_rad: Option<[f32; BODY_ANGLES]>,
    frames: &[(u64, SeenPoints)],
) -> Result<Option<BodySize>> {
    let options = sizing_options(options);
    let first_rad = match first_rad {
        None if !frames.is_empty() => {
            Some(begin_from_frames(&mut BodyStream::new(options.clone(), *start, None)?, frames)?.angles_rad)
        }
        given => given,
    };
    let mut estimate = SizeEstimate::new(*start);
    for _ in 0..PASSES {
        estimate.forget();
        let stream = BodyStream::new(options.clone(), estimate.size(), first_rad)?;
        track(stream, frames, |stream, seen| {
            let filter = stream.filter();
            estimate.observe(filter.scene(), &filter.before_deadband().0, &seen.blocks);
            stream.resize(&estimate.size())
        })?;
    }
    let found = estimate.size();
    let log_likelihood = |size: &BodySize| log_likelihood(&options, size, first_rad, frames);
    let is_likelier = log_likelihood(&found)? > log_likelihood(start)?;
    Ok(is_likelier.then_some(found))
}

/// Log-likelihood of all frames' points about the tracked poses of a person of that size.
fn log_likelihood(
    options: &BodyStreamOptions,
    size: &BodySize,
    first_rad: Option<[f32; BODY_ANGLES]>,
    frames: &[(u64, SeenPoints)],
) -> Result<f32> {
    let mut sum = 0.0;
    track(BodyStream::new(options.clone(), *size, first_rad)?, frames, |stream, seen| {
        let scene = stream.filter().scene();
        let surface = scene.surface(&scene.posture(&stream.filter().before_deadband().0));
        sum += scene.likelihood.log_likelihood(&surface, &seen.blocks);
        Ok(())
    })?;
    Ok(sum)
}

/// Steps through the frames; `each` is called after those that were answered.
fn track(
    mut stream: BodyStream,
    frames: &[(u64, SeenPoints)],
    mut each: impl FnMut(&mut BodyStream, &SeenPoints) -> Result<()>,
) -> Result<()> {
    for (frame, seen) in frames {
        if stream.step(seen, FrameTime::Number(*frame), StickSight::Unseen)?.is_some() {
            each(&mut stream, seen)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::PointCloud;
    use crate::stereo::{SceneErrors, StereoOptions, StereoScene, stick_wave};
    use sinew_core::skeleton::BodyMeasures;
    use sinew_core::skeleton::full_body::{FEET, SHANKS, THIGHS, TRUNK};

    /// Someone with both arms on a stick, whose lengths are off by 5 % and whose radii by 15 %.
    fn scene(seed: u64) -> StereoScene {
        let errors = SceneErrors { radius_share: 0.15, length_share: 0.05, ..SceneErrors::default() };
        let mut recording = stick_wave(seed, 15.0, 1.0, 3.0).unwrap().recording;
        recording.joints_m.truncate(30);
        StereoScene::new(recording, StereoOptions { errors, seed, points: 1000, ..StereoOptions::default() }).unwrap()
    }

    fn frames(stream: &BodyStream, clouds_m: Vec<Vec<sinew_core::math::Vec3>>) -> Vec<(u64, SeenPoints)> {
        let numbered = clouds_m.into_iter().enumerate();
        numbered.map(|(at, cloud)| (at as u64, stream.seen(PointCloud::from_points(cloud), at as u64))).collect()
    }

    #[test]
    fn lengths_and_radii_come_nearer_to_the_true_ones() {
        let options = sizing_options(&BodyStreamOptions::default());
        // Of trunk, thighs, shanks and feet: sums of the squared errors of the logarithms.
        let (mut before, mut after) = (0.0, 0.0);
        for seed in 1..=2 {
            let scene = scene(seed);
            let given = BodySize::from(*scene.measures());
            let stream = BodyStream::new(options.clone(), given, None).unwrap();
            let first = scene.first_pose().unwrap().angles;
            let seen = frames(&stream, scene.clouds_m());
            let found = size_from_frames(&options, &given, Some(first), &seen).unwrap().unwrap();
            for bone in [TRUNK, THIGHS[0], SHANKS[0], FEET[0]] {
                let off = |size: &BodySize| (size.radii_m[bone] / scene.radii_m()[bone]).ln().powi(2);
                before += off(&given);
                after += off(&found);
            }
        }
        assert!((0.02..0.5).contains(&(after / before)), "{after} of {before}");
    }

    #[test]
    fn without_points_the_size_stays() {
        let options = sizing_options(&BodyStreamOptions::default());
        let start = BodySize::from(BodyMeasures::of_height(1.6).unwrap());
        assert_eq!(size_from_frames(&options, &start, None, &[]).unwrap(), None);
        let stream = BodyStream::new(options.clone(), start, None).unwrap();
        let empty = frames(&stream, vec![Vec::new(), Vec::new()]);
        assert_eq!(size_from_frames(&options, &start, None, &empty).unwrap(), None);
    }
}
