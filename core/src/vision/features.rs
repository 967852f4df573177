//! A blob: what a component looks like, as it is and with the gaps between its fingers filled.

use super::components::{BoundingBox, Component};
use super::distance::{DistanceRow, EMPTY_ROW, UNIT, at, greatest, transform};
use super::ellipse::{best_overlap, semi_axes};
use super::runs::RunPool;
use super::shape::{CellGrid, MAX_PADDING, MAX_ROWS};
use crate::camera::Pixel;
use crate::error::{ParameterError, within};
use crate::math::{clamp, min, round, sqrt};
use crate::vision::candidate::HandCandidate;

/// Radius of the disc that closes the gaps between fingers, relative to that of the circle of the
/// blob's area.
///
/// Chosen: about the palm's radius of an open hand, so that gaps between spread fingers are filled.
/// Measured: `cargo test -p sinew-lab --test accuracy hand_likelihood_roc`;
/// `docs/hand_likelihood.md` compares it with DTmax.
pub const DEFAULT_FILL_RATIO: f32 = 0.75;

/// Shape features of a set of pixels.
///
/// ```
/// use sinew_core::vision::features::ShapeFeatures;
///
/// // An arm with a hand at its end: the mass lies where it is thin, which makes a hand unlikely.
/// let arm = ShapeFeatures { dt_max_px: 20.0, dt_at_centroid_px: 8.0, ..ShapeFeatures::default() };
/// let fist = ShapeFeatures { dt_at_centroid_px: 19.0, ..arm };
/// assert!(fist.centrality() > 0.9 && (arm.centrality() - 0.4).abs() < 1e-6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ShapeFeatures {
    /// Area, square pixels.
    pub area_px: f32,
    /// Perimeter, pixels, see [`super::components::crofton_perimeter`].
    pub perimeter_px: f32,
    /// Centre of gravity.
    pub centroid: Pixel,
    /// Greatest value of the distance transform, pixels (DTmax of arm (8)).
    pub dt_max_px: f32,
    /// Where the distance transform is greatest; of several such places the one nearest to the
    /// centroid.
    pub dt_max_at: Pixel,
    /// Distance transform at the centroid, pixels, 0 where the centroid lies outside (d(CoG) of arm
    /// (8)).
    pub dt_at_centroid_px: f32,
    /// Intersection over union with the best rotation of the ellipse of the same area and
    /// perimeter, 0 to 1; arm (9).
    pub ellipse_iou: f32,
}

impl ShapeFeatures {
    /// d(CoG) / DTmax, to which arm (8) reduces; in [0, 1].
    #[must_use]
    pub fn centrality(&self) -> f32 {
        if self.dt_max_px > 0.0 { clamp(self.dt_at_centroid_px / self.dt_max_px, 0.0, 1.0) } else { 0.0 }
    }
}

/// A connected component's features.
///
/// ```
/// use sinew_core::vision::component_scanner::ComponentScanner;
/// use sinew_core::vision::features::{BlobMeter, DEFAULT_FILL_RATIO};
/// use sinew_core::vision::mask::Mask;
/// use sinew_core::vision::runs::{Run, RunPool};
///
/// // A palm of twelve pixels with two fingers.
/// let mut rows = [0xfff0; 20];
/// rows[..8].fill(0xc0c0);
/// let mut meter = BlobMeter::new(DEFAULT_FILL_RATIO)?;
/// let mut storage = [Run::default(); 64];
/// # let mask = Mask::new(&rows, 32, 20)?;
/// ComponentScanner::<8, 8>::new().scan(
///     &mask,
///     &mut RunPool::new(&mut storage),
///     &mut |component, pool| {
///         let blob = meter.measure(component, pool);
///         assert_eq!((blob.area_px, blob.shape_complete), (12 * 12 + 8 * 4, true));
///         assert!(
///             blob.filled.area_px > blob.plain.area_px,
///             "the gap between the fingers counts"
///         );
///         assert!(blob.palm_centre().v_px > 8.0, "the palm is where there is most room");
///     },
/// );
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Blob {
    /// Number of pixels.
    pub area_px: u32,
    /// Centre of gravity.
    pub centroid: Pixel,
    /// Second central moments of the pixels: uu, uv, vv, square pixels.
    pub moments_px2: [f32; 3],
    /// Smallest upright rectangle around all pixels.
    pub bounding_box: BoundingBox,
    /// Features of the component as it is.
    pub plain: ShapeFeatures,
    /// Features of the component closed by a disc in proportion to the root of its area.
    ///
    /// Fingers and the gaps between them become one area.
    pub filled: ShapeFeatures,
    /// False where some runs were lost, so that the shape features see only a part.
    pub shape_complete: bool,
}

