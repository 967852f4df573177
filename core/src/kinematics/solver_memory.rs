//! What a solver of many angles needs for a while.

use super::body_information::BodyInformation;
use super::cholesky::Cholesky;
use super::forward::Posture;

/// Memory of a solver, 5 KB for an upper body: on the stack of a host, in the memory of a tracker
/// for firmware. It carries nothing from one use to the next.
///
/// ```
/// use sinew_core::kinematics::inverse::{PoseDensity, Solve};
/// use sinew_core::kinematics::solver_memory::SolverMemory;
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// let skeleton = ArmGeometry::new(Side::Left, 0.3, 0.3)?.skeleton()?;
/// let density = PoseDensity {
///     skeleton: &skeleton,
///     root_m: Vec3::zeros(),
///     goals: &[],
///     previous_rad: [0.5; 4],
///     stiffness: [1.0; 4],
///     held: 0,
/// };
/// let mut memory = SolverMemory::new();
/// let solution = density.solve_within(&[], 3, &mut memory);
/// assert_eq!(solution.angles_rad, density.mode(3).angles_rad);
/// assert_eq!(memory.hessian(), &density.mode(3).hessian);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct SolverMemory<const BONES: usize, const ANGLES: usize> {
    /// That of the pose and that of the next one, in turn.
    pub(super) postures: [Posture<BONES, ANGLES>; 2],
    pub(super) hessian: [[f32; ANGLES]; ANGLES],
    /// Of the Hessian without the angles that are held.
    pub(super) factor: Cholesky<ANGLES>,
    pub(super) information: BodyInformation<BONES>,
}

impl<const BONES: usize, const ANGLES: usize> SolverMemory<BONES, ANGLES> {
    /// Before its first use: all zeros.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            postures: [Posture::folded(), Posture::folded()],
            hessian: [[0.0; ANGLES]; ANGLES],
            factor: Cholesky { lower: [[0.0; ANGLES]; ANGLES] },
            information: BodyInformation::empty(),
        }
    }

    /// Minus the second derivative of the log density at the last solution.
    #[must_use]
    pub const fn hessian(&self) -> &[[f32; ANGLES]; ANGLES] {
        &self.hessian
    }

    /// Factors the Hessian at the last solution; `None` where it is not positive definite.
    pub(crate) fn factor_hessian(&mut self) -> Option<&Cholesky<ANGLES>> {
        self.factor.refactor(&self.hessian, 0).then_some(&self.factor)
    }
}

impl<const BONES: usize, const ANGLES: usize> Default for SolverMemory<BONES, ANGLES> {
    fn default() -> Self {
        Self::new()
    }
}
