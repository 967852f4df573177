//! What a coach or a gait lab reads off a tracked recording: a folder with tables, plots and files for other programs.

pub mod body;
pub mod document;
pub mod joints;
pub mod measured;
#[cfg(feature = "plots")]
pub mod plots;
pub mod series;

use super::AngleTable;
use super::anatomy::repetition::{self, Repetition, repetitions};
use super::anatomy::symmetry::{self, Symmetry, symmetries};
use super::anatomy::{AnatomicalSeries, CycleCurves};
use super::export::{mot, series::to_csv, trc};
use super::tracking::table::{self, MotionCells};
use super::tracking::{Summary, Tracked, TrackingOptions};
use crate::error::Result;
use crate::output::OutputDir;
use serde::Serialize;

/// File of the estimates.
pub const ESTIMATES: &str = "estimates.csv";
/// File of the angles that the filter was given.
pub const MEASURED: &str = "measured.csv";

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
    /// Name and probability of each row's motion, where several were told apart.
    pub motions: Option<&'a MotionCells>,
    /// The overlays, where some are drawn.
    pub overlay: Option<&'a OverlayOrigin>,
}

/// Everything that the folder holds, before it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Cycles, cadence, outliers.
    pub summary: Summary,
    /// Share of the rows in which each angle of the stick figure was measured and used, 0 to 1.
    pub measured_shares: [f64; super::angle_table::ANGLES],
    /// Anatomical angles of the estimate; those that need an angle which was never measured are missing.
    pub series: AnatomicalSeries,
    /// First and last frame of each whole cycle, between frames.
    pub cycles: Vec<[f64; 2]>,
    /// Each whole cycle.
    pub repetitions: Vec<Repetition>,
    /// Curves over the cycle.
    pub curves: CycleCurves,
    /// Left against right.
    pub symmetries: Vec<Symmetry>,
}

impl Report {
    /// Derives everything from a run over `table`.
    #[must_use]
    pub fn new(table: &AngleTable, tracked: &Tracked, options: &TrackingOptions) -> Self {
        let summary = Summary::of(tracked);
        let measured_shares = series::measured_shares(table, &options.updates);
        let series = series::estimated(tracked, &summary, &measured_shares);
        let first = tracked.frames[0].frame as f64;
        let starts: Vec<f64> = summary.cycle_starts_s.iter().map(|start| first + start * tracked.rate_hz).collect();
        let cycles: Vec<[f64; 2]> = starts.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        let repetitions = repetitions(&series, &cycles);
        let curves = CycleCurves::new(&series, &cycles);
        let symmetries = symmetries(&repetitions, &curves);
        Self { summary, measured_shares, series, cycles, repetitions, curves, symmetries }
    }

    /// Writes all files, each under a temporary name that is then changed to its own; the summary comes last.
    ///
    /// # Errors
    /// Names the file that cannot be written.
    pub fn write(&self, origin: &Origin<'_>, table: &AngleTable, tracked: &Tracked, output: &OutputDir) -> Result<()> {
        let text = |name: &str, text: String| output.write(name, |writer| Ok(writer.write_all(text.as_bytes())?));
        text(ESTIMATES, table::to_csv(tracked, origin.motions)?)?;
        text(MEASURED, measured::to_csv(table, tracked, &origin.options.updates))?;
        text("anatomical.csv", to_csv(&self.series))?;
        text("repetitions.csv", repetition::to_csv(&self.repetitions))?;
        text("curves.csv", self.curves.to_csv())?;
        text("symmetry.csv", symmetry::to_csv(&self.symmetries))?;
        text("angles.mot", mot::to_mot(&self.series, origin.table))?;
        let body = body::Body::of_table(table, origin.height_m);
        let positions = joints::positions(table, tracked, self, &body, origin.options.sigma_rad)?;
        text("joints.trc", trc::to_trc(&positions, tracked.rate_hz, body.metres_per_unit, origin.table))?;
        if body.is_in_pixels() {
            text("joints_px.csv", joints::to_csv_px(&positions, table, &body))?;
        }
        #[cfg(feature = "plots")]
        for (name, picture) in plots::plots(self, table, tracked, &origin.options.updates)? {
            output.write_png(&name, &picture)?;
        }
        let document = document::Document::new(self, origin, tracked);
        output.write("summary.json", |writer| Ok(serde_json::to_writer_pretty(writer, &document)?))
    }
}

#[cfg(test)]
mod tests;
