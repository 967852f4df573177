//! A person's own skin from what moves, where no face is known.
//!
//! What hides a learned background, has a colour that skin may have, and one that is rare in that
//! background, is this person's skin. Its mean and covariance take the place of the trained ones in
//! part, as those of a calibration's rectangle do. The trained model stays beside the result.

use super::background::Background;
use super::calibrate::blended;
use super::gaussian::{GaussianModel, Moments, chromaticity};
use super::model::{ModelNumbers, SkinModel};
use crate::error::Result;
use crate::pixels::{Picture, Pixels};
use sinew_core::vision::skin::{GaussianSkin, SkinClassifier};

/// Mahalanobis distance from the trained model beyond which nothing is learned: three standard
/// deviations, as for the skin of a face. Grey clothes begin at 3.2.
const MAX_DISTANCE: f32 = 3.0;
/// How long a colour is remembered, seconds. Chosen: with 5 s as good on seeds 100 to 186 of
/// `sinew demo`.
const MEMORY_S: f64 = 2.0;
/// Cells of r and of g. Chosen: three are about half a standard deviation of skin's r wide.
const CELLS: usize = 128;

/// The skin that moved before one camera.
///
/// ```
/// use image::{Rgb, RgbImage};
/// use sinew::skin::{Background, MovingSkin, SkinModel};
/// use sinew_core::vision::skin::SkinClassifier;
///
/// let trained = SkinModel::from_option("gaussian")?;
/// let wall = RgbImage::from_pixel(40, 40, Rgb([60, 90, 140]));
/// let mut background = Background::new(15.0);
/// (0..15).for_each(|_| background.see(&wall, &trained));
/// // A pale hand, the half of which the trained model does not see.
/// let pale = [[180, 155, 136], [180, 163, 154]];
/// let hand = RgbImage::from_fn(40, 40, |u, _| Rgb(pale[u as usize / 20]));
/// background.see(&hand, &trained);
/// let mut moving = MovingSkin::new(15.0);
/// let own = moving.see(&hand, &background, &trained)?;
/// let (mut of_anyone, mut of_person) = ([0], [0]);
/// trained.classify_line(pale.as_flattened(), &mut of_anyone);
/// own.classify_line(pale.as_flattened(), &mut of_person);
/// assert_eq!((of_anyone, of_person), ([0b01], [0b11]));
/// # Ok::<(), sinew::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MovingSkin {
    moments: Moments,
    /// Share of the moments that a frame leaves.
    kept: f64,
}

impl MovingSkin {
    /// Before the first of so many pictures a second.
    #[must_use]
    pub fn new(rate_hz: f64) -> Self {
        Self { moments: Moments::default(), kept: 1.0 - 1.0 / (MEMORY_S * rate_hz).max(1.0) }
    }

    /// Takes a picture that `background` has seen; what is skin there. Beside a histogram nothing
    /// is learned.
    ///
    /// # Errors
    /// None in practice: blended moments make a model.
    pub fn see<'a>(
        &mut self,
        image: &Picture<impl Pixels>,
        background: &Background,
        trained: &'a SkinModel,
    ) -> Result<EitherSkin<'a>> {
        let ModelNumbers::Gaussian(gaussian) = trained.numbers() else { return Ok(EitherSkin { trained, own: None }) };
        let (anyone, own) = (gaussian.classifier()?, self.adapted(gaussian).unwrap_or(*gaussian).classifier()?);
        let is_skin = |rgb: [u8; 3]| {
            let is_within = |distance: Option<f32>, limit: f32| distance.is_some_and(|distance| distance <= limit);
            is_within(anyone.distance(rgb), MAX_DISTANCE) && is_within(own.distance(rgb), own.threshold())
        };
        let (mut resting, mut moving, mut hiding) = (ColourCounts::new(), ColourCounts::new(), Vec::new());
        for (usual, now) in background.learned(image) {
            resting.add(usual);
            now.into_iter().for_each(|now| {
                moving.add(now);
                hiding.push(now);
            });
        }
        hiding.retain(|now| is_skin(*now) && moving.around(*now) > resting.around(*now));
        self.moments.fade(self.kept);
        let colours = hiding.into_iter().filter_map(|rgb| chromaticity(rgb.map(f64::from)));
        colours.for_each(|colour| self.moments.add(colour, 1.0));
        let own = self.adapted(gaussian).map(|own| own.classifier()).transpose()?;
        Ok(EitherSkin { trained, own })
    }

    /// The model with the part of what moved; `None` before that.
    fn adapted(&self, trained: &GaussianModel) -> Option<GaussianModel> {
        let moved = self.moments.mean_and_covariance()?;
        Some(blended(trained, moved, self.moments.weight()))
    }

    /// Forgets all.
    pub fn forget(&mut self) {
        self.moments = Moments::default();
    }

    /// The state, which [`MovingSkin::restore`] takes.
    #[must_use]
    pub fn saved(&self) -> [u64; 6] {
        self.moments.numbers().map(f64::to_bits)
    }

    /// Goes on from a state that was saved with the same rate.
    pub fn restore(&mut self, saved: [u64; 6]) {
        self.moments = Moments::of_numbers(saved.map(f64::from_bits));
    }
}

