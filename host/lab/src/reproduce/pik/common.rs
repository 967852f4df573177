//! What the sections of the PIK page share.

use crate::body::Measured;
use crate::body::trial::{PoseMeasures, TrialResult};

/// Why the numbers are not the paper's.
pub const OTHER_DATA: &str = "The paper's stereo sequence is not public. Real motion is seen by a simulated small-baseline \
                              stereo camera at 15 frames a second, and the paper draws its errors without printing a number.";
/// Heads of the columns of [`measures`].
pub const MEASURES: [&str; 4] =
    ["PIK (34), cm", "joints, cm", "frames with a joint over 10 cm off", "PIK (35), cm a frame"];

/// Centimetres with one decimal.
pub fn cm(metres: f64) -> String {
    format!("{:.1}", 100.0 * metres)
}

/// A table of `rows` below `head`.
pub fn with_head<'a>(
    head: impl IntoIterator<Item = &'a str>,
    rows: impl IntoIterator<Item = Vec<String>>,
) -> Vec<Vec<String>> {
    std::iter::once(head.into_iter().map(str::to_owned).collect()).chain(rows).collect()
}

/// A margin with its interval.
pub fn percent((mean, low, high): (f64, f64, f64)) -> String {
    // Zero has no sign.
    let [mean, low, high] = [mean, low, high].map(|value| value.round() + 0.0);
    format!("{mean:.0} % ({low:.0} to {high:.0})")
}

/// The measures of the reported pose.
pub fn reported(trial: &TrialResult) -> PoseMeasures {
    let &TrialResult { error_m, joint_error_m, lost_joint_share, smoothness_m, .. } = trial;
    PoseMeasures { error_m, joint_error_m, lost_joint_share, smoothness_m }
}

/// Mean and standard deviation over `poses`, one a trial.
pub fn measures(poses: &[PoseMeasures]) -> [String; 4] {
    let of = |value: fn(&PoseMeasures) -> f64| Measured::of(&poses.iter().map(value).collect::<Vec<_>>());
    let cm = |value| {
        let Measured { mean, std, .. } = of(value);
        format!("{:.2} +- {:.2}", 100.0 * mean, 100.0 * std)
    };
    let lost = format!("{:.0} %", 100.0 * of(|pose| pose.lost_joint_share).mean);
    [cm(|pose| pose.error_m), cm(|pose| pose.joint_error_m), lost, cm(|pose| pose.smoothness_m)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_are_centimetres_with_their_spread() {
        let pose = |error_m| PoseMeasures { error_m, joint_error_m: 0.05, lost_joint_share: 0.25, smoothness_m: 0.004 };
        let [error, joints, lost, smoothness] = measures(&[pose(0.01), pose(0.03)]);
        // The standard deviation of two values is their distance over the root of two.
        assert_eq!((error.as_str(), joints.as_str()), ("2.00 +- 1.41", "5.00 +- 0.00"));
        assert_eq!((lost.as_str(), smoothness.as_str()), ("25 %", "0.40 +- 0.00"));
        assert_eq!(percent((27.4, -3.6, 35.5)), "27 % (-4 to 36)");
        assert_eq!(percent((-0.2, -0.4, 0.3)), "0 % (0 to 0)");
    }
}
