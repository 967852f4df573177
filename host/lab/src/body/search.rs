//! The numbers that the PIK paper leaves open, searched in the same way for goals and for angles.

use super::trial::{SeenMotion, trial};
use anyhow::Result;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sinew::body::tracking::{BodyModelKind, BodyTuning, ByJoint, PaperTuning};
use sinew_core::random::Stream;

/// Size of a step of the search, in natural logarithms.
/// Chosen: a factor of 1.6, which crosses the usual range of each number in ten steps.
const STEP: f32 = 0.5;

/// Which numbers a search may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Searched {
    /// lambda, W, sigma of PIK (33), sigma of PIK (25), tau.
    Goals,
    /// One kappa for all angles, sigma of PIK (25), tau.
    Angles,
    /// As [`Self::Angles`], with a kappa for each joint.
    AnglesByJoint,
    /// Goals and angles with the same sigma of PIK (25), tau and root.
    Both,
    /// The root alone, of goals and angles.
    Root,
}

impl Searched {
    /// The models that are scored.
    #[must_use]
    pub const fn models(self) -> &'static [BodyModelKind] {
        match self {
            Self::Goals => &[BodyModelKind::EndEffectorPaper],
            Self::Angles | Self::AnglesByJoint => &[BodyModelKind::AngularPaper],
            Self::Both | Self::Root => &[BodyModelKind::EndEffectorPaper, BodyModelKind::AngularPaper],
        }
    }

    /// `paper` with each number that may change times a factor of its own.
    fn neighbour(self, paper: &PaperTuning, stream: &mut Stream) -> PaperTuning {
        let mut next = *paper;
        let mut change = |number: &mut f32| *number *= (STEP * stream.normal()).exp();
        if self != Self::Root {
            change(&mut next.point_std_m);
            change(&mut next.outlier_m);
        }
        if matches!(self, Self::Goals | Self::Both) {
            [&mut next.lambda, &mut next.reach_std_m, &mut next.goal_std_m].into_iter().for_each(&mut change);
        }
        if matches!(self, Self::Angles | Self::Both) {
            let mut kappa = next.kappa.trunk;
            change(&mut kappa);
            next.kappa = ByJoint::uniform(kappa);
        }
        if self == Self::AnglesByJoint {
            let ByJoint { trunk, head, shoulder, elbow, hip, knee, ankle } = &mut next.kappa;
            [trunk, head, shoulder, elbow, hip, knee, ankle].into_iter().for_each(&mut change);
        }
        if matches!(self, Self::Both | Self::Root) {
            let root = &mut next.root;
            let fit = [&mut root.aligned_shift_std_m, &mut root.aligned_turn_std_rad, &mut root.aligned_angle_std_rad];
            fit.into_iter().for_each(&mut change);
            [&mut root.persistence, &mut root.shift_std_m, &mut root.turn_std_rad].into_iter().for_each(change);
            root.persistence = root.persistence.min(1.0);
        }
        next
    }
}

/// Mean natural logarithm of PIK (34) over motions, each with its seed, and models, metres.
///
/// # Errors
/// Names a number of the tracker that broke a rule.
pub fn mean_log_error(
    motions: &[(u64, SeenMotion)],
    models: &[BodyModelKind],
    paper: &PaperTuning,
    particles: usize,
) -> Result<f64> {
    let tuning = BodyTuning { paper: *paper, ..BodyTuning::default() };
    let jobs: Vec<(&(u64, SeenMotion), BodyModelKind)> =
        motions.iter().flat_map(|motion| models.iter().map(move |&model| (motion, model))).collect();
    let logs: Vec<f64> = jobs
        .par_iter()
        .map(|((seed, motion), model)| Ok(trial(motion, *model, &tuning, particles, *seed)?.0.error_m.ln()))
        .collect::<Result<_>>()?;
    Ok(logs.iter().sum::<f64>() / logs.len() as f64)
}

/// What a search found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// Which numbers were searched.
    pub searched: Searched,
    /// The best.
    pub paper: PaperTuning,
    /// Geometric mean of PIK (34) with them, metres.
    pub error_m: f64,
    /// Sets of numbers that were tried.
    pub tries: usize,
}

/// A random walk on the logarithms that keeps a step where the error falls; `tries` steps from
/// `start`.
///
/// # Errors
/// As [`mean_log_error`].
pub fn search(
    searched: Searched,
    start: &PaperTuning,
    (motions, particles): (&[(u64, SeenMotion)], usize),
    tries: usize,
    tried: impl Fn(usize, f64),
) -> Result<Found> {
    let mut best = *start;
    let mut least = mean_log_error(motions, searched.models(), &best, particles)?;
    for index in 0..tries {
        let next = searched.neighbour(&best, &mut Stream::new(1, index as u64, searched as u32));
        let error = mean_log_error(motions, searched.models(), &next, particles)?;
        if error < least {
            (best, least) = (next, error);
        }
        tried(index, least.exp());
    }
    Ok(Found { searched, paper: best, error_m: least.exp(), tries })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_changes_its_own_numbers_only_and_is_the_same_again() {
        let paper = BodyTuning::default().paper;
        let next = |searched: Searched| searched.neighbour(&paper, &mut Stream::new(1, 7, 0));
        let (goals, angles, by_joint) = (next(Searched::Goals), next(Searched::Angles), next(Searched::AnglesByJoint));
        assert_eq!(goals.kappa, paper.kappa);
        assert!(goals.lambda != paper.lambda && goals.point_std_m != paper.point_std_m);
        assert_eq!(
            (angles.lambda, angles.reach_std_m, angles.goal_std_m),
            (paper.lambda, paper.reach_std_m, paper.goal_std_m)
        );
        assert_eq!(angles.kappa.trunk, angles.kappa.elbow);
        assert!(by_joint.kappa.trunk != by_joint.kappa.elbow);
        assert_eq!(next(Searched::Both), next(Searched::Both));
        for searched in [Searched::Goals, Searched::Angles, Searched::Both] {
            assert_eq!(next(searched).own_velocity, paper.own_velocity);
        }
    }
}
