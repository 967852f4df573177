//! Which modes stay: alike ones are merged, unlikely ones pruned, and the heaviest leads.

use super::options::{MAX_MODES, ModeOptions};
use super::state::BodyMode;
use crate::math::{Vec3, max, min};
use heapless::Vec;

/// Modes all of whose bones end within this of each other's are alike, metres.
/// Chosen: less than a limb's thickness.
const ALIKE_M: f32 = 0.04;
/// Modes lighter than the leading one by so many switch costs are pruned.
/// Chosen: a rival that needs some frames to reach its mode lives on.
const PRUNED_COSTS: f32 = 3.0;

/// Keeps the most likely of `candidates` that are not alike, the leading one first, weights
/// relative to its own.
///
/// Rivals begin at minus the switch cost and gain or lose evidence against the leading mode (a
/// cumulative sum test, Page 1954). One that has gained the cost leads. What led then has to gain
/// it anew.
pub(super) fn select<const BONES: usize, const ANGLES: usize>(
    candidates: &[BodyMode<BONES, ANGLES>],
    options: &ModeOptions,
    kept: &mut Vec<BodyMode<BONES, ANGLES>, MAX_MODES>,
) {
    let Some(leader) = heaviest(candidates.iter()) else { return };
    kept.clear();
    // There is room for the first.
    let _ = kept.push(BodyMode { log_weight: 0.0, is_rival: false, ..*leader });
    let most = if leader.is_rival { -options.switch_cost } else { 0.0 };
    while kept.len() < options.max_modes {
        let is_new =
            |mode: &&BodyMode<BONES, ANGLES>| kept.iter().all(|other| !is_alike(&mode.pose.ends_m, &other.pose.ends_m));
        let Some(next) = heaviest(candidates.iter().filter(is_new)) else { break };
        let log_weight = min(next.log_weight - leader.log_weight, most);
        if !(log_weight >= -PRUNED_COSTS * options.switch_cost) {
            break;
        }
        let _ = kept.push(BodyMode { log_weight, is_rival: true, ..*next });
    }
}

/// The first of the heaviest.
fn heaviest<'m, const BONES: usize, const ANGLES: usize>(
    modes: impl Iterator<Item = &'m BodyMode<BONES, ANGLES>>,
) -> Option<&'m BodyMode<BONES, ANGLES>> {
    modes.fold(None, |best, mode| match best {
        Some(best) if !(mode.log_weight > best.log_weight) => Some(best),
        _ => Some(mode),
    })
}

/// Whether two poses whose bones end there are one explanation.
pub(in super::super) fn is_alike(one_m: &[Vec3], other_m: &[Vec3]) -> bool {
    let mut farthest_m2 = 0.0;
    for (one_m, other_m) in one_m.iter().zip(other_m) {
        let off_m: Vec3 = one_m - other_m;
        farthest_m2 = max(farthest_m2, off_m.dot(&off_m));
    }
    farthest_m2 < ALIKE_M * ALIKE_M
}
