//! The cyclic paper: tables 1 and 2, figures 3 to 5, on walkers.

mod common;
mod noise;
mod samples;
mod sparse;
mod trajectories;

use super::{Made, Material, printed, seeds};
use crate::cyclic::experiments::Setting;
use crate::cyclic::{rate_of, test_cycles};
use anyhow::Result;
use noise::{figure_4a, table_1};
use samples::{figures_5, table_2};
use sinew::cyclic::CutList;
use sinew::cyclic::training::{TrainingOptions, train};
use sinew::resume::Cells;
use sparse::figure_4b;
use trajectories::figure_3;

/// Most samples of a quick run.
const QUICK_SAMPLES: usize = 10_000;
/// Samples of figure 5a, as in the paper.
const SPARSE_SAMPLES: [usize; 2] = [10_000, 50_000];
/// Everything of the page.
///
/// # Errors
/// Recordings that are missing; a run that fails.
pub fn make(material: Material<'_>, cells: &Cells<'_>) -> Result<Made> {
    let folder = material.data.join("cyclic-walking");
    let list = CutList::read(&folder.join("train_cuts.csv"))?;
    let rate_hz = rate_of(&list, None)?;
    let model = train(&list, TrainingOptions { rate_hz: Some(rate_hz), ..TrainingOptions::default() })?;
    let cycles = test_cycles(&CutList::read(&folder.join("test_cuts.csv"))?)?;
    let seeds = seeds(material.is_quick, 10);
    let setting = Setting { cycles: &cycles, model: &model, rate_hz, seeds, cells };
    let most = material.max_particles.min(if material.is_quick { QUICK_SAMPLES } else { usize::MAX });
    let at_most = |all: &'static [usize]| &all[..all.partition_point(|&count| count <= most)];
    let (samples, sparse) = (at_most(&printed::CYCLIC_SAMPLES), at_most(&SPARSE_SAMPLES));
    let mut made = Made::default();
    let page = &mut made.page;
    page.title = "Cyclic paper: a kinematic model for Bayesian tracking of cyclic human motion".into();
    if material.is_quick {
        page.left_out.push(format!("seeds 3 to 10; spread is that of {seeds} seeds and {} cycles", cycles.len()));
    }
    if samples.len() < printed::CYCLIC_SAMPLES.len() {
        page.left_out.push(format!("more than {most} samples in table 2 and figures 5a and 5b"));
    }
    let training = test_cycles(&list)?;
    let std = table_1(&setting, &training, &mut made)?;
    figure_3(&setting, &mut made)?;
    figure_4a(&setting, &mut made)?;
    figure_4b(&setting, std, &mut made)?;
    table_2(&setting, (samples, std), &mut made)?;
    figures_5(&setting, (sparse, samples), &mut made)?;
    Ok(made)
}
