//! Figures 13 to 15, the margin of goals over angles, and the margin with other open numbers.

use super::common::{MEASURES, OTHER_DATA, measures, percent, reported, with_head};
use crate::body::Measured;
use crate::body::trial::{PoseMeasures, SeenMotion, TrialResult, trial};
use crate::reproduce::goals_against_angles::{Comparison, Pair, Value, compare, plots};
use crate::reproduce::open_numbers::{self, Numbers};
use crate::reproduce::page::{Row, Section};
use crate::reproduce::{Made, printed};
use anyhow::Result;
use serde_json::json;
use sinew::body::BodyPart;
use sinew::body::tracking::BodyModelKind;
use sinew::resume::Cells;

/// Numbers of particles whose margin is printed.
pub const MARGIN_PARTICLES: [usize; 2] = [100, 500];
/// The tuned models, goals first.
const TUNED: [BodyModelKind; 2] = [BodyModelKind::EndEffector, BodyModelKind::Angular];
/// Heads of the table of margins.
const MARGINS: [&str; 9] = [
    "body",
    "models",
    "particles",
    "goals, PIK (34), cm",
    "angles",
    "goals below angles by",
    "at the joints",
    "PIK (35)",
    "frames with a joint over 10 cm off, goals and angles",
];

/// Figures 13 to 15 of one part of the body.
///
/// # Errors
/// A number of a tracker that breaks a rule; an interrupted run.
pub fn figures_13_to_15(comparison: &Comparison<'_>, cells: &Cells<'_>, made: &mut Made) -> Result<()> {
    let pairs = compare(comparison, cells)?;
    let (part, motions) = (comparison.part, comparison.motions);
    let truth: Vec<f64> = motions.iter().filter_map(|(_, seen)| seen.first().map(SeenMotion::smoothness_m)).collect();
    let plots = plots(&pairs, part, Measured::of(&truth).mean);
    let mut table = numbers(&pairs);
    table.extend(baselines(comparison, cells)?);
    let mut rows = Vec::new();
    for pair in pairs.iter().filter(|pair| MARGIN_PARTICLES.contains(&pair.particles)) {
        let measures: [(&str, Value); 3] =
            [("PIK (34)", |t| t.error_m), ("joint error", |t| t.joint_error_m), ("PIK (35)", |t| t.smoothness_m)];
        for (name, value) in measures {
            rows.push(Row {
                what: format!("goals below angles by, {name}, {} particles", pair.particles),
                paper: "above zero at every number; drawn, not printed".into(),
                ours: percent(pair.margin_percent(value)),
                difference: "no number to compare".into(),
            });
        }
    }
    let times: Vec<f64> =
        pairs.iter().map(|p| mean(p, 0, |t| t.seconds_per_frame) / mean(p, 1, |t| t.seconds_per_frame)).collect();
    rows.push(Row {
        what: "time of goals over that of angles".into(),
        paper: format!("about {}", printed::PIK_TIME_RATIO),
        ours: format!("{:.2}", Measured::of(&times).mean),
        difference: format!("{:+.2}", Measured::of(&times).mean - printed::PIK_TIME_RATIO),
    });
    made.page.sections.push(Section {
        id: if part == BodyPart::Upper { "figures-13-upper" } else { "figures-13-whole" },
        title: format!("Figures 13 to 15: goals against angles, {} body", part.name()),
        material: format!(
            "{}, none of them tuned on. Both models have the paper's structure, and the numbers that it leaves open \
             were searched alike. In brackets: the 95 % interval over motions. The printed models have no deadband: \
             the pose before it is the same.",
            extent(comparison)
        ),
        rows,
        reason: OTHER_DATA.into(),
        table,
        pictures: plots.iter().map(|(file, _)| file.clone()).collect(),
    });
    made.plots.extend(plots);
    Ok(())
}

/// How many motions and seeds.
fn extent(comparison: &Comparison<'_>) -> String {
    let seeds = comparison.motions.first().map_or(0, |(_, seen)| seen.len());
    format!("{} motions, {seeds} seeds each", comparison.motions.len())
}

/// Rows of the table of margins: the printed pair of `comparison`, then the tuned one.
///
/// # Errors
/// As [`compare`].
pub fn margin_rows(comparison: &Comparison<'_>, cells: &Cells<'_>) -> Result<Vec<Vec<String>>> {
    let mut rows = Vec::new();
    for models in [comparison.models, TUNED] {
        for pair in compare(&Comparison { models, ..comparison.clone() }, cells)? {
            let error = |model| {
                let (mean, std) = pair.mean_and_std(model, |trial| trial.error_m);
                format!("{:.2} +- {:.2}", 100.0 * mean, 100.0 * std)
            };
            let lost = [0, 1].map(|model| format!("{:.0} %", 100.0 * mean(&pair, model, |t| t.lost_joint_share)));
            rows.push(vec![
                comparison.part.name().to_owned(),
                if models == TUNED { "tuned" } else { "as printed" }.to_owned(),
                pair.particles.to_string(),
                error(0),
                error(1),
                percent(pair.margin_percent(|trial| trial.error_m)),
                percent(pair.margin_percent(|trial| trial.joint_error_m)),
                percent(pair.margin_percent(|trial| trial.smoothness_m)),
                lost.join(", "),
            ]);
        }
    }
    Ok(rows)
}

/// Adds the table of margins.
pub fn margins(comparison: &Comparison<'_>, rows: Vec<Vec<String>>, made: &mut Made) {
    made.page.sections.push(Section {
        id: "margins",
        title: "Figures 13 and 14: the margin of goals over angles".into(),
        material: format!(
            "{}; +- is one standard deviation over seeds, mean over motions. A margin is that of the mean logarithm of \
             the ratio, in brackets its 95 % interval over motions (Student's t). The tuned models are the default \
             ones, whose numbers were chosen on people of three of the motions.",
            extent(comparison)
        ),
        reason: OTHER_DATA.into(),
        table: with_head(MARGINS, rows),
        ..Section::default()
    });
}

