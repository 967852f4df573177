//! A click on the hand: the skin model adapted to a box around it.

use crate::skin_model::BalancedSkin;
use sinew_core::error::{ParameterError, Rule};
use sinew_core::vision::components::BoundingBox;
use sinew_core::vision::front_end::calibration::SkinSample;
use sinew_core::vision::front_end::pixel_format::Rgb565;
use sinew_core::vision::objects::head::HeadBox;
use sinew_core::vision::objects::person_colour::PersonColour;
use sinew_core::vision::white_balance::Gains;

/// Half the side of the box, as a part of the picture's longer side: 16 of 640 pixels.
const HALF_SIDE_PART: usize = 40;
/// What small pictures have of it, so that the box outweighs what was trained.
const MIN_HALF_SIDE_PX: usize = 8;
/// Half the side of the box, as a part of the head's width. Chosen: on two clips of `video/asl`
/// nothing changes from 12 to 20, and at 8 the wall behind a hand is learned, too.
const HEAD_PART: f32 = 16.0;
/// What small heads have of it, so that there are enough pixels for a colour.
const MIN_HALF_SIDE_OF_HEAD_PX: usize = 2;
/// Pixels of the box that are looked at, at most.
const SAMPLE_PIXELS: usize = 1024;
/// Pixels of the longest line.
const LINE_PIXELS: usize = crate::frame::MAX_SIDE_PX;

/// The box around the pixel (`u`, `v`), as far as it lies in a picture of `width` x `height`. It is
/// a part of the `head`'s box, or of the picture where no face is known.
///
/// # Errors
/// The pixel has to lie in the picture.
pub fn box_around(
    (u, v): (usize, usize),
    (width, height): (usize, usize),
    head: Option<HeadBox>,
) -> Result<BoundingBox, ParameterError> {
    for (name, at, side) in [("u", u, width), ("v", v, height)] {
        if at >= side {
            return Err(ParameterError::new(name, Rule::Within { low: 0.0, high: side as f32 - 1.0 }));
        }
    }
    let of_picture = (width.max(height) / HALF_SIDE_PART).max(MIN_HALF_SIDE_PX);
    let half = head.map_or(of_picture, |head| ((head.width_px / HEAD_PART) as usize).max(MIN_HALF_SIDE_OF_HEAD_PX));
    Ok(BoundingBox {
        min_u: u.saturating_sub(half) as u16,
        min_v: v.saturating_sub(half) as u16,
        max_u: (u + half).min(width - 1) as u16,
        max_v: (v + half).min(height - 1) as u16,
    })
}

/// `trained` adapted to what lies inside of `bounds` in a picture of interleaved RGB, by
/// [`SkinSample`].
///
/// # Errors
/// A box that shows only black.
pub fn adapted(
    trained: &BalancedSkin,
    rgb: &[u8],
    width: usize,
    bounds: BoundingBox,
) -> Result<BalancedSkin, ParameterError> {
    let gains = Gains::of_picture(rgb, width);
    let mut sample = SkinSample::<Rgb565, SAMPLE_PIXELS>::new(bounds);
    let mut line = [0; LINE_PIXELS];
    let rows = rgb.chunks_exact((3 * width).max(1)).enumerate();
    for (v, row) in rows.take(usize::from(bounds.max_v) + 1).skip(usize::from(bounds.min_v)) {
        for (key, &pixel) in line.iter_mut().zip(row.as_chunks::<3>().0) {
            *key = rgb565(gains.darkened(pixel));
        }
        sample.line(v, &line);
    }
    Ok(BalancedSkin::of_classifier(&sample.adapted(&trained.classifier()?)?))
}

/// The colour inside of `bounds`, if enough of it is alike.
#[must_use]
pub fn colour_in(rgb: &[u8], width: usize, bounds: BoundingBox) -> Option<PersonColour> {
    let [columns, rows] = [(bounds.min_u, bounds.max_u), (bounds.min_v, bounds.max_v)]
        .map(|(first, last)| usize::from(first)..=usize::from(last));
    let places = rows.flat_map(|v| columns.clone().map(move |u| v * width + u));
    let pixels: Vec<[u8; 3]> = places.filter_map(|at| rgb.as_chunks::<3>().0.get(at).copied()).collect();
    PersonColour::of_face(&pixels)
}

fn rgb565([red, green, blue]: [u8; 3]) -> u16 {
    u16::from(red >> 3) << 11 | u16::from(green >> 2) << 5 | u16::from(blue >> 3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skin_model::SHIPPED;

    /// Skin in bluish light on the left, a green wall on the right.
    fn picture() -> Vec<u8> {
        let pixel = |u: usize, v: usize| {
            let noise = ((u * 7 + v * 13) % 5) as u8;
            if u < 40 { [120 + noise, 105 + noise, 140 + noise] } else { [40 + noise, 130, 60] }
        };
        (0..80 * 60).flat_map(|i| pixel(i % 80, i / 80)).collect()
    }

    #[test]
    fn a_click_teaches_the_light() {
        let rgb = picture();
        let gains = Gains::of_picture(&rgb, 80);
        let lit = [122, 107, 142];
        let before = SHIPPED.for_picture(&gains).unwrap().distance(lit);
        assert!(before.is_none_or(|distance| distance > 2.25), "{before:?}");
        let bounds = box_around((20, 30), (80, 60), None).unwrap();
        let skin = adapted(&SHIPPED, &rgb, 80, bounds).unwrap().for_picture(&gains).unwrap();
        assert!(skin.distance(lit).unwrap() < 2.0, "{:?}", skin.distance(lit));
        assert!(skin.distance([42, 130, 60]).is_none_or(|distance| distance > 2.25));
        let colour = colour_in(&rgb, 80, bounds).unwrap();
        assert!(colour.is_skin(lit) && !colour.is_skin([42, 130, 60]));
    }

    #[test]
    fn a_box_stays_inside_and_a_click_outside_is_refused() {
        let corner = box_around((639, 0), (640, 480), None).unwrap();
        assert_eq!((corner.min_u, corner.max_u, corner.min_v, corner.max_v), (623, 639, 0, 16));
        let head = |width_px| Some(HeadBox { centre_px: [300.0, 100.0], width_px });
        for (width_px, half) in [(80.0, 5), (20.0, 2)] {
            let at_head = box_around((100, 50), (640, 480), head(width_px)).unwrap();
            assert_eq!((at_head.min_u, at_head.max_v), (100 - half, 50 + half));
        }
        assert_eq!(box_around((640, 0), (640, 480), None).unwrap_err().parameter, "u");
        assert_eq!(box_around((0, 480), (640, 480), None).unwrap_err().parameter, "v");
        let black = vec![0; 3 * 80 * 60];
        assert!(adapted(&SHIPPED, &black, 80, box_around((5, 5), (80, 60), None).unwrap()).is_err());
    }
}
