//! PIK (34) over markers that were recorded on a person, which no model of ours made.

use super::common::{MEASURES, measures, reported, with_head};
use crate::body::Measured;
use crate::body::trial::{SeenMotion, TrialResult, trial};
use crate::data_split::{Role, motions};
use crate::reproduce::goals_against_angles::PAIR;
use crate::reproduce::page::Section;
use crate::reproduce::{Made, Material};
use anyhow::Result;
use serde_json::json;
use sinew::body::BodyPart;
use sinew::body::tracking::{BodyModelKind, BodyTuning};
use sinew::resume::Cells;

/// Rows in the data split of the recordings with markers.
const TRACKER: &str = "body-markers";
/// Models with their particles, the mode alone last.
const MODELS: [(BodyModelKind, usize); 4] =
    [(PAIR[0], 500), (PAIR[1], 500), (BodyModelKind::Guided, 50), (BodyModelKind::Guided, 1)];

/// Adds the table of recorded markers.
///
/// # Errors
/// A recording that is missing; a run that fails.
pub fn recorded_markers(
    material: &Material<'_>,
    (tuning, seeds): (&BodyTuning, u64),
    cells: &Cells<'_>,
    made: &mut Made,
) -> Result<()> {
    let head = ["recording", "model", "recorded markers, PIK (34), cm"].into_iter().chain(MEASURES);
    let mut table = with_head(head, []);
    for motion in motions(material.data, TRACKER, Role::Reporting)? {
        let read = motion.read(None)?;
        let seen: Vec<SeenMotion> = (1..=seeds).map(|seed| read.seen(BodyPart::Whole, seed)).collect::<Result<_>>()?;
        for (model, count) in MODELS {
            let one = |(seed, motion): (u64, &SeenMotion)| -> Result<TrialResult> {
                let key = json!(["recorded markers", motion.key(), model.name(), tuning.paper, count, seed]);
                cells.cell(&key, || trial(motion, model, tuning, count, seed).map(|trial| trial.0))
            };
            let trials: Vec<TrialResult> = (1..).zip(&seen).map(one).collect::<Result<_>>()?;
            let recorded_m: Vec<f64> = trials.iter().filter_map(|trial| trial.recorded_error_m).collect();
            let Measured { mean, std, .. } = Measured::of(&recorded_m);
            let name =
                if count == 1 { "baseline: the mode alone".into() } else { format!("{}, {count}", model.name()) };
            let mut row = vec![motion.name(), name, format!("{:.2} +- {:.2}", 100.0 * mean, 100.0 * std)];
            row.extend(measures(&trials.iter().map(reported).collect::<Vec<_>>()));
            table.push(row);
        }
        if let Some(floor_m) = seen.first().map(SeenMotion::recorded_floor_m).transpose()?.flatten() {
            let mut row = vec![motion.name(), "nearest pose of this body".into(), format!("{:.2}", 100.0 * floor_m)];
            row.resize(table[0].len(), String::new());
            table.push(row);
        }
    }
    made.page.sections.push(Section {
        id: "recorded-markers",
        title: "PIK (34) over recorded markers".into(),
        material: format!(
            "A take of HDM05 with the markers of its optical system; {seeds} seeds, +- is one standard deviation over \
             them. The points are still those of the simulated camera, and the second PIK (34) is that of its virtual \
             markers. No tracker of this body gets below the nearest pose."
        ),
        table,
        ..Section::default()
    });
    Ok(())
}
