//! What a run reads: clouds, and beside them who is seen, by which camera, from which pose on.

use super::measures_source::{measures_of_height, read_measures};
use super::options::{BodyTrackOptions, SizeSource};
use crate::body::pose_file::{inside_limits, read_pose};
use crate::body::recording::DEFAULT_RATE_HZ;
use crate::body::tracking::BodyModelKind;
use crate::body::tracking::stream::stick_at;
use crate::body::tracking::stream_options::{check_part, check_rate};
use crate::body::{BodyPart, BodySize};
use crate::cloud::{CloudFolder, CloudSource, FoundSource, MAX_DISTANCE_M};
use crate::error::{Context, Result, ensure};
use crate::json_file::read_json;
use crate::stereo::{SeenStick, StereoCamera, TrueFrame, read_stick, read_truth};
use serde::{Deserialize, Serialize};
use sinew_core::math::unit;
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::BODY_ANGLES;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Where each input came from.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InputFiles {
    /// Folder of the clouds.
    pub clouds: PathBuf,
    /// The camera of depth images; none of clouds.
    pub camera: Option<PathBuf>,
    /// The person: what the files or the height say.
    pub skeleton: Option<PathBuf>,
    /// The first pose; found in the points where there is none.
    pub init: Option<PathBuf>,
    /// The stick.
    pub stick: Option<PathBuf>,
    /// The truth that errors are measured against.
    pub truth: Option<PathBuf>,
    /// The scene's own report: rate, camera and floor.
    pub scene: Option<PathBuf>,
}

/// All inputs of a run, checked.
#[derive(Debug, Clone)]
pub struct BodyInputs {
    /// The clouds.
    pub clouds: CloudFolder,
    /// What their files are, and which points count.
    pub source: CloudSource,
    /// Frames in a second.
    pub rate_hz: f32,
    /// How much of the body is tracked.
    pub part: BodyPart,
    /// The person.
    pub size: BodySize,
    /// Whether the size is to be estimated from the first seconds, beginning with `size`.
    pub estimates_size: bool,
    /// The first pose inside the limits; `None` if it has to be found in the points.
    pub first_rad: Option<[f32; BODY_ANGLES]>,
    /// What is known of the stick in each frame; empty but for the stick model.
    pub stick: BTreeMap<u64, StickSight>,
    /// What is true in each frame.
    pub truth: BTreeMap<u64, TrueFrame>,
    /// The floor, camera axes, metres.
    pub floor_y_m: Option<f32>,
    /// Where it all came from.
    pub files: InputFiles,
    /// What a user should know of how inputs were chosen.
    pub notes: Vec<String>,
    /// Doubts about them.
    pub warnings: Vec<String>,
}

/// The part of a scene's `run.json` that tracking needs.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
struct SceneReport {
    rate_hz: Option<f32>,
    camera: Option<StereoCamera>,
    floor_y_m: Option<f32>,
    body: Option<BodyPart>,
    /// Of what the scene was made.
    #[serde(default)]
    notes: Vec<String>,
}

impl BodyInputs {
    /// Reads everything but the clouds themselves.
    ///
    /// # Errors
    /// Names the file or option, the rule it broke, and the remedy.
    pub fn read(options: &BodyTrackOptions) -> Result<Self> {
        let beside = |name: &str| Some(options.folder.join(name)).filter(|path| path.is_file());
        let FoundSource { source, folder: clouds_folder, camera, mut notes } =
            FoundSource::find(&options.folder, options.camera.as_deref(), options.region())?;
        let clouds = source.open(&clouds_folder)?;
        let scene_file = beside("run.json");
        let scene = scene_file.as_deref().map_or_else(|| Ok(SceneReport::default()), read_scene)?;
        notes.extend(scene.notes);
        let rate_hz = options.rate_hz.or(scene.rate_hz).unwrap_or_else(|| {
            notes.push(format!("no run.json and no --rate say how fast the frames were taken; {DEFAULT_RATE_HZ} Hz"));
            DEFAULT_RATE_HZ
        });
        let skeleton = options.skeleton.clone().or_else(|| beside("body.json").filter(|_| options.height_m.is_none()));
        let size = size(options, skeleton.as_deref(), &mut notes)?;
        let init = options.init.clone().or_else(|| beside("first_pose.json"));
        let first_rad = init.as_deref().map(|path| first_pose(path, &size.measures, &mut notes)).transpose()?;
        let part = options.part.or(scene.body).unwrap_or_default();
        check_part(part, options.model)?;
        let mut stick_file = options.stick.clone();
        let mut stick = BTreeMap::new();
        if options.model == BodyModelKind::Stick {
            stick_file = stick_file.or_else(|| beside("stick.csv"));
            let path = stick_file.as_deref().with_context(|| {
                format!(
                    "--model stick needs the stick's ends; give --stick FILE, or put stick.csv into `{}`",
                    options.folder.display()
                )
            })?;
            stick = sights(&read_stick(path)?, scene.camera.as_ref(), &mut notes);
        }
        let truth_file = beside("truth.csv");
        let truth = truth_file.as_deref().map_or_else(|| Ok(Vec::new()), read_truth)?;
        Ok(Self {
            clouds,
            source,
            rate_hz,
            part,
            size,
            estimates_size: options.size.map_or(skeleton.is_none(), |source| source == SizeSource::Estimated),
            first_rad,
            stick,
            truth: truth.into_iter().map(|frame| (frame.frame, frame)).collect(),
            floor_y_m: scene.floor_y_m,
            files: InputFiles {
                clouds: clouds_folder,
                camera,
                skeleton,
                init,
                stick: stick_file,
                truth: truth_file,
                scene: scene_file,
            },
            notes,
            warnings: Vec::new(),
        })
    }
}

