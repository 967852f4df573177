//! Means over the strides of one foot.

use super::strides::Stride;
use serde::Serialize;

/// Mean and spread.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MeanStd {
    /// Mean.
    pub mean: f64,
    /// Standard deviation, of two values or more.
    pub std: Option<f64>,
    /// Number of values.
    pub count: usize,
}

impl MeanStd {
    fn of(values: impl Iterator<Item = Option<f64>>) -> Option<Self> {
        let values: Vec<f64> = values.flatten().collect();
        let count = values.len();
        if count == 0 {
            return None;
        }
        let mean = values.iter().sum::<f64>() / count as f64;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let std = (count > 1).then(|| (squares / (count - 1) as f64).sqrt());
        Some(Self { mean, std, count })
    }
}

/// Means of what a [`Stride`] holds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the fields of `Stride`")]
pub struct FootMeans {
    pub stride_time_s: Option<MeanStd>,
    pub step_time_s: Option<MeanStd>,
    pub stance_share: Option<MeanStd>,
    pub swing_share: Option<MeanStd>,
    pub double_support_share: Option<MeanStd>,
    pub flight_time_s: Option<MeanStd>,
    pub step_length_m: Option<MeanStd>,
    pub stride_length_m: Option<MeanStd>,
    pub speed_m_per_s: Option<MeanStd>,
}

impl FootMeans {
    pub(super) fn of(strides: &[Stride]) -> Self {
        let mean = |value: fn(&Stride) -> Option<f64>| MeanStd::of(strides.iter().map(value));
        Self {
            stride_time_s: mean(|stride| Some(stride.stride_time_s)),
            step_time_s: mean(|stride| stride.step_time_s),
            stance_share: mean(|stride| Some(stride.stance_share)),
            swing_share: mean(|stride| Some(stride.swing_share)),
            double_support_share: mean(|stride| stride.double_support_share),
            flight_time_s: mean(|stride| stride.flight_time_s),
            step_length_m: mean(|stride| stride.step_length_m),
            stride_length_m: mean(|stride| stride.stride_length_m),
            speed_m_per_s: mean(|stride| stride.speed_m_per_s),
        }
    }
}
