//! How a recording is tracked.

use crate::cyclic::CyclicError;
use serde::{Deserialize, Serialize};
use sinew_core::ranges::ANGLE_STD_RAD;
use std::str::FromStr;

/// Which filter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum FilterName {
    /// The phase-coupled filter: measurements correct the position in the cycle too.
    #[default]
    Coupled,
    /// The cyclic paper's Kalman filter.
    Paper,
    /// The paper's other reading: measurements correct the angles only.
    PaperCut,
    /// The paper's particle filter.
    Particle,
}

impl FilterName {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Coupled, Self::Paper, Self::PaperCut, Self::Particle];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Coupled => "coupled",
            Self::Paper => "paper",
            Self::PaperCut => "paper-cut",
            Self::Particle => "particle",
        }
    }

    /// Whether the seed changes the result.
    #[must_use]
    pub const fn is_random(self) -> bool {
        matches!(self, Self::Particle)
    }
}

impl FromStr for FilterName {
    type Err = CyclicError;

    fn from_str(name: &str) -> Result<Self, CyclicError> {
        let rule = || format!("has to be one of {}, not {name}", Self::ALL.map(Self::name).join(", "));
        let known = Self::ALL.into_iter().find(|filter| filter.name() == name);
        known.ok_or_else(|| CyclicError::parameter("filter", rule()))
    }
}

/// What is known of the first state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum StartName {
    /// The first row's angles, the model's velocities, the best matching (or given) position in the
    /// cycle.
    #[default]
    Standard,
    /// Nothing of the position in the cycle (coupled, particle).
    Uniform,
    /// Nothing at all: random angles and velocities too (particle).
    Random,
}

/// How the noise of the trained accelerations grows with the cycle's velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum ScalingName {
    /// Its covariance by the fourth power, since the acceleration grows by the square.
    #[default]
    FourthPower,
    /// Its covariance by the square like the mean, the cyclic paper's wording.
    Square,
}

/// Which rows' measurements the filter sees; the others are only compared with.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Updates {
    /// All.
    #[default]
    All,
    /// Every k-th after the first.
    Every(u64),
    /// Those of these frames.
    At(Vec<u64>),
}

impl Updates {
    /// Whether the measurement of `frame` is used in a table that begins at `first_frame`.
    #[must_use]
    pub fn uses(&self, first_frame: u64, frame: u64) -> bool {
        match self {
            Self::All => true,
            Self::Every(every) => (frame - first_frame).is_multiple_of(*every),
            Self::At(frames) => frames.contains(&frame),
        }
    }

    /// The same, and the first row, which gives the first state in any case.
    #[must_use]
    pub fn sees(&self, first_frame: u64, frame: u64) -> bool {
        frame == first_frame || self.uses(first_frame, frame)
    }
}

/// Options of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackingOptions {
    /// Filter.
    pub filter: FilterName,
    /// Standard deviation of every measured angle, radians.
    pub sigma_rad: f64,
    /// First state.
    pub start: StartName,
    /// First position in the cycle, [0, 1); the best match where `None`.
    pub initial_cycle_position: Option<f64>,
    /// First velocity, cycles per frame of the recording; that of the model's mean cycle where
    /// `None`.
    pub initial_cycle_velocity: Option<f64>,
    /// Growth of the acceleration's noise with the velocity (paper, paper-cut).
    pub covariance_scaling: ScalingName,
    /// Standard deviation of the temporal acceleration, cycles per frame^2 at the model's rate
    /// (paper, paper-cut, particle); the filter's own where `None`.
    pub temporal_std: Option<f64>,
    /// Rows that are used.
    pub updates: Updates,
    /// Frames per second of the recording; the model's where `None`.
    pub rate_hz: Option<f64>,
    /// Number of particles.
    pub particles: usize,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Whether each estimate is the one given the whole recording, by a pass backwards over the
    /// filter's.
    pub smooth: bool,
}

impl Default for TrackingOptions {
    fn default() -> Self {
        Self {
            filter: FilterName::Coupled,
            sigma_rad: 6.0_f64.to_radians(),
            start: StartName::Standard,
            initial_cycle_position: None,
            initial_cycle_velocity: None,
            covariance_scaling: ScalingName::FourthPower,
            temporal_std: None,
            updates: Updates::All,
            rate_hz: None,
            particles: 10_000,
            seed: 1,
            smooth: false,
        }
    }
}

/// Maximum number of frames per second. Chosen: no camera is as fast.
pub const MAX_RATE_HZ: f64 = 1.0e6;
/// Largest standard deviation of the temporal acceleration, cycles per frame^2. Chosen: from rest
/// to half a cycle a frame, the largest velocity, in ten frames.
pub const MAX_TEMPORAL_STD: f64 = 0.05;
/// Maximum number of particles that a run is asked for.
pub const MAX_PARTICLES: usize = 10_000_000;