impl Blob {
    /// Centre of the palm: where the distance transform of the filled blob is greatest.
    #[must_use]
    pub fn palm_centre(&self) -> Pixel {
        self.filled.dt_max_at
    }

    /// The trackers' input for this blob; its centre is the centre of gravity (arm paper, section
    /// 3.2).
    #[must_use]
    pub fn candidate(&self, likelihood: f32) -> HandCandidate {
        HandCandidate { centre: self.centroid, moments_px2: self.moments_px2, area_px: self.area_px as f32, likelihood }
    }
}

/// Measures blobs; holds the working memory for one blob (about 38 KiB).
///
/// Large components are measured on a grid of at most 80 x 80 cells, so the work for a blob is
/// bounded. It is four distance transforms and 28 ellipses on at most 128 x 128 cells, and its
/// runs.
///
/// ```
/// use sinew_core::vision::component_scanner::ComponentScanner;
/// use sinew_core::vision::features::BlobMeter;
/// use sinew_core::vision::mask::Mask;
/// use sinew_core::vision::runs::{Run, RunPool};
///
/// // Filling by nothing leaves a blob as it is.
/// let mut meter = BlobMeter::new(0.0)?;
/// let mut storage = [Run::default(); 32];
/// ComponentScanner::<8, 8>::new().scan(
///     &Mask::new(&[0x00ff_ff00; 16], 32, 16)?,
///     &mut RunPool::new(&mut storage),
///     &mut |component, pool| {
///         let square = meter.measure(component, pool);
///         assert_eq!(square.filled.area_px, square.plain.area_px);
///         assert_eq!(square.plain.dt_max_px, 8.0, "from the middle to the outside");
///     },
/// );
/// // The disc that fills gaps is at most twice as wide as the blob.
/// assert_eq!(BlobMeter::new(2.5).map_err(|error| error.parameter).err(), Some("fill_ratio"));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct BlobMeter {
    plain: CellGrid,
    filled: CellGrid,
    distances: [DistanceRow; MAX_ROWS],
    fill_ratio: f32,
}

impl BlobMeter {
    /// A meter that fills gaps by a disc of `fill_ratio` times the radius of the circle of the
    /// blob's area.
    ///
    /// See [`DEFAULT_FILL_RATIO`]; 0 fills nothing.
    ///
    /// # Errors
    /// The ratio has to lie from 0 to 2.
    pub fn new(fill_ratio: f32) -> Result<Self, ParameterError> {
        let fill_ratio = within("fill_ratio", fill_ratio, 0.0, 2.0)?;
        Ok(Self { plain: CellGrid::EMPTY, filled: CellGrid::EMPTY, distances: [EMPTY_ROW; MAX_ROWS], fill_ratio })
    }

    /// Measures a component whose runs lie in `pool`.
    pub fn measure(&mut self, component: &Component, pool: &RunPool<'_>) -> Blob {
        let (area_px, centroid) = (component.area_px() as f32, component.centroid());
        self.plain.draw(component, pool);
        let plain = shape(&self.plain, &mut self.distances, area_px, component.perimeter_px(), centroid);
        self.fill(sqrt(area_px / core::f32::consts::PI));
        let (area_px, perimeter_px, centroid) = self.filled.outline();
        let filled = shape(&self.filled, &mut self.distances, area_px, perimeter_px, centroid);
        Blob {
            area_px: component.area_px(),
            centroid: component.centroid(),
            moments_px2: component.moments_px2(),
            bounding_box: component.bounding_box(),
            plain,
            filled,
            shape_complete: component.unrecorded_px() == 0,
        }
    }

