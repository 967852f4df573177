//! Skin by the colour of the face in the same image, and what is scored of it.

use anyhow::Result;
use image::RgbImage;
use sinew::person::{FaceDetector, FoundFace, PersonSkin};
use sinew::signal::median::median;
use sinew::skin::BitImage;
use sinew::skin::confusion::Confusion;
use sinew_core::vision::frame::segment;
use sinew_core::vision::objects::head::{HeadBox, is_head};

/// What looks for faces.
#[derive(Debug)]
pub struct Faces {
    /// That of `sinew track arm`.
    pub detector: FaceDetector,
    /// Whether the colour of the face takes the place of the model.
    pub adapt: bool,
}

/// Skin by the colour of a face, as `sinew track arm` sees it; `None` where it gives none.
pub fn by_face(image: &RgbImage, face: &FoundFace) -> Option<Result<BitImage>> {
    let skin = PersonSkin::new(face.colour?);
    let segmented = || {
        let mut bits = BitImage::new(image.width() as usize, image.height() as usize)?;
        segment(image.as_raw(), &skin, &mut bits.view_mut()?);
        Ok(bits)
    };
    Some(segmented())
}

/// Decisions on the pixels outside of the head.
///
/// # Errors
/// None in practice: the sizes were checked when the images were made.
pub fn outside_head(mut found: BitImage, mut truth: BitImage, head: Option<HeadBox>) -> Result<Confusion> {
    if let Some(head) = head {
        for bits in [&mut found, &mut truth] {
            clear_head(bits, head)?;
        }
    }
    Ok(Confusion::of(&found, &truth))
}

fn clear_head(bits: &mut BitImage, head: HeadBox) -> Result<()> {
    let mut bits = bits.view_mut()?;
    for v in 0..bits.height() {
        for u in 0..bits.width() {
            if is_head(head.relative([u as f32, v as f32])) {
                bits.set(u, v, false);
            }
        }
    }
    Ok(())
}

/// Median L* (CIE 1976, of sRGB before D65) of the labelled skin; `None` without skin.
///
/// # Errors
/// As [`outside_head`].
pub fn skin_lightness(image: &RgbImage, truth: &BitImage) -> Result<Option<f64>> {
    let truth = truth.view()?;
    let of_skin = image.enumerate_pixels().filter(|(u, v, _)| truth.get(*u as usize, *v as usize));
    let mut luminances: Vec<f64> = of_skin.map(|(_, _, pixel)| luminance(pixel.0)).collect();
    Ok(median(&mut luminances).map(lightness))
}

/// Relative luminance of a colour: IEC 61966-2-1.
fn luminance(rgb: [u8; 3]) -> f64 {
    let linear = rgb.map(|channel| {
        let share = f64::from(channel) / 255.0;
        if share <= 0.04045 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
    });
    0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
}

/// L* of a relative luminance.
fn lightness(luminance: f64) -> f64 {
    if luminance > (6.0_f64 / 29.0).powi(3) {
        116.0 * luminance.cbrt() - 16.0
    } else {
        luminance * (29.0_f64 / 3.0).powi(3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{GrayImage, Luma, Rgb};
    use sinew_core::vision::objects::person_colour::PersonColour;

    const SKIN: [u8; 3] = [236, 205, 194];

    #[test]
    fn grey_has_the_lightness_of_the_norm() {
        for (level, expected) in [(0, 0.0), (10, 2.74), (119, 50.03), (255, 100.0)] {
            let of_grey = lightness(luminance([level; 3]));
            assert!((of_grey - expected).abs() < 0.01, "{level}: {of_grey}");
        }
    }

    #[test]
    fn pale_skin_is_found_by_its_face_and_counted_outside_of_the_head() {
        let is_skin = |u: u32, v: u32| (v < 40 && (40..60).contains(&u)) || (v >= 70 && u < 20);
        let image = RgbImage::from_fn(100, 100, |u, v| Rgb(if is_skin(u, v) { SKIN } else { [90, 110, 150] }));
        let mask = GrayImage::from_fn(100, 100, |u, v| Luma([if is_skin(u, v) { 255 } else { 0 }]));
        let truth = BitImage::from_gray(&mask, 127).unwrap();
        let head = HeadBox { centre_px: [50.0, 20.0], width_px: 30.0 };
        let colour = PersonColour::of_face(&[SKIN; 100]);
        let found = by_face(&image, &FoundFace { head, colour }).unwrap().unwrap();
        assert_eq!(found, truth);
        assert!((skin_lightness(&image, &truth).unwrap().unwrap() - 84.5).abs() < 0.5);
        let counts = outside_head(found, truth, Some(head)).unwrap();
        assert_eq!(counts.scores().f1, 1.0);
        assert!((600.0..700.0).contains(&counts.true_positive), "the hand: {counts:?}");
        assert!(by_face(&image, &FoundFace { head, colour: None }).is_none());
    }
}
