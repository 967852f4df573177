//! Numbers of the motion models, tuned on motions that no result is reported on
//! (docs/body_tracker.md).

use super::by_joint::ByJoint;
use super::end_effectors::END_EFFECTORS;
use super::model_kind::BodyModelKind;
use super::paper_tuning::{PAPER, PaperRoot, PaperTuning};
use serde::{Deserialize, Serialize};
use sinew_core::error::ParameterError;
use sinew_core::observation::range_smoothing::RangeSmoothing;
use sinew_core::pik::goal::LinearExtrapolation;
use sinew_core::pik::root::{NO_PLANES, RootProcess};
use sinew_core::tracker::body::modes::{DEFAULT_MODE_OPTIONS, ModeOptions};
use sinew_core::tracker::body::{BodyOptions, RivalOptions, RootAlignment, SpeedScaledNoise};

/// Steps of the alignment of the root.
const ALIGNMENT_STEPS: usize = 3;

/// The root's process, the same in all models but the pelvic lift.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RootTuning {
    /// Share of the velocity that goes on.
    pub persistence: f32,
    /// Metres by root second.
    pub shift_std_m: f32,
    /// Radians by root second.
    pub turn_std_rad: f32,
    /// Whether the mean pose is fitted to the points first, so that all particles begin there.
    pub aligned: bool,
    /// How far the aligned root may get, metres by root second.
    pub aligned_shift_std_m: f32,
    /// How far the aligned root may turn, radians by root second.
    pub aligned_turn_std_rad: f32,
    /// How far other angles may change while the root is aligned, radians by root second.
    pub aligned_angle_std_rad: f32,
    /// Whether a coarse-to-fine search looks for a limb that is farther off than the likelihood
    /// reaches.
    pub aligned_from_afar: bool,
    /// Whether the trunk is fitted to the points with the root.
    pub aligned_trunk: bool,
    /// Process noise of the trunk about the fitted place, radians by root second; in the place of
    /// its `joint_std`.
    pub trunk_std_rad: f32,
}

impl RootTuning {
    /// The root with these numbers, without the fits of trunk and far limbs.
    fn with(&self, paper: &PaperRoot) -> Self {
        Self {
            persistence: paper.persistence,
            shift_std_m: paper.shift_std_m,
            turn_std_rad: paper.turn_std_rad,
            aligned_shift_std_m: paper.aligned_shift_std_m,
            aligned_turn_std_rad: paper.aligned_turn_std_rad,
            aligned_angle_std_rad: paper.aligned_angle_std_rad,
            aligned_trunk: false,
            aligned_from_afar: false,
            ..*self
        }
    }

    /// How the root is fitted to the points, and the trunk with it if asked for.
    #[must_use]
    pub fn alignment(&self) -> Option<RootAlignment> {
        self.aligned.then_some(RootAlignment {
            steps: ALIGNMENT_STEPS,
            coarse_to_fine: self.aligned_from_afar,
            shift_std_m_per_sqrt_s: self.aligned_shift_std_m,
            turn_std_rad_per_sqrt_s: self.aligned_turn_std_rad,
            angle_std_rad_per_sqrt_s: self.aligned_angle_std_rad,
            pulling_blocks: usize::MAX,
            fit_trunk: self.aligned_trunk,
        })
    }

    /// The process of a guided root: it is moved by the points like every angle, from as far as an
    /// aligned one.
    #[must_use]
    pub fn guided_process(&self) -> RootProcess {
        let (s, t) = (self.aligned_shift_std_m, self.aligned_turn_std_rad);
        RootProcess { std_per_sqrt_s: [s, s, s, t, t, t], ..self.process() }
    }

    /// The process.
    #[must_use]
    pub fn process(&self) -> RootProcess {
        let (s, t) = (self.shift_std_m, self.turn_std_rad);
        RootProcess { persistence: self.persistence, std_per_sqrt_s: [s, s, s, t, t, t], shift_limits_m: NO_PLANES }
    }
}

