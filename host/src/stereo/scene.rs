//! A body before a stereo camera: the points of each frame, and what is true.

use super::camera::StereoCamera;
use super::capsule::Capsule;
use super::hidden::Hidden;
use super::markers::markers;
use super::patches::{Disc, Patches};
use super::visible::{VisiblePixel, capsules, visible_pixels};
use crate::body::{BodyJoints, BodyPart, BodyRecording, measure};
use crate::error::{Result, ensure};
use rayon::prelude::*;
use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;
use sinew_core::random::Stream;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::BODY_BONES;

/// Draws of a pixel for one point before the point is left out: nearly all of the body is behind
/// patches.
const MAX_TRIES: usize = 16;
/// Outliers fill the body's box with this much more at each side, metres.
const OUTLIER_MARGIN_M: f32 = 0.3;
/// No point comes nearer to the camera, metres.
const NEAREST_M: f32 = 0.2;
/// Maximum number of points of a frame.
pub const MAX_POINTS: usize = 1_000_000;

/// How a scene is seen.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct StereoOptions {
    /// The camera.
    pub camera: StereoCamera,
    /// How much of the body the camera sees.
    pub part: BodyPart,
    /// Points of a frame before hidden ones are left out, outliers included.
    pub points: usize,
    /// Share of the points that are outliers.
    pub outliers: f32,
    /// How many missing patches there are.
    pub patches: u32,
    /// Limbs without points.
    pub hidden: Vec<Hidden>,
    /// Seed of all that is random.
    pub seed: u64,
}

impl Default for StereoOptions {
    fn default() -> Self {
        Self {
            camera: StereoCamera::default(),
            part: BodyPart::Whole,
            points: 2000,
            outliers: 0.1,
            patches: 4,
            hidden: Vec::new(),
            seed: 1,
        }
    }
}

/// A recorded body before a stereo camera.
#[derive(Debug, Clone)]
pub struct StereoScene {
    recording: BodyRecording,
    measures: BodyMeasures,
    radii_m: [f32; BODY_BONES],
    options: StereoOptions,
    patches: Patches,
}

/// A point and the bone that it lies on; `None` is an outlier.
type BonePoint = (Vec3, Option<usize>);

impl StereoScene {
    /// The person of `recording`, as thick as their measures say.
    ///
    /// # Errors
    /// No frame, a share of outliers outside of 0 to 1, more points than [`MAX_POINTS`], a segment
    /// that no frame shows.
    pub fn new(recording: BodyRecording, options: StereoOptions) -> Result<Self> {
        let (outliers, points) = (options.outliers, options.points);
        ensure!((0.0..=1.0).contains(&outliers), "`outliers` has to be from 0 to 1, not {outliers}");
        ensure!(points <= MAX_POINTS, "`points` has to be at most {MAX_POINTS}, not {points}");
        ensure!(!recording.joints_m.is_empty(), "the recording has no frame");
        let measures = measure(&recording)?;
        let patches = Patches::new(options.seed, options.patches);
        Ok(Self { recording, measures, radii_m: options.part.radii_m(&measures), options, patches })
    }

    /// Number of frames, at least one.
    #[must_use]
    #[allow(clippy::len_without_is_empty)] // never empty
    pub fn len(&self) -> usize {
        self.recording.joints_m.len()
    }

    /// The true joints.
    #[must_use]
    pub fn recording(&self) -> &BodyRecording {
        &self.recording
    }

    /// The person's measures.
    #[must_use]
    pub fn measures(&self) -> &BodyMeasures {
        &self.measures
    }

    /// Radii of the capsules, metres.
    #[must_use]
    pub fn radii_m(&self) -> &[f32; BODY_BONES] {
        &self.radii_m
    }

    /// How the scene is seen.
    #[must_use]
    pub fn options(&self) -> &StereoOptions {
        &self.options
    }

    /// True joints of a frame.
    ///
    /// # Panics
    /// If `frame` is not below [`Self::len`].
    #[must_use]
    pub fn joints_m(&self, frame: usize) -> &BodyJoints {
        &self.recording.joints_m[frame]
    }

    /// True capsules of a frame.
    ///
    /// # Panics
    /// As [`Self::joints_m`].
    #[must_use]
    pub fn capsules(&self, frame: usize) -> Vec<Capsule> {
        capsules(self.joints_m(frame), &self.radii_m)
    }

