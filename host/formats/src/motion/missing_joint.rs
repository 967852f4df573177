//! What a person reads of joints that were not found.

use super::joint_table::{LATERAL, Limb};
use super::name_forms::{plain, sided};
use crate::quote::{excerpt, listed};
use std::fmt;

/// Names that are compared. Chosen: more than any person has markers.
const MAX_COMPARED: usize = 400;
/// Longest name that is compared, bytes.
const MAX_COMPARED_BYTES: usize = 64;
/// Similarity (Jaro-Winkler, 0 to 1) from which a name is near. Chosen: `LKnie` is 0.91 from
/// `LKnee`, and the elbow's names are at most 0.7 from the knee's.
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
    pub(super) fn new(limb: &Limb, left: bool, names: &[String]) -> Self {
        let on_skin = limb.skin.iter().flat_map(|word| LATERAL.map(|form| form.replace('*', word)));
        let patterns: Vec<String> = on_skin
            .chain([limb.usual, limb.markers, limb.segments].concat().iter().map(|&one| one.to_owned()))
            .collect();
        let single = patterns.iter().filter(|pattern| !pattern.contains(['+', '&']));
        let forms: Vec<String> = single.flat_map(|pattern| sided(pattern, left)).collect();
        let side = if left { "left" } else { "right" };
        let joint = format!("{side} {}", limb.name);
        let mut examples: Vec<String> = vec![format!("{side}_{}", limb.name)];
        examples.extend(limb.usual.iter().chain(limb.markers).flat_map(|pattern| sided(pattern, left)));
        examples.truncate(EXAMPLES);
        Self { joint, examples, nearest: nearest(&forms, names) }
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
    format!("{joints}\nname its points with --names FILE (lines as `left_hip,NAME`){remedy}; it has {}", listed(&names))
}

fn nearest(forms: &[String], names: &[String]) -> Option<String> {
    let compared = names.iter().filter(|name| !name.is_empty() && name.len() <= MAX_COMPARED_BYTES).take(MAX_COMPARED);
    let similarity = |name: &str| {
        let name = plain(name);
        forms.iter().map(|form| strsim::jaro_winkler(&name, form)).fold(0.0, f64::max)
    };
    let best = compared.map(|name| (similarity(name), name)).max_by(|(a, _), (b, _)| a.total_cmp(b));
    best.filter(|(similarity, _)| *similarity >= MIN_SIMILARITY).map(|(_, name)| name.clone())
}