/// Standard deviations of goals after one second, by the end-effector; metres by root second.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoalStd {
    /// The head.
    pub head: f32,
    /// Hands.
    pub hand: f32,
    /// Feet.
    pub foot: f32,
}

impl GoalStd {
    /// One value an end-effector: head, hands, feet.
    #[must_use]
    pub fn per_end_effector(&self) -> [f32; END_EFFECTORS.len()] {
        [self.head, self.hand, self.hand, self.foot, self.foot]
    }
}

/// Numbers of the models with goals.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoalTuning {
    /// Share of an end-effector's velocity that goes on.
    pub persistence: f32,
    /// Share of the velocities' last change that goes on.
    pub acceleration_share: f32,
    /// How closely a goal is reached, metres, by a limb that has all of its noise; as much more
    /// closely by one at rest.
    pub reach_std_m: f32,
    /// Spread of the goals.
    pub goal_std: GoalStd,
    /// Stiffness of the pose: standard deviations of the angles' changes after one second, radians.
    pub joint_std: ByJoint,
    /// Share of the angles' velocities that goes on in what the stiffness holds on to.
    pub angle_persistence: f32,
    /// Maximum number of steps of the solver.
    pub solver_steps: usize,
}

impl GoalTuning {
    /// How one end-effector's goal moves, but for its spread.
    #[must_use]
    pub fn extrapolation(&self) -> LinearExtrapolation {
        LinearExtrapolation { persistence: self.persistence, std_m_per_sqrt_s: 0.0 }
    }
}

/// How poses are drawn about their mode in the models with goals, but for the guided one.
/// That one always draws all of its expansion and corrects the weight.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DrawTuning {
    /// Whether the weights take the importance ratio.
    pub corrects_weight: bool,
    /// Width of the draw relative to the Laplace expansion's, in (0, 1]; read where weights are not
    /// corrected.
    pub share: f32,
}

/// Numbers of the angular model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AngularTuning {
    /// Share of an angle's velocity that goes on.
    pub persistence: f32,
    /// Share of the velocities' last change that goes on.
    pub acceleration_share: f32,
    /// Standard deviations of the angles' noise after one second, radians.
    pub joint_std: ByJoint,
}

/// The points' likelihood.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointTuning {
    /// sigma of PIK (25), metres.
    pub std_m: f32,
    /// Root of tau of PIK (29), metres.
    pub outlier_m: f32,
    /// Smallest share of effective particles of a hundred; of others their least number grows with
    /// the root of theirs. Zero never flattens the weights.
    pub least_effective_share: f32,
    /// Whether each limb is weighed by what it explains itself and resampled apart from the others.
    pub limb_by_limb: bool,
}

/// How points' distances from the camera are averaged over their neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SmoothingTuning {
    /// How far neighbours may be to each side, metres; zero takes every point as it is.
    pub radius_m: f32,
    /// Where distances scatter by this much, metres, points go half of the way to their mean.
    pub skin_std_m: f32,
    /// Standard deviation of a point along its line of sight beyond that across, as a share of the
    /// measured scatter of neighbours' distances; zero takes both as the same. Guided and modes.
    pub along_share: f32,
}

/// Numbers of the tracker by modes; its density is the guided model's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModesTuning {
    /// Maximum number of steps of the solver.
    pub solver_steps: usize,
    /// Share of a frame's log evidence that counts.
    pub evidence_share: f32,
    /// Log evidence that a rival has to gain before it leads.
    pub switch_cost: f32,
    /// How far the pelvis of some rivals is turned, radians.
    pub turn_rad: f32,
    /// How often in a frame each limb is begun anew from a drawn pose.
    pub draws: usize,
}

/// When a guided body whose legs are exchanged takes the place of the estimate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RivalTuning {
    /// Share of a frame's log evidence that counts.
    pub evidence_share: f32,
    /// Log evidence that it has to gain before it leads.
    pub switch_cost: f32,
}

