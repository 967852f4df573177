//! Memory for one picture and what vision leaves behind for the next.

use heapless::Vec;
use sinew_core::error::{ParameterError, Rule};
use sinew_core::vision::frame::{FrameBuffers, mask_words, runs_that_suffice};
use sinew_core::vision::morphology::scratch_words;
use sinew_core::vision::runs::Run;

/// Maximum number of pixels of a picture: 640 x 480, upright or across.
pub const MAX_PIXELS: usize = 640 * 480;
/// Longest side, pixels.
pub const MAX_SIDE_PX: usize = 640;
/// Rows of a picture whose last word is not full take up to one word more each.
const MASK_WORDS: usize = MAX_PIXELS / 32 + MAX_SIDE_PX;
/// The same for runs, of which a row has one for every four pixels.
const RUNS: usize = MAX_PIXELS / 4 + 2 * MAX_SIDE_PX;

/// A picture and the working memory of vision; all zero at first.
#[derive(Debug)]
pub struct Frame {
    /// What the page writes: red, green, blue and a byte that is not read.
    pub rgba: [u8; 4 * MAX_PIXELS],
    /// The same without the fourth byte.
    rgb: [u8; 3 * MAX_PIXELS],
    luminance: [[u8; MAX_PIXELS]; 2],
    mask: [u32; MASK_WORDS],
    edges: [u32; MASK_WORDS],
    scratch: [u32; scratch_words(MAX_SIDE_PX)],
    /// Full after the first use.
    runs: Vec<Run, RUNS>,
    /// The skin mask as a picture: its colour where skin is, transparent elsewhere.
    pub skin_rgba: [u8; 4 * MAX_PIXELS],
}

/// Checks that a picture of this size has room.
///
/// # Errors
/// Sides from 1 to [`MAX_SIDE_PX`], at most [`MAX_PIXELS`] pixels.
pub fn checked_size(width: usize, height: usize) -> Result<(), ParameterError> {
    let rule = Rule::Within { low: 1.0, high: MAX_SIDE_PX as f32 };
    for (name, side) in [("width", width), ("height", height)] {
        if !(1..=MAX_SIDE_PX).contains(&side) {
            return Err(ParameterError::new(name, rule));
        }
    }
    let too_many = ParameterError::new("width x height", Rule::Capacity { capacity: MAX_PIXELS });
    if width * height > MAX_PIXELS { Err(too_many) } else { Ok(()) }
}

impl Frame {
    /// A black picture.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            rgba: [0; 4 * MAX_PIXELS],
            rgb: [0; 3 * MAX_PIXELS],
            luminance: [[0; MAX_PIXELS]; 2],
            mask: [0; MASK_WORDS],
            edges: [0; MASK_WORDS],
            scratch: [0; scratch_words(MAX_SIDE_PX)],
            runs: Vec::new(),
            skin_rgba: [0; 4 * MAX_PIXELS],
        }
    }

    /// The same on the heap, made on a stack that has room for it.
    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn boxed() -> Box<Self> {
        let made = std::thread::Builder::new().stack_size(64 << 20).spawn(|| Box::new(Self::new()));
        made.ok().and_then(|thread| thread.join().ok()).unwrap_or_default()
    }

    /// Takes the picture that the page wrote.
    pub fn take_rgba(&mut self, pixels: usize) {
        let from = self.rgba.as_chunks::<4>().0.iter().take(pixels);
        for (&[red, green, blue, _], to) in from.zip(self.rgb.as_chunks_mut::<3>().0) {
            *to = [red, green, blue];
        }
    }

    /// The picture's first `pixels` pixels as interleaved RGB, and the memory that vision works in.
    pub fn parts(&mut self, (width, height): (usize, usize)) -> (&[u8], FrameBuffers<'_>) {
        let pixels = (width * height).min(MAX_PIXELS);
        let words = mask_words(width, height).min(MASK_WORDS);
        let runs = runs_that_suffice(width, height).min(RUNS);
        // As many as there is room for, so this cannot fail.
        let _ = self.runs.resize_default(RUNS);
        let [first, second] = &mut self.luminance;
        let buffers = FrameBuffers {
            mask: &mut self.mask[..words],
            edges: &mut self.edges[..words],
            scratch: &mut self.scratch[..scratch_words(width)],
            runs: &mut self.runs[..runs],
            luminance: [&mut first[..pixels], &mut second[..pixels]],
        };
        (&self.rgb[..3 * pixels], buffers)
    }

    /// Interleaved RGB of the picture's first `pixels` pixels.
    #[must_use]
    pub fn rgb(&self, pixels: usize) -> &[u8] {
        &self.rgb[..3 * pixels.min(MAX_PIXELS)]
    }

    /// Paints the last skin mask of a picture of `width` x `height` into [`Self::skin_rgba`].
    pub fn paint_skin(&mut self, (width, height): (usize, usize), colour: [u8; 4]) {
        let rows = self.skin_rgba.as_chunks_mut::<4>().0.chunks_exact_mut(width.max(1));
        let words = self.mask.chunks_exact(mask_words(width, 1).max(1));
        for (row, bits) in rows.zip(words).take(height) {
            for (pixels, &word) in row.chunks_mut(32).zip(bits) {
                for (i, pixel) in pixels.iter_mut().enumerate() {
                    *pixel = if word >> (i & 31) & 1 == 1 { colour } else { [0; 4] };
                }
            }
        }
    }
}

impl Default for Frame {
    fn default() -> Self {
        Self::new()
    }
}
