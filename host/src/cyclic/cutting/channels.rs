//! An angle table as signals that can be compared: cosine and sine of each angle that moves, about their means.

use crate::cyclic::angle_table::{ANGLES, AngleTable};

/// Least standard deviation of a signal that is used: about three degrees.
const LEAST_MOTION: f64 = 0.05;
/// Share of the frames in which an angle has to be there.
const LEAST_SHARE: f64 = 0.2;

/// Signals of the same length; NaN where the angle is missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Channels {
    signals: Vec<Vec<f64>>,
    frames: usize,
}

impl Channels {
    /// The signals of `table`, from its first to its last frame; `None` if no angle moves.
    #[must_use]
    pub fn of(table: &AngleTable) -> Option<Self> {
        let frames = (table.end_frame() - table.first_frame()) as usize;
        let mut signals = Vec::new();
        for angle in 0..ANGLES {
            for part in [f64::cos, f64::sin] {
                let mut signal = vec![f64::NAN; frames];
                for row in table.rows() {
                    if let Some(angle) = row.angles_rad[angle] {
                        signal[(row.frame - table.first_frame()) as usize] = part(angle);
                    }
                }
                signals.extend(centred(signal));
            }
        }
        (!signals.is_empty()).then_some(Self { signals, frames })
    }

    /// Number of frames.
    #[must_use]
    pub fn len(&self) -> usize {
        self.frames
    }

    /// Whether there is no frame.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.frames == 0
    }

    /// Correlation of the frames of `at` with those `lag` later, over all signals, from -1 to 1; `None` where less than half
    /// of the values are there twice.
    #[must_use]
    pub fn correlation(&self, at: std::ops::Range<usize>, lag: usize) -> Option<f64> {
        let (mut product, mut here, mut there, mut count) = (0.0, 0.0, 0.0, 0_usize);
        let (mut known, wanted) = (0_usize, at.len() * self.signals.len());
        for signal in &self.signals {
            for frame in at.clone() {
                let (a, b) = (signal[frame], signal.get(frame + lag).copied().unwrap_or(f64::NAN));
                known += usize::from(!a.is_nan());
                if !a.is_nan() && !b.is_nan() {
                    product += a * b;
                    here += a * a;
                    there += b * b;
                    count += 1;
                }
            }
        }
        let enough = 2 * count >= known && 8 * count >= wanted && count > 0;
        (enough && here > 0.0 && there > 0.0).then(|| product / (here * there).sqrt())
    }

    /// Mean squared difference of the frames of `at` and those `lag` later; `None` where nothing can be compared.
    #[must_use]
    pub fn difference(&self, at: std::ops::Range<usize>, lag: usize) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0_usize);
        for signal in &self.signals {
            for frame in at.clone() {
                let (a, b) = (signal[frame], signal.get(frame + lag).copied().unwrap_or(f64::NAN));
                if !a.is_nan() && !b.is_nan() {
                    sum += (a - b) * (a - b);
                    count += 1;
                }
            }
        }
        (count > 0).then(|| sum / count as f64)
    }
}

/// The signal about its mean, if it is there often enough and moves.
fn centred(mut signal: Vec<f64>) -> Option<Vec<f64>> {
    let known: Vec<f64> = signal.iter().copied().filter(|value| !value.is_nan()).collect();
    if (known.len() as f64) < LEAST_SHARE * signal.len() as f64 || known.is_empty() {
        return None;
    }
    let mean = known.iter().sum::<f64>() / known.len() as f64;
    let variance = known.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / known.len() as f64;
    signal.iter_mut().for_each(|value| *value -= mean);
    (variance.sqrt() > LEAST_MOTION).then_some(signal)
}
