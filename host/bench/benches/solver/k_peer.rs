//! The same arm for the crate `k`, and its solver.

use k::prelude::*;
use k::{Constraints, JacobianIkSolver, JointType, Node, NodeBuilder, SerialChain, connect};
use nalgebra_for_k::{Isometry3, RealField, Translation3, Unit, Vector3};
use simba_for_k::scalar::SubsetOf;
use sinew_core::skeleton::{Joint, Skeleton};

/// Numbers that `k` computes with.
pub trait Number: RealField + SubsetOf<f64> + Copy {}
impl Number for f32 {}
impl Number for f64 {}

/// An arm of `k`, its solver, and where it is to go.
pub struct KPeer<T: Number> {
    arm: SerialChain<T>,
    solver: JacobianIkSolver<T>,
    constraints: Constraints,
}

impl<T: Number> KPeer<T> {
    /// The chain of `skeleton`; a goal counts as reached within `tolerance_m`, in `most_steps` of
    /// `step_share` of a whole step each.
    pub fn new<const BONES: usize, const ANGLES: usize>(
        skeleton: &Skeleton<BONES, ANGLES>,
        tolerance_m: f64,
        step_share: f64,
        most_steps: usize,
    ) -> Self {
        let number = nalgebra_for_k::convert::<f64, T>;
        let vector = |v: &sinew_core::math::Vec3| Vector3::new(v.x, v.y, v.z).map(|x| number(f64::from(x)));
        let mut nodes: Vec<Node<T>> = Vec::new();
        let mut offset = Vector3::zeros();
        let mut limits = skeleton.limits().iter();
        for bone in skeleton.bones() {
            let axes = match &bone.joint {
                Joint::Hinge(axis) => std::slice::from_ref(axis),
                Joint::Ball(axes) => axes,
                Joint::Fixed | Joint::Free(_) => &[],
            };
            for axis in axes {
                let limit = limits.next().expect("a limit for each angle");
                let range = k::joint::Range::new(number(limit.low_rad.into()), number(limit.high_rad.into()));
                let joint = NodeBuilder::new()
                    .name(&nodes.len().to_string())
                    .joint_type(JointType::Rotational { axis: Unit::new_normalize(vector(axis)) })
                    .limits(Some(range))
                    .translation(Translation3::from(offset));
                nodes.push(joint.into_node());
                offset = Vector3::zeros();
            }
            offset = vector(&bone.offset_m);
        }
        nodes.push(NodeBuilder::new().name("end").translation(Translation3::from(offset)).into_node());
        for pair in nodes.windows(2) {
            connect![pair[0] => pair[1]];
        }
        let arm = SerialChain::from_end(nodes.last().expect("an end"));
        let solver = JacobianIkSolver::new(number(tolerance_m), number(1.0), number(step_share), most_steps);
        let constraints =
            Constraints { rotation_x: false, rotation_y: false, rotation_z: false, ..Constraints::default() };
        Self { arm, solver, constraints }
    }

    /// Poses the arm.
    pub fn pose(&self, angles_rad: &[f32]) {
        let positions: Vec<T> = angles_rad.iter().map(|&angle| nalgebra_for_k::convert(f64::from(angle))).collect();
        self.arm.set_joint_positions_clamped(&positions);
    }

    /// Where the hand is, metres.
    pub fn end_m(&self) -> [f64; 3] {
        let end = self.arm.end_transform().translation.vector;
        [0, 1, 2].map(|i| nalgebra_for_k::try_convert(end[i]).unwrap_or(f64::NAN))
    }

    /// A goal in the numbers of `k`.
    pub fn goal(position_m: &[f32; 3]) -> Isometry3<T> {
        let [x, y, z] = position_m.map(|x| nalgebra_for_k::convert(f64::from(x)));
        Isometry3::translation(x, y, z)
    }

    /// Brings the hand to `goal`; whether it got there.
    pub fn solve(&self, goal: &Isometry3<T>) -> bool {
        self.solver.solve_with_constraints(&self.arm, goal, &self.constraints).is_ok()
    }
}
