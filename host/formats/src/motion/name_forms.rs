//! Names of points in a form in which programs agree: without case, separators, and the prefix that
//! a program puts before them.

use std::collections::HashMap;

/// Words for the sides. A prefix ends before the first of them.
const SIDES: [&str; 4] = ["l", "r", "left", "right"];
/// Words for parts of a body. A prefix ends before the first of them.
const PARTS: [&str; 32] = [
    "ankle", "arm", "ball", "calf", "chest", "clavicle", "ear", "elbow", "eye", "finger", "foot", "forearm", "hand",
    "head", "heel", "hip", "hips", "knee", "leg", "neck", "pelvis", "root", "shank", "shin", "shoulder", "spine",
    "thigh", "thumb", "toe", "upper", "upperarm", "wrist",
];
/// Words that programs put behind a joint's name.
const FILLERS: [&str; 5] = ["study", "jnt", "joint", "bone", "bend"];
/// Longest prefix in words. Chosen: `ValveBiped.Bip01_L_Thigh` has four.
const MAX_PREFIX_WORDS: usize = 6;
/// Names beyond this length are compared as a whole. Chosen: names with namespaces have 60 bytes.
const MAX_SPLIT_BYTES: usize = 256;

/// The names of a file, looked up by their forms.
#[derive(Debug)]
pub struct NameForms {
    /// Names without the prefix of so many words, and their positions in the file.
    without_words: Vec<HashMap<String, usize>>,
}

impl NameForms {
    /// The forms of `names`. Empty names are none.
    pub fn new(names: &[String]) -> Self {
        let mut without_words: Vec<HashMap<String, usize>> = Vec::new();
        let common = common_prefix(names);
        for (index, name) in names.iter().enumerate() {
            for (dropped, form) in forms(name, common).into_iter().enumerate().filter(|(_, form)| !form.is_empty()) {
                if without_words.len() <= dropped {
                    without_words.resize_with(dropped + 1, HashMap::new);
                }
                without_words[dropped].entry(form).or_insert(index);
            }
        }
        Self { without_words }
    }

    /// Points whose middle the first of `patterns` asks for that is in the file. Names as a whole
    /// go before names without a prefix.
    pub fn points(&self, patterns: &[&str], left: bool) -> Option<Vec<usize>> {
        let of_depth = |depth: usize| patterns.iter().find_map(|pattern| self.matched(pattern, left, depth));
        (0..self.without_words.len()).find_map(of_depth)
    }

    /// The points of one pattern; see [`super::joint_table`].
    fn matched(&self, pattern: &str, left: bool, depth: usize) -> Option<Vec<usize>> {
        let (pattern, beside) = pattern.split_once('&').unwrap_or((pattern, ""));
        if !beside.is_empty() {
            self.part(beside, left, depth)?;
        }
        pattern.split('+').map(|part| self.part(part, left, depth)).collect()
    }

    fn part(&self, part: &str, left: bool, depth: usize) -> Option<usize> {
        let maps = &self.without_words[..=depth];
        sided(part, left).iter().find_map(|form| maps.iter().find_map(|map| map.get(form).copied()))
    }
}

/// The names that a part of a pattern stands for. `{L}` is left or right, and `{l}` is l or r.
/// `{s}` at the beginning is any of these before or behind the rest.
pub fn sided(part: &str, left: bool) -> Vec<String> {
    let (long, short) = if left { ("left", "l") } else { ("right", "r") };
    match part.strip_prefix("{s}") {
        Some(rest) => {
            vec![format!("{long}{rest}"), format!("{short}{rest}"), format!("{rest}{short}"), format!("{rest}{long}")]
        }
        None => vec![part.replace("{L}", long).replace("{l}", short)],
    }
}

/// Lower case, without separators and without what stands before a colon.
pub fn plain(name: &str) -> String {
    let name = name.rsplit(':').next().unwrap_or(name);
    name.chars().filter(|letter| !is_separator(*letter)).collect::<String>().to_ascii_lowercase()
}