/// Skin by the trained model, or by what moved.
#[derive(Debug)]
pub struct EitherSkin<'a> {
    trained: &'a SkinModel,
    own: Option<GaussianSkin>,
}

impl SkinClassifier for EitherSkin<'_> {
    fn classify_line(&self, rgb: &[u8], bits: &mut [u32]) {
        const WORDS: usize = 8;
        self.trained.classify_line(rgb, bits);
        let Some(own) = &self.own else { return };
        for (words, pixels) in bits.chunks_mut(WORDS).zip(rgb.chunks(3 * 32 * WORDS)) {
            let mut of_own = [0; WORDS];
            own.classify_line(pixels, &mut of_own);
            words.iter_mut().zip(of_own).for_each(|(word, own)| *word |= own);
        }
    }
}

/// How many pixels have a chromaticity.
struct ColourCounts(Vec<u32>);

impl ColourCounts {
    fn new() -> Self {
        Self(vec![0; CELLS * CELLS])
    }

    fn cell([r, g, b]: [u8; 3]) -> [usize; 2] {
        let sum = usize::from(r) + usize::from(g) + usize::from(b);
        let share = |channel: u8| (CELLS - 1) * usize::from(channel) / sum.max(1);
        [share(r), share(g)]
    }

    fn add(&mut self, rgb: [u8; 3]) {
        let [r, g] = Self::cell(rgb);
        self.0[r * CELLS + g] += 1;
    }

    /// Pixels in the nine cells around a colour's.
    fn around(&self, rgb: [u8; 3]) -> u32 {
        let [r, g] = Self::cell(rgb).map(|cell| cell.saturating_sub(1)..(cell + 2).min(CELLS));
        r.map(|r| self.0[r * CELLS..][g.clone()].iter().sum::<u32>()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{Rgb, RgbImage};

    const WALL: [u8; 3] = [60, 90, 140];
    const PALE: [[u8; 3]; 2] = [[180, 155, 136], [180, 163, 154]];
    const CLOTHES: [u8; 3] = [150, 145, 140];

    /// What a classifier says of a colour.
    fn is_skin(skin: &impl SkinClassifier, colour: [u8; 3]) -> bool {
        let mut bits = [0; 10];
        skin.classify_line(&colour.repeat(300), &mut bits);
        assert!(bits == [0; 10] || bits[..9] == [u32::MAX; 9] && bits[9] == 0xfff, "{bits:?}");
        bits[0] & 1 == 1
    }

    /// The skin after nine frames in which rows of `colours` hid a wall.
    fn after<'a>(
        moving: &mut MovingSkin,
        wall: [u8; 3],
        colours: &[[u8; 3]],
        trained: &'a SkinModel,
    ) -> EitherSkin<'a> {
        let picture = |colours: &[[u8; 3]]| RgbImage::from_fn(40, 40, |_, v| Rgb(colours[v as usize % colours.len()]));
        let mut background = Background::new(10.0);
        (0..10).for_each(|_| background.see(&picture(&[wall]), trained));
        let mut own = EitherSkin { trained, own: None };
        for _ in 0..9 {
            background.see(&picture(colours), trained);
            own = moving.see(&picture(colours), &background, trained).unwrap();
        }
        own
    }

    #[test]
    fn pale_skin_that_moves_is_learned_as_a_whole() {
        let trained = SkinModel::from_option("gaussian").unwrap();
        assert_eq!(PALE.map(|colour| is_skin(&trained, colour)), [true, false]);
        let mut moving = MovingSkin::new(10.0);
        let own = after(&mut moving, WALL, &PALE, &trained);
        assert_eq!(PALE.map(|colour| is_skin(&own, colour)), [true, true]);
        assert!(!is_skin(&own, [140, 142, 145]) && !is_skin(&own, WALL));
        let mut again = MovingSkin::new(10.0);
        again.restore(moving.saved());
        assert_eq!(again, moving);
        moving.forget();
        assert_eq!(moving, MovingSkin::new(10.0));
    }

    #[test]
    fn clothes_that_move_beside_skin_are_not_learned() {
        let trained = SkinModel::from_option("gaussian").unwrap();
        let colours = [[196, 140, 115], CLOTHES, CLOTHES, CLOTHES];
        let own = after(&mut MovingSkin::new(10.0), WALL, &colours, &trained);
        assert!(own.own.is_some() && is_skin(&own, colours[0]) && !is_skin(&own, CLOTHES));
    }

    #[test]
    fn a_wall_in_other_light_is_not_learned() {
        let trained = SkinModel::from_option("gaussian").unwrap();
        let darker = PALE[0].map(|channel| channel / 8 * 7);
        assert!(is_skin(&trained, darker));
        assert!(after(&mut MovingSkin::new(10.0), PALE[0], &[darker], &trained).own.is_none());
    }

    #[test]
    fn beside_a_histogram_and_at_rest_nothing_is_learned() {
        let [histogram, gaussian] = ["histogram", "gaussian"].map(|name| SkinModel::from_option(name).unwrap());
        assert!(after(&mut MovingSkin::new(10.0), WALL, &PALE, &histogram).own.is_none());
        assert!(after(&mut MovingSkin::new(10.0), WALL, &[WALL], &gaussian).own.is_none());
    }
}
