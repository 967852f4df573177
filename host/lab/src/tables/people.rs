//! Hands of recorded people, as recorded and changed.

use super::markdown::{Rows, line};
use crate::people::changes::Change;
use crate::people::clips::{RATE_HZ, list};
use crate::people::score::HandScore;
use crate::people::track::{score, score_at_length};
use anyhow::Result;
use rayon::prelude::*;
use std::path::Path;

/// How long a clip goes on, seconds, and the parts at both ends that are compared.
const MINUTES_S: f64 = 120.0;
const PART_S: f64 = 20.0;

/// A row for each change, and for parts of the recorded clips.
pub fn hands(recordings: &Path) -> Result<Rows> {
    let clips = list(&recordings.join("video/asl"))?;
    let mut rows =
        vec![line(["", "tracking", "of these on a hand", "left, right", "on the face", "palms found", "of"])];
    for change in Change::ALL {
        let scores: Vec<[HandScore; 3]> = clips.par_iter().map(|clip| score(clip, change)).collect::<Result<_>>()?;
        let [all, together, in_front_of_face] = sums(&scores);
        rows.push(row(change.name(), &all));
        if change == Change::None {
            rows.push(row("hands that touch", &together));
            rows.push(row("a hand in front of the face", &in_front_of_face));
        }
    }
    let (frames, part) = ((MINUTES_S * RATE_HZ) as usize, (PART_S * RATE_HZ) as usize);
    let scores: Vec<[HandScore; 2]> =
        clips.par_iter().map(|clip| score_at_length(clip, frames, part)).collect::<Result<_>>()?;
    let [first, last] = sums(&scores);
    rows.push(row("forwards and backwards for two minutes, first 20 s", &first));
    rows.push(row("the same, last 20 s", &last));
    Ok(rows)
}

fn sums<const N: usize>(clips: &[[HandScore; N]]) -> [HandScore; N] {
    let mut sums = [HandScore::default(); N];
    for clip in clips {
        sums.iter_mut().zip(clip).for_each(|(sum, score)| sum.plus(score));
    }
    sums
}

fn row(name: &str, score: &HandScore) -> Vec<String> {
    let [left, right] = score.arms.map(|arm| format!("{:.2}", arm.on_hand_share()));
    line([
        name.to_owned(),
        format!("{:.2}", score.sure_share()),
        format!("{:.3}", score.both().on_hand_share()),
        format!("{left}, {right}"),
        format!("{:.3}", score.on_face_share()),
        format!("{:.3}", score.found_share()),
        score.palms.to_string(),
    ])
}
