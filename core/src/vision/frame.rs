//! From a colour frame to blobs with their likelihood and temporal edges.

use super::blobs::{BlobFinder, BlobList};
use super::edges::{EdgeDetector, EdgeList, luminance_line};
use super::mask::{Mask, MaskMut, words_per_row};
use super::morphology::{close_by, open, scratch_words};
use super::runs::Run;
use super::skin::SkinClassifier;
use crate::error::{ParameterError, Rule, within};

/// Working memory for frames of one size; it keeps the previous frame's luminance.
///
/// ```
/// use sinew_core::vision::frame::{FrameBuffers, last_mask, mask_words, runs_that_suffice};
/// use sinew_core::vision::morphology::scratch_words;
/// use sinew_core::vision::runs::Run;
///
/// const WIDTH: usize = 64;
/// const HEIGHT: usize = 48;
/// let buffers = FrameBuffers {
///     mask: &mut [0; mask_words(WIDTH, HEIGHT)],
///     edges: &mut [0; mask_words(WIDTH, HEIGHT)],
///     scratch: &mut [0; scratch_words(WIDTH)],
///     runs: &mut [Run::default(); runs_that_suffice(WIDTH, HEIGHT)],
///     luminance: [&mut [0; WIDTH * HEIGHT], &mut [0; WIDTH * HEIGHT]],
/// };
/// // They fit a frame of this size, and none of twice the width.
/// assert!(last_mask(&buffers, WIDTH, HEIGHT).is_ok());
/// assert!(last_mask(&buffers, 2 * WIDTH, HEIGHT).is_err());
/// ```
#[derive(Debug)]
pub struct FrameBuffers<'a> {
    /// Skin mask, [`mask_words`] words; holds the last frame's mask, after morphology.
    pub mask: &'a mut [u32],
    /// Temporal edge pixels, [`mask_words`] words; holds the last frame's, before they were
    /// thinned.
    pub edges: &'a mut [u32],
    /// Rows of morphology, [`scratch_words`] words.
    pub scratch: &'a mut [u32],
    /// Runs of growing components, see [`runs_that_suffice`]; with fewer, shapes may be incomplete.
    pub runs: &'a mut [Run],
    /// Luminance of two successive frames, width x height bytes each, used alternately.
    pub luminance: [&'a mut [u8]; 2],
}

/// Half the width of the closing, as a fraction of the image's width: 2 pixels of 640.
///
/// Chosen: joins parts that noise and highlights cut apart. Measured against 3x3 in
/// `docs/vision.md` (area under the ROC curve 0.81 against 0.76 on the weakest segmentation, equal
/// on the best).
pub const DEFAULT_CLOSING_FRACTION: f32 = 1.0 / 320.0;

/// Steps of closing for an image of `width` pixels, from 1 to 8.
///
/// ```
/// use sinew_core::vision::frame::{DEFAULT_CLOSING_FRACTION, closing_steps};
///
/// assert_eq!(closing_steps(640, DEFAULT_CLOSING_FRACTION), 2);
/// assert_eq!(closing_steps(160, DEFAULT_CLOSING_FRACTION), 1, "at least one");
/// ```
#[must_use]
pub fn closing_steps(width: usize, closing_fraction: f32) -> u8 {
    crate::math::clamp(crate::math::round(width as f32 * closing_fraction), 1.0, 8.0) as u8
}

/// Words of a mask of this size.
///
/// ```
/// use sinew_core::vision::frame::mask_words;
///
/// static MASK: [u32; mask_words(320, 240)] = [0; mask_words(320, 240)];
/// assert_eq!(MASK.len(), 10 * 240);
/// ```
#[must_use]
pub const fn mask_words(width: usize, height: usize) -> usize {
    words_per_row(width) * height
}

/// Runs that always suffice for the components of a closed mask of this size: gaps between runs are
/// at least three pixels wide.
///
/// ```
/// use sinew_core::vision::frame::runs_that_suffice;
/// use sinew_core::vision::runs::Run;
///
/// // The worst case of 320 x 240 pixels, a constant of the program.
/// let mut runs = [Run::default(); runs_that_suffice(320, 240)];
/// assert_eq!(runs.len(), 81 * 240, "a run and a gap take four pixels at least");
/// # runs[0] = Run::default();
/// ```
#[must_use]
pub const fn runs_that_suffice(width: usize, height: usize) -> usize {
    (width + 3).div_ceil(4) * height
}

