//! What a filter has to beat: the raw measurement, a filter of constant velocity with one number,
//! and the mean cycle replayed.

use super::experiments::{PROTOCOLS, SIGMAS_DEG, Setting};
use super::protocol::{Protocol, TestCycle, measurements};
use anyhow::Result;
use rayon::prelude::*;
use sinew::cyclic::AngleTable;
use sinew::cyclic::angle_table::ANGLES;
use std::f64::consts::{PI, TAU};

/// Standard deviations of the acceleration that are tried, rad per frame^2.
/// Chosen: from a tremor to a turn within a frame, in steps of the root of ten.
const ACCELERATION_STDS: [f64; 9] = [1.0e-4, 3.16e-4, 1.0e-3, 3.16e-3, 1.0e-2, 3.16e-2, 0.1, 0.316, 1.0];

/// A trivial estimate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Baseline {
    /// The last measurement as it is.
    Raw,
    /// A Kalman filter of each angle by itself, white acceleration, which begins at rest.
    ConstantVelocity,
    /// The model's mean cycle at its mean pace from position 0; no measurement is used.
    MeanCycle,
}

impl Baseline {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Raw, Self::ConstantVelocity, Self::MeanCycle];

    /// Name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Raw => "raw measurement",
            Self::ConstantVelocity => "constant velocity",
            Self::MeanCycle => "mean cycle replayed",
        }
    }
}

fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// One angle with constant velocity: value and velocity with their covariance.
#[derive(Debug, Clone, Copy)]
struct ConstantVelocity {
    state: [f64; 2],
    covariance: [f64; 3],
}

impl ConstantVelocity {
    fn at(angle: f64) -> Self {
        // Known as well as the filters of the paper: 1e-4 for angle and velocity.
        Self { state: [angle, 0.0], covariance: [1.0e-4, 0.0, 1.0e-4] }
    }

    fn step(&mut self, measured: Option<f64>, variance: f64, acceleration_variance: f64) -> f64 {
        let [a, b, c] = self.covariance;
        self.state[0] += self.state[1];
        let q = acceleration_variance;
        let [a, b, c] = [a + 2.0 * b + c + 0.25 * q, b + c + 0.5 * q, c + q];
        let Some(measured) = measured else {
            self.covariance = [a, b, c];
            return self.state[0];
        };
        let innovation = wrapped(measured - self.state[0]);
        let [gain, rate_gain] = [a / (a + variance), b / (a + variance)];
        self.state[0] += gain * innovation;
        self.state[1] += rate_gain * innovation;
        self.covariance = [(1.0 - gain) * a, (1.0 - gain) * b, c - rate_gain * b];
        self.state[0]
    }
}

/// Mean absolute error of a baseline over cycles and seeds with a measurement every so many frames,
/// degrees; the first frame is given.
#[must_use]
pub fn error_deg(
    setting: &Setting<'_>,
    baseline: Baseline,
    (protocol, sigma_deg, every): (Protocol, f64, u64),
    acceleration_std: f64,
) -> f64 {
    let seeds = if protocol == Protocol::ExactMean { 1 } else { setting.seeds };
    let jobs: Vec<(usize, u64)> =
        (0..setting.cycles.len()).flat_map(|cycle| (1..=seeds).map(move |seed| (cycle, seed))).collect();
    let sums: Vec<(f64, f64)> = jobs
        .into_par_iter()
        .map(|(cycle, seed)| {
            let truth = &setting.cycles[cycle];
            let measured = measurements(&truth.truth, protocol, sigma_deg.to_radians(), seed * 1000 + cycle as u64);
            errors(setting, (truth, &measured, every), baseline, sigma_deg.to_radians(), acceleration_std)
        })
        .collect();
    let (sum, count) = sums.into_iter().fold((0.0, 0.0), |(s, n), (sum, count)| (s + sum, n + count));
    sum / count
}

