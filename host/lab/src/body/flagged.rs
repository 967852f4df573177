//! Frames that lose a joint without a word: neither said to be unobserved nor to be ambiguous.

use sinew::body::BodyJoints;
use sinew::body::tracking::BodyFilter;
use sinew::body::tracking::ambiguity::LOST_JOINT_M;
use sinew::body::tracking::end_effectors::END_EFFECTORS;
use sinew::body::tracking::filter::WholeBodyEstimate;
use sinew_core::skeleton::full_body::{BODY_BONES, BODY_PARENTS};

/// A joint of which more of the particles' weight is elsewhere is ambiguous.
///
/// Chosen on the tuning runners: from 0.05 to 0.2 the share of the frames that lose a joint without
/// a word is the same, 1.3 %.
const AMBIGUOUS_SHARE: f32 = 0.2;

/// Whether `estimate`, the last of `filter`, has a joint far from the true one, and head, wrist or
/// ankle of its limb are neither unobserved nor ambiguous. The trunk belongs to all limbs.
pub fn loses_unflagged(filter: &BodyFilter, estimate: &WholeBodyEstimate, joints_m: &BodyJoints) -> bool {
    let ambiguous = filter.ambiguous(estimate);
    let flagged: Vec<usize> =
        END_EFFECTORS.into_iter().filter(|&end| !estimate.observed[end] || ambiguous[end] > AMBIGUOUS_SHARE).collect();
    (0..filter.part().bones()).any(|bone| {
        let error_m = joints_m[bone].map_or(0.0, |true_m| (estimate.ends_m[bone] - true_m).norm());
        error_m > LOST_JOINT_M && !flagged.iter().any(|&end| hangs_on(end, bone) || hangs_on(bone, end))
    })
}

/// Whether `bone` is `other` or hangs on it.
fn hangs_on(bone: usize, other: usize) -> bool {
    let parent = |bone: &usize| BODY_PARENTS[*bone].map(usize::from);
    std::iter::successors(Some(bone), parent).take(BODY_BONES).any(|bone| bone == other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::MotionChoice;
    use sinew::body::tracking::{BodyModelKind, BodyTuning};
    use sinew_core::math::Vec3;
    use sinew_core::pik::processes::stick::StickSight;
    use sinew_core::skeleton::full_body::{FOREARMS, SHANKS, TRUNK};

    #[test]
    fn a_lost_limb_has_to_be_flagged_by_its_own_end() {
        let seen = "pelvic-lift".parse::<MotionChoice>().unwrap().seen(None, 1).unwrap();
        let who = (&seen.measures, seen.first_rad);
        let mut filter =
            BodyFilter::of_part(seen.part, BodyModelKind::Guided, BodyTuning::default(), who, 1, 1).unwrap();
        let blocks = filter.blocks(&mut seen.clouds_m[1].clone());
        let mut estimate = filter.step(&blocks, 1.0 / seen.rate_hz, StickSight::Unseen);
        estimate.observed = [true; BODY_BONES];
        // A single particle is nowhere else.
        estimate.ends_m = filter.particles().0[0].ends_m;
        let mut joints_m = estimate.ends_m.map(Some);
        let ambiguous = filter.ambiguous(&estimate);
        assert!(END_EFFECTORS.iter().all(|&end| ambiguous[end] < AMBIGUOUS_SHARE), "{ambiguous:?}");
        assert!(!loses_unflagged(&filter, &estimate, &joints_m));
        let toe = SHANKS[0] + 1;
        joints_m[toe] = Some(estimate.ends_m[toe] + Vec3::new(0.0, 0.2, 0.0));
        assert!(loses_unflagged(&filter, &estimate, &joints_m));
        estimate.observed[FOREARMS[0]] = false;
        assert!(loses_unflagged(&filter, &estimate, &joints_m), "an arm's flag is no word about a foot");
        estimate.observed[SHANKS[0]] = false;
        assert!(!loses_unflagged(&filter, &estimate, &joints_m));
    }

    #[test]
    fn limbs_hang_on_the_trunk() {
        assert!(hangs_on(FOREARMS[1], TRUNK) && hangs_on(SHANKS[0] + 1, SHANKS[0]));
        assert!(!hangs_on(TRUNK, FOREARMS[1]) && !hangs_on(SHANKS[0], TRUNK));
    }
}
