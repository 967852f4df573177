//! The density of a pose given goals of its end-effectors, PIK (12), and the solver's trait of any
//! density.

use super::body_information::BodyInformation;
use super::forward::{Posture, posture};
use super::jacobian::moving_column;
use crate::math::{Mat3, Vec3, length, max, times};
use crate::skeleton::Skeleton;

/// Whether whole rows of the Hessian are computed: faster with vectors than the half that is read.
const WHOLE_ROWS: bool = !cfg!(target_arch = "arm");

/// Goal of an end-effector.
///
/// ```
/// use sinew_core::kinematics::inverse::{Goal, PoseDensity, Solve};
/// use sinew_core::math::{Mat3, Vec3};
/// use sinew_core::skeleton::arm::FOREARM;
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// // One camera measures a hand across its axis to a centimetre, and not along it.
/// let across = Mat3::from_diagonal(&Vec3::new(10_000.0, 10_000.0, 0.0));
/// let goals =
///     [Goal { bone: FOREARM, position_m: Vec3::new(0.3, 0.3, 7.0), precision: across }];
/// let skeleton = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// # let (root_m, previous_rad) = (Vec3::zeros(), [0.6, 0.1, 0.1, 0.9]);
/// let density = PoseDensity {
///     skeleton: &skeleton,
///     root_m,
///     goals: &goals,
///     previous_rad,
///     stiffness: [1.0; 4],
///     held: 0,
/// };
/// # use sinew_core::kinematics::inverse::PoseObjective;
/// let hand_m = density.posture(&density.mode(20).angles_rad).ends[FOREARM];
/// assert!(
///     (hand_m.xy() - goals[0].position_m.xy()).norm() < 0.01,
///     "seven metres away do not matter: {hand_m}"
/// );
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// The bone whose end has the goal.
    pub bone: usize,
    /// The place, metres.
    pub position_m: Vec3,
    /// W of PIK (12): inverse covariance of the goal, 1 / m^2.
    pub precision: Mat3,
}

/// log p(theta | g, previous theta) of PIK (12), up to its constant.
///
/// ```
/// use sinew_core::kinematics::inverse::{Goal, PoseDensity, PoseObjective, Solve};
/// # use sinew_core::math::{Mat3, Vec3};
/// # use sinew_core::skeleton::arm::FOREARM;
/// # use sinew_core::skeleton::{ArmGeometry, Side};
/// # let skeleton = ArmGeometry::new(Side::Right, 0.30, 0.35)?.skeleton()?;
/// # let position_m = Vec3::new(-0.3, 0.3, -0.2);
/// # let goals = [Goal { bone: FOREARM, position_m, precision: Mat3::identity() * 2500.0 }];
/// # let (root_m, previous_rad) = (Vec3::zeros(), [0.6, 0.1, 0.1, 0.9]);
/// # let (skeleton, goals, stiffness) = (&skeleton, &goals, [50.0; 4]);
/// # let density = PoseDensity { skeleton, root_m, goals, previous_rad, stiffness, held: 0 };
///
/// // A goal pulls at the hand, stiffness holds every angle where it was: the mode lies between.
/// let log_density =
///     |pose: &[f32; 4]| density.log_density(pose, &density.posture(pose));
/// let mode = density.mode(20);
/// assert!(log_density(&mode.angles_rad) > log_density(&previous_rad) + 1.0);
/// // Held angles stay, for any goal.
/// let held = PoseDensity { held: 3, ..density }.mode(20);
/// assert_eq!(held.angles_rad[..3], previous_rad[..3]);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct PoseDensity<'a, const BONES: usize, const ANGLES: usize> {
    /// The body.
    pub skeleton: &'a Skeleton<BONES, ANGLES>,
    /// Where its root is, metres.
    pub root_m: Vec3,
    /// Goals of the end-effectors.
    pub goals: &'a [Goal],
    /// Angles of the previous frame.
    pub previous_rad: [f32; ANGLES],
    /// lambda of PIK (12), one an angle: inverse variance of its change, 1 / rad^2.
    pub stiffness: [f32; ANGLES],
    /// How many of the first coordinates are given, those of a root that was drawn before: they
    /// stay at `previous_rad`.
    pub held: usize,
}