    /// Closes the plain grid by a disc: dilation and erosion by thresholds of two distance
    /// transforms.
    fn fill(&mut self, circle_radius_px: f32) {
        let radius = min(self.fill_ratio * circle_radius_px / self.plain.step_px(), (MAX_PADDING - 1) as f32);
        let reach = round(radius * f32::from(UNIT)) as i16;
        self.filled = self.plain.padded((reach / UNIT) as usize + 1);
        if reach < UNIT {
            return;
        }
        let (rows, columns) = (self.filled.rows().len(), self.filled.columns());
        transform(self.filled.rows(), columns, false, &mut self.distances[..rows]);
        self.filled.keep(&self.distances, |d| d <= reach);
        transform(self.filled.rows(), columns, true, &mut self.distances[..rows]);
        self.filled.keep(&self.distances, |d| d > reach);
        self.filled.add(&self.plain);
    }
}

/// The features that need the cells.
fn shape(
    grid: &CellGrid,
    distances: &mut [DistanceRow; MAX_ROWS],
    area_px: f32,
    perimeter_px: f32,
    centroid: Pixel,
) -> ShapeFeatures {
    let (rows, step) = (grid.rows(), grid.step_px());
    let distances = &mut distances[..rows.len()];
    transform(rows, grid.columns(), true, distances);
    let (u, v) = grid.cell_of(centroid);
    let (top, (top_u, top_v)) = greatest(distances, grid.columns(), u, v);
    let to_px = step / f32::from(UNIT);
    let area = area_px / (step * step);
    let axes = semi_axes(area, perimeter_px / step);
    let cells: f32 = grid.count() as f32;
    ShapeFeatures {
        area_px,
        perimeter_px,
        centroid,
        dt_max_px: f32::from(top) * to_px,
        dt_max_at: grid.pixel_of(top_u, top_v),
        dt_at_centroid_px: f32::from(at(
            distances,
            round(clamp(u, 0.0, 200.0)) as usize,
            round(clamp(v, 0.0, 200.0)) as usize,
        )) * to_px,
        ellipse_iou: best_overlap(rows, cells, (u, v), axes).0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vision::component_scanner::ComponentScanner;
    use crate::vision::mask::{MaskMut, words_per_row};
    use crate::vision::runs::Run;
    use proptest::prelude::*;

    /// The largest blob of the points where `inside` holds.
    fn blob(width: usize, height: usize, fill_ratio: f32, inside: impl Fn(f32, f32) -> bool) -> Blob {
        let mut words = vec![0; words_per_row(width) * height];
        let mut mask = MaskMut::new(&mut words, width, height).unwrap();
        (0..height).for_each(|v| (0..width).for_each(|u| mask.set(u, v, inside(u as f32, v as f32))));
        let mut storage = vec![Run::default(); width * height];
        let mut scanner = ComponentScanner::<600, 600>::new();
        let mut meter = BlobMeter::new(fill_ratio).unwrap();
        let mut found: Option<Blob> = None;
        scanner.scan(&mask.view(), &mut RunPool::new(&mut storage), &mut |component, pool| {
            let blob = meter.measure(component, pool);
            if found.is_none_or(|other| other.area_px < blob.area_px) {
                found = Some(blob);
            }
        });
        found.unwrap()
    }

    /// A palm of radius `r` with five spread fingers upwards.
    fn hand(u: f32, v: f32, (cu, cv): (f32, f32), r: f32) -> bool {
        let palm = (u - cu).hypot(v - cv) <= r;
        let finger = (0..5).any(|i| {
            let (s, c) = ((i as f32 - 2.0) * 0.42).sin_cos();
            let (x, y) = (c * (u - cu) + s * (v - cv), s * (u - cu) - c * (v - cv));
            x.abs() <= 0.2 * r && (0.0..=2.3 * r).contains(&y)
        });
        palm || finger
    }

    #[test]
    fn a_disc_has_its_radius_at_its_centre_at_any_scale() {
        for (side, radius) in [(60, 20.3_f32), (150, 60.3), (500, 200.3)] {
            let middle = side as f32 / 2.0;
            let disc = blob(side, side, DEFAULT_FILL_RATIO, |u, v| (u - middle).hypot(v - middle) <= radius);
            for shape in [disc.plain, disc.filled] {
                assert!((shape.dt_max_px / radius - 1.0).abs() < 0.08, "{shape:?}");
                assert!(shape.dt_max_at.distance_px(Pixel::new(middle, middle)) < 0.06 * radius);
                assert!(shape.centrality() > 0.95 && (0.9..=1.0).contains(&shape.ellipse_iou), "{shape:?}");
                assert!((shape.area_px / (core::f32::consts::PI * radius * radius) - 1.0).abs() < 0.04);
            }
        }
    }

    #[test]
    fn filling_turns_an_open_hand_into_a_compact_shape() {
        for (side, r) in [(120, 18.0), (330, 55.0)] {
            let centre = (side as f32 / 2.0, side as f32 * 0.6);
            let open = blob(side, side, DEFAULT_FILL_RATIO, |u, v| hand(u, v, centre, r));
            assert!(open.plain.ellipse_iou < 0.45, "{open:?}");
            assert!(open.filled.ellipse_iou > 0.62, "{open:?}");
            assert!(open.filled.area_px > 1.2 * open.plain.area_px);
            assert!(open.palm_centre().distance_px(Pixel::new(centre.0, centre.1)) < 1.2 * r, "{open:?}");
            assert!((0.9..1.9).contains(&(open.filled.dt_max_px / r)), "{open:?}");
        }
    }

    #[test]
    fn filling_by_nothing_changes_nothing() {
        let ring = blob(90, 80, 0.0, |u, v| ((u - 40.0).hypot(v - 40.0) - 30.0).abs() <= 4.0);
        assert_eq!(ring.filled.area_px, ring.plain.area_px);
        assert!((ring.filled.perimeter_px - ring.plain.perimeter_px).abs() < 1.0e-3);
        assert_eq!(ring.plain.dt_at_centroid_px, 0.0);
        assert_eq!(ring.plain.centrality(), 0.0);
    }

    #[test]
    fn a_single_pixel_is_a_blob() {
        let speck = blob(40, 40, 1.0, |u, v| u == 7.0 && v == 9.0);
        assert_eq!(
            (speck.area_px, speck.centroid, speck.palm_centre()),
            (1, Pixel::new(7.0, 9.0), Pixel::new(7.0, 9.0))
        );
        assert_eq!(speck.filled.dt_max_px, 1.0);
        assert_eq!(speck.candidate(0.25).likelihood, 0.25);
    }

    #[test]
    fn a_blob_whose_runs_are_lost_says_so() {
        let mut scanner = ComponentScanner::<4, 4>::new();
        let mut meter = BlobMeter::new(1.0).unwrap();
        let mut storage = [Run::default(); 2];
        let mut pool = RunPool::new(&mut storage);
        let mut complete = None;
        let mut sink = |component: &Component, pool: &RunPool<'_>| {
            complete = Some(meter.measure(component, pool).shape_complete);
        };
        (0..5).for_each(|_| scanner.line(&[0xff0], &mut pool, &mut sink));
        scanner.finish(&mut pool, &mut sink);
        assert_eq!(complete, Some(false));
    }

    proptest! {
        #[test]
        fn features_move_with_the_blob(du in 0_u8..60, dv in 0_u8..40, r in 6.0_f32..30.0) {
            let (du, dv) = (f32::from(du), f32::from(dv));
            let (w, h) = (220, 200);
            let a = blob(w, h, DEFAULT_FILL_RATIO, |u, v| hand(u, v, (75.0, 90.0), r));
            let b = blob(w, h, DEFAULT_FILL_RATIO, |u, v| hand(u - du, v - dv, (75.0, 90.0), r));
            for (x, y) in [(a.plain, b.plain), (a.filled, b.filled)] {
                prop_assert_eq!((x.area_px, x.perimeter_px, x.dt_max_px), (y.area_px, y.perimeter_px, y.dt_max_px));
                prop_assert!((x.ellipse_iou - y.ellipse_iou).abs() < 0.01);
                prop_assert!((x.centroid.u_px + du - y.centroid.u_px).abs() < 1.0e-3);
            }
            prop_assert_eq!(a.moments_px2.map(|m| (m * 16.0).round()), b.moments_px2.map(|m| (m * 16.0).round()));
        }
    }
}
