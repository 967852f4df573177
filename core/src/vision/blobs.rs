//! The blobs of a mask that are most likely hands.

use super::component_scanner::ComponentScanner;
use super::components::Component;
use super::features::{Blob, BlobMeter};
use super::hand_likelihood::HandLikelihood;
use super::mask::Mask;
use super::runs::{Run, RunPool};
use crate::vision::candidate::HandCandidate;
use heapless::Vec;

/// Smallest component that becomes a blob, as a fraction of the image's area.
///
/// Chosen: 24 pixels of 640 x 480, far below the area of a hand
/// ([`super::hand_likelihood::DEFAULT_AREA_FRACTIONS`]).
pub const DEFAULT_MIN_AREA_FRACTION: f32 = 8.0e-5;

/// A blob and its likelihood of being a hand.
///
/// ```
/// use sinew_core::vision::blobs::{BlobFinder, BlobList, DEFAULT_MIN_AREA_FRACTION, Ranked};
/// use sinew_core::vision::features::{BlobMeter, DEFAULT_FILL_RATIO};
/// use sinew_core::vision::hand_likelihood::HandLikelihood;
/// # use sinew_core::vision::{mask::Mask, runs::Run};
///
/// # let mut rows = [0; 64];
/// # rows[20..36].fill(0x00ff_ff00);
/// # let mask = Mask::new(&rows, 32, 64)?;
/// let meter = BlobMeter::new(DEFAULT_FILL_RATIO)?;
/// let mut finder =
///     BlobFinder::<16, 16>::new(meter, HandLikelihood::default(), DEFAULT_MIN_AREA_FRACTION);
/// let mut list = BlobList::<4>::new();
/// finder.find(&mask, &mut [Run::default(); 64], &mut list);
/// // The tracker's input: the blob's place, its extent and its likelihood.
/// let entry = &list.as_slice()[0];
/// let candidate = entry.candidate();
/// assert_eq!(
///     (candidate.centre, candidate.likelihood),
///     (entry.blob.centroid, entry.likelihood)
/// );
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LikelyBlob {
    /// The blob.
    pub blob: Blob,
    /// p(hand | blob) in [0, 1].
    pub likelihood: f32,
}

/// A blob that can be ranked and passed to a tracker.
///
/// ```
/// use sinew_core::vision::blobs::{BlobList, Ranked};
/// use sinew_core::vision::candidate::HandCandidate;
///
/// // What another detector found: a place and a score.
/// struct Detection(HandCandidate);
///
/// impl Ranked for Detection {
///     fn likelihood(&self) -> f32 {
///         self.0.likelihood
///     }
///
///     fn candidate(&self) -> HandCandidate {
///         self.0
///     }
/// }
///
/// let mut best = BlobList::<1, Detection>::new();
/// for likelihood in [0.3, 0.9, 0.5] {
///     best.insert(Detection(HandCandidate { likelihood, ..HandCandidate::default() }));
/// }
/// assert_eq!(best.candidates().next().map(|hand| hand.likelihood), Some(0.9));
/// ```
pub trait Ranked {
    /// Likelihood of being a hand, 0 to 1.
    fn likelihood(&self) -> f32;

    /// The trackers' input for it.
    fn candidate(&self) -> HandCandidate;
}

impl Ranked for LikelyBlob {
    fn likelihood(&self) -> f32 {
        self.likelihood
    }

    fn candidate(&self) -> HandCandidate {
        self.blob.candidate(self.likelihood)
    }
}

/// The most likely blobs of a frame, most likely first, and counts of those without room.
///
/// ```
/// use sinew_core::vision::blobs::{BlobFinder, BlobList, DEFAULT_MIN_AREA_FRACTION};
/// # use sinew_core::vision::features::{BlobMeter, DEFAULT_FILL_RATIO};
/// # use sinew_core::vision::{hand_likelihood::HandLikelihood, mask::Mask, runs::Run};
///
/// # let mut rows = [0; 96];
/// # rows[10..30].fill(0x00ff_ff00);
/// # rows[40..50].fill(0x0000_ff00);
/// # rows[60..64].fill(0x0000_0f00);
/// # let mask = Mask::new(&rows, 32, 96)?;
/// # let meter = BlobMeter::new(DEFAULT_FILL_RATIO)?;
/// # let likelihood = HandLikelihood::default();
/// # let mut finder = BlobFinder::<16, 16>::new(meter, likelihood, DEFAULT_MIN_AREA_FRACTION);
/// // A mask with three squares, and room for two.
/// let mut list = BlobList::<2>::new();
/// finder.find(&mask, &mut [Run::default(); 64], &mut list);
/// assert!(list.as_slice()[0].likelihood >= list.as_slice()[1].likelihood);
/// assert_eq!((list.as_slice().len(), list.dropped_blobs), (2, 1));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct BlobList<const N: usize, B = LikelyBlob> {
    blobs: Vec<B, N>,
    /// Blobs that were less likely than all that were kept.
    pub dropped_blobs: u32,
    /// Components that found no room while the mask was scanned, see
    /// [`ComponentScanner::dropped_components`].
    pub dropped_components: u32,
    /// Components too small to become a blob.
    pub specks: u32,
}