/// Finds blobs and temporal edges, a tracker's input, in each frame.
///
/// `RUNS` and `OPEN` bound the scan for components, see
/// [`super::component_scanner::ComponentScanner`].
///
/// ```
/// use sinew_core::vision::blobs::{BlobFinder, DEFAULT_MIN_AREA_FRACTION};
/// use sinew_core::vision::edges::EdgeDetector;
/// use sinew_core::vision::features::{BlobMeter, DEFAULT_FILL_RATIO};
/// use sinew_core::vision::frame::FrameAnalyser;
/// use sinew_core::vision::hand_likelihood::HandLikelihood;
///
/// // The page of `vision` runs one on frames. A wider closing joins parts that are farther apart.
/// let (meter, likelihood) = (BlobMeter::new(DEFAULT_FILL_RATIO)?, HandLikelihood::default());
/// let finder = BlobFinder::<32, 32>::new(meter, likelihood, DEFAULT_MIN_AREA_FRACTION);
/// let analyser = FrameAnalyser::new(finder, EdgeDetector::default());
/// assert!(analyser.clone().with_closing_fraction(0.01).is_ok());
/// let refused = analyser.with_closing_fraction(0.2).map_err(|error| error.parameter);
/// assert_eq!(refused.err(), Some("closing_fraction"));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct FrameAnalyser<const RUNS: usize, const OPEN: usize> {
    finder: BlobFinder<RUNS, OPEN>,
    detector: EdgeDetector,
    closing_fraction: f32,
    /// Whether the next frame's luminance goes into the second buffer.
    odd: bool,
    /// Size of the frame whose luminance is kept.
    last_size: Option<(usize, usize)>,
}

impl<const RUNS: usize, const OPEN: usize> FrameAnalyser<RUNS, OPEN> {
    /// An analyser before its first frame.
    #[must_use]
    pub fn new(finder: BlobFinder<RUNS, OPEN>, detector: EdgeDetector) -> Self {
        Self { finder, detector, closing_fraction: DEFAULT_CLOSING_FRACTION, odd: false, last_size: None }
    }

    /// The same analyser with another closing: half its width as a part of the image's width, see
    /// [`closing_steps`].
    ///
    /// # Errors
    /// The fraction has to lie from 0 to 0.05.
    pub fn with_closing_fraction(self, closing_fraction: f32) -> Result<Self, ParameterError> {
        Ok(Self { closing_fraction: within("closing_fraction", closing_fraction, 0.0, 0.05)?, ..self })
    }

    /// Forgets the last frame, so that the next one has no temporal edges.
    pub fn forget_last_frame(&mut self) {
        self.last_size = None;
    }

    /// The luminance of the last frame in the buffers, row by row; empty before the first frame.
    #[must_use]
    pub fn last_luminance<'b>(&self, buffers: &'b FrameBuffers<'_>) -> &'b [u8] {
        let pixels = self.last_size.map_or(0, |(width, height)| width * height);
        let [even, odd] = &buffers.luminance;
        let last = if self.odd { even } else { odd };
        last.get(..pixels).unwrap_or(&[])
    }

    /// Analyses one frame of `width` x `height` interleaved RGB pixels.
    ///
    /// Blobs and edges replace the contents of the lists. The first frame, and one of another size,
    /// has no edges.
    ///
    /// # Errors
    /// Sides from 1 to [`super::mask::MAX_SIDE_PX`], 3 `width` x `height` bytes, and buffers as
    /// long as [`FrameBuffers`] states.
    pub fn analyse<const BLOBS: usize, const EDGES: usize>(
        &mut self,
        rgb: &[u8],
        (width, height): (usize, usize),
        skin: &impl SkinClassifier,
        buffers: &mut FrameBuffers<'_>,
        blobs: &mut BlobList<BLOBS>,
        edges: &mut EdgeList<EDGES>,
    ) -> Result<(), ParameterError> {
        blobs.clear();
        edges.clear();
        check_lengths(rgb, width, height, buffers)?;
        let mut mask = MaskMut::new(buffers.mask, width, height)?;
        segment(rgb, skin, &mut mask);
        open(&mut mask, buffers.scratch)?;
        close_by(&mut mask, closing_steps(width, self.closing_fraction), buffers.scratch)?;
        self.finder.find(&mask.view(), buffers.runs, blobs);
        let [even, odd] = &mut buffers.luminance;
        let (now, before) = if self.odd { (odd, even) } else { (even, odd) };
        luminance_line(rgb, &mut now[..width * height]);
        self.odd = !self.odd;
        if self.last_size == Some((width, height)) {
            self.detector.find(now, before, width, height, buffers.edges)?;
            edges.take_mask(&buffers.edges[..mask_words(width, height)], width);
        } else {
            buffers.edges.fill(0);
        }
        self.last_size = Some((width, height));
        Ok(())
    }
}

