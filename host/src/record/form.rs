//! What of a run is recorded.

/// What of a run is recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
pub enum Form {
    /// What the tracker was given: blobs and edges, or angles.
    #[default]
    Tracker,
    /// The lines of its images, for firmware that does the vision as well.
    Camera,
}