    /// Virtual markers on the true surface of a frame, for PIK (34).
    ///
    /// # Panics
    /// As [`Self::joints_m`].
    #[must_use]
    pub fn markers_m(&self, frame: usize) -> Vec<Option<Vec3>> {
        markers(self.joints_m(frame), &self.radii_m)
    }

    /// What the camera measures in a frame: points in camera axes, metres. Each belongs to a stream
    /// of its own (seed, frame, index), so neither the order of frames nor a hidden limb
    /// changes the others.
    ///
    /// # Panics
    /// As [`Self::joints_m`].
    #[must_use]
    pub fn points_m(&self, frame: usize) -> Vec<Vec3> {
        let hides = |bone: usize| self.options.hidden.iter().any(|hidden| hidden.hides(bone, frame));
        let points = self.points_with_bones(frame).into_iter();
        points.filter(|(_, bone)| !bone.is_some_and(hides)).map(|(point, _)| point).collect()
    }

    /// [`Self::points_m`] of all frames.
    #[must_use]
    pub fn clouds_m(&self) -> Vec<Vec<Vec3>> {
        (0..self.len()).into_par_iter().map(|frame| self.points_m(frame)).collect()
    }

    fn points_with_bones(&self, frame: usize) -> Vec<BonePoint> {
        let capsules = self.capsules(frame);
        let seen = visible_pixels(&self.options.camera, &capsules);
        let Some(limits) = limits(&capsules) else { return Vec::new() };
        let discs = self.discs(frame, &seen);
        (0..self.options.points).filter_map(|index| self.point(frame, index, &seen, &discs, &limits)).collect()
    }

    fn discs(&self, frame: usize, seen: &[VisiblePixel]) -> Vec<Disc> {
        let mut low = Pixel::new(f32::INFINITY, f32::INFINITY);
        let mut high = Pixel::new(0.0, 0.0);
        for VisiblePixel { pixel, .. } in seen {
            low = Pixel::new(low.u_px.min(pixel.u_px), low.v_px.min(pixel.v_px));
            high = Pixel::new(high.u_px.max(pixel.u_px), high.v_px.max(pixel.v_px));
        }
        if seen.is_empty() {
            return Vec::new();
        }
        self.patches.discs(frame as f32 / self.recording.rate_hz, low, high)
    }

    fn point(
        &self,
        frame: usize,
        index: usize,
        seen: &[VisiblePixel],
        discs: &[Disc],
        [low, high]: &[Vec3; 2],
    ) -> Option<BonePoint> {
        let camera = &self.options.camera;
        let mut stream = Stream::new(self.options.seed, frame as u64, index as u32);
        if stream.uniform() < self.options.outliers {
            let share = Vec3::new(stream.uniform(), stream.uniform(), stream.uniform());
            return Some((low + (high - low).component_mul(&share), None));
        }
        for _ in 0..MAX_TRIES {
            let VisiblePixel { pixel, bone, depth_m } = *seen.get(stream.below(seen.len() as u32) as usize)?;
            if discs.iter().any(|disc| disc.holds(pixel)) {
                continue;
            }
            let focal_baseline = camera.focal_px * camera.baseline_m;
            let disparity_px = focal_baseline / depth_m + camera.disparity_std_px * stream.normal();
            let measured_m = focal_baseline / disparity_px;
            return (disparity_px > 0.0).then(|| (camera.direction(pixel) * measured_m, Some(bone)));
        }
        None
    }
}

