//! The configuration file of `track arm`: camera, body, thresholds; every value has a default.

mod body;
mod camera;
mod known_keys;
mod likelihood;
mod tracker;

pub use body::BodyConfig;
pub use camera::CameraConfig;
pub use likelihood::{EdgeConfig, LikelihoodConfig};
pub use tracker::{MAX_PARTICLES, options_for};

use crate::error::{Context, Error, Result, bail};
use crate::file::read_text;
use serde::{Deserialize, Deserializer, Serialize};
use sinew_core::error::ParameterError;
use sinew_core::tracker::arm::ArmOptions;
use std::path::Path;

/// The defaults as a commented file: what `--print-config` writes.
pub const DEFAULT_FILE: &str = include_str!("default.toml");

/// Everything that a configuration file can set.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Config {
    /// The camera.
    pub camera: CameraConfig,
    /// The person.
    pub body: BodyConfig,
    /// The tracker.
    pub tracker: ArmOptions,
    /// From blobs to the likelihood of a hand.
    pub likelihood: LikelihoodConfig,
    /// Temporal edges.
    pub edges: EdgeConfig,
}

impl Config {
    /// Reads a TOML file.
    ///
    /// # Errors
    /// Names the file and what is wrong: it is not readable, or not TOML. A key may be unknown
    /// (with the nearest right one), or a value may have the wrong type or be out of range.
    pub fn load(path: &Path) -> Result<Self> {
        let text = read_text(path).with_context(|| {
            format!("configuration `{}` cannot be read; `sinew track arm --print-config` writes one", path.display())
        })?;
        Self::parse(&text).with_context(|| format!("configuration `{}`", path.display()))
    }

    /// Reads TOML text.
    ///
    /// # Errors
    /// As [`Config::load`].
    pub fn parse(text: &str) -> Result<Self> {
        Self::read(toml::Deserializer::parse(text).context("it is not valid TOML")?)
    }

    /// Reads JSON text with the same sections: what `run.json` has as `options.config`.
    ///
    /// # Errors
    /// As [`Config::load`].
    pub fn parse_json(text: &str) -> Result<Self> {
        // By way of a value, whose numbers are parsed exactly.
        Self::read(serde_json::from_str::<serde_json::Value>(text).context("it is not valid JSON")?)
    }

    fn read<'de, D: Deserializer<'de>>(text: D) -> Result<Self>
    where
        Error: From<D::Error>,
    {
        let mut unknown = Vec::new();
        let config: Self = serde_ignored::deserialize(text, |path| unknown.push(path.to_string()))?;
        if let Some(key) = unknown.first() {
            bail!("{}", known_keys::unknown_key_message(key));
        }
        config.check()?;
        Ok(config)
    }

    /// Refuses values out of range, by name.
    ///
    /// # Errors
    /// The first one.
    pub fn check(&self) -> Result<(), ParameterError> {
        self.camera.check()?;
        self.body.check()?;
        tracker::check(&self.tracker)?;
        self.likelihood.build()?;
        self.edges.build()?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_printed_file_holds_exactly_the_defaults() {
        assert_eq!(Config::parse(DEFAULT_FILE).unwrap(), Config::default());
    }

    #[test]
    fn json_holds_what_toml_does() {
        let config = Config::parse(
            "[body]\nupper_arm_m = 0.29\n[camera]\nwidth_px = 640\ndistortion = [0.1, -0.3, 0, 0, 1e-7]\n\
             [tracker]\ngate = false\nvariant = \"bootstrap\"\n",
        );
        let config = config.unwrap();
        for config in [Config::default(), config] {
            assert_eq!(Config::parse_json(&serde_json::to_string(&config).unwrap()).unwrap(), config);
        }
        let refused = |text: &str, part: &str| {
            let message = format!("{:#}", Config::parse_json(text).unwrap_err());
            assert!(message.contains(part), "{message}");
        };
        refused("{\"body\": {\"heigth_m\": 1.8}}", "body.height_m");
        refused("{\"tracker\": {\"particles\": 0}}", "particles");
        refused("[1]", "CameraConfig");
        refused("{", "JSON");
    }

    #[test]
    fn the_printed_file_names_every_key() {
        for key in known_keys::all().into_iter().filter(|key| key.contains('.')) {
            let name = key.rsplit('.').next().unwrap();
            let is_there = DEFAULT_FILE.contains(&format!("{name} =")) || DEFAULT_FILE.contains(&format!("[{key}]"));
            assert!(is_there, "`{key}` is missing");
        }
    }

    #[test]
    fn an_unknown_key_is_refused_with_the_nearest_right_one() {
        let message = format!("{:#}", Config::parse("[body]\nheigth_m = 1.8\n").unwrap_err());
        assert!(message.contains("body.heigth_m") && message.contains("body.height_m"), "{message}");
        let message = format!("{:#}", Config::parse("[trakcer]\nparticles = 5\n").unwrap_err());
        assert!(message.contains("trakcer") && message.contains("tracker"), "{message}");
    }

    #[test]
    fn a_key_of_older_files_is_refused_with_the_present_one() {
        for (old, new) in known_keys::FORMER {
            let message = format!("{:#}", Config::parse(&format!("[tracker]\n{old} = 1\n")).unwrap_err());
            assert!(message.contains(&format!("`tracker.{old}` is now `tracker.{new}`")), "{message}");
            assert!(known_keys::all().contains(&format!("tracker.{new}")), "{new}");
        }
    }

    #[test]
    fn parts_of_the_tracker_are_switched_off_and_set_in_sections() {
        let tracker = |text: &str| Config::parse(text).unwrap().tracker;
        let off = tracker("[tracker]\ngate = false\narea_cue = true\nvariant = \"pik-paid\"\n");
        assert!(off.gate.is_none() && off.area_cue == ArmOptions::default().area_cue);
        assert_eq!(off.variant, sinew_core::tracker::arm::Variant::PikWeighted);
        let set = tracker("[tracker.gate]\nstd_m = 0.8\n[tracker.hough]\nbins = 18\n");
        assert_eq!((set.gate.unwrap().std_m, set.gate.unwrap().floor, set.hough.bins), (0.8, 0.02, 18));
        let message = format!("{:#}", Config::parse("[tracker.gate]\nstd = 0.8\n").unwrap_err());
        assert!(message.contains("`tracker.gate.std`") && message.contains("`tracker.gate.std_m`"), "{message}");
    }

    #[test]
    fn a_value_out_of_range_is_refused_by_name() {
        for (text, name) in [
            ("[tracker]\nparticles = 0\n", "particles"),
            ("[tracker.gate]\nstd_m = -1.0\n", "gate.std_m"),
            ("[camera]\nhorizontal_field_of_view_deg = 200.0\n", "horizontal_field_of_view_deg"),
            ("[body]\nupper_arm_m = nan\n", "upper_arm_m"),
            ("[body]\nheight_m = \"tall\"\n", "height_m"),
            ("[likelihood]\narea_fractions = [0.5, 0.1]\n", "area_fractions"),
            ("[edges]\nmin_motion = 999.0\n", "min_motion"),
        ] {
            let message = format!("{:#}", Config::parse(text).unwrap_err());
            assert!(message.contains(name), "{text}: {message}");
        }
    }
}
