//! From camera lines to blobs and temporal edges, in buffers of fixed size and without a colour frame.

use crate::camera::{HEIGHT, LINE_BYTES, WIDTH};
use sinew_core::error::ParameterError;
use sinew_core::observation::candidate::HandCandidate;
use sinew_core::vision::blobs::{BlobFinder, BlobList, DEFAULT_MIN_AREA_FRACTION};
use sinew_core::vision::edges::{EdgeDetector, EdgeList, EdgePixel, luminance_line};
use sinew_core::vision::features::{BlobMeter, DEFAULT_FILL_RATIO};
use sinew_core::vision::frame::{DEFAULT_CLOSING_FRACTION, closing_steps, mask_words};
use sinew_core::vision::hand_likelihood::HandLikelihood;
use sinew_core::vision::mask::{MaskMut, words_per_row};
use sinew_core::vision::morphology::{close_by, open, scratch_words};
use sinew_core::vision::runs::Run;
use sinew_core::vision::skin::{GaussianSkin, SkinClassifier};

/// Words of a line's mask.
const ROW_WORDS: usize = words_per_row(WIDTH);
/// Words of a frame's mask.
const MASK_WORDS: usize = mask_words(WIDTH, HEIGHT);
/// Runs of a line and components that grow at once; half of the width always suffices.
const LINE_CAPACITY: usize = WIDTH / 2;
/// Runs of growing components; less than always suffices, enough for a few hands and faces.
const POOL_RUNS: usize = 1024;
/// Most blobs of a frame.
const MAX_BLOBS: usize = 8;
/// Most temporal edge pixels of a frame.
const MAX_EDGES: usize = 512;

/// The finder with its working memory.
pub type Finder = BlobFinder<LINE_CAPACITY, LINE_CAPACITY>;

/// Everything that vision keeps.
#[derive(Debug)]
pub struct FrontEnd {
    skin: GaussianSkin,
    detector: EdgeDetector,
    finder: Finder,
    mask: [u32; MASK_WORDS],
    edge_bits: [u32; MASK_WORDS],
    scratch: [u32; scratch_words(WIDTH)],
    runs: [Run; POOL_RUNS],
    luminance: [[u8; WIDTH * HEIGHT]; 2],
    /// Which of the two luminance frames is being written.
    now: usize,
    /// Whether the other one holds the frame before.
    has_previous: bool,
    blobs: BlobList<MAX_BLOBS>,
    candidates: [HandCandidate; MAX_BLOBS],
    edges: EdgeList<MAX_EDGES>,
}

impl FrontEnd {
    /// A front end before its first line.
    ///
    /// # Errors
    /// None with the constants of this file.
    pub fn new() -> Result<Self, ParameterError> {
        let meter = BlobMeter::new(DEFAULT_FILL_RATIO)?;
        Ok(Self {
            skin: GaussianSkin::new(0.45, 0.316, [0.0017, 0.0, 0.0002], 2.25, 215)?,
            detector: EdgeDetector::default(),
            finder: Finder::new(meter, HandLikelihood::default(), DEFAULT_MIN_AREA_FRACTION),
            mask: [0; MASK_WORDS],
            edge_bits: [0; MASK_WORDS],
            scratch: [0; scratch_words(WIDTH)],
            runs: [Run::default(); POOL_RUNS],
            luminance: [[0; WIDTH * HEIGHT]; 2],
            now: 0,
            has_previous: false,
            blobs: BlobList::new(),
            candidates: [HandCandidate::default(); MAX_BLOBS],
            edges: EdgeList::new(),
        })
    }

    /// Takes line `v` of a frame; lines beyond the image are ignored.
    pub fn line(&mut self, v: usize, rgb: &[u8; LINE_BYTES]) {
        if v >= HEIGHT {
            return;
        }
        self.skin.classify_line(rgb, &mut self.mask[v * ROW_WORDS..(v + 1) * ROW_WORDS]);
        luminance_line(rgb, &mut self.luminance[self.now & 1][v * WIDTH..(v + 1) * WIDTH]);
    }

    /// Ends a frame: what its lines showed.
    ///
    /// # Errors
    /// None with the constants of this file.
    pub fn end_frame(&mut self) -> Result<(&[HandCandidate], &[EdgePixel]), ParameterError> {
        let mut mask = MaskMut::new(&mut self.mask, WIDTH, HEIGHT)?;
        open(&mut mask, &mut self.scratch)?;
        close_by(&mut mask, closing_steps(WIDTH, DEFAULT_CLOSING_FRACTION), &mut self.scratch)?;
        self.finder.find(&mask.view(), &mut self.runs, &mut self.blobs);
        self.edges.clear();
        if self.has_previous {
            let [even, odd] = &self.luminance;
            let (now, before) = if self.now & 1 == 0 { (even, odd) } else { (odd, even) };
            self.detector.find(now, before, WIDTH, HEIGHT, &mut self.edge_bits)?;
            self.edges.take_mask(&self.edge_bits, WIDTH);
        }
        self.now ^= 1;
        self.has_previous = true;
        let mut count = 0;
        for (slot, candidate) in self.candidates.iter_mut().zip(self.blobs.candidates()) {
            *slot = candidate;
            count += 1;
        }
        Ok((&self.candidates[..count], self.edges.as_slice()))
    }

    /// Forgets the last frame, as after a missing one.
    pub fn forget_last_frame(&mut self) {
        self.has_previous = false;
    }
}
