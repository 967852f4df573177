//! `--pictures`: some frames on a sheet, and curves over time.

use crate::body::tracking::BodyFilter;
use crate::body::tracking::filter::WholeBodyEstimate;
use crate::draw::body_views::{body_views, drawn_bones, sheet};
use crate::draw::contact_sheet::ContactSheet;
use crate::draw::plot::{Curve, curves_plot};
use crate::error::Result;
use crate::output::{OutputDir, PendingFile};
use image::RgbImage;
use sinew_core::math::Vec3;

/// Frames on the sheet.
const TILES: usize = 6;
const COLUMNS: u32 = 2;

/// What is drawn of a run.
#[derive(Debug)]
pub struct BodyPictures {
    choice: ContactSheet,
    tiles: Vec<RgbImage>,
    effective: Vec<(f64, f64)>,
    error_cm: Vec<(f64, f64)>,
}

impl BodyPictures {
    /// Pictures of a run of `frames` clouds.
    ///
    /// # Errors
    /// None for the number of tiles that is built in.
    pub fn new(frames: usize) -> Result<Self> {
        let choice = ContactSheet::new(frames, TILES)?;
        Ok(Self { choice, tiles: Vec::new(), effective: Vec::new(), error_cm: Vec::new() })
    }

    /// Whether the points of the `index`-th cloud are drawn.
    #[must_use]
    pub fn wants(&self, index: usize) -> bool {
        self.choice.wants(index)
    }

    /// Takes the frame number `frame`, the `index`-th cloud, at `time_s`.
    pub fn add(
        &mut self,
        (index, frame, time_s): (usize, u64, f64),
        points_m: &[Vec3],
        (filter, estimate): (&BodyFilter, &WholeBodyEstimate),
        joint_error_m: Option<f64>,
    ) {
        self.effective.push((time_s, f64::from(estimate.effective_sample_size)));
        self.error_cm.extend(joint_error_m.map(|error_m| (time_s, 100.0 * error_m)));
        if self.choice.wants(index) {
            let posture = filter.scene().posture(&estimate.angles_rad);
            let bones = drawn_bones(&posture, &filter.scene().radii_m);
            self.tiles.push(body_views(&format!("frame {frame}"), points_m, &bones));
        }
    }

    /// `contact_sheet.png`, `effective_samples.png`, and with truth `joint_error.png`, before they
    /// have their names.
    ///
    /// # Errors
    /// A picture that cannot be written.
    pub fn files(&self, out: &OutputDir) -> Result<Vec<PendingFile>> {
        let mut files = vec![out.pending_png("contact_sheet.png", &sheet(&self.tiles, COLUMNS))?];
        for (name, y_name, points) in [
            ("effective_samples.png", "effective particles", &self.effective),
            ("joint_error.png", "mean joint error (cm)", &self.error_cm),
        ] {
            if !points.is_empty() {
                let curve = Curve { name: y_name.to_owned(), points: points.clone(), ..Curve::default() };
                files.push(out.pending_png(name, &curves_plot(y_name, "time (s)", y_name, false, &[curve])?)?);
            }
        }
        Ok(files)
    }
}
