//! The chain of this crate, whole and step by step.

use crate::scene::{FramePair, skin};
use crate::timed;
use sinew_core::vision::blobs::{BlobFinder, BlobList, DEFAULT_MIN_AREA_FRACTION};
use sinew_core::vision::edges::{EdgeDetector, EdgeList, luminance_line};
use sinew_core::vision::features::{BlobMeter, DEFAULT_FILL_RATIO};
use sinew_core::vision::frame::{
    DEFAULT_CLOSING_FRACTION, FrameAnalyser, FrameBuffers, closing_steps, mask_words, runs_that_suffice, segment,
};
use sinew_core::vision::hand_likelihood::HandLikelihood;
use sinew_core::vision::mask::MaskMut;
use sinew_core::vision::morphology::{close_by, open, scratch_words};
use sinew_core::vision::runs::Run;
use sinew_core::vision::skin::GaussianSkin;

const RUNS: usize = 1024;
const OPEN: usize = 512;

/// Working memory of the chain.
pub struct SinewChain {
    skin: GaussianSkin,
    finder: Box<BlobFinder<RUNS, OPEN>>,
    analyser: Box<FrameAnalyser<RUNS, OPEN>>,
    mask: Vec<u32>,
    edge_bits: Vec<u32>,
    scratch: Vec<u32>,
    runs: Vec<Run>,
    luminance: Vec<u8>,
    previous: Vec<u8>,
    blobs: BlobList<32>,
    edges: EdgeList<4096>,
    later: bool,
}

impl SinewChain {
    /// Memory for frames of this size.
    pub fn new(pair: &FramePair) -> Self {
        let (width, height) = (pair.width, pair.height);
        let meter = BlobMeter::new(DEFAULT_FILL_RATIO).expect("the default is in range");
        let finder = BlobFinder::new(meter, HandLikelihood::default(), DEFAULT_MIN_AREA_FRACTION);
        Self {
            skin: skin(),
            analyser: Box::new(FrameAnalyser::new(finder.clone(), EdgeDetector::default())),
            finder: Box::new(finder),
            mask: vec![0; mask_words(width, height)],
            edge_bits: vec![0; mask_words(width, height)],
            scratch: vec![0; scratch_words(width)],
            runs: vec![Run::default(); runs_that_suffice(width, height)],
            luminance: vec![0; width * height],
            previous: vec![0; width * height],
            blobs: BlobList::new(),
            edges: EdgeList::new(),
            later: true,
        }
    }

    /// Blobs of the last frame.
    pub fn blob_count(&self) -> usize {
        self.blobs.as_slice().len()
    }

    /// Temporal edge pixels of the last frame.
    pub fn edge_count(&self) -> u32 {
        self.edges.as_slice().len() as u32 + self.edges.dropped
    }

    /// Analyses a frame as a tracker does; both frames take turns, so that the edges are those
    /// between them.
    pub fn whole(&mut self, pair: &FramePair) {
        let mut buffers = FrameBuffers {
            mask: &mut self.mask,
            edges: &mut self.edge_bits,
            scratch: &mut self.scratch,
            runs: &mut self.runs,
            luminance: [&mut self.luminance, &mut self.previous],
        };
        let size = (pair.width, pair.height);
        self.later = !self.later;
        let frame = if self.later { &pair.now } else { &pair.before };
        self.analyser
            .analyse(frame.as_raw(), size, &self.skin, &mut buffers, &mut self.blobs, &mut self.edges)
            .expect("the buffers have the right lengths");
    }

    /// Seconds for segmentation, morphology, components with features, edges, and for all of it.
    pub fn steps(&mut self, pair: &FramePair) -> [f64; 5] {
        let (width, height) = (pair.width, pair.height);
        let mut mask = MaskMut::new(&mut self.mask, width, height).expect("the size is in range");
        let segmentation = timed(|| segment(pair.now.as_raw(), &self.skin, &mut mask));
        let morphology = timed(|| {
            open(&mut mask, &mut self.scratch)?;
            close_by(&mut mask, closing_steps(width, DEFAULT_CLOSING_FRACTION), &mut self.scratch)
        });
        let components = timed(|| self.finder.find(&mask.view(), &mut self.runs, &mut self.blobs));
        luminance_line(pair.before.as_raw(), &mut self.previous);
        let edges = timed(|| {
            luminance_line(pair.now.as_raw(), &mut self.luminance);
            let detector = EdgeDetector::default();
            detector.find(&self.luminance, &self.previous, width, height, &mut self.edge_bits)?;
            self.edges.take_mask(&self.edge_bits, width);
            Ok::<(), sinew_core::error::ParameterError>(())
        });
        [segmentation, morphology, components, edges, segmentation + morphology + components + edges]
    }
}
