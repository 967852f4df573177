//! A body before a stereo camera: the points of each frame, and what is true.

use super::camera::StereoCamera;
use super::capsule::Capsule;
use super::hidden::Hidden;
use super::markers::markers;
use super::patches::{Disc, Patches};
use super::scene_errors::{Match, SceneErrors};
use super::visible::{VisiblePixel, capsules, visible_pixels};
use crate::body::{BodyJoints, BodyPart, BodyRecording, FittedPose, fit_pose, measure};
use crate::error::{Result, ensure};
use rayon::prelude::*;
use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;
use sinew_core::random::Stream;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_BONES, BODY_PARENTS, body_radii_m, full_body};

/// Draws of a pixel for one point before the point is left out: nearly all of the body is behind
/// patches.
const MAX_TRIES: usize = 16;
/// Outliers fill the body's box with this much more at each side, metres.
const OUTLIER_MARGIN_M: f32 = 0.3;
/// The wall stands this far behind the farthest joint of the motion, metres.
/// Chosen: a person who stands before a wall without touching it.
const WALL_DISTANCE_M: f32 = 0.5;
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
    /// What else is wrong with the scene.
    pub errors: SceneErrors,
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
            errors: SceneErrors::default(),
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
    /// z of the wall behind the person.
    wall_m: f32,
}

/// What the points of one frame are drawn from.
struct SeenBody<'a> {
    frame: usize,
    pixels: &'a [VisiblePixel],
    discs: &'a [Disc],
    /// Corners of the body's rectangle in the picture.
    rectangle: [Pixel; 2],
    /// Corners of the body's box.
    limits: [Vec3; 2],
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
        let (errors, seed) = (options.errors, options.seed);
        errors.check(outliers)?;
        let measures = errors.given_measures(&measure(&recording)?, seed);
        let radii_m = errors.seen_radii_m(&options.part.fleshed(&body_radii_m(&measures)), seed);
        let patches = Patches::new(seed, options.patches);
        let depths_m = recording.joints_m.iter().flatten().flatten().map(|joint| joint.z);
        let wall_m = depths_m.fold(NEAREST_M, f32::max) + WALL_DISTANCE_M;
        Ok(Self { recording, measures, radii_m, options, patches, wall_m })
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

    /// The person's measures as a tracker is given them: with the errors of the options.
    #[must_use]
    pub fn measures(&self) -> &BodyMeasures {
        &self.measures
    }

    /// The first frame's pose as a tracker is given it: with the errors of the options.
    ///
    /// # Errors
    /// Measures that no body has.
    pub fn first_pose(&self) -> Result<FittedPose> {
        let (skeleton, joints) = (full_body(&self.measures)?, self.joints_m(0));
        let fitted = fit_pose(&skeleton, joints, None);
        let given = self.options.errors.given_pose(&skeleton, &fitted.angles, self.options.seed);
        Ok(if given == fitted.angles { fitted } else { FittedPose::of(&skeleton, joints, given) })
    }

    /// True radii of the capsules, metres.
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
        let pixels = visible_pixels(&self.options.camera, &capsules);
        let Some(limits) = limits(&capsules) else { return Vec::new() };
        let rectangle = rectangle(&pixels);
        let discs = self.discs(frame, &pixels, rectangle);
        let seen = SeenBody { frame, pixels: &pixels, discs: &discs, rectangle, limits };
        (0..self.options.points).filter_map(|index| self.point(index, &seen)).collect()
    }

    fn discs(&self, frame: usize, pixels: &[VisiblePixel], [low, high]: [Pixel; 2]) -> Vec<Disc> {
        if pixels.is_empty() {
            return Vec::new();
        }
        self.patches.discs(frame as f32 / self.recording.rate_hz, low, high)
    }

    fn point(&self, index: usize, seen: &SeenBody<'_>) -> Option<BonePoint> {
        let StereoOptions { seed, outliers, errors, .. } = self.options;
        let mut stream = Stream::new(seed, seen.frame as u64, index as u32);
        let kind = stream.uniform();
        if kind < outliers {
            let share = Vec3::new(stream.uniform(), stream.uniform(), stream.uniform());
            let [low, high] = seen.limits;
            return Some((low + (high - low).component_mul(&share), None));
        }
        if kind < outliers + errors.background {
            return Some((self.wall_point(seen, &mut stream)?, None));
        }
        for _ in 0..MAX_TRIES {
            let VisiblePixel { pixel, bone, depth_m } =
                *seen.pixels.get(stream.below(seen.pixels.len() as u32) as usize)?;
            if seen.discs.iter().any(|disc| disc.holds(pixel)) {
                continue;
            }
            if errors.exposure_s > 0.0 {
                let time_s = errors.exposure_s * (stream.uniform() - 0.5);
                let point_m = self.options.camera.direction(pixel) * depth_m;
                let moved_m = point_m + self.velocity_m_per_s(seen.frame, bone, &point_m) * time_s;
                let moved = self.options.camera.project(&moved_m)?;
                return Some((self.measured(seen, moved, moved_m.z, &mut stream)?, Some(bone)));
            }
            return Some((self.measured(seen, pixel, depth_m, &mut stream)?, Some(bone)));
        }
        None
    }

    /// Where the camera finds a point of the wall that the body does not hide.
    fn wall_point(&self, seen: &SeenBody<'_>, stream: &mut Stream) -> Option<Vec3> {
        let [low, high] = seen.rectangle;
        for _ in 0..MAX_TRIES {
            let between = |low: f32, high: f32, share: f32| (low + (high - low) * share).round();
            let u_px = between(low.u_px, high.u_px, stream.uniform());
            let pixel = Pixel::new(u_px, between(low.v_px, high.v_px, stream.uniform()));
            let is_hidden = is_seen(seen.pixels, pixel) || seen.discs.iter().any(|disc| disc.holds(pixel));
            if !is_hidden {
                return self.measured(seen, pixel, self.wall_m, stream);
            }
        }
        None
    }

    /// The point that the camera finds at `pixel`, `depth_m` away.
    fn measured(&self, seen: &SeenBody<'_>, pixel: Pixel, depth_m: f32, stream: &mut Stream) -> Option<Vec3> {
        let camera = &self.options.camera;
        let focal_baseline = camera.focal_px * camera.baseline_m;
        let frame = (self.options.seed, seen.frame as u64);
        let disparity_px = match self.options.errors.matched(frame, pixel, camera.width_px, stream) {
            Match::Noise(noise) => focal_baseline / depth_m + camera.disparity_std_px * noise,
            Match::False(share) => {
                let [far_px, near_px] = [seen.limits[1].z, seen.limits[0].z].map(|z_m| focal_baseline / z_m);
                far_px + (near_px - far_px) * share
            }
        };
        (disparity_px > 0.0).then(|| camera.direction(pixel) * (focal_baseline / disparity_px))
    }

    /// Velocity of a point that moves with a bone's two ends, from the frames beside this one.
    fn velocity_m_per_s(&self, frame: usize, bone: usize, point_m: &Vec3) -> Vec3 {
        let (before, after) = (frame.saturating_sub(1), (frame + 1).min(self.len() - 1));
        let time_s = (after - before) as f32 / self.recording.rate_hz;
        let velocity = |end: usize| Some((self.joints_m(after)[end]? - self.joints_m(before)[end]?) / time_s);
        let of_bone = || {
            let parent = usize::from(BODY_PARENTS[bone]?);
            let (start_m, end_m) = (self.joints_m(frame)[parent]?, self.joints_m(frame)[bone]?);
            let along_m = end_m - start_m;
            let share = ((point_m - start_m).dot(&along_m) / along_m.norm_squared().max(1.0e-12)).clamp(0.0, 1.0);
            Some(velocity(parent)? * (1.0 - share) + velocity(bone)? * share)
        };
        if after > before { of_bone().unwrap_or_else(Vec3::zeros) } else { Vec3::zeros() }
    }
}

