//! A place in static memory that is empty at first.

/// As `Option`, but empty is all zero: a static of empty slots takes no flash.
///
/// `Option` may mark its `None` by a value that a field of the content cannot have, and then the whole static is copied from flash.
#[derive(Debug)]
#[repr(u8)]
pub enum Slot<T> {
    /// Nothing there.
    Empty = 0,
    /// Something there.
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

    /// The content, which is `made` where there was none.
    pub fn get_or_insert(&mut self, made: fn() -> T) -> &mut T {
        if matches!(self, Self::Empty) {
            *self = Self::Full(made());
        }
        match self {
            Self::Full(content) => content,
            Self::Empty => unreachable!("it was filled above"),
        }
    }

    /// The content to change, if there is any.
    pub const fn get_mut(&mut self) -> Option<&mut T> {
        match self {
            Self::Empty => None,
            Self::Full(content) => Some(content),
        }
    }
}
