//! The parameter section of a C3D file, as far as it says how much data follows.

use super::words::Words;
use std::collections::BTreeMap;

/// Kinds of parameters.
const INTEGER: i8 = 2;
const REAL: i8 = 4;
/// Bytes that a reader keeps of each parameter beside its content, about.
const KEPT_BYTES: usize = 64;
/// How many times the section's own size its parameters may take together, and how much more. They
/// exceed it where they overlap. Chosen: readers take dimensions of 0 for 1, which exceeds the
/// section up to four times.
const MAX_OVERLAP: usize = 16;
const FREE_BYTES: usize = 1 << 16;

/// Numbers of a parameter, by the name of its group (empty for a group that is not there) and its
/// own.
#[derive(Debug)]
pub struct Parameters {
    entries: Vec<(String, String, Vec<f64>)>,
    /// Name of each parameter and the byte of the section at which it begins.
    places: Vec<(String, usize)>,
}

impl Parameters {
    /// Reads the numbers of `section`, whose first four bytes are its header.
    ///
    /// # Errors
    /// The section ends within a group or parameter, or its parameters overlap.
    pub fn read(section: &[u8], words: Words) -> Result<Self, String> {
        let mut groups: BTreeMap<i8, String> = BTreeMap::new();
        let mut numbers: Vec<(i8, String, Vec<f64>)> = Vec::new();
        let mut places = Vec::new();
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
                let name = entry.name.to_ascii_uppercase();
                places.push((name.clone(), at + 2));
                numbers.push((entry.group, name, entry.numbers));
            }
            at = entry.next;
        }
        let named = |(group, name, numbers)| (groups.get(&group).cloned().unwrap_or_default(), name, numbers);
        Ok(Self { entries: numbers.into_iter().map(named).collect(), places })
    }

    /// The first two numbers of each parameter of this name in `group`, the last one first.
    pub fn all<'a>(&'a self, group: &'a str, name: &'a str) -> impl Iterator<Item = &'a [f64]> {
        let wanted = move |entry: &&'a (String, String, Vec<f64>)| entry.0 == group && entry.1 == name;
        self.entries.iter().rev().filter(wanted).map(|entry| entry.2.as_slice())
    }

    /// The bytes of the section at which parameters of this name begin, in whatever group.
    pub fn places<'a>(&'a self, name: &'a str) -> impl Iterator<Item = usize> + 'a {
        self.places.iter().filter(move |(other, _)| other == name).map(|(_, at)| *at)
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
    numbers: Vec<f64>,
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
            numbers: Vec::new(),
            next: offset_at + usize::from(offset),
            kept_bytes: name.len() + usize::from(u8::MAX),
        };
        if group > 0 {
            let kind = section.get(offset_at + 2).ok_or_else(ends)?.cast_signed();
            let count = usize::from(*section.get(offset_at + 3).ok_or_else(ends)?);
            let start = offset_at + 4 + count;
            let dimensions = section.get(offset_at + 4..start).ok_or_else(ends)?;
            let values = dimensions.iter().filter(|&&size| size > 0).try_fold(1_usize, |product, &size| {
                product.checked_mul(usize::from(size)).filter(|&values| values <= section.len())
            });
            let values = values.ok_or_else(ends)?;
            entry.kept_bytes += count + values * usize::from(kind.unsigned_abs());
            entry.numbers = first_numbers(section, start, kind, values, words);
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
