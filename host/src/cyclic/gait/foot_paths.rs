//! How far each foot is before the hips over time.

use super::scale::{LEGS, LegLengths};
use crate::cyclic::even_rows::EvenRows;
use crate::cyclic::place_columns::PlaceColumns;
use crate::error::Result;
use crate::signal::{FilterOptions, filtered};

/// Segments from the root to the hip of each side among the angles.
const HIP_SEGMENTS: [usize; 2] = [7, 10];
/// Share of the frames with an ankle in which a heel or toe has to be seen to be used. Chosen: a
/// point that is missing more often would lose more events than it betters.
pub const MIN_SEEN_SHARE: f64 = 0.5;

/// Points of one foot, forward of the hips, smoothed, in the unit of the leg's lengths; one value a
/// frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FootPaths {
    pub heel: Option<Vec<Option<f64>>>,
    pub toe: Option<Vec<Option<f64>>>,
    pub ankle: Vec<Option<f64>>,
    /// How far the ankle is below the hips.
    pub below: Vec<Option<f64>>,
}

impl FootPaths {
    /// Paths of the left foot (`side` 0) or the right one.
    ///
    /// # Errors
    /// The filter refuses the rate.
    pub fn find(
        even: &EvenRows<'_>,
        columns: Option<&PlaceColumns>,
        (side, leg): (usize, &LegLengths),
        rate_hz: f64,
    ) -> Result<Self> {
        let (options, _) = FilterOptions::default().lowered_for(rate_hz);
        let [thigh, shank] = LEGS[side];
        let columns = columns.filter(|_| leg.is_measured);
        let ankle = |along: fn(f64) -> f64| {
            even.series(|row| {
                let part = |segment: usize, usual: f64| {
                    let length = columns.and_then(|columns| columns.length(row, segment)).unwrap_or(usual);
                    Some(length * along(row.angles_rad[segment]?))
                };
                let hip = part(HIP_SEGMENTS[side], 0.0).unwrap_or(0.0);
                Some(hip + part(thigh, leg.segments[0])? + part(shank, leg.segments[1])?)
            })
        };
        let (ankle, below) = (ankle(f64::cos), ankle(f64::sin));
        let ankles = ankle.iter().flatten().count() as f64;
        let point = |end: usize| -> Result<Option<Vec<Option<f64>>>> {
            let Some(columns) = columns else { return Ok(None) };
            let path = even.series(|row| columns.foot_from_root(row, 2 * side + end).map(|[forward, _]| forward));
            let seen = path.iter().flatten().count() as f64;
            let is_used = seen > 0.0 && seen >= MIN_SEEN_SHARE * ankles;
            is_used.then(|| filtered(&path, rate_hz, &options)).transpose()
        };
        let [ankle, below] = [ankle, below].map(|path| filtered(&path, rate_hz, &options));
        Ok(Self { heel: point(0)?, toe: point(1)?, ankle: ankle?, below: below? })
    }

    /// The same, counted backward of the hips.
    pub fn turned(mut self) -> Self {
        let paths = [Some(&mut self.ankle), self.heel.as_mut(), self.toe.as_mut()];
        paths.into_iter().flatten().for_each(|path| turn(path));
        self
    }
}

/// Counts a path the other way.
pub fn turn(path: &mut [Option<f64>]) {
    path.iter_mut().flatten().for_each(|place| *place = -*place);
}

/// How far the hips are along the way, smoothed; `None` where the table does not say, or not in the
/// unit of the legs.
pub fn hips_path(
    even: &EvenRows<'_>,
    columns: Option<&PlaceColumns>,
    legs: &[LegLengths; 2],
    rate_hz: f64,
) -> Option<Vec<Option<f64>>> {
    let columns = columns.filter(|_| legs[0].is_measured)?;
    let (options, _) = FilterOptions::default().lowered_for(rate_hz);
    filtered(&even.series(|row| columns.root(row).map(|[forward, _]| forward)), rate_hz, &options).ok()
}
