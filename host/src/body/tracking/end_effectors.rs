//! The end-effectors of the body models, and the most particles of a tracker.

use sinew_core::skeleton::full_body::{COLLARS, FOREARMS, HEAD, SHANKS, TRUNK};

/// Most particles of a body tracker.
pub const MAX_BODY_PARTICLES: usize = 16_384;

/// End-effectors with goals: head, hands and feet; an upper body has the first three.
pub const END_EFFECTORS: [usize; 5] = [HEAD, FOREARMS[0], FOREARMS[1], SHANKS[0], SHANKS[1]];

/// Of these head and hands go with the root; feet stand.
pub const CARRIED: usize = 3;

/// About whose ends they swing: the neck and the shoulders.
pub(super) const JOINTS: [usize; CARRIED] = [TRUNK, COLLARS[0], COLLARS[1]];
