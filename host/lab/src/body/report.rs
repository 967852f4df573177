//! `report.json`, the table, and what the paper's figures ask of them.

use super::hidden_arm::{self, HiddenArm, HiddenArmSummary};
use super::prediction::PredictionReport;
use serde::Serialize;
use sinew::body::tracking::{BodyModelKind, BodyTuning};
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::fmt::Write;

/// A number measured in several trials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Measured {
    /// Mean over the trials.
    pub mean: f64,
    /// Standard deviation over the trials; zero for a single one.
    pub std: f64,
    /// Half width of the 95 % confidence interval of the mean (Student's t); zero for a single
    /// trial.
    pub ci95: f64,
}

impl Measured {
    /// Of one value a trial.
    #[must_use]
    pub fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n.max(1.0);
        if values.len() < 2 {
            return Self { mean, std: 0.0, ci95: 0.0 };
        }
        let std = (values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0)).sqrt();
        let t = StudentsT::new(0.0, 1.0, n - 1.0).map_or(0.0, |student| student.inverse_cdf(0.975));
        Self { mean, std, ci95: t * std / n.sqrt() }
    }
}

/// By how much a ratio lies below one, percent, with its 95 % interval; `log_ratio` is measured in
/// natural logarithms.
#[must_use]
pub fn percent_lower(log_ratio: &Measured) -> (f64, f64, f64) {
    let percent = |log: f64| 100.0 * (1.0 - log.exp());
    let Measured { mean, ci95, .. } = *log_ratio;
    (percent(mean), percent(mean + ci95), percent(mean - ci95))
}

/// One cell: a model with a number of particles on a motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodyResult {
    /// The motion's name.
    pub motion: String,
    /// The model.
    pub model: BodyModelKind,
    /// Number of particles.
    pub particles: usize,
    /// Eq. (34): markers from the skin, metres.
    pub error_m: Measured,
    /// Eq. (34) over the markers of a .c3d, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recorded_error_m: Option<Measured>,
    /// The same of the poses nearest to the true joints, metres: what no tracker of this body gets
    /// below.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recorded_floor_m: Option<f64>,
    /// Joints from the true ones, metres.
    pub joint_error_m: Measured,
    /// Share of frames that have a joint more than 10 cm off.
    pub lost_joint_share: Measured,
    /// Eq. (35), metres a frame.
    pub smoothness_m: Measured,
    /// Eq. (34) before the deadband, metres.
    pub error_before_deadband_m: Measured,
    /// Joints before the deadband, metres.
    pub joint_error_before_deadband_m: Measured,
    /// Share of frames with a joint more than 10 cm off before the deadband.
    pub lost_joint_share_before_deadband: Measured,
    /// Eq. (35) before the deadband, metres a frame.
    pub smoothness_before_deadband_m: Measured,
    /// Eq. (35) of the truth, metres a frame.
    pub truth_smoothness_m: f64,
    /// Wall time of the tracker's step, seconds a frame.
    pub seconds_per_frame: f64,
    /// Mean share of effective particles.
    pub effective_share: f64,
}

/// Everything that an evaluation found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodyReport {
    /// Says what this file is.
    pub format: &'static str,
    /// Version of the form of this file.
    pub version: u32,
    /// Version of the program.
    pub sinew_version: &'static str,
    /// Trials of each cell; trial n has seed n.
    pub trials: u64,
    /// What a user should know of the motions, one sentence each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Threads that the steps ran on.
    pub threads: usize,
    /// Numbers of the models.
    pub tuning: BodyTuning,
    /// All cells.
    pub results: Vec<BodyResult>,
    /// Particles with which the angular model equals the end-effector model with 250, by the mean
    /// over the motions. Absent where the counts do not determine it, infinite (null) where none
    /// does.
    pub angular_equals_end_effector_250: Option<f64>,
    /// What the models predict before they see a point: figures 2, 19 and 20.
    pub predictions: Option<PredictionReport>,
    /// Arms that were hidden by `--hide-arms`, by model and number of particles.
    pub hidden_arm_summaries: Vec<HiddenArmSummary>,
    /// Each of these arms.
    pub hidden_arms: Vec<HiddenArm>,
}

impl BodyReport {
    /// Mean error over all motions of a model and count, metres; `None` where it was not measured.
    #[must_use]
    pub fn mean_error_m(&self, model: BodyModelKind, particles: usize) -> Option<f64> {
        self.mean_of((model, particles), |cell| cell.error_m.mean)
    }