fn is_separator(letter: char) -> bool {
    matches!(letter, '_' | '.' | '-' | ' ' | '|' | '/')
}

/// The forms of one name: whole, and without words behind it. Also without one word of its prefix
/// after the other, and without what all names begin with.
fn forms(name: &str, common: usize) -> Vec<String> {
    let mut forms = vec![plain(name)];
    if name.len() > MAX_SPLIT_BYTES {
        return forms;
    }
    let words = words(name.rsplit(':').next().unwrap_or(name));
    let end = words.iter().rposition(|word| !FILLERS.contains(&word.as_str())).map_or(0, |last| last + 1);
    let words = &words[..end];
    forms.push(words.concat());
    let is_prefix = |word: &&String| !SIDES.contains(&word.as_str()) && !PARTS.contains(&word.as_str());
    let prefix = words.iter().take_while(is_prefix).count().min(words.len().saturating_sub(1));
    forms.extend((1..=prefix.min(MAX_PREFIX_WORDS)).map(|dropped| words[dropped..].concat()));
    if common > 0 {
        forms.push(name.get(common..).map(plain).unwrap_or_default());
    }
    forms
}

/// Words of a name, lower case: they end at separators, between a lower and an upper letter, and
/// between letters and digits.
fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let letters: Vec<char> = name.chars().collect();
    for (index, &letter) in letters.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| letters[before]);
        let is_start = before.is_none_or(|before| {
            let is_next_lower = letters.get(index + 1).is_some_and(|next| next.is_ascii_lowercase());
            is_separator(before)
                || before.is_ascii_digit() != letter.is_ascii_digit()
                || (letter.is_ascii_uppercase() && (before.is_ascii_lowercase() || is_next_lower))
        });
        if is_separator(letter) {
            continue;
        }
        if is_start {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut() {
            word.push(letter.to_ascii_lowercase());
        }
    }
    words
}

/// Bytes that all names begin with; 0 where that is a side alone, or there are fewer than three.
fn common_prefix(names: &[String]) -> usize {
    let Some((first, others)) = names.split_first().filter(|(_, others)| others.len() > 1) else { return 0 };
    let shared = others.iter().fold(first.len(), |shared, name| {
        first.bytes().zip(name.bytes()).take(shared).take_while(|(a, b)| a == b).count()
    });
    let is_side = first.get(..shared).is_some_and(|prefix| SIDES.contains(&plain(prefix).as_str()));
    if is_side { 0 } else { shared }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_end_where_people_see_them_end() {
        for (name, wanted) in [
            ("mixamorigLeftUpLeg", "mixamorig left up leg"),
            ("J_Bip_L_UpperLeg", "j bip l upper leg"),
            ("Bip01 L Toe0", "bip 01 l toe 0"),
            ("RHJC_study", "rhjc study"),
            ("LThigh", "l thigh"),
            ("upper_arm.L", "upper arm l"),
            ("..", ""),
        ] {
            assert_eq!(words(name).join(" "), wanted);
        }
    }

    #[test]
    fn a_prefix_is_dropped_up_to_a_side_or_a_part() {
        let found = |names: &[&str], pattern: &str| {
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            NameForms::new(&names).points(&[pattern], true)
        };
        assert_eq!(found(&["Rig_R_Knee_L", "Rig_L_Knee"], "{s}knee"), Some(vec![1]));
        assert_eq!(found(&["ik_foot_l", "foot_l"], "{s}foot"), Some(vec![1]));
        assert_eq!(found(&["ik_hand_root"], "root"), None);
        assert_eq!(found(&["zzlhip", "zzlknee", "zzneck"], "{s}knee"), Some(vec![1]));
        assert_eq!(found(&["LeftHandThumb1"], "{s}hand"), None);
        assert_eq!(found(&["L_Arm", "L_Hand"], "{s}arm&{s}forearm"), None);
        assert_eq!(found(&[&"a_".repeat(100_000), "", "äöü"], "{s}knee"), None);
    }
}
