//! Parts of the filter that an experiment can switch off, to measure what each is worth.
//!
//! Without the feature `ablation` every part is on, and nothing is left of this file.

#[cfg(feature = "ablation")]
use core::sync::atomic::{AtomicU32, Ordering};

/// A part that can be switched off.
///
/// ```
/// # #[cfg(feature = "ablation")] {
/// use sinew_core::cyclic::coupled::ablation::{Part, switch_off};
///
/// for part in Part::ALL {
///     switch_off(Some(part));
///     // ... the same recordings as with all parts ...
/// }
/// switch_off(None);
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The scale of each angle's noise; without it the noise is as stated.
    NoiseScale,
    /// The scale of the person's spread; without it the spread is that of the training.
    SpreadScale,
    /// The inflation of an angle's variance as evidence for the phase.
    Tempering,
    /// The limit of an angle's evidence where angles wind.
    WindingShape,
    /// The exclusion of angles that wind unlike the mean cycle.
    WindingExclusion,
    /// The gate of a single angle at four standard deviations.
    AngleGate,
    /// The slope as a secant; without it, it is the tangent.
    Secant,
    /// The second hypothesis, where the grid names another place.
    Rival,
    /// The second speed of a start, until a cycle is seen.
    SecondSpeed,
    /// Giving way to a rival without a comparison, of a filter that does not fit or stands.
    GivingWay,
    /// The wider prior of an angle that is far from the mean pose in the first row.
    FirstRowOffset,
    /// The noise of the first row; without it, it is as stated.
    FirstRowNoise,
    /// The turns along the measured way.
    MeasuredPath,
}

#[cfg(feature = "ablation")]
impl Part {
    /// All parts.
    pub const ALL: [Self; 13] = [
        Self::NoiseScale,
        Self::SpreadScale,
        Self::Tempering,
        Self::WindingShape,
        Self::WindingExclusion,
        Self::AngleGate,
        Self::Secant,
        Self::Rival,
        Self::SecondSpeed,
        Self::GivingWay,
        Self::FirstRowOffset,
        Self::FirstRowNoise,
        Self::MeasuredPath,
    ];
}

/// The part that is off, counted from one; 0 for none.
#[cfg(feature = "ablation")]
static OFF: AtomicU32 = AtomicU32::new(0);

/// Switches `part` off in all filters of the program, and all others on.
///
/// ```
/// use sinew_core::cyclic::coupled::ablation::{Part, switch_off};
///
/// switch_off(Some(Part::Tempering));
/// // ... filters of which this part is to be measured ...
/// switch_off(None);
/// ```
#[cfg(feature = "ablation")]
pub fn switch_off(part: Option<Part>) {
    OFF.store(part.map_or(0, |part| part as u32 + 1), Ordering::Relaxed);
}

/// Whether `part` is on.
#[cfg(feature = "ablation")]
pub(super) fn is_on(part: Part) -> bool {
    OFF.load(Ordering::Relaxed) != part as u32 + 1
}

/// Whether `part` is on: always.
#[cfg(not(feature = "ablation"))]
#[inline(always)]
pub(super) const fn is_on(_: Part) -> bool {
    true
}
