//! Many poses of one body over each other: what a motion model draws.

use super::body_views::{BACKGROUND, DrawnBone, PAPER, colour};
use super::colour::INK;
use super::lettering::Lettering;
use super::stroke::{Stroke, line};
use image::{RgbImage, imageops};
use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;

/// Width of a panel, pixels.
const WIDTH_PX: u32 = 460;
/// Height of the drawing of a panel, pixels.
const HEIGHT_PX: u32 = 460;
/// Space left around the bodies, pixels.
const MARGIN_PX: f32 = 14.0;
/// The largest scale, pixels a metre.
const LARGEST_SCALE: f32 = 500.0;
/// Space between panels, pixels.
const GAP_PX: u32 = 4;
/// Size of letters, pixels.
const LETTERS_PX: f32 = 13.0;

/// Where one looks from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// As the camera looks: x to the right.
    Front,
    /// From the picture's left, with the camera to the left: z to the right.
    Side,
}

/// Poses that are drawn over each other.
#[derive(Debug, Clone)]
pub struct PoseFan<'a> {
    /// What stands above.
    pub title: &'a str,
    /// Lines below.
    pub notes: &'a [String],
    /// The bones of each pose.
    pub poses: &'a [Vec<DrawnBone>],
    /// Where one looks from.
    pub look: Look,
}

/// Draws panels beside each other, all at the scale at which each of them fits; no perspective.
#[must_use]
pub fn pose_fans(panels: &[PoseFan]) -> RgbImage {
    let letters = Lettering::new(LETTERS_PX);
    let line_px = letters.map_or(0, Lettering::line_height_px);
    let notes = panels.iter().map(|panel| panel.notes.len() as u32).max().unwrap_or(0);
    let count = panels.len().max(1) as u32;
    let size = (count * (WIDTH_PX + GAP_PX) - GAP_PX, HEIGHT_PX + line_px * (notes + 1));
    let mut image = RgbImage::from_pixel(size.0, size.1, BACKGROUND);
    let scale = panels.iter().map(fitting_scale).fold(LARGEST_SCALE, f32::min);
    for (index, panel) in (0..).zip(panels) {
        let left = index * (WIDTH_PX + GAP_PX);
        imageops::replace(&mut image, &drawing(panel, scale), i64::from(left), i64::from(line_px));
        if let Some(letters) = letters {
            let at = |row: u32| (left as i32 + 3, row as i32);
            letters.draw(&mut image, at(0), &letters.fit(panel.title, WIDTH_PX), INK);
            for (row, note) in (0..).zip(panel.notes) {
                letters.draw(&mut image, at(line_px + HEIGHT_PX + row * line_px), &letters.fit(note, WIDTH_PX), INK);
            }
        }
    }
    image
}

fn across(look: Look) -> usize {
    match look {
        Look::Front => 0,
        Look::Side => 2,
    }
}

/// Lowest and highest x, y and z of all bones that are finite.
fn bounds(panel: &PoseFan) -> Option<[Vec3; 2]> {
    let places = panel.poses.iter().flatten().flat_map(|bone| [bone.start_m, bone.end_m]);
    let finite = places.filter(|place| place.iter().all(|value| value.is_finite()));
    finite.fold(None, |bounds, place| match bounds {
        Some([low, high]) => Some([place.inf(&low), place.sup(&high)]),
        None => Some([place, place]),
    })
}

/// Pixels a metre at which all of the panel's bones are inside; bones that are not finite do not
/// count.
fn fitting_scale(panel: &PoseFan) -> f32 {
    let Some([low, high]) = bounds(panel) else { return LARGEST_SCALE };
    let sides = [(across(panel.look), WIDTH_PX), (1, HEIGHT_PX)];
    let scale = sides.map(|(axis, room_px)| (room_px as f32 - 2.0 * MARGIN_PX) / (high[axis] - low[axis]));
    scale[0].min(scale[1]).min(LARGEST_SCALE)
}

fn drawing(panel: &PoseFan, scale: f32) -> RgbImage {
    let mut image = RgbImage::from_pixel(WIDTH_PX, HEIGHT_PX, PAPER);
    let (centre, axis) = (bounds(panel).map_or(Vec3::zeros(), |[low, high]| (low + high) * 0.5), across(panel.look));
    let place = |point: &Vec3| {
        let off = (point - centre) * scale;
        Pixel::new(0.5 * WIDTH_PX as f32 + off[axis], 0.5 * HEIGHT_PX as f32 + off.y)
    };
    // Ten poses can be distinguished, a hundred cannot.
    let opacity = (4.0 / panel.poses.len().max(1) as f64).clamp(0.12, 0.6);
    for bone in panel.poses.iter().flatten() {
        let stroke = Stroke::new(colour(bone), 1.6).with_opacity(opacity);
        line(&mut image, place(&bone.start_m), place(&bone.end_m), &stroke);
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn bone(x: f32) -> DrawnBone {
        DrawnBone { start_m: Vec3::new(x, -0.5, 3.0), end_m: Vec3::new(x, 0.5, 3.0), radius_m: 0.05, side: None }
    }

    #[test]
    fn poses_lie_beside_each_other_where_they_differ_and_fill_the_panel() {
        let poses = [vec![bone(-0.4)], vec![bone(0.4)]];
        let panel = PoseFan { title: "two", notes: &[], poses: &poses, look: Look::Front };
        let image = drawing(&panel, fitting_scale(&panel));
        let lit: Vec<(u32, u32)> =
            image.enumerate_pixels().filter(|(.., pixel)| **pixel != PAPER).map(|(x, y, _)| (x, y)).collect();
        let scale = HEIGHT_PX as f32 - 2.0 * MARGIN_PX;
        for sign in [-1.0, 1.0] {
            let column = 0.5 * WIDTH_PX as f32 + sign * 0.4 * scale;
            assert!(lit.iter().any(|(x, _)| (*x as f32 - column).abs() < 2.0), "{column}");
        }
        let lowest = lit.iter().map(|(_, y)| *y).max().unwrap() as f32;
        assert!((lowest - (HEIGHT_PX as f32 - MARGIN_PX)).abs() < 4.0, "{lowest}");
        // From the side both poses are one line.
        let side = PoseFan { look: Look::Side, ..panel };
        let columns = drawing(&side, 100.0);
        let lit = columns.enumerate_pixels().filter(|(.., pixel)| **pixel != PAPER);
        assert!(lit.map(|(x, ..)| x.abs_diff(WIDTH_PX / 2)).max().unwrap() < 3);
    }

    #[test]
    fn a_note_makes_the_picture_higher() {
        let panel = |notes| pose_fans(&[PoseFan { title: "", notes, poses: &[], look: Look::Front }]);
        assert!(panel(&["a".to_owned(), "b".to_owned()]).height() > panel(&[]).height());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]
        #[test]
        fn nothing_makes_it_panic(ends in prop::collection::vec(any::<[f32; 6]>(), 0..4)) {
            let pose: Vec<DrawnBone> = ends.into_iter().map(|e| DrawnBone {
                start_m: Vec3::new(e[0], e[1], e[2]),
                end_m: Vec3::new(e[3], e[4], e[5]),
                radius_m: 0.0,
                side: None,
            }).collect();
            let poses = [pose];
            let image = pose_fans(&[PoseFan { title: "x", notes: &[], poses: &poses, look: Look::Side }]);
            prop_assert_eq!(image.width(), WIDTH_PX);
        }
    }
}
