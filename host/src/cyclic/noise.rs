//! Measurement noise on angles that are known.

use super::{AngleRow, AngleTable};
use sinew_core::random::Stream;

impl AngleTable {
    /// The angles with independent Gaussian noise of `sigma_rad`; the first row stays exact, since
    /// it gives the first state.
    #[must_use]
    pub fn with_noise(&self, sigma_rad: f64, seed: u64) -> Self {
        let mut rows: Vec<AngleRow> = self.rows().to_vec();
        for (index, row) in rows.iter_mut().enumerate().skip(1) {
            let mut stream = Stream::new(seed, index as u64, 0);
            for angle in &mut row.angles_rad {
                let noise = sigma_rad * f64::from(stream.normal());
                *angle = angle.map(|angle| angle + noise);
            }
        }
        Self::new(rows, self.extra_columns().to_vec())
            .expect("only angles were changed, by finite noise")
            .at_rate(self.rate_hz())
    }
}