    /// Mean over all motions of what `value` reads of a model and count.
    fn mean_of(&self, of: (BodyModelKind, usize), value: fn(&BodyResult) -> f64) -> Option<f64> {
        let of_it = |cell: &&BodyResult| (cell.model, cell.particles) == of;
        let values: Vec<f64> = self.results.iter().filter(of_it).map(value).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }

    /// Counts that were measured with `model`, ascending.
    #[must_use]
    pub fn counts(&self, model: BodyModelKind) -> Vec<usize> {
        let mut counts: Vec<usize> =
            self.results.iter().filter(|cell| cell.model == model).map(|cell| cell.particles).collect();
        counts.sort_unstable();
        counts.dedup();
        counts
    }

    /// Particles that `model` needs for an error of `wanted_m`, on the line between its counts in
    /// the logarithm; `None` where no count reaches it or all are below it.
    #[must_use]
    pub fn particles_for(&self, model: BodyModelKind, wanted_m: f64) -> Option<f64> {
        let counts = self.counts(model);
        let errors: Vec<f64> = counts.iter().filter_map(|&count| self.mean_error_m(model, count)).collect();
        (1..errors.len()).find(|&i| errors[i] <= wanted_m && errors[i - 1] > wanted_m).map(|i| {
            let share = (errors[i - 1] - wanted_m) / (errors[i - 1] - errors[i]);
            let (low, high) = ((counts[i - 1] as f64).ln(), (counts[i] as f64).ln());
            (low + share * (high - low)).exp()
        })
    }

