//! What the frames of a run showed, and why no hand was surely seen in most of them.

use super::arms::ArmSet;
use crate::frames::FrameView;
use crate::pixels::GREY;
use serde::{Deserialize, Serialize};

/// How many frames showed what a tracker needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SeenCounts {
    /// Frames that could be read.
    pub frames: usize,
    /// Of these, those without colours.
    pub grey: usize,
    /// Those in which the person's face was known.
    pub with_face: usize,
    /// Those with something that may be a hand: skin, or a row of `--hands`.
    pub with_candidates: usize,
    /// Those in which any of that was within an arm's length of a shoulder.
    pub within_reach: usize,
    /// Those in which an edge moved.
    pub with_motion: usize,
}

impl SeenCounts {
    /// Counts a frame.
    pub(super) fn count(&mut self, view: &FrameView, is_grey: bool, is_face_known: bool, arms: &ArmSet) {
        let is_within_reach = view.candidates.iter().any(|candidate| arms.reach(candidate.centre));
        self.frames += 1;
        self.grey += usize::from(is_grey);
        self.with_face += usize::from(is_face_known);
        self.with_candidates += usize::from(!view.candidates.is_empty());
        self.within_reach += usize::from(is_within_reach);
        self.with_motion += usize::from(!view.edges.is_empty());
    }

    /// The likeliest cause why a side was surely seen in `sure` of `all` frames only, and what
    /// helps; none if these are half of them. `looks_for_face` and `has_table` say what the run was
    /// given.
    #[must_use]
    pub(super) fn cause(&self, [sure, all]: [usize; 2], looks_for_face: bool, has_table: bool) -> Option<String> {
        if 2 * sure >= all {
            return None;
        }
        let Self { frames, grey, with_face, with_candidates, within_reach, with_motion } = *self;
        let cause = if 2 * with_candidates < frames && has_table {
            format!("--hands has a row for {with_candidates} of {frames} frames; does it count them from 0?")
        } else if 2 * grey > frames && !has_table {
            format!("{grey} of {frames} frames are grey; {GREY}, or the hands with --hands")
        } else if 2 * with_candidates < frames {
            format!("skin was found in {with_candidates} of {frames} frames; more light helps, or --calibrate")
        } else if 2 * within_reach < with_candidates {
            format!(
                "in {within_reach} of {frames} frames there was skin within an arm's length of the shoulder; \
                 let the face be seen, or give shoulders and camera with --config"
            )
        } else if 10 * with_motion < frames {
            format!("something moved in {with_motion} of {frames} frames only")
        } else if looks_for_face && 2 * with_face < frames {
            "no face was found, so skin, distance and shoulders are guesses; let the face be seen, a thirteenth of \
             the picture wide or more"
                .to_owned()
        } else {
            "several places look like a hand; --overlay draws them".to_owned()
        };
        Some(format!("surely seen in {sure} of {all} frames; the likeliest cause: {cause}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: SeenCounts =
        SeenCounts { frames: 100, grey: 0, with_face: 100, with_candidates: 100, within_reach: 100, with_motion: 100 };
    const UNSURE: [usize; 2] = [10, 100];

    #[test]
    fn most_frames_have_to_be_unsure() {
        assert_eq!(ALL.cause([50, 100], true, false), None);
        assert_eq!(ALL.cause([0, 0], true, false), None, "of no frame nothing is said");
        assert!(ALL.cause(UNSURE, true, false).unwrap().contains("surely seen in 10 of 100 frames"));
    }

    #[test]
    fn the_first_thing_that_is_missing_is_named() {
        let named = |seen: SeenCounts, part: &str| {
            let cause = seen.cause(UNSURE, true, false).unwrap();
            assert!(cause.contains(part), "{cause}");
        };
        named(
            SeenCounts { grey: 60, with_candidates: 0, ..ALL },
            "60 of 100 frames are grey; skin is found by its colour",
        );
        named(SeenCounts { with_candidates: 20, ..ALL }, "skin was found in 20 of 100 frames");
        named(SeenCounts { within_reach: 30, ..ALL }, "let the face be seen, or give shoulders");
        named(SeenCounts { with_motion: 3, ..ALL }, "something moved in 3 of 100 frames only");
        named(SeenCounts { with_face: 0, ..ALL }, "no face was found");
        named(ALL, "several places look like a hand");
        let table = SeenCounts { with_candidates: 20, ..ALL }.cause(UNSURE, true, true).unwrap();
        assert!(table.contains("--hands has a row for 20 of 100 frames"), "{table}");
        assert!(!SeenCounts { with_face: 0, ..ALL }.cause(UNSURE, false, false).unwrap().contains("no face"));
    }
}
