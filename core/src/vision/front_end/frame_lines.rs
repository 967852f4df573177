//! What a front end reports at the end of a frame.

use super::moment_blob::MomentBlob;
use crate::vision::candidate::HandCandidate;
use crate::vision::edges::EdgePixel;

/// Counts of data without room in a frame and of missing lines; all zero means that the results are
/// exact.
///
/// ```
/// use sinew_core::vision::front_end::{FrameLosses, QvgaFrontEnd, edge_lines::EdgeSteps};
/// use sinew_core::vision::front_end::{pixel_format::Rgb565, skin_table::SkinTable};
/// use sinew_core::vision::hand_likelihood::HandLikelihood;
///
/// // A camera that drops its last ten lines and repeats one.
/// let mut front_end =
///     QvgaFrontEnd::new((320, 240), HandLikelihood::default(), EdgeSteps::default())?;
/// let table = SkinTable::<Rgb565>::new();
/// front_end.begin_frame();
/// for v in (0..230).chain([229]) {
///     front_end.line(v, &[0; 320], &table);
/// }
/// let losses = front_end.end_frame().losses;
/// assert_eq!(
///     losses,
///     FrameLosses { missing_lines: 10, ignored_lines: 1, ..FrameLosses::default() }
/// );
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FrameLosses {
    /// Components that found no room in the table of open ones, see
    /// [`ComponentScanner::dropped_components`].
    ///
    /// [`ComponentScanner::dropped_components`]:
    /// crate::vision::component_scanner::ComponentScanner::dropped_components
    pub dropped_components: u32,
    /// Pixels of those, and of runs that found no room in their line.
    pub dropped_px: u32,
    /// Blobs less likely than all in the list.
    pub dropped_blobs: u32,
    /// Temporal edge pixels that were thinned out.
    pub dropped_edges: u32,
    /// Lines that are missing, or shorter than the frame's width: without skin where pixels are
    /// missing.
    pub missing_lines: u32,
    /// Lines that came twice, too late, or from beyond the frame: ignored.
    pub ignored_lines: u32,
}

/// Blobs, edges and losses of a frame.
///
/// ```
/// use sinew_core::vision::front_end::{LineFrontEnd, edge_lines::EdgeSteps};
/// use sinew_core::vision::front_end::{pixel_format::Rgb565, skin_table::SkinTable};
/// # use sinew_core::vision::{hand_likelihood::HandLikelihood, skin::GaussianSkin};
/// # let mut table = SkinTable::<Rgb565>::new();
/// # table.learn(&GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?);
/// # const SKIN: u16 = 200 >> 3 << 11 | 140 >> 2 << 5 | 110 >> 3;
///
/// let mut front_end = LineFrontEnd::<2, 16, 16, 4, 64, 24>::new(
///     (64, 48),
///     HandLikelihood::default(),
///     EdgeSteps::default(),
/// )?;
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
/// assert_eq!(
///     seen.candidates[0].centre, first.centroid,
///     "a tracker's input, in the same order"
/// );
/// assert!(seen.edges.is_empty(), "the first frame has no temporal edges");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct FrameLines<'a> {
    /// Blobs, the most likely first.
    pub blobs: &'a [MomentBlob],
    /// The trackers' input for each blob, in the same order.
    pub candidates: &'a [HandCandidate],
    /// Temporal edge pixels, in the order of rows, at even columns and rows.
    pub edges: &'a [EdgePixel],
    /// Counts of lost data.
    pub losses: FrameLosses,
}