/// Classifies each line of a frame into a row of `mask`; lines that `rgb` does not hold become
/// zero.
///
/// ```
/// use sinew_core::vision::frame::segment;
/// use sinew_core::vision::mask::MaskMut;
/// use sinew_core::vision::skin::GaussianSkin;
///
/// let skin = GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?;
/// // Two lines of two pixels: skin on the left, a wall on the right.
/// let (hand, wall) = ([200, 140, 110], [20, 40, 90]);
/// let mut words = [0; 2];
/// segment(
///     [hand, wall, hand, wall].as_flattened(),
///     &skin,
///     &mut MaskMut::new(&mut words, 2, 2)?,
/// );
/// assert_eq!(words, [0b01, 0b01]);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
pub fn segment(rgb: &[u8], skin: &impl SkinClassifier, mask: &mut MaskMut<'_>) {
    let stride = 3 * mask.width();
    mask.write_rows(|v, row| skin.classify_line(rgb.get(v * stride..(v + 1) * stride).unwrap_or(&[]), row));
}

/// The last frame's mask in the buffers.
///
/// ```
/// use sinew_core::vision::frame::{FrameBuffers, last_mask, mask_words};
///
/// // Words as `FrameAnalyser::analyse` leaves them: here one row of skin.
/// let mut mask = [0; mask_words(32, 4)];
/// mask[2] = 0xff;
/// let luminance: [&mut [u8]; 2] = [&mut [], &mut []];
/// let buffers = FrameBuffers {
///     mask: &mut mask,
///     edges: &mut [],
///     scratch: &mut [],
///     runs: &mut [],
///     luminance,
/// };
/// let skin = last_mask(&buffers, 32, 4)?;
/// assert_eq!(skin.count(), 8);
/// assert!(last_mask(&buffers, 640, 480).is_err(), "that was no frame of this size");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
///
/// # Errors
/// If the buffers were used with another size.
pub fn last_mask<'b>(buffers: &'b FrameBuffers<'_>, width: usize, height: usize) -> Result<Mask<'b>, ParameterError> {
    Mask::new(buffers.mask, width, height)
}

