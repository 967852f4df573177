//! The observations of each frame for the trackers: the core's front end with buffers that fit the
//! frames.

use crate::error::Result;
use crate::pixels::{Picture, Pixels};
use image::{GrayImage, Luma};
use sinew_core::vision::blobs::{BlobFinder, BlobList, DEFAULT_MIN_AREA_FRACTION, LikelyBlob};
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::edges::{EdgeDetector, EdgeList, EdgePixel};
use sinew_core::vision::features::{BlobMeter, DEFAULT_FILL_RATIO};
use sinew_core::vision::frame::{FrameAnalyser, FrameBuffers, last_mask, mask_words, runs_that_suffice};
use sinew_core::vision::front_end::moment_blob::MomentBlob;
use sinew_core::vision::hand_likelihood::HandLikelihood;
use sinew_core::vision::morphology::scratch_words;
use sinew_core::vision::objects::grid::CellGrid;
use sinew_core::vision::runs::Run;
use sinew_core::vision::skin::SkinClassifier;

/// Runs of one line and components that grow at once: enough for lines of 2048 pixels and any mask.
const LINE_CAPACITY: usize = 1024;
/// Maximum number of blobs of a frame.
pub const MAX_BLOBS: usize = 64;
/// Most temporal edge pixels of a frame; more are thinned evenly.
pub const MAX_EDGES: usize = 4096;

/// What one frame shows.
#[derive(Debug, Clone, Default)]
pub struct FrameView {
    /// Blobs, the most likely first.
    pub blobs: Vec<LikelyBlob>,
    /// Those of a front end that reads lines, in place of these.
    pub line_blobs: Vec<MomentBlob>,
    /// The same as the trackers see them.
    pub candidates: Vec<HandCandidate>,
    /// Temporal edge pixels.
    pub edges: Vec<EdgePixel>,
    /// Blobs and components that found no room.
    pub dropped_blobs: u32,
}

/// Analyses frames one after the other; frames may differ in size, which starts the edges anew.
#[derive(Debug)]
pub struct FrameReader {
    analyser: Box<FrameAnalyser<LINE_CAPACITY, LINE_CAPACITY>>,
    buffers: Buffers,
    blobs: Box<BlobList<MAX_BLOBS>>,
    edges: Box<EdgeList<MAX_EDGES>>,
    size: (usize, usize),
}

#[derive(Debug, Default)]
struct Buffers {
    mask: Vec<u32>,
    edges: Vec<u32>,
    scratch: Vec<u32>,
    runs: Vec<Run>,
    luminance: [Vec<u8>; 2],
}

impl Buffers {
    fn fit(&mut self, (width, height): (usize, usize)) {
        self.mask.resize(mask_words(width, height), 0);
        self.edges.resize(mask_words(width, height), 0);
        self.scratch.resize(scratch_words(width), 0);
        self.runs.resize(runs_that_suffice(width, height), Run::default());
        for plane in &mut self.luminance {
            plane.resize(width * height, 0);
        }
    }

    fn borrow(&mut self) -> FrameBuffers<'_> {
        let [first, second] = &mut self.luminance;
        FrameBuffers {
            mask: &mut self.mask,
            edges: &mut self.edges,
            scratch: &mut self.scratch,
            runs: &mut self.runs,
            luminance: [first, second],
        }
    }
}

impl FrameReader {
    /// A reader before its first frame.
    ///
    /// # Errors
    /// None with the shipped constants.
    pub fn new(likelihood: HandLikelihood, detector: EdgeDetector) -> Result<Self> {
        let finder = BlobFinder::new(BlobMeter::new(DEFAULT_FILL_RATIO)?, likelihood, DEFAULT_MIN_AREA_FRACTION);
        Ok(Self {
            analyser: Box::new(FrameAnalyser::new(finder, detector)),
            buffers: Buffers::default(),
            blobs: Box::default(),
            edges: Box::default(),
            size: (0, 0),
        })
    }

    /// Forgets the last frame: the next one has no temporal edges, as after a missing image.
    pub fn forget_last_frame(&mut self) {
        self.analyser.forget_last_frame();
    }

