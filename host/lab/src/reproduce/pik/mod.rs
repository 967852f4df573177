//! The PIK paper: figures 2, 6, 7, 9 to 17, 19 and 20, on real motion before a simulated stereo
//! camera.

mod common;
mod comparison;
mod markers;
mod predictions;
mod stick;

use super::goals_against_angles::{Comparison, PAIR};
use super::{Made, Material, seeds};
use crate::body::trial::SeenMotion;
use crate::data_split::{Role, motions};
use anyhow::Result;
use comparison::{MARGIN_PARTICLES, figures_13_to_15, margin_rows, margins, other_numbers};
use sinew::body::BodyPart;
use sinew::body::tracking::BodyTuning;
use sinew::resume::Cells;

/// Rows in the data split of these numbers.
pub const TRACKER: &str = "body-paper";
/// Numbers of particles of figures 13 to 15 and 17.
const PARTICLES: [usize; 6] = [50, 100, 250, 500, 1000, 2500];
/// Those of a quick run.
const QUICK_PARTICLES: [usize; 3] = [50, 100, 500];

/// Everything of the page.
///
/// # Errors
/// Recordings that are missing; a run that fails.
pub fn make(material: Material<'_>, cells: &Cells<'_>) -> Result<Made> {
    let seeds = seeds(material.is_quick, 5);
    let at_most = |all: &'static [usize]| &all[..all.partition_point(|&count| count <= material.max_particles)];
    let particles = at_most(if material.is_quick { &QUICK_PARTICLES } else { &PARTICLES });
    let mut made = Made::default();
    made.page.title = "PIK paper: predicting articulated human motion from spatial processes".into();
    made.page.left_out = left_out(&material, particles);
    let skeleton = material.data.join("mocap/cmu-walk/35/35.asf");
    let tuning = BodyTuning::default();
    predictions::predictions(&tuning, &mut made)?;
    let parts: &[BodyPart] = if material.is_quick { &[BodyPart::Upper] } else { &[BodyPart::Upper, BodyPart::Whole] };
    let mut all_margins = Vec::new();
    for &part in parts {
        let mut seen: Vec<(String, Vec<SeenMotion>)> = Vec::new();
        for motion in motions(material.data, TRACKER, Role::Reporting)? {
            cells.go_on()?;
            let read = motion.read(Some(&skeleton))?;
            seen.push((motion.name(), (1..=seeds).map(|seed| read.seen(part, seed)).collect::<Result<_>>()?));
        }
        let comparison = Comparison { part, motions: &seen, particles, tunings: [tuning; 2], models: PAIR };
        let at_margin = Comparison { particles: at_most(&MARGIN_PARTICLES), ..comparison.clone() };
        // The paper shows upper bodies; of whole ones there are the numbers of the margin.
        figures_13_to_15(if part == BodyPart::Upper { &comparison } else { &at_margin }, cells, &mut made)?;
        all_margins.extend(margin_rows(&at_margin, cells)?);
        if part == BodyPart::Upper {
            let counts = if material.is_quick { &MARGIN_PARTICLES[..1] } else { at_margin.particles };
            other_numbers(&Comparison { particles: counts, ..comparison.clone() }, cells, &mut made)?;
        }
        if part == parts[parts.len() - 1] {
            margins(&comparison, std::mem::take(&mut all_margins), &mut made);
        }
    }
    markers::recorded_markers(&material, (&tuning, seeds), cells, &mut made)?;
    stick::stick(&tuning, (seeds, particles), cells, &mut made)?;
    Ok(made)
}

fn left_out(material: &Material<'_>, particles: &[usize]) -> Vec<String> {
    let mut left_out = Vec::new();
    if material.is_quick {
        left_out.push("seeds 3 to 5, and 250, 1000 and 2500 particles".into());
        left_out.push("the whole body: upper bodies only, as in the paper's sequence".into());
        left_out.push("other sets of open numbers with 500 particles".into());
    } else if particles.len() < PARTICLES.len() {
        left_out.push(format!("more than {} particles", material.max_particles));
    }
    left_out.push("figures 8, 18 and 21: the paper's films are not public".into());
    left_out
}
