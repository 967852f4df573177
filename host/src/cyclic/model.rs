//! A motion model that owns its numbers, and lends them to the core's filters.

use self_cell::self_cell;
use serde::{Deserialize, Serialize};
use sinew_core::cyclic::model::bytes::{self, ModelHeader};
use sinew_core::cyclic::{Deviation, ModelError, ModelParts, MotionModel};

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
    /// What the variances of constant and swing were multiplied by, for the few people that they
    /// come from.
    pub inflation: f32,
    /// Part of each variance that was replaced by the mean over the angles.
    pub shrinkage: f32,
    /// See [`Deviation::offset_std_rad`].
    pub offset_std_rad: Vec<f32>,
    /// See [`Deviation::cosine_std_rad`].
    #[serde(alias = "swing_std_rad")]
    pub cosine_std_rad: Vec<f32>,
    /// See [`Deviation::sine_std_rad`].
    #[serde(default)]
    pub sine_std_rad: Vec<f32>,
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
    /// See [`ModelParts::mean_duration_frames`]: one over the mean of the training cycles' 1 /
    /// duration.
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
                cosine_std_rad: &deviation.cosine_std_rad,
                sine_std_rad: &deviation.sine_std_rad,
                rest_std_rad: &deviation.rest_std_rad,
                rest_rate_per_cycle: &deviation.rest_rate_per_cycle,
            }),
        })
    }
}

impl ModelNumbers {
    /// CRC-32 of all numbers, which stands for them where a run goes on.
    #[must_use]
    pub fn crc32(&self) -> u32 {
        let mut hasher = crc32fast::Hasher::new();
        let mut add = |values: &[f32]| {
            hasher.update(&values.len().to_le_bytes());
            values.iter().for_each(|value| hasher.update(&value.to_le_bytes()));
        };
        add(&[self.mean_duration_frames, self.rate_hz]);
        let turns: Vec<f32> = self.turns_per_cycle.iter().map(|turns| f32::from(*turns)).collect();
        [&turns, &self.mean_pose_rad, &self.mean_velocity, &self.mean_acceleration, &self.acceleration_covariance]
            .into_iter()
            .for_each(|values| add(values));
        if let Some(deviation) = &self.deviation {
            add(&[deviation.inflation, deviation.shrinkage]);
            [
                &deviation.offset_std_rad,
                &deviation.cosine_std_rad,
                &deviation.sine_std_rad,
                &deviation.rest_std_rad,
                &deviation.rest_rate_per_cycle,
            ]
            .into_iter()
            .for_each(|values| add(values));
        }
        hasher.finalize()
    }
}

self_cell! {
    /// Numbers that were checked, with what the core's filters borrow of them.
    struct Checked {
        owner: ModelNumbers,
        #[covariant]
        dependent: MotionModel,
    }

    impl { Debug, PartialEq }
}

/// A checked model with its origin.
#[derive(Debug, PartialEq)]
pub struct CyclicModel {
    checked: Checked,
    trained_on: TrainedOn,
}

impl Clone for CyclicModel {
    fn clone(&self) -> Self {
        let copy = Self::new(self.numbers().clone(), self.trained_on.clone());
        copy.expect("the numbers were checked when this model was made")
    }
}

impl CyclicModel {
    /// Checks `numbers`.
    ///
    /// # Errors
    /// Those of [`MotionModel::new`].
    pub fn new(numbers: ModelNumbers, trained_on: TrainedOn) -> Result<Self, ModelError> {
        Ok(Self { checked: Checked::try_new(numbers, ModelNumbers::view)?, trained_on })
    }

    /// The model as the core's filters read it.
    #[must_use]
    pub fn view(&self) -> MotionModel<'_> {
        *self.checked.borrow_dependent()
    }

    /// The model as firmware reads it ([`sinew_core::cyclic::model::bytes`]), for all filters;
    /// `None` where it says nothing of how people differ.
    #[must_use]
    pub fn to_bytes(&self) -> Option<Vec<u8>> {
        let view = self.view();
        let mut bytes = vec![0; ModelHeader::of(&view).byte_count()];
        bytes::write(&view, &mut bytes)?;
        Some(bytes)
    }

    /// As [`Self::to_bytes`], for the phase-coupled filter alone.
    #[must_use]
    pub fn to_coupled_bytes(&self) -> Option<Vec<u8>> {
        let view = self.view();
        let mut bytes = vec![0; ModelHeader::of_coupled(&view).byte_count()];
        bytes::write_coupled(&view, &mut bytes)?;
        Some(bytes)
    }

    /// The numbers.
    #[must_use]
    pub fn numbers(&self) -> &ModelNumbers {
        self.checked.borrow_owner()
    }

    /// What it was trained on.
    #[must_use]
    pub fn trained_on(&self) -> &TrainedOn {
        &self.trained_on
    }
}
