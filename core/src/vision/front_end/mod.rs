//! From a camera's lines, as they arrive, to blobs and temporal edge pixels: no frame buffer, no mask of a frame.
//!
//! A line becomes skin bits by one look-up a pixel ([`skin_table`]), is opened and closed four lines later ([`super::line_morphology`]), and
//! goes into the same scanner for components as the host's masks ([`super::component_scanner`]); its luminances are judged against the lines
//! around it and the 1-bit edge map of the frame before ([`edge_lines`]).
//!
//! ```
//! use sinew_core::vision::front_end::{QvgaFrontEnd, edge_lines::EdgeSteps, pixel_format::Rgb565, skin_table::SkinTable};
//! use sinew_core::vision::hand_likelihood::HandLikelihood;
//! use sinew_core::vision::skin::GaussianSkin;
//!
//! let mut table = SkinTable::<Rgb565>::new();
//! table.learn(&GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?);
//! let mut front_end = QvgaFrontEnd::new((320, 240), HandLikelihood::default(), EdgeSteps::default())?;
//!
//! // Lines as a camera sends them, 16 bits a pixel: a hand's worth of skin in the middle.
//! let rgb565 = |[r, g, b]: [u16; 3]| (r >> 3) << 11 | (g >> 2) << 5 | b >> 3;
//! front_end.begin_frame();
//! for v in 0..240 {
//!     let line = std::array::from_fn::<u16, 320, _>(|u| {
//!         let is_skin = (130..180).contains(&u) && (100..150).contains(&v);
//!         rgb565(if is_skin { [200, 140, 110] } else { [20, 40, 90] })
//!     });
//!     front_end.line(v, &line, &table);
//! }
//! let seen = front_end.end_frame();
//! assert_eq!((seen.candidates.len(), seen.losses.missing_lines), (1, 0));
//! assert!((seen.candidates[0].centre.u_px - 154.5).abs() < 0.6);
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

pub mod calibration;
pub mod edge_lines;
pub mod moment_blob;
pub mod pixel_format;
pub mod skin_table;

use super::blobs::{BlobList, DEFAULT_MIN_AREA_FRACTION};
use super::component_scanner::ComponentScanner;
use super::components::Component;
use super::edges::{EdgeList, EdgePixel};
use super::hand_likelihood::HandLikelihood;
use super::line_morphology::LineMorphology;
use super::runs::RunPool;
use crate::error::{ParameterError, Rule};
use crate::observation::candidate::HandCandidate;
use edge_lines::{EdgeLines, EdgeSteps};
use moment_blob::MomentBlob;
use pixel_format::PixelFormat;
use skin_table::SkinTable;

/// What found no room in a frame, or did not come; all zero means that the frame's results are exact.
///
/// ```
/// use sinew_core::vision::front_end::{FrameLosses, QvgaFrontEnd, edge_lines::EdgeSteps};
/// use sinew_core::vision::front_end::{pixel_format::Rgb565, skin_table::SkinTable};
/// use sinew_core::vision::hand_likelihood::HandLikelihood;
///
/// // A camera that drops its last ten lines and repeats one.
/// let mut front_end = QvgaFrontEnd::new((320, 240), HandLikelihood::default(), EdgeSteps::default())?;
/// let table = SkinTable::<Rgb565>::new();
/// front_end.begin_frame();
/// for v in (0..230).chain([229]) {
///     front_end.line(v, &[0; 320], &table);
/// }
/// let losses = front_end.end_frame().losses;
/// assert_eq!(losses, FrameLosses { missing_lines: 10, ignored_lines: 1, ..FrameLosses::default() });
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FrameLosses {
    /// Components that found no room in the table of open ones, see [`ComponentScanner::dropped_components`].
    pub dropped_components: u32,
    /// Pixels of those, and of runs that found no room in their line.
    pub dropped_px: u32,
    /// Blobs less likely than all in the list.
    pub dropped_blobs: u32,
    /// Temporal edge pixels that were thinned out.
    pub dropped_edges: u32,
    /// Lines that did not come, or shorter than the frame's width: without skin where pixels are missing.
    pub missing_lines: u32,
    /// Lines that came twice, too late, or from beyond the frame: ignored.
    pub ignored_lines: u32,
}

