//! One frame with all that the arm tracker knew and found.

pub use super::arm_marks::OverlayArm;
use super::arm_marks::{Scale, lighter, outlined};
use super::colour::{BLOB, EDGE, INK, SHADE, SKIN, of_side};
use super::stroke::{Stroke, disc, line, tint, tint_rectangle};
use super::top_view;
use crate::wording::{side_name, status_name};
use image::{GrayImage, RgbImage};
use sinew_core::camera::Pixel;
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::Status;

/// What is drawn of one blob.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OverlayBlob {
    /// Where the hand would be.
    pub centre: Pixel,
    /// Left, top, width and height, pixels.
    pub bounding_box: [u32; 4],
    /// Likelihood of being a hand, 0..=1.
    pub likelihood: f32,
}

/// All that is drawn on one frame.
#[derive(Debug, Clone, Copy)]
pub struct Overlay<'a> {
    /// The arms, in the order of their notes.
    pub arms: &'a [OverlayArm],
    /// The blobs that may be a hand.
    pub blobs: &'a [OverlayBlob],
    /// Column and row of each temporal edge.
    pub edges: &'a [(u16, u16)],
    /// Skin mask (255 = skin) whose rim is drawn.
    pub mask_outline: Option<&'a GrayImage>,
    /// Lines at the top; empty for none.
    pub caption: &'a str,
}

/// `image` with `overlay` drawn on it; same size. Images with a side below 120 pixels get no
/// letters.
#[must_use]
pub fn draw(image: &RgbImage, overlay: &Overlay) -> RgbImage {
    let mut image = image.clone();
    let scale = Scale::of(&image);
    if let Some(mask) = overlay.mask_outline {
        draw_mask(&mut image, mask);
    }
    for (x, y) in overlay.edges {
        tint(&mut image, u32::from(*x), u32::from(*y), EDGE, 0.75);
    }
    top_view::draw(&mut image, overlay.arms, scale);
    for blob in overlay.blobs {
        draw_blob(&mut image, blob, scale);
    }
    for arm in overlay.arms {
        draw_particles(&mut image, arm, scale);
    }
    for arm in overlay.arms {
        draw_arm(&mut image, arm, scale);
    }
    draw_notes(&mut image, overlay.arms, scale);
    draw_caption(&mut image, overlay.caption, scale);
    image
}

/// Tints skin a little and its rim (skin with a 4-neighbour that is none) much.
fn draw_mask(image: &mut RgbImage, mask: &GrayImage) {
    let skin = |x: u32, y: u32| mask.get_pixel_checked(x, y).is_none_or(|pixel| pixel[0] > 127);
    let (width, height) = (image.width().min(mask.width()), image.height().min(mask.height()));
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        if skin(x, y) {
            let inner = skin(x + 1, y) && skin(x, y + 1) && skin(x.wrapping_sub(1), y) && skin(x, y.wrapping_sub(1));
            tint(image, x, y, SKIN, if inner { 0.12 } else { 0.8 });
        }
    }
}

fn draw_blob(image: &mut RgbImage, blob: &OverlayBlob, scale: Scale) {
    let [left, top, width, height] = blob.bounding_box.map(|length_px| length_px as f32);
    let (right, bottom) = (left + (width - 1.0).max(0.0), top + (height - 1.0).max(0.0));
    let width_px = (1.2 * scale.factor).max(1.0);
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
    let corners = corners.map(|(u_px, v_px)| Pixel::new(u_px, v_px));
    outlined(image, &corners, Stroke::new(BLOB, width_px), width_px + 2.0);
    let (u, v, arm) = (blob.centre.u_px, blob.centre.v_px, (4.0 * scale.factor) as f32);
    for ends in [[(u - arm, v), (u + arm, v)], [(u, v - arm), (u, v + arm)]] {
        let ends = ends.map(|(u_px, v_px)| Pixel::new(u_px, v_px));
        outlined(image, &ends, Stroke::new(BLOB, width_px), width_px + 2.0);
    }
    if let Some(letters) = scale.letters {
        let text = if blob.likelihood.is_finite() { format!("{:.2}", blob.likelihood) } else { "?".to_owned() };
        let above = top as i32 - letters.line_height_px() as i32 - 1;
        let y = if above >= 0 { above } else { (bottom as i32).saturating_add(2) };
        letters.draw_on_plate(image, (left as i32, y), &text, BLOB);
    }
}

