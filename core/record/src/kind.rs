//! Version and kinds of records.

/// Version of the format that this library writes and reads.
pub const VERSION: u16 = 2;

/// What a record holds. The numbers never change their meaning.
///
/// ```
/// use sinew_record::Kind;
///
/// // The number stands in the header; those of later versions are unknown.
/// assert_eq!(Kind::of(17), Some(Kind::CyclicInput));
/// assert_eq!(Kind::CyclicInput as u16, 17);
/// assert_eq!(Kind::of(9999), None);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u16)]
#[non_exhaustive]
pub enum Kind {
    /// [`crate::End`].
    End = 1,
    /// [`crate::CyclicSetup`].
    CyclicSetup = 16,
    /// [`crate::CyclicInput`].
    CyclicInput = 17,
    /// [`crate::ArmSetup`].
    ArmSetup = 32,
    /// [`crate::CandidateChunk`].
    CandidateChunk = 33,
    /// [`crate::EdgeChunk`].
    EdgeChunk = 34,
    /// [`crate::ArmInput`].
    ArmInput = 35,
    /// [`crate::CameraSetup`].
    CameraSetup = 48,
    /// [`crate::CameraLine`].
    CameraLine = 49,
    /// [`crate::CameraFace`].
    CameraFace = 50,
    /// [`crate::CyclicResult`].
    CyclicResult = 128,
    /// [`crate::ArmResult`].
    ArmResult = 129,
    /// [`crate::VisionResult`].
    VisionResult = 130,
    /// [`crate::BodyResult`].
    BodyResult = 131,
    /// [`crate::Failure`].
    Failure = 144,
    /// [`crate::Cost`].
    Cost = 160,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 16] = [
        Self::End,
        Self::CyclicSetup,
        Self::CyclicInput,
        Self::ArmSetup,
        Self::CandidateChunk,
        Self::EdgeChunk,
        Self::ArmInput,
        Self::CameraSetup,
        Self::CameraLine,
        Self::CameraFace,
        Self::CyclicResult,
        Self::ArmResult,
        Self::VisionResult,
        Self::BodyResult,
        Self::Failure,
        Self::Cost,
    ];

    /// The kind with this number.
    #[must_use]
    pub fn of(number: u16) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| *kind as u16 == number)
    }
}