/// A log density of poses made of squares, which the solver maximises.
///
/// ```
/// use sinew_core::kinematics::forward::Posture;
/// use sinew_core::kinematics::inverse::{PoseObjective, Solve};
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::{ArmGeometry, Side, Skeleton};
///
/// /// A density of your own: poses near one that is comfortable.
/// struct Comfort {
///     skeleton: Skeleton<2, 4>,
///     rest_rad: [f32; 4],
/// }
///
/// impl PoseObjective<2, 4> for Comfort {
///     fn skeleton(&self) -> &Skeleton<2, 4> {
///         &self.skeleton
///     }
///     fn root_m(&self) -> Vec3 {
///         Vec3::zeros()
///     }
///     fn start_rad(&self) -> [f32; 4] {
///         [1.0; 4]
///     }
///     fn held(&self) -> usize {
///         0
///     }
///     fn log_density(&self, angles_rad: &[f32; 4], _posture: &Posture<2, 4>) -> f32 {
///         (0..4)
///             .map(|i| {
///                 -0.5 * (angles_rad[i] - self.rest_rad[i])
///                     * (angles_rad[i] - self.rest_rad[i])
///             })
///             .sum()
///     }
///     fn derivatives(
///         &self,
///         angles_rad: &[f32; 4],
///         _posture: &Posture<2, 4>,
///     ) -> ([f32; 4], [[f32; 4]; 4]) {
///         let gradient = core::array::from_fn(|i| self.rest_rad[i] - angles_rad[i]);
///         (
///             gradient,
///             core::array::from_fn(|i| core::array::from_fn(|j| f32::from(u8::from(i == j)))),
///         )
///     }
///     fn residual_m(&self, _posture: &Posture<2, 4>) -> f32 {
///         0.0
///     }
/// }
///
/// // The solver climbs it inside the limits: no elbow bends backwards, however comfortable.
/// let skeleton = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// let mode = Comfort { skeleton, rest_rad: [0.3, 0.1, 0.0, -0.5] }.mode(10);
/// assert!((mode.angles_rad[0] - 0.3).abs() < 1e-3 && mode.angles_rad[3] == 0.0, "{mode:?}");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
pub trait PoseObjective<const BONES: usize, const ANGLES: usize> {
    /// The body.
    fn skeleton(&self) -> &Skeleton<BONES, ANGLES>;

    /// Where its root is before any shift, metres.
    fn root_m(&self) -> Vec3;

    /// Where the search begins.
    fn start_rad(&self) -> [f32; ANGLES];

    /// How many of the first coordinates are given and stay.
    fn held(&self) -> usize;

    /// log density of a pose inside the limits, up to a constant.
    fn log_density(&self, angles_rad: &[f32; ANGLES], posture: &Posture<BONES, ANGLES>) -> f32;

    /// Its gradient, and minus its second derivative by Gauss and Newton. What belongs to a held
    /// coordinate is not read.
    fn derivatives(
        &self,
        angles_rad: &[f32; ANGLES],
        posture: &Posture<BONES, ANGLES>,
    ) -> ([f32; ANGLES], [[f32; ANGLES]; ANGLES]);

    /// As [`Self::log_density`]. Leaves in `information` what residuals on bones say of the pose,
    /// so that [`Self::write_derivatives`] need not find them again.
    fn inform(
        &self,
        angles_rad: &[f32; ANGLES],
        posture: &Posture<BONES, ANGLES>,
        _information: &mut BodyInformation<BONES>,
    ) -> f32 {
        self.log_density(angles_rad, posture)
    }

    /// As [`Self::derivatives`], written in place: a Hessian of many angles takes a kilobyte of
    /// stack each time that it is handed on. `information` is what [`Self::inform`] left at this
    /// pose.
    fn write_derivatives(
        &self,
        (angles_rad, posture): (&[f32; ANGLES], &Posture<BONES, ANGLES>),
        (gradient, hessian): (&mut [f32; ANGLES], &mut [[f32; ANGLES]; ANGLES]),
        _information: &mut BodyInformation<BONES>,
    ) {
        (*gradient, *hessian) = self.derivatives(angles_rad, posture);
    }

    /// Distance of the worst end-effector from its goal, metres; zero without goals.
    fn residual_m(&self, posture: &Posture<BONES, ANGLES>) -> f32;

    /// The posture of `angles_rad`.
    fn posture(&self, angles_rad: &[f32; ANGLES]) -> Posture<BONES, ANGLES> {
        posture(self.skeleton(), &self.root_m(), angles_rad)
    }
}

