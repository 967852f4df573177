//! One step of the Rauch-Tung-Striebel recursion.

use nalgebra::{Cholesky, DMatrix, DVector};

/// Mean and covariance.
#[derive(Debug, Clone, PartialEq)]
pub struct Moments {
    /// Mean.
    pub mean: DVector<f64>,
    /// Covariance, symmetric.
    pub covariance: DMatrix<f64>,
}

/// Parts of its diagonal by which a predicted covariance is raised until it can be inverted: what
/// `f32` states leave open.
const RIDGES: [f64; 3] = [0.0, 1.0e-9, 1.0e-6];

/// The moments of x(k) given everything: m + G `surprise`, P + G (P(k+1, smoothed) - P(k+1,
/// predicted)) G'. There G = `cross` / P(k+1, predicted).
///
/// `filtered` are the moments of x(k) given the measurements up to k. `cross` is the covariance of
/// x(k) with x(k+1) before the measurement k+1, and `predicted_covariance` that of x(k+1).
/// `surprise` is the smoothed mean of x(k+1) less its predicted mean. `None` where the predicted
/// covariance is not positive definite.
#[must_use]
pub fn smooth_step(
    filtered: &Moments,
    cross: &DMatrix<f64>,
    predicted_covariance: &DMatrix<f64>,
    next_covariance: &DMatrix<f64>,
    surprise: &DVector<f64>,
) -> Option<Moments> {
    let cholesky = RIDGES.iter().find_map(|ridge| {
        let mut raised = predicted_covariance.clone();
        raised.set_diagonal(&(raised.diagonal() * (1.0 + ridge)));
        Cholesky::new(raised)
    })?;
    let gain = cholesky.solve(&cross.transpose()).transpose();
    let mean = &filtered.mean + &gain * surprise;
    let change = &gain * (next_covariance - predicted_covariance) * gain.transpose();
    let mut covariance = &filtered.covariance + change;
    let rows = covariance.nrows();
    for i in 0..rows {
        for j in 0..i {
            let value = 0.5 * (covariance[(i, j)] + covariance[(j, i)]);
            covariance[(i, j)] = value;
            covariance[(j, i)] = value;
        }
    }
    Some(Moments { mean, covariance })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::random::Stream;

    /// Random walk with velocity, its position measured at every second step: forward and back,
    /// against the joint Gaussian of all states given all measurements.
    #[test]
    fn forward_and_back_is_the_joint_posterior() {
        const STEPS: usize = 12;
        let f = DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 0.0, 0.95]);
        let q = DMatrix::from_row_slice(2, 2, &[0.03, 0.01, 0.01, 0.05]);
        let h = DMatrix::from_row_slice(1, 2, &[1.0, 0.3]);
        let noise = 0.2;
        let mut stream = Stream::new(3, 0, 0);
        let seen: Vec<Option<f64>> =
            (0..STEPS).map(|k| (k % 2 == 1).then(|| 0.4 * k as f64 + f64::from(stream.normal()))).collect();
        let start = Moments { mean: DVector::from_vec(vec![0.1, 0.3]), covariance: DMatrix::identity(2, 2) * 0.5 };
        // The joint: precision and information vector over all states.
        let size = 2 * STEPS;
        let (mut precision, mut information) = (DMatrix::<f64>::zeros(size, size), DVector::<f64>::zeros(size));
        let prior = start.covariance.clone().try_inverse().unwrap();
        precision.view_mut((0, 0), (2, 2)).copy_from(&prior);
        information.rows_mut(0, 2).copy_from(&(&prior * &start.mean));
        let weight = q.clone().try_inverse().unwrap();
        for k in 0..STEPS {
            if k > 0 {
                let mut both = DMatrix::zeros(2, 4);
                both.view_mut((0, 0), (2, 2)).copy_from(&(-&f));
                both.view_mut((0, 2), (2, 2)).copy_from(&DMatrix::identity(2, 2));
                let added = both.transpose() * &weight * &both;
                let mut block = precision.view_mut((2 * k - 2, 2 * k - 2), (4, 4));
                block += added;
            }
            if let Some(value) = seen[k] {
                let mut block = precision.view_mut((2 * k, 2 * k), (2, 2));
                block += h.transpose() * &h / noise;
                let mut rows = information.rows_mut(2 * k, 2);
                rows += h.transpose().column(0) * (value / noise);
            }
        }
        let joint = precision.try_inverse().unwrap();
        let joint_mean = &joint * information;
        // Forward.
        let mut filtered = vec![start];
        for value in &seen[1..] {
            let last = filtered.last().unwrap();
            let (mut mean, mut covariance) = (&f * &last.mean, &f * &last.covariance * f.transpose() + &q);
            if let Some(value) = value {
                let variance = (&h * &covariance * h.transpose())[(0, 0)] + noise;
                let gain = &covariance * h.transpose() / variance;
                mean += gain.column(0) * (value - (&h * &mean)[0]);
                covariance -= &gain * gain.transpose() * variance;
            }
            filtered.push(Moments { mean, covariance });
        }
        // Back.
        let mut next = filtered[STEPS - 1].clone();
        for k in (0..STEPS - 1).rev() {
            let here = &filtered[k];
            let predicted = &f * &here.covariance * f.transpose() + &q;
            let surprise = &next.mean - &f * &here.mean;
            let cross = &here.covariance * f.transpose();
            next = smooth_step(here, &cross, &predicted, &next.covariance, &surprise).unwrap();
            let wanted = joint.view((2 * k, 2 * k), (2, 2));
            assert!((&next.covariance - wanted).norm() < 1.0e-9 * wanted.norm(), "step {k}");
            assert!((&next.mean - joint_mean.rows(2 * k, 2)).norm() < 1.0e-9, "step {k}");
            assert!(next.covariance[(0, 0)] < here.covariance[(0, 0)]);
        }
    }
}
