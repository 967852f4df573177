//! The arm tracker: particles of arm poses, some of whose hands are sent to skin-coloured blobs.
//!
//! [`ArmModel`] is what does not change (camera, arm, options); [`ArmTracker`] is the small state
//! of one arm, and [`ArmPair`] that of two arms that share one list of blobs. A frame goes in as an
//! [`ArmFrame`], an [`ArmEstimate`] comes out, for every frame.

mod confirmation;
mod context;
mod estimate;
pub mod example;
mod frame;
mod importance;
mod limbs;
mod memory;
mod model;
pub mod options;
mod pair;
mod particle;
mod propose;
mod resample;
mod saved;
mod state;
mod step;
#[cfg(feature = "serde")]
mod switch;
mod variant;
mod weigh;

pub use estimate::{ArmEstimate, ArmJoints, Status};
pub use frame::{ArmFrame, ArmImage, MAX_CANDIDATES, MIN_LIKELIHOOD};
pub use model::ArmModel;
pub use options::ArmOptions;
pub use pair::{ArmPair, PairFrame};
pub use particle::Particle;
pub use state::ArmTracker;
pub use variant::{PoseRule, Variant, VariantTraits};
