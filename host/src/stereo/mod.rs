//! A small-baseline stereo camera that sees a body made of capsules: points with known truth, and
//! two built-in motions.

pub mod animated;
pub mod camera;
pub mod capsule;
pub mod export;
pub mod hidden;
pub mod markers;
pub mod patches;
pub mod pelvic_lift;
pub mod scene;
pub mod scene_errors;
pub mod source;
pub mod stick_file;
pub mod stick_wave;
pub mod truth;
pub mod visible;

pub use camera::StereoCamera;
pub use hidden::{Hidden, Limb};
pub use pelvic_lift::pelvic_lift;
pub use scene::{StereoOptions, StereoScene};
pub use scene_errors::SceneErrors;
pub use source::{StereoMotion, StereoSource};
pub use stick_file::{SeenStick, read_stick};
pub use stick_wave::{StickWave, stick_wave};
pub use truth::{TrueFrame, read_truth};
