//! Figures 13 to 15 of the PIK paper: goals against angles with the paper's structure, and the
//! margin between them with its confidence interval.

use super::plot::{Plot, Series};
use crate::body::Measured;
use crate::body::report::percent_lower;
use crate::body::trial::{SeenMotion, TrialResult, trial};
use anyhow::Result;
use serde::Serialize;
use serde_json::json;
use sinew::body::BodyPart;
use sinew::body::tracking::{BodyModelKind, BodyTuning};
use sinew::resume::Cells;

/// The two models, goals first.
pub const PAIR: [BodyModelKind; 2] = [BodyModelKind::EndEffectorPaper, BodyModelKind::AngularPaper];

/// What is compared.
#[derive(Debug, Clone)]
pub struct Comparison<'a> {
    /// How much of the body is tracked.
    pub part: BodyPart,
    /// By motion, then by seed.
    pub motions: &'a [(String, Vec<SeenMotion>)],
    /// Numbers of particles.
    pub particles: &'a [usize],
    /// Numbers of goals and of angles.
    pub tunings: [BodyTuning; 2],
    /// The models.
    pub models: [BodyModelKind; 2],
}

/// Trials of both models with a number of particles, by motion, then by seed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Pair {
    /// Number of particles.
    pub particles: usize,
    /// Goals, then angles.
    pub trials: [Vec<Vec<TrialResult>>; 2],
}

/// A number of a trial.
pub type Value = fn(&TrialResult) -> f64;

impl Pair {
    /// Mean over motions and seeds, and the standard deviation over seeds, mean over motions.
    #[must_use]
    pub fn mean_and_std(&self, model: usize, value: Value) -> (f64, f64) {
        let motions: Vec<Measured> =
            self.trials[model].iter().map(|seeds| Measured::of(&seeds.iter().map(value).collect::<Vec<_>>())).collect();
        let n = motions.len().max(1) as f64;
        (motions.iter().map(|m| m.mean).sum::<f64>() / n, motions.iter().map(|m| m.std).sum::<f64>() / n)
    }

    /// By how much goals are below angles, percent, with the 95 % interval over motions: of the
    /// mean logarithm of the ratio, Student's t with one value a motion.
    #[must_use]
    pub fn margin_percent(&self, value: Value) -> (f64, f64, f64) {
        let [goals, angles] = &self.trials;
        let mean_log = |seeds: &[TrialResult]| seeds.iter().map(|t| value(t).ln()).sum::<f64>() / seeds.len() as f64;
        let ratios: Vec<f64> = goals.iter().zip(angles).map(|(g, a)| mean_log(g) - mean_log(a)).collect();
        percent_lower(&Measured::of(&ratios))
    }
}

/// Tracks everything; a trial that is in `cells` is not run again.
///
/// # Errors
/// A number of a tracker that breaks a rule; an interrupted run.
pub fn compare(comparison: &Comparison<'_>, cells: &Cells<'_>) -> Result<Vec<Pair>> {
    let Comparison { part, motions, particles, tunings, models } = comparison;
    let of_model = |index: usize, count: usize| -> Result<Vec<Vec<TrialResult>>> {
        let (model, tuning) = (models[index], &tunings[index]);
        let one = |(name, seen): &(String, Vec<SeenMotion>)| {
            let seeds = (1..).zip(seen);
            seeds
                .map(|(seed, motion)| {
                    let key = json!(["pik", name, part.name(), model.name(), tuning.paper, count, seed]);
                    cells.cell(&key, || trial(motion, model, tuning, count, seed).map(|trial| trial.0))
                })
                .collect::<Result<Vec<_>>>()
        };
        motions.iter().map(one).collect()
    };
    particles
        .iter()
        .map(|&particles| Ok(Pair { particles, trials: [of_model(0, particles)?, of_model(1, particles)?] }))
        .collect()
}