    /// The cells as CSV.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = String::from(
            "motion,model,particles,error_m,error_std_m,error_ci95_m,joint_error_m,lost_joint_share,smoothness_m,truth_smoothness_m,seconds_per_frame,error_before_deadband_m,joint_error_before_deadband_m,lost_joint_share_before_deadband,smoothness_before_deadband_m\n",
        );
        for cell in &self.results {
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{},{},{},{:.5},{:.5},{:.5},{:.5},{:.5},{:.5},{:.5},{:.5},{:.5},{:.5},{:.5},{:.5}",
                cell.motion,
                cell.model.name(),
                cell.particles,
                cell.error_m.mean,
                cell.error_m.std,
                cell.error_m.ci95,
                cell.joint_error_m.mean,
                cell.lost_joint_share.mean,
                cell.smoothness_m.mean,
                cell.truth_smoothness_m,
                cell.seconds_per_frame,
                cell.error_before_deadband_m.mean,
                cell.joint_error_before_deadband_m.mean,
                cell.lost_joint_share_before_deadband.mean,
                cell.smoothness_before_deadband_m.mean
            );
        }
        text
    }

    /// Tables of the means over the motions, a row a model, a column a count: errors on the skin
    /// and at the joints, lost joints, smoothness.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        self.add_means(&mut text, "mean error over the motions, cm, PIK (34)", |cell| 100.0 * cell.error_m.mean);
        self.add_means(&mut text, "mean error at the joints, cm", |cell| 100.0 * cell.joint_error_m.mean);
        self.add_means(&mut text, "frames with a joint more than 10 cm off, %", |cell| {
            100.0 * cell.lost_joint_share.mean
        });
        self.add_means(&mut text, "smoothness over the truth's, PIK (35)", |cell| {
            cell.smoothness_m.mean / cell.truth_smoothness_m
        });
        if self.results.iter().any(|cell| cell.smoothness_m != cell.smoothness_before_deadband_m) {
            self.add_means(&mut text, "before the deadband: cm, PIK (34)", |cell| {
                100.0 * cell.error_before_deadband_m.mean
            });
            self.add_means(&mut text, "before the deadband: cm at the joints", |cell| {
                100.0 * cell.joint_error_before_deadband_m.mean
            });
            self.add_means(&mut text, "before the deadband: smoothness over the truth's, PIK (35)", |cell| {
                cell.smoothness_before_deadband_m.mean / cell.truth_smoothness_m
            });
        }
        self.add_notes(&mut text);
        text
    }

    /// The table of one measure.
    fn add_means(&self, text: &mut String, title: &str, value: fn(&BodyResult) -> f64) {
        let mut models: Vec<BodyModelKind> = self.results.iter().map(|cell| cell.model).collect();
        models.sort_unstable();
        models.dedup();
        let mut counts: Vec<usize> = self.results.iter().map(|cell| cell.particles).collect();
        counts.sort_unstable();
        counts.dedup();
        // Writing to a string cannot fail.
        let _ = write!(text, "{title}\nparticles         ");
        for count in &counts {
            let _ = write!(text, "{count:>8}");
        }
        for model in models {
            let _ = write!(text, "\n{:18}", model.name());
            for &count in &counts {
                match self.mean_of((model, count), value) {
                    Some(mean) => {
                        let _ = write!(text, "{mean:8.2}");
                    }
                    None => text.push_str("       -"),
                }
            }
        }
        text.push('\n');
    }

    /// What is no table: recorded markers, hidden arms, notes.
    fn add_notes(&self, text: &mut String) {
        for cell in &self.results {
            if let (Some(error_m), Some(floor_m)) = (cell.recorded_error_m, cell.recorded_floor_m) {
                let (model, error_cm, floor_cm) = (cell.model.name(), 100.0 * error_m.mean, 100.0 * floor_m);
                let _ = writeln!(
                    text,
                    "recorded markers of {}: {model} with {} {error_cm:.2} cm; nearest pose {floor_cm:.2} cm",
                    cell.motion, cell.particles
                );
            }
        }
        if let Some(count) = self.angular_equals_end_effector_250 {
            let _ = writeln!(text, "angular needs {count:.0} particles for the error of end-effector with 250");
        }
        *text += &hidden_arm::to_text(&self.hidden_arm_summaries);
        for note in &self.notes {
            let _ = writeln!(text, "note: {note}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_students() {
        let measured = Measured::of(&[1.0, 2.0, 3.0, 4.0, 5.0]);
        assert!((measured.mean - 3.0).abs() < 1.0e-12 && (measured.std - 2.5_f64.sqrt()).abs() < 1.0e-12);
        assert!((measured.ci95 - 2.776_445 * (0.5_f64).sqrt()).abs() < 1.0e-4, "{}", measured.ci95);
        assert_eq!(Measured::of(&[2.0]), Measured { mean: 2.0, std: 0.0, ci95: 0.0 });
    }

    #[test]
    fn the_count_of_equal_error_lies_between_counts() {
        let cell = |particles: usize, error: f64| BodyResult {
            motion: "m".into(),
            model: BodyModelKind::Angular,
            particles,
            error_m: Measured::of(&[error]),
            recorded_error_m: None,
            recorded_floor_m: None,
            joint_error_m: Measured::of(&[2.0 * error]),
            lost_joint_share: Measured::of(&[0.25]),
            smoothness_m: Measured::of(&[0.01]),
            error_before_deadband_m: Measured::of(&[error]),
            joint_error_before_deadband_m: Measured::of(&[2.0 * error]),
            lost_joint_share_before_deadband: Measured::of(&[0.25]),
            smoothness_before_deadband_m: Measured::of(&[0.02]),
            truth_smoothness_m: 0.01,
            seconds_per_frame: 0.01,
            effective_share: 0.1,
        };
        let report = BodyReport {
            format: "",
            version: 1,
            sinew_version: "",
            trials: 1,
            notes: vec!["it is cut".to_owned()],
            threads: 1,
            tuning: BodyTuning::default(),
            results: vec![cell(100, 0.08), cell(10_000, 0.04)],
            angular_equals_end_effector_250: None,
            predictions: None,
            hidden_arm_summaries: Vec::new(),
            hidden_arms: Vec::new(),
        };
        let found = report.particles_for(BodyModelKind::Angular, 0.06).unwrap();
        assert!((found - 1000.0).abs() < 1.0e-6, "{found}");
        assert_eq!(report.particles_for(BodyModelKind::Angular, 0.03), None);
        let text = report.to_text();
        for (title, wanted) in [
            ("PIK (34)", "8.00"),
            ("at the joints", "16.00"),
            ("10 cm off", "25.00"),
            ("(35)", "1.00"),
            ("before the deadband: smoothness over the truth's, PIK (35)", "2.00"),
        ] {
            let table = text.split_once(title).unwrap().1;
            assert!(table.lines().nth(2).unwrap().contains(wanted), "{title}: {text}");
        }
    }
}