impl<const N: usize, B: Ranked> Default for BlobList<N, B> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize, B: Ranked> BlobList<N, B> {
    /// An empty list.
    #[must_use]
    pub const fn new() -> Self {
        Self { blobs: Vec::new(), dropped_blobs: 0, dropped_components: 0, specks: 0 }
    }

    /// The blobs, most likely first.
    #[must_use]
    pub fn as_slice(&self) -> &[B] {
        &self.blobs
    }

    /// The trackers' input for each blob, most likely first.
    pub fn candidates(&self) -> impl Iterator<Item = HandCandidate> + '_ {
        self.blobs.iter().map(Ranked::candidate)
    }

    /// Empties the list and its counts.
    pub fn clear(&mut self) {
        self.blobs.clear();
        self.dropped_blobs = 0;
        self.dropped_components = 0;
        self.specks = 0;
    }

    /// Whether a blob of at most this likelihood would find no room.
    pub(super) fn refuses(&self, likelihood: f32) -> bool {
        self.blobs.is_full() && self.blobs.last().is_none_or(|least| likelihood <= least.likelihood())
    }

    /// Puts a blob in its place; the least likely one goes when there is no room.
    pub fn insert(&mut self, entry: B) {
        if self.refuses(entry.likelihood()) {
            self.dropped_blobs = self.dropped_blobs.saturating_add(1);
            return;
        }
        if self.blobs.is_full() {
            self.blobs.pop();
            self.dropped_blobs = self.dropped_blobs.saturating_add(1);
        }
        let place = self.blobs.iter().position(|other| other.likelihood() < entry.likelihood());
        // There is room, so neither can fail.
        let _ = self.blobs.insert(place.unwrap_or(self.blobs.len()), entry);
    }
}

/// Finds the blobs of masks; owns the working memory.
///
/// ```
/// use sinew_core::vision::blobs::{BlobFinder, BlobList};
/// use sinew_core::vision::features::{BlobMeter, DEFAULT_FILL_RATIO};
/// use sinew_core::vision::hand_likelihood::HandLikelihood;
/// use sinew_core::vision::mask::Mask;
/// use sinew_core::vision::runs::Run;
///
/// // A square of 256 pixels and a speck of one, in an image of 32 x 64.
/// let mut rows = [0; 64];
/// rows[20..36].fill(0x00ff_ff00);
/// rows[50] = 1;
/// let meter = BlobMeter::new(DEFAULT_FILL_RATIO)?;
/// let mut finder = BlobFinder::<16, 16>::new(meter, HandLikelihood::default(), 0.01);
/// let mut list = BlobList::<4>::new();
/// finder.find(&Mask::new(&rows, 32, 64)?, &mut [Run::default(); 64], &mut list);
/// assert_eq!(
///     (list.as_slice().len(), list.specks),
///     (1, 1),
///     "less than a hundredth of the image is no blob"
/// );
/// assert_eq!(list.as_slice()[0].blob.area_px, 256);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct BlobFinder<const RUNS: usize, const OPEN: usize> {
    scanner: ComponentScanner<RUNS, OPEN>,
    meter: BlobMeter,
    likelihood: HandLikelihood,
    min_area_fraction: f32,
}

impl<const RUNS: usize, const OPEN: usize> BlobFinder<RUNS, OPEN> {
    /// A finder that leaves out components below `min_area_fraction` of the image's area (a NaN
    /// leaves out all).
    #[must_use]
    pub fn new(meter: BlobMeter, likelihood: HandLikelihood, min_area_fraction: f32) -> Self {
        Self { scanner: ComponentScanner::new(), meter, likelihood, min_area_fraction }
    }

    /// Replaces the contents of `list` by the most likely blobs of `mask`.
    ///
    /// `runs` is working memory for the runs of the components that grow at the same time. Where it
    /// is too short, blobs come with `shape_complete` false.
    pub fn find<const N: usize>(&mut self, mask: &Mask<'_>, runs: &mut [Run], list: &mut BlobList<N>) {
        list.clear();
        let image_area_px = (mask.width() * mask.height()) as f32;
        let Self { scanner, meter, likelihood, min_area_fraction } = self;
        let mut take = |component: &Component, pool: &RunPool<'_>| {
            let area_px = component.area_px() as f32;
            if area_px >= *min_area_fraction * image_area_px {
                if list.refuses(likelihood.upper_bound(area_px, image_area_px)) {
                    list.dropped_blobs = list.dropped_blobs.saturating_add(1);
                    return;
                }
                let blob = meter.measure(component, pool);
                list.insert(LikelyBlob { blob, likelihood: likelihood.evaluate(&blob, image_area_px) });
            } else {
                list.specks = list.specks.saturating_add(1);
            }
        };
        scanner.scan(mask, &mut RunPool::new(runs), &mut take);
        list.dropped_components = scanner.dropped_components();
    }
}
