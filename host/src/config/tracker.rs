//! Section `[tracker]`: the options of the core's arm tracker.

use super::BodyConfig;
use sinew_core::error::{ParameterError, Rule};
use sinew_core::tracker::arm::ArmOptions;
use sinew_core::tracker::arm::options::AreaCue;

/// Maximum number of particles that the command tracks with.
pub const MAX_PARTICLES: usize = 5000;

/// Checks every value.
pub(super) fn check(options: &ArmOptions) -> Result<(), ParameterError> {
    if !(1..=MAX_PARTICLES).contains(&options.particles) {
        let rule = Rule::Within { low: 1.0, high: MAX_PARTICLES as f32 };
        return Err(ParameterError::new("particles", rule));
    }
    options.check()
}

/// The options for this person: the hand's area, and what a guessed shoulder changes.
#[must_use]
pub fn options_for(options: &ArmOptions, body: &BodyConfig) -> ArmOptions {
    let hand_area_m2 = body.hand_area_m2();
    let area_cue = options.area_cue.map(|cue| AreaCue { hand_area_m2, ..cue });
    ArmOptions { area_cue, ..*options }.for_shoulder(body.knows_shoulders())
}