/// Hands as dots, the more opaque the heavier (light ones below heavy ones), and the heaviest
/// particles' arms.
fn draw_particles(image: &mut RgbImage, arm: &OverlayArm, scale: Scale) {
    let colour = of_side(arm.side);
    let mut hands: Vec<&(Pixel, f32)> = arm.particle_hands.iter().collect();
    hands.sort_by(|a, b| a.1.total_cmp(&b.1));
    let heaviest = hands.iter().map(|hand| hand.1).filter(|weight| weight.is_finite()).fold(0.0_f32, f32::max);
    for (hand, weight) in hands {
        let share = if heaviest > 0.0 { f64::from(weight / heaviest) } else { 0.0 };
        let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
        let radius_px = 1.5 * scale.factor;
        disc(image, *hand, radius_px + 0.7, SHADE, 0.5 * share);
        disc(image, *hand, radius_px, lighter(colour), 0.15 + 0.85 * share);
    }
    if arm.status != Status::Lost {
        for joints in &arm.best_arms {
            let stroke = Stroke::new(lighter(colour), (0.9 * scale.factor).max(0.8)).with_opacity(0.75);
            joints.windows(2).for_each(|bone| line(image, bone[0], bone[1], &stroke));
        }
    }
}

fn draw_arm(image: &mut RgbImage, arm: &OverlayArm, scale: Scale) {
    let Some(joints) = arm.joints_px.filter(|_| arm.status != Status::Lost) else { return };
    let (colour, predicted) = (of_side(arm.side), arm.status != Status::Tracking);
    let width_px = if predicted { 1.8 } else { 3.2 } * scale.factor;
    outlined(image, &joints, Stroke::new(colour, width_px).with_dashes(predicted), width_px + 1.6 * scale.factor);
    for (joint, radius) in joints.iter().zip([1.0, 1.0, 1.5]) {
        disc(image, *joint, radius * (0.5 * width_px + 1.6 * scale.factor), SHADE, 0.8);
        disc(image, *joint, radius * (0.5 * width_px + 0.8 * scale.factor), colour, 1.0);
    }
    disc(image, joints[2], 0.5 * width_px, INK, 1.0);
    let hand = joints[2];
    let inside =
        hand.u_px >= 0.0 && hand.v_px >= 0.0 && image.get_pixel_checked(hand.u_px as u32, hand.v_px as u32).is_some();
    if let Some(letters) = scale.letters.filter(|_| inside) {
        let letter = if arm.side == Side::Left { "L" } else { "R" };
        let corner =
            [(hand.u_px, 5.0), (hand.v_px, 4.0)].map(|(place, gap)| (place + gap * scale.factor as f32) as i32);
        letters.draw_on_plate(image, corner.into(), letter, lighter(colour));
    }
}

/// One line of text an arm at the bottom left: its side, colour and state.
fn draw_notes(image: &mut RgbImage, arms: &[OverlayArm], scale: Scale) {
    let Some(letters) = scale.letters else { return };
    let room = image.height() / 3 / letters.line_height_px();
    let shown = arms.len().min(room as usize);
    for (index, arm) in arms.iter().take(shown).enumerate() {
        let text = format!("{} {}", side_name(arm.side), status_name(arm.status));
        let y = image.height() - letters.line_height_px() * (shown - index) as u32;
        letters.draw_on_plate(image, (0, y as i32), &text, lighter(of_side(arm.side)));
    }
}

