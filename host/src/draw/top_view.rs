//! The scene from above, in a corner: a ray through the camera is a point in the image, and a line
//! only from elsewhere.

use super::arm_marks::{OverlayArm, Scale, lighter, outlined};
use super::colour::{BLOB, INK, SHADE, of_side};
use super::stroke::{Stroke, disc, line, tint_rectangle};
use image::{Rgb, RgbImage, imageops};
use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;
use sinew_core::tracker::arm::Status;

/// Smallest side of an image that has room for the view, pixels.
const SMALLEST_PX: u32 = 64;
/// Rim and lines that are neither arm nor ray.
const GREY: Rgb<u8> = Rgb([150, 150, 155]);

/// Draws x (to the right) and z (upwards) of joints and rays at the bottom right; nothing without
/// any.
pub fn draw(image: &mut RgbImage, arms: &[OverlayArm], scale: Scale) {
    let (width, height) = image.dimensions();
    let seen: Vec<&OverlayArm> = arms.iter().filter(|arm| arm.status != Status::Lost).collect();
    if width.min(height) < SMALLEST_PX || seen.iter().all(|arm| arm.joints_m.is_none() && arm.ray.is_none()) {
        return;
    }
    let panel_width = (width / 4).max(84.min(2 * width / 5));
    let panel_height = (panel_width * 11 / 10).min(height / 2);
    let corner = (width - panel_width, height - panel_height);
    let mut panel = imageops::crop_imm(image, corner.0, corner.1, panel_width, panel_height).to_image();
    tint_rectangle(&mut panel, (0, 0), (panel_width, panel_height), SHADE, 0.82);
    draw_panel(&mut panel, &seen, scale);
    imageops::replace(image, &panel, i64::from(corner.0), i64::from(corner.1));
}

/// Where a place in camera axes lies on the panel.
struct GroundMap {
    camera: (f32, f32),
    pixels_per_metre: f32,
}

impl GroundMap {
    fn new(panel: &RgbImage, arms: &[&OverlayArm], scale: Scale) -> Self {
        let (width, height) = (panel.width() as f32, panel.height() as f32);
        let joints = || arms.iter().filter_map(|arm| arm.joints_m).flatten();
        let greatest = |values: &mut dyn Iterator<Item = f32>| values.filter(|x| x.is_finite()).fold(0.0, f32::max);
        let half_width_m = round_up(1.2 * greatest(&mut joints().map(|joint| joint.x.abs())).max(0.25));
        let depth_m = round_up(1.2 * greatest(&mut joints().map(|joint| joint.z)).max(0.5));
        let camera = (0.5 * (width - 1.0), height - 1.0 - (8.0 * scale.factor) as f32);
        let rim_px = scale.letters.map_or(2, |letters| letters.line_height_px()) as f32;
        let pixels_per_metre = (0.5 * width / half_width_m).min((camera.1 - rim_px) / depth_m).max(0.0);
        Self { camera, pixels_per_metre }
    }

    fn place(&self, point: &Vec3) -> Pixel {
        let (x, z) = (point.x * self.pixels_per_metre, point.z * self.pixels_per_metre);
        Pixel::new(self.camera.0 + x, self.camera.1 - z)
    }
}

fn draw_panel(panel: &mut RgbImage, arms: &[&OverlayArm], scale: Scale) {
    let map = GroundMap::new(panel, arms, scale);
    let rim = Stroke::new(GREY, 1.0);
    let (right, bottom) = (panel.width() as f32 - 1.0, panel.height() as f32 - 1.0);
    line(panel, Pixel::new(0.0, 0.0), Pixel::new(right, 0.0), &rim);
    line(panel, Pixel::new(0.0, 0.0), Pixel::new(0.0, bottom), &rim);
    for ray in arms.iter().filter_map(|arm| arm.ray) {
        draw_ray(panel, &map, ray, scale);
    }
    for arm in arms {
        let Some(joints) = arm.joints_m else { continue };
        let joints = joints.map(|joint| map.place(&joint));
        let predicted = arm.status != Status::Tracking;
        let width_px = if predicted { 1.3 } else { 2.2 } * scale.factor;
        let stroke = Stroke::new(of_side(arm.side), width_px).with_dashes(predicted);
        outlined(panel, &joints, stroke, width_px + 1.5);
        for (joint, radius) in joints.iter().zip([0.8, 0.8, 1.2]) {
            disc(panel, *joint, radius * 2.4 * scale.factor, of_side(arm.side), 1.0);
        }
        disc(panel, joints[2], 1.2 * scale.factor, INK, 1.0);
    }
    draw_camera(panel, &map, scale);
    draw_scale_bar(panel, &map, scale);
    if let Some(letters) = scale.letters {
        let text = letters.fit("from above", panel.width().saturating_sub(6));
        letters.draw(panel, (4, 1), &text, INK);
    }
}

/// The whole ray, as far as it can be seen.
fn draw_ray(panel: &mut RgbImage, map: &GroundMap, [near, far]: [Vec3; 2], scale: Scale) {
    let direction = far - near;
    let seen_m = (panel.width() + panel.height()) as f32 / map.pixels_per_metre.max(1.0e-6);
    let length_m = (direction.x * direction.x + direction.z * direction.z).sqrt();
    let end = if length_m > 0.0 { near + direction * (seen_m / length_m) } else { far };
    let stroke = Stroke::new(BLOB, (1.1 * scale.factor).max(1.0)).with_opacity(0.9);
    line(panel, map.place(&near), map.place(&end), &stroke);
}

/// A small triangle that opens along the line of sight.
fn draw_camera(panel: &mut RgbImage, map: &GroundMap, scale: Scale) {
    let at =
        |x: f64, z: f64| Pixel::new(map.camera.0 + (x * scale.factor) as f32, map.camera.1 - (z * scale.factor) as f32);
    let stroke = Stroke::new(INK, (1.2 * scale.factor).max(1.0));
    let corners = [at(0.0, 0.0), at(-4.0, 6.0), at(4.0, 6.0), at(0.0, 0.0)];
    corners.windows(2).for_each(|side| line(panel, side[0], side[1], &stroke));
    disc(panel, at(0.0, 0.0), 1.6 * scale.factor, INK, 1.0);
}

/// A bar of a round length at the bottom left, with its length in metres.
fn draw_scale_bar(panel: &mut RgbImage, map: &GroundMap, scale: Scale) {
    let room_m = 0.4 * panel.width() as f32 / map.pixels_per_metre;
    let Some(length_m) = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0].into_iter().rfind(|length_m| *length_m <= room_m) else {
        return;
    };
    let y = panel.height() as f32 - 4.0 * scale.factor as f32;
    let ends = [Pixel::new(4.0, y), Pixel::new(4.0 + length_m * map.pixels_per_metre, y)];
    let stroke = Stroke::new(INK, (1.2 * scale.factor).max(1.0));
    line(panel, ends[0], ends[1], &stroke);
    for end in ends {
        let tick = 2.5 * scale.factor as f32;
        line(panel, Pixel::new(end.u_px, y - tick), Pixel::new(end.u_px, y + tick), &stroke);
    }
    if let Some(letters) = scale.letters {
        let top = y as i32 - letters.line_height_px() as i32 - 1;
        letters.draw(panel, (4, top), &format!("{length_m} m"), lighter(GREY));
    }
}

/// The next round number, so that the view keeps its scale over many frames.
fn round_up(length_m: f32) -> f32 {
    const STEPS_M: [f32; 12] = [0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 20.0];
    STEPS_M.into_iter().find(|step_m| *step_m >= length_m).unwrap_or(length_m)
}
