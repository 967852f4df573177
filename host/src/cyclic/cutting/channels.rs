//! An angle table as signals that can be compared: cosine and sine of each angle that moves, about
//! their means.

use crate::cyclic::angle_table::{ANGLES, AngleRow, AngleTable};
use crate::cyclic::place_columns::PlaceColumns;
use crate::signal::median::median;

/// Smallest standard deviation of a signal that is used: about three degrees.
const MIN_STD_RAD: f64 = 0.05;
/// Share of the frames in which an angle has to be there.
const MIN_SHARE: f64 = 0.2;

/// Signals of the same length; NaN where the angle is missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Channels {
    signals: Vec<Vec<f64>>,
    /// What each signal counts in a correlation.
    weights: Vec<f64>,
    frames: usize,
}

impl Channels {
    /// The signals of `table`, from its first to its last frame; `None` if no angle moves. Each is
    /// weighted by how well its segment's length lets the angle be known. Noise of s pixels at both
    /// ends of a segment of L pixels is noise of sqrt(2) s / L radians in its angle, and the weight
    /// is inverse to that variance.
    #[must_use]
    pub fn of(table: &AngleTable) -> Option<Self> {
        let frames = (table.end_frame() - table.first_frame()) as usize;
        let lengths = length_shares(table);
        let (mut signals, mut weights) = (Vec::new(), Vec::new());
        for angle in 0..ANGLES {
            for part in [f64::cos, f64::sin] {
                let mut signal = vec![f64::NAN; frames];
                for row in table.rows() {
                    if let Some(angle) = row.angles_rad[angle] {
                        signal[(row.frame - table.first_frame()) as usize] = part(angle);
                    }
                }
                if let Some(signal) = centred(signal) {
                    signals.push(signal);
                    weights.push(lengths[angle] * lengths[angle]);
                }
            }
        }
        (!signals.is_empty()).then_some(Self { signals, weights, frames })
    }

    /// The same signals, ready to be compared over `period` frames. Each is taken about its mean
    /// over one period, so a slow turn or lean of the person does not count as a late step. Each is
    /// weighted by how closely it repeats after a period, so that angles that wind irregularly
    /// count little.
    #[must_use]
    pub fn over_period(&self, period: usize) -> Self {
        let weighed = |signal: &Vec<f64>| {
            let level = about_running_mean(signal, period);
            let differences = level.iter().zip(level.iter().skip(period)).map(|(a, b)| (b - a).powi(2));
            let known: Vec<f64> = differences.filter(|square| !square.is_nan()).collect();
            let spread = if known.is_empty() { 1.0 } else { known.iter().sum::<f64>() / known.len() as f64 };
            let weight = 1.0 / (spread + MIN_STD_RAD * MIN_STD_RAD).sqrt();
            level.into_iter().map(|value| weight * value).collect()
        };
        // Noise does not repeat either, so lengths count in this already.
        let (signals, weights) = (self.signals.iter().map(weighed).collect(), vec![1.0; self.weights.len()]);
        Self { signals, weights, frames: self.frames }
    }

    /// The signals, each as long as the recording.
    #[must_use]
    pub fn signals(&self) -> &[Vec<f64>] {
        &self.signals
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

    /// Weighted correlation of the frames of `at` with those `lag` later, over all signals, from -1
    /// to 1; `None` where less than half of the values are there twice.
    #[must_use]
    pub fn correlation(&self, at: std::ops::Range<usize>, lag: usize) -> Option<f64> {
        let (mut product, mut here, mut there, mut count) = (0.0, 0.0, 0.0, 0_usize);
        let (mut known, wanted) = (0_usize, at.len() * self.signals.len());
        for (signal, weight) in self.signals.iter().zip(&self.weights) {
            for frame in at.clone() {
                let (a, b) = (signal[frame], signal.get(frame + lag).copied().unwrap_or(f64::NAN));
                known += usize::from(!a.is_nan());
                if !a.is_nan() && !b.is_nan() {
                    product += weight * a * b;
                    here += weight * a * a;
                    there += weight * b * b;
                    count += 1;
                }
            }
        }
        let enough = 2 * count >= known && 8 * count >= wanted && count > 0;
        (enough && here > 0.0 && there > 0.0).then(|| product / (here * there).sqrt())
    }

    /// Mean squared difference of the frames of `at` and those `lag` later; `None` where nothing
    /// can be compared.
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

/// Median length of each segment as a share of the longest one; 1 where the table has none.
fn length_shares(table: &AngleTable) -> [f64; ANGLES] {
    let columns = PlaceColumns::find(table);
    let usual = |angle: usize| {
        let length = |row: &AngleRow| columns.as_ref()?.length(row, angle);
        median(&mut table.rows().iter().filter_map(length).collect::<Vec<f64>>())
    };
    let lengths: [Option<f64>; ANGLES] = std::array::from_fn(usual);
    let longest = lengths.iter().flatten().copied().fold(0.0, f64::max);
    lengths.map(|length| length.map_or(1.0, |length| length / longest))
}

/// Each value less the mean of those known in the window of `period` frames round it, which is
/// shifted inwards at the ends.
fn about_running_mean(signal: &[f64], period: usize) -> Vec<f64> {
    let (mut sums, mut counts) = (vec![0.0], vec![0_usize]);
    for (index, value) in signal.iter().enumerate() {
        sums.push(sums[index] + if value.is_nan() { 0.0 } else { *value });
        counts.push(counts[index] + usize::from(!value.is_nan()));
    }
    let last = signal.len().saturating_sub(period);
    let level = |(frame, value): (usize, &f64)| {
        let from = frame.saturating_sub(period / 2).min(last);
        let to = (from + period).min(signal.len());
        value - (sums[to] - sums[from]) / (counts[to] - counts[from]).max(1) as f64
    };
    signal.iter().enumerate().map(level).collect()
}

/// The signal about its mean, if it is there often enough and moves.
fn centred(mut signal: Vec<f64>) -> Option<Vec<f64>> {
    let known: Vec<f64> = signal.iter().copied().filter(|value| !value.is_nan()).collect();
    if (known.len() as f64) < MIN_SHARE * signal.len() as f64 || known.is_empty() {
        return None;
    }
    let mean = known.iter().sum::<f64>() / known.len() as f64;
    let variance = known.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / known.len() as f64;
    signal.iter_mut().for_each(|value| *value -= mean);
    (variance.sqrt() > MIN_STD_RAD).then_some(signal)
}
