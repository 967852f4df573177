//! The files of a tracked recording.

use super::contents::{Origin, Report};
#[cfg(feature = "plots")]
use super::plots;
use super::{body, document, joints, measured};
use crate::cyclic::AngleTable;
use crate::cyclic::anatomy::{ANATOMICAL_ANGLES, AnatomicalSeries, CycleCurves, MeasuredAngles, repetition, symmetry};
use crate::cyclic::export::{mot, series::to_csv, trc};
use crate::cyclic::gait::Gait;
use crate::cyclic::tracking::{Tracked, table};
use crate::error::Result;
use crate::output::OutputDir;
use crate::signal::FilterOptions;
#[cfg(feature = "plots")]
use rayon::prelude::*;

/// File of the estimates.
pub const ESTIMATES: &str = "estimates.csv";
/// File of the angles that the filter was given.
pub const MEASURED: &str = "measured.csv";

impl Report {
    /// Writes all files, each under a temporary name that is then changed to its own; the summary
    /// comes last.
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
        // Flexion angles without a model of the motion.
        let (filter, _) = FilterOptions::default().lowered_for(tracked.rate_hz);
        if let Ok(measured) = MeasuredAngles::of_table(table, tracked.rate_hz, &filter) {
            text("measured_anatomical.csv", measured.to_csv())?;
        }
        if let Ok(gait) = &self.gait {
            text("events.csv", gait.events.to_csv(tracked.rate_hz))?;
            text("strides.csv", gait.strides_to_csv(tracked.rate_hz))?;
            text("gait_curves.csv", curves_from_strikes(&self.series, gait).to_csv())?;
        }
        text("symmetry.csv", symmetry::to_csv(&self.symmetries))?;
        text("angles.mot", mot::to_mot(&self.series, origin.table))?;
        let body = body::Body::of_table(table, origin.height_m);
        let positions = joints::positions(table, tracked, self, &body, origin.options.sigma_rad)?;
        text("joints.trc", trc::to_trc(&positions, tracked.rate_hz, body.metres_per_unit, origin.table))?;
        if body.is_in_pixels() {
            text("joints_px.csv", joints::to_csv_px(&positions, table, &body))?;
        }
        #[cfg(feature = "plots")]
        plots::plots(self, table, tracked, &origin.options.updates)?
            .par_iter()
            .try_for_each(|(name, picture)| output.write_png(name, picture))?;
        let document = document::Document::new(self, origin, tracked);
        output.write("summary.json", |writer| Ok(serde_json::to_writer_pretty(writer, &document)?))
    }
}

/// Curves of each side from strike to strike of its own foot; those of the trunk from the left
/// one's.
fn curves_from_strikes(series: &AnatomicalSeries, gait: &Gait) -> CycleCurves {
    let of_foot = |strikes: &[f64]| {
        let pairs: Vec<[f64; 2]> = strikes.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        CycleCurves::new(series, &pairs)
    };
    let (left, right) = (of_foot(&gait.events.left.strikes), of_foot(&gait.events.right.strikes));
    let curves = ANATOMICAL_ANGLES.iter().zip(left.curves).zip(right.curves);
    CycleCurves {
        curves: curves.map(|((name, left), right)| if name.starts_with("r_") { right } else { left }).collect(),
    }
}
