//! Reads a frame line by line as the camera sends it.

use super::edge_lines::{EDGE_CELL_PX, EdgeLines, EdgeSteps};
use super::frame_lines::{FrameLines, FrameLosses};
use super::moment_blob::MomentBlob;
use super::pixel_format::{PixelFormat, Rgb565};
use super::skin_table::SkinTable;
use crate::error::{ParameterError, Rule};
use crate::vision::blobs::{BlobList, DEFAULT_MIN_AREA_FRACTION};
use crate::vision::candidate::HandCandidate;
use crate::vision::component_scanner::ComponentScanner;
use crate::vision::components::Component;
use crate::vision::edges::EdgeList;
use crate::vision::hand_likelihood::HandLikelihood;
use crate::vision::line_morphology::LineMorphology;
use crate::vision::mask::MAX_SIDE_PX;
use crate::vision::runs::RunPool;

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
/// // A camera of 160 x 120 pixels, of which four blobs and 128 edges are wanted, in less than 7
/// // KiB.
/// type QqvgaFrontEnd = LineFrontEnd<5, 28, 12, 4, 128, 60>;
/// const { assert!(size_of::<QqvgaFrontEnd>() < 7 * 1024) };
/// let new = |size| QqvgaFrontEnd::new(size, HandLikelihood::default(), EdgeSteps::default());
/// assert!(new((160, 120)).is_ok());
/// let too_wide = new((320, 240)).map_err(|error| error.parameter);
/// assert_eq!(too_wide.err(), Some("width"));
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
/// // A hand that moves by eight pixels a frame has temporal edges; the blob is that of the last
/// // frame.
/// let mut front_end =
///     QvgaFrontEnd::new((320, 240), HandLikelihood::default(), EdgeSteps::default())?;
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

/// A front end for 640 x 480 pixels: twice the runs and components of a line, and four times the
/// edge map; as many blobs and edges, since they say as much.
///
/// ```
/// use sinew_core::vision::front_end::{VgaFrontEnd, edge_lines::EdgeSteps};
/// use sinew_core::vision::hand_likelihood::HandLikelihood;
///
/// const { assert!(size_of::<VgaFrontEnd>() < 22 * 1024) };
/// assert!(VgaFrontEnd::new((640, 480), HandLikelihood::default(), EdgeSteps::default()).is_ok());
/// ```
pub type VgaFrontEnd = LineFrontEnd<20, 64, 48, 8, 512, 240>;

/// Bytes that vision may take for 320 x 240 pixels, the table included, the edge map not.
///
/// Chosen: the stated budget of the front end, asserted below.
const QVGA_BYTES: usize = 16 * 1024;
const _: () =
    assert!(size_of::<QvgaFrontEnd>() - EdgeLines::<10, 120>::MAP_BYTES + size_of::<SkinTable<Rgb565>>() <= QVGA_BYTES);
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
    /// A width from 1 to 32 `WORDS`, a height from 1 to 2 `MAP_ROWS`, both at most [`MAX_SIDE_PX`].
    pub fn new(
        (width, height): (usize, usize),
        likelihood: HandLikelihood,
        steps: EdgeSteps,
    ) -> Result<Self, ParameterError> {
        Self::check_size((width, height))?;
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

    /// Whether frames of this size have room.
    pub(crate) fn check_size((width, height): (usize, usize)) -> Result<(), ParameterError> {
        side("width", width, 32 * WORDS)?;
        side("height", height, EDGE_CELL_PX * MAP_ROWS)
    }

    /// Begins anew, in place, as what [`Self::new`] gives: also with frames of another size.
    ///
    /// # Errors
    /// Those of [`Self::new`]; the front end is as before then.
    pub fn begin(
        &mut self,
        size: (usize, usize),
        likelihood: HandLikelihood,
        steps: EdgeSteps,
    ) -> Result<(), ParameterError> {
        Self::check_size(size)?;
        (self.width, self.height) = size;
        self.likelihood = likelihood;
        self.min_area_fraction = DEFAULT_MIN_AREA_FRACTION;
        self.skin_bits.fill(0);
        self.candidates.fill(HandCandidate::default());
        self.edge_lines.begin(steps);
        self.begin_frame();
        self.forget_last_frame();
        Ok(())
    }

    /// The same front end without components below another fraction of the image's area.
    ///
    /// [`DEFAULT_MIN_AREA_FRACTION`] if not set.
    #[must_use]
    pub fn with_min_area_fraction(self, min_area_fraction: f32) -> Self {
        Self { min_area_fraction, ..self }
    }

    /// Drops components below this fraction of the image's area, as
    /// [`Self::with_min_area_fraction`].
    #[cfg(feature = "c-api")]
    pub(crate) const fn set_min_area_fraction(&mut self, min_area_fraction: f32) {
        self.min_area_fraction = min_area_fraction;
    }

    /// Forgets the last frame: the next one has no temporal edges, as after a missing image.
    pub fn forget_last_frame(&mut self) {
        self.edge_lines.forget_last_frame();
    }

    /// Begins a frame; drops an unfinished one.
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

    /// The line that has to come next.
    pub(super) fn next_line(&self) -> usize {
        self.next_line
    }

    /// Skin of the last line, a bit a pixel, as its colours say.
    pub(super) fn last_skin(&self) -> &[u32; WORDS] {
        &self.skin_bits
    }

    /// Luminances of every second pixel of the even line that was read last, 0 to 127, four a word.
    pub(super) fn last_luminances(&self) -> impl Iterator<Item = u32> {
        self.edge_lines.luminances(self.next_line.saturating_sub(1))
    }

    /// Ends the frame and returns its blobs, edges and losses.
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

    /// Opens and closes the next line's skin bits and scans finished lines.
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
    let capacity = capacity.min(MAX_SIDE_PX);
    match side {
        0 => Err(ParameterError::new(name, Rule::Positive)),
        _ if side > capacity => Err(ParameterError::new(name, Rule::Capacity { capacity })),
        _ => Ok(()),
    }
}