/// Figures 13 (error), joint error, 14 (smoothness) and 15 (time), by file name.
#[must_use]
pub fn plots(pairs: &[Pair], part: BodyPart, truth_smoothness_m: f64) -> Vec<(String, Plot)> {
    let shown: [(&str, &str, &str, Value, f64); 4] = [
        ("figure_13", "Figure 13: error, PIK (34)", "distance of markers from the skin, cm", |t| t.error_m, 100.0),
        ("joint_error", "Error of the joints", "distance of joints from the true ones, cm", |t| t.joint_error_m, 100.0),
        ("figure_14", "Figure 14: smoothness, PIK (35)", "way of a joint, cm a frame", |t| t.smoothness_m, 100.0),
        ("figure_15", "Figure 15: time", "time of a frame, ms", |t| t.seconds_per_frame, 1000.0),
    ];
    let series = |index: usize, value: Value, scale: f64| {
        let point = |pair: &Pair| {
            let (mean, std) = pair.mean_and_std(index, value);
            (pair.particles as f64, scale * mean, scale * std)
        };
        let name = ["end-effector (goals)", "angular"][index].to_owned();
        Series { name, points: pairs.iter().map(point).collect() }
    };
    let mut all = Vec::new();
    for (file, title, y_label, value, scale) in shown {
        let mut plot = Plot {
            title: format!("{title}, {} body", part.name()),
            x_label: "particles (logarithmic)".into(),
            y_label: y_label.into(),
            log_x: true,
            bars: "one standard deviation over seeds, as in the paper; mean over the motions".into(),
            series: vec![series(0, value, scale), series(1, value, scale)],
            ..Plot::default()
        };
        if file == "figure_14" {
            let points = pairs.iter().map(|pair| (pair.particles as f64, 100.0 * truth_smoothness_m, 0.0)).collect();
            plot.series.push(Series { name: "truth".into(), points });
        }
        all.push((format!("{file}_{}.svg", part.name()), plot));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::trial::PoseMeasures;

    fn trials(errors_m: &[f64]) -> Vec<TrialResult> {
        let of = |&error_m: &f64| TrialResult {
            error_m,
            recorded_error_m: None,
            joint_error_m: error_m,
            lost_joint_share: 0.0,
            near: None,
            smoothness_m: 0.01,
            before_deadband: PoseMeasures {
                error_m,
                joint_error_m: error_m,
                lost_joint_share: 0.0,
                smoothness_m: 0.01,
            },
            seconds_per_frame: 0.001,
            effective_share: 0.1,
        };
        errors_m.iter().map(of).collect()
    }

    #[test]
    fn a_margin_is_the_mean_ratio_with_an_interval_over_motions() {
        let goals = vec![trials(&[0.009, 0.009]), trials(&[0.016, 0.016]), trials(&[0.035, 0.035])];
        let angles = vec![trials(&[0.010, 0.010]), trials(&[0.020, 0.020]), trials(&[0.050, 0.050])];
        let pair = Pair { particles: 100, trials: [goals.clone(), angles] };
        let (mean, low, high) = pair.margin_percent(|trial| trial.error_m);
        let wanted = 100.0 * (1.0 - (0.9_f64 * 0.8 * 0.7).cbrt());
        assert!((mean - wanted).abs() < 1.0e-9, "{mean} is not {wanted}");
        // Student's t of three motions is 4.303: with so few the interval holds zero.
        assert!(low < 0.0 && high > 30.0 && high < 60.0, "{low} to {high}");
        let same = Pair { particles: 100, trials: [goals.clone(), goals] };
        assert_eq!(same.margin_percent(|trial| trial.error_m), (0.0, 0.0, 0.0));
        let (mean, std) = same.mean_and_std(0, |trial| trial.error_m);
        assert!((mean - 0.02).abs() < 1.0e-12 && std == 0.0, "{mean} {std}");
    }

    #[test]
    fn plots_show_both_models_and_the_truth_of_smoothness() {
        let pair = |particles| Pair { particles, trials: [vec![trials(&[0.01])], vec![trials(&[0.02])]] };
        let plots = plots(&[pair(50), pair(100)], BodyPart::Upper, 0.008);
        let names: Vec<&str> = plots.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(
            names,
            ["figure_13_upper.svg", "joint_error_upper.svg", "figure_14_upper.svg", "figure_15_upper.svg"]
        );
        let smoothness = &plots[2].1.series;
        assert_eq!(smoothness.len(), 3);
        assert!((smoothness[2].points[1].1 - 0.8).abs() < 1.0e-9 && smoothness[2].points[1].0 == 100.0);
        assert_eq!(plots[0].1.series[1].points, [(50.0, 2.0, 0.0), (100.0, 2.0, 0.0)]);
    }
}