impl RivalTuning {
    const fn options(self) -> RivalOptions {
        RivalOptions { evidence_share: self.evidence_share, switch_cost: self.switch_cost }
    }
}

/// The deadband of the reported pose at rest, in all models but the printed ones. With both zero
/// each frame's mean is reported.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeadbandTuning {
    /// In standard errors of the particles' mean.
    pub jitter_std_errors: f32,
    /// Beyond that, metres.
    pub jitter_std_m: f32,
}

/// Everything that a body tracker's results depend on, but the number of particles and the seed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyTuning {
    /// The root of all models.
    pub root: RootTuning,
    /// End-effector, stick and pelvic lift.
    pub end_effector: GoalTuning,
    /// How those three draw.
    pub draw: DrawTuning,
    /// Guided.
    pub guided: GoalTuning,
    /// Modes.
    pub modes: ModesTuning,
    /// Blocks of points that pull in the guided model.
    pub pulling_blocks: usize,
    /// Steps from the guided particles' mean to the mode that is reported; 0 reports the mean.
    pub refining_steps: usize,
    /// The guided model's rival with exchanged legs.
    pub rival: RivalTuning,
    /// Angular.
    pub angular: AngularTuning,
    /// Points of all models but the printed ones, before they are weighed.
    pub smoothing: SmoothingTuning,
    /// How the noise of a limb follows its speed, in all models but the printed ones. A
    /// `rest_share`, a `max_scale_seen` and a `max_scale_unseen` of one leave every limb the
    /// model's own.
    pub pace: SpeedScaledNoise,
    /// The deadband of the reported pose.
    pub deadband: DeadbandTuning,
    /// Points of the models that draw from the motion alone.
    pub points: PointTuning,
    /// Points of the guided model.
    pub guided_points: PointTuning,
    /// How far limbs may give way where they meet, metres: less flesh in flesh is likelier; zero
    /// lets them pass through one another.
    pub self_penetration_std_m: f32,
    /// Walk of a hand along the stick, shares by root second.
    pub stick_gamma_std: f32,
    /// How closely a hand is on the stick, metres.
    pub stick_reach_std_m: f32,
    /// Pelvic lift: the root's sideways standard deviation, metres by root second; four times as
    /// much up and down.
    pub lift_std_m: f32,
    /// Pelvic lift: how closely hands, feet and head stay where they are, metres.
    pub lift_reach_std_m: f32,
    /// Pelvic lift: the pelvis' turning, radians by root second.
    pub lift_turn_std_rad: f32,
    /// End-effector and angular with the paper's structure.
    pub paper: PaperTuning,
}

impl BodyTuning {
    /// The default numbers of a model. One with the PIK paper's structure takes the points as they
    /// are and weighs whole poses, without tempering. Its poses may penetrate themselves, its trunk
    /// is drawn, its noise does not depend on the pace, and each frame's mean is reported.
    #[must_use]
    pub fn of_kind(mut self, kind: BodyModelKind) -> Self {
        if kind.is_printed() {
            self.smoothing.radius_m = 0.0;
            (self.pace.rest_share, self.pace.max_scale_seen, self.pace.max_scale_unseen) = (1.0, 1.0, 1.0);
            (self.end_effector.acceleration_share, self.angular.acceleration_share) = (0.0, 0.0);
            self.deadband = DeadbandTuning { jitter_std_errors: 0.0, jitter_std_m: 0.0 };
            self.self_penetration_std_m = 0.0;
            self.root = self.root.with(&self.paper.root);
            let (std_m, outlier_m) = (self.paper.point_std_m, self.paper.outlier_m);
            self.points = PointTuning { std_m, outlier_m, least_effective_share: 0.0, limb_by_limb: false };
        }
        self
    }

    /// How the model `kind` weighs its points, and how its goals move.
    pub(super) const fn points_and_goals(&self, kind: BodyModelKind) -> (PointTuning, GoalTuning) {
        match kind {
            BodyModelKind::Guided | BodyModelKind::Modes => (self.guided_points, self.guided),
            _ => (self.points, self.end_effector),
        }
    }

