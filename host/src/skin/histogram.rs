//! Colour histograms of skin and of everything else, and Bayes' rule, after Jones and Rehg (2002).
//!
//! Three things make a few dozen images enough. Each pixel is counted under several strengths and
//! tints of light. Neighbouring cells share counts. A cell with little evidence falls back to the
//! probability of its chromaticity.

use super::colour_cube::{CELLS, cell_of, centre_of, over_brightness, relit, smooth};
use super::threshold::{Choice, ColourLevels, cross_validate};
use super::training_set::{TrainingSet, Unit};
use crate::error::{Result, bail};
use sinew_core::vision::skin::{CUBE_WORDS, HistogramSkin};

/// Strengths of light under which each training pixel is counted.
pub const GAINS: [f64; 5] = [0.85, 0.92, 1.0, 1.08, 1.17];
/// Tints of light (errors of white balance) under which each training pixel is counted.
pub const TINTS: [[f64; 3]; 5] =
    [[1.0, 1.0, 1.0], [1.04, 1.0, 0.96], [0.96, 1.0, 1.04], [1.0, 1.03, 1.0], [1.0, 0.97, 1.0]];
/// Standard deviation of the smoothing of the cube, cells.
pub const SMOOTHING_STD_CELLS: f64 = 0.7;
/// Evidence, in images, that the chromaticity's own probability counts in each cell.
pub const CHROMATICITY_EVIDENCE: f64 = 0.01;
/// Evidence, in images, that the overall share of skin counts in each chromaticity.
const BASE_EVIDENCE: f64 = 0.001;
/// Cells darker than this sum R+G+B get no help from their chromaticity, which is noise there.
const DARK_SUM: f64 = 100.0;
/// Probability levels of a cell.
const TOP: f64 = 255.0;
/// Evidence levels of a cell: level n stands for 2^(n - 10) images.
pub const EVIDENCE_LEVELS: u8 = 16;

/// Numbers of the histogram model: for each cell of the colour cube what was learned of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HistogramModel {
    /// Probability of skin, 0 to 255, for each cell in the order of [`cell_of`].
    pub probability: Vec<u8>,
    /// How much evidence that rests on: level n, 0 to 15, stands for 2^(n - 10) images.
    pub evidence: Vec<u8>,
    /// A cell is skin from this probability on, 1 to 255.
    pub min_probability: u8,
}

impl HistogramModel {
    /// The decision table of the core's classifier.
    #[must_use]
    pub fn table(&self) -> Box<[u32; CUBE_WORDS]> {
        let mut table = Box::new([0; CUBE_WORDS]);
        for (cell, &probability) in self.probability.iter().enumerate() {
            table[cell / 32] |= u32::from(probability >= self.min_probability) << (cell % 32);
        }
        table
    }

    /// The model of given skin and other masses (in images), which already include all prior
    /// evidence.
    pub(super) fn from_masses(skin: &[f64], other: &[f64], min_probability: u8) -> Self {
        let quantise = |(&s, &o): (&f64, &f64)| ((s / (s + o)) * TOP).round() as u8;
        let level = |(&s, &o): (&f64, &f64)| ((s + o).log2().round() + 10.0).clamp(0.0, 15.0) as u8;
        Self {
            probability: skin.iter().zip(other).map(quantise).collect(),
            evidence: skin.iter().zip(other).map(level).collect(),
            min_probability,
        }
    }

    /// Mass (in images) of skin and of other things in `cell`.
    pub(super) fn masses(&self, cell: usize) -> (f64, f64) {
        let evidence = (f64::from(self.evidence[cell]) - 10.0).exp2();
        let probability = f64::from(self.probability[cell]) / TOP;
        (probability * evidence, (1.0 - probability) * evidence)
    }
}

impl ColourLevels for HistogramModel {
    fn level(&self, rgb: [u8; 3]) -> usize {
        255 - usize::from(self.probability[cell_of(rgb)])
    }
}

/// Whether a core table says that `rgb` is skin.
#[must_use]
pub fn is_skin(table: &[u32; CUBE_WORDS], rgb: [u8; 3]) -> bool {
    HistogramSkin::new(table).is_skin(rgb)
}

/// Adds a unit's colours to the cubes, under all [`GAINS`] and [`TINTS`]; the unit as a whole
/// counts as one image.
fn count(unit: &Unit, skin: &mut [f64], other: &mut [f64]) {
    let mut total = 0.0;
    let mut counted = Vec::with_capacity(unit.colours.len() * GAINS.len() * TINTS.len());
    for colour in &unit.colours {
        let lights = GAINS.iter().flat_map(|&gain| TINTS.iter().map(move |&tint| (gain, tint)));
        for rgb in lights.filter_map(|(gain, tint)| relit(colour.rgb, gain, tint)) {
            total += f64::from(colour.count);
            counted.push((cell_of(rgb), colour.is_skin, f64::from(colour.count)));
        }
    }
    for (cell, is_skin, pixels) in counted {
        let cube = if is_skin { &mut *skin } else { &mut *other };
        cube[cell] += pixels / total;
    }
}