/// What a frame showed.
///
/// ```
/// use sinew_core::vision::front_end::{LineFrontEnd, edge_lines::EdgeSteps};
/// use sinew_core::vision::front_end::{pixel_format::Rgb565, skin_table::SkinTable};
/// # use sinew_core::vision::{hand_likelihood::HandLikelihood, skin::GaussianSkin};
/// # let mut table = SkinTable::<Rgb565>::new();
/// # table.learn(&GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?);
/// # const SKIN: u16 = 200 >> 3 << 11 | 140 >> 2 << 5 | 110 >> 3;
///
/// let mut front_end =
///     LineFrontEnd::<2, 16, 16, 4, 64, 24>::new((64, 48), HandLikelihood::default(), EdgeSteps::default())?;
/// // Two squares of skin before black.
/// front_end.begin_frame();
/// for v in 0..48 {
///     let line = core::array::from_fn::<u16, 64, _>(|u| match (u, v) {
///         (10..26, 10..26) | (40..46, 20..26) => SKIN,
///         _ => 0,
///     });
///     front_end.line(v, &line, &table);
/// }
/// let seen = front_end.end_frame();
/// let [first, second] = seen.blobs else { panic!("two squares are two blobs") };
/// assert!(first.moment_likelihood > second.moment_likelihood, "the most likely comes first");
/// assert_eq!(seen.candidates[0].centre, first.centroid, "what a tracker takes, in the same order");
/// assert!(seen.edges.is_empty(), "the first frame has no temporal edges");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct FrameLines<'a> {
    /// Blobs, the most likely first.
    pub blobs: &'a [MomentBlob],
    /// The same as the trackers see them.
    pub candidates: &'a [HandCandidate],
    /// Temporal edge pixels, in the order of rows, at even columns and rows.
    pub edges: &'a [EdgePixel],
    /// What was lost.
    pub losses: FrameLosses,
}

/// Reads frames line by line.
///
/// | parameter | what it bounds |
/// |---|---|
/// | `WORDS` | width: 32 `WORDS` pixels |
/// | `RUNS` | runs of a line after opening and closing; a sixth of the width, and one, always suffices |
/// | `OPEN` | components that grow at the same time; as many as runs always suffice |
/// | `BLOBS` | blobs of a frame |
/// | `EDGES` | temporal edge pixels of a frame |
/// | `MAP_ROWS` | height: 2 `MAP_ROWS` lines have edges |
///
/// ```
/// use sinew_core::vision::front_end::{LineFrontEnd, edge_lines::EdgeSteps};
/// use sinew_core::vision::hand_likelihood::HandLikelihood;
///
/// // A camera of 160 x 120 pixels, of which four blobs and 128 edges are wanted, in less than 7 KiB.
/// type QqvgaFrontEnd = LineFrontEnd<5, 28, 12, 4, 128, 60>;
/// const { assert!(size_of::<QqvgaFrontEnd>() < 7 * 1024) };
/// let new = |size| QqvgaFrontEnd::new(size, HandLikelihood::default(), EdgeSteps::default());
/// assert!(new((160, 120)).is_ok());
/// assert_eq!(new((320, 240)).map_err(|error| error.parameter).err(), Some("width"), "it has no room for more");
/// ```
#[derive(Debug, Clone)]
pub struct LineFrontEnd<
    const WORDS: usize,
    const RUNS: usize,
    const OPEN: usize,
    const BLOBS: usize,
    const EDGES: usize,
    const MAP_ROWS: usize,
> {
    edge_lines: EdgeLines<WORDS, MAP_ROWS>,
    /// Skin or not of the last line, a bit a pixel.
    skin_bits: [u32; WORDS],
    morphology: LineMorphology<WORDS>,
    scanner: ComponentScanner<RUNS, OPEN>,
    likelihood: HandLikelihood,
    min_area_fraction: f32,
    width: usize,
    height: usize,
    /// The line that has to come next.
    next_line: usize,
    blobs: BlobList<BLOBS, MomentBlob>,
    candidates: [HandCandidate; BLOBS],
    edges: EdgeList<EDGES>,
    losses: FrameLosses,
}

