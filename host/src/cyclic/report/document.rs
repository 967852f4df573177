//! `summary.json`: what was run, and what it came to.

use super::contents::{Origin, OverlayOrigin, Report};
use crate::cyclic::about::About;
use crate::cyclic::anatomy::{ANATOMICAL_ANGLES, Range, Repetition, Symmetry};
use crate::cyclic::angle_table::COLUMNS;
use crate::cyclic::gait::{Direction, Foot, FootMeans, Gait};
use crate::cyclic::tracking::{FilterName, ScalingName, StartName, Summary, Tracked, Updates};
use serde::Serialize;
use std::collections::BTreeMap;

/// Value of the field `format`.
pub const FORMAT: &str = "sinew-track-cyclic";
/// Value of the field `version`.
pub const VERSION: u32 = 1;

/// The options as they stand in the file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OptionsRecord {
    filter: FilterName,
    sigma_deg: f64,
    init: StartName,
    initial_cycle_position: Option<f64>,
    initial_cycle_velocity: Option<f64>,
    covariance_scaling: ScalingName,
    temporal_std: Option<f64>,
    update_every: Option<u64>,
    update_at: Option<Vec<u64>>,
    rate_hz: f64,
    particles: Option<usize>,
    smooth: bool,
    finished: bool,
    height_m: f64,
}

impl OptionsRecord {
    fn new(origin: &Origin<'_>, rate_hz: f64) -> Self {
        let (options, height_m) = (origin.options, origin.height_m);
        let (update_every, update_at) = match &options.updates {
            Updates::All => (None, None),
            Updates::Every(every) => (Some(*every), None),
            Updates::At(frames) => (None, Some(frames.clone())),
        };
        Self {
            filter: options.filter,
            // Degrees as they were typed, without the rounding of the way to radians and back.
            sigma_deg: (options.sigma_rad.to_degrees() * 1.0e9).round() / 1.0e9,
            init: options.start,
            initial_cycle_position: options.initial_cycle_position,
            initial_cycle_velocity: options.initial_cycle_velocity,
            covariance_scaling: options.covariance_scaling,
            temporal_std: options.temporal_std,
            update_every,
            update_at,
            rate_hz,
            particles: (options.filter == FilterName::Particle).then_some(options.particles),
            smooth: options.smooth,
            finished: origin.is_finished,
            height_m,
        }
    }
}

/// Least, greatest, and how far apart, degrees.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RangeRecord {
    min_deg: f64,
    max_deg: f64,
    range_deg: f64,
}

impl From<Range> for RangeRecord {
    fn from(range: Range) -> Self {
        Self { min_deg: range.min_deg, max_deg: range.max_deg, range_deg: range.extent_deg() }
    }
}

/// One whole cycle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RepetitionRecord {
    number: usize,
    start_s: f64,
    duration_s: f64,
    tempo_per_min: f64,
    range_of_motion: BTreeMap<&'static str, RangeRecord>,
}

impl From<&Repetition> for RepetitionRecord {
    fn from(one: &Repetition) -> Self {
        let ranges = ANATOMICAL_ANGLES.into_iter().zip(one.ranges);
        Self {
            number: one.number,
            start_s: one.start_s,
            duration_s: one.duration_s,
            tempo_per_min: one.tempo_per_min,
            range_of_motion: ranges.filter_map(|(name, range)| Some((name, range?.into()))).collect(),
        }
    }
}

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Document<'a> {
    format: &'static str,
    version: u32,
    sinew_version: &'static str,
    table: &'a str,
    model: &'a str,
    seed: u64,
    overlay: Option<&'a OverlayOrigin>,
    options: OptionsRecord,
    recording: Option<&'a About>,
    doubts: &'a [String],
    notes: &'a [String],
    #[serde(flatten)]
    summary: &'a Summary,
    /// Share of the rows in which each angle was measured and used.
    measured_shares: BTreeMap<&'static str, f64>,
    repetitions: Vec<RepetitionRecord>,
    symmetry: &'a [Symmetry],
    gait: Option<GaitRecord<'a>>,
}

/// Means over the strides.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct GaitRecord<'a> {
    direction: Direction,
    is_running: bool,
    unseen: Option<Foot>,
    strides: usize,
    left: &'a FootMeans,
    right: &'a FootMeans,
}

impl<'a> GaitRecord<'a> {
    const fn new(gait: &'a Gait) -> Self {
        let Gait { direction, is_running, unseen, .. } = *gait;
        Self { direction, is_running, unseen, strides: gait.strides.len(), left: &gait.left, right: &gait.right }
    }
}

impl<'a> Document<'a> {
    /// The file of a report.
    #[must_use]
    pub fn new(report: &'a Report, origin: &Origin<'a>, tracked: &Tracked) -> Self {
        Self {
            format: FORMAT,
            version: VERSION,
            sinew_version: env!("CARGO_PKG_VERSION"),
            table: origin.table,
            model: origin.model,
            seed: origin.options.seed,
            overlay: origin.overlay,
            options: OptionsRecord::new(origin, tracked.rate_hz),
            recording: origin.about,
            doubts: origin.doubts,
            notes: origin.notes,
            summary: &report.summary,
            measured_shares: COLUMNS[1..].iter().copied().zip(report.measured_shares).collect(),
            repetitions: report.repetitions.iter().map(Into::into).collect(),
            symmetry: &report.symmetries,
            gait: report.gait.as_ref().ok().map(GaitRecord::new),
        }
    }
}