impl<const BONES: usize, const ANGLES: usize> PoseObjective<BONES, ANGLES> for PoseDensity<'_, BONES, ANGLES> {
    fn skeleton(&self) -> &Skeleton<BONES, ANGLES> {
        self.skeleton
    }

    fn root_m(&self) -> Vec3 {
        self.root_m
    }

    fn start_rad(&self) -> [f32; ANGLES] {
        self.previous_rad
    }

    fn held(&self) -> usize {
        self.held
    }

    /// log density of a pose inside the limits, up to the constant of PIK (12).
    fn log_density(&self, angles_rad: &[f32; ANGLES], posture: &Posture<BONES, ANGLES>) -> f32 {
        let mut sum = 0.0;
        for goal in self.goals {
            let Some(end) = posture.ends.get(goal.bone) else { continue };
            let miss = goal.position_m - end;
            sum -= 0.5 * miss.dot(&times(&goal.precision, &miss));
        }
        for i in 0..ANGLES {
            let change = angles_rad[i] - self.previous_rad[i];
            sum -= 0.5 * self.stiffness[i] * change * change;
        }
        sum
    }

    /// Gradient of the log density, PIK (23), and J'WJ + lambda, PIK (21).
    fn derivatives(
        &self,
        angles_rad: &[f32; ANGLES],
        posture: &Posture<BONES, ANGLES>,
    ) -> ([f32; ANGLES], [[f32; ANGLES]; ANGLES]) {
        let mut gradient = [0.0; ANGLES];
        let mut hessian = [[0.0; ANGLES]; ANGLES];
        self.fill_derivatives(posture, angles_rad, &mut gradient, &mut hessian);
        (gradient, hessian)
    }

    fn write_derivatives(
        &self,
        (angles_rad, posture): (&[f32; ANGLES], &Posture<BONES, ANGLES>),
        (gradient, hessian): (&mut [f32; ANGLES], &mut [[f32; ANGLES]; ANGLES]),
        _information: &mut BodyInformation<BONES>,
    ) {
        (*gradient, *hessian) = ([0.0; ANGLES], [[0.0; ANGLES]; ANGLES]);
        self.fill_derivatives(posture, angles_rad, gradient, hessian);
    }

    /// Distance of the worst end-effector from its goal, metres.
    fn residual_m(&self, posture: &Posture<BONES, ANGLES>) -> f32 {
        let mut worst = 0.0;
        for goal in self.goals {
            if let Some(end) = posture.ends.get(goal.bone) {
                worst = max(worst, length(&(goal.position_m - end)));
            }
        }
        worst
    }
}

impl<const BONES: usize, const ANGLES: usize> PoseDensity<'_, BONES, ANGLES> {
    /// Writes the derivatives over zeros.
    #[inline(always)]
    fn fill_derivatives(
        &self,
        posture: &Posture<BONES, ANGLES>,
        angles_rad: &[f32; ANGLES],
        gradient: &mut [f32; ANGLES],
        hessian: &mut [[f32; ANGLES]; ANGLES],
    ) {
        for i in 0..ANGLES {
            gradient[i] = -self.stiffness[i] * (angles_rad[i] - self.previous_rad[i]);
            hessian[i][i] = self.stiffness[i];
        }
        for goal in self.goals {
            let Some(end) = posture.ends.get(goal.bone) else { continue };
            let miss = goal.position_m - end;
            // By coordinate, so that a row of the Hessian is made of vectors.
            let (mut x, mut y, mut z) = ([0.0; ANGLES], [0.0; ANGLES], [0.0; ANGLES]);
            // Bounds that are constants, so that small skeletons are unrolled.
            for i in 0..ANGLES {
                // Angles that do not move the end add nothing.
                if i < self.held || !self.skeleton.angle_moves(i, goal.bone) {
                    continue;
                }
                let column = moving_column(self.skeleton, posture, goal.bone, i);
                (x[i], y[i], z[i]) = (column.x, column.y, column.z);
                let weighted = times(&goal.precision, &column);
                gradient[i] += weighted.dot(&miss);
                for j in 0..if WHOLE_ROWS { ANGLES } else { i + 1 } {
                    hessian[i][j] += weighted.x * x[j] + weighted.y * y[j] + weighted.z * z[j];
                }
            }
        }
        for i in 0..ANGLES {
            for j in i + 1..ANGLES {
                hessian[i][j] = hessian[j][i];
            }
        }
    }
}
