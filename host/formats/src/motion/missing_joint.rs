//! What a person reads of joints that were not found.

use super::joint_table::{LATERAL, Limb};
use super::name_forms::{plain, sided};
use crate::quote::{excerpt, listed};
use std::fmt;

/// Names that are compared. Chosen: more than any person has markers.
const MAX_COMPARED: usize = 400;
/// Longest name that is compared, bytes.
const MAX_COMPARED_BYTES: usize = 64;
/// Similarity (Jaro-Winkler, 0 to 1) without the side from which a name is near. Chosen: `knie` is
/// 0.87 from `knee`, and `elbow` 0.
const MIN_SIMILARITY: f64 = 0.75;
/// Examples of names in a line.
const EXAMPLES: usize = 4;

/// A limb joint that goes by no name that is known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MissingJoint {
    /// The joint, e.g. `left knee`.
    pub joint: String,
    /// Some of the names that are read.
    pub examples: Vec<String>,
    /// The name of the file that is most like one that is read.
    pub nearest: Option<String>,
}

impl MissingJoint {
    /// What is said of a joint that none of the file's names is for; `free` are those that no other
    /// joint goes by.
    pub(super) fn new(limb: &Limb, left: bool, free: &[&str]) -> Self {
        let on_skin = limb.skin.iter().flat_map(|word| LATERAL.map(|form| form.replace('*', word)));
        let patterns: Vec<String> = on_skin
            .chain([limb.usual, limb.markers, limb.segments].concat().iter().map(|&one| one.to_owned()))
            .collect();
        let single = patterns.iter().filter(|pattern| !pattern.contains(['+', '&']));
        let parts: Vec<String> = single
            .map(|pattern| ["{s}", "{L}", "{l}"].iter().fold(pattern.clone(), |part, side| part.replace(side, "")))
            .collect();
        let side = if left { "left" } else { "right" };
        let joint = format!("{side} {}", limb.name);
        let mut examples: Vec<String> = vec![format!("{side}_{}", limb.name)];
        examples.extend(limb.usual.iter().chain(limb.markers).flat_map(|pattern| sided(pattern, left)));
        examples.truncate(EXAMPLES);
        Self { joint, examples, nearest: nearest(&parts, free, left) }
    }
}

impl fmt::Display for MissingJoint {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} ({}, ...): ", self.joint, self.examples.join(", "))?;
        match &self.nearest {
            Some(name) => write!(out, "the nearest name is `{}`", excerpt(name)),
            None => write!(out, "no name is near"),
        }
    }
}

/// The lines of an error: a joint each, the remedy, and the names that are there.
pub fn lines(missing: &[MissingJoint], partial: bool, names: &[String]) -> String {
    let joints: String = missing.iter().map(|joint| format!("\n  {joint}")).collect();
    let remedy = if partial { "" } else { ", or take what is there with --partial" };
    let names: Vec<String> = names.iter().filter(|name| !name.is_empty()).cloned().collect();
    format!(
        "{joints}\nname its points with `sinew angles --names FILE` (lines as `left_hip,NAME`){remedy}\nit has {}",
        listed(&names)
    )
}

/// The name of this side whose rest is most like one of `parts`.
fn nearest(parts: &[String], names: &[&str], left: bool) -> Option<String> {
    let (long, short) = if left { ("left", "l") } else { ("right", "r") };
    let similarity = |name: &str| {
        let name = plain(name);
        let of_rest = |rest: &str| parts.iter().map(|part| strsim::jaro_winkler(rest, part)).fold(0.0, f64::max);
        let sides = [long, short].into_iter();
        let rests = sides.flat_map(|side| [name.strip_prefix(side), name.strip_suffix(side)]).flatten();
        rests.map(of_rest).fold(0.0, f64::max)
    };
    let compared = names.iter().filter(|name| !name.is_empty() && name.len() <= MAX_COMPARED_BYTES).take(MAX_COMPARED);
    let best = compared.map(|name| (similarity(name), name)).max_by(|(a, _), (b, _)| a.total_cmp(b));
    best.filter(|(similarity, _)| *similarity >= MIN_SIMILARITY).map(|(_, name)| (*name).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_of_the_same_side() {
        for (one, other, wanted) in [("knie", "knee", 0.87), ("elbow", "knee", 0.0)] {
            assert!((strsim::jaro_winkler(one, other) - wanted).abs() < 0.005, "{one}");
        }
        let parts = ["knee".to_owned(), "leg".to_owned()];
        let names = ["R.Knie", "LElbow", "Knie", "Knie_left"];
        assert_eq!(nearest(&parts, &names, true).as_deref(), Some("Knie_left"));
        assert_eq!(nearest(&parts, &names, false).as_deref(), Some("R.Knie"));
        assert_eq!(nearest(&parts, &names[1..3], false), None);
    }
}
