//! What a scene looks like, for the caller to choose.

use crate::motion::ArmSide;
use crate::track::SideChoice;
use sinew_core::error::{ParameterError, Rule, within};
use std::ops::Range;

/// Largest image side, pixels.
pub const MAX_SIDE_PX: u32 = 4096;

/// What stands behind the person.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BackgroundStyle {
    /// A wall with furniture and pictures of random colours, some of them brown like wood.
    #[default]
    Cluttered,
    /// A wall of one colour.
    Plain,
}

/// Which arms perform the motion; the other one hangs in a long sleeve, its hand in a pocket.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// One arm.
    One(ArmSide),
    /// Both arms.
    Both,
}

impl Sides {
    /// The moving sides, left first.
    #[must_use]
    pub fn list(self) -> Vec<ArmSide> {
        match self {
            Self::One(side) => vec![side],
            Self::Both => vec![ArmSide::Left, ArmSide::Right],
        }
    }
}

impl From<SideChoice> for Sides {
    fn from(choice: SideChoice) -> Self {
        match choice {
            SideChoice::Left => Self::One(ArmSide::Left),
            SideChoice::Right => Self::One(ArmSide::Right),
            SideChoice::Both => Self::Both,
        }
    }
}

/// Options of a scene. [`Default`] gives a laptop webcam and an adult.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneOptions {
    /// Image width, pixels.
    pub width_px: u32,
    /// Image height, pixels.
    pub height_px: u32,
    /// Horizontal field of view, radians.
    pub field_of_view_rad: f32,
    /// Number of frames; a shorter motion runs to and fro.
    pub frames: usize,
    /// Frames in a second; the motion is resampled to it.
    pub frames_per_second: f32,
    /// Seed of everything that is drawn at random.
    pub seed: u64,
    /// Which arms move and show their hands.
    pub sides: Sides,
    /// Body height, metres; it sets all lengths.
    pub body_height_m: f32,
    /// Share of the frames in which face and neck show their skin; in the others a hood covers
    /// both.
    pub false_blob_fraction: f32,
    /// Share of the frames in which a hand is hidden by a glove or a card, in runs of 3 to 10
    /// frames.
    pub hidden_fraction: f32,
    /// Frames in which the arm is behind the back and shows no skin; in the frame after them it is
    /// back.
    pub away: Option<Range<usize>>,
    /// Standard deviation of the sensor noise, levels of 255.
    pub noise_std: f32,
    /// What stands behind the person.
    pub background: BackgroundStyle,
}

impl Default for SceneOptions {
    fn default() -> Self {
        Self {
            width_px: 640,
            height_px: 480,
            field_of_view_rad: core::f32::consts::FRAC_PI_3,
            frames: 250,
            frames_per_second: 15.0,
            seed: 1,
            sides: Sides::One(ArmSide::Right),
            body_height_m: 1.75,
            false_blob_fraction: 0.5,
            hidden_fraction: 0.1,
            away: None,
            noise_std: 2.5,
            background: BackgroundStyle::default(),
        }
    }
}

impl SceneOptions {
    /// Checks every option.
    ///
    /// # Errors
    /// The first option that breaks a rule, by name.
    pub fn validate(&self) -> Result<(), ParameterError> {
        within("width_px", self.width_px as f32, 1.0, MAX_SIDE_PX as f32)?;
        within("height_px", self.height_px as f32, 1.0, MAX_SIDE_PX as f32)?;
        within("field_of_view_rad", self.field_of_view_rad, 0.2, 2.6)?;
        if self.frames == 0 {
            return Err(ParameterError::new("frames", Rule::NotEmpty));
        }
        within("frames_per_second", self.frames_per_second, 0.1, 10_000.0)?;
        within("body_height_m", self.body_height_m, 0.5, 2.5)?;
        within("false_blob_fraction", self.false_blob_fraction, 0.0, 1.0)?;
        within("hidden_fraction", self.hidden_fraction, 0.0, 0.9)?;
        within("noise_std", self.noise_std, 0.0, 60.0)?;
        match &self.away {
            Some(range) if range.start >= range.end || range.end > self.frames => {
                Err(ParameterError::new("away", Rule::OrderedInterval))
            }
            _ => Ok(()),
        }
    }
}