/// Sum and number of the absolute errors of one cycle, degrees.
fn errors(
    setting: &Setting<'_>,
    (cycle, measured, every): (&TestCycle, &AngleTable, u64),
    baseline: Baseline,
    sigma_rad: f64,
    acceleration_std: f64,
) -> (f64, f64) {
    let view = setting.model.view();
    let velocity = f64::from(view.mean_cycle_velocity()) * f64::from(setting.model.numbers().rate_hz) / setting.rate_hz;
    let first = &cycle.truth.rows()[0];
    let mut filters = first.angles_rad.map(|angle| ConstantVelocity::at(angle.unwrap_or(0.0)));
    let mut last_seen = first.angles_rad;
    let (mut sum, mut count) = (0.0, 0.0);
    for (index, (truth, measured)) in cycle.truth.rows().iter().zip(measured.rows()).enumerate().skip(1) {
        let position = (velocity * index as f64).fract() as f32;
        let mean = view.mean_pose_rad::<ANGLES>(view.point(position));
        for angle in 0..ANGLES {
            let seen = measured.angles_rad[angle].filter(|_| (index as u64).is_multiple_of(every));
            last_seen[angle] = seen.or(last_seen[angle]);
            let estimate = match baseline {
                Baseline::Raw => last_seen[angle],
                Baseline::ConstantVelocity => {
                    Some(filters[angle].step(seen, sigma_rad * sigma_rad, acceleration_std * acceleration_std))
                }
                Baseline::MeanCycle => Some(f64::from(mean[angle])),
            };
            if let (Some(estimate), Some(truth)) = (estimate, truth.angles_rad[angle]) {
                sum += wrapped(estimate - truth).abs().min(PI).to_degrees();
                count += 1.0;
            }
        }
    }
    (sum, count)
}

/// The one number of the constant-velocity filter: the least mean logarithm of the noisy errors
/// over all sigmas, on the cycles of `training`.
#[must_use]
pub fn tuned_acceleration_std(training: &Setting<'_>) -> f64 {
    let score = |std: f64| -> f64 {
        let error = |sigma| error_deg(training, Baseline::ConstantVelocity, (Protocol::Noisy, sigma, 1), std);
        SIGMAS_DEG.map(|sigma| error(sigma).ln()).iter().sum()
    };
    let scored = ACCELERATION_STDS.map(|std| (std, score(std)));
    scored.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(ACCELERATION_STDS[0], |best| best.0)
}

/// Rows beside table 1: name, protocol, error for each sigma.
///
/// # Errors
/// An interrupted run.
pub fn rows(setting: &Setting<'_>, acceleration_std: f64) -> Result<Vec<Vec<String>>> {
    let mut rows = Vec::new();
    for protocol in PROTOCOLS {
        for baseline in Baseline::ALL {
            setting.cells.go_on()?;
            let mut row = vec![baseline.name().to_owned(), protocol.name().to_owned()];
            let error = |sigma| error_deg(setting, baseline, (protocol, sigma, 1), acceleration_std);
            row.extend(SIGMAS_DEG.map(|sigma| format!("{:.2}", error(sigma))));
            rows.push(row);
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::synthetic::cycles;
    use sinew::cyclic::CyclicModel;
    use sinew::resume::Cells;

    #[test]
    fn raw_is_the_noise_and_a_filter_lies_below_it() {
        let model = CyclicModel::from_option("walking").unwrap();
        let (cycles, cells) = (cycles(&model, 60.0).unwrap(), Cells::not_kept());
        let setting = Setting { cycles: &cycles, model: &model, rate_hz: 60.0, seeds: 1, cells: &cells };
        let error = |baseline, protocol, sigma| error_deg(&setting, baseline, (protocol, sigma, 1), 3.16e-3);
        assert_eq!(error(Baseline::Raw, Protocol::ExactMean, 6.0), 0.0);
        let raw = error(Baseline::Raw, Protocol::Noisy, 6.0);
        let wanted = 6.0 * (2.0 / PI).sqrt();
        assert!((raw / wanted - 1.0).abs() < 0.03, "{raw} is the mean of the size of a normal: {wanted}");
        let smooth = error(Baseline::ConstantVelocity, Protocol::Noisy, 6.0);
        assert!(smooth < 0.8 * raw && smooth > 0.1 * raw, "{smooth} of {raw}");
        let [one, other] = [6.0, 29.0].map(|sigma| error(Baseline::MeanCycle, Protocol::Noisy, sigma));
        assert_eq!(one, other, "no measurement is used");
        assert!(one > 0.5 && one < 15.0, "people differ from their mean: {one}");
        let tuned = tuned_acceleration_std(&setting);
        let [best, low, high] = [tuned, 1.0e-4, 1.0]
            .map(|std| error_deg(&setting, Baseline::ConstantVelocity, (Protocol::Noisy, 6.0, 1), std));
        assert!(best < 0.8 * low && best < 0.8 * high, "{best} against {low} and {high}");
        // A gap costs the raw measurement what the angles move meanwhile.
        let gap = |every| error_deg(&setting, Baseline::Raw, (Protocol::ExactMean, 6.0, every), tuned);
        assert!(gap(2) > 0.05 && gap(10) > 4.0 * gap(2) && gap(10) < 40.0, "{} {}", gap(2), gap(10));
    }
}