fn check_lengths(rgb: &[u8], width: usize, height: usize, buffers: &FrameBuffers<'_>) -> Result<(), ParameterError> {
    let side = super::mask::MAX_SIDE_PX;
    if width > side || height > side {
        return Err(ParameterError::new("frame side", Rule::Capacity { capacity: side }));
    }
    let (pixels, words) = (width * height, mask_words(width, height));

    let checks = [
        ("rgb", rgb.len(), 3 * pixels),
        ("buffers.mask", buffers.mask.len(), words),
        ("buffers.edges", buffers.edges.len(), words),
        ("buffers.scratch", buffers.scratch.len(), scratch_words(width)),
        ("buffers.luminance", buffers.luminance[0].len().min(buffers.luminance[1].len()), pixels),
    ];
    match checks.into_iter().find(|&(_, have, expected)| have < expected) {
        Some((parameter, _, expected)) => Err(ParameterError::new(parameter, Rule::SameLength { expected })),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vision::blobs::DEFAULT_MIN_AREA_FRACTION;
    use crate::vision::features::{BlobMeter, DEFAULT_FILL_RATIO};
    use crate::vision::hand_likelihood::HandLikelihood;
    use crate::vision::skin::GaussianSkin;
    use proptest::prelude::*;

    const SKIN: [u8; 3] = [200, 140, 110];

    /// Analyses frames of one size one after the other and gives what the last one held.
    fn analysed<const BLOBS: usize>(frames: &[Vec<u8>], size: (usize, usize)) -> (BlobList<BLOBS>, EdgeList<500>) {
        let (width, height) = size;
        let words = mask_words(width, height);
        let (mut mask, mut edge_bits) = (vec![0; words], vec![0; words]);
        let mut scratch = vec![0; scratch_words(width)];
        let mut runs = vec![Run::default(); runs_that_suffice(width, height)];
        let (mut luminance, mut previous) = (vec![0; width * height], vec![0; width * height]);
        let mut buffers = FrameBuffers {
            mask: &mut mask,
            edges: &mut edge_bits,
            scratch: &mut scratch,
            runs: &mut runs,
            luminance: [&mut luminance, &mut previous],
        };
        let skin = GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60).unwrap();
        let meter = BlobMeter::new(DEFAULT_FILL_RATIO).unwrap();
        let finder = BlobFinder::<1024, 256>::new(meter, HandLikelihood::default(), DEFAULT_MIN_AREA_FRACTION);
        let mut analyser = FrameAnalyser::new(finder, EdgeDetector::default());
        let (mut blobs, mut edges) = (BlobList::new(), EdgeList::new());
        for rgb in frames {
            analyser.analyse(rgb, size, &skin, &mut buffers, &mut blobs, &mut edges).unwrap();
        }
        assert!(last_mask(&buffers, width, height).is_ok());
        (blobs, edges)
    }

    fn frame((width, height): (usize, usize), skin: impl Fn(usize, usize) -> bool) -> Vec<u8> {
        let pixels = (0..width * height).map(|i| if skin(i % width, i / width) { SKIN } else { [20, 40, 90] });
        pixels.flatten().collect()
    }

    #[test]
    fn a_moving_square_is_a_blob_with_edges() {
        let size = (160, 120);
        let square = |left: usize| frame(size, |u, v| (left..left + 30).contains(&u) && (50..80).contains(&v));
        let (blobs, edges) = analysed::<8>(&[square(40), square(46)], size);
        let [found] = blobs.as_slice() else { panic!("{blobs:?}") };
        assert_eq!(found.blob.area_px, 900);
        assert!(found.blob.shape_complete && found.likelihood > 0.9);
        assert_eq!(blobs.candidates().next().unwrap().centre, crate::camera::Pixel::new(60.5, 64.5));
        assert!((60..=500).contains(&edges.as_slice().len()), "{}", edges.as_slice().len());
        let (_, still) = analysed::<8>(&[square(40), square(40)], size);
        assert!(still.as_slice().is_empty());
    }

    #[test]
    fn the_least_likely_blobs_are_dropped_and_counted() {
        let size = (200, 60);
        let squares = frame(size, |u, v| u % 20 < 3 + u / 20 && v < 3 + u / 20);
        let (all, _) = analysed::<32>(core::slice::from_ref(&squares), size);
        let (few, _) = analysed::<4>(core::slice::from_ref(&squares), size);
        let (none, _) = analysed::<0>(&[squares], size);
        assert_eq!(few.as_slice(), &all.as_slice()[..4]);
        assert_eq!(few.dropped_blobs as usize, all.as_slice().len() - 4);
        assert_eq!(none.dropped_blobs as usize, all.as_slice().len());
        assert!(all.as_slice().is_sorted_by(|a, b| a.likelihood >= b.likelihood));
    }

    #[test]
    fn frames_of_any_size_all_skin_or_none_do_not_panic() {
        for size in [(1, 1), (1, 50), (50, 1), (2, 2), (3, 3), (33, 5), (31, 64), (700, 33), (1920, 1080)] {
            for skin in [true, false] {
                let rgb = frame(size, |_, _| skin);
                let (blobs, edges) = analysed::<4>(&[rgb.clone(), rgb], size);
                assert_eq!(blobs.as_slice().len(), usize::from(skin), "{size:?}");
                assert!(blobs.as_slice().iter().all(|b| b.blob.area_px as usize == size.0 * size.1));
                assert!(edges.as_slice().is_empty());
            }
        }
    }

    #[test]
    fn short_buffers_are_refused_by_name() {
        let meter = BlobMeter::new(1.0).unwrap();
        let finder = BlobFinder::<4, 4>::new(meter, HandLikelihood::default(), 0.0);
        let mut analyser = FrameAnalyser::new(finder, EdgeDetector::default());
        let skin = GaussianSkin::new(0.44, 0.31, [0.003, 0.0, 0.001], 2.0, 60).unwrap();
        let mut buffers = FrameBuffers {
            mask: &mut [0; 4],
            edges: &mut [0; 3],
            scratch: &mut [0; 3],
            runs: &mut [],
            luminance: [&mut [0; 16], &mut [0; 16]],
        };
        let mut run = |rgb: &[u8], size| {
            let lists = (&mut BlobList::<2>::new(), &mut EdgeList::<2>::new());
            analyser.analyse(rgb, size, &skin, &mut buffers, lists.0, lists.1).unwrap_err().parameter
        };
        assert_eq!(run(&[0; 47], (4, 4)), "rgb");
        assert_eq!(run(&[0; 48], (4, 4)), "buffers.edges");
        assert_eq!(run(&[], (0, 4)), "width");
        assert_eq!(run(&[], (1 << 40, 1 << 40)), "frame side");
    }

    proptest! {
        #[test]
        fn noise_never_panics_and_likelihoods_are_probabilities(
            width in 1_usize..90, height in 1_usize..40, seeds in prop::collection::vec(any::<u32>(), 90 * 40), coarse in 1_usize..6,
        ) {
            let at = |u: usize, v: usize| seeds[(v / coarse) * 90 + u / coarse].count_ones() > 15;
            let (blobs, _) = analysed::<6>(&[frame((width, height), at)], (width, height));
            for entry in blobs.as_slice() {
                prop_assert!((0.0..=1.0).contains(&entry.likelihood));
                prop_assert!(entry.blob.shape_complete, "the pool's stated size did not suffice");
            }
        }
    }
}
