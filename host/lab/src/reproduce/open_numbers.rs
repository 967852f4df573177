//! Sets of the numbers that the PIK paper leaves open, each found by `sinew-lab tune-pik` with 60
//! tries on the clips of `data_split.csv`. All but the shipped ones were found with the root of the
//! default numbers, and are run with that of `[paper.root]`.

use sinew::body::tracking::{BodyTuning, ByJoint, PaperTuning};

/// Steps of the gradient projection.
/// Chosen: with them the errors are those of Gauss-Newton steps (docs/reproduce.md).
const GRADIENT_STEPS: usize = 20;

/// Numbers of goals and of angles that are compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numbers {
    /// What distinguishes them.
    pub name: &'static str,
    /// Numbers of goals, then of angles.
    pub tunings: [BodyTuning; 2],
}

/// The shipped numbers first: one likelihood for both models.
#[must_use]
pub fn all() -> [Numbers; 5] {
    let shared = BodyTuning::default();
    let with = |paper: PaperTuning| BodyTuning { paper, ..shared };
    let goals = with(PaperTuning {
        lambda: 268.0,
        reach_std_m: 0.0166,
        goal_std_m: 0.0484,
        point_std_m: 0.0993,
        outlier_m: 0.0842,
        ..shared.paper
    });
    let angles =
        with(PaperTuning { kappa: ByJoint::uniform(97.1), point_std_m: 0.173, outlier_m: 0.0915, ..shared.paper });
    let kappa =
        ByJoint { trunk: 56.7, head: 362.0, shoulder: 130.0, elbow: 65.1, hip: 396.0, knee: 94.6, ankle: 561.0 };
    let by_joint = with(PaperTuning { kappa, point_std_m: 0.157, outlier_m: 0.107, ..shared.paper });
    let literal_goals = with(PaperTuning {
        lambda: 72.3,
        reach_std_m: 3.21,
        goal_std_m: 0.0916,
        point_std_m: 0.252,
        outlier_m: 0.119,
        own_velocity: true,
        ..shared.paper
    });
    let literal_angles = with(PaperTuning {
        kappa: ByJoint::uniform(79.5),
        point_std_m: 0.2,
        outlier_m: 0.109,
        own_velocity: true,
        ..shared.paper
    });
    [
        Numbers { name: "one likelihood for both (shipped)", tunings: [shared; 2] },
        Numbers {
            name: "the same, the solver by gradient projection",
            tunings: [
                with(PaperTuning { gradient_projection: true, solver_steps: GRADIENT_STEPS, ..shared.paper }),
                shared,
            ],
        },
        Numbers { name: "each with its own likelihood", tunings: [goals, angles] },
        Numbers { name: "each with its own, a kappa for each joint", tunings: [goals, by_joint] },
        Numbers {
            name: "(31), (33) of the particle's own past, own likelihoods",
            tunings: [literal_goals, literal_angles],
        },
    ]
}