impl TrackingOptions {
    /// Checks every option.
    ///
    /// # Errors
    /// Names the option and the rule it broke.
    pub fn check(&self) -> Result<(), CyclicError> {
        let refuse = |parameter, rule: String| Err(CyclicError::parameter(parameter, rule));
        if !(self.sigma_rad > 0.0 && self.sigma_rad.is_finite()) {
            return refuse(
                "sigma",
                format!("has to be greater than zero, not {} degrees", self.sigma_rad.to_degrees()),
            );
        }
        if !ANGLE_STD_RAD.contains(&(self.sigma_rad as f32)) {
            let [low, high] = [ANGLE_STD_RAD.start(), ANGLE_STD_RAD.end()].map(|std_rad| std_rad.to_degrees());
            return refuse(
                "sigma",
                format!("has to lie from {low:.3} to {high:.0} degrees, not {}", self.sigma_rad.to_degrees()),
            );
        }
        if let Some(rate) = self.rate_hz.filter(|rate| !(*rate > 0.0 && *rate <= MAX_RATE_HZ)) {
            return refuse("rate", format!("has to be greater than zero and at most {MAX_RATE_HZ}, not {rate}"));
        }
        if let Some(position) = self.initial_cycle_position.filter(|position| !(0.0..1.0).contains(position)) {
            return refuse("initial-cycle-position", format!("has to lie in [0, 1), not {position}"));
        }
        if let Some(velocity) = self.initial_cycle_velocity.filter(|velocity| !(velocity.abs() <= 0.5)) {
            return refuse("initial-cycle-velocity", format!("has to lie within +-0.5 cycles a frame, not {velocity}"));
        }
        self.check_paper_options()?;
        if self.updates == Updates::Every(0) {
            return refuse("update-every", "has to be at least 1".into());
        }
        if self.filter == FilterName::Particle && !(1..=MAX_PARTICLES).contains(&self.particles) {
            return refuse("particles", format!("have to be 1 to {MAX_PARTICLES}, not {}", self.particles));
        }
        if self.smooth && self.filter == FilterName::Particle {
            return refuse(
                "smooth",
                "needs a filter whose answer is a mean and a covariance; `particle` has a cloud: use --filter coupled, paper or paper-cut"
                    .into(),
            );
        }
        let start_fits = match self.start {
            StartName::Standard => true,
            StartName::Uniform => matches!(self.filter, FilterName::Particle | FilterName::Coupled),
            StartName::Random => self.filter == FilterName::Particle,
        };
        if !start_fits {
            let rule = format!(
                "{:?} is not known to `{}`; use standard, or --filter particle",
                self.start,
                self.filter.name()
            );
            return refuse("init", rule.to_lowercase());
        }
        Ok(())
    }

    /// Checks what only the paper's filters have.
    fn check_paper_options(&self) -> Result<(), CyclicError> {
        let is_kalman = matches!(self.filter, FilterName::Paper | FilterName::PaperCut);
        if self.covariance_scaling == ScalingName::Square && !is_kalman {
            let rule = format!("is no option of `{}`; use --filter paper or paper-cut", self.filter.name());
            return Err(CyclicError::parameter("covariance-scaling", rule));
        }
        let Some(std) = self.temporal_std else { return Ok(()) };
        let rule = match self.filter {
            FilterName::Coupled => "is no option of `coupled`; use --filter paper, paper-cut or particle".to_owned(),
            _ if (0.0..=MAX_TEMPORAL_STD).contains(&std) => return Ok(()),
            _ => format!("has to lie from 0 to {MAX_TEMPORAL_STD} cycles per frame^2, not {std}"),
        };
        Err(CyclicError::parameter("temporal-std", rule))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_second_frame_after_the_first_is_used() {
        let used: Vec<u64> = (7..14).filter(|&frame| Updates::Every(3).uses(7, frame)).collect();
        assert_eq!(used, [7, 10, 13]);
        assert!(Updates::At(vec![9]).uses(7, 9) && !Updates::At(vec![9]).uses(7, 10));
    }

    #[test]
    fn each_option_is_checked_by_name() {
        let good = TrackingOptions::default();
        good.check().unwrap();
        let bad = [
            (TrackingOptions { sigma_rad: 0.0, ..good.clone() }, "sigma"),
            (TrackingOptions { sigma_rad: 1.0e4, filter: FilterName::Paper, ..good.clone() }, "sigma"),
            (TrackingOptions { rate_hz: Some(-1.0), ..good.clone() }, "rate"),
            (TrackingOptions { rate_hz: Some(1.0e30), ..good.clone() }, "rate"),
            (TrackingOptions { initial_cycle_position: Some(1.0), ..good.clone() }, "initial-cycle-position"),
            (TrackingOptions { initial_cycle_velocity: Some(f64::NAN), ..good.clone() }, "initial-cycle-velocity"),
            (TrackingOptions { updates: Updates::Every(0), ..good.clone() }, "update-every"),
            (TrackingOptions { covariance_scaling: ScalingName::Square, ..good.clone() }, "covariance-scaling"),
            (TrackingOptions { temporal_std: Some(1.0e-4), ..good.clone() }, "temporal-std"),
            (TrackingOptions { temporal_std: Some(-1.0), filter: FilterName::Paper, ..good.clone() }, "temporal-std"),
            (TrackingOptions { filter: FilterName::Particle, particles: 0, ..good.clone() }, "particles"),
            (TrackingOptions { filter: FilterName::Particle, smooth: true, ..good.clone() }, "smooth"),
            (TrackingOptions { filter: FilterName::Paper, start: StartName::Uniform, ..good.clone() }, "init"),
        ];
        for (options, name) in bad {
            let error = options.check().unwrap_err().to_string();
            assert!(error.contains(name), "{error}");
        }
    }
}
