//! Options that make a scene of `sinew simulate stereo` harder.

use crate::stereo::SceneErrors;
use clap::Args;

/// What is wrong with a scene; what is not given is zero, or with `--hard` that of a hard scene.
#[derive(Debug, Clone, Default, Args)]
pub struct SceneErrorArgs {
    /// A hard scene: radius error 0.15, length error 0.05, first pose error 10, match window 11,
    /// false matches 0.05, background 0.1, exposure 1/30 s; each may be given beside it.
    #[arg(long)]
    pub hard: bool,
    /// Share by which the radii of the seen body differ from those of body.json, thicker or
    /// thinner by the seed.
    #[arg(long, value_name = "SHARE")]
    pub radius_error: Option<f32>,
    /// Share by which the lengths of body.json differ from the seen person's, longer or shorter by
    /// the seed.
    #[arg(long, value_name = "SHARE")]
    pub length_error: Option<f32>,
    /// Degrees by which each angle of first_pose.json is off, to either side by the seed.
    #[arg(long, value_name = "DEGREES")]
    pub first_pose_error: Option<f32>,
    /// Side of the squares whose points share the error of their disparity, pixels; 0 gives each
    /// point its own.
    #[arg(long, value_name = "PIXELS")]
    pub match_window: Option<u32>,
    /// Share of these squares (or of points) that are matched falsely, to any depth of the body's
    /// box.
    #[arg(long, value_name = "SHARE")]
    pub false_matches: Option<f32>,
    /// Share of the points that lie on a wall half a metre behind the person.
    #[arg(long, value_name = "SHARE")]
    pub background: Option<f32>,
    /// How long the shutter is open, seconds: each point lies where its bone is at a moment of it.
    #[arg(long, value_name = "SECONDS")]
    pub exposure: Option<f32>,
}

impl SceneErrorArgs {
    /// The errors of the scene.
    #[must_use]
    pub fn errors(&self) -> SceneErrors {
        let base = if self.hard { SceneErrors::HARD } else { SceneErrors::default() };
        SceneErrors {
            radius_share: self.radius_error.unwrap_or(base.radius_share),
            length_share: self.length_error.unwrap_or(base.length_share),
            first_pose_deg: self.first_pose_error.unwrap_or(base.first_pose_deg),
            match_window_px: self.match_window.unwrap_or(base.match_window_px),
            false_matches: self.false_matches.unwrap_or(base.false_matches),
            background: self.background.unwrap_or(base.background),
            exposure_s: self.exposure.unwrap_or(base.exposure_s),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hard_scene_has_all_errors_and_each_may_be_given() {
        assert_eq!(SceneErrorArgs::default().errors(), SceneErrors::default());
        let hard = SceneErrorArgs { hard: true, ..SceneErrorArgs::default() };
        assert_eq!(hard.errors(), SceneErrors::HARD);
        let sharp = SceneErrorArgs { exposure: Some(0.0), ..hard };
        assert_eq!(sharp.errors(), SceneErrors { exposure_s: 0.0, ..SceneErrors::HARD });
    }
}
