//! A body's capsules and skeleton over a frame's points, from the front and from the side.

use super::colour::{INK, of_side};
use super::lettering::Lettering;
use super::stroke::{Stroke, disc, line, tint};
use image::{Rgb, RgbImage, imageops};
use sinew_core::camera::Pixel;
use sinew_core::kinematics::forward::Posture;
use sinew_core::math::Vec3;
use sinew_core::skeleton::Side;
use sinew_core::skeleton::full_body::{BODY_ANGLES, BODY_BONES, BODY_JOINT_NAMES};

/// Size of one view, pixels.
const VIEW_PX: (u32, u32) = (300, 400);
const PIXELS_PER_METRE: f32 = 160.0;
/// Space around tiles, pixels.
const GAP_PX: u32 = 4;
pub(super) const BACKGROUND: Rgb<u8> = Rgb([32, 32, 36]);
pub(super) const PAPER: Rgb<u8> = Rgb([20, 20, 24]);
/// Points: pale yellow.
const POINTS: Rgb<u8> = Rgb([255, 236, 140]);
/// Trunk and head, which belong to no side.
const MIDDLE: Rgb<u8> = Rgb([150, 150, 158]);

/// A bone as it is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawnBone {
    /// Where it starts, metres in camera axes.
    pub start_m: Vec3,
    /// Where it ends, metres.
    pub end_m: Vec3,
    /// Radius of its capsule, metres; zero for a bone without flesh.
    pub radius_m: f32,
    /// The person's own side; `None` for trunk and head.
    pub side: Option<Side>,
}

/// All bones of a whole body, as thick as `radii_m` says.
#[must_use]
pub fn drawn_bones(posture: &Posture<BODY_BONES, BODY_ANGLES>, radii_m: &[f32; BODY_BONES]) -> Vec<DrawnBone> {
    let side = |name: &str| match name.get(..2) {
        Some("l_") => Some(Side::Left),
        Some("r_") => Some(Side::Right),
        _ => None,
    };
    let bone = |(index, name): (usize, &&str)| DrawnBone {
        start_m: posture.joints[index],
        end_m: posture.ends[index],
        radius_m: radii_m[index],
        side: side(name),
    };
    BODY_JOINT_NAMES.iter().enumerate().map(bone).collect()
}

/// Draws both views beside each other under `title`. One is as the camera looks (x, y), the other
/// from the picture's left with the camera on the left hand (z, y). No perspective; 160 pixels are
/// a metre, and the bones are in the middle.
#[must_use]
pub fn body_views(title: &str, points_m: &[Vec3], bones: &[DrawnBone]) -> RgbImage {
    let letters = Lettering::new(13.0);
    let title_px = letters.map_or(0, Lettering::line_height_px);
    let size = (2 * VIEW_PX.0 + GAP_PX, VIEW_PX.1 + title_px);
    let mut image = RgbImage::from_pixel(size.0, size.1, BACKGROUND);
    let middle = middle(bones);
    for (index, across) in [0, 2].into_iter().enumerate() {
        let view = View { across, middle };
        let corner = index as u32 * (VIEW_PX.0 + GAP_PX);
        imageops::replace(&mut image, &view.draw(points_m, bones), i64::from(corner), i64::from(title_px));
    }
    if let Some(letters) = letters {
        letters.draw(&mut image, (2, 0), &letters.fit(&format!("{title}: front"), VIEW_PX.0), INK);
        letters.draw(&mut image, ((VIEW_PX.0 + GAP_PX) as i32 + 2, 0), "side, camera to the left", INK);
    }
    image
}

/// Puts tiles of one size on a sheet of at most `columns` columns, row by row.
#[must_use]
pub fn sheet(tiles: &[RgbImage], columns: u32) -> RgbImage {
    let width = tiles.iter().map(RgbImage::width).max().unwrap_or(1) + GAP_PX;
    let height = tiles.iter().map(RgbImage::height).max().unwrap_or(1) + GAP_PX;
    let count = tiles.len().max(1) as u32;
    let columns = columns.clamp(1, count);
    let mut sheet =
        RgbImage::from_pixel(width * columns + GAP_PX, height * count.div_ceil(columns) + GAP_PX, BACKGROUND);
    for (place, tile) in (0..).zip(tiles) {
        let corner = (GAP_PX + width * (place % columns), GAP_PX + height * (place / columns));
        imageops::replace(&mut sheet, tile, i64::from(corner.0), i64::from(corner.1));
    }
    sheet
}

/// Middle of all that is finite of the bones' ends; the origin without any.
fn middle(bones: &[DrawnBone]) -> Vec3 {
    let ends = || bones.iter().map(|bone| bone.end_m).filter(|end| end.iter().all(|value| value.is_finite()));
    let Some(first) = ends().next() else { return Vec3::zeros() };
    let (low, high) = ends().fold((first, first), |(low, high), end| (low.inf(&end), high.sup(&end)));
    low * 0.5 + high * 0.5
}

