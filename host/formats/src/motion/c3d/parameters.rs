//! The parameter section of a C3D file: its numbers, as far as they say how much data follows, and
//! its texts.

use super::words::Words;
use std::collections::BTreeMap;

/// Kinds of parameters.
const TEXT: i8 = -1;
const INTEGER: i8 = 2;
const REAL: i8 = 4;
/// Bytes that a reader keeps of each parameter beside its content, about.
const KEPT_BYTES: usize = 64;
/// How many times the section's own size its parameters may take together, and how much more. They
/// exceed it where they overlap. Chosen: parameters that do not overlap take the section once, and
/// the bytes that are kept of each.
const MAX_OVERLAP: usize = 4;
const FREE_BYTES: usize = 1 << 16;

/// Parameters, in the file's order.
#[derive(Debug)]
pub struct Parameters {
    entries: Vec<Parameter>,
}

/// One parameter.
#[derive(Debug)]
struct Parameter {
    /// Name of its group; empty for a group that is not there.
    group: String,
    name: String,
    content: Content,
}

/// What a parameter holds.
#[derive(Debug, Default)]
struct Content {
    /// The first two numbers.
    numbers: Vec<f64>,
    /// Texts of `text_bytes` each.
    text: Vec<u8>,
    text_bytes: usize,
}

impl Parameters {
    /// Reads a `section`, whose first four bytes are its header.
    ///
    /// # Errors
    /// The section ends within a group or parameter, or its parameters overlap.
    pub fn read(section: &[u8], words: Words) -> Result<Self, String> {
        let mut groups: BTreeMap<i8, String> = BTreeMap::new();
        let mut entries = Vec::new();
        let mut taken = 0_usize;
        let mut at = 4;
        while let Some(entry) = Entry::at(section, at, words)? {
            taken = taken.saturating_add(KEPT_BYTES + entry.kept_bytes);
            if taken > MAX_OVERLAP * section.len() + FREE_BYTES {
                return Err("its parameters overlap".to_owned());
            }
            if entry.group < 0 {
                groups.insert(entry.group.wrapping_abs(), entry.name);
            } else {
                entries.push((entry.group, entry.name.to_ascii_uppercase(), entry.content));
            }
            at = entry.next;
        }
        let named = |(group, name, content)| {
            let group = groups.get(&group).cloned().unwrap_or_default();
            Parameter { group, name, content }
        };
        Ok(Self { entries: entries.into_iter().map(named).collect() })
    }

    /// The first two numbers of each parameter of this name in `group`, the last one first.
    pub fn all<'a>(&'a self, group: &'a str, name: &'a str) -> impl Iterator<Item = &'a [f64]> {
        self.contents(group, name).map(|content| content.numbers.as_slice())
    }

    /// The texts of a parameter, without zeros and spaces at their ends; none where it is missing.
    pub fn texts(&self, group: &str, name: &str) -> Vec<String> {
        let text = |bytes: &[u8]| {
            let text: String = bytes.iter().copied().map(char::from).collect();
            text.trim_matches(|letter: char| letter.is_whitespace() || letter == '\0').to_owned()
        };
        let texts = |content: &Content| content.text.chunks(content.text_bytes.max(1)).map(text).collect();
        self.contents(group, name).next().map_or_else(Vec::new, texts)
    }

    fn contents<'a>(&'a self, group: &'a str, name: &'a str) -> impl Iterator<Item = &'a Content> {
        let wanted = move |entry: &&'a Parameter| entry.group == group && entry.name == name;
        self.entries.iter().rev().filter(wanted).map(|entry| &entry.content)
    }

    /// The number of a parameter that is there and not empty.
    pub fn number(&self, group: &str, name: &str) -> Option<f64> {
        self.all(group, name).next()?.first().copied()
    }
}

/// A group (its number is negative) or a parameter.
struct Entry {
    group: i8,
    name: String,
    content: Content,
    next: usize,
    kept_bytes: usize,
}

impl Entry {
    /// The entry at `at`; `None` where the section ends.
    fn at(section: &[u8], at: usize, words: Words) -> Result<Option<Self>, String> {
        let ends = || format!("its parameters end within the one at byte {at}");
        let (Some(&length), Some(&group)) = (section.get(at), section.get(at + 1)) else { return Ok(None) };
        let group = group.cast_signed();
        if group == 0 {
            return Ok(None);
        }
        let offset_at = at + 2 + usize::from(length.cast_signed().unsigned_abs());
        let name = section.get(at + 2..offset_at).ok_or_else(ends)?;
        let offset = words.u16(section, offset_at).ok_or_else(ends)?;
        let mut entry = Self {
            group,
            name: name.iter().copied().map(char::from).collect(),
            content: Content::default(),
            next: offset_at + usize::from(offset),
            kept_bytes: name.len() + usize::from(u8::MAX),
        };
        if group > 0 {
            let kind = section.get(offset_at + 2).ok_or_else(ends)?.cast_signed();
            let count = usize::from(*section.get(offset_at + 3).ok_or_else(ends)?);
            let start = offset_at + 4 + count;
            let dimensions = section.get(offset_at + 4..start).ok_or_else(ends)?;
            let values = dimensions.iter().try_fold(1_usize, |product, &size| {
                product.checked_mul(usize::from(size)).filter(|&values| values <= section.len())
            });
            let values = values.ok_or_else(ends)?;
            entry.kept_bytes += count + values * usize::from(kind.unsigned_abs());
            entry.content.numbers = first_numbers(section, start, kind, values, words);
            if kind == TEXT {
                entry.content.text = section.get(start..start + values).ok_or_else(ends)?.to_vec();
                entry.content.text_bytes = dimensions.first().map_or(1, |&length| usize::from(length));
            }
        }
        Ok(Some(entry))
    }
}

/// The first two numbers of a parameter, as many as it has.
fn first_numbers(section: &[u8], start: usize, kind: i8, values: usize, words: Words) -> Vec<f64> {
    let number = |index: usize| match kind {
        // Counts are without sign.
        INTEGER => words.u16(section, start + 2 * index).map(f64::from),
        REAL => words.f32(section, start + 4 * index).map(f64::from),
        _ => None,
    };
    (0..values.min(2)).map_while(number).collect()
}
