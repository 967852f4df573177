//! A run at a glance: some of its frames, evenly chosen, as thumbnails on one sheet.

use super::colour::INK;
use super::lettering::Lettering;
use crate::error::{Result, ensure};
use image::{Rgb, RgbImage, imageops};

/// Width of a thumbnail, pixels; smaller frames keep their size.
const THUMBNAIL_WIDTH_PX: u32 = 320;
/// Largest height of a thumbnail, pixels.
const THUMBNAIL_HEIGHT_PX: u32 = 640;
/// Space around thumbnails, pixels.
const GAP_PX: u32 = 4;
/// Maximum number of tiles of a sheet.
pub const MAX_TILES: usize = 400;
const BACKGROUND: Rgb<u8> = Rgb([32, 32, 36]);

/// Collects thumbnails while a run goes on; holds no more pixels than the sheet shows.
///
/// Invariant: the chosen frames are distinct, evenly spaced up to rounding, and include the first
/// and the last.
#[derive(Debug, Clone)]
pub struct ContactSheet {
    frames: usize,
    tiles: usize,
    thumbnails: Vec<(usize, RgbImage)>,
}

impl ContactSheet {
    /// A sheet of `tiles` out of `frames` frames, of all if there are no more.
    ///
    /// # Errors
    /// The number of tiles has to lie in 1..=[`MAX_TILES`].
    pub fn new(frames: usize, tiles: usize) -> Result<Self> {
        ensure!(
            (1..=MAX_TILES).contains(&tiles),
            "contact sheet of {tiles} tiles: must have 1 to {MAX_TILES}; choose another number"
        );
        Ok(Self { frames, tiles: tiles.min(frames), thumbnails: Vec::new() })
    }

    /// Whether the frame at `index` (from 0) will be on the sheet; others need not be drawn.
    #[must_use]
    pub fn wants(&self, index: usize) -> bool {
        let intervals = self.tiles.saturating_sub(1).max(1);
        let last = self.frames.saturating_sub(1);
        (0..self.tiles).any(|tile| (tile.saturating_mul(last) + intervals / 2) / intervals == index)
    }

    /// Takes the picture of the frame at `index` (from 0); does nothing with one that it does not
    /// want.
    pub fn add(&mut self, index: usize, image: &RgbImage) {
        if self.wants(index) && !self.thumbnails.iter().any(|(known, _)| *known == index) {
            self.thumbnails.push((index, thumbnail(image)));
        }
    }

    /// The sheet of all that was added, row by row in the order of frames, each with its index.
    #[must_use]
    pub fn finish(mut self) -> RgbImage {
        self.thumbnails.sort_by_key(|(index, _)| *index);
        let width = self.thumbnails.iter().map(|(_, tile)| tile.width()).max().unwrap_or(1);
        let height = self.thumbnails.iter().map(|(_, tile)| tile.height()).max().unwrap_or(1);
        let count = self.thumbnails.len().max(1) as u32;
        let columns = (1..=count).find(|columns| columns * columns >= count).unwrap_or(1);
        let letters = Lettering::new(13.0);
        let title_px = letters.map_or(0, Lettering::line_height_px);
        let cell = (width + GAP_PX, height + title_px + GAP_PX);
        let size = (cell.0 * columns + GAP_PX, cell.1 * count.div_ceil(columns) + GAP_PX);
        let mut sheet = RgbImage::from_pixel(size.0, size.1, BACKGROUND);
        for (place, (index, tile)) in (0..).zip(&self.thumbnails) {
            let corner = (GAP_PX + cell.0 * (place % columns), GAP_PX + cell.1 * (place / columns));
            imageops::replace(&mut sheet, tile, i64::from(corner.0), i64::from(corner.1 + title_px));
            if let Some(letters) = letters {
                let text = letters.fit(&format!("frame {index}"), width);
                letters.draw(&mut sheet, (corner.0 as i32 + 2, corner.1 as i32), &text, INK);
            }
        }
        sheet
    }
}

/// `image` made to fit, in its proportions.
fn thumbnail(image: &RgbImage) -> RgbImage {
    let (width, height) = (image.width().max(1), image.height().max(1));
    let shrink_by_width = f64::from(THUMBNAIL_WIDTH_PX) / f64::from(width);
    let shrink = shrink_by_width.min(f64::from(THUMBNAIL_HEIGHT_PX) / f64::from(height));
    if shrink >= 1.0 {
        return image.clone();
    }
    let scaled = |length_px: u32| ((f64::from(length_px) * shrink).round() as u32).max(1);
    imageops::thumbnail(image, scaled(width), scaled(height))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn chosen(frames: usize, tiles: usize) -> Vec<usize> {
        let sheet = ContactSheet::new(frames, tiles).unwrap();
        (0..frames + 5).filter(|index| sheet.wants(*index)).collect()
    }

    #[test]
    fn twelve_of_many_frames_are_chosen_evenly() {
        assert_eq!(chosen(100, 12), [0, 9, 18, 27, 36, 45, 54, 63, 72, 81, 90, 99]);
        assert_eq!(chosen(5, 12), [0, 1, 2, 3, 4]);
        assert_eq!(chosen(7, 1), [0]);
        assert!(chosen(0, 12).is_empty());
    }

    #[test]
    fn a_sheet_without_tiles_is_refused() {
        assert!(ContactSheet::new(10, 0).unwrap_err().to_string().contains("1 to 400"));
    }

    #[test]
    fn tiles_stand_in_the_order_of_frames_and_keep_their_colour() {
        let mut sheet = ContactSheet::new(40, 4).unwrap();
        for index in (0..40).rev() {
            sheet.add(index, &RgbImage::from_pixel(640, 480, Rgb([(5 * index) as u8, 0, 200])));
        }
        assert_eq!(sheet.thumbnails.len(), 4);
        let picture = sheet.finish();
        let (half_width, half_height) = (picture.width() / 2, picture.height() / 2);
        assert!(half_width > 320 && half_height > 240);
        let reds = [(0, 0), (1, 0), (0, 1), (1, 1)]
            .map(|(x, y)| picture.get_pixel(x * half_width + 160, y * half_height + 150)[0]);
        assert_eq!(reds, [0, 65, 130, 195]);
    }

    #[test]
    fn empty_and_extreme_frames_do_no_harm() {
        let mut sheet = ContactSheet::new(4, 4).unwrap();
        for (index, size) in [(0, 0), (1, 1), (1, 5000), (5000, 1)].into_iter().enumerate() {
            sheet.add(index, &RgbImage::new(size.0, size.1));
        }
        assert!(sheet.finish().width() < 1000);
        assert!(ContactSheet::new(0, 3).unwrap().finish().width() > 0);
    }

    proptest! {
        #[test]
        fn choices_are_distinct_even_and_hold_both_ends(frames in 1_usize..3000, tiles in 2_usize..40) {
            let chosen = chosen(frames, tiles);
            prop_assert_eq!(chosen.len(), tiles.min(frames));
            prop_assert_eq!((chosen[0], chosen[chosen.len() - 1]), (0, frames - 1));
            let steps: Vec<usize> = chosen.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let widest = steps.iter().max().copied().unwrap_or(1);
            let narrowest = steps.iter().min().copied().unwrap_or(1);
            prop_assert!(widest - narrowest <= 1);
        }
    }
}