    /// The core's options of the tracker of `kind`, of which these are the numbers
    /// ([`Self::of_kind`]).
    #[must_use]
    pub fn options(&self, kind: BodyModelKind) -> BodyOptions {
        let (points, goals) = self.points_and_goals(kind);
        let acceleration_share = match kind {
            BodyModelKind::Angular | BodyModelKind::AngularPaper => self.angular.acceleration_share,
            _ => goals.acceleration_share,
        };
        let is_aligned = !matches!(kind, BodyModelKind::Guided | BodyModelKind::Modes | BodyModelKind::PelvicLift);
        BodyOptions {
            least_effective_share: points.least_effective_share,
            limb_by_limb: points.limb_by_limb,
            alignment: self.root.alignment().filter(|_| is_aligned),
            jitter_std_errors: self.deadband.jitter_std_errors,
            jitter_std_m: self.deadband.jitter_std_m,
            rival: matches!(kind, BodyModelKind::Guided).then_some(self.rival.options()),
            pace: Some(self.pace),
            acceleration_share,
        }
    }

    /// The core's options of the tracker that follows at most `max_modes` modes.
    #[must_use]
    pub fn mode_options(&self, max_modes: usize) -> ModeOptions {
        let ModesTuning { evidence_share, switch_cost, turn_rad, draws, .. } = self.modes;
        let (jitter_std_m, pace) = (self.deadband.jitter_std_m, Some(self.pace));
        ModeOptions { max_modes, evidence_share, switch_cost, turn_rad, draws, jitter_std_m, pace }
    }

    /// How points are smoothed; `None` where they are taken as they are.
    ///
    /// # Errors
    /// Names the number that broke a rule.
    pub fn range_smoothing(&self) -> Result<Option<RangeSmoothing>, ParameterError> {
        let SmoothingTuning { radius_m, skin_std_m, along_share } = self.smoothing;
        let smoothing = || RangeSmoothing::new(radius_m, skin_std_m)?.keeping(along_share);
        (radius_m > 0.0).then(smoothing).transpose()
    }
}

/// Found by a random search for the least error (34) with 100 particles on 18 clips that no result
/// is reported on (docs/body_tracker.md). So was [`ANGULAR_JOINTS`].
const GOAL_JOINTS: ByJoint =
    ByJoint { trunk: 0.268, head: 0.6, shoulder: 1.02, elbow: 1.31, hip: 0.65, knee: 1.2, ankle: 0.062 };
/// The angular model's noise.
const ANGULAR_JOINTS: ByJoint =
    ByJoint { trunk: 0.255, head: 0.28, shoulder: 0.64, elbow: 0.89, hip: 0.3, knee: 0.66, ankle: 0.13 };
/// The guided model draws where the points pull, so that its stiffness may be looser.
const GUIDED_JOINTS: ByJoint =
    ByJoint { trunk: 0.2, head: 0.6, shoulder: 2.0, elbow: 2.0, hip: 2.0, knee: 1.5, ankle: 1.0 };

/// The models with goals.
const GOALS: GoalTuning = GoalTuning {
    persistence: 0.90,
    acceleration_share: 0.5,
    reach_std_m: 0.10,
    goal_std: GoalStd { head: 0.105, hand: 0.21, foot: 0.18 },
    joint_std: GOAL_JOINTS,
    angle_persistence: 0.4,
    solver_steps: 2,
};
/// The guided model.
const GUIDED_GOALS: GoalTuning = GoalTuning {
    persistence: 0.5,
    acceleration_share: 0.0,
    reach_std_m: 0.03,
    goal_std: GoalStd { head: 0.3, hand: 0.3, foot: 0.3 },
    joint_std: GUIDED_JOINTS,
    angle_persistence: 0.5,
    solver_steps: 3,
};

