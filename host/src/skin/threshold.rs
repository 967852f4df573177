//! The choice of a threshold by cross-validation.

use super::confusion::{Confusion, Scores};
use super::folds;
use super::training_set::{Source, TrainingSet, Unit};

/// Thresholds whose F1 is at least this part of the best one are taken as equally good: for a list
/// of many pixels.
pub const LIST_PLATEAU: f64 = 0.99;
/// The same for images, of which there are few: with other folds the best threshold's F1 moves by
/// about this much.
pub const IMAGES_PLATEAU: f64 = 0.98;

/// A trained colour model whose threshold is still open.
///
/// A colour of level n is skin for the threshold levels n and above; levels rise from the tightest
/// threshold.
pub trait ColourLevels {
    /// The tightest threshold level that accepts `rgb`; a number beyond the last level where none
    /// does.
    fn level(&self, rgb: [u8; 3]) -> usize;
}

/// Held-out decisions for each threshold level.
#[derive(Debug, Clone)]
pub struct Curve {
    source: Source,
    /// For each group that has units: the decisions at each level.
    groups: Vec<Vec<Confusion>>,
}

/// A threshold level and its scores.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// The threshold level.
    pub level: usize,
    /// Pooled scores of all held-out units.
    pub scores: Scores,
}

/// Trains on all folds but one, judges that one, and adds up over all folds: no unit is judged by a
/// model trained on it.
pub fn cross_validate<M: ColourLevels>(
    set: &TrainingSet,
    fold_count: usize,
    seed: u64,
    level_count: usize,
    train: impl Fn(&[&Unit]) -> crate::error::Result<M>,
) -> crate::error::Result<Curve> {
    let fold_of = folds::assign(set.units.len(), fold_count, seed);
    let mut groups = vec![vec![Confusion::default(); level_count]; set.groups.len()];
    for fold in 0..fold_count {
        let (held_out, kept): (Vec<_>, Vec<_>) =
            set.units.iter().zip(&fold_of).partition(|&(_, &unit_fold)| unit_fold == fold);
        let kept: Vec<&Unit> = kept.into_iter().map(|(unit, _)| unit).collect();
        let model = train(&kept)?;
        for (unit, _) in held_out {
            judge(&model, unit, &mut groups[unit.group]);
        }
    }
    groups.retain(|levels| levels.last().is_some_and(|all| all.true_positive + all.false_negative > 0.0));
    Ok(Curve { source: set.source, groups })
}

fn judge(model: &impl ColourLevels, unit: &Unit, levels: &mut [Confusion]) {
    let mut at_level = vec![[0.0; 2]; levels.len() + 1];
    let mut totals = [0.0; 2];
    for colour in &unit.colours {
        let count = f64::from(colour.count) * unit.pixels_per_count;
        let label = usize::from(colour.is_skin);
        at_level[model.level(colour.rgb).min(levels.len())][label] += count;
        totals[label] += count;
    }
    let mut accepted = [0.0; 2];
    for (confusion, counts) in levels.iter_mut().zip(at_level) {
        accepted = [accepted[0] + counts[0], accepted[1] + counts[1]];
        confusion.merge(&Confusion {
            true_positive: accepted[1],
            false_positive: accepted[0],
            false_negative: totals[1] - accepted[1],
        });
    }
}

impl Curve {
    /// Mean over the groups of the pooled F1 at `level`: each source counts the same, however many
    /// pixels it has.
    fn mean_f1(&self, level: usize) -> f64 {
        let sum: f64 = self.groups.iter().map(|levels| levels[level].scores().f1).sum();
        sum / self.groups.len().max(1) as f64
    }

    /// Chooses a level on the plateau around the best one, where F1 is nearly the best.
    ///
    /// Whole images show all that a camera sees, so the plateau's middle is taken: the peak itself
    /// is noise. A pixel list says little of the background that skin is separated from, so its F1
    /// flatters loose thresholds. There the plateau's tightest level is taken.
    #[must_use]
    pub fn choose(&self) -> Choice {
        let level_count = self.groups.first().map_or(0, Vec::len);
        let f1: Vec<f64> = (0..level_count).map(|level| self.mean_f1(level)).collect();
        let best = (0..level_count).max_by(|&a, &b| f1[a].total_cmp(&f1[b]).then(b.cmp(&a))).unwrap_or(0);
        let plateau = match self.source {
            Source::PixelList => LIST_PLATEAU,
            Source::Images => IMAGES_PLATEAU,
        };
        let good = |level: &usize| f1[*level] >= plateau * f1[best];
        let tightest = (0..best).rev().take_while(good).last().unwrap_or(best);
        let loosest = (best..level_count).take_while(good).last().unwrap_or(best);
        let level = match self.source {
            Source::PixelList => tightest,
            Source::Images => tightest.midpoint(loosest),
        };
        let mut pooled = Confusion::default();
        for levels in &self.groups {
            pooled.merge(&levels[level]);
        }
        Choice { level, scores: pooled.scores() }
    }
}

#[cfg(test)]
mod tests {
    use super::super::training_set::WeightedColour;
    use super::*;

    /// Level = red; trained on nothing.
    struct Red;

    impl ColourLevels for Red {
        fn level(&self, rgb: [u8; 3]) -> usize {
            usize::from(rgb[0])
        }
    }

    fn set(source: Source) -> TrainingSet {
        let colour = |red, is_skin| WeightedColour { rgb: [red, 0, 0], is_skin, count: 1 };
        let skin = (10..20).map(|red| colour(red, true));
        let other = (40..60).map(|red| colour(red, false));
        let units = skin.chain(other).map(|c| Unit { group: 0, colours: vec![c], pixels_per_count: 2.0 }).collect();
        TrainingSet { source, groups: vec!["a".to_owned(), "empty".to_owned()], units }
    }

    #[test]
    fn the_rule_depends_on_the_source() {
        let choose = |source| cross_validate(&set(source), 5, 1, 100, |_| Ok(Red)).unwrap().choose();
        let list = choose(Source::PixelList);
        assert_eq!((list.level, list.scores.f1), (19, 1.0));
        assert_eq!(choose(Source::Images).level, 29);
    }

    #[test]
    fn no_unit_is_judged_by_a_model_that_saw_it() {
        struct Seen(Vec<[u8; 3]>);
        impl ColourLevels for Seen {
            fn level(&self, rgb: [u8; 3]) -> usize {
                usize::from(!self.0.contains(&rgb))
            }
        }
        let train = |units: &[&Unit]| Ok(Seen(units.iter().flat_map(|u| &u.colours).map(|c| c.rgb).collect()));
        let curve = cross_validate(&set(Source::Images), 4, 1, 1, train).unwrap();
        assert_eq!(curve.groups[0][0].true_positive, 0.0);
    }
}
