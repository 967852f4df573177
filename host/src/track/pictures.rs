//! The pictures of a run: an overlay a frame, and the contact sheet.

use super::arms::{ArmSet, ArmView};
use super::source::FrameSource;
use crate::draw::contact_sheet::ContactSheet;
use crate::draw::overlay::{Overlay, OverlayArm, OverlayBlob, draw};
use crate::error::Result;
use crate::frames::FrameView;
use crate::images::load_rgb;
use crate::output::OutputDir;
use crate::wording::{side_name, status_name};
use image::RgbImage;
use rayon::prelude::*;
use sinew_core::camera::{Camera, Pixel};
use sinew_core::math::Vec3;
use sinew_core::tracker::arm::{MAX_CANDIDATES, Particle};
use sinew_core::vision::components::BoundingBox;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Thumbnails on the contact sheet.
const SHEET_TILES: usize = 20;
/// Particles whose whole arms are drawn.
const BEST_ARMS: usize = 3;
/// How far behind the hand the ray is drawn, as a factor of the hand's depth.
const RAY_DEPTHS: f32 = 1.2;

/// What one frame's overlay shows.
#[derive(Debug)]
pub struct Shot {
    /// Number of the frame.
    pub frame: usize,
    /// Its name.
    pub name: String,
    /// The frame.
    pub image: RgbImage,
    /// What the front end found.
    pub view: FrameView,
    /// What the tracker made of it.
    pub arms: Vec<ArmView>,
}

/// Draws overlays and keeps the thumbnails for the contact sheet.
#[derive(Debug)]
pub struct Pictures {
    names: Names,
    folder: OutputDir,
    sheet: ContactSheet,
}

impl Pictures {
    /// Overlays of `frames` in `folder`.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub(super) fn new(frames: &FrameSource, folder: OutputDir) -> Result<Self> {
        let sheet = ContactSheet::new(frames.count(), SHEET_TILES)?;
        let names = match frames {
            FrameSource::Folder(frames) => Names::Files(overlay_names(frames.files())),
            FrameSource::Video(_) => Names::Same,
        };
        Ok(Self { names, folder, sheet })
    }

    /// Draws and writes the overlays of some frames, in parallel; what is written does not depend
    /// on the threads.
    ///
    /// # Errors
    /// The first frame whose overlay cannot be written; those of the others are.
    pub fn draw(&mut self, shots: &[Shot], arms: &ArmSet) -> Result<()> {
        let written: Vec<Result<Option<RgbImage>>> = shots
            .par_iter()
            .map(|shot| {
                let overlay = self.names.of_overlay(shot.frame, &shot.name);
                let picture = draw_shot(shot, &shot.name, arms);
                self.folder.write_frame_png(overlay, &picture)?;
                Ok(self.sheet.wants(shot.frame).then_some(picture))
            })
            .collect();
        for (shot, picture) in shots.iter().zip(written) {
            if let Some(picture) = picture? {
                self.sheet.add(shot.frame, &picture);
            }
        }
        Ok(())
    }

    /// Takes the thumbnails of frames that were drawn before from their overlays.
    ///
    /// # Errors
    /// An overlay that cannot be read.
    pub fn take_up(&mut self, frames: impl Iterator<Item = (usize, String)>) -> Result<()> {
        for (frame, name) in frames {
            if !self.sheet.wants(frame) {
                continue;
            }
            let overlay = load_rgb(&self.folder.join(self.names.of_overlay(frame, &name)))?;
            self.sheet.add(frame, &overlay);
        }
        Ok(())
    }

    /// The contact sheet of all frames that were drawn.
    #[must_use]
    pub fn contact_sheet(self) -> RgbImage {
        self.sheet.finish()
    }
}

/// How overlays are named.
#[derive(Debug)]
enum Names {
    /// After the files of a folder: the name of each and of its overlay.
    Files(Vec<(String, String)>),
    /// As the frames, which are named like pictures.
    Same,
}

impl Names {
    fn of_overlay<'a>(&'a self, frame: usize, name: &'a str) -> &'a str {
        match self {
            Self::Files(names) => names.get(frame).map_or(name, |(_, overlay)| overlay),
            Self::Same => name,
        }
    }
}

/// File name and overlay name of each frame: the stem with `.png`, or the whole name where two
/// files share a stem.
pub(crate) fn overlay_names(files: &[PathBuf]) -> Vec<(String, String)> {
    let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let stem = |file: &Path| part(file.file_stem());
    let mut uses: BTreeMap<String, usize> = BTreeMap::new();
    for file in files {
        *uses.entry(stem(file).to_lowercase()).or_default() += 1;
    }
    let name = |file: &PathBuf| {
        let (name, stem) = (part(file.file_name()), stem(file));
        let base = if uses[&stem.to_lowercase()] == 1 { &stem } else { &name };
        let overlay = format!("{base}.png");
        (name, overlay)
    };
    files.iter().map(name).collect()
}