/// The tracker by modes, chosen on the runners that docs/body_modes.md names.
const MODES: ModesTuning = ModesTuning {
    solver_steps: 4,
    evidence_share: DEFAULT_MODE_OPTIONS.evidence_share,
    switch_cost: DEFAULT_MODE_OPTIONS.switch_cost,
    turn_rad: DEFAULT_MODE_OPTIONS.turn_rad,
    draws: DEFAULT_MODE_OPTIONS.draws,
};

/// Chosen on the tuning runners that docs/body_modes.md names. With a cost of 10, one of 180 runs
/// exchanges legs that are right; with 40 those that are begun exchanged are right again in 88
/// instead of 95 %.
const RIVAL: RivalTuning = RivalTuning { evidence_share: 0.2, switch_cost: 20.0 };

impl Default for BodyTuning {
    fn default() -> Self {
        let points = PointTuning { std_m: 0.07, outlier_m: 0.10, least_effective_share: 0.06, limb_by_limb: true };
        Self {
            root: RootTuning {
                persistence: 0.85,
                shift_std_m: 0.003,
                turn_std_rad: 0.01,
                aligned: true,
                aligned_shift_std_m: 0.3,
                aligned_turn_std_rad: 0.7,
                aligned_angle_std_rad: 0.5,
                aligned_from_afar: true,
                aligned_trunk: true,
                trunk_std_rad: 0.04,
            },
            end_effector: GOALS,
            draw: DrawTuning { corrects_weight: false, share: 0.62 },
            guided: GUIDED_GOALS,
            modes: MODES,
            pulling_blocks: 32,
            refining_steps: 3,
            rival: RIVAL,
            angular: AngularTuning { persistence: 0.55, acceleration_share: 0.35, joint_std: ANGULAR_JOINTS },
            pace: SpeedScaledNoise {
                rest_share: 0.4,
                full_speed_m_per_s: 1.6,
                max_scale_seen: 5.0,
                fade_s: 0.3,
                unseen_growth_s: 0.5,
                max_scale_unseen: 2.5,
            },
            deadband: DeadbandTuning { jitter_std_errors: 3.0, jitter_std_m: 0.0075 },
            smoothing: SmoothingTuning { radius_m: 0.04, skin_std_m: 0.015, along_share: 0.25 },
            points,
            guided_points: PointTuning {
                least_effective_share: 0.3,
                limb_by_limb: false,
                std_m: 0.05,
                outlier_m: 0.08,
            },
            self_penetration_std_m: 0.015,
            stick_gamma_std: 0.1,
            stick_reach_std_m: 0.01,
            lift_std_m: 0.08,
            // Chosen: hands and feet spread little beside pelvis and knees, as the caption of PIK
            // figure 19 has it; from 0.01 to 0.02 the error is the same.
            lift_reach_std_m: 0.02,
            lift_turn_std_rad: 0.3,
            paper: PAPER,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_structure_has_no_filter_of_its_own() {
        for kind in [BodyModelKind::EndEffectorPaper, BodyModelKind::AngularPaper] {
            let tuning = BodyTuning::default().of_kind(kind);
            let options = tuning.options(kind);
            assert_eq!(options.least_effective_share, 0.0, "weights are not tempered");
            assert!(!options.limb_by_limb && options.jitter_std_errors == 0.0 && options.jitter_std_m == 0.0);
            assert_eq!(options.acceleration_share, 0.0);
            let pace = options.pace.unwrap();
            assert_eq!((pace.rest_share, pace.max_scale_seen, pace.max_scale_unseen), (1.0, 1.0, 1.0));
            let alignment = options.alignment.unwrap();
            assert!(!alignment.fit_trunk && !alignment.coarse_to_fine);
            assert!(tuning.range_smoothing().unwrap().is_none() && tuning.self_penetration_std_m == 0.0);
            assert_eq!(
                (tuning.points.std_m, tuning.points.outlier_m),
                (tuning.paper.point_std_m, tuning.paper.outlier_m)
            );
        }
        let other = BodyTuning::default().of_kind(BodyModelKind::EndEffector);
        assert_eq!(other, BodyTuning::default());
    }
}