/// A front end for 320 x 240 pixels.
///
/// ```
/// use sinew_core::vision::front_end::{QvgaFrontEnd, edge_lines::EdgeSteps};
/// use sinew_core::vision::front_end::{pixel_format::Rgb565, skin_table::SkinTable};
/// use sinew_core::vision::hand_likelihood::HandLikelihood;
/// # use sinew_core::vision::skin::GaussianSkin;
/// # let mut table = SkinTable::<Rgb565>::new();
/// # table.learn(&GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?);
/// # let line = |u0: usize| core::array::from_fn::<u16, 320, _>(|u| {
/// #     if (u0..u0 + 50).contains(&u) { 200 >> 3 << 11 | 140 >> 2 << 5 | 110 >> 3 } else { 0 }
/// # });
///
/// // A hand that moves by eight pixels from frame to frame has temporal edges, and is where the last frame shows it.
/// let mut front_end = QvgaFrontEnd::new((320, 240), HandLikelihood::default(), EdgeSteps::default())?;
/// for (frame, left) in [100, 108, 116].into_iter().enumerate() {
///     let (across_hand, wall) = (line(left), [0; 320]);
///     front_end.begin_frame();
///     for v in 0..240 {
///         front_end.line(v, if (80..130).contains(&v) { &across_hand } else { &wall }, &table);
///     }
///     let seen = front_end.end_frame();
///     assert_eq!(seen.edges.is_empty(), frame == 0);
///     assert!((seen.candidates[0].centre.u_px - (left as f32 + 24.5)).abs() < 0.1);
/// }
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
pub type QvgaFrontEnd = LineFrontEnd<10, 32, 24, 8, 512, 120>;

/// Bytes that vision may take for 320 x 240 pixels, the table included, the edge map not.
const QVGA_BYTES: usize = 16 * 1024;
const _: () = assert!(
    size_of::<QvgaFrontEnd>() - EdgeLines::<10, 120>::MAP_BYTES + size_of::<SkinTable<pixel_format::Rgb565>>()
        <= QVGA_BYTES
);
const _: () = assert!(EdgeLines::<10, 120>::MAP_BYTES == 2400);

impl<
    const WORDS: usize,
    const RUNS: usize,
    const OPEN: usize,
    const BLOBS: usize,
    const EDGES: usize,
    const MAP_ROWS: usize,