fn draw_shot(shot: &Shot, file: &str, arms: &ArmSet) -> RgbImage {
    let drawn: Vec<OverlayArm> = shot.arms.iter().map(|arm| overlay_arm(arm, arms)).collect();
    let states: Vec<String> = shot
        .arms
        .iter()
        .map(|arm| format!("{} {}", side_name(arm.estimate.side), status_name(arm.estimate.status)))
        .collect();
    let edges: Vec<(u16, u16)> = shot.view.edges.iter().map(|edge| (edge.u, edge.v)).collect();
    let blobs = shot.view.blobs.iter();
    let blobs = blobs.map(|entry| overlay_blob(entry.blob.centroid, entry.blob.bounding_box, entry.likelihood));
    let of_lines =
        shot.view.line_blobs.iter().map(|blob| overlay_blob(blob.centroid, blob.bounding_box, blob.moment_likelihood));
    let blobs: Vec<OverlayBlob> = blobs.chain(of_lines).take(MAX_CANDIDATES).collect();
    let caption = format!("frame {}  {file}  {}", shot.frame, states.join(", "));
    draw(&shot.image, &Overlay { arms: &drawn, blobs: &blobs, edges: &edges, mask_outline: None, caption: &caption })
}

fn overlay_blob(centre: Pixel, bounds: BoundingBox, likelihood: f32) -> OverlayBlob {
    let corner = [u32::from(bounds.min_u), u32::from(bounds.min_v)];
    let bounding_box = [corner[0], corner[1], bounds.width_px(), bounds.height_px()];
    OverlayBlob { centre, bounding_box, likelihood }
}

fn overlay_arm(arm: &ArmView, arms: &ArmSet) -> OverlayArm {
    let estimate = &arm.estimate;
    let joints_m = [estimate.joints.shoulder_m, estimate.joints.elbow_m, estimate.joints.hand_m];
    let camera = arms.models().first().map(|model| *model.camera());
    let hand = |particle: &Particle| camera.and_then(|camera| camera.project(&particle.hand_m));
    let mut heaviest: Vec<&(Particle, f32)> = arm.particles.iter().collect();
    // Stable, so that the first of equals stays first.
    heaviest.sort_by(|a, b| b.1.total_cmp(&a.1));
    let best = heaviest.iter().take(BEST_ARMS);
    OverlayArm {
        side: estimate.side,
        status: estimate.status,
        joints_px: arms.joints_px(joints_m),
        joints_m: Some(joints_m),
        particle_hands: arm
            .particles
            .iter()
            .filter_map(|(particle, weight)| Some((hand(particle)?, *weight)))
            .collect(),
        best_arms: best
            .filter_map(|(particle, _)| arms.joints_px([joints_m[0], particle.elbow_m, particle.hand_m]))
            .collect(),
        ray: camera.zip(arm.carrier).and_then(|(camera, centre)| ray(&camera, centre, joints_m[2].z)),
    }
}

/// The camera's centre and the point of the ray through `centre` a little behind the hand, metres.
fn ray(camera: &Camera, centre: Pixel, hand_depth_m: f32) -> Option<[Vec3; 2]> {
    let direction = camera.back_project(centre).direction;
    let far = direction * (RAY_DEPTHS * hand_depth_m / direction.z);
    (direction.z > 0.0).then_some([Vec3::zeros(), far])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_one_stem_get_overlays_of_their_own() {
        let files = ["a/x.png", "a/X.jpg", "a/y.JPG"].map(PathBuf::from);
        let overlays: Vec<String> = overlay_names(&files).into_iter().map(|(_, overlay)| overlay).collect();
        assert_eq!(overlays, ["x.png.png", "X.jpg.png", "y.png"]);
    }

    #[test]
    fn the_ray_ends_behind_the_hand_on_the_blobs_line_of_sight() {
        let camera = Camera::from_field_of_view(640, 480, 1.0).unwrap();
        let [near, far] = ray(&camera, Pixel::new(100.0, 300.0), 0.5).unwrap();
        assert_eq!(near, Vec3::zeros());
        assert!((far.z - 0.6).abs() < 1.0e-5);
        assert!(camera.project(&far).unwrap().distance_px(Pixel::new(100.0, 300.0)) < 0.01);
    }
}
