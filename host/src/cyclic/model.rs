//! A motion model that owns its numbers, and lends them to the core's filters.

use super::model_file;
use anyhow::{Result, bail};
use serde::{Deserialize, Serialize};
use sinew_core::cyclic::{Deviation, ModelError, ModelParts, MotionModel};
use std::path::Path;

/// Walking, as shipped: `models/cuts/walking.csv` tells on which cycles it was trained.
const SHIPPED_WALKING: &str = include_str!("../../models/walking.json");
/// Running, as shipped: `models/cuts/running.csv` tells on which cycles it was trained.
const SHIPPED_RUNNING: &str = include_str!("../../models/running.json");
/// Arms that circle forwards, as shipped: `models/cuts/arm-circles.csv` tells on which cycles it was trained.
const SHIPPED_ARM_CIRCLES: &str = include_str!("../../models/arm-circles.json");

/// What a model was trained on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrainedOn {
    /// Names of the angle tables, without the places where they lay, sorted.
    pub tables: Vec<String>,
    /// Number of cycles.
    pub cycles: u64,
    /// Share of the covariance that was replaced by its diagonal, 0 for none.
    pub shrinkage: f64,
}

/// Spread about the mean cycle: see [`Deviation`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviationNumbers {
    /// What the variances of constant and swing were multiplied by, for the few people that they come from.
    pub inflation: f32,
    /// Part of each variance that was replaced by the mean over the angles.
    pub shrinkage: f32,
    /// See [`Deviation::offset_std_rad`].
    pub offset_std_rad: Vec<f32>,
    /// See [`Deviation::swing_std_rad`].
    pub swing_std_rad: Vec<f32>,
    /// See [`Deviation::rest_std_rad`].
    pub rest_std_rad: Vec<f32>,
    /// See [`Deviation::rest_rate_per_cycle`].
    pub rest_rate_per_cycle: Vec<f32>,
}

/// The numbers of a model: see [`ModelParts`] for each field.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelNumbers {
    /// See [`ModelParts::angle_count`].
    pub angle_count: usize,
    /// See [`ModelParts::mean_acceleration`].
    pub mean_acceleration: Vec<f32>,
    /// See [`ModelParts::acceleration_covariance`].
    pub acceleration_covariance: Vec<f32>,
    /// See [`ModelParts::mean_pose_rad`].
    pub mean_pose_rad: Vec<f32>,
    /// See [`ModelParts::mean_velocity`].
    pub mean_velocity: Vec<f32>,
    /// See [`ModelParts::turns_per_cycle`].
    pub turns_per_cycle: Vec<i8>,
    /// See [`ModelParts::mean_duration_frames`]: one over the mean of the training cycles' 1 / duration.
    pub mean_duration_frames: f32,
    /// See [`ModelParts::rate_hz`].
    pub rate_hz: f32,
    /// What the phase-coupled filter needs; `None` in a model that was trained without.
    pub deviation: Option<DeviationNumbers>,
}

impl ModelNumbers {
    /// Checks the numbers and lends them to the core.
    ///
    /// # Errors
    /// Those of [`MotionModel::new`].
    pub fn view(&self) -> Result<MotionModel<'_>, ModelError> {
        MotionModel::new(ModelParts {
            angle_count: self.angle_count,
            mean_acceleration: &self.mean_acceleration,
            acceleration_covariance: &self.acceleration_covariance,
            mean_pose_rad: &self.mean_pose_rad,
            mean_velocity: &self.mean_velocity,
            turns_per_cycle: &self.turns_per_cycle,
            mean_duration_frames: self.mean_duration_frames,
            rate_hz: self.rate_hz,
            deviation: self.deviation.as_ref().map_or_else(Deviation::default, |deviation| Deviation {
                offset_std_rad: &deviation.offset_std_rad,
                swing_std_rad: &deviation.swing_std_rad,
                rest_std_rad: &deviation.rest_std_rad,
                rest_rate_per_cycle: &deviation.rest_rate_per_cycle,
            }),
        })
    }
}

/// A checked model with its origin.
#[derive(Debug, Clone, PartialEq)]
pub struct CyclicModel {
    numbers: ModelNumbers,
    trained_on: TrainedOn,
}

impl CyclicModel {
    /// Checks `numbers`.
    ///
    /// # Errors
    /// Those of [`MotionModel::new`].
    pub fn new(numbers: ModelNumbers, trained_on: TrainedOn) -> Result<Self, ModelError> {
        numbers.view()?;
        Ok(Self { numbers, trained_on })
    }

    /// The model that an option names: `walking`, `running` or `arm-circles` as shipped, else a file.
    ///
    /// # Errors
    /// No such file, or a file that is no model.
    pub fn from_option(option: &str) -> Result<Self> {
        match option {
            "walking" => model_file::parse(SHIPPED_WALKING),
            "running" => model_file::parse(SHIPPED_RUNNING),
            "arm-circles" => model_file::parse(SHIPPED_ARM_CIRCLES),
            path if Path::new(path).exists() => model_file::read(Path::new(path)),
            other => bail!(
                "`--model {other}`: there is no such file; give walking, running, arm-circles, or a file made by `sinew train cyclic`"
            ),
        }
    }

    /// The model as the core's filters read it.
    ///
    /// # Panics
    /// Never: the numbers were checked when the model was made.
    #[must_use]
    pub fn view(&self) -> MotionModel<'_> {
        self.numbers.view().expect("the numbers were checked when the model was made")
    }

    /// The numbers.
    #[must_use]
    pub fn numbers(&self) -> &ModelNumbers {
        &self.numbers
    }

    /// What it was trained on.
    #[must_use]
    pub fn trained_on(&self) -> &TrainedOn {
        &self.trained_on
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shipped_models_are_sound_and_have_the_cadence_of_people() {
        for (name, cycles_per_s) in [("walking", 0.7..1.2), ("running", 1.1..1.7), ("arm-circles", 0.8..1.4)] {
            let model = CyclicModel::from_option(name).unwrap();
            let view = model.view();
            let found = view.mean_cycle_velocity() * view.rate_hz();
            assert!(cycles_per_s.contains(&found), "{name}: {found} cycles a second");
            assert!(model.trained_on().cycles >= 6, "{name}");
        }
    }

    #[test]
    fn an_unknown_name_is_refused_with_the_choices() {
        let message = CyclicModel::from_option("wlaking").unwrap_err().to_string();
        assert!(message.contains("walking, running") && message.contains("wlaking"), "{message}");
    }
}
