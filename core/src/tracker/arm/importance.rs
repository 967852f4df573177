//! Importance ratio of a goal (`pik-weighted`): the goal transition over the proposal it was drawn
//! from.

use super::context::FrameContext;
use crate::correction::hand::log_density_on_ray;
use crate::math::{Vec3, exp, length, ln, max};
use crate::random::Stream;
use crate::random::normal::LOG_SQRT_TAU;

/// A draw from the goal transition: (1 - rho) of the goal process + rho uniform over the reachable
/// space.
pub(super) fn draw_transition(context: &FrameContext<'_>, extrapolated_m: &Vec3, stream: &mut Stream) -> Vec3 {
    if stream.uniform() < context.model.options().teleport_share {
        return draw_reachable(context, stream);
    }
    extrapolated_m + stream.normal3() * context.hand_process().std_m(context.dt_s)
}

/// Uniform over the reachable shell: the cube of the radius is uniform.
fn draw_reachable(context: &FrameContext<'_>, stream: &mut Stream) -> Vec3 {
    let shell = &context.reachable;
    let direction = crate::math::unit(stream.normal3()).unwrap_or(Vec3::z());
    let (inner, outer) = (shell.inner_m * shell.inner_m * shell.inner_m, shell.outer_m * shell.outer_m * shell.outer_m);
    let cube = inner + stream.uniform() * (outer - inner);
    shell.centre_m + direction * exp(ln(max(cube, 1.0e-9)) / 3.0)
}

/// ln density of the goal transition at `goal_m`, per cubic metre.
pub(super) fn log_transition(context: &FrameContext<'_>, extrapolated_m: &Vec3, goal_m: &Vec3) -> f32 {
    let rho = context.model.options().teleport_share;
    let std_m = context.hand_process().std_m(context.dt_s);
    let miss = length(&(goal_m - extrapolated_m)) / std_m;
    let near = (1.0 - rho) * exp(-0.5 * miss * miss - 3.0 * (LOG_SQRT_TAU + ln(std_m)));
    let shell = &context.reachable;
    let anywhere = if shell.contains(goal_m) {
        let cubes = shell.outer_m * shell.outer_m * shell.outer_m - shell.inner_m * shell.inner_m * shell.inner_m;
        rho / (4.0 / 3.0 * core::f32::consts::PI * max(cubes, 1.0e-6))
    } else {
        0.0
    };
    ln(max(near + anywhere, f32::MIN_POSITIVE))
}

/// ln of q_i(g) = (n_0/N) p_i(g) + sum_b (n_b/N) N(g; H1_ib, Sigma_ib), per cubic metre.
pub(super) fn log_proposal(context: &FrameContext<'_>, extrapolated_m: &Vec3, forearm: &Vec3, goal_m: &Vec3) -> f32 {
    let driven: u32 = context.counts.iter().map(|&n| u32::from(n)).sum();
    let total = context.free as f32 + driven as f32;
    let mut density = context.free as f32 / total * exp(log_transition(context, extrapolated_m, goal_m));
    for (index, &count) in context.counts.iter().enumerate() {
        if count == 0 {
            continue;
        }
        if let Some((mean_m, ray, spread)) = context.corrected_hand(extrapolated_m, forearm, index) {
            density += f32::from(count) / total * exp(log_density_on_ray(goal_m, &mean_m, &ray, &spread));
        }
    }
    ln(max(density, f32::MIN_POSITIVE))
}
