//! The arm's variants and options on rendered scenes of recorded clips.

use super::markdown::{Rows, line, named};
use crate::clips::{Clip, recorded};
use crate::experiments::{self, Row, STACK_BYTES};
use crate::observed::{FrontEnd, ObservedScene, Reading, observe_all};
use anyhow::Result;
use sinew::config::Config;
use sinew::resume::Cells;
use sinew::scene::SceneOptions;
use sinew::skin::SkinModel;
use sinew::skin::model::DEFAULT_SKIN;
use sinew_core::tracker::arm::Variant;
use std::path::Path;

/// Clips, seeds of each, and frames: those of `sinew evaluate arm`.
const CLIPS: usize = 10;
const SEEDS: u64 = 10;
const FRAMES: usize = 250;
/// Numbers of particles.
const PARTICLES: [usize; 7] = [10, 25, 50, 100, 250, 1000, 5000];

/// Rows that `measure` makes of all scenes, read with `config`, on threads with room for thousands
/// of particles.
fn on_scenes(
    recordings: &Path,
    (config, reading): (&Config, Reading),
    measure: fn(&[ObservedScene]) -> Result<Rows>,
) -> Result<Rows> {
    let pool = rayon::ThreadPoolBuilder::new().stack_size(STACK_BYTES).build()?;
    pool.install(|| {
        let mut clips: Vec<Clip> = recorded(&recordings.join("mocap"))?;
        clips.truncate(CLIPS);
        let seeds: Vec<u64> = (1..=SEEDS).collect();
        let options = SceneOptions { frames: FRAMES, ..SceneOptions::default() };
        let skin = SkinModel::from_option(DEFAULT_SKIN)?;
        let front_end = FrontEnd { config, skin: &skin, reading };
        measure(&observe_all(&clips, &seeds, &options, &front_end, &Cells::not_kept())?)
    })
}

pub fn variants(recordings: &Path) -> Result<Rows> {
    on_scenes(recordings, (&Config::default(), Reading::OverTime), |scenes| {
        let measured = experiments::variants(scenes, &Variant::ALL, &PARTICLES, &Cells::not_kept())?;
        let mut rows = vec![named("", PARTICLES.map(|count| count.to_string()))];
        let error = |row: &Row| format!("{:.3} m, {:.1} px", row.error_m.median, row.error_px.median);
        for of_variant in measured.chunks(PARTICLES.len()) {
            rows.push(named(format!("`{}`", of_variant[0].name), of_variant.iter().map(error)));
        }
        Ok(rows)
    })
}

pub fn options(recordings: &Path) -> Result<Rows> {
    let mut rows = on_scenes(recordings, (&Config::default(), Reading::OverTime), |scenes| {
        let cells = &Cells::not_kept();
        let mut rows = vec![line(["", "3D error, m (quartiles)", "2D error, px (quartiles)"])];
        for variant in [Variant::Pik, Variant::Corrected] {
            let effects = experiments::options(scenes, variant, cells)?;
            rows.extend(effects.iter().map(|effect| spread(effect.name.clone(), effect)));
        }
        Ok(rows)
    })?;
    rows.extend(on_scenes(recordings, (&experiments::printed_base(), Reading::Alone), |scenes| {
        let printed = experiments::printed(scenes, &Cells::not_kept())?;
        Ok(printed.iter().map(|row| spread(format!("{}, {} particles", row.name, row.particles), row)).collect())
    })?);
    Ok(rows)
}

/// A line of medians with quartiles.
fn spread(name: String, row: &Row) -> Vec<String> {
    let (m, px) = (&row.error_m, &row.error_px);
    let metres = format!("{:.3} ({:.3}-{:.3})", m.median, m.lower, m.upper);
    line([name, metres, format!("{:.1} ({:.1}-{:.1})", px.median, px.lower, px.upper)])
}