/// The box that outliers fill.
fn limits(capsules: &[Capsule]) -> Option<[Vec3; 2]> {
    let margin = Vec3::repeat(OUTLIER_MARGIN_M);
    let ends = || capsules.iter().flat_map(|capsule| [capsule.start_m, capsule.end_m]);
    let mut low = ends().reduce(|a, b| a.inf(&b))? - margin;
    let mut high = ends().reduce(|a, b| a.sup(&b))? + margin;
    low.z = low.z.max(NEAREST_M);
    high.z = high.z.max(NEAREST_M);
    Some([low, high])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stereo::stick_wave;

    fn scene(options: StereoOptions) -> StereoScene {
        let mut recording = stick_wave(2, 15.0, 1.0, 3.0).unwrap().recording;
        recording.joints_m.truncate(30);
        StereoScene::new(recording, options).unwrap()
    }

    #[test]
    fn points_lie_on_the_visible_skin_up_to_the_depth_noise() {
        let scene = scene(StereoOptions { outliers: 0.0, points: 3000, ..StereoOptions::default() });
        for frame in [0, 20] {
            let (capsules, camera) = (scene.capsules(frame), &scene.options().camera);
            let (mut sum, mut count) = (0.0, 0.0_f32);
            for point in scene.points_m(frame) {
                let direction = point / point.z;
                let true_m = capsules.iter().filter_map(|capsule| capsule.entry(&direction)).reduce(f32::min).unwrap();
                let standardised = (point.z - true_m) / camera.depth_std_m(true_m);
                sum += standardised * standardised;
                count += 1.0;
            }
            assert!(count > 2900.0, "{count}");
            // The variance of n squares of standard normals is 2 n; depth is not quite linear in
            // disparity.
            assert!((sum / count - 1.0).abs() < 5.0 * (2.0 / count).sqrt(), "{}", sum / count);
        }
    }

    #[test]
    fn hiding_a_limb_takes_its_points_and_no_other() {
        let hidden: Hidden = "l_arm:3-5".parse().unwrap();
        let (all, hiding) = (
            scene(StereoOptions::default()),
            scene(StereoOptions { hidden: vec![hidden], ..StereoOptions::default() }),
        );
        assert_eq!(all.points_m(2), hiding.points_m(2));
        assert_eq!(all.points_m(6), hiding.points_m(6));
        let kept = all.points_with_bones(4).into_iter();
        let kept: Vec<Vec3> = kept.filter(|(_, bone)| !matches!(bone, Some(4 | 5))).map(|(point, _)| point).collect();
        assert_eq!(kept, hiding.points_m(4));
        let arm = all.points_m(4).len() - kept.len();
        assert!(arm > 40, "the arm was seen: {arm} points");
    }

    #[test]
    fn outliers_have_their_share_and_patches_hold_no_points() {
        let scene = scene(StereoOptions { outliers: 0.2, points: 5000, ..StereoOptions::default() });
        let points = scene.points_with_bones(7);
        let outliers = points.iter().filter(|(_, bone)| bone.is_none()).count() as f32 / 5000.0;
        assert!((outliers - 0.2).abs() < 4.0 * (0.2_f32 * 0.8 / 5000.0).sqrt(), "{outliers}");
        let seen = visible_pixels(&scene.options().camera, &scene.capsules(7));
        let discs = scene.discs(7, &seen);
        let behind = seen.iter().filter(|seen| discs.iter().any(|disc| disc.holds(seen.pixel))).count();
        assert!(behind > 100, "a patch covers some of the body: {behind} pixels");
        for (point, bone) in points {
            let pixel = scene.options().camera.project(&point).unwrap();
            assert!(bone.is_none() || discs.iter().all(|disc| disc.centre.distance_px(pixel) > disc.radius_px - 0.1));
        }
    }

    #[test]
    fn frames_may_be_asked_for_in_any_order_and_seeds_differ() {
        let (a, b) = (scene(StereoOptions::default()), scene(StereoOptions { seed: 2, ..StereoOptions::default() }));
        let later = a.points_m(9);
        let _ = a.points_m(1);
        assert_eq!(a.points_m(9), later);
        assert_ne!(b.points_m(9), later);
    }

    #[test]
    fn options_that_cannot_be_used_are_named() {
        let recording = stick_wave(2, 15.0, 1.0, 3.0).unwrap().recording;
        for (options, name) in [
            (StereoOptions { outliers: 1.5, ..StereoOptions::default() }, "outliers"),
            (StereoOptions { outliers: f32::NAN, ..StereoOptions::default() }, "outliers"),
            (StereoOptions { points: MAX_POINTS + 1, ..StereoOptions::default() }, "points"),
        ] {
            assert!(StereoScene::new(recording.clone(), options).unwrap_err().to_string().contains(name));
        }
        let empty = BodyRecording { rate_hz: 15.0, joints_m: Vec::new() };
        assert!(StereoScene::new(empty, StereoOptions::default()).unwrap_err().to_string().contains("no frame"));
    }
}
