//! Which way a person walks, from where they face.

use super::extrema::slope;
use super::foot_paths::{FootPaths, MIN_SEEN_SHARE};
use serde::Serialize;

/// Correlation of a foot's height with its speed forward under the hips from which the direction is
/// known. Chosen: 67 walks and runs of CMU, Bandai and others have 0.59 to 0.87 by the difference
/// of both feet, and 0.35 to 0.77 by one foot. Squats, standing and arms have at most 0.16.
const MIN_CORRELATION: f64 = 0.3;

/// Where a person goes, from where they face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// Where they face.
    Forward,
    /// Away from where they face.
    Backward,
    /// The feet do not show it. Events are those of a walk forward.
    Unknown,
}

impl Direction {
    /// The direction in which the feet go through the air. On the ground they go the other way
    /// under the hips, also on a treadmill and before a camera that pans.
    ///
    /// The sum of height times speed is the area of the loop that a foot makes under the hips, and
    /// its sign is the way round.
    pub(super) fn find([left, right]: &[FootPaths; 2]) -> Self {
        let seen = [left, right].map(|paths| paths.ankle.iter().flatten().count());
        let difference = |a: &[Option<f64>], b: &[Option<f64>]| -> Vec<Option<f64>> {
            a.iter().zip(b).map(|(a, b)| Some((*a)? - (*b)?)).collect()
        };
        let ahead = difference(&left.ankle, &right.ankle);
        let both = ahead.iter().flatten().count();
        let forwardness = if both as f64 >= MIN_SEEN_SHARE * seen[0].max(seen[1]) as f64 {
            forwardness(&ahead, &difference(&left.below, &right.below))
        } else {
            let foot = if seen[0] > seen[1] { left } else { right };
            forwardness(&foot.ankle, &foot.below)
        };
        match forwardness {
            Some(forwardness) if forwardness >= MIN_CORRELATION => Self::Forward,
            Some(forwardness) if forwardness <= -MIN_CORRELATION => Self::Backward,
            _ => Self::Unknown,
        }
    }
}

/// Correlation of height with speed forward.
fn forwardness(ahead: &[Option<f64>], below: &[Option<f64>]) -> Option<f64> {
    let pairs: Vec<[f64; 2]> =
        (0..ahead.len()).filter_map(|sample| Some([-below[sample]?, slope(ahead, sample)?])).collect();
    let mean = [0, 1].map(|axis| pairs.iter().map(|pair| pair[axis]).sum::<f64>() / pairs.len() as f64);
    let product = |a: usize, b: usize| pairs.iter().map(|pair| (pair[a] - mean[a]) * (pair[b] - mean[b])).sum::<f64>();
    let scale = (product(0, 0) * product(1, 1)).sqrt();
    (scale > 0.0).then(|| product(0, 1) / scale)
}