fn mean(pair: &Pair, model: usize, value: Value) -> f64 {
    pair.mean_and_std(model, value).0
}

fn numbers(pairs: &[Pair]) -> Vec<Vec<String>> {
    let head = ["particles", "model"].into_iter().chain(MEASURES).chain(["ms a frame"]);
    let mut table = with_head(head, []);
    for pair in pairs {
        for (index, model) in ["goals", "angles"].into_iter().enumerate() {
            let of = |value: Value, scale: f64| {
                let (mean, std) = pair.mean_and_std(index, value);
                format!("{:.2} +- {:.2}", scale * mean, scale * std)
            };
            table.push(vec![
                pair.particles.to_string(),
                model.into(),
                of(|t| t.error_m, 100.0),
                of(|t| t.joint_error_m, 100.0),
                format!("{:.0} %", 100.0 * mean(pair, index, |t| t.lost_joint_share)),
                of(|t| t.smoothness_m, 100.0),
                format!("{:.1}", 1000.0 * mean(pair, index, |t| t.seconds_per_frame)),
            ]);
        }
    }
    table
}

/// What any tracker has to beat: the mode alone, and the true pose of the frame before.
fn baselines(comparison: &Comparison<'_>, cells: &Cells<'_>) -> Result<Vec<Vec<String>>> {
    let (mut modes, mut before_m) = (Vec::new(), Vec::new());
    for (name, seen) in comparison.motions {
        for (seed, motion) in (1..).zip(seen) {
            let key = json!(["mode alone", name, comparison.part.name(), seed]);
            let run = || trial(motion, BodyModelKind::Guided, &comparison.tunings[0], 1, seed).map(|trial| trial.0);
            modes.push(cells.cell(&key, run)?);
        }
        before_m.extend(seen.first().map(last_pose_error_m));
    }
    let row = |name: &str, of: fn(&TrialResult) -> PoseMeasures| {
        let [error, joints, lost, smoothness] = measures(&modes.iter().map(of).collect::<Vec<_>>());
        // The spread over motions is not that over seeds of the rows above.
        let [error, joints, smoothness] = [error, joints, smoothness].map(|text| first_number(&text));
        vec!["1".into(), name.to_owned(), error, joints, lost, smoothness, String::new()]
    };
    let mut before = vec![String::new(); MEASURES.len() + 3];
    before[1] = "baseline: the true pose of the frame before".into();
    before[3] = format!("{:.2}", 100.0 * Measured::of(&before_m).mean);
    Ok(vec![
        row("baseline: the mode alone (one guided particle, default numbers)", reported),
        row("the same before the deadband", |trial| trial.before_deadband),
        before,
    ])
}

fn first_number(text: &str) -> String {
    text.split(' ').next().unwrap_or_default().to_owned()
}

/// Mean distance of the joints from their places in the frame before, metres.
fn last_pose_error_m(motion: &SeenMotion) -> f64 {
    let mut ways_m = Vec::new();
    for frames in motion.joints_m.windows(2) {
        for (before, now) in frames[0].iter().zip(&frames[1]).take(motion.part.bones()) {
            if let (Some(before), Some(now)) = (before, now) {
                ways_m.push(f64::from((now - before).norm()));
            }
        }
    }
    Measured::of(&ways_m).mean
}

/// The margin with other sets of open numbers, and with the other reading of PIK (31) and PIK (33).
///
/// # Errors
/// As [`compare`].
pub fn other_numbers(comparison: &Comparison<'_>, cells: &Cells<'_>, made: &mut Made) -> Result<()> {
    let head = [
        "numbers",
        "reach, cm",
        "particles",
        "PIK (34), cm: goals, angles",
        "goals below angles by",
        "joints, cm",
        "goals below angles by",
        "frames with a joint over 10 cm off",
        "PIK (35), cm a frame",
    ];
    let mut table = with_head(head, []);
    for Numbers { name, tunings } in open_numbers::all() {
        for pair in compare(&Comparison { tunings, ..comparison.clone() }, cells)? {
            let both = |value: Value, scale: f64, decimals: usize| {
                [0, 1].map(|model| format!("{:.decimals$}", scale * mean(&pair, model, value))).join(", ")
            };
            let reach_cm = format!("{:.1}", 100.0 * tunings[0].paper.reach_std_m);
            table.push(vec![
                name.to_owned(),
                reach_cm,
                pair.particles.to_string(),
                both(|t| t.error_m, 100.0, 2),
                percent(pair.margin_percent(|t| t.error_m)),
                both(|t| t.joint_error_m, 100.0, 2),
                percent(pair.margin_percent(|t| t.joint_error_m)),
                both(|t| 100.0 * t.lost_joint_share, 1.0, 0) + " %",
                both(|t| t.smoothness_m, 100.0, 2),
            ]);
        }
    }
    made.page.sections.push(Section {
        id: "open-numbers",
        title: format!("Figure 13 with other open numbers, {} body", comparison.part.name()),
        material: format!(
            "{}. The paper prints no lambda, W, sigma, tau or kappa. Each set was searched alike for goals and angles. \
             Reach is 1 / root W: a goal that is known to metres does not pull. The last row reads (31) and (33) \
             literally: of the particle's own last two angles and sampled goals. In brackets: the 95 % interval over \
             motions.",
            extent(comparison)
        ),
        table,
        ..Section::default()
    });
    Ok(())
}