    /// Analyses one frame.
    ///
    /// # Errors
    /// Images with a side above the core's limit.
    pub fn read(&mut self, image: &Picture<impl Pixels>, skin: &impl SkinClassifier) -> Result<FrameView> {
        let size = (image.width() as usize, image.height() as usize);
        if size != self.size {
            self.buffers.fit(size);
            self.size = size;
        }
        let mut buffers = self.buffers.borrow();
        self.analyser.analyse(image.as_raw(), size, skin, &mut buffers, &mut self.blobs, &mut self.edges)?;
        Ok(FrameView {
            blobs: self.blobs.as_slice().to_vec(),
            candidates: self.blobs.candidates().collect(),
            edges: self.edges.as_slice().to_vec(),
            dropped_blobs: self.blobs.dropped_blobs + self.blobs.dropped_components,
            line_blobs: Vec::new(),
        })
    }

    /// Gives the last frame, its mask after morphology and its brightness, to a grid of cells.
    pub fn fill<const COLUMNS: usize, const ROWS: usize>(&mut self, grid: &mut CellGrid<COLUMNS, ROWS>) {
        let (width, height) = self.size;
        let buffers = self.buffers.borrow();
        let (Ok(mask), luminance) = (last_mask(&buffers, width, height), self.analyser.last_luminance(&buffers)) else {
            return;
        };
        grid.begin();
        for (v, (bits, levels)) in mask.rows().zip(luminance.chunks(width)).enumerate() {
            grid.line(v, bits, levels, 1);
        }
    }

    /// Brightness of the last frame: what the next one is compared with. None before the first
    /// frame and where the last one was forgotten.
    pub fn last_luminance(&mut self) -> Option<GrayImage> {
        let (width, height) = self.size;
        let buffers = self.buffers.borrow();
        let levels = self.analyser.last_luminance(&buffers);
        if levels.is_empty() { None } else { GrayImage::from_raw(width as u32, height as u32, levels.to_vec()) }
    }

    /// The last frame's mask after morphology, 255 = skin.
    #[must_use]
    pub fn mask(&mut self) -> GrayImage {
        let (width, height) = self.size;
        let buffers = self.buffers.borrow();
        let mask = last_mask(&buffers, width, height).ok();
        GrayImage::from_fn(width as u32, height as u32, |u, v| {
            let skin = mask.is_some_and(|mask| mask.get(u as usize, v as usize));
            Luma([if skin { 255 } else { 0 }])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::RgbImage;
    use sinew_core::vision::skin::GaussianSkin;

    fn skin() -> GaussianSkin {
        GaussianSkin::new(0.45, 0.31, [0.001, 0.0, 0.0005], 2.5, 40).unwrap()
    }

    fn reader() -> FrameReader {
        FrameReader::new(HandLikelihood::default(), EdgeDetector::default()).unwrap()
    }

    fn disc(size: u32, u: f32) -> RgbImage {
        RgbImage::from_fn(size, size, |x, y| {
            let inside = (x as f32 - u).powi(2) + (y as f32 - 60.0).powi(2) < 400.0;
            image::Rgb(if inside { [180, 124, 96] } else { [60, 90, 140] })
        })
    }

    #[test]
    fn a_moving_disc_is_one_blob_with_edges_from_the_second_frame_on() {
        let mut reader = reader();
        let first = reader.read(&disc(120, 50.0), &skin()).unwrap();
        assert_eq!((first.blobs.len(), first.edges.len()), (1, 0));
        let second = reader.read(&disc(120, 54.0), &skin()).unwrap();
        assert!((second.candidates[0].centre.u_px - 54.0).abs() < 0.5);
        assert!(second.edges.len() > 20, "{} edges", second.edges.len());
        let third = reader.read(&disc(120, 54.0), &skin()).unwrap();
        assert!(third.edges.is_empty(), "a still frame has no moving edges");
        assert_eq!(reader.mask().get_pixel(54, 60).0, [255]);
    }

    #[test]
    fn images_of_any_size_pass() {
        let mut reader = reader();
        for (width, height) in [(1, 1), (1, 50), (50, 1), (33, 7), (2000, 3)] {
            for colour in [[180, 124, 96], [0, 0, 0]] {
                reader.read(&RgbImage::from_pixel(width, height, image::Rgb(colour)), &skin()).unwrap();
            }
        }
    }
}
