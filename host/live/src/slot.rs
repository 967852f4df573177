//! A place in static memory that is empty at first.

/// As `Option`, but empty is all zero, whatever the content: a static of empty slots takes no room in the module's file.
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
    pub const fn get_mut(&mut self) -> Option<&mut T> {
        match self {
            Self::Empty => None,
            Self::Full(content) => Some(content),
        }
    }
}
