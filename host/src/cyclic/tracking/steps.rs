//! Steps from one row to the next, and rows as measurements.

use super::TrackingOptions;
use crate::error::{Result, ensure};
use sinew_core::cyclic::measurement::MAX_STEP_FRAMES;
use sinew_core::cyclic::{AngleMeasurement, MotionModel};

/// How rows of a recording become measurements of a model.
#[derive(Debug, Clone, Copy)]
pub struct Steps<'a> {
    options: &'a TrackingOptions,
    rate_hz: f64,
    step_frames: f64,
}

impl<'a> Steps<'a> {
    /// Checks what does not depend on the rows.
    ///
    /// # Errors
    /// An option out of range, a rate so low that a step is too long.
    pub fn new(view: &MotionModel<'_>, options: &'a TrackingOptions) -> Result<Self> {
        options.check()?;
        let model_hz = f64::from(view.rate_hz());
        let rate_hz = options.rate_hz.unwrap_or(model_hz);
        let step_frames = model_hz / rate_hz;
        ensure!(
            step_frames <= f64::from(MAX_STEP_FRAMES),
            "`--rate {rate_hz}`: one frame is {step_frames:.0} of the model's; at most {MAX_STEP_FRAMES} can be bridged"
        );
        Ok(Self { options, rate_hz, step_frames })
    }

    /// Frames per second of the recording.
    #[must_use]
    pub const fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// Frames of the model's rate in one of the recording's.
    #[must_use]
    pub const fn step_frames(&self) -> f64 {
        self.step_frames
    }

    /// The angles of the first row with an angle, used or not.
    ///
    /// # Errors
    /// None for rows of a table.
    pub fn first<const N: usize>(&self, angles_rad: &[Option<f32>; N]) -> Result<AngleMeasurement<N>> {
        Ok(AngleMeasurement::new(angles_rad, self.options.sigma_rad as f32)?)
    }

    /// The measurement of `frame`, which follows the frame `before` in a recording that begins at
    /// `first_frame`. A gap longer than the longest step says no more than that one.
    ///
    /// # Errors
    /// None for rows of a table.
    pub fn later<const N: usize>(
        &self,
        first_frame: u64,
        before: u64,
        frame: u64,
        angles_rad: &[Option<f32>; N],
    ) -> Result<AngleMeasurement<N>> {
        let used = self.options.updates.uses(first_frame, frame);
        let angles_rad = if used { angles_rad } else { &[None; N] };
        let step = (self.step_frames * (frame - before) as f64).min(f64::from(MAX_STEP_FRAMES));
        Ok(self.first(angles_rad)?.after(step as f32)?)
    }
}