/// Learns each cell's probability of skin; the threshold is left at `min_probability`.
fn fit(units: &[&Unit], min_probability: u8) -> Result<HistogramModel> {
    let (mut skin, mut other) = (vec![0.0; CELLS], vec![0.0; CELLS]);
    for unit in units {
        count(unit, &mut skin, &mut other);
    }
    let skin_share = skin.iter().sum::<f64>() / (skin.iter().sum::<f64>() + other.iter().sum::<f64>());
    if !(skin_share > 0.0 && skin_share < 1.0) {
        bail!("training needs pixels that are skin and pixels that are not; check the masks");
    }
    let (skin_plane, other_plane) = (over_brightness(&skin), over_brightness(&other));
    let (mut skin, mut other) = (smooth(&skin, SMOOTHING_STD_CELLS), smooth(&other, SMOOTHING_STD_CELLS));
    for cell in 0..CELLS {
        // Half of the share: a colour that was never seen is rather not skin.
        let base = BASE_EVIDENCE * 0.5 * skin_share;
        let prior = (skin_plane[cell] + base) / (skin_plane[cell] + other_plane[cell] + BASE_EVIDENCE);
        let prior = if centre_of(cell).iter().sum::<f64>() < DARK_SUM { 0.0 } else { prior };
        skin[cell] += CHROMATICITY_EVIDENCE * prior;
        other[cell] += CHROMATICITY_EVIDENCE * (1.0 - prior);
    }
    Ok(HistogramModel::from_masses(&skin, &other, min_probability))
}

/// Trains the model: probabilities from all units, the threshold by cross-validation.
///
/// # Errors
/// A training fold has only skin or only other pixels.
pub fn train(set: &TrainingSet, folds: usize, seed: u64) -> Result<(HistogramModel, Choice)> {
    let curve = cross_validate(set, folds, seed, usize::from(u8::MAX), |units| fit(units, 128))?;
    let choice = curve.choose();
    let units: Vec<&Unit> = set.units.iter().collect();
    Ok((fit(&units, 255 - choice.level.min(254) as u8)?, choice))
}

#[cfg(test)]
mod tests {
    use super::super::training_set::{Source, WeightedColour};
    use super::*;

    fn set() -> TrainingSet {
        let unit = |shift: u8| {
            let patch = |rgb: [u8; 3], is_skin, count| {
                (0..8).map(move |i| WeightedColour { rgb: rgb.map(|c| c + shift + i), is_skin, count })
            };
            let colours = patch([190, 130, 100], true, 10).chain(patch([90, 110, 150], false, 30));
            Unit { group: 0, colours: colours.collect(), pixels_per_count: 1.0 }
        };
        TrainingSet { source: Source::Images, groups: vec!["a".to_owned()], units: (0..12).map(unit).collect() }
    }

    #[test]
    fn what_was_skin_is_skin_also_in_weaker_light() {
        let (model, choice) = train(&set(), 4, 1).unwrap();
        let table = model.table();
        assert!(is_skin(&table, [195, 135, 105]) && is_skin(&table, [160, 110, 85]));
        assert!(!is_skin(&table, [95, 115, 155]) && !is_skin(&table, [0, 0, 0]) && !is_skin(&table, [20, 250, 20]));
        assert!(choice.scores.f1 > 0.99, "{choice:?}");
    }

    #[test]
    fn the_table_follows_the_probability() {
        let (mut model, _) = train(&set(), 4, 1).unwrap();
        let cell = cell_of([8, 16, 24]);
        model.probability[cell] = model.min_probability;
        assert!(is_skin(&model.table(), [8, 16, 24]));
        model.probability[cell] -= 1;
        assert!(!is_skin(&model.table(), [8, 16, 24]));
    }

    #[test]
    fn masses_survive_quantisation() {
        let (skin, other) = (vec![0.02; CELLS], vec![0.06; CELLS]);
        let model = HistogramModel::from_masses(&skin, &other, 100);
        let (s, o) = model.masses(7);
        assert!((s / (s + o) - 0.25).abs() < 0.003 && s + o > 0.08 / 1.5 && s + o < 0.08 * 1.5);
    }

    #[test]
    fn one_label_only_is_refused() {
        let mut one = set();
        one.units.iter_mut().for_each(|unit| unit.colours.retain(|colour| colour.is_skin));
        assert!(train(&one, 3, 1).unwrap_err().to_string().contains("not"));
    }
}