/// Lines on a dark strip along the top, at most a quarter of the image.
fn draw_caption(image: &mut RgbImage, caption: &str, scale: Scale) {
    let Some(letters) = scale.letters else { return };
    let height_px = letters.line_height_px();
    let lines: Vec<&str> = caption.lines().take((image.height() / 4 / height_px) as usize).collect();
    if lines.is_empty() {
        return;
    }
    let size = (image.width(), height_px * lines.len() as u32 + 2);
    tint_rectangle(image, (0, 0), size, SHADE, 0.7);
    for (index, text) in lines.iter().enumerate() {
        let text = letters.fit(text, image.width().saturating_sub(8));
        letters.draw(image, (4, 1 + (height_px as usize * index) as i32), &text, INK);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::colour::{LEFT, RIGHT};
    use image::Rgb;
    use proptest::prelude::*;
    use sinew_core::math::Vec3;

    const NOTHING: Overlay = Overlay { arms: &[], blobs: &[], edges: &[], mask_outline: None, caption: "" };
    const BACKGROUND: Rgb<u8> = Rgb([90, 100, 80]);

    fn background(width: u32, height: u32) -> RgbImage {
        RgbImage::from_pixel(width, height, BACKGROUND)
    }

    fn arm(side: Side, status: Status, joints_px: [Pixel; 3]) -> OverlayArm {
        let (particle_hands, best_arms) = (Vec::new(), Vec::new());
        OverlayArm { side, status, joints_px: Some(joints_px), joints_m: None, particle_hands, best_arms, ray: None }
    }

    fn changed(image: &RgbImage) -> Vec<(u32, u32)> {
        image.enumerate_pixels().filter(|(_, _, pixel)| **pixel != BACKGROUND).map(|(x, y, _)| (x, y)).collect()
    }

    fn share(image: &RgbImage, colour: Rgb<u8>) -> usize {
        image.pixels().filter(|pixel| **pixel == colour).count()
    }

    const JOINTS: [Pixel; 3] = [Pixel::new(20.0, 20.0), Pixel::new(20.0, 80.0), Pixel::new(80.0, 80.0)];

    #[test]
    fn an_arm_covers_its_bones_and_nothing_far_from_them() {
        let image =
            draw(&background(110, 100), &Overlay { arms: &[arm(Side::Left, Status::Tracking, JOINTS)], ..NOTHING });
        assert_eq!(*image.get_pixel(20, 50), LEFT);
        assert_eq!(*image.get_pixel(50, 80), LEFT);
        let near = |x: u32, y: u32| {
            (15..=25).contains(&x) && (15..=85).contains(&y) || (15..=86).contains(&x) && y.abs_diff(80) < 7
        };
        assert!(changed(&image).into_iter().all(|(x, y)| near(x, y)));
    }

    #[test]
    fn sides_and_states_look_different() {
        let drawn =
            |side, status| draw(&background(110, 100), &Overlay { arms: &[arm(side, status, JOINTS)], ..NOTHING });
        let tracking = drawn(Side::Right, Status::Tracking);
        let predicted = drawn(Side::Right, Status::Predicted);
        assert!(share(&tracking, RIGHT) > 2 * share(&predicted, RIGHT) && share(&predicted, RIGHT) > 20);
        assert_eq!(share(&tracking, LEFT), 0);
        assert!(changed(&drawn(Side::Right, Status::Lost)).is_empty());
    }

    #[test]
    fn a_lost_arm_leaves_a_note_at_the_bottom_left() {
        let image = draw(&background(320, 240), &Overlay { arms: &[arm(Side::Left, Status::Lost, JOINTS)], ..NOTHING });
        let places = changed(&image);
        assert!(places.len() > 100 && places.iter().all(|(x, y)| *x < 160 && *y > 200));
    }

    #[test]
    fn heavier_particles_are_more_opaque() {
        let particle_hands = vec![(Pixel::new(30.0, 50.0), 0.1), (Pixel::new(70.0, 50.0), 0.4)];
        let arms = [OverlayArm { joints_px: None, particle_hands, ..arm(Side::Left, Status::Tracking, JOINTS) }];
        let image = draw(&background(100, 100), &Overlay { arms: &arms, ..NOTHING });
        let red = |x| image.get_pixel(x, 50)[0];
        assert!(red(70) > red(30) + 40 && red(30) > BACKGROUND[0] + 10, "{} {}", red(30), red(70));
    }

    #[test]
    fn blobs_edges_and_mask_are_drawn_where_they_are() {
        let mut mask = GrayImage::new(100, 100);
        (40..50)
            .flat_map(|y| (10..20).map(move |x| (x, y)))
            .for_each(|(x, y)| mask.put_pixel(x, y, image::Luma([255])));
        let blobs = [OverlayBlob { centre: Pixel::new(70.0, 30.0), bounding_box: [60, 20, 21, 21], likelihood: 0.87 }];
        let overlay = Overlay { blobs: &blobs, edges: &[(5, 95), (99, 99)], mask_outline: Some(&mask), ..NOTHING };
        let image = draw(&background(100, 100), &overlay);
        assert_eq!(*image.get_pixel(60, 30), BLOB);
        assert_eq!(*image.get_pixel(70, 30), BLOB);
        assert_eq!(*image.get_pixel(65, 25), BACKGROUND);
        assert!(image.get_pixel(5, 95)[0] > 200 && image.get_pixel(99, 99)[0] > 200);
        let green = |x, y| image.get_pixel(x, y)[1];
        assert!(green(10, 45) > green(14, 45) && green(14, 45) > BACKGROUND[1]);
    }

    #[test]
    fn the_view_from_above_shows_arm_and_ray_in_its_corner_only() {
        let joints = [Vec3::new(-0.2, 0.0, 1.6), Vec3::new(-0.3, 0.2, 1.5), Vec3::new(-0.1, 0.1, 1.2)];
        let seen = OverlayArm {
            joints_px: None,
            joints_m: Some(joints),
            ray: Some([Vec3::zeros(), joints[2]]),
            ..arm(Side::Right, Status::Tracking, JOINTS)
        };
        let image = draw(&background(110, 110), &Overlay { arms: &[seen], ..NOTHING });
        assert!(image.pixels().filter(|pixel| pixel[2] > 120 && pixel[0] < 90).count() > 10);
        assert!(image.pixels().any(|pixel| pixel[0] > 200 && pixel[1] > 180 && pixel[2] < 90));
        assert!(changed(&image).into_iter().all(|(x, y)| x >= 66 && y >= 55));
    }

    #[test]
    fn letters_appear_on_a_strip_at_the_top() {
        let image = draw(&background(320, 240), &Overlay { caption: "frame 0042", ..NOTHING });
        let places = changed(&image);
        assert!(places.iter().all(|(_, y)| *y < 24) && places.contains(&(319, 0)));
        assert!(image.pixels().filter(|pixel| pixel[0] > 150).count() > 50);
        assert!(changed(&draw(&background(320, 90), &Overlay { caption: "frame 0042", ..NOTHING })).is_empty());
    }

    #[test]
    fn a_large_image_takes_points_from_everywhere() {
        let far = [Pixel::new(-3.0e38, 540.0), Pixel::new(960.0, 540.0), Pixel::new(f32::NAN, 3.0e38)];
        let arms = [Status::Tracking, Status::Predicted].map(|status| OverlayArm {
            joints_m: Some([Vec3::repeat(3.0e38), Vec3::repeat(-3.0e38), Vec3::repeat(f32::INFINITY)]),
            ray: Some([Vec3::zeros(), Vec3::repeat(3.0e38)]),
            ..arm(Side::Left, status, far)
        });
        let image = draw(&background(1920, 1080), &Overlay { arms: &arms, ..NOTHING });
        assert!((0..950).all(|x| *image.get_pixel(x, 540) != BACKGROUND));
        assert_eq!(*image.get_pixel(960, 800), BACKGROUND);
    }

    fn any_pixel() -> impl Strategy<Value = Pixel> {
        let coordinate = || prop_oneof![any::<f32>(), -300.0_f32..300.0, Just(f32::NAN), Just(f32::INFINITY)];
        (coordinate(), coordinate()).prop_map(|(u_px, v_px)| Pixel::new(u_px, v_px))
    }

    fn any_place() -> impl Strategy<Value = Vec3> {
        (any_pixel(), prop_oneof![any::<f32>(), -5.0_f32..5.0]).prop_map(|(p, z)| Vec3::new(p.u_px, p.v_px, z))
    }

    fn any_arm() -> impl Strategy<Value = OverlayArm> {
        let hands = prop::collection::vec((any_pixel(), any::<f32>()), 0..5);
        let arms = prop::collection::vec([any_pixel(), any_pixel(), any_pixel()], 0..3);
        let places = ([any_place(), any_place(), any_place()], [any_place(), any_place()]);
        (any::<bool>(), 0_usize..3, [any_pixel(), any_pixel(), any_pixel()], hands, arms, places).prop_map(
            |(left, status, joints, particle_hands, best_arms, (joints_m, ray))| OverlayArm {
                joints_m: Some(joints_m),
                particle_hands,
                best_arms,
                ray: Some(ray),
                ..arm(
                    if left { Side::Left } else { Side::Right },
                    [Status::Tracking, Status::Predicted, Status::Lost][status],
                    joints,
                )
            },
        )
    }

    proptest! {
        #[test]
        fn nothing_makes_it_panic(
            size in (0_u32..300, 0_u32..300), mask_size in (0_u32..40, 0_u32..40),
            arms in prop::collection::vec(any_arm(), 0..4),
            blobs in prop::collection::vec((any_pixel(), any::<[u32; 4]>(), any::<f32>()), 0..4),
            edges: Vec<(u16, u16)>, caption in "(.|\n){0,40}",
        ) {
            let blobs: Vec<_> = blobs.into_iter()
                .map(|(centre, bounding_box, likelihood)| OverlayBlob { centre, bounding_box, likelihood }).collect();
            let mask = GrayImage::from_pixel(mask_size.0, mask_size.1, image::Luma([255]));
            let overlay =
                Overlay { arms: &arms, blobs: &blobs, edges: &edges, mask_outline: Some(&mask), caption: &caption };
            let image = background(size.0, size.1);
            let drawn = draw(&image, &overlay);
            prop_assert_eq!(drawn.dimensions(), size);
            prop_assert!(drawn == draw(&image, &overlay), "not deterministic");
        }
    }
}
