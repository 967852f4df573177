//! A place in static memory that is empty at first.

/// As `Option`, but empty is all zero: a static of empty slots takes no room in flash or in a
/// module's file.
///
/// `Option` may mark its `None` by a value that a field of the content cannot have. Then the whole
/// static is stored and copied.
///
/// ```
/// use sinew_core::slot::Slot;
///
/// let mut slot = Slot::Empty;
/// assert!(slot.get().is_none());
/// *slot.get_or_insert(|| 3) += 1;
/// assert_eq!(slot.get(), Some(&4));
/// assert!(slot.get_mut().is_some_and(|content| *content == 4));
/// ```
#[derive(Debug)]
#[repr(u8)]
pub enum Slot<T> {
    /// No content.
    Empty = 0,
    /// The content.
    Full(T) = 1,
}

impl<T> Slot<T> {
    /// The content, if there is any.
    pub const fn get(&self) -> Option<&T> {
        match self {
            Self::Empty => None,
            Self::Full(content) => Some(content),
        }
    }

    /// The content to change, if there is any.
    pub const fn get_mut(&mut self) -> Option<&mut T> {
        match self {
            Self::Empty => None,
            Self::Full(content) => Some(content),
        }
    }

    /// The content; an empty slot is filled by `make` first.
    pub fn get_or_insert(&mut self, make: fn() -> T) -> &mut T {
        if matches!(self, Self::Empty) {
            *self = Self::Full(make());
        }
        match self {
            Self::Full(content) => content,
            Self::Empty => unreachable!("it was filled above"),
        }
    }
}
