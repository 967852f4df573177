//! Which way a person in a side view faces.

use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// Column of which way the person faces in the image: `left` or `right`.
pub const FACING: &str = "facing";

/// Direction in the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Facing {
    /// Towards smaller u.
    Left,
    /// Towards larger u.
    Right,
}

impl FromStr for Facing {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = [Self::Left, Self::Right].into_iter().find(|facing| facing.name() == text);
        named.ok_or_else(|| format!("has to be `left` or `right`, not `{text}`"))
    }
}

impl Facing {
    /// The name on the command line and in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// Sign of u in the picture of a person who walks towards larger u.
    #[must_use]
    pub const fn side(self) -> f64 {
        match self {
            Self::Left => -1.0,
            Self::Right => 1.0,
        }
    }
}