fn read_scene(path: &Path) -> Result<SceneReport> {
    let inner = || -> Result<SceneReport> {
        let scene: SceneReport = read_json(path)?;
        scene.rate_hz.map_or(Ok(()), |rate_hz| check_rate("rate_hz", rate_hz))?;
        if let Some(camera) = &scene.camera {
            let focal_px = camera.focal_px;
            ensure!(focal_px > 0.0 && focal_px.is_finite(), "focal_px has to be greater than zero, not {focal_px}");
        }
        ensure!(scene.floor_y_m.is_none_or(f32::is_finite), "floor_y_m has to be finite");
        Ok(scene)
    };
    inner().with_context(|| {
        format!("`{}` cannot be used; write it again, or take it away and give --rate", path.display())
    })
}

fn size(options: &BodyTrackOptions, file: Option<&Path>, notes: &mut Vec<String>) -> Result<BodySize> {
    if let Some(path) = file {
        return read_measures(path, options.partial, notes);
    }
    measures_of_height(options.height_m, notes)
}

/// Reads the first pose and brings it inside the limits.
fn first_pose(path: &Path, measures: &BodyMeasures, notes: &mut Vec<String>) -> Result<[f32; BODY_ANGLES]> {
    inside_limits(read_pose(path)?, measures, &path.display().to_string(), notes)
}

/// Ends where they are known in space, rays where only in the picture.
fn sights(stick: &[SeenStick], camera: Option<&StereoCamera>, notes: &mut Vec<String>) -> BTreeMap<u64, StickSight> {
    let (mut blind, mut far) = (0, 0);
    let mut sight = |seen: &SeenStick| {
        if let Some(ends_m) = seen.ends_m {
            if let Some(sight) = stick_at(ends_m) {
                return sight;
            }
            far += 1;
        }
        let Some([a, b]) = seen.ends_px else { return StickSight::Unseen };
        blind += usize::from(camera.is_none());
        let ray = |pixel| unit(camera?.direction(pixel));
        ray(a).zip(ray(b)).map_or(StickSight::Unseen, |(a, b)| StickSight::Rays([a, b]))
    };
    let sights = stick.iter().map(|seen| (seen.frame, sight(seen))).collect();
    if far > 0 {
        notes.push(format!("{far} frames have an end of the stick farther than {MAX_DISTANCE_M} m; it is not there"));
    }
    if blind > 0 {
        notes.push(format!(
            "{blind} frames know the stick in pixels only, and no run.json has a camera; it is unseen there"
        ));
    }
    sights
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::camera::Pixel;
    use sinew_core::math::Vec3;

    #[test]
    fn a_stick_is_ends_then_rays_then_unseen() {
        let camera = StereoCamera::default();
        let ends_m = [Vec3::new(0.4, 0.0, 2.0), Vec3::new(-0.4, 0.1, 2.0)];
        let ends_px = [Pixel::new(100.0, 200.0), Pixel::new(400.0, 210.0)];
        let all = [
            SeenStick { frame: 3, ends_m: Some(ends_m), ends_px: Some(ends_px) },
            SeenStick { frame: 4, ends_m: None, ends_px: Some(ends_px) },
            SeenStick { frame: 5, ends_m: None, ends_px: None },
            SeenStick { frame: 6, ends_m: Some([Vec3::repeat(1.0e30); 2]), ends_px: None },
        ];
        let mut notes = Vec::new();
        let found = sights(&all, Some(&camera), &mut notes);
        assert_eq!(found[&3], StickSight::Ends(ends_m));
        let StickSight::Rays([a, b]) = found[&4] else { panic!("{found:?}") };
        assert!((a.norm() - 1.0).abs() < 1.0e-6 && (b.norm() - 1.0).abs() < 1.0e-6 && a.x < 0.0 && b.x > 0.0);
        assert!(camera.project(&(a * 3.0)).unwrap().distance_px(ends_px[0]) < 1.0e-2);
        assert_eq!((found[&5], found[&6]), (StickSight::Unseen, StickSight::Unseen));
        assert!(notes.len() == 1 && notes[0].contains("farther than 1000 m"), "{notes:?}");
        assert_eq!(sights(&all, None, &mut notes)[&4], StickSight::Unseen);
        assert!(notes[2].contains("1 frames know"), "{notes:?}");
    }
}