/// One of the two looks: which axis goes to the right, and what is in the middle.
struct View {
    across: usize,
    middle: Vec3,
}

impl View {
    fn place(&self, point: &Vec3) -> Pixel {
        let off = (point - self.middle) * PIXELS_PER_METRE;
        Pixel::new(0.5 * VIEW_PX.0 as f32 + off[self.across], 0.5 * VIEW_PX.1 as f32 + off.y)
    }

    fn draw(&self, points_m: &[Vec3], bones: &[DrawnBone]) -> RgbImage {
        let mut image = RgbImage::from_pixel(VIEW_PX.0, VIEW_PX.1, PAPER);
        for bone in bones.iter().filter(|bone| bone.radius_m > 0.0) {
            let width_px = f64::from(2.0 * bone.radius_m * PIXELS_PER_METRE);
            let stroke = Stroke::new(colour(bone), width_px).with_opacity(0.35);
            line(&mut image, self.place(&bone.start_m), self.place(&bone.end_m), &stroke);
        }
        for point in points_m {
            let at = self.place(point);
            // Beside the picture, and where it is no number, nothing is tinted.
            if at.u_px >= 0.0 && at.v_px >= 0.0 {
                tint(&mut image, at.u_px as u32, at.v_px as u32, POINTS, 0.8);
            }
        }
        for bone in bones {
            let (start, end) = (self.place(&bone.start_m), self.place(&bone.end_m));
            line(&mut image, start, end, &Stroke::new(colour(bone), 2.0));
            disc(&mut image, end, 2.5, INK, 1.0);
        }
        image
    }
}

pub(super) fn colour(bone: &DrawnBone) -> Rgb<u8> {
    bone.side.map_or(MIDDLE, of_side)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::colour::{LEFT, RIGHT};
    use proptest::prelude::*;

    fn arm(side: Side, x: f32) -> DrawnBone {
        DrawnBone { start_m: Vec3::new(x, -0.3, 3.0), end_m: Vec3::new(x, 0.3, 3.0), radius_m: 0.05, side: Some(side) }
    }

    #[test]
    fn the_left_arm_of_who_faces_the_camera_is_on_the_right() {
        let image = body_views("frame 3", &[], &[arm(Side::Left, 0.5), arm(Side::Right, -0.5)]);
        let columns = |colour: Rgb<u8>| {
            let found = image.enumerate_pixels().filter(|(x, _, pixel)| *x < VIEW_PX.0 && **pixel == colour);
            found.map(|(x, ..)| x).collect::<Vec<_>>()
        };
        assert!(columns(LEFT).iter().all(|&x| x.abs_diff(230) < 10) && columns(LEFT).len() > 50);
        assert!(columns(RIGHT).iter().all(|&x| x.abs_diff(70) < 10) && columns(RIGHT).len() > 50);
    }

    #[test]
    fn points_lie_where_the_bones_are() {
        let points = [Vec3::new(0.5, 0.0, 2.5)];
        let (with, without) =
            (body_views("", &points, &[arm(Side::Left, 0.5)]), body_views("", &[], &[arm(Side::Left, 0.5)]));
        let changed: Vec<u32> =
            with.enumerate_pixels().zip(without.pixels()).filter(|((.., a), b)| a != b).map(|((x, ..), _)| x).collect();
        // Under the bone in front; half a metre nearer to the camera from the side.
        assert_eq!(changed, [VIEW_PX.0 + GAP_PX + 150 - 80]);
    }

    #[test]
    fn a_sheet_holds_its_tiles_row_by_row() {
        let tiles: Vec<RgbImage> = (0..5).map(|i| RgbImage::from_pixel(10, 8, Rgb([50 * i, 0, 0]))).collect();
        let sheet = sheet(&tiles, 3);
        assert_eq!(sheet.dimensions(), (3 * 14 + 4, 2 * 12 + 4));
        assert_eq!(sheet.get_pixel(4 + 14 + 3, 4 + 12 + 3)[0], 200);
        assert!(super::sheet(&[], 3).width() > 0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]
        #[test]
        fn nothing_makes_it_panic(points: Vec<[f32; 3]>, bones in prop::collection::vec(any::<[f32; 7]>(), 0..4)) {
            let points: Vec<Vec3> = points.into_iter().map(Vec3::from).collect();
            let bones: Vec<DrawnBone> = bones.into_iter().map(|b| DrawnBone {
                start_m: Vec3::new(b[0], b[1], b[2]),
                end_m: Vec3::new(b[3], b[4], b[5]),
                radius_m: b[6].min(1.0),
                side: None,
            }).collect();
            prop_assert_eq!(body_views("x", &points, &bones).width(), 2 * VIEW_PX.0 + GAP_PX);
        }
    }
}