> LineFrontEnd<WORDS, RUNS, OPEN, BLOBS, EDGES, MAP_ROWS>
{
    /// A front end for frames of `width` x `height` pixels, before its first line.
    ///
    /// # Errors
    /// A width from 1 to 32 `WORDS`, a height from 1 to 2 `MAP_ROWS`, both at most [`super::mask::MAX_SIDE_PX`].
    pub fn new(
        (width, height): (usize, usize),
        likelihood: HandLikelihood,
        steps: EdgeSteps,
    ) -> Result<Self, ParameterError> {
        side("width", width, 32 * WORDS)?;
        side("height", height, edge_lines::EDGE_CELL_PX * MAP_ROWS)?;
        Ok(Self {
            edge_lines: EdgeLines::new(steps),
            skin_bits: [0; WORDS],
            morphology: LineMorphology::new(),
            scanner: ComponentScanner::new(),
            likelihood,
            min_area_fraction: DEFAULT_MIN_AREA_FRACTION,
            width,
            height,
            next_line: 0,
            blobs: BlobList::new(),
            candidates: [HandCandidate::default(); BLOBS],
            edges: EdgeList::new(),
            losses: FrameLosses::default(),
        })
    }

    /// The same front end with components below another part of the image's area left out ([`DEFAULT_MIN_AREA_FRACTION`] if not set).
    #[must_use]
    pub fn with_min_area_fraction(self, min_area_fraction: f32) -> Self {
        Self { min_area_fraction, ..self }
    }

    /// Forgets the last frame: the next one has no temporal edges, as after a missing image.
    pub fn forget_last_frame(&mut self) {
        self.edge_lines.forget_last_frame();
    }

    /// Begins a frame; what was read of one that did not end is dropped.
    pub fn begin_frame(&mut self) {
        if self.next_line > 0 {
            // Half of the map is that of the dropped frame.
            self.edge_lines.forget_last_frame();
        }
        self.morphology.restart();
        self.scanner.restart();
        self.blobs.clear();
        self.edge_lines.begin_frame(&mut self.edges);
        self.losses = FrameLosses::default();
        self.next_line = 0;
    }

    /// Reads line `v`. Lines that were left out before it have no skin and this line's luminances.
    pub fn line<F: PixelFormat>(&mut self, v: usize, line: &[u16], skin: &SkinTable<F>) {
        if v < self.next_line || v >= self.height {
            self.losses.ignored_lines = self.losses.ignored_lines.saturating_add(1);
            return;
        }
        for missing in self.next_line..v {
            self.skin_bits.fill(0);
            self.take_skin_bits();
            self.losses.missing_lines += 1;
            self.edge_lines.line::<F, EDGES>(missing, line, self.width, &mut self.edges);
        }
        let line = &line[..line.len().min(self.width)];
        self.losses.missing_lines += u32::from(line.len() < self.width);
        skin.classify_line(line, &mut self.skin_bits);
        self.take_skin_bits();
        self.edge_lines.line::<F, EDGES>(v, line, self.width, &mut self.edges);
        self.next_line = v + 1;
    }

    /// Ends the frame: what its lines showed.
    pub fn end_frame(&mut self) -> FrameLines<'_> {
        let missing = self.height.saturating_sub(self.next_line);
        for _ in 0..missing {
            self.skin_bits.fill(0);
            self.take_skin_bits();
        }
        self.losses.missing_lines += missing as u32;
        let Self { morphology, scanner, blobs, likelihood, min_area_fraction, width, height, .. } = self;
        let image_area_px = (*width * *height) as f32;
        let mut take = |component: &Component, _: &RunPool<'_>| {
            take_component(component, blobs, likelihood, *min_area_fraction, image_area_px);
        };
        morphology.finish(*width, |row| scanner.line(row, &mut RunPool::new(&mut []), &mut take));
        scanner.finish(&mut RunPool::new(&mut []), &mut take);
        self.edge_lines.end_frame();
        if missing > 0 {
            // The map's lower rows are those of an older frame.
            self.edge_lines.forget_last_frame();
        }
        self.next_line = 0;
        self.losses.dropped_components = self.scanner.dropped_components();
        self.losses.dropped_px = self.scanner.dropped_px();
        self.losses.dropped_blobs = self.blobs.dropped_blobs;
        self.losses.dropped_edges = self.edges.dropped;
        let mut count = 0;
        for (slot, candidate) in self.candidates.iter_mut().zip(self.blobs.candidates()) {
            *slot = candidate;
            count += 1;
        }
        FrameLines {
            blobs: self.blobs.as_slice(),
            candidates: &self.candidates[..count],
            edges: self.edges.as_slice(),
            losses: self.losses,
        }
    }

    /// Opens and closes the next line's skin bits and hands on what is finished.
    fn take_skin_bits(&mut self) {
        let Self { skin_bits, morphology, scanner, blobs, likelihood, min_area_fraction, width, height, .. } = self;
        let image_area_px = (*width * *height) as f32;
        let mut take = |component: &Component, _: &RunPool<'_>| {
            take_component(component, blobs, likelihood, *min_area_fraction, image_area_px);
        };
        morphology.line(skin_bits, *width, |row| scanner.line(row, &mut RunPool::new(&mut []), &mut take));
    }
}

/// Puts a component into the list if it is large enough.
fn take_component<const BLOBS: usize>(
    component: &Component,
    blobs: &mut BlobList<BLOBS, MomentBlob>,
    likelihood: &HandLikelihood,
    min_area_fraction: f32,
    image_area_px: f32,
) {
    if component.area_px() as f32 >= min_area_fraction * image_area_px {
        blobs.insert(MomentBlob::of(component, likelihood, image_area_px));
    } else {
        blobs.specks = blobs.specks.saturating_add(1);
    }
}

fn side(name: &'static str, side: usize, capacity: usize) -> Result<(), ParameterError> {
    let capacity = capacity.min(super::mask::MAX_SIDE_PX);
    match side {
        0 => Err(ParameterError::new(name, Rule::Positive)),
        _ if side > capacity => Err(ParameterError::new(name, Rule::Capacity { capacity })),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests;
