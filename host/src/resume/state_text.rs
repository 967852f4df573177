//! States as text inside JSON: the core's saved state, with its checksum, in base64.

use super::REMEDY;
use crate::error::{Context, Error, Result};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sinew_core::saved_state::{SavedState, StateKind, StateVisitor, restore, save, saved_bytes};

/// `state` as text. It is not changed.
///
/// # Errors
/// None that a user can bring about.
pub fn to_text(kind: StateKind, state: &mut impl SavedState) -> Result<String> {
    let mut bytes = vec![0; saved_bytes(state)];
    save(kind, 0, state, &mut bytes)?;
    Ok(STANDARD.encode(bytes))
}

/// Puts `state` back into what `text` says.
///
/// # Errors
/// The text is not whole, or of another kind of state.
pub fn from_text(kind: StateKind, text: &str, state: &mut impl SavedState) -> Result<()> {
    let mut inner = || -> Result<()> { Ok(restore(kind, 0, state, &STANDARD.decode(text).map_err(Error::invalid)?)?) };
    inner().with_context(|| format!("what the run left is not whole; {REMEDY}"))
}

/// A list of any length of what has a state.
#[derive(Debug, Clone, PartialEq)]
pub struct List<T> {
    /// The entries.
    pub entries: Vec<T>,
    /// What an entry is before it is read.
    fill: T,
}

impl<T: Clone> List<T> {
    /// A list with these entries; others are read over copies of `fill`.
    #[must_use]
    pub fn new(entries: Vec<T>, fill: T) -> Self {
        Self { entries, fill }
    }
}

impl<T: SavedState + Clone> SavedState for List<T> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        let mut count = self.entries.len();
        visitor.index(&mut count, u32::MAX as usize);
        // Each entry has at least one word.
        if count > visitor.words_left() {
            count = 0;
            visitor.refuse();
        }
        self.entries.resize(count, self.fill.clone());
        for entry in &mut self.entries {
            entry.visit(visitor);
        }
    }
}

/// Shows a number of any value.
pub fn real(value: &mut f32, visitor: &mut impl StateVisitor) {
    let mut bits = value.to_bits();
    visitor.word(&mut bits);
    *value = f32::from_bits(bits);
}

/// Shows numbers of any value.
pub fn reals(values: &mut [f32], visitor: &mut impl StateVisitor) {
    values.iter_mut().for_each(|value| real(value, visitor));
}

/// Shows a number of any value.
pub fn long_real(value: &mut f64, visitor: &mut impl StateVisitor) {
    let mut bits = value.to_bits();
    visitor.long(&mut bits);
    *value = f64::from_bits(bits);
}

/// Shows whether `value` is there, and then by `show` what it is; a reader begins with `fill`.
pub fn optional<T, V: StateVisitor>(
    value: &mut Option<T>,
    fill: T,
    visitor: &mut V,
    show: impl FnOnce(&mut T, &mut V),
) {
    let mut is_there = value.is_some();
    visitor.flag(&mut is_there);
    if !is_there {
        *value = None;
        return;
    }
    show(value.get_or_insert(fill), visitor);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Clone, PartialEq)]
    struct Entry {
        angle: Option<f32>,
        sum: f64,
    }

    impl SavedState for Entry {
        fn visit(&mut self, visitor: &mut impl StateVisitor) {
            optional(&mut self.angle, 0.0, visitor, |angle, visitor| real(angle, visitor));
            long_real(&mut self.sum, visitor);
        }
    }

    #[test]
    fn entries_come_back_bit_for_bit() {
        let fill = Entry { angle: None, sum: 0.0 };
        let entries = vec![
            Entry { angle: Some(-0.0), sum: 0.1 },
            fill.clone(),
            Entry { angle: Some(f32::NEG_INFINITY), sum: f64::MIN_POSITIVE / 4.0 },
        ];
        let text = to_text(StateKind::Arm, &mut List::new(entries.clone(), fill.clone())).unwrap();
        let mut back = List::new(Vec::new(), fill.clone());
        from_text(StateKind::Arm, &text, &mut back).unwrap();
        assert_eq!(back.entries, entries);
        assert!(back.entries[0].angle.unwrap().is_sign_negative());
        for broken in [&text[4..], &text[..text.len() - 4], "no base64"] {
            let message = format!("{:#}", from_text(StateKind::Arm, broken, &mut back).unwrap_err());
            assert!(message.contains("leave --resume out"), "{message}");
        }
        assert!(from_text(StateKind::Cyclic, &text, &mut back).is_err());
    }

    /// A list that says it has so many entries.
    struct Promised(usize);

    impl SavedState for Promised {
        fn visit(&mut self, visitor: &mut impl StateVisitor) {
            visitor.index(&mut self.0, u32::MAX as usize);
        }
    }

    #[test]
    fn a_list_longer_than_its_state_is_refused_before_memory_is_taken() {
        for count in [1, u32::MAX as usize] {
            let text = to_text(StateKind::Arm, &mut Promised(count)).unwrap();
            let mut list = List::new(Vec::new(), Entry { angle: None, sum: 0.0 });
            assert!(from_text(StateKind::Arm, &text, &mut list).is_err());
            assert!(list.entries.capacity() < 2, "{}", list.entries.capacity());
        }
    }
}