/// Corners of the rectangle that the body takes in the picture.
fn rectangle(pixels: &[VisiblePixel]) -> [Pixel; 2] {
    let mut low = Pixel::new(f32::INFINITY, f32::INFINITY);
    let mut high = Pixel::new(0.0, 0.0);
    for VisiblePixel { pixel, .. } in pixels {
        low = Pixel::new(low.u_px.min(pixel.u_px), low.v_px.min(pixel.v_px));
        high = Pixel::new(high.u_px.max(pixel.u_px), high.v_px.max(pixel.v_px));
    }
    [low, high]
}

/// Whether `pixel` sees the body; `pixels` are in the order of rows.
fn is_seen(pixels: &[VisiblePixel], pixel: Pixel) -> bool {
    let row_by_row =
        |seen: &VisiblePixel| seen.pixel.v_px.total_cmp(&pixel.v_px).then(seen.pixel.u_px.total_cmp(&pixel.u_px));
    pixels.binary_search_by(row_by_row).is_ok()
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
        let discs = scene.discs(7, &seen, rectangle(&seen));
        let behind = seen.iter().filter(|seen| discs.iter().any(|disc| disc.holds(seen.pixel))).count();
        assert!(behind > 100, "a patch covers some of the body: {behind} pixels");
        for (point, bone) in points {
            let pixel = scene.options().camera.project(&point).unwrap();
            assert!(bone.is_none() || discs.iter().all(|disc| disc.centre.distance_px(pixel) > disc.radius_px - 0.1));
        }
    }

    #[test]
    fn false_matches_keep_their_pixels_and_have_their_share() {
        let errors = SceneErrors { match_window_px: 8, false_matches: 0.3, ..SceneErrors::default() };
        let options = StereoOptions { outliers: 0.0, points: 4000, patches: 0, ..StereoOptions::default() };
        let (plain, falsely) = (scene(options.clone()), scene(StereoOptions { errors, ..options }));
        let camera = &plain.options().camera;
        let (before, after) = (plain.points_m(5), falsely.points_m(5));
        assert_eq!(before.len(), after.len());
        let mut far = 0.0;
        for (a, b) in before.iter().zip(&after) {
            let [a_px, b_px] = [a, b].map(|point| camera.project(point).unwrap());
            assert!(a_px.distance_px(b_px) < 1.0e-2, "only the depth is wrong");
            far += f32::from(u8::from((a.z - b.z).abs() > 0.25));
        }
        // Windows are false all at once: some 400 of them cover the body. The box is 1.2 m deep.
        assert!((0.1..0.35).contains(&(far / 4000.0)), "{far}");
    }

    #[test]
    fn background_points_lie_on_the_wall_beside_the_body() {
        let errors = SceneErrors { background: 0.2, ..SceneErrors::default() };
        let scene = scene(StereoOptions { errors, outliers: 0.0, points: 5000, ..StereoOptions::default() });
        let camera = &scene.options().camera;
        let seen = visible_pixels(camera, &scene.capsules(7));
        let points = scene.points_with_bones(7);
        let wall: Vec<Vec3> = points.iter().filter(|(_, bone)| bone.is_none()).map(|(point, _)| *point).collect();
        let share = wall.len() as f32 / 5000.0;
        assert!((share - 0.2).abs() < 4.0 * (0.2_f32 * 0.8 / 5000.0).sqrt(), "{share}");
        let mean_m = wall.iter().map(|point| point.z).sum::<f32>() / wall.len() as f32;
        let std_m = camera.depth_std_m(scene.wall_m);
        // Depth is not quite linear in disparity: its mean is a little farther.
        assert!((mean_m - scene.wall_m).abs() < 4.0 * std_m / (wall.len() as f32).sqrt() + 0.01, "{mean_m}");
        for point in &wall {
            let pixel = camera.project(point).unwrap();
            let at = Pixel::new(pixel.u_px.round(), pixel.v_px.round());
            assert!(!is_seen(&seen, at), "the body hides it");
        }
    }

    #[test]
    fn an_exposure_smears_what_moves_by_its_way() {
        let smeared = |exposure_s: f32| {
            let errors = SceneErrors { exposure_s, ..SceneErrors::default() };
            let camera = StereoCamera { disparity_std_px: 0.0, ..StereoCamera::default() };
            scene(StereoOptions { errors, camera, outliers: 0.0, patches: 0, points: 4000, ..StereoOptions::default() })
        };
        let (sharp, blurred) = (smeared(0.0), smeared(0.1));
        let frame = 8;
        let (mut ways, mut wanted) = ([0.0; 2], [0.0; 2]);
        // Streams differ from the sharp scene's, so each point is compared with the body itself.
        for (scene, slot) in [(&sharp, 0), (&blurred, 1)] {
            for (point, bone) in scene.points_with_bones(frame) {
                let bone = bone.unwrap();
                let capsule = scene.capsules(frame).into_iter().find(|capsule| capsule.bone == bone).unwrap();
                let along = capsule.end_m - capsule.start_m;
                let share = ((point - capsule.start_m).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                let off = (point - capsule.start_m - along * share).norm() - capsule.radius_m;
                ways[slot] += off.abs();
                wanted[slot] += scene.velocity_m_per_s(frame, bone, &point).norm();
            }
        }
        let count = sharp.points_m(frame).len() as f32;
        assert!(ways[0] / count < 1.0e-3, "{}", ways[0] / count);
        // A point goes a quarter of the exposure's way on the mean, and part of it along the skin.
        let way_m = 0.025 * wanted[1] / count;
        assert!((0.2 * way_m..way_m).contains(&(ways[1] / count)), "{} of {way_m}", ways[1] / count);
    }

    #[test]
    fn measures_and_first_pose_are_given_with_their_errors() {
        let hard = scene(StereoOptions { errors: SceneErrors::HARD, ..StereoOptions::default() });
        let plain = scene(StereoOptions::default());
        let off = hard.measures().thigh_m / plain.measures().thigh_m - 1.0;
        assert!((off.abs() - 0.05).abs() < 1.0e-5, "{off}");
        let off = hard.radii_m()[1] / plain.radii_m()[1] - 1.0;
        assert!((off.abs() - 0.15).abs() < 1.0e-5, "{off}");
        let (plain_m, hard_m) = (plain.first_pose().unwrap().mean_m(), hard.first_pose().unwrap().mean_m());
        assert!(plain_m < 0.01 && hard_m > 0.05, "{plain_m} {hard_m}");
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
