//! What the folder of a tracked recording holds, before it is written.

use super::series;
use crate::cyclic::AngleTable;
use crate::cyclic::about::About;
use crate::cyclic::anatomy::repetition::{Repetition, repetitions};
use crate::cyclic::anatomy::symmetry::{Symmetry, symmetries};
use crate::cyclic::anatomy::{AnatomicalSeries, CycleCurves};
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::gait::{self, Gait, NoGait, Scale};
use crate::cyclic::own_cycle::noise;
use crate::cyclic::tracking::table::MotionCells;
use crate::cyclic::tracking::{Summary, Tracked, TrackingOptions};
use serde::Serialize;

/// Pictures of the person's own frames with the figure on them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct OverlayOrigin {
    /// Their folder.
    pub folder: String,
    /// File names of the images that they were drawn on, in the order of frames.
    pub images: Vec<String>,
}

/// Where a run comes from.
#[derive(Debug, Clone, Copy)]
pub struct Origin<'a> {
    /// Name of the angle table, for the reader.
    pub table: &'a str,
    /// Name of the motion model.
    pub model: &'a str,
    /// How it was tracked.
    pub options: &'a TrackingOptions,
    /// Height of the person, metres, which gives positions their scale.
    pub height_m: f64,
    /// Name and probability of each row's motion, where several models were tracked.
    pub motions: Option<&'a MotionCells>,
    /// The overlays, where some are drawn.
    pub overlay: Option<&'a OverlayOrigin>,
    /// Whether the estimates are those of a finished recording, and not the filter's.
    pub is_finished: bool,
    /// What is known of the recording.
    pub about: Option<&'a About>,
    /// What speaks against the result, one sentence each.
    pub doubts: &'a [String],
    /// What a user should know, one sentence each.
    pub notes: &'a [String],
}

/// Everything that the folder holds, before it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Cycles, cadence, outliers.
    pub summary: Summary,
    /// Share of the rows in which each angle of the stick figure was measured and used, 0 to 1.
    pub measured_shares: [f64; ANGLES],
    /// Anatomical angles of the estimate; those that need an angle which was never measured are
    /// missing.
    pub series: AnatomicalSeries,
    /// First and last frame of each whole cycle, between frames.
    pub cycles: Vec<[f64; 2]>,
    /// Each whole cycle.
    pub repetitions: Vec<Repetition>,
    /// Curves over the cycle.
    pub curves: CycleCurves,
    /// Left against right.
    pub symmetries: Vec<Symmetry>,
    /// Foot strikes, toe-offs and strides, if the person walks or runs; else why there are none.
    pub gait: Result<Gait, NoGait>,
}

impl Report {
    /// Derives everything from a run over `table`.
    #[must_use]
    pub fn new(table: &AngleTable, tracked: &Tracked, options: &TrackingOptions, height_m: Option<f64>) -> Self {
        Self::of(Summary::of(tracked), table, tracked, options, height_m)
    }

    /// As [`Report::new`], of a recording that shows none of the models' motions: what is derived
    /// from cycles is left out.
    #[must_use]
    pub fn without_cycles(
        table: &AngleTable,
        tracked: &Tracked,
        options: &TrackingOptions,
        height_m: Option<f64>,
    ) -> Self {
        Self::of(Summary::of(tracked).without_cycles(), table, tracked, options, height_m)
    }

    fn of(
        summary: Summary,
        table: &AngleTable,
        tracked: &Tracked,
        options: &TrackingOptions,
        height_m: Option<f64>,
    ) -> Self {
        let measured_shares = series::measured_shares(table, &options.updates);
        let series = series::estimated(tracked, &summary, &measured_shares);
        let first = tracked.frames[0].frame as f64;
        let in_frames = |cycle_s: &[f64; 2]| cycle_s.map(|time_s| first + time_s * tracked.rate_hz);
        let cycles: Vec<[f64; 2]> = summary.whole_cycles_s.iter().map(in_frames).collect();
        let repetitions = repetitions(&series, &cycles);
        let curves = CycleCurves::new(&series, &cycles);
        let noise_rad = noise::of_table(table, &options.updates).unwrap_or(noise::MIN_NOISE_RAD);
        let symmetries = symmetries(&repetitions, &curves, noise_rad);
        let gait = gait::of_table(table, tracked.rate_hz, Scale { height_m });
        Self { summary, measured_shares, series, cycles, repetitions, curves, symmetries, gait }
    }
}
